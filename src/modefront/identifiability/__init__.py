"""What the data determine of a model, and what they leave open."""
