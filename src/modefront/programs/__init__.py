"""Finite-element programs, one a file: a new one is named here, and nowhere else."""

from __future__ import annotations

from collections.abc import Mapping

from modefront.programs.abaqus import ABAQUS
from modefront.programs.ansys import ANSYS
from modefront.programs.base import Program
from modefront.programs.calculix import CALCULIX
from modefront.programs.nastran import NASTRAN
from modefront.programs.opensees import OPENSEES

PROGRAMS: Mapping[str, Program] = {
    program.name: program for program in (CALCULIX, ABAQUS, NASTRAN, ANSYS, OPENSEES)
}
"""All programs by their names."""
