"""Results of a study: their schema, the file that holds them, and what is said about them."""
