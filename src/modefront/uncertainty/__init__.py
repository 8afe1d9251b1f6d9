"""How far measured errors scatter models and fronts, and what that says of predictions."""
