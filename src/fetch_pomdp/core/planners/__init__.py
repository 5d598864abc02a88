"""Planners: each turns a belief and the last question into a decision."""
