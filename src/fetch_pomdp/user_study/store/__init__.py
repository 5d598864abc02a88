"""The database of a study's participants, their trials and answers: SQLite, or PostgreSQL."""
