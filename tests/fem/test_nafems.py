"""The NAFEMS benchmarks of natural frequencies, on meshes of the standard: published targets."""

from __future__ import annotations

import numpy as np
import pytest
from nafems import CASES, differences, radial_modes


@pytest.mark.parametrize("name", list(CASES))
def test_frequencies_are_near_the_published_targets(name: str) -> None:
    case = CASES[name]
    found, error = differences(case)
    assert len(found) == len(case.target)
    assert np.abs(error).max() < case.within


def test_the_closed_form_of_the_sphere_is_the_published_one() -> None:
    assert radial_modes() == pytest.approx([369.91, 838.03, 1451.2, 2117.0, 2795.8], rel=1e-4)


def test_finer_meshes_are_nearer() -> None:
    # FV15 is left out: fine meshes of all elements are up to 1.6 % below some of its targets. The
    # target of the sixth mode of FV22 is that of a mesh, those of the others closed forms.
    for name in ("FV22", "FV32"):
        coarse, fine = (np.abs(differences(CASES[n])[1][:5]) for n in (name, f"{name}, finer"))
        assert fine.max() < 0.6 * coarse.max()
