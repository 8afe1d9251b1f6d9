"""Structural model updating with all Pareto-optimal models."""

__version__ = "0.1.0"
