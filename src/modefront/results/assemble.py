"""A front, its analysis, and what the posterior says of the parameters, as one dataset."""

from typing import Any

import numpy as np

from modefront._typing import Bools, Floats
from modefront.analysis.certified import certificate_values
from modefront.analysis.front import FrontAnalysis
from modefront.datasets import ArrayDataset
from modefront.front.dominance import nondominated, undominated
from modefront.front.front import Front
from modefront.front.gaps import branch_numbers
from modefront.front.methods import METHODS
from modefront.front.point import WEIGHTED, Kind, front_points, label, of_kind
from modefront.identifiability.combinations import cosines, determination, index
from modefront.optim.problem import at_bounds
from modefront.residuals.problem import UpdatingProblem
from modefront.results.findings import Determinations, as_values, findings
from modefront.results.schema import FORMAT, Values, described
from modefront.rounding import COMPUTED
from modefront.uncertainty.inference import CHANCE, Inference, excluding, refused
from modefront.uncertainty.prediction import summary
from modefront.uncertainty.prior import NoiseModel, prior_widths
from modefront.uncertainty.sampling import QUANTILES

ITERATED = "iterated-weights"
"""Name of the fixed point of the iteration of the weights, among the minima."""

DETERMINED, OPEN = 1 / 3, 0.8
"""Width of the 90 % interval over that of the prior, below which a parameter is determined, and
above which it is not."""

TRUST = ("determined", "partly", "not determined")  # what the data say of a parameter


