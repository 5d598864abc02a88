"""What was said: its words, the paper's reading of them (Eq. 4-6), and the answers that people give."""
