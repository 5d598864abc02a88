"""Simulated people who are not the model's own story: what they say, how they point, and what is heard of it."""
