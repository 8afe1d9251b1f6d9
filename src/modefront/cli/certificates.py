"""Output on reduced bases: errors of the models, and costs of the solutions."""

from __future__ import annotations

import numpy as np
import xarray as xr

from modefront.work.costs import Costs


def certificate_remarks(data: xr.Dataset) -> list[str]:
    """Return in words how exact the modes are, and which models do not meet the tolerance."""
    out = [data.attrs["remark"]] if data.attrs.get("remark") else []
    if "certified" not in data:
        return out
    tolerance = data.attrs["eigenvalue_tolerance"]
    worst = float(data["eigenvalue_error"].max())
    predicted = data.attrs.get("prediction_eigensolutions", 0)
    corrected = data.attrs.get("corrected_eigensolutions", 0)
    out.append(
        f"reduced basis from {data.attrs['full_eigensolutions'] - predicted} full eigensolutions "
        f"and {corrected} corrected with their factors: relative errors of "
        f"eigenvalues up to {worst:.1e} (estimated; tolerance {tolerance:.0e}), of "
        f"shapes up to {float(data['shape_error'].max()):.1e}"
    )
    if predicted:
        out.append(f"predictions are not reduced: they took {predicted} full eigensolutions")
    failed = uncertified(data)
    if failed.size:
        out.append(f"above the tolerance: {', '.join(failed)}")
        held = data["label"].values[data["certified"].values]
        out.append(f"within the tolerance: {', '.join(held) if held.size else 'none'}")
    return out


def uncertified(data: xr.Dataset) -> np.ndarray:
    """Return the labels of models whose eigenvalues do not meet the tolerance."""
    if "certified" not in data:
        return np.zeros(0, dtype=str)
    return np.asarray(data["label"].values[~data["certified"].values])


def cost_lines(costs: Costs) -> list[str]:
    """Return what this run has solved, and how long that took."""
    out = [
        f"this time: {costs.eigenproblems} full eigensolutions in {costs.full_time:.3g} s, "
        f"{costs.factorisations} factorisations"
    ]
    if costs.corrected:
        out.append(
            f"{costs.corrected} corrected with their factors, and derivatives, "
            f"in {costs.corrected_time:.3g} s"
        )
    if costs.reduced:
        out.append(
            f"{costs.reduced} reduced solutions in {costs.reduced_time:.3g} s, "
            f"{costs.certificates} certificates in {costs.certificate_time:.3g} s"
        )
    return out
