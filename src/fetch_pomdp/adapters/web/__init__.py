"""The robot in a browser: a page, the server behind it, and what they say to each other (docs/serve.md)."""
