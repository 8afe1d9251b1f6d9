"""Which model mode belongs to which measured mode."""
