"""The paper's twelve cells: what they are, a search for people who give them, ours beside theirs."""
