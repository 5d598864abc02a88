"""What `benchmarks/questions.py` measures with."""
