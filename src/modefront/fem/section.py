"""Materials, and sections of beams with their constants.

Sections of beams are constants about principal axes y and z through the centroid. Their warping is
free: where it is held, open thin walls twist less than beams. Units are consistent ones.
"""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from modefront import options as opt
from modefront._typing import Floats
from modefront.errors import wrong

DENSITY = opt.number("a density of 0 or more", least=0)
Length = Annotated[float, opt.number("a number above 0", above=0)]
Factor = Annotated[
    float,
    opt.Requirement("a shear factor above 0", {"type": "number", "exclusiveMinimum": 0}, float),
]
POSITIVE = opt.array(opt.ABOVE_ZERO, 3, 3)


class Elastic(opt.Checked):
    """What materials have in common."""

    def compliance(self) -> Floats:
        """Return S (6, 6), strains of stresses 11, 22, 33, 23, 13, 12 (engineering shear)."""
        own: Any = self
        E, nu, G = (np.broadcast_to(x, 3) for x in (own.E, own.nu, own.G))
        S = np.diag(1 / np.concatenate([E, G[::-1]]))
        for (i, j), each in zip(((0, 1), (0, 2), (1, 2)), nu, strict=True):
            S[i, j] = S[j, i] = -each / E[i]
        return S


@dataclass(frozen=True)
class Material(Elastic):
    """Isotropic material, in consistent units (SI: Pa, -, kg/m^3).

    Raises InputError if a value is outside its range.

    Attributes
    ----------
    E : Young's modulus, > 0
    nu : Poisson's ratio, -1 < nu < 0.5
    rho : density, >= 0
    """

    E: Annotated[float, opt.number("Young's modulus above 0", above=0)]
    nu: Annotated[float, opt.number("Poisson's ratio between -1 and 0.5", above=-1, below=0.5)]
    rho: Annotated[float, DENSITY]

    @property
    def G(self) -> float:
        """Shear modulus E / (2 (1 + nu))."""
        return self.E / (2 * (1 + self.nu))


@dataclass(frozen=True)
class Orthotropic(Elastic):
    """Orthotropic material, such as wood or a laminate, by its axes 1, 2 and 3.

    Raises InputError if a value is outside its range, or the elasticity matrix is not positive
    definite.

    Attributes
    ----------
    E : Young's moduli E_1, E_2, E_3, > 0
    nu : Poisson's ratios nu_12, nu_13, nu_23: a stress along 1 strains 2 by -nu_12 / E_1
    G : shear moduli G_12, G_13, G_23, > 0
    rho : density, >= 0
    """

    E: Annotated[tuple[float, float, float], opt.numbers("three values of E above 0", POSITIVE)]
    nu: Annotated[
        tuple[float, float, float], opt.numbers("three values of nu", opt.array(opt.NUMBER, 3, 3))
    ]
    G: Annotated[tuple[float, float, float], opt.numbers("three values of G above 0", POSITIVE)]
    rho: Annotated[float, DENSITY]

    def __post_init__(self) -> None:
        super().__post_init__()
        if not np.linalg.eigvalsh(self.compliance()[:3, :3] * max(self.E))[0] > 0:
            raise wrong("nu", "ratios that leave the elasticity positive definite", self.nu)


@dataclass(frozen=True)
class Section(opt.Checked):
    """Section constants of a beam; lengths in the unit of the nodes.

    Raises InputError if a constant is not positive.

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
    shear_centre: Annotated[tuple[float, float], opt.numbers("its y and z", opt.PAIR)] = (0.0, 0.0)


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

    Raises InputError if the walls meet: 2 wall >= min(b_y, b_z).
    """
    if 2 * wall >= min(b_y, b_z):
        raise wrong("wall", f"less than {min(b_y, b_z) / 2}", wall)
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

    Raises InputError if the wall is not thinner than the radius.
    """
    inner = diameter - 2 * wall
    if not 0 < inner < diameter:
        raise wrong("wall", f"between 0 and {diameter / 2}", wall)
    moment = np.pi * (diameter**4 - inner**4) / 64
    return Section(np.pi * (diameter**2 - inner**2) / 4, moment, moment, 2 * moment, 0.5, 0.5)
