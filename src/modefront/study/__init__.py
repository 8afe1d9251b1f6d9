"""Studies: a file in, results out."""
