r"""Models of which stiffness and mass matrix are a Python function of the parameters.

At each :math:`\theta_0` the model is replaced by the affine one that has the same matrices and the
same first derivatives there, so that modes, their derivatives and responses are those of the
function itself. Derivatives that the function does not return are complex steps of it
(``docs/methods/derivatives.md``), in which nothing cancels: they are exact to rounding. A function
that loses the imaginary part on its way (``abs``, an array of real numbers that is filled) returns
wrong derivatives and says nothing. Those at the nominal values, the user's own as well, are
therefore compared with differences.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.exceptions import ComplexWarning
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, issparse

from modefront._typing import Floats
from modefront.errors import InputError, ModelError, refuse, wrong
from modefront.linalg.affine import DenseAffine, Monomials, SparseAffine, sparse_affine
from modefront.models.base import LoadCase, Transfer, passed_on
from modefront.models.matrices import (
    DENSE,
    MatrixModel,
    SensorSpec,
    select,
    symmetrised,
    weights_of,
)
from modefront.models.parameters import Parameter
from modefront.modes.result import FullModes, Modes
from modefront.options import each_once
from modefront.text import Shown, brief_model
from modefront.work.transfer import shared

Matrix: TypeAlias = Any  # (N, N): an array, nested lists of numbers, or a sparse matrix of scipy

MatrixFunction: TypeAlias = Callable[
    [NDArray[Any]],
    tuple[Matrix, Matrix] | tuple[Matrix, Matrix, Sequence[Matrix], Sequence[Matrix]],
]
"""A function of theta (parameters,) that returns K and M, or K, M and lists of dK and dM."""

Tangent: TypeAlias = tuple[Any, tuple[Any, ...]]
"""A matrix (N, N) at one theta, an array of a small model, else a sparse one, and its derivatives:
one a parameter, None for one without effect."""

DIFFERENCE = 1e-6  # step of the differences, over the range of the parameter

RETURNED = "K and M, or K, M and lists of their derivatives dK and dM"


@dataclass(frozen=True)
class CheckedFunction:
    """A user's function of theta that returns matrices."""

    function: MatrixFunction  # returns K and M, or K, M and lists of their derivatives
    names: tuple[str, ...]  # names of the parameters

    def at(
        self, theta: Floats, size: int | None, *, derivatives: bool = True
    ) -> tuple[Tangent, Tangent]:
        """Return K and M, of ``size`` N if that is known, with derivatives; else InputError."""
        place = self._place(theta)
        returned = self._call(theta.copy(), place, RETURNED)
        K = _checked(returned[0], f"{place}: K", size)
        M = _checked(returned[1], f"{place}: M", K.shape[0])
        if not derivatives:
            return (K, ()), (M, ())
        if len(returned) == 4:
            given = zip(returned[2:], ("dK", "dM"), strict=True)
            dK, dM = (self._listed(x, f"{place}: {what}", K.shape[0]) for x, what in given)
        else:
            steps = (self._complex_step(theta, i, K.shape[0]) for i in range(theta.size))
            dK, dM = zip(*steps, strict=True)
        return (K, dK), (M, dM)

    def check_derivatives(
        self, theta: Floats, lower: Floats, upper: Floats, known: tuple[Tangent, Tangent]
    ) -> None:
        """Raise InputError where derivatives differ by far from differences within the bounds."""
        for i, (name, span) in enumerate(zip(self.names, upper - lower, strict=True)):
            ahead, h = theta.copy(), DIFFERENCE * span
            ahead[i] += h if theta[i] + h <= upper[i] else -h
            moved = self.at(ahead, known[0][0].shape[0], derivatives=False)
            for what, (shifted, _), (nominal, slopes) in zip("KM", moved, known, strict=True):
                difference = (shifted - nominal) / (ahead[i] - theta[i])
                if found := _wrong_entry(nominal, slopes[i], difference, span):
                    expected = f"derivatives of the matrices that {what} has, or, where none are "
                    expected += "returned, a function that keeps the imaginary part of complex "
                    expected += "parameters"
                    place = f"{self._place(theta)}: derivative of {what} with respect to {name}"
                    raise wrong(place, expected, found)

    def _complex_step(self, theta: Floats, i: int, size: int) -> tuple[Any, Any]:
        # The square of the step drowns in rounding, and division by it is exact.
        h = 2.0 ** (float(np.frexp(theta[i])[1]) - 70)
        moved = theta.astype(complex)
        moved[i] += 1j * h
        place = f"{self._place(theta)}, complex {self.names[i]}"
        expected = "a function that takes complex parameters, or that returns K, M, dK and dM"
        with warnings.catch_warnings(action="error", category=ComplexWarning):
            returned = self._call(moved, place, expected)
        dK, dM = (
            _checked(A, f"{place}: {what}", size, real=False).imag / h
            for what, A in zip("KM", returned[:2], strict=True)
        )
        return dK if abs(dK).max() > 0 else None, dM if abs(dM).max() > 0 else None

    def _listed(self, slopes: Any, place: str, size: int) -> tuple[Any, ...]:
        listed = isinstance(slopes, Sequence | np.ndarray)
        if not listed or len(slopes) != len(self.names):
            expected = f"a list of {len(self.names)} derivatives, one a parameter"
            raise wrong(place, expected, len(slopes) if listed else type(slopes).__name__)
        return tuple(
            None if slope is None else _checked(slope, f"{place} of {name}", size)
            for name, slope in zip(self.names, slopes, strict=True)
        )

    def _call(self, theta: NDArray[Any], place: str, expected: str) -> Any:
        try:
            returned = self.function(theta)
        except (ModelError, InputError):
            raise
        except Exception as error:  # a user's function may raise anything
            raise wrong(place, expected, f"{type(error).__name__}: {error}") from error
        listed = isinstance(returned, tuple | list)
        if not listed or len(returned) not in (2, 4):
            found = f"{len(returned)} values" if listed else type(returned).__name__
            raise wrong(place, RETURNED, found)
        return returned

    def _place(self, theta: Floats) -> str:
        shown = [f"{name} = {x:g}" for name, x in zip(self.names[:6], theta, strict=False)]
        return f"matrices({', '.join(shown + ['...'] * (len(self.names) > 6))})"


