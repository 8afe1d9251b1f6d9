"""Frequency response of linear structures, and its peaks."""
