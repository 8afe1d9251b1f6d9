"""Files of frequency response functions, test files, and what is wrong with them."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from modefront._typing import Complexes, Floats
from modefront.data.csv import read_csv, write_csv
from modefront.data.modal import modal_data
from modefront.data.modal_test import read_test
from modefront.data.uff import blocks, read_uff
from modefront.errors import InputError

UFF = Path(__file__).parents[3] / "shared" / "data" / "uff"


def _ascii58(values: str, count: int, kind: int = 4, quantity: int = 12) -> str:
    """Return an ASCII dataset 58 of complex values at an even abscissa."""
    return (
        "    -1\n    58\nNONE\nNONE\n01-Jan-26 00:00:00\nNONE\nNONE\n"
        f"{kind:5d}         0    0         0 NONE               3  -3 NONE               7   3\n"
        f"         5{count:10d}         1  1.00000E+00  5.00000E-01  0.00000E+00\n"
        "        18    0    0    0 NONE                 Hz                  \n"
        f"{quantity:10d}    0    0    0 NONE                 NONE                \n"
        "         9    0    0    0 NONE                 NONE                \n"
        "         0    0    0    0 NONE                 NONE                \n"
        f"{values}    -1\n"
    )


def _values(letter: str, count: int = 9) -> str:
    numbers = [f"{k + 1:13.5E}".replace("E", letter) for k in range(2 * count)]
    return "".join(
        "".join(numbers[position : position + 6]) + "\n" for position in range(0, 2 * count, 6)
    )


@pytest.mark.parametrize("letter", ["E", "D"])
def test_ascii_functions_are_read_with_either_exponent(tmp_path: Path, letter: str) -> None:
    path = tmp_path / "a.uff"
    text = _ascii58(_values(letter), 9)
    path.write_text(text.replace("E+0", f"{letter}+0").replace("E-0", f"{letter}-0"))
    (channel,) = read_uff(path)
    assert (channel.response, channel.reference, channel.quantity) == ("3Z", "7Z", "accelerance")
    assert channel.frequency == pytest.approx(1 + 0.5 * np.arange(9))
    assert channel.H == pytest.approx(-(np.arange(1, 19, 2) + 1j * np.arange(2, 20, 2)))


def test_binary_functions_are_read(tmp_path: Path) -> None:
    path = tmp_path / "b.uff"
    H = np.exp(1j * np.arange(30.0))
    body = np.stack([H.real, H.imag], axis=1).astype("<f4").tobytes()
    lines = _ascii58("", 30, quantity=8).split("\n")[2:-2]
    header = f"{58:6d}b{1:6d}{2:6d}{len(lines):12d}{len(body):12d}{0:6d}{0:6d}{0:12d}{0:12d}"
    text = "\n".join(["    -1", header, *lines]) + "\n"
    path.write_bytes(text.encode() + body + b"\n    -1\n")
    (result,) = read_uff(path)
    assert result.quantity == "receptance"
    assert result.H == pytest.approx(-H, rel=1e-6)


@pytest.mark.parametrize("even", [0, 1])
def test_binary_functions_of_pyuff_are_read_though_it_writes_a_wrong_size(
    tmp_path: Path, even: int
) -> None:
    pyuff = pytest.importorskip("pyuff")
    path = tmp_path / "b.uff"
    H = np.exp(1j * np.arange(30.0)) * np.array([[1.0], [2.0]])
    x = np.arange(30.0) if even else np.arange(30.0) ** 1.01
    for i, values in enumerate(H):
        written = pyuff.prepare_58(
            binary=1,
            func_type=4,
            rsp_node=i + 1,
            rsp_dir=3,
            ref_node=1,
            ref_dir=3,
            data=values,
            x=x,
            id1="a",
            ordinate_spec_data_type=12,
            orddenom_spec_data_type=13,
            abscissa_spec_data_type=18,
            abscissa_spacing=even,
            ver_num=0,
            load_case_id=0,
            abscissa_min=0.0,
            abscissa_inc=1.0,
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ResourceWarning)
            pyuff.UFF(str(path)).write_sets([written], "add")
    channels = read_uff(path)
    assert [channel.response for channel in channels] == ["1Z", "2Z"]
    assert np.array([channel.H for channel in channels]) == pytest.approx(H)
    assert channels[0].frequency == pytest.approx(x)
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(InputError, match="expected the end of dataset 58"):
        read_uff(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (_ascii58(_values("E"), 9)[:-40], "the end of dataset 58"),
        (_ascii58(_values("E"), 20), "20 values"),
        (_ascii58(_values("E"), 9, kind=1), "functions of type 1 only"),
        ("    -1\n    15\n  1 2 3\n    -1\n", "datasets 15 only"),
        ("once upon a time", "this is no universal file"),
        ("", "found an empty file"),
    ],
)
def test_other_files_are_answered(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "a.uff"
    path.write_text(content)
    with pytest.raises(InputError, match=message):
        read_uff(path)


@pytest.mark.skipif(not UFF.exists(), reason="no folder of shared data")
@pytest.mark.parametrize(
    ("name", "first", "count"),
    [
        ("heat_engine_housing.uff", 151, 5),
        ("mesh_Oros-modal_uff15_uff2412.uff", 18, 3),
        ("Sample_UFF58_ascii.uff", 58, 1),
    ],
)
def test_datasets_of_real_files_are_found(name: str, first: int, count: int) -> None:
    result = blocks((UFF / name).read_bytes(), UFF / name)
    assert result[0].number == first
    assert len(result) >= count
    with pytest.raises(InputError, match="frequency response functions"):
        read_uff(UFF / name)


def _csv(path: Path, f: Floats, H: dict[str, Complexes]) -> Path:
    header = ",".join(["frequency", *(f"{n}_{e}" for n in H for e in ("re", "im"))])
    columns = [f, *(part for h in H.values() for part in (h.real, h.imag))]
    np.savetxt(path, np.transpose(columns), delimiter=",", header=header, comments="", fmt="%.9g")
    return path


def _test_file(folder: Path, files: list[str], references: list[str]) -> Path:
    path = folder / "test.toml"
    path.write_text(
        f'[test]\nname = "t"\nquantity = "mobility"\n[[set]]\nfiles = {files}\n'
        f"reference = {references}\n"
    )
    return path


def _functions(seed: int) -> dict[str, Complexes]:
    rng = np.random.default_rng(seed)
    return {n: rng.standard_normal(30) + 1j * rng.standard_normal(30) for n in ("a", "b")}


def test_references_and_blows_are_told_apart(tmp_path: Path) -> None:
    f = np.arange(1, 31.0)
    for k in range(3):
        _csv(tmp_path / f"{k}.csv", f, _functions(k))
    path = _test_file(tmp_path, ["0.csv", "1.csv", "2.csv"], ["a", "a", "b"])
    (data_set,) = read_test(path).sets
    data = data_set.data
    assert data.H.shape == (2, 2, 30)
    assert (data.references, data.responses, data.quantity) == (("a", "b"), ("a", "b"), "mobility")
    assert data.H[0, 0] == pytest.approx((_functions(0)["a"] + _functions(1)["a"]) / 2)
    assert data.variance is not None
    spread = np.abs(_functions(0)["a"] - _functions(1)["a"]) ** 2 / 4
    assert data.variance[0, 0] == pytest.approx(spread)
    assert np.isnan(data.variance[1]).all()


def test_functions_of_spreadsheets_are_read(tmp_path: Path) -> None:
    H = _functions(0)
    path = _csv(tmp_path / "a.csv", np.arange(1, 31.0), H)
    text = path.read_text().replace(",", ";").replace(".", ",")
    path.write_text("sep=;\n" + text)
    (data_set,) = read_test(path).sets
    assert data_set.data.H[0] == pytest.approx(np.array(list(H.values())))
    path.write_text(text.replace(text.splitlines()[3], "3;x;1;1;1"))
    with pytest.raises(InputError, match=r"line 4, column 'a_re'.*found 'x'"):
        read_test(path)


def test_different_axes_and_missing_files_are_named(tmp_path: Path) -> None:
    _csv(tmp_path / "0.csv", np.arange(1, 31.0), _functions(0))
    _csv(tmp_path / "1.csv", np.arange(2, 32.0), _functions(1))
    with pytest.raises(InputError, match=r"1\.csv: .*expected the frequency axis of .*0\.csv"):
        read_test(_test_file(tmp_path, ["0.csv", "1.csv"], ["a", "b"]))
    with pytest.raises(InputError, match=r"2\.csv: file: .*no such file"):
        read_test(_test_file(tmp_path, ["0.csv", "2.csv"], ["a", "b"]))


def test_odd_channels_are_pointed_out(tmp_path: Path) -> None:
    f = 2 * np.pi * np.arange(1, 31.0)
    H = _functions(0)
    _csv(tmp_path / "0.csv", f, {"a": H["a"], "b": H["b"], "c": 0 * H["a"]})
    _csv(tmp_path / "1.csv", f, {"a": -H["b"], "b": H["a"], "c": 1000 * H["a"]})
    (data_set,) = read_test(_test_file(tmp_path, ["0.csv", "1.csv"], ["a", "b"])).sets
    message = "\n".join(data_set.warnings)
    for text in ("looks like rad/s", "only zeros", "check its unit", "opposite signs"):
        assert text in message
    assert np.isnan(data_set.data.H[0, 2]).all()


@pytest.mark.parametrize("bad", ["nan", "x", "", "1e999"])
def test_numbers_that_are_none_are_named(tmp_path: Path, bad: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(f"frequency,a_re,a_im\n1,2,3\n2,{bad},4\n")
    with pytest.raises(InputError, match="finite number"):
        read_test(path)


def test_only_zeros_are_an_error(tmp_path: Path) -> None:
    f = np.arange(1, 31.0)
    with pytest.raises(InputError, match="only zeros"):
        read_test(_csv(tmp_path / "a.csv", f, {"a": np.zeros(30, complex)}))


def test_written_modal_data_are_read_again(tmp_path: Path) -> None:
    f = np.array([[1.5, 2.5], [1.6, np.nan]])
    phi = np.array([[[1.0, 0.5], [0.2, -1.0]], [[0.9, 0.6], [np.nan, np.nan]]])
    data = modal_data(f, phi, ("low", "top"), frequency_std=0.01 * f, shape_std=0.02 + 0 * phi)
    write_csv(tmp_path / "m.csv", data, damping_std=0.1 * f)
    again = read_csv(tmp_path / "m.csv")
    np.testing.assert_allclose(again.frequency, data.frequency)
    np.testing.assert_allclose(again.shape, data.shape)
    np.testing.assert_allclose(again.shape_std[0], data.shape_std[0])
    assert (tmp_path / "m.csv").read_text().startswith("set,mode,frequency,damping,low,top,freq")


@pytest.mark.parametrize("form", ["rad", "deg"])
def test_functions_as_magnitude_and_phase(tmp_path: Path, form: str) -> None:
    f, H = np.arange(1, 31.0), _functions(0)
    angles = {name: np.unwrap(np.angle(h)) for name, h in H.items()}
    angles = angles if form == "rad" else {name: np.degrees(x) for name, x in angles.items()}
    header = ",".join(["frequency", *(f"{n}_{e}" for n in H for e in ("magnitude", form))])
    table = np.transpose([f, *(x for n in H for x in (np.abs(H[n]), angles[n]))])
    np.savetxt(tmp_path / "a.csv", table, "%.12g", ",", header=header, comments="")
    (data_set,) = read_test(tmp_path / "a.csv").sets
    assert data_set.data.H[0] == pytest.approx(np.array(list(H.values())))


@pytest.mark.parametrize(
    ("columns", "says"),
    [
        ("a_magnitude,a_rad\n1,1,-170\n2,2,20\n", "a_rad.*a phase in radians .*found 170"),
        ("a_magnitude,a_deg\n1,1,-3\n2,2,0.2\n", "a_deg.*a phase in degrees .*found 3"),
        ("a_magnitude,a_deg\n1,-40,-30\n2,2,20\n", "magnitudes of 0 or more, found -40: .*dB"),
        ("a_magnitude,a_phase\n1,1,2\n2,2,3\n", "'a_rad' or 'a_deg'.*no such column"),
        ("a_magnitude,a_rad,a_deg\n1,1,2,3\n", "'a_rad' or 'a_deg'.*found both"),
        ("a_re,a_im,a_magnitude,a_rad\n1,1,2,3,4\n", "'a_rad' or 'a_deg'.*found both"),
        ("a_magnitude,a_im\n1,1,2\n", "'a_rad' or 'a_deg'.*no such column"),
    ],
)
def test_magnitudes_and_phases_of_other_units(tmp_path: Path, columns: str, says: str) -> None:
    (tmp_path / "a.csv").write_text("frequency," + columns)
    with pytest.raises(InputError, match=says):
        read_test(tmp_path / "a.csv")


def test_columns_are_named_freely(tmp_path: Path) -> None:
    f, H = np.arange(1, 31.0), _functions(0)
    path = _csv(tmp_path / "0.csv", f, H)
    test = _test_file(tmp_path, ["0.csv"], ["a"])
    (right,) = read_test(test).sets
    path.write_text(path.read_text().replace("frequency", "f [Hz]").replace("b_", "acc 1_"))
    path.write_text(path.read_text().replace("a_re", "A real").replace("a_im", "A imag"))
    names = '{ "f [Hz]" = "frequency", "acc 1" = "b", "A real" = "a_re", "A imag" = "a_im" }'
    text = test.read_text()
    test.write_text(f"{text}columns = {names}\n")
    (found,) = read_test(test).sets
    assert found.data.responses == ("a", "b")
    np.testing.assert_array_equal(found.data.H, right.data.H)
    test.write_text(f"{text}columns = {names[:-1]}, other = 'c' }}\n")
    with pytest.raises(InputError, match=r"columns: expected a column of the CSV files .*'other'"):
        read_test(test)


def test_a_name_with_a_hyphen_turns_no_sign(tmp_path: Path) -> None:
    H = {"deck-1": _functions(0)["a"], "deck": _functions(0)["b"]}
    _csv(tmp_path / "0.csv", np.arange(1, 31.0), H)
    (found,) = read_test(_test_file(tmp_path, ["0.csv"], ["deck"])).sets
    assert found.data.responses == ("deck-1", "deck")
    np.testing.assert_allclose(found.data.H[0], [H["deck-1"], H["deck"]], rtol=1e-8)


@pytest.mark.parametrize("value", ["", "0", "2.5"])
def test_functions_that_say_nothing_are_left_out(tmp_path: Path, value: str) -> None:
    path = _csv(tmp_path / "a.csv", np.arange(1, 31.0), _functions(0))
    header, *rows = path.read_text().splitlines()
    rows = [f"{row},{value},{value}" for row in rows]
    path.write_text("\n".join([f"{header},c_re,c_im", *rows]) + "\n")
    (data_set,) = read_test(path).sets
    data = data_set.data
    assert data.responses == ("a", "b", "c")
    assert np.isnan(data.H[0, 2]).all()
    assert data.H[0, :2] == pytest.approx(np.array(list(_functions(0).values())))
    what = "one number at all lines" if value == "2.5" else "empty or only zeros"
    assert f"'c_im': {what}; the channel is left out" in "\n".join(data_set.warnings)
    if not value:
        text = path.read_text()
        path.write_text(text.replace(rows[3], rows[3] + "7"))
        with pytest.raises(InputError, match=r"line 2, column 'c_im': .*found ''"):
            read_test(path)
        path.write_text("\n".join([f"{header},c_re,c_im", *(f"{row}7" for row in rows)]) + "\n")
        with pytest.raises(InputError, match=r"column 'c_re': expected numbers.*an empty one"):
            read_test(path)


@pytest.mark.parametrize("value", ["", "4.5"])
def test_records_that_never_move_are_left_out(tmp_path: Path, value: str) -> None:
    t = np.arange(400) * 0.01
    for k in range(2):
        rng = np.random.default_rng(k)
        force = np.where(t < 0.03, 1.0 + t, 0.0) + 1e-3 * rng.standard_normal(t.size)
        move = np.exp(-2 * t) * np.sin(30 * t) + 1e-3 * rng.standard_normal(t.size)
        rows = [f"{a:.9g},{b:.9g},{value},{c:.9g}" for a, b, c in zip(t, force, move, strict=True)]
        (tmp_path / f"{k}.csv").write_text("\n".join(["time,force,still,top", *rows]) + "\n")
    (data_set,) = read_test(_test_file(tmp_path, ["0.csv", "1.csv"], ["a", "a"])).sets
    data = data_set.data
    assert np.isnan(data.H[0, data.responses.index("still")]).all()
    assert np.isfinite(data.H[0, data.responses.index("top")]).all()
    assert "'still': empty or only zeros; the channel is left out" in "\n".join(data_set.warnings)


def test_records_without_times_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,force,a\n,0,1\n,1,2\n,0,3\n")
    with pytest.raises(InputError, match="columns: expected a time axis of even steps"):
        read_test(tmp_path / "a.csv")
