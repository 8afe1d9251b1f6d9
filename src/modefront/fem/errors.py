"""The one exception of the finite-element room."""


class FemError(ValueError):
    """A model that cannot be built: says where, what was expected and what was found."""
