"""Affine matrices, their sparse pencil and factorisations, and products with tall matrices."""
