"""Upper bounds on the optimal return: what no policy can beat."""
