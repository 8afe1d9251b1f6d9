"""Materials, and sections of beams: constants about principal axes y and z through the centroid.

Warping is free: where it is held, open thin walls twist less than beams.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Annotated, ParamSpec, TypeVar

import numpy as np

from modefront._typing import Floats
from modefront.options import NUMBER, PAIR, array, number, numbers

DENSITY, THREE = number("a density of 0 or more", least=0), array(NUMBER, 3, 3)
Length = Annotated[float, number("a number above 0", above=0)]
Factor = Annotated[float, number("a shear factor above 0", above=0)]

P = ParamSpec("P")
T = TypeVar("T")


class FemError(ValueError):
    """A model that cannot be built: says where, what was expected and what was found.

    Attributes
    ----------
    messages : one for each thing that is wrong
    """

    def __init__(self, *messages: str) -> None:
        self.messages = messages
        super().__init__("\n".join(messages))


@contextmanager
def at(place: str) -> Iterator[None]:
    """Have messages begin with the place of what is checked; with an empty one as they are."""
    try:
        yield
    except FemError as error:
        raise FemError(*(f"{place}: {x}" if place else x for x in error.messages)) from None


@dataclass(frozen=True)
class Checks:
    """Checks that go on after one of them fails, so that all that is wrong is said at once.

    Attributes
    ----------
    messages : what is wrong
    """

    messages: list[str] = field(default_factory=list)

    def attempt(
        self, place: str, check: Callable[P, T], *args: P.args, **kwargs: P.kwargs
    ) -> T | None:
        """Return the result of a function; None, with messages noted for a place, if it fails."""
        try:
            with at(place):
                return check(*args, **kwargs)
        except FemError as error:
            self.messages.extend(m for m in error.messages if m not in self.messages)
            return None

    def close(self) -> None:
        """Raise FemError with everything that is wrong, if anything is."""
        if self.messages:
            raise FemError(*self.messages)


@dataclass(frozen=True)
class Material:
    """Isotropic material, in consistent units (SI: Pa, -, kg/m^3).

    Raises FemError if a value is outside its range.

    Attributes
    ----------
    E : Young's modulus, > 0
    nu : Poisson's ratio, -1 < nu < 0.5
    rho : density, >= 0
    """

    E: Annotated[float, number("Young's modulus above 0", above=0)]
    nu: Annotated[float, number("Poisson's ratio between -1 and 0.5", above=-1, below=0.5)]
    rho: Annotated[float, DENSITY]

    def __post_init__(self) -> None:
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

    def compliance(self) -> Floats:
        """Return S (6, 6), strains of stresses 11, 22, 33, 23, 13, 12 (engineering shear)."""
        return _compliance((self.E,) * 3, (self.nu,) * 3, (self.G,) * 3)


@dataclass(frozen=True)
class Orthotropic:
    """Orthotropic material, such as wood or a laminate, by its axes 1, 2 and 3.

    Raises FemError if a value is outside its range, or the elasticity matrix is not positive
    definite.

    Attributes
    ----------
    E : Young's moduli E_1, E_2, E_3, > 0
    nu : Poisson's ratios nu_12, nu_13, nu_23: a stress along 1 strains 2 by -nu_12 / E_1
    G : shear moduli G_12, G_13, G_23, > 0
    rho : density, >= 0
    """

    E: Annotated[tuple[float, float, float], numbers("three values of E", THREE)]
    nu: Annotated[tuple[float, float, float], numbers("three values of nu", THREE)]
    G: Annotated[tuple[float, float, float], numbers("three values of G", THREE)]
    rho: Annotated[float, DENSITY]

    def __post_init__(self) -> None:
        for name, value in (("E", self.E), ("G", self.G)):
            if len(value) != 3 or not min(value) > 0:
                raise FemError(f"material: {name} must be three values > 0, found {value!r}")
        if len(self.nu) != 3 or not self.rho >= 0:
            expected = "three Poisson's ratios and rho >= 0"
            raise FemError(f"material: expected {expected}, found {self.nu!r} and {self.rho!r}")
        if not np.linalg.eigvalsh(self.compliance()[:3, :3] * max(self.E))[0] > 0:
            what = "nu must leave the elasticity positive definite"
            raise FemError(f"material: {what}, found {self.nu!r}")

    def compliance(self) -> Floats:
        """Return S (6, 6), strains of stresses 11, 22, 33, 23, 13, 12 (engineering shear)."""
        return _compliance(self.E, self.nu, self.G)


def _compliance(E: Sequence[float], nu: Sequence[float], G: Sequence[float]) -> Floats:
    S = np.diag([*(1 / np.array(E)), 1 / G[2], 1 / G[1], 1 / G[0]])
    for (i, j), each in zip(((0, 1), (0, 2), (1, 2)), nu, strict=True):
        S[i, j] = S[j, i] = -each / E[i]
    return S


@dataclass(frozen=True)
class Section:
    """Section constants of a beam; lengths in the unit of the nodes.

    Raises FemError if a constant is not positive.

    Attributes
    ----------
    A, I_y, I_z, J : area, second moments of area and torsion constant, all > 0
    kappa_y, kappa_z : shear correction factors for deflection along y and z; `inf` leaves out shear
        deformation
    shear_centre : its y and z, from the centroid
    """

    A: Length
    I_y: Length
    I_z: Length
    J: Length
    kappa_y: Factor = 5 / 6
    kappa_z: Factor = 5 / 6
    shear_centre: Annotated[tuple[float, float], numbers("its y and z", PAIR)] = (0.0, 0.0)

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if name != "shear_centre" and not value > 0:
                raise FemError(f"section: {name} must be > 0, found {value!r}")


def rectangle(b_y: Length, b_z: Length) -> Section:
    """Solid rectangle, b_y along local y and b_z along local z.

    J is Saint-Venant's series (S. Timoshenko, J. N. Goodier, "Theory of Elasticity", sec. 109).
    """
    long, short = max(b_y, b_z), min(b_y, b_z)
    n = np.arange(1, 40, 2)
    series = float(np.sum(np.tanh(n * np.pi * long / (2 * short)) / n**5))
    J = long * short**3 * (1 / 3 - 64 / np.pi**5 * short / long * series)
    return Section(b_y * b_z, b_y * b_z**3 / 12, b_y**3 * b_z / 12, J)


def hollow_rectangle(b_y: Length, b_z: Length, wall: Length) -> Section:
    """Rectangular tube of outer sides b_y, b_z; J after Bredt, shear on the webs alone.

    Raises FemError if the walls meet: 2 wall >= min(b_y, b_z).
    """
    if 2 * wall >= min(b_y, b_z):
        raise FemError(f"section: wall must be < {min(b_y, b_z) / 2}, found {wall}")
    i_y, i_z = b_y - 2 * wall, b_z - 2 * wall
    A = b_y * b_z - i_y * i_z
    middle_y, middle_z = b_y - wall, b_z - wall
    J = 2 * wall * (middle_y * middle_z) ** 2 / (middle_y + middle_z)
    I_y, I_z = (b_y * b_z**3 - i_y * i_z**3) / 12, (b_z * b_y**3 - i_z * i_y**3) / 12
    return Section(A, I_y, I_z, J, 2 * wall * b_y / A, 2 * wall * b_z / A)


def circle(diameter: Length) -> Section:
    """Solid circle; shear factor 9/10."""
    moment = np.pi * diameter**4 / 64
    return Section(np.pi * diameter**2 / 4, moment, moment, 2 * moment, 0.9, 0.9)


def tube(diameter: Length, wall: Length) -> Section:
    """Circular tube of outer diameter; shear factor 1/2 of a thin wall.

    Raises FemError if the wall is not thinner than the radius.
    """
    inner = diameter - 2 * wall
    if not 0 < inner < diameter:
        raise FemError(f"section: wall must be between 0 and {diameter / 2}, found {wall}")
    moment = np.pi * (diameter**4 - inner**4) / 64
    return Section(np.pi * (diameter**2 - inner**2) / 4, moment, moment, 2 * moment, 0.5, 0.5)
