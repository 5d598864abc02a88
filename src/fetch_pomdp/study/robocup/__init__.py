"""RoboCup@Home's "Hand Me That": its rules and score, and games with simulated operators."""
