"""Costs of a run in sentences."""

from __future__ import annotations

from modefront.work.costs import Costs


def cost_lines(costs: Costs) -> list[str]:
    """Return the eigenproblems that this run has solved, and the time it took."""
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
