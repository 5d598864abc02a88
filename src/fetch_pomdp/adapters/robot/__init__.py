"""Arms and voices."""
