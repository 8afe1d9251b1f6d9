"""Tasks: what a run is made of, who carries them out, what they cost, and what is kept of them."""
