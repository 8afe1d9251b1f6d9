"""Local solutions of scalarised vector problems within bounds; nothing here knows of fronts."""
