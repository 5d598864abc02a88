"""Recorded interactions on disk."""
