"""Modes of one frequency: found, declared as a pair, and told to a study."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from simulation import accelerance, blows

from modefront._typing import Floats
from modefront.data.csv import read_csv, write_csv
from modefront.data.modal_test import ModalTest
from modefront.data.responses import frequency_responses
from modefront.data.uff import read_uff55, write_uff55
from modefront.errors import InputError
from modefront.identification.methods.hammer import identify
from modefront.identification.modal_test import IdentifiedTest
from modefront.identification.record import Identification
from modefront.identification.sets import combine
from modefront.study.check import check
from modefront.study.examples import write_example
from modefront.study.file import load

F = np.arange(1.0, 40.0, 0.1)
F0 = (7.0, 15.0, 15.0, 31.0)
ZETA = np.full(4, 0.01)


def shapes() -> Floats:
    out: Floats = np.linalg.qr(np.random.default_rng(4).standard_normal((8, 8)))[0][:4]
    return out


@cache
def identified(
    seed: int, f0: tuple[float, ...] = F0, references: tuple[int, ...] = (0, 5)
) -> Identification:
    rng = np.random.default_rng(seed)
    H = accelerance(F, np.array(f0), ZETA, shapes(), references)
    return identify(frequency_responses(F, blows(H, 0.03, rng)))


@pytest.mark.slow(3)
def test_repeated_modes_are_a_pair_with_deviations_from_their_plane() -> None:
    scores = []
    for seed in range(3):
        result = identified(seed)
        assert result.pairs == ((1, 2),)
        first, second = (result.modes[k] for k in result.pairs[0])
        assert first.frequency == second.frequency == pytest.approx(15.0, rel=1e-3)
        basis = np.array([first.shape.shape, second.shape.shape])
        np.testing.assert_allclose(basis @ basis.T, np.eye(2), atol=1e-4)
        plane = shapes()[1:3]
        outside = basis - basis @ plane.T @ plane
        scores.append(outside / [first.shape_std, second.shape_std])
        assert any("one of a pair" in flag for flag in first.flags)
    assert 0.7 < np.std(scores) < 1.3


def test_close_modes_are_no_pair() -> None:
    result = identified(0, (7.0, 15.0, 15.02, 31.0))
    assert len(result.modes) == 4
    assert result.pairs == ()


def test_pairs_of_two_sets_have_the_same_numbers() -> None:
    both = combine(["a", "b"], [identified(0), identified(1, references=(2, 7))]).data
    assert both.frequency.shape == (2, 4)
    assert np.isfinite(both.frequency).all()
    assert both.pairs == ((2, 3),)


def test_a_pair_reaches_files_and_the_check(tmp_path: Path) -> None:
    data = combine(["1"], [identified(0)]).data
    write_csv(tmp_path / "modes.csv", data)
    assert read_csv(tmp_path / "modes.csv").pairs == ((2, 3),)
    pole, shapes = complex(-1, 50), ([1.0 + 0j, 2.0], [1j, 0.1])
    modes = {number: (pole, np.array(shape)) for number, shape in enumerate(shapes, 1)}
    write_uff55(tmp_path / "modes.uff", ["a"], [modes], ["1Z", "2Z"], [(1, 2)])
    assert read_uff55(tmp_path / "modes.uff").data.pairs == ((1, 2),)

    write_example("three-story-c0", tmp_path / "study")
    file = tmp_path / "study" / "modes.csv"
    lines = file.read_text(encoding="utf-8").splitlines()
    ends = {"1": "2", "2": "1"}
    rows = [f"{line},{ends.get(line.split(',')[1], '')}" for line in lines[1:]]
    file.write_text("\n".join([f"{lines[0]},pair", *rows]) + "\n", encoding="utf-8")
    warnings = check(load(tmp_path / "study" / "study.toml")).warnings
    assert any("subspace = [1, 2]" in text for text in warnings)


@pytest.mark.parametrize("other", ["3", "1", "1.5"])
def test_a_pair_without_its_other_mode_is_refused(tmp_path: Path, other: str) -> None:
    text = f"mode,frequency,top,pair\n1,5,1,{other}\n2,5,1,1\n"
    (tmp_path / "modes.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="the other mode of a pair"):
        read_csv(tmp_path / "modes.csv")


def test_close_modes_of_nearly_one_shape_stay_two_where_noise_is_small() -> None:
    phi = shapes()
    phi[2] = phi[1] + 0.15 * phi[2]
    H = accelerance(F, np.array([7.0, 15.0, 15.05, 31.0]), ZETA, phi, [0, 5])
    result = identify(frequency_responses(F, blows(H, 1e-4, np.random.default_rng(0))))
    assert [round(mode.frequency, 2) for mode in result.modes] == [7.0, 15.0, 15.05, 31.0]


@pytest.mark.parametrize("seed", [1, pytest.param(16, marks=pytest.mark.slow(2))])
def test_a_pair_whose_shapes_nearly_meet_is_no_split_peak(seed: int) -> None:
    rng = np.random.default_rng(seed)
    phi = np.linalg.qr(rng.standard_normal((6, 6)))[0][:4]
    f = np.arange(5.0, 25.0, 0.05)
    zeta = np.array([0.01, 0.008, 0.008, 0.01])
    H = accelerance(f, np.array([9.0, 15.0, 15.0, 20.0]), zeta, phi, [0, 2, 5])
    result = identify(frequency_responses(f, blows(H, 0.01, rng)))
    assert len(result.modes) == 4
    assert result.pairs == ((1, 2),)


def test_modes_keep_their_numbers_in_universal_files_where_a_set_lacks_one(tmp_path: Path) -> None:
    whole, part = identified(0), identified(1, references=(2, 7))
    both = (whole, replace(part, modes=part.modes[1:]))
    modes = combine(["a", "b"], both)
    test = IdentifiedTest(ModalTest("t", None, None, ()), both, modes, ((1, 2, 3, 4), (2, 3, 4)))
    test.write(tmp_path / "modes.uff")
    read = read_uff55(tmp_path / "modes.uff").data
    np.testing.assert_allclose(read.frequency, test.data.frequency, rtol=1e-5)
    assert read.pairs == test.data.pairs
