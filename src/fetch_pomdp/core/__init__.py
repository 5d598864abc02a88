"""The model, the belief, the planners and the interaction; it imports NumPy, Numba and the standard library alone."""
