"""The revisions; a new one never changes those before it."""
