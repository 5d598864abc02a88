"""What people said about tables and what they meant: a corpus, how well it is read, and weights learnt from it."""
