"""Studies with real people: who comes is led from consent to completion code (docs/study-with-people.md)."""
