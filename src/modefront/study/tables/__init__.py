"""The tables of a study file: one reader a table."""
