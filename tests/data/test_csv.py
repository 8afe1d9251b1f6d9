"""Modal data in CSV: what is read, and what an empty field means."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from modefront.data.csv import read_csv, read_numbers
from modefront.data.modal import ModalData, modal_data
from modefront.errors import InputError
from modefront.models.chain import chain
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem, updating_problem

SENSORS = ("low", "top")
nan = np.nan


def read(folder: Path, text: str, sensors: tuple[str, ...] | None = SENSORS) -> ModalData:
    file = folder / "modes.csv"
    file.write_text(text, encoding="utf-8")
    return read_csv(file, sensors)


def test_sets_modes_and_sensors_with_gaps(tmp_path: Path) -> None:
    data = read(
        tmp_path,
        "set,mode,frequency,damping,low,top\n"
        "hammer,3,11.5,0.02,1,-0.5\n"
        "hammer,1,4.0,,0.5,1e0\n"
        "ambient,1,4.1,.01,,+2.\n",
    )
    assert data.sets == ("hammer", "ambient")
    assert data.modes == (1, 3)
    assert data.sensors == SENSORS
    np.testing.assert_array_equal(data.frequency, [[4.0, 11.5], [4.1, nan]])
    np.testing.assert_array_equal(data.damping, [[nan, 0.02], [0.01, nan]])
    shapes = [[[0.5, 1.0], [1.0, -0.5]], [[nan, 2.0], [nan, nan]]]
    np.testing.assert_array_equal(data.shape, shapes)
    np.testing.assert_array_equal(data.mean_frequency, [4.05, 11.5])


def test_standard_deviations(tmp_path: Path) -> None:
    data = read(
        tmp_path,
        "set,mode,frequency,damping,low,top,top_std,frequency_std\n"
        "a,1,4.0,,0.5,1.0,0.02,0.1\n"
        "a,2,11.0,,1.0,-0.5,,0\n",
    )
    np.testing.assert_array_equal(data.frequency_std, [[0.1, 0.0]])
    np.testing.assert_array_equal(data.shape_std, [[[nan, 0.02], [nan, nan]]])


def test_columns_may_come_in_any_order_and_rows_too(tmp_path: Path) -> None:
    plain = read(tmp_path, "set,mode,frequency,damping,low,top\na,1,4,,1,2\na,2,5,,3,4\n")
    mixed = read(tmp_path, "top,damping,mode,low,set,frequency\n4,,2,3,a,5\n2,,1,1,a,4\n")
    assert mixed.modes == plain.modes
    np.testing.assert_array_equal(mixed.frequency, plain.frequency)
    np.testing.assert_array_equal(mixed.shape, plain.shape)


def test_sensors_follow_the_model_not_the_file(tmp_path: Path) -> None:
    text = "set,mode,frequency,damping,low,top\na,1,4,,1,2\n"
    assert read(tmp_path, text, ("top", "low")).shape.tolist() == [[[2.0, 1.0]]]
    assert read(tmp_path, text, None).sensors == SENSORS


def test_sensors_that_the_columns_name_are_not_their_deviations(tmp_path: Path) -> None:
    text = "set,mode,frequency,damping,x,x_std,y_std,frequency_std\na,1,4,,1,2,3,4\n"
    data = read(tmp_path, text, None)
    assert data.sensors == ("x", "y_std")
    assert data.shape.tolist() == [[[1.0, 3.0]]]
    assert data.shape_std[0, 0, 0] == 2.0


def test_what_spreadsheets_write(tmp_path: Path) -> None:
    data = read(
        tmp_path,
        "\ufeffset, mode, frequency, damping, low, top\r\n"
        '"set, first", "1", 4.0, , 1, "2"\r\n'
        ", , , , ,\r\n"
        "\r\n",
    )
    assert data.sets == ("set, first",)
    assert data.shape.tolist() == [[[1.0, 2.0]]]


def test_quoted_names_behind_a_blank_have_no_quotes(tmp_path: Path) -> None:
    (tmp_path / "y.csv").write_text('time, "acc 1", acc 2\n0.0, 1.0, 2.0\n0.1, 3.0, 4.0\n')
    assert read_numbers(tmp_path / "y.csv", "records")[0] == ["time", "acc 1", "acc 2"]


def test_commas_of_names_in_quotes_separate_nothing(tmp_path: Path) -> None:
    text = 'mode;frequency;"deck, left, low";"deck, top"\n1;4,5;1,5;2\n'
    data = read(tmp_path, text, None)
    assert data.sensors == ("deck, left, low", "deck, top")
    assert data.shape.tolist() == [[[1.5, 2.0]]]


def test_line_numbers_are_those_of_the_file(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, "\nset,mode,frequency,damping,low,top\n\na,1,x,,1,2\n\na,2,4,,y,2\n")
    assert [fault.place for fault in caught.value.faults] == [
        "line 4, column 'frequency'",
        "line 6, column 'low'",
    ]


def test_what_is_not_measured_drops_out_of_residuals_and_counts(tmp_path: Path) -> None:
    model = chain(["k"], [1.0, 1.0], [900.0, 800.0], stiffness_parameters=["k", None])
    header = "set,mode,frequency,damping,floor1,floor2\n"

    def problem(rows: str, *groups: Group) -> UpdatingProblem:
        data = read(tmp_path, header + rows, model.sensors)
        unit = np.ones(1)
        return UpdatingProblem(model, data, groups, 0.5 * unit, 2 * unit, unit)

    frequency, shape = Group("f", frequency="all"), Group("s", shape="all")
    whole = problem("a,1,2.5,,0.6,1\na,2,7,,1,-0.6\n", frequency, shape)
    assert whole.properties.tolist() == [2.0, 4.0]
    gaps = problem("a,1,,,0.6,1\na,2,7,,1,\n", frequency, shape)
    assert gaps.properties.tolist() == [1.0, 3.0]
    twice = problem("a,1,2.5,,0.6,1\nb,1,2.6,,,1\n", frequency, shape)
    assert twice.properties.tolist() == [1.0, 1.5]

    f = whole.model.modes(np.ones(1), 2).frequency
    evaluation = gaps.evaluate(np.ones(1))
    np.testing.assert_allclose(evaluation.J[0], (f[1] / 7 - 1) ** 2, rtol=1e-12)
    # A shape at one sensor fits exactly: what is left is the first mode.
    alone = problem("a,1,2.5,,0.6,1\n", frequency, shape)
    np.testing.assert_allclose(evaluation.J[1], alone.evaluate(np.ones(1)).J[1], rtol=1e-9)


def test_arrays_make_the_same_data_as_a_file(tmp_path: Path) -> None:
    read_data = read(tmp_path, "set,mode,frequency,damping,low,top\n1,1,4,,1,2\n1,2,5,0.1,3,\n")
    made = modal_data(
        np.array([4.0, 5.0]),
        np.array([[1.0, 2.0], [3.0, nan]]),
        SENSORS,
        damping=np.array([nan, 0.1]),
    )
    for name in ("sets", "modes", "sensors"):
        assert getattr(made, name) == getattr(read_data, name)
    for name in ("frequency", "damping", "shape", "frequency_std", "shape_std"):
        np.testing.assert_array_equal(getattr(made, name), getattr(read_data, name))
    with pytest.raises(InputError, match="shape: expected 1 modes x 3 sensors, found 1 x 2"):
        modal_data(np.ones(1), np.ones((1, 2)), ("a", "b", "c"))


@pytest.mark.parametrize(
    ("frequency", "shape", "message"),
    [
        ([1.0, 2.0], [[1.0, 1j], [0.0, 1.0]], "shape: expected real numbers.* found complex ones"),
        ([1.0, 2.0], [[1.0, 1.0], [0.0, nan]], "shape of mode 2 in set 1: expected a mode"),
        ([1.0, 0.0], [[1.0, 1.0], [1.0, nan]], "frequency of mode 2 in set 1: expected a"),
        ([[1.0], [2.0]], [[[1.0, 1.0]]] * 2, "sets: expected 2 names, found 1"),
    ],
)
def test_arrays_of_which_no_residuals_can_be_made_are_refused(
    frequency: Any, shape: Any, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        modal_data(np.array(frequency), np.array(shape), SENSORS, sets=("a",))


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_columns_are_separated_as_spreadsheets_do(separator: str, tmp_path: Path) -> None:
    text = "\ufeffset,mode,frequency,low,top\r\na,1,4.5,1,-2e-1\r\n".replace(",", separator)
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.frequency, [[4.5]])
    np.testing.assert_array_equal(data.damping, [[nan]])
    np.testing.assert_array_equal(data.shape, [[[1.0, -0.2]]])


@pytest.mark.parametrize("separator", [";", "\t"])
def test_decimal_commas_and_columns_left_out(separator: str, tmp_path: Path) -> None:
    text = ";;;\nmode;frequency;low;top\n1;4,5;,5;-0,2\n2;11,0;-1,5e0;\n".replace(";", separator)
    data = read(tmp_path, text)
    assert data.sets == ("1",)
    np.testing.assert_array_equal(data.frequency, [[4.5, 11.0]])
    np.testing.assert_array_equal(data.shape, [[[0.5, -0.2], [-1.5, nan]]])


@pytest.mark.parametrize("first", ["sep=;\r\n", "\ufeffsep=;\n", '"sep=;"\n', "SEP=;;;;\n"])
def test_a_first_line_that_says_the_separator(first: str, tmp_path: Path) -> None:
    data = read(tmp_path, first + "mode;frequency;low;top\n1;4,5;,5;-0,2\n")
    np.testing.assert_array_equal(data.frequency, [[4.5]])
    np.testing.assert_array_equal(data.shape, [[[0.5, -0.2]]])
    with pytest.raises(InputError, match="line 3, column 'frequency'"):
        read(tmp_path, first + "mode;frequency;low;top\n1;4.,5;,5;-0,2\n")


def test_empty_columns_at_the_end_are_left_out(tmp_path: Path) -> None:
    data = read(tmp_path, "mode;frequency;low;top;;\n1;4,5;,5;-0,2;;\n2;9;1;1;; ;\n")
    np.testing.assert_array_equal(data.frequency, [[4.5, 9.0]])
    with pytest.raises(InputError, match="line 2: expected 4 fields, as in the header, found 6"):
        read(tmp_path, "mode;frequency;low;top;;\n1;4,5;,5;-0,2;;7\n")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("mode;frequency;low;top\n1;1.234,5;1;2\n", "a finite number or an empty field"),
        ("mode;frequency;low;top\n1;1,2,3;1;2\n", "a finite number or an empty field"),
        ("mode,frequency,low,top\n1,4,1,2\n1,5,1,2\n", "or a column 'set' that tells data sets"),
        ("mode,frequency,damping,low,top\n1,4,1.5,1,2\n", "if 1.5 % is meant: 0.015"),
    ],
)
def test_numbers_that_are_none_and_modes_twice(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=says):
        read(tmp_path, text)


def test_columns_of_other_names(tmp_path: Path) -> None:
    text = "No.;f [Hz];acc 1;acc 1_std;top\n1;4,5;,5;0,1;-0,2\n"
    file = tmp_path / "modes.csv"
    file.write_text(text)
    columns = {"No.": "mode", "f [Hz]": "frequency", "acc 1": "low"}
    data = read_csv(file, SENSORS, columns)
    np.testing.assert_array_equal(data.frequency, [[4.5]])
    np.testing.assert_array_equal(data.shape, [[[0.5, -0.2]]])
    np.testing.assert_array_equal(data.shape_std, [[[0.1, nan]]])
    with pytest.raises(InputError, match=r"columns 'acc': .* found 'acc' .did you mean 'acc 1'"):
        read_csv(file, SENSORS, {**columns, "acc": "low"})
    with pytest.raises(InputError, match="column 'top': expected each column once"):
        read_csv(file, SENSORS, {**columns, "acc 1": "top"})


def test_data_at_some_of_the_sensors_of_a_model(tmp_path: Path) -> None:
    names = ("floor1", "floor2", "floor3")
    model = chain(["k"], [1.0] * 3, [900.0, 800.0, 700.0], stiffness_parameters=["k", None, None])
    groups = [Group("f", frequency="all"), Group("s", shape="all")]
    bounds, nominal = {"k": (0.5, 2.0)}, {"k": 1.0}
    some = modal_data(
        np.array([2.0, 6.0]), np.array([[1.0, 0.4], [-0.6, 1.0]]), ("floor3", "floor1")
    )
    problem = updating_problem(model, some, groups, bounds, nominal)
    header = "mode,frequency,floor1,floor2,floor3\n"
    same = read(tmp_path, header + "1,2,0.4,,1\n2,6,1,,-0.6\n", names)
    right = updating_problem(model, same, groups, bounds, nominal)
    np.testing.assert_array_equal(problem.evaluate(np.ones(1)).J, right.evaluate(np.ones(1)).J)
    assert problem.properties.tolist() == right.properties.tolist()
    other = modal_data(np.ones(1), np.ones((1, 1)), ("flor3",))
    with pytest.raises(ValueError, match=r"found 'flor3' .did you mean 'floor3'"):
        updating_problem(model, other, groups, bounds, nominal)
