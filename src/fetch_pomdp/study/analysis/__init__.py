"""What a table of trials says: cells, comparisons, the paper's two hypotheses, and the people a study needs."""
