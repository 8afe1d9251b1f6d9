"""Models of results as files of other programs."""
