"""Finite-element programs, a module each: a new one is named here, and nowhere else."""

PROGRAMS = ("calculix", "abaqus", "nastran", "ansys", "opensees")  # as the command line has them
