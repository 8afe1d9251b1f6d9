"""Residuals of measured properties and the objectives that they form."""
