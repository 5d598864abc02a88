"""Robots to compare ours with: the two of Section IV, and others after earlier work."""
