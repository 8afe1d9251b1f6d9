r"""Models given by their matrices: :math:`K(\theta) = K_0 + \sum_j c_j(\theta) K_j`, M likewise."""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import compress
from typing import Any, TypeAlias

import numpy as np
from scipy.sparse import coo_array, csr_array, issparse, lil_array, sparray

from modefront._typing import Floats
from modefront.errors import Fault, InputError, refuse, suggestion, wrong
from modefront.linalg.affine import DenseAffine, Members, Monomials, SparseAffine, sparse_affine
from modefront.linalg.factorisation import Pencil, SingularMatrixError, pencil
from modefront.linalg.products import gram
from modefront.models.base import LoadCase, Model, NamedWeights, Transfer, passed_on
from modefront.models.geometry import Geometry
from modefront.models.parameters import (
    BASE,
    Parameter,
    exponents_of,
    form_of,
    term_exponents,
    wrong_ties,
)
from modefront.modes import dense, sparse
from modefront.modes.result import FullModes, Modes
from modefront.options import NUMBER, WHOLE, any_of, array, whole
from modefront.rounding import LARGEST, SYMMETRY
from modefront.text import Shown, brief_model
from modefront.work.task import Costs, spend
from modefront.work.transfer import shared

DENSE = 180  # degrees of freedom up to which dense matrices are faster
ARRAYS = 8  # matrices N x N of a dense solution: K, M, their factors, the modes and workspace
FACTOR = 40  # entries of a sparse solution, its two factors and all else, over N^(4/3)

SensorSpec = int | Sequence[tuple[int, float]]
"""A sensor: a degree of freedom, counted from 0, or weighted degrees of freedom."""

DOF = whole(0, WHOLE).schema
WEIGHTED = any_of(DOF, array(array([DOF, NUMBER], 2, 2), 1))  # schema of a `SensorSpec` in a file

Matrix: TypeAlias = Floats | sparray


@contextmanager
def _eigenproblem() -> Iterator[None]:
    spend(Costs(eigenproblems=1))
    started = time.perf_counter()
    try:
        yield
    finally:
        spend(Costs(full_time=time.perf_counter() - started))