@shared
@dataclass(frozen=True, eq=False, repr=False)
class FunctionModel(Shown):
    """A model whose matrices are a function of the parameters; `function_model` makes it."""

    function: CheckedFunction  # returns K and M with their derivatives
    nominal: MatrixModel  # the affine model at the nominal values of the parameters

    __repr__ = brief_model

    unused = ()  # on which parameters a function does not depend is not known
    parameters = passed_on("nominal", "parameters")
    sensors = passed_on("nominal", "sensors")
    size = passed_on("nominal", "size")
    places = passed_on("nominal", "places")
    directions = passed_on("nominal", "directions")
    selection = passed_on("nominal", "selection")
    footprint = passed_on("nominal", "footprint")

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``; see `modefront.models.base.Model`."""
        modes = self.at(theta, derivatives=derivatives).modes(theta, count, derivatives=derivatives)
        if modes.derivatives is None:
            return modes
        # The second derivatives of the affine model are not those of the function.
        return replace(modes, derivatives=replace(modes.derivatives, second=None))

    def full_modes(self, theta: Floats, count: int) -> FullModes:
        """Return the ``count`` lowest modes at all degrees of freedom; see `MatrixModel`."""
        return self.at(theta, derivatives=False).full_modes(theta, count)

    def transfer(self, theta: Floats, count: int, load_case: LoadCase) -> Transfer:
        """Return the model in a load case; see `modefront.models.base.Model`."""
        return self.at(theta, derivatives=False).transfer(theta, count, load_case)

    def at(self, theta: Floats, *, derivatives: bool = True) -> MatrixModel:
        """Return the affine model with the same matrices and first derivatives at ``theta``.

        Without ``derivatives`` its matrices are constant. Raises InputError where the function does
        not return such matrices; a ModelError of the function is passed on.
        """
        known = self.function.at(theta, self.size, derivatives=derivatives)
        K, M = (_affine(A, theta) for A in known)
        out = replace(self.nominal, stiffness=K, mass=M)
        if isinstance(K, SparseAffine) and isinstance(M, SparseAffine):
            pencil = self.nominal.pencil
            if K.has_pattern_of(pencil.K) and M.has_pattern_of(pencil.M):
                # The analysis costs more than a factorisation, and is that of the pattern alone.
                vars(out)["pencil"] = replace(pencil, K=K, M=M)
        return out


def function_model(
    parameters: Sequence[Parameter],
    sensors: Mapping[str, SensorSpec],
    matrices: MatrixFunction,
    *,
    outputs: Mapping[str, SensorSpec] | None = None,
    base: Mapping[str, SensorSpec] | None = None,
) -> FunctionModel:
    """Return the model whose stiffness and mass matrix are a function of the parameters.

    The function is called at the nominal values at once, so that its errors show here.

    Parameters
    ----------
    parameters
        The parameters, in the order of ``theta``; `updating_problem` takes the same ones.
    sensors
        For the name of each sensor, in the order of the measured shapes, a degree of freedom
        counted from 0, or pairs (degree of freedom, weight) that are summed.
    matrices
        Function of ``theta``, shape (parameters,), that returns ``K, M`` or ``K, M, dK, dM``.
        ``K`` and ``M`` are the stiffness and the mass matrix, (N, N), symmetric, dense or
        scipy-sparse, in consistent units: eigenvalues of K with respect to M are in (rad/s)².
        ``dK`` and ``dM`` are lists of their derivatives, one a parameter, None for a parameter
        without effect. Where they are not returned, they are complex steps of the function:
        it is called with complex ``theta`` and has to calculate with complex numbers throughout
        (``np.zeros((N, N), dtype=theta.dtype)``, no ``abs``, no comparisons). The function raises
        `modefront.ModelError` where there is no model.
    outputs
        Places besides the sensors that predictions may name, in the form of ``sensors``.
    base
        For the name of each direction in which the base can move, the degrees of freedom that move
        with it and how far, in the form of ``sensors``.

    Raises
    ------
    InputError
        If the function raises anything but ModelError or returns something else, if it cannot be
        called with complex numbers or its derivatives are not those of its matrices, and for
        degrees of freedom that there are not.

    Examples
    --------
    A cantilever of length L with a tip mass, EI = 3 N m² and 1 kg:

    >>> import modefront as mf
    >>> length = mf.Parameter("L", nominal=2.0, bounds=(1.0, 4.0))
    >>> model = mf.function_model(
    ...     [length], {"tip": 0}, lambda theta: ([[9 / theta[0] ** 3]], [[1.0]])
    ... )
    >>> model.modes(np.array([2.0]), 1).dlam.tolist()  # -27 / L^4
    [[-1.6875]]
    """
    if not parameters:
        raise wrong("parameters", "at least one", "none")
    refuse(each_once("parameters", [each.name for each in parameters]))
    function = CheckedFunction(matrices, tuple(each.name for each in parameters))
    theta, lower, upper = np.array([(each.nominal, *each.bounds) for each in parameters]).T.copy()
    K, M = function.at(theta, None)
    function.check_derivatives(theta, lower, upper, (K, M))
    size = int(K[0].shape[0])
    named = function.names, tuple(sensors), select(sensors, size)
    others = weights_of(outputs, size, "outputs"), weights_of(base, size, "base")
    nominal = MatrixModel(*named, _affine(K, theta), _affine(M, theta), *others)
    return FunctionModel(function, nominal)


def _affine(known: Tangent, theta: Floats) -> DenseAffine | SparseAffine:
    matrix, each = known
    slopes = {i: slope for i, slope in enumerate(each) if slope is not None}
    exponents = np.vstack([np.zeros(theta.size), np.eye(theta.size)[list(slopes)]])
    terms, coefficients = [matrix, *slopes.values()], Monomials(exponents, theta.copy())
    if isinstance(matrix, np.ndarray):
        return DenseAffine(np.array(terms), coefficients)
    return sparse_affine(terms, coefficients, matrix.shape[0])


def _checked(value: Matrix, place: str, size: int | None, real: bool = True) -> Any:
    """Return a symmetric matrix, an array up to `DENSE` degrees of freedom, else a sparse one."""
    try:
        A: Any = value if issparse(value) else np.asarray(value)
    except ValueError:  # lists of different lengths
        raise wrong(place, "a matrix", type(value).__name__) from None
    n = size or (A.shape[0] if A.ndim else 0)
    if A.shape != (n, n) or not n:
        found = " x ".join(map(str, A.shape)) or "a single number"
        raise wrong(place, f"a matrix {size or 'N'} x {size or 'N'}", found)
    if A.dtype.kind not in "biufc":
        raise wrong(place, "numbers", str(A.dtype))
    if real and A.dtype.kind == "c":
        raise wrong(place, "real numbers for real parameters", "complex numbers")
    A = A.astype(complex if A.dtype.kind == "c" else float)
    if A.shape[0] > DENSE:
        A = csr_array(A)
    elif issparse(A):
        A = A.toarray()
    return symmetrised(A, "", place)


def _wrong_entry(A: Any, slope: Any, difference: Any, span: float) -> str:
    """Return the entry that is wrong by most, or nothing; ``span`` is the parameter's range."""
    slope = 0 * A if slope is None else slope
    off = coo_array(difference - slope)
    if not off.nnz:
        return ""
    rows, columns = off.row, off.col
    given, expected = (np.asarray(x[rows, columns]).ravel() for x in (slope, difference))
    diagonal = np.sqrt(np.abs(A.diagonal()))
    # Errors, not digits; differences of entries that hardly change show their curvature.
    allowed = 0.05 * np.maximum(np.abs(given), np.abs(expected))
    allowed += 1e-3 * diagonal[rows] * diagonal[columns] / span
    k = int(np.argmax(np.abs(off.data) - allowed))
    if abs(off.data[k]) <= allowed[k]:
        return ""
    return (
        f"{given[k]:.6g} in row {rows[k]}, column {columns[k]} (from 0) where the difference of "
        f"two matrices is {expected[k]:.6g}"
    )
