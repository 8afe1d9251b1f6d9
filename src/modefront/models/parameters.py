r"""The parameters that are updated, and the names of terms of affine matrices in them.

.. math:: A(\theta) = A_0 + \sum_k c_k(\theta) A_k, \qquad c_k(\theta) = \prod_i \theta_i^{e_{ki}}

A term is written ``E``, ``t^3``, ``1/L``, ``E*t^3`` or ``E*t/L^2``. A name of a parameter always
stands for the parameter, whatever characters are in it.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

import numpy as np

from modefront import options
from modefront._typing import Floats
from modefront.errors import Fault, InputError, refuse, wrong
from modefront.text import Shown

BOUNDS = options.numbers(
    "[lower, upper], two finite numbers with lower < upper", options.PAIR, options.rising
)


@dataclass(frozen=True)
class Prior(options.Checked):
    """What is expected of a parameter before the data are seen: it lies about its nominal value.

    Attributes
    ----------
    kind : the distribution of the parameter is normal, or lognormal, that of its logarithm
    std : standard deviation, in the unit of the parameter; of the logarithm where it is lognormal
    """

    kind: Literal["normal", "lognormal"] = "normal"
    std: Annotated[float, options.number("a number above 0", above=0)] = 0.2


@dataclass(frozen=True)
class Parameter(Shown):
    """A parameter of a model.

    Raises InputError for bounds of no width and for a nominal value beyond them.

    Attributes
    ----------
    name : name of the parameter in the model
    nominal : nominal value, at which the search starts, in the unit of the model
    bounds : lower and upper bound, finite, in the same unit
    prior : what is expected of it; None for any value within the bounds
    fixed : whether it stays at its nominal value
    tie : name of the parameter whose value it has, within the bounds of that one; empty for a value
        of its own
    """

    name: Annotated[str, options.text("the name of the parameter")]
    nominal: Annotated[float, options.number("a finite number")]
    bounds: Annotated[tuple[float, float], BOUNDS]
    prior: Annotated[Prior, options.nested("a table of kind and std", Prior)] | None = None
    fixed: Annotated[bool, options.TRUE_OR_FALSE] = False
    tie: Annotated[str, options.Requirement("the name of a parameter", {"type": "string"})] = ""

    def __post_init__(self) -> None:
        options.check_fields(self)
        if not self.lower <= self.nominal <= self.upper:
            inside = f"a value within its bounds, {self.lower:g} to {self.upper:g}"
            raise wrong("nominal", inside, f"{self.nominal:g}")
        if self.prior and self.prior.kind == "lognormal" and self.lower <= 0:
            raise wrong("bounds", "a lower bound above 0, as the prior is lognormal", self.lower)
        if self.fixed and self.tie:
            raise wrong("tie", "no 'tie' of a parameter that is fixed", f"'{self.tie}'")
        if self.tie and self.prior:
            raise wrong("prior", f"none beside the tie to '{self.tie}'", self.prior.kind)

    @property
    def free(self) -> bool:
        """Whether it has a value of its own, which is sought."""
        return not (self.fixed or self.tie)

    @property
    def lower(self) -> float:
        """The lower bound."""
        return self.bounds[0]

    @property
    def upper(self) -> float:
        """The upper bound."""
        return self.bounds[1]


def parameters_of(
    bounds: Mapping[str, tuple[float, float]], nominal: Mapping[str, float]
) -> list[Parameter]:
    """Return the parameters with these bounds and nominal values; InputError with all faults."""
    out, faults = [], list[Fault]()
    for name in dict.fromkeys([*bounds, *nominal]):
        known: Any = nominal.get(name), bounds.get(name)
        try:
            out.append(Parameter(name, *known))
        except InputError as error:
            faults += [replace(x, place=f"{x.place} of '{name}'") for x in error.faults]
    refuse(faults)
    return out


def in_order(parameters: Sequence[Parameter], names: Sequence[str]) -> list[Parameter]:
    """Return the parameters of these names, in this order.

    Raises InputError where one is missing or given twice. Others are left out.
    """
    given = {parameter.name: parameter for parameter in parameters}
    missing = [name for name in names if name not in given]
    twice = options.each_once("parameters", [parameter.name for parameter in parameters])
    refuse([*twice, *(Fault("", "parameters", f"one called '{x}'", "none") for x in missing)])
    return [given[name] for name in names]


def wrong_ties(where: str, parameters: Sequence[Parameter]) -> Iterator[Fault]:
    """Yield what is wrong with parameters that are not free: their ties, and that all are."""
    free = {parameter.name: parameter for parameter in parameters if parameter.free}
    for each in parameters:
        other = free.get(each.tie)
        if each.tie and not other:
            expected = "the name of a parameter that is neither fixed nor tied"
            yield Fault("", f"{where} '{each.name}' tie", expected, f"'{each.tie}'")
        elif other and other.nominal != each.nominal:
            expected = f"{other.nominal:g} as of '{other.name}', to which it is tied"
            yield Fault("", f"{where} '{each.name}' nominal", expected, f"{each.nominal:g}")
    if parameters and not free:
        yield Fault("", where, "one that is neither fixed nor tied", "none")


BASE = "base"  # name of the term that does not depend on the parameters

_POWER = re.compile(r"(?P<name>.*?)\s*(?:\^|\*\*)\s*(?P<power>[+-]?\d+(?:\.\d+)?)")


def exponents_of(term: str, parameters: Sequence[str]) -> Floats | None:
    """Return the exponents (parameters,) of a term, or None where it is not of the right form."""
    out, names, sign = np.zeros(len(parameters)), list(parameters), 1.0
    if term == BASE:
        return out
    for part in [term] if term in names else re.split(r"(/|(?<!\*)\*(?!\*))", term):
        factor = part.strip()
        match = _POWER.fullmatch(factor)
        if factor in ("*", "/"):
            sign = 1.0 if factor == "*" else -1.0
        elif factor in names:
            out[names.index(factor)] += sign
        elif match and match["name"] in names:
            out[names.index(match["name"])] += sign * float(match["power"])
        elif factor != "1":
            return None
    return out if out.any() else None


def form_of(term: str) -> str:
    """Return the expected form of the name of a term, for a message."""
    if any(sign in term for sign in "^*/"):
        return f"'{BASE}', a parameter, or a product of powers of parameters"
    return f"'{BASE}' or a parameter (in a study file, the name of a [[parameter]])"


def term_exponents(terms: Sequence[str], parameters: Sequence[str]) -> Floats:
    """Return the exponents (terms, parameters) of terms that are all of the right form."""
    rows = [exponents_of(term, parameters) for term in terms]
    return np.array(rows, dtype=float).reshape(len(terms), len(parameters))
