"""Finite-element programs, a module each: a new one is named here, and nowhere else."""

from __future__ import annotations

from collections.abc import Mapping

from modefront.programs.base import Program

PROGRAMS: Mapping[str, Program] = {
    name: Program(name, eliminates=name == "abaqus")
    for name in ("calculix", "abaqus", "nastran", "ansys", "opensees")
}
"""All programs by their names."""