def dataset(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> ArrayDataset:
    """Return a front, with all points that are reported, and its analysis as a dataset."""
    reported = [front.reference, *of_kind(front.points, Kind.EDGE)]
    determined = [(x.label, determination(problem, x.solution.evaluation)) for x in reported]
    boundary = METHODS[front.method].programme == "boundary"
    parts = dict.fromkeys((Kind.IDENTIFIABLE, Kind.IDENTIFIABLE_EDGE), "identifiable")
    parts[Kind.FRONT] = "whole" if boundary else ""
    values = _points(problem, front, analysis) | _minima(problem, front)
    values |= _branches(problem, front) | lattice_values(front)
    values["front_part"] = [parts.get(point.kind, "") for point in front.points]
    values["flat"] = analysis.identifiable.flat
    values |= _identifiability(determined) | _equivalent(analysis)
    values |= _scatter(problem, front, analysis) | _posterior(front, analysis)
    values |= _replicates(problem, front, analysis)
    values |= as_values(findings(problem, front, analysis, determined))
    values["measured_frequency"] = problem.data.mean_frequency
    values["properties"], values["exact"] = problem.properties, list(front.exact)
    values["bounds"] = np.column_stack([problem.lower, problem.upper])
    groups, parameters = list(problem.objectives), list(problem.model.parameters)
    coordinates: dict[str, Any] = {
        "parameter": parameters,
        "group": groups,
        "mode": list(problem.data.modes),
        "bound": ["lower", "upper"],
        "parameter_other": parameters,
        "group_other": groups,
    }
    sizes = {name: len(of) for name, of in coordinates.items()}
    attributes = {"format": FORMAT, "reference": front.reference.label}
    return ArrayDataset(described(values, sizes=sizes), attributes).assign_coords(coordinates)


def _points(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Values:
    points, a = front.points, problem.properties
    solutions = [point.solution for point in points]
    theta, J = np.array([x.theta for x in solutions]), np.array([x.J for x in solutions])
    unknown = np.full(len(problem.data.modes), np.nan)
    on = np.array([x.kind is Kind.FRONT for x in points])
    dominated = np.zeros(len(J), dtype=bool)
    if on.any():
        dominated[on] = ~nondominated(J[on], scale=front.scale)
    # All evaluated models are known, minima, ends of branches and equivalent models too. An end
    # that another branch dominates at the same level counts for the points next to it only.
    others = [x.J for edge in front.edges for x in edge.minima] + [x.J for x in front.optimal]
    others += [x.J for gap in front.gaps for x in gap.ends]
    others += [x.J for _, found in analysis.manifolds for each in found for x in each.models]
    known = np.vstack([J, front.known.reshape(-1, J.shape[1]), *others])
    # Weights times the ranges of J, with sum 1.
    weights = np.array([x.weights for x in solutions], dtype=float).reshape(J.shape)
    weights = weights * (1.0 if front.scale is None else front.scale)
    total = weights.sum(axis=1, keepdims=True)
    shares = np.divide(weights, total, out=np.full(weights.shape, np.nan), where=total != 0)
    return {
        "label": [point.label for point in points],
        "kind": [point.kind.value for point in points],
        # Of a front that is a point, the ranges over models as good as each other are rounding.
        "pareto": undominated(J, known, front.sizes if front.scale is None else front.scale),
        "dominated_among_front": dominated,
        "theta": theta,
        "objective": J,
        "error": np.sqrt(J / a),
        "weight": _weights(front, J, a),
        "stationary_weight": shares,
        "converged": [x.converged for x in solutions],
        "status": [x.status.name.lower() for x in solutions],
        "evaluations": [x.evaluations for x in solutions],
        "at_bound": at_bounds(theta, problem.lower, problem.upper),
        **{
            name: np.array([x.evaluation.quantities.get(name, unknown) for x in solutions], float)
            for name in ("frequency", "mac", "paired_mode", "coincident")
        },
        **certificate_values(problem, solutions),
    }


def _minima(problem: UpdatingProblem, front: Front) -> Values:
    """Return all distinct minima of single objectives and of the optimally weighted residuals."""
    names = [*problem.objectives, label(Kind.OPTIMAL), ITERATED]
    minima = [*(edge.minima for edge in front.edges), front.optimal]
    minima.append([front.iterated] if front.iterated else [])
    solutions = [minimum for each in minima for minimum in each]
    return {
        "minimum_of": np.repeat(names, list(map(len, minima))),
        "minimum_theta": [x.theta for x in solutions],
        "minimum_objective": [x.J for x in solutions],
        "minimum_converged": [x.converged for x in solutions],
        **certificate_values(problem, solutions, "minimum_"),
    }


def _branches(problem: UpdatingProblem, front: Front) -> Values:
    if len(front.edges) != 2 or METHODS[front.method].programme != "boundary":
        return {}
    J = np.array([point.solution.J for point in front.points])
    ends = [end for gap in front.gaps for end in (gap.end, gap.start)]
    unknown = np.full(len(problem.model.parameters), np.nan), np.full(2, np.nan)
    labels = [(f"end-{k}", f"start-{k + 1}") for k in range(1, len(front.gaps) + 1)]
    return {
        "piece": branch_numbers(J, nondominated(J), front.gaps),
        "end_label": [label for each in labels for label in each],
        "end_theta": [x.theta if x else unknown[0] for x in ends],
        "end_objective": [x.J if x else unknown[1] for x in ends],
        "end_converged": [x is not None for x in ends],
    }


def lattice_values(front: Front) -> Values:
    """Return the lattice of normal-boundary intersection and the point that each place led to."""
    if not len(front.places):
        return {}
    labels = [front.points[k].label for k in front.places]
    return {"lattice": front.lattice, "lattice_label": labels}


def _weights(front: Front, J: Floats, a: Floats) -> Floats:
    """Return the weights (points, n) that weighted methods used; NaN at other points."""
    out = np.full(J.shape, np.nan)
    swept = [Kind.FRONT] * (METHODS[front.method].programme == "weights")
    for i, point in enumerate(front.points):
        if point.kind is Kind.OPTIMAL:
            out[i] = a / J[i]
        elif point.kind in (*WEIGHTED, *swept):
            out[i] = point.solution.weights
    return out


def _identifiability(determined: Determinations) -> Values:
    rows = [
        (at, name, combination, each.scale.unit)
        for at, each in determined
        for name, of_data in each.combinations
        for combination in of_data
    ]
    at, of, chosen, unit = zip(*rows, strict=True)
    effects = determined[0][1].effects
    active = np.flatnonzero(np.diag(effects) > 0).tolist()
    return {
        "combination_at": at,
        "combination_of": of,
        "combination_direction": [x.direction for x in chosen],
        "combination_unit": unit,
        "combination_sensitivity": [x.sensitivity for x in chosen],
        "combination_share": [x.share for x in chosen],
        "collinearity": cosines(effects),
        "collinearity_index": index(effects[np.ix_(active, active)]) if active else np.nan,
    }


def _equivalent(analysis: FrontAnalysis) -> Values:
    rows = [
        (name, number, manifold, model)
        for name, manifolds in analysis.manifolds
        for number, manifold in enumerate(manifolds, start=1)
        for model in manifold.models
    ]
    return {
        "equal_of": [name for name, *_ in rows],
        "equal_manifold": [number for _, number, *_ in rows],
        "equal_dimension": [x.dimension for _, _, x, _ in rows],
        "equal_extent": [x.extent.name.lower() for _, _, x, _ in rows],
        "equal_theta": [model.theta for *_, model in rows],
        "equal_objective": [model.J for *_, model in rows],
    }


def _scatter(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Values:
    if analysis.source is None:
        return {}
    n, p, modes = len(problem.objectives), len(problem.model.parameters), len(problem.data.modes)
    sizes = {"theta_std": (p,), "theta_covariance": (p, p), "objective_std": (n,)}
    sizes |= {"objective_covariance": (n, n), "frequency_std": (modes,), "mac_std": (modes,)}
    out = {name: np.full((len(front.points), *size), np.nan) for name, size in sizes.items()}
    doubts = [""] * len(front.points)
    for i, point in enumerate(front.points):
        if (scatter := analysis.scatter.get(point.label)) is not None:
            J = scatter.J.T @ scatter.J
            out["theta_covariance"][i], out["objective_covariance"][i] = scatter.covariance, J
            out["theta_std"][i] = _std(scatter.covariance, scatter.free)
            out["objective_std"][i] = np.sqrt(np.diag(J))
            doubts[i] = ", ".join(x.name.lower() for x in scatter.warnings)
            for quantity, slopes in analysis.slopes.get(point.label, {}).items():
                out[f"{quantity}_std"][i] = np.linalg.norm(scatter.theta @ slopes.T, axis=0)
    return {**out, "scatter_doubt": doubts}


def _std(covariance: Floats, free: Floats) -> Floats:
    """Return standard deviations, infinite for parameters that have a part in what is free."""
    return np.where(left_open(free), np.inf, np.sqrt(np.diag(covariance)))


def left_open(free: Floats) -> Bools:
    """Return the parameters that have a part in orthonormal directions (p, d)."""
    return np.asarray((np.abs(free) > COMPUTED).any(axis=1))


def _posterior(front: Front, analysis: FrontAnalysis) -> Values:
    posterior = analysis.posterior
    if posterior is None:
        return {}
    out: Values = {
        "posterior_std": _std(posterior.covariance, posterior.free),
        "posterior_covariance": posterior.covariance,
    }
    for name in ("frequency", "mac"):
        slopes = analysis.slopes[front.reference.label][name]
        out[f"posterior_{name}_std"] = np.linalg.norm(slopes @ posterior.axes, axis=1)
    return out


def _replicates(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Values:
    """Return the solutions with data drawn again, NaN where one did not converge."""
    if not analysis.replicates:
        return {}
    p, n = len(problem.model.parameters), len(problem.objectives)
    both = np.full((len(analysis.replicates), len(front.points), p + n), np.nan)
    for k, each in enumerate(analysis.replicates):
        for i, point in enumerate(front.points):
            if (found := each.get(point.label)) and found.converged:
                both[k, i] = np.concatenate([found.theta, found.J])
    deviation = summary(both.reshape(len(both), -1))[1].reshape(-1, p + n)
    return {
        "bootstrap_theta": both[..., :p],
        "bootstrap_objective": both[..., p:],
        "bootstrap_theta_std": deviation[:, :p],
        "bootstrap_objective_std": deviation[:, p:],
    }


def intervals(theta: Floats, best: Floats) -> Floats:
    """Return 90 % intervals, with the medians between their ends, (p, 3), of draws (draws, p).

    They have equal tails. Where the most probable model ``best`` (p,) is in one of these, as at a
    bound, they begin there, and that tail is less: they contain what they are of.
    """
    out, (low, middle, high) = np.empty((best.size, 3)), QUANTILES
    for row, x, value in zip(out, theta.T, best.tolist(), strict=True):
        tail = max(min(low, (x < value).mean()), 2 * low - (x > value).mean())
        row[:] = np.quantile(x, (tail, middle, tail + high - low), method="weibull")
        row[0], row[2] = min(row[0], value), max(row[2], value)
    return out


def with_intervals(data: ArrayDataset, noise: NoiseModel, inference: Inference) -> ArrayDataset:
    """Return results with what the posterior says.

    A quantile is such that the next draw is below it with its probability. Of draws that do not
    settle, and of a model that lacks something or cannot be used, none is called determined, nor is
    a parameter that a bound holds, and not the data. Of one whose bound excludes what fits or whose
    prior the data contradict, these say something.
    """
    draws, fit, widths = inference.draws, inference.fit, prior_widths(noise.problem)
    freed, unfixed = inference.freed, inference.unfixed
    settled = draws.settled and not np.any(refused(fit["misfit"], fit["nominal_misfit"]))
    best = data["kind"].values == Kind.MOST_PROBABLE.value
    (side,), (theta,) = (data[name].values[best] for name in ("at_bound", "theta"))
    held = side * (freed.theta - theta) > 0 if freed else side != 0
    interval = intervals(draws.theta, theta)
    share = (interval[:, 2] - interval[:, 0]) / widths
    known = (share < DETERMINED) & ~held & (settled and not (fit["lack_of_fit"] < CHANCE).any())
    place = np.where(known, 0, np.where(share > OPEN, 2, 1))
    if freed:
        place[excluding(side, theta, fit["misfit"], freed)] = 1
    attributes: dict[str, Any] = {"assumed": noise.assumed, "settled": int(settled)}
    if wrong := inference.contradicted:
        place[noise.problem.model.parameters.index(wrong[0])] = 1
        attributes |= zip(("prior_parameter", "prior_value", "prior_away"), wrong, strict=True)
    along = np.full(data["error"].values.shape, np.nan)
    along[front_points(data)] = inference.along
    values = {
        **fit,
        "front_misfit": along,
        "sample_theta": draws.theta,
        "r_hat": draws.r_hat,
        "effective_draws": draws.effective,
        "interval": interval,
        "trust": np.array(TRUST)[place],
        "prior_width": widths,
        "posterior_std": draws.theta.std(axis=0, ddof=1),
        "posterior_covariance": np.atleast_2d(np.cov(draws.theta, rowvar=False)),
        "posterior_frequency_std": summary(draws.frequency)[1],
        "posterior_mac_std": summary(draws.mac)[1],
    }
    if freed is not None:
        values |= {"freed_theta": freed.theta, "freed_misfit": freed.misfit}
        attributes["freed_less"] = freed.less
    if unfixed is not None:
        attributes["fixed_parameter"], attributes["fixed_value"], values["unfixed_misfit"] = unfixed
    out = data.assign(described(values)).assign_coords({"quantile": QUANTILES})
    return out.assign_attrs(attributes)
