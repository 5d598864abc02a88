"""Our reader: from the words of a request to readings, and from each reading to a likelihood of every item."""
