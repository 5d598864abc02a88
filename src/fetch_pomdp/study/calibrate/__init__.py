"""The model's parameters from recorded interactions: estimates, intervals, and which of them limits accuracy."""
