"""Measured data."""
