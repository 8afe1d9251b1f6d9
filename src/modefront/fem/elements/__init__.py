"""Element matrices, vectorised over elements; each module opens with its derivation."""
