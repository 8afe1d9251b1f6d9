r"""Names of the terms of an affine matrix: ``base``, a parameter, or a product of their powers.

.. math:: A(\theta) = A_0 + \sum_k c_k(\theta) A_k, \qquad c_k(\theta) = \prod_i \theta_i^{e_{ki}}

A term is written ``E``, ``t^3``, ``1/L``, ``E*t^3`` or ``E*t/L^2``. A name of a parameter always
stands for the parameter, whatever characters are in it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from modefront._typing import Floats

BASE = "base"
"""Name of the term that does not depend on the parameters."""

SIGNS = "^*/"
"""Signs of products and powers."""

_POWER = re.compile(r"(?P<name>.*?)\s*(?:\^|\*\*)\s*(?P<power>[+-]?\d+(?:\.\d+)?)")


def exponents_of(term: str, parameters: Sequence[str]) -> Floats | None:
    """Return the exponents (parameters,) of a term, or None where it is not of the right form."""
    out = np.zeros(len(parameters))
    if term == BASE:
        return out
    if term in parameters:
        out[list(parameters).index(term)] = 1.0
        return out
    sign = 1.0
    for part in re.split(r"(/|(?<!\*)\*(?!\*))", term):
        factor = part.strip()
        if factor in ("*", "/"):
            sign = 1.0 if factor == "*" else -1.0
            continue
        powers = _factor(factor, parameters)
        if powers is None:
            return None
        name, power = powers
        if name:
            out[list(parameters).index(name)] += sign * power
    return out if out.any() else None


def form_of(term: str) -> str:
    """Return the expected form of the name of a term, for a message."""
    if any(sign in term for sign in SIGNS):
        return f"'{BASE}', a parameter, or a product of powers of parameters"
    return f"'{BASE}' or a parameter"


def _factor(text: str, parameters: Sequence[str]) -> tuple[str, float] | None:
    """Return the parameter, empty for 1, and the power of one factor; None where there is none."""
    if text in parameters:
        return text, 1.0
    if text == "1":
        return "", 1.0
    match = _POWER.fullmatch(text)
    if match and match["name"] in parameters:
        return match["name"], float(match["power"])
    return None


def term_exponents(terms: Sequence[str], parameters: Sequence[str]) -> Floats:
    """Return the exponents (terms, parameters) of terms that are all of the right form.

    Raises ValueError for one that is not.
    """
    out = np.zeros((len(terms), len(parameters)))
    for row, term in enumerate(terms):
        exponents = exponents_of(term, parameters)
        if exponents is None:
            raise ValueError(f"expected {form_of(term)}, found {term!r}")
        out[row] = exponents
    return out


def above_zero(exponents: Floats) -> list[int]:
    """Return the parameters that have to be above 0 where there are roots or quotients of them."""
    away = (exponents < 0) | (exponents % 1 != 0)
    return np.flatnonzero(away.any(axis=0)).tolist()
