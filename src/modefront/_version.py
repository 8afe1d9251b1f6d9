"""The version of the package; flit reads it here."""

__version__ = "0.1.0"
