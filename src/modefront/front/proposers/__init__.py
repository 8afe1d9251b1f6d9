"""Proposers: each says what to search next, one a file."""
