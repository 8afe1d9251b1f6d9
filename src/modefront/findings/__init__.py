"""Findings as records, and the one place in which records become sentences.

A finding has a kind and the numbers and names of its sentence; `catalogue` has the sentence of each
kind and how severe it is. Terminal, report, JSON and Python show the same sentences, in the same
order. docs/findings.md says of each kind what it means and what to do.
"""
