"""Files of tests with faults: each has an error or a warning that names it."""

from pathlib import Path

import numpy as np
import pytest

from modefront._typing import Complexes, Floats
from modefront.data.csv import read_test_csv
from modefront.data.modal_test import read_test
from modefront.errors import InputError
from modefront.identification.methods.hammer import weighting
from modefront.study.examples import write_example

F = np.arange(0.1, 20.05, 0.1)


def accelerances() -> Complexes:
    """Return driving-point and transfer accelerances of two modes, (references, responses, f)."""
    phi = np.array([[0.6, 1.0], [1.0, -0.6]])
    s, omega = 2j * np.pi * F, 2 * np.pi * np.array([[4.0], [11.0]])
    G = s**2 / (s**2 + 2 * 0.01 * omega * s + omega**2)
    out: Complexes = np.einsum("rj,ri,rk->jik", phi, phi, G)
    return out


def uff58(
    H: Complexes,
    response: int,
    reference: int,
    f: Floats = F,
    letter: str = "E",
    kind: int = 4,
) -> str:
    """Return an ASCII dataset 58 of complex values at an even abscissa."""
    numbers = [f"{x:13.5E}".replace("E", letter) for x in H.view(float)]
    lines = ["".join(numbers[k : k + 6]) for k in range(0, len(numbers), 6)]
    return "\n".join(
        [
            "    -1",
            "    58",
            *("NONE", "NONE", "01-Jan-26 00:00:00", "NONE", "NONE"),
            f"{kind:5d}         0    0         0 NONE      {response:10d}   3"
            f" NONE      {reference:10d}   3",
            f"         5{len(f):10d}         1{f[0]:13.5E}{f[1] - f[0]:13.5E}  0.00000E+00",
            "        18    0    0    0 NONE                 Hz                  ",
            "        12    0    0    0 NONE                 NONE                ",
            "         9    0    0    0 NONE                 NONE                ",
            "         0    0    0    0 NONE                 NONE                ",
            *lines,
            "    -1",
            "",
        ]
    )


def _all(H: Complexes, letter: str = "E") -> str:
    return "".join(uff58(H[j, i], i + 1, j + 1, letter=letter) for j in (0, 1) for i in (0, 1))


def _changed(j: int, i: int, factor: complex) -> str:
    H = accelerances()
    H[j, i] *= factor
    return _all(H)


ERRORS = [
    pytest.param(_all(accelerances())[:-900], "the end of dataset 58", id="cut-off"),
    pytest.param("    -1\n    15\n  1 0 0\n    -1\n", "datasets 15 only", id="other-datasets"),
    pytest.param("a letter to a friend\n", "this is no universal file", id="text"),
    pytest.param("", "found an empty file", id="empty"),
    pytest.param(_changed(0, 1, np.nan), "finite numbers", id="nan"),
    pytest.param(_all(0 * accelerances()), "only zeros", id="zeros"),
    pytest.param(
        uff58(accelerances()[0, 0], 1, 1) + uff58(accelerances()[0, 1], 2, 1, 2 * F),
        "expected the frequency axis of",
        id="axes",
    ),
    pytest.param(
        uff58(accelerances()[0, 0], 1, 1) + uff58(accelerances()[0, 1, :99], 2, 1, F[:99]),
        "expected 200 lines",
        id="lines",
    ),
    pytest.param(uff58(accelerances()[0, 0], 1, 1, kind=2), "functions of type 2", id="spectra"),
    pytest.param(
        uff58(np.zeros(0, complex), 1, 1, F[:2]).replace(f"5{2:10d}", f"5{0:10d}"),
        "expected a dataset 58, found 0 values",
        id="no-values",
    ),
]

WARNINGS = [
    pytest.param(_changed(0, 1, 0), "only zeros; the channel is left out", id="dead"),
    pytest.param(_changed(0, 1, -1), "opposite signs", id="sign"),
    pytest.param(_changed(1, 1, -1), "the driving point has the wrong sign", id="driving-point"),
    pytest.param(_changed(0, 1, 1000), "check its unit", id="unit"),
    pytest.param(_changed(0, 1, 0.001), "the channel 2Z is 0.001 times as great", id="small-unit"),
    pytest.param(
        uff58(accelerances()[0, 0], 1, 1, 2 * np.pi * F), "looks like rad/s", id="circular"
    ),
]


