"""Searches a few actions ahead: the paper's sparse sampling, and one that sums answers exactly."""
