"""What the robot may ask: questions as data, what their answers tell, and what asking costs."""
