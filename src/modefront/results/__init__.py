"""Results of a study: their schema, the file that holds them, and the findings."""
