"""Records of impacts in files: CSV and universal files, what is left out, what is wrong."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from simulation import THREE_STORY, THREE_STORY_DAMPING, impact_records, three_story_shapes

from modefront._typing import Floats
from modefront.data.modal_test import read_test
from modefront.errors import InputError
from modefront.identification.methods.hammer import identify

FLOORS = ("floor1", "floor2", "floor3")


def _records(reference: int, seed: int) -> tuple[Floats, Floats, Floats]:
    rng = np.random.default_rng(seed)
    return impact_records(
        THREE_STORY, THREE_STORY_DAMPING, three_story_shapes(), reference, rng, 0.01
    )


def _csv(path: Path, time: Floats, force: Floats, y: Floats) -> None:
    header = ",".join(["time", "force", *FLOORS])
    columns = np.column_stack([time, force, *y])
    np.savetxt(path, columns, delimiter=",", header=header, comments="", fmt="%.9g")


def _test_file(folder: Path, files: Sequence[str], references: Sequence[str], more: str) -> Path:
    path = folder / "test.toml"
    path.write_text(
        f'[test]\nname = "t"\nquantity = "accelerance"\n{more}\n[[set]]\n'
        f"files = {list(files)}\nreference = {list(references)}\n"
    )
    return path


def _blows(folder: Path, blows: int = 3) -> tuple[list[str], list[str]]:
    """Write blows at the second and third floor; return files and references."""
    files, references = [], []
    for reference in (1, 2):
        for b in range(blows):
            files.append(f"{FLOORS[reference]}-{b}.csv")
            references.append(FLOORS[reference])
            _csv(folder / files[-1], *_records(reference, 10 * reference + b))
    return files, references


WINDOWS = '[impact]\nestimator = "Hv"\nforce_window = 0.1\nexponential = 1.5'


@pytest.mark.parametrize("windows", ["", pytest.param(WINDOWS, marks=pytest.mark.slow(4))])
def test_records_in_csv_give_the_modes_without_the_damping_of_the_window(
    tmp_path: Path, windows: str
) -> None:
    (data_set,) = read_test(_test_file(tmp_path, *_blows(tmp_path), windows)).sets
    data = data_set.data
    assert data_set.warnings == ()
    assert (data.references, data.responses) == (FLOORS[1:], FLOORS)
    assert data.decay == pytest.approx(1 / 1.5 if windows else 0.4)
    modes = identify(data, (3, 20)).modes
    assert [mode.frequency for mode in modes] == pytest.approx(THREE_STORY, rel=2e-3)
    assert [mode.damping for mode in modes] == pytest.approx(THREE_STORY_DAMPING, rel=0.1)
    for mode, true in zip(modes, zip(THREE_STORY, THREE_STORY_DAMPING, strict=True), strict=True):
        assert abs(mode.frequency - true[0]) < 4 * mode.frequency_std
        assert abs(mode.damping - true[1]) < 4 * mode.damping_std


def test_records_in_universal_files_are_grouped_into_blows(tmp_path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    path = tmp_path / "blows.uff"
    sets = []
    for b in range(3):
        time, force, y = _records(2, b)
        for node, (kind, values) in enumerate([(13, force), *((12, row) for row in y)]):
            sets.append(
                pyuff.prepare_58(
                    func_type=1,
                    rsp_node=node or 3,
                    rsp_dir=3 if node else -3,
                    ref_node=3,
                    ref_dir=-3,
                    data=values if node else -values,
                    x=time,
                    id1="a",
                    binary=0,
                    ordinate_spec_data_type=kind,
                    orddenom_spec_data_type=0,
                    abscissa_spec_data_type=17,
                    abscissa_spacing=1,
                    ver_num=b,
                    load_case_id=0,
                    abscissa_min=0.0,
                    abscissa_inc=time[1],
                )
            )
    pyuff.UFF(str(path)).write_sets(sets, "add")
    (data_set,) = read_test(path).sets
    data = data_set.data
    assert (data.references, data.responses) == (("3Z",), ("1Z", "2Z", "3Z"))
    assert data.quantity == "accelerance"
    assert data.variance is not None
    modes = identify(data, (3, 20)).modes
    assert [mode.frequency for mode in modes] == pytest.approx(THREE_STORY, rel=2e-3)
    assert modes[0].shape.shape @ three_story_shapes()[0] != pytest.approx(0, abs=0.1)


def test_times_may_have_few_digits(tmp_path: Path) -> None:
    files, references = _blows(tmp_path)
    data = []
    for digits in (9, 3):
        for file in files:
            time, *values = np.loadtxt(tmp_path / file, delimiter=",", skiprows=1).T
            _csv(tmp_path / file, np.round(time, digits), values[0], np.array(values[1:]))
        data.append(read_test(_test_file(tmp_path, files, references, "")).sets[0].data)
    assert data[1].H == pytest.approx(data[0].H, rel=1e-6)
    assert data[1].frequency == pytest.approx(data[0].frequency, rel=1e-3)


def test_a_dead_response_is_left_out(tmp_path: Path) -> None:
    files, references = _blows(tmp_path)
    for file in files:
        time, force, *y = np.loadtxt(tmp_path / file, delimiter=",", skiprows=1).T
        y[1] = 0 * y[1]
        _csv(tmp_path / file, time, force, np.array(y))
    (data_set,) = read_test(_test_file(tmp_path, files, references, "")).sets
    (dead_once,) = data_set.warnings
    assert re.search(r"floor2.* and \d more: empty or only zeros; the channel", dead_once)
    data = data_set.data
    modes = identify(data, (3, 20)).modes
    assert [mode.frequency for mode in modes] == pytest.approx(THREE_STORY, rel=2e-3)
    dead = [name == "floor2" for name in data.responses]
    assert any(dead)
    assert np.isnan(modes[0].shape_std).tolist() == dead


def test_blows_that_are_left_out_are_named(tmp_path: Path) -> None:
    files, references = _blows(tmp_path)
    time, force, y = _records(1, 3)
    force[300:303] = 1.0
    _csv(tmp_path / files[1], time, force, y)
    (data_set,) = read_test(_test_file(tmp_path, files, references, "")).sets
    (text,) = data_set.warnings
    assert files[1] in text
    assert "left out: a second hit 2.18 s after the first" in text


def test_responses_that_are_cut_off_are_said(tmp_path: Path) -> None:
    files, references = _blows(tmp_path)
    for file in files:
        lines = (tmp_path / file).read_text().splitlines()
        (tmp_path / file).write_text("\n".join(lines[:201]) + "\n")
    test = _test_file(tmp_path, files, references, '[impact]\nexponential = "none"')
    (data_set,) = read_test(test).sets
    assert "at the end of the record: expect errors of leakage" in data_set.warnings[0]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("time,force", "time,strength"), r"column 'force': expected the record of the force"),
        (
            ("\n0.0078125,", "\n0.012,"),
            r"even steps, found times off by up to 0.0\d+ s, steps of 0.0078",
        ),
        (("floor1", "floor2"), "column 'floor2': expected each column once"),
        (("time,force,floor1,floor2,floor3", "time,force,floor1,floor2"), "expected 4 fields"),
    ],
)
def test_records_that_are_wrong_are_named(
    tmp_path: Path, change: tuple[str, str], message: str
) -> None:
    files, references = _blows(tmp_path, 1)
    text = (tmp_path / files[1]).read_text()
    assert change[0] in text
    (tmp_path / files[1]).write_text(text.replace(*change, 1))
    with pytest.raises(InputError, match=message):
        read_test(_test_file(tmp_path, files, references, ""))


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("[impact]\nexponential = -1", r"\[impact\] exponential: expected a time constant"),
        ('[impact]\nestimator = "H3"', r"\[impact\] estimator: expected one of 'H1'"),
        ("[impact]\nwindow = 1", "expected a known key"),
    ],
)
def test_options_that_are_wrong_are_named(tmp_path: Path, more: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_test(_test_file(tmp_path, *_blows(tmp_path, 1), more))


def test_records_of_different_length_and_of_no_force_are_named(tmp_path: Path) -> None:
    files, references = _blows(tmp_path, 1)
    time, force, y = _records(2, 0)
    _csv(tmp_path / files[1], time[:-1], force[:-1], y[:, :-1])
    with pytest.raises(InputError, match="expected records of 1280 samples over 9"):
        read_test(_test_file(tmp_path, files, references, ""))
    _csv(tmp_path / files[1], time, 0 * force, y)
    with pytest.raises(InputError, match="at least one good blow, found blow 1: there is no force"):
        read_test(_test_file(tmp_path, files, references, ""))


def test_windows_without_records_and_a_mixture_are_errors(tmp_path: Path) -> None:
    files, references = _blows(tmp_path, 1)
    lines = "".join(f"{k},1,0\n" for k in range(1, 30))
    (tmp_path / "f.csv").write_text("frequency,a_re,a_im\n" + lines)
    with pytest.raises(InputError, match="expected either functions or records of blows"):
        read_test(_test_file(tmp_path, ["f.csv", *files], ["a", *references], ""))
    with pytest.raises(InputError, match="'window' in their"):
        read_test(_test_file(tmp_path, ["f.csv"], ["a"], '[impact]\nestimator = "H2"'))


@pytest.mark.slow(3)
def test_damping_of_windowed_functions_is_that_of_the_structure(tmp_path: Path) -> None:
    tau = 1.0
    files = []
    for j in (1, 2):
        for blow in range(3):
            time, force, y = _records(j, 10 * j + blow)
            spectra = np.fft.rfft(np.vstack([force, y]) * np.exp(-time / tau))
            H = spectra[1:] / spectra[0]
            f = np.arange(H.shape[1]) / (len(time) * time[1])
            columns = [f, *(part for h in H for part in (h.real, h.imag))]
            header = ",".join(["frequency", *(f"{n}_{e}" for n in FLOORS for e in ("re", "im"))])
            path = tmp_path / f"{j}{blow}.csv"
            np.savetxt(path, np.transpose(columns), delimiter=",", header=header, comments="")
            files.append(path.name)
    references = [FLOORS[int(name[0])] for name in files]
    test = _test_file(tmp_path, files, references, "")
    test.write_text(test.read_text() + f"window = {{ exponential = {tau} }}\n")
    (data_set,) = read_test(test).sets
    modes = identify(data_set.data, (3, 20)).modes
    assert [mode.frequency for mode in modes] == pytest.approx(THREE_STORY, rel=1e-3)
    assert [mode.damping for mode in modes] == pytest.approx(THREE_STORY_DAMPING, rel=0.1)
    test.write_text(test.read_text().replace(str(tau), "-1"))
    with pytest.raises(InputError, match="window exponential: expected a time constant in s"):
        read_test(test)


def test_blows_have_their_windows_in_impact(tmp_path: Path) -> None:
    files, references = _blows(tmp_path, 1)
    test = _test_file(tmp_path, files, references, "")
    test.write_text(test.read_text() + "window = { exponential = 1.0 }\n")
    with pytest.raises(InputError, match=r"found records of blows: \[impact\]"):
        read_test(test)
