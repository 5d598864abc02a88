"""FETCH-POMDP: decide online whether to wait, to point at an item and ask, or to pick it."""
