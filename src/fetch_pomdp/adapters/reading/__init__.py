"""Readers of what people say, by name, and a door to models that others serve."""
