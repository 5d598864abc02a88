"""User studies with real people, led from consent to completion code in a browser (docs/study-with-people.md)."""
