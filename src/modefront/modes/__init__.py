"""Eigenproblems and exact derivatives of their solutions: the only place that solves them."""
