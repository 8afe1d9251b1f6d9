"""Uncertainty: the scatter of models, fronts and predictions by errors of the data."""
