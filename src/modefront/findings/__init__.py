"""Findings as records, and the one place in which records become sentences (findings.md)."""
