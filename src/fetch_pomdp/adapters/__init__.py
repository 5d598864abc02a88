"""Ears, eyes and robots: each behind a Protocol of the core, its library imported only where it is used."""
