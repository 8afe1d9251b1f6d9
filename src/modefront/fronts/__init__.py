"""Pareto fronts: what a point of one is, how it is found, and the models beside it."""