# 11 fields: the matrices, and what else is known of the structure, which is optional.
@shared
@dataclass(frozen=True, eq=False, repr=False)
class MatrixModel(Shown):
    """A model with affine stiffness and mass matrices, both dense or both sparse."""

    parameters: tuple[str, ...]  # names of the parameters
    sensors: tuple[str, ...]  # names of the sensors
    selection: csr_array  # (sensors, N) weights of the degrees of freedom at each sensor
    stiffness: DenseAffine | SparseAffine  # stiffness, mass: K(theta), M(theta), N x N
    mass: DenseAffine | SparseAffine
    # weights (N,) of the degrees of freedom at places that are no sensors, by name
    outputs: Mapping[str, Floats] = field(default_factory=dict)
    # motion (N,) of the degrees of freedom with the base, by the name of its direction
    base: Mapping[str, Floats] = field(default_factory=dict)
    floating: bool = True  # whether K may be singular: rigid-body modes are wanted
    limits: tuple[str, ...] = ()  # warnings on the elements of which the matrices are made
    geometry: Geometry | None = None  # of the degrees of freedom; None where it is not known
    # returns what members add to the terms of the matrices; None where that is not known
    members: Callable[[], Sequence[Members]] | None = None

    __repr__ = brief_model

    size = passed_on("stiffness", "size")

    @property
    def footprint(self) -> float:
        """Bytes that an eigensolution takes, estimated; factors of solids fill in the most."""
        return 8.0 * (ARRAYS * self.size**2 if self._dense else FACTOR * self.size ** (4 / 3))

    @property
    def above_zero(self) -> tuple[str, ...]:
        """Names of parameters that have to be above 0: there are roots or quotients of them."""
        e = np.vstack([A.coefficients.exponents for A in (self.stiffness, self.mass)])
        return tuple(compress(self.parameters, ((e < 0) | (e % 1 != 0)).any(axis=0)))

    @property
    def unused(self) -> tuple[str, ...]:
        """Names of parameters on which neither matrix depends."""
        used = self.stiffness.used | self.mass.used
        return tuple(self.parameters[i] for i in np.flatnonzero(~used))

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``; see `modefront.models.base.Model`."""
        with _eigenproblem():
            if self._dense:
                return dense.modes(*self._dense, theta, count, derivatives)
            return sparse.modes(self.pencil, self.selection, theta, count, derivatives)

    def full_modes(self, theta: Floats, count: int, loads: Floats | None = None) -> FullModes:
        """Return the ``count`` lowest modes at all degrees of freedom, and static responses.

        ``loads`` are (N, loads), none unless given. Raises ModelError where the model has no such
        modes.
        """
        columns = np.zeros((self.size, 0)) if loads is None else loads
        with _eigenproblem():
            if self._dense:
                return dense.full_modes(*self._dense[:2], theta, count, columns)
            return sparse.full_modes(self.pencil, theta, count, columns)

    def modes_below(self, theta: Floats, frequency: float) -> int:
        """Return how many modes are below a frequency in Hz (Sylvester's law); 0 if unknown."""
        level = (2 * np.pi * frequency) ** 2
        if self._dense:
            K, M, _ = self._dense
            return int((np.linalg.eigvalsh(K.at(theta) - level * M.at(theta)) < 0).sum())
        with suppress(SingularMatrixError):
            K, M = (A.at(theta).data for A in (self.pencil.K, self.pencil.M))
            return self.pencil.factor(K, M, level).negative or 0
        return 0

    def at(self, _: Floats) -> "MatrixModel":
        """Return the model itself: its matrices are known at all parameters."""
        return self

    def is_singular(self, theta: Floats) -> bool:
        """Return whether K(theta) is singular to working precision."""
        if self._dense:
            return dense.is_singular(self._dense[0].at(theta))
        return sparse.regular_factor(self.pencil, theta) is None

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the sensors and of the other outputs."""
        return (*self.sensors, *self.outputs)

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of the directions in which the base can move."""
        return tuple(self.base)

    def transfer(self, theta: Floats, count: int, load_case: LoadCase) -> Transfer:
        """Return the model in a load case; see `modefront.models.base.Model`."""
        outputs = self._weights(load_case.outputs)
        if load_case.base is None:
            loads, rigid = self._weights(load_case.forces), None
        else:
            motion = self.base[load_case.base][:, None]
            loads, rigid = -(self.mass.at(theta) @ motion), gram(outputs, motion)
        solution = self.full_modes(theta, count, loads)
        return Transfer(
            Modes(solution.lam, self.selection @ solution.Phi),
            input=gram(solution.Phi, loads),
            output=gram(outputs, solution.Phi),
            static=None if solution.static is None else gram(outputs, solution.static),
            rigid=rigid,
        )

    def _weights(self, sums: Sequence[NamedWeights]) -> Floats:
        """Return weighted sums of sensors and outputs as columns (N, sums)."""
        out = np.zeros((self.size, len(sums)))
        for column, weights in zip(out.T, sums, strict=True):
            for name, weight in weights.items():
                own = self.sensors.index(name) if name in self.sensors else None
                row = self.outputs[name] if own is None else self.selection[[own]].toarray()[0]
                column += weight * row
        return out

    def held(self, fixed: Mapping[str, float], tied: Mapping[str, str]) -> "MatrixModel":
        """Return the model as a function of the other parameters.

        ``fixed`` parameters have one value, and ``tied`` ones that of another parameter, which is
        neither. Raises KeyError for a name that is no parameter.
        """
        index = {name: j for j, name in enumerate(self.parameters)}
        values = {index[name]: value for name, value in fixed.items()}
        others = {index[name]: index[other] for name, other in tied.items()}
        pair = {"stiffness": self.stiffness, "mass": self.mass}
        scales = {of: A.coefficients.held(values, others)[1] for of, A in pair.items()}
        members = self.members and partial(_scaled, self.members, scales)
        names = tuple(x for x in self.parameters if x not in fixed and x not in tied)
        K, M = (A.held(values, others) for A in (self.stiffness, self.mass))
        return replace(self, members=members, parameters=names, stiffness=K, mass=M)

    def sparse(self) -> "MatrixModel":
        """Return the same model with sparse matrices."""
        if self._dense is None:
            return self
        K, M, _ = self._dense
        return replace(self, stiffness=K.sparse(), mass=M.sparse())

    def compact(self) -> "MatrixModel":
        """Return the same model, with dense matrices where it is so small that these are faster."""
        K, M = self.stiffness, self.mass
        if self.size > DENSE or isinstance(K, DenseAffine) or isinstance(M, DenseAffine):
            return self
        return replace(self, stiffness=K.dense(), mass=M.dense())

    @cached_property
    def _dense(self) -> tuple[DenseAffine, DenseAffine, Floats] | None:
        """K, M and the selection as arrays; None where the matrices are sparse."""
        if isinstance(self.stiffness, DenseAffine) and isinstance(self.mass, DenseAffine):
            return self.stiffness, self.mass, self.selection.toarray()
        return None

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without members and the analysis of the pattern, which is made again."""
        made = ("pencil", "_dense")
        kept = {name: value for name, value in vars(self).items() if name not in made}
        return kept | {"members": None}

    @cached_property
    def pencil(self) -> Pencil:
        """The sparse pencil; its pattern is analysed at the first evaluation, and only then."""
        if isinstance(self.stiffness, DenseAffine) or isinstance(self.mass, DenseAffine):
            raise TypeError("stiffness and mass have to be both dense or both sparse")
        return pencil(self.stiffness, self.mass, partial(spend, Costs(factorisations=1)))


def _scaled(of_all: Callable[[], Sequence[Members]], scales: Mapping[str, Floats]) -> list[Members]:
    """Return members of a model of which the terms of each matrix are scaled."""
    return [
        replace(x, shares=[(j, A * scales[x.of][j][:, None, None]) for j, A in x.shares])
        for x in of_all()
    ]


def of_free(model: Model, parameters: Sequence[Parameter]) -> tuple[Model, tuple[Parameter, ...]]:
    """Return a model as a function of the free ones of its parameters, and these.

    Raises InputError for wrong ties, and where any is held and the model is not one of matrices.
    """
    refuse(wrong_ties("parameters", parameters))
    fixed = {each.name: each.nominal for each in parameters if each.fixed}
    tied = {each.name: each.tie for each in parameters if each.tie}
    if not fixed and not tied:
        return model, tuple(parameters)
    if not isinstance(model, MatrixModel):
        expected = "parameters of their own: only models of matrices have fixed or tied ones"
        raise wrong("parameters", expected, ", ".join([*fixed, *tied]))
    return model.held(fixed, tied), tuple(each for each in parameters if each.free)


# 7 arguments: the matrices and places of a model, the optional ones by keyword.
def matrices(
    parameters: Sequence[str],
    stiffness: Mapping[str, Matrix],
    mass: Mapping[str, Matrix],
    sensors: Mapping[str, SensorSpec],
    *,
    floating: bool = True,
    outputs: Mapping[str, SensorSpec] | None = None,
    base: Mapping[str, SensorSpec] | None = None,
) -> MatrixModel:
    """Return the model with K(theta) = K_0 + sum_j theta_j K_j and M(theta) likewise.

    Parameters
    ----------
    parameters
        Names of the parameters, in the order of theta.
    stiffness, mass
        Symmetric matrices (N, N), dense or scipy-sparse, in consistent units: eigenvalues of K with
        respect to M are in (rad/s)². K_0 is called ``"base"``, K_j by its parameter, or by the
        product of powers of parameters in its place, such as ``"t^3"``, ``"1/L"``, ``"E*t"``; what
        is not given is zero. The mass matrix may be singular (degrees of freedom without mass).
    sensors
        For the name of each sensor, in the order of the measured shapes, a degree of freedom
        counted from 0, or pairs (degree of freedom, weight) that are summed.
    floating
        Whether the structure may have rigid-body modes. `modefront check` reports a singular
        stiffness matrix where it may not.
    outputs
        Places besides the sensors that predictions may name, in the form of ``sensors``.
    base
        For the name of each direction in which the base can move, the degrees of freedom that move
        with it and how far, in the form of ``sensors``.

    Raises
    ------
    InputError
        For a term that is no parameter, matrices of different sizes, and degrees of freedom that
        there are not.

    Examples
    --------
    >>> import modefront as mf
    >>> model = mf.matrices(["k"], {"k": np.array([[4.0]])}, {"base": np.eye(1)}, {"floor": 0})
    >>> model.modes(np.array([1.0]), 1).lam.tolist()
    [4.0]
    """
    size, faults = common_size(parameters, {"stiffness": stiffness, "mass": mass})
    refuse(faults)
    K, M = (affine(parameters, terms, size) for terms in (stiffness, mass))
    others = weights_of(outputs, size, "outputs"), weights_of(base, size, "base")
    named = tuple(parameters), tuple(sensors), select(sensors, size)
    return MatrixModel(*named, K, M, *others, floating).compact()


def affine(parameters: Sequence[str], terms: Mapping[str, Matrix], size: int) -> SparseAffine:
    """Return base + sum_k c_k(theta) A_k for terms named as `modefront.models.parameters` says."""
    coefficients = Monomials(term_exponents(list(terms), parameters))
    return sparse_affine(list(map(coo_array, terms.values())), coefficients, size)


def common_size(
    parameters: Sequence[str], tables: Mapping[str, Mapping[str, Matrix]]
) -> tuple[int, list[Fault]]:
    """Return the N of most terms, which have to be N x N and named, and what is wrong with them."""
    expected = f"names other than '{BASE}', which is the term without parameters"
    faults = [Fault("", "parameters", expected, f"'{BASE}'")] * (BASE in parameters)
    counts = Counter(A.shape[0] for terms in tables.values() for A in terms.values() if A.ndim)
    size = max(counts, key=lambda n: (counts[n], n), default=0)
    for place, terms in tables.items():
        if not terms:
            faults.append(Fault("", place, form_of(""), "nothing"))
        for name, A in terms.items():
            if exponents_of(name, parameters) is None:
                found = suggestion(name, [BASE, *parameters])
                faults.append(Fault("", place, form_of(name), found))
            if A.shape != (size, size):
                expected = f"{size} x {size}, as the other matrices"
                found = " x ".join(map(str, A.shape))
                faults.append(Fault("", f"{place} {name}", expected, found))
    return size, faults


def select(sensors: Mapping[str, SensorSpec], size: int, place: str = "sensors") -> csr_array:
    """Return the weights of the degrees of freedom at each sensor, shape (sensors, N).

    Raises InputError, which names the ``place``, for degrees of freedom that there are not.
    """
    selection = lil_array((len(sensors), size))
    for row, (name, spec) in enumerate(sensors.items()):
        for dof, weight in [(spec, 1.0)] if isinstance(spec, int | np.integer) else spec:
            if not 0 <= dof < size:
                raise wrong(f"{place} '{name}'", f"a degree of freedom from 0 to {size - 1}", dof)
            selection[row, dof] += weight
    return selection.tocsr()


def weights_of(places: Mapping[str, SensorSpec] | None, size: int, place: str) -> dict[str, Floats]:
    """Return the weights (size,) of the degrees of freedom at each of some places, by name."""
    known = places or {}
    return dict(zip(known, select(known, size, place).toarray(), strict=True))


def symmetrised(
    A: Any,
    file: str,
    place: str,
    label: Callable[[int, int], str] = "row {}, column {} (from 0)".format,
) -> Any:
    """Return a matrix, an array or a sparse one, without the rounding in its symmetry.

    Raises InputError, which names the ``file``, the ``place`` and the entry, by its ``label``,
    where a number is not finite and where the matrix is not symmetric.
    """

    def error(B: coo_array, wrong: Floats, expected: str, why: str) -> InputError:
        k = int(np.argmax(wrong))
        i, j = int(B.row[k]), int(B.col[k])
        found = f"{A[i, j]:.6g}"
        found += f", and {A[j, i]:.6g} across the diagonal ({why})" if why else ""
        where = ", ".join(filter(None, (place, label(i, j))))
        return InputError(Fault(file, where, expected, found))

    if not (np.abs(A.data if issparse(A) else A) <= LARGEST).all():
        B = coo_array(A)
        beyond = np.where(np.abs(B.data) <= LARGEST, 0.0, 1.0)
        raise error(B, beyond, f"finite numbers up to {LARGEST:g}", "")
    asymmetry = abs(A - A.T)
    if asymmetry.max() > SYMMETRY * abs(A).max():
        B = coo_array(asymmetry)
        why = "damping, contact, friction and rotors make it unsymmetric"
        raise error(B, B.data, "a symmetric matrix", why)
    return (A + A.T) / 2
