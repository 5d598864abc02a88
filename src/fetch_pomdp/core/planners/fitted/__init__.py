"""The default planner: a value table fitted to the problem, and one exact step ahead of it."""
