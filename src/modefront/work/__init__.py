"""Tasks of a run: their execution, costs and kept results."""
