"""Eyes: sources of skeletons."""
