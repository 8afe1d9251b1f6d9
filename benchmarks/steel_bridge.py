"""The front of a measured steel bridge of 946 DOFs, 474 of them massless, with and without a basis.

python benchmarks/steel_bridge.py [--points 20] [--doubt 0.5]

17 parameters and 5 measured modes, of which the first two come in the other order in the nominal
model; frequencies and shapes over their standard deviations. Prints for each point how far the
parameters of the two fronts are apart, over their ranges, and the relative differences of the
objectives; and the processor time and the eigenproblems of both. Needs ``../shared/data``.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
import xarray as xr
from smu import Structure, frequencies_and_shapes, read

import modefront as mf
from modefront.front.search import Search
from modefront.identifiability.combinations import Identifiability
from modefront.uncertainty.noise import Uncertainty


def front(structure: Structure, points: int, doubt: float, *, reduced: bool) -> xr.Dataset:
    """Return the front, and print what it has cost."""
    problem = frequencies_and_shapes(structure, scale="std", reduced=reduced)
    began = time.process_time()
    data = mf.solve(
        problem,
        points=points,
        search=Search(doubt=doubt),
        identifiability=Identifiability(flat=0, models=0),
        uncertainty=Uncertainty(source="none"),
    ).dataset
    print(
        f"{'reduced' if reduced else 'full':8s} {time.process_time() - began:.0f} s, "
        f"{data.attrs['full_eigensolutions']} eigenproblems in full and "
        f"{data.attrs['reduced_solutions']} reduced, {int(data['converged'].sum())} of "
        f"{data.sizes['point']} models converged, hypervolume {data.attrs['hypervolume']:.4f}",
        flush=True,
    )
    return data


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--points", type=int, default=20)
    parser.add_argument("--doubt", type=float, default=0.5)
    given = parser.parse_args()
    structure = read("steel_bridge_exp")
    first, other = (
        front(structure, given.points, given.doubt, reduced=reduced) for reduced in (True, False)
    )
    span = structure.upper - structure.lower
    for i, label in enumerate(other["label"].values):
        apart = np.abs(first["theta"].values[i] - other["theta"].values[i]) / span
        J = first["objective"].values[i] / other["objective"].values[i] - 1
        print(f"{label:18s} theta {apart.max():.1e}   J {J[0]: .1e} {J[1]: .1e}")


if __name__ == "__main__":
    main()
