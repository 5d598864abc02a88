"""Point-based values for questions of any kind: the default planner where there is more to ask than "this one?"."""
