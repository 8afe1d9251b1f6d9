"""Mistakes of models and data that a comparison at the nominal parameters shows."""