@pytest.mark.parametrize(("content", "message"), ERRORS)
def test_wrong_files_are_errors(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "a.uff"
    path.write_text(content)
    with pytest.raises(InputError, match=message):
        read_test(path)


@pytest.mark.parametrize(("content", "message"), WARNINGS)
def test_doubtful_files_have_warnings(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "a.uff"
    path.write_text(content)
    (data_set,) = read_test(path).sets
    assert message in "\n".join(data_set.warnings)


@pytest.mark.parametrize("roving", ["sensor", "hammer"])
def test_a_sensor_in_g_is_named_by_reciprocity(tmp_path: Path, roving: str) -> None:
    phi = np.array([[0.6, 1.0, 0.5], [1.0, -0.6, 0.7]])
    s, omega = 2j * np.pi * F, 2 * np.pi * np.array([[4.0], [11.0]])
    G = s**2 / (s**2 + 2 * 0.01 * omega * s + omega**2)
    H = np.einsum("rj,ri,rk->jik", phi, phi, G)  # hammer, sensor, lines
    H[:, 2] /= 9.80665
    path = tmp_path / "test.toml"
    points = ("a", "b", "c", "d") if roving == "hammer" else ("a", "b", "c")
    files = [f"{k}.uff" for k in range(len(points))]
    for j, file in enumerate(files):
        text = "".join(uff58(H[min(j, 2), i], i + 1, j + 1) for i in range(3))
        (tmp_path / file).write_text(text)
    names = "".join(f'{name} = "{k}Z"\n' for k, name in enumerate(points, start=1))
    path.write_text(f"[test]\n[[set]]\nfiles = {files}\n[sensors]\n{names}")
    test = read_test(path)
    assert test.name == "test"
    (warning,) = test.sets[0].warnings
    assert "the channel c is 0.102 times as great as reciprocity with a, b says" in warning
    assert "between g and m/s²" in warning


def test_each_set_may_have_channels_of_its_own(tmp_path: Path) -> None:
    H, path = accelerances()[0, 0], tmp_path / "test.toml"
    for file, responses in (("a.uff", (1, 2)), ("b.uff", (1, 3))):
        (tmp_path / file).write_text("".join(uff58(H, i, 1) for i in responses))
    sets = '[test]\n[[set]]\nfiles = ["a.uff"]\n[[set]]\nfiles = ["b.uff"]\n[sensors]\n'
    path.write_text(sets + 'top = "3Z"\nlow = "1-Z"\nmiddle = "2Z"\n')
    both = [each.data.responses for each in read_test(path).sets]
    assert both == [("low", "middle"), ("low", "top")]
    path.write_text(sets + 'top = "4Z"\nlow = "1Z"\n')
    with pytest.raises(InputError, match=r"\[sensors\] top: expected a channel .* 1Z, 2Z, 3Z, f"):
        read_test(path)


@pytest.mark.parametrize("letter", ["E", "D", "d"])
def test_good_files_have_none(tmp_path: Path, letter: str) -> None:
    path = tmp_path / "a.uff"
    path.write_text(_all(accelerances(), letter))
    (data_set,) = read_test(path).sets
    assert data_set.warnings == ()
    assert data_set.data.H == pytest.approx(accelerances(), rel=1e-4, abs=1e-6)


def test_a_fault_far_down_a_long_file_is_found_by_its_line(tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    rows = [f"{k},1.0,2.0" for k in range(1, 30_001)]
    rows[25_000] = "25001,x,2.0"
    path.write_text("\n".join(["frequency,a_re,a_im", *rows]))
    with pytest.raises(InputError, match=r"line 25002, column 'a_re'.*found 'x'"):
        read_test_csv(path)


def test_a_pair_that_was_hit_once_is_weighted_too(tmp_path: Path) -> None:
    H = accelerances()
    path = tmp_path / "a.uff"
    path.write_text(_all(H) + uff58(1.01 * H[0, 0], 1, 1))
    (data_set,) = read_test(path).sets
    data = data_set.data
    assert data.variance is not None
    assert weighting(data) == "residuals"


@pytest.mark.filterwarnings("error")
def test_numbers_beyond_all_are_refused_without_a_warning_of_arithmetic(tmp_path: Path) -> None:
    path = tmp_path / "a.uff"
    H = accelerances()[0, 0]
    path.write_text(uff58(H, 1, 1).replace(f"{H[3].imag:13.5E}", "   9.0000E999", 1))
    with pytest.raises(InputError, match=r"finite numbers up to 1e\+100, found "):
        read_test(path)


@pytest.mark.parametrize("number", ["-1.23456E+100", " -1.23456+100"])
def test_numbers_that_overflow_are_refused(tmp_path: Path, number: str) -> None:
    path = tmp_path / "a.uff"
    H = accelerances()[0, 0]
    text = uff58(H, 1, 1)
    path.write_text(text.replace(f"{H[3].real:13.5E}", number, 1))
    with pytest.raises(InputError, match=r"finite numbers up to 1e\+100, found -1.23456e\+100"):
        read_test(path)


@pytest.mark.parametrize("ended", [True, False])
def test_a_table_that_ends_within_its_last_number_is_refused(tmp_path: Path, ended: bool) -> None:
    path = tmp_path / "a.csv"
    rows = [f"{f:.9g},{np.sin(f):.9g},{np.cos(f):.9g}" for f in np.arange(1.0, 9.0)]
    text = "\n".join(["frequency,a_re,a_im", *rows]) + "\n" * ended
    path.write_text(text)
    right, _ = read_test_csv(path)
    for lost in range(1 + ended, 10):
        path.write_text(text[:-lost])
        with pytest.raises(InputError, match="last line: expected whole lines to the end"):
            read_test_csv(path)
    path.write_text(text.rstrip("\n"))
    np.testing.assert_array_equal(read_test_csv(path)[0][0].H, right[0].H)


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ("[identify]\nkeep = [0]", "a list of numbers of modes, from 1"),
        ('[identify]\nseed = ["4 Hz"]', "a list of frequencies in Hz"),
        ("[geometry]\nfloor1 = [0, 0, 1]", "x, y, z and a direction that is not zero, six numbers"),
        ("[geometry]\nfloor1 = [0, 0, 1, 0, 0, 0]", "a direction that is not zero"),
        ("[geometry]\nflor1 = [0, 0, 1, 1, 0, 0]", "did you mean 'floor1'"),
    ],
)
def test_modes_by_hand_and_places_that_are_wrong(tmp_path: Path, lines: str, says: str) -> None:
    write_example("hammer-test", tmp_path)
    test = tmp_path / "test-m0.toml"
    text = test.read_text(encoding="utf-8")
    whole = "" if lines.startswith("[identify]") else "[identify]\n"
    test.write_text(text.replace("[identify]\n", f"{lines}\n{whole}", 1), encoding="utf-8")
    with pytest.raises(InputError, match=says):
        read_test(test)
