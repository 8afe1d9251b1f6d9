"""First-passage probabilities of linear structures under Gaussian noise."""
