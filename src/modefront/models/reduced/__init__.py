"""Reduced bases that are certified in the full model: a few full eigensolutions for all."""
