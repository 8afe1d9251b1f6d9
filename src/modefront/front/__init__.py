"""Pareto fronts: subproblems, an archive, proposers, and the search that asks and tells them."""
