"""Solvers of vector problems J(theta) within bounds; nothing here knows of structures."""
