"""Linear elastic isotropic material."""

from __future__ import annotations

from dataclasses import dataclass

from modefront.fem.errors import FemError


@dataclass(frozen=True)
class Material:
    """Isotropic material, in consistent units (SI: Pa, -, kg/m^3).

    Attributes
    ----------
    E
        Young's modulus, > 0.
    nu
        Poisson's ratio, -1 < nu < 0.5.
    rho
        Density, >= 0.

    Raises
    ------
    FemError
        If a value is outside its range.
    """

    E: float
    nu: float
    rho: float

    def __post_init__(self) -> None:
        """Refuse values for which the elasticity matrix is not positive definite."""
        for name, value, expected, ok in (
            ("E", self.E, "> 0", self.E > 0),
            ("nu", self.nu, "between -1 and 0.5", -1 < self.nu < 0.5),
            ("rho", self.rho, ">= 0", self.rho >= 0),
        ):
            if not ok:
                raise FemError(f"material: {name} must be {expected}, found {value!r}")

    @property
    def G(self) -> float:
        """Shear modulus E / (2 (1 + nu))."""
        return self.E / (2 * (1 + self.nu))
