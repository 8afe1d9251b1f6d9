"""Identifiability: combinations of parameters that data determine, and those that they do not."""
