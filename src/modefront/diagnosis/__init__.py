"""Mistakes of models and data that a comparison at the nominal parameters shows.

``benchmarks/check.py`` measures the limits from which on something is a mistake: docs/check.md has
the rates of mistakes that are found, and of findings on correct studies.
"""
