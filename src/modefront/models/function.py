r"""Models of which stiffness and mass matrix are a Python function of the parameters.

At each :math:`\theta_0` the model is replaced by the affine one that has the same matrices and the
same first derivatives there,

.. math:: K(\theta) = K(\theta_0) + \sum_i (\theta_i - \theta_{0i})\, K_i'(\theta_0),

and M likewise: modes, their derivatives and responses at :math:`\theta_0` are those of the function
itself. `modefront.models.checked_function` calls the function and says where its derivatives come
from.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.brief import as_html, brief_model
from modefront.errors import refuse, wrong
from modefront.linalg.affine import DenseAffine, Monomials, SparseAffine, sparse_affine
from modefront.models.base import LoadCase, Transfer, passed_on
from modefront.models.checked_function import CheckedFunction, MatrixFunction, Tangent
from modefront.models.matrices import MatrixModel, SensorSpec, select, weights_of
from modefront.models.parameters import Parameter
from modefront.modes.result import Modes
from modefront.options import each_once
from modefront.work.transfer import shared


@shared
@dataclass(frozen=True, eq=False, repr=False)
class FunctionModel:
    """A model whose matrices are a function of the parameters; `function_model` makes it.

    Attributes
    ----------
    function : returns K and M with their derivatives
    nominal : the affine model at the nominal values of the parameters
    """

    function: CheckedFunction
    nominal: MatrixModel

    __repr__ = brief_model
    _repr_html_ = as_html

    parameters = passed_on("nominal", "parameters")

    sensors = passed_on("nominal", "sensors")

    size = passed_on("nominal", "size")

    @property
    def parts(self) -> tuple[MatrixModel]:
        """The nominal model, which is sent to other processes on its own."""
        return (self.nominal,)

    @property
    def footprint(self) -> float:
        """Bytes that an eigensolution takes, estimated."""
        return self.nominal.footprint

    @property
    def unused(self) -> tuple[str, ...]:
        """No names: on which parameters a function does not depend is not known."""
        return ()

    places = passed_on("nominal", "places")

    directions = passed_on("nominal", "directions")

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``; see `modefront.models.base.Model`."""
        modes = self.at(theta, derivatives=derivatives).modes(theta, count, derivatives=derivatives)
        if modes.derivatives is None:
            return modes
        # The second derivatives of the affine model are not those of the function.
        return replace(modes, derivatives=replace(modes.derivatives, second=None))

    def transfer(self, theta: Floats, count: int, load_case: LoadCase) -> Transfer:
        """Return the model in a load case; see `modefront.models.base.Model`."""
        return self.at(theta, derivatives=False).transfer(theta, count, load_case)

    def at(self, theta: Floats, *, derivatives: bool = True) -> MatrixModel:
        """Return the affine model with the same matrices and first derivatives at ``theta``.

        Without ``derivatives`` its matrices are constant. Raises InputError where the function does
        not return such matrices; a ModelError of the function is passed on.
        """
        K, M = self.function.at(theta, self.size, derivatives=derivatives)
        return self.nominal.with_matrices(_affine(K, theta), _affine(M, theta))


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
    theta = np.array([each.nominal for each in parameters])
    lower, upper = (np.array(ends) for ends in zip(*(x.bounds for x in parameters), strict=True))
    K, M = function.at(theta, None)
    function.check_derivatives(theta, lower, upper, (K, M))
    size = int(K[0].shape[0])
    nominal = MatrixModel(
        function.names,
        tuple(sensors),
        select(sensors, size),
        _affine(K, theta),
        _affine(M, theta),
        weights_of(outputs or {}, size, "outputs"),
        weights_of(base or {}, size, "base"),
    )
    return FunctionModel(function, nominal)


def _affine(known: Tangent, theta: Floats) -> DenseAffine | SparseAffine:
    matrix, each = known
    slopes = {i: slope for i, slope in enumerate(each) if slope is not None}
    exponents = np.zeros((1 + len(slopes), theta.size))
    exponents[1 + np.arange(len(slopes)), list(slopes)] = 1
    terms, coefficients = [matrix, *slopes.values()], Monomials(exponents, theta.copy())
    if isinstance(matrix, np.ndarray):
        return DenseAffine(np.array(terms), coefficients)
    return sparse_affine(terms, coefficients, matrix.shape[0])
