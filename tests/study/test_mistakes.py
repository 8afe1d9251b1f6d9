"""Mistakes of engineers, each put into a study in which nothing is wrong, and found by a check."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from written import write

from modefront import (
    Group,
    ModalData,
    NoisePrior,
    Study,
    UpdatingProblem,
    chain,
    modal_data,
    updating_problem,
)
from modefront.cli.main import cli
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.search import diagnose
from modefront.models.matrices import MatrixModel
from modefront.modes.result import Modes
from modefront.study.check import Findings, check
from modefront.study.file import load

pytestmark = pytest.mark.slow(2)

CHAIN, FRAME, SETS = "three-story-c0", "three-story-fe-c1", "hammer-test"

Rows = list[dict[str, str]]


def spoilt(
    folder: Path, example: str, *edits: tuple[str, str], data: Callable[[Rows], None] | None = None
) -> Path:
    """Write an example with parts of the study file replaced and its data changed."""
    write(example, folder)
    study = folder / "study.toml"
    text = study.read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    study.write_text(text, encoding="utf-8")
    if data is not None:
        file = folder / ("modes-m0.csv" if example == SETS else "modes.csv")
        with file.open(encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
        data(rows)
        with file.open("w", encoding="utf-8", newline="") as stream:
            writer = csv.DictWriter(stream, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
    return study


def findings_of(study: Path) -> Findings:
    return check(load(study))


def only(study: Path) -> str:
    """Return the sentence on the only finding: consequences of a mistake are not reported."""
    findings = findings_of(study)
    assert len(findings.mistakes) == 1, findings.warnings
    assert len(findings.warnings) == 1, findings.warnings
    return findings.warnings[0]


def scaled(column: str, factor: float, where: str = "") -> Callable[[Rows], None]:
    """Return a change of a column by a factor, in one data set or in all."""

    def change(rows: Rows) -> None:
        for row in rows:
            if row["set"] == where or not where:
                row[column] = repr(factor * float(row[column] or 0.01))

    return change


def exchanged(rows: Rows) -> None:
    for row in rows:
        row["floor1"], row["floor2"] = row["floor2"], row["floor1"]


@pytest.mark.parametrize("example", [CHAIN, FRAME, SETS])
def test_nothing_is_found_where_nothing_is_wrong(example: str, tmp_path: Path) -> None:
    assert findings_of(spoilt(tmp_path, example)).mistakes == ()


@pytest.mark.parametrize("example", [CHAIN, FRAME])
def test_rad_per_second(example: str, tmp_path: Path) -> None:
    text = only(spoilt(tmp_path, example, data=scaled("frequency", 6.2831853)))
    assert "look like rad/s" in text
    assert "divide the column 'frequency' by 6.2832" in text


@pytest.mark.parametrize(("factor", "unit"), [(1e-6, "MPa"), (1e-9, "GPa"), (1e9, "GPa")])
def test_units_of_stiffness(factor: float, unit: str, tmp_path: Path) -> None:
    k = repr(84763.8 * factor)
    text = only(spoilt(tmp_path, CHAIN, ("84763.8", k)))
    assert "all measured frequencies are about" in text
    assert unit in text


def test_periods_and_eigenvalues(tmp_path: Path) -> None:
    def period(rows: Rows) -> None:
        for row in rows:
            row["frequency"] = repr(1 / float(row["frequency"]))

    def eigenvalue(rows: Rows) -> None:
        for row in rows:
            row["frequency"] = repr((6.2831853 * float(row["frequency"])) ** 2)

    assert "looks like periods in s" in only(spoilt(tmp_path / "a", CHAIN, data=period))
    assert "looks like eigenvalues" in only(spoilt(tmp_path / "b", CHAIN, data=eigenvalue))


def test_what_a_unit_mistake_brings_about_is_not_said(tmp_path: Path) -> None:
    study = spoilt(tmp_path, SETS, data=scaled("frequency", 6.2831853))
    text = " ".join(CliRunner().invoke(cli, ["check", "--all", str(study)]).output.split())
    assert "look like rad/s" in text
    assert "put this right first: it changes what the data determine" in text
    assert text.count("warning:") == 1
    assert "determine this combination" not in text
    assert "all data determine" not in text


@pytest.mark.parametrize(
    ("example", "sensor"), [(CHAIN, "floor1"), (CHAIN, "floor2"), (FRAME, "floor3")]
)
def test_a_reversed_sensor(example: str, sensor: str, tmp_path: Path) -> None:
    text = only(spoilt(tmp_path, example, data=scaled(sensor, -1.0)))
    assert f"sensor {sensor} is reversed in all data" in text
    assert re.search(r"\(without, MAC \d is 1\.00 after a fit, and not 0\.\d\d\)", text)
    assert f"check the direction of {sensor}" in text


@pytest.mark.slow(15)
def test_a_reversed_sensor_that_moves_too_little_for_the_mac() -> None:
    names = [f"k{i + 1}" for i in range(10)]
    springs, sensors = [names[i // 5] for i in range(50)], {f"s{i}": i for i in range(50)}
    model = chain(names, [1.0] * 50, [1e4] * 50, stiffness_parameters=springs, sensors=sensors)
    structure = model.modes(np.linspace(0.97, 1.05, 10), 4, derivatives=False)
    size = np.abs(structure.phi).max(axis=0)
    noise = 0.1 * size * np.random.default_rng(1).standard_normal(structure.phi.shape)
    noise[0] /= 20
    shape = (structure.phi + noise).T
    first = shape[:, 0].copy()
    groups = (Group("shapes", shape="all"),)
    unit = np.ones(10)
    for sign, expected in ((1.0, []), (-1.0, [("reversed-sensor", "s0, all data")])):
        shape[:, 0] = sign * first
        data = modal_data(structure.frequency, shape, model.sensors)
        mistakes = diagnose(
            compare(UpdatingProblem(model, data, groups, 0.2 * unit, 5 * unit, unit))
        )
        assert [(x.kind, x.subject) for x in mistakes] == expected


def test_exchanged_sensors_that_move_nearly_alike(tmp_path: Path) -> None:
    def exchange(rows: Rows) -> None:
        for row in rows:
            row["n7z"], row["n12z"] = row["n12z"], row["n7z"]

    text = only(spoilt(tmp_path, "calculix", data=exchange))
    assert "sensors n7z and n12z are exchanged" in text
    assert "check the cables of n7z and n12z" in text


def test_exchanged_sensors(tmp_path: Path) -> None:
    text = only(spoilt(tmp_path, FRAME, data=exchanged))
    assert "sensors floor1 and floor2 are exchanged in all data" in text


def test_sensors_of_one_data_set(tmp_path: Path) -> None:
    first = tmp_path / "modes-m0.csv"
    write(SETS, tmp_path / "plain")
    names = load(tmp_path / "plain" / "study.toml").problem.data.sets
    text = only(spoilt(tmp_path, SETS, data=scaled("floor2", -1.0, names[1])))
    assert f"sensor floor2 is reversed in set {names[1]}" in text
    assert first.exists()


def test_a_sensor_that_most_data_sets_have_reversed(tmp_path: Path) -> None:
    def change(rows: Rows) -> None:
        for name in ("set1", "set2"):
            scaled("floor1", -1.0, name)(rows)

    text = only(spoilt(tmp_path, SETS, data=change))
    assert "sensor floor1 is reversed in sets set1 and set2" in text


def test_a_data_set_in_another_unit_and_one_with_another_frequency(tmp_path: Path) -> None:
    write(SETS, tmp_path / "plain")
    name = load(tmp_path / "plain" / "study.toml").problem.data.sets[2]
    text = only(spoilt(tmp_path / "a", SETS, data=scaled("frequency", 6.2831853, name)))
    assert f"all frequencies of set {name} are 6.28 times" in text
    assert "rad/s for Hz" in text

    def first_row(rows: Rows) -> None:
        (row,) = (row for row in rows if row["set"] == name and row["mode"] == "2")
        row["frequency"] = repr(1.1 * float(row["frequency"]))

    text = only(spoilt(tmp_path / "b", SETS, data=first_row))
    assert f"set {name} disagrees with set1 and set2 in the frequency of mode 2" in text
    assert "14.394 and 13.085 Hz" in text
    assert f"look at set {name} again" in text


def test_of_three_sets_the_odd_one_is_named(tmp_path: Path) -> None:
    def shape(rows: Rows) -> None:
        (row,) = (row for row in rows if row["set"] == "set2" and row["mode"] == "2")
        row["floor1"], row["floor2"], row["floor3"] = "0.3", "1.0", "0.9"

    text = only(spoilt(tmp_path / "a", SETS, data=shape))
    assert "set set2 disagrees with" in text
    assert "in the shape of mode 2" in text
    text = only(spoilt(tmp_path / "b", SETS, data=scaled("frequency", 1.05, "set2")))
    assert "all frequencies of set set2 are +5.0 % off those of" in text


def test_of_two_sets_nobody_knows_which_is_wrong() -> None:
    model = chain(["k1", "k2", "k3"], [1.0] * 3, [100.0] * 3)
    modes = model.modes(np.ones(3), 3, derivatives=False)
    f = np.array([modes.frequency, modes.frequency])
    f[1, 1] *= 1.2
    nothing = np.full(f.shape, np.nan)
    shapes = np.array([modes.phi.T, modes.phi.T])
    data = ModalData(
        *(("old", "new"), (1, 2, 3), model.sensors, f, nothing, shapes),
        *(nothing, np.full((2, 3, 3), np.nan)),
    )
    groups, unit = (Group("shapes", shape="all"),), np.ones(3)
    problem = UpdatingProblem(model, data, groups, 0.2 * unit, 5 * unit, unit)
    (result,) = diagnose(compare(problem))
    assert "sets new and old disagree in the frequency of mode 2" in str(result)
    assert "+20.0 %" in str(result)
    assert "look at both again" in str(result)


def test_modes_that_one_set_numbers_differently(tmp_path: Path) -> None:
    write(SETS, tmp_path / "plain")
    name = load(tmp_path / "plain" / "study.toml").problem.data.sets[0]

    def renumbered(rows: Rows) -> None:
        for row in rows:
            if row["set"] == name:
                row["mode"] = {"1": "1", "2": "3", "3": "2"}[row["mode"]]

    text = only(spoilt(tmp_path / "a", SETS, data=renumbered))
    assert f"modes 2 and 3 of set {name} are modes 3 and 2 of" in text


def test_directions_that_do_not_match(tmp_path: Path) -> None:
    text = only(spoilt(tmp_path / "a", FRAME, ('direction = "x" }', 'direction = "y" }')))
    assert "direction y of floor1, floor2 and floor3 does not match the data: x does" in text
    edit = ('node = 37, direction = "x"', 'node = 37, direction = "y"')
    text = only(spoilt(tmp_path / "b", FRAME, edit))
    assert "direction y of floor2 does not match the data: x does" in text


def test_all_directions_are_said_that_fit_alike(tmp_path: Path) -> None:
    """One mode moves the sensor, and no other one: its shape does not say along which axis."""
    place = 'across12 = { node = 205, direction = "%s" }'
    (result,) = findings_of(spoilt(tmp_path, "footbridge", (place % "y", place % "z"))).mistakes
    found = {(x.kind, x.subject, x.numbers["better"]) for x in (result, *result.others)}
    assert found == {("wrong-direction", "across12", better) for better in ("x", "y", "-y")}
    assert "(the data cannot tell)" in str(result)


def test_two_sensors_at_one_degree_of_freedom(tmp_path: Path) -> None:
    text = only(spoilt(tmp_path, CHAIN, ("floor2 = 1", "floor2 = 2")))
    assert "floor2 fits the data at degree of freedom 1 and not at degree of freedom 2" in text
    assert "where the model has floor3 too" in text


def test_degrees_of_freedom_counted_from_one(tmp_path: Path) -> None:
    sensors = "sensors = { floor1 = 0, floor2 = 1, floor3 = 2 }"

    def without_third(rows: Rows) -> None:
        for row in rows:
            del row["floor3"]

    edit = (sensors, "sensors = { floor1 = 1, floor2 = 2 }")
    text = only(spoilt(tmp_path / "a", CHAIN, edit, data=without_third))
    assert "the degrees of freedom of the sensors look as if they were counted from 1" in text
    with pytest.raises(ValueError, match=r"from 0 to 2 .they are counted from 0., found 3"):
        load(
            spoilt(
                tmp_path / "b",
                CHAIN,
                (
                    sensors,
                    sensors.replace("0, fl", "1, fl")
                    .replace("= 2 }", "= 3 }")
                    .replace("floor2 = 1", "floor2 = 2"),
                ),
            )
        )


def test_damping_in_percent(tmp_path: Path) -> None:
    text = only(spoilt(tmp_path, CHAIN, data=scaled("damping", 80.0)))
    assert "damping of 0.8 to 0.8 looks like percent" in text
    assert "by 100" in text


@pytest.mark.parametrize(("second", "third"), [(None, "400.0"), ("15.2", "3.0")])
def test_pairs_far_apart(second: str | None, third: str, tmp_path: Path) -> None:
    """The shape of the third mode is that of the model's: its frequency is wrong."""

    def far(rows: Rows) -> None:
        rows[1]["frequency"], rows[2]["frequency"] = second or rows[1]["frequency"], third

    warnings = findings_of(spoilt(tmp_path, CHAIN, data=far)).warnings
    start = f"measured mode 3 at {float(third):g} Hz is paired with model mode 3 at 17.89 Hz (MAC 1"
    (text,) = (text for text in warnings if text.startswith(start))
    assert "none that is like it is near; check its frequency and shape" in text


def test_groups_of_the_mesh_without_elements(tmp_path: Path) -> None:
    study = spoilt(tmp_path, FRAME)
    mesh = tmp_path / "building.msh"
    text = mesh.read_text(encoding="utf-8")
    text = text.replace("$PhysicalNames\n6\n", '$PhysicalNames\n7\n1 9 "braces"\n')
    count = int(text.split("$Elements\n")[1].split("\n")[0])
    text = text.replace(f"$Elements\n{count}\n", f"$Elements\n{count + 1}\n")
    text = text.replace("$EndElements", f"{count + 1} 1 2 9 9 19 37\n$EndElements")
    mesh.write_text(text, encoding="utf-8")
    message = only(study)
    assert "mesh group 'braces' of 1 line cells has no elements" in message
    assert '[[model.group]] name = "braces"' in message


def test_the_table_sets_nominal_beside_measured_in_80_columns(tmp_path: Path) -> None:
    study = spoilt(
        tmp_path, SETS, ('name = "theta2"', 'name = "the stiffness of the second storey"')
    )
    text = study.read_text(encoding="utf-8").replace(
        '"theta2"', '"the stiffness of the second storey"'
    )
    study.write_text(text, encoding="utf-8")
    result = CliRunner().invoke(cli, ["check", "--all", str(study)])
    assert result.exception is None, result.output
    lines = result.output.replace(str(tmp_path), "").splitlines()
    assert max(map(len, lines)) <= 80
    header = next(line for line in lines if line.startswith("mode "))
    assert header.split() == ["mode", "Hz", "Hz", "%", "MAC", "mode"]
    assert sum("COMAC by sensor" in line for line in lines) == 1
    assert any(line.split()[:4] == ["parameter", "f1", "f2", "f3"] for line in lines)


def test_parameters_that_the_data_do_not_determine_are_to_be_fixed(tmp_path: Path) -> None:
    """One frequency determines one of three stiffnesses: the one on which it depends most."""
    shapes = ('[[group]]\nname = "shapes"\nshape = "all"\n', "")
    study = spoilt(tmp_path, CHAIN, shapes, ('frequency = "all"', "frequency = [1]"))
    assert set(findings_of(study).sensitivities.superfluous) == {"theta2", "theta3"}
    text = " ".join(CliRunner().invoke(cli, ["check", "--all", str(study)]).output.split())
    assert "at the nominal values, or measure more; the data determine the other" in text


def test_far_frequencies_of_a_nominal_model_leave_nothing_undetermined(tmp_path: Path) -> None:
    """Expected errors say what data determine, and not the misfits of a model to be updated."""

    def stiffer(rows: Rows) -> None:
        for row in rows:
            row["frequency"] = str(1.5 * float(row["frequency"]))

    findings = findings_of(spoilt(tmp_path, CHAIN, data=stiffer))
    assert not findings.warnings
    assert not findings.sensitivities.superfluous


def test_a_nominal_value_off_by_a_thousand(tmp_path: Path) -> None:
    study = spoilt(tmp_path, CHAIN)
    problem = load(study).problem
    factor = np.array([1.0, 1e3, 1.0])
    wrong = replace(
        problem,
        start=problem.start * factor,
        lower=problem.lower * factor,
        upper=problem.upper * factor,
    )
    (result,) = diagnose(compare(wrong))
    assert "the nominal value of theta2 is 1000, and the data say about 1" in str(result)


@pytest.mark.parametrize("weight", [4.0, 0.0])
def test_a_bound_that_excludes_what_fits(weight: float) -> None:
    """Nothing is said where nothing is expected of the errors, as in the verdict of a run."""
    model, structure = long_chain()
    data = modal_data(structure.frequency, structure.phi.T, model.sensors)
    groups, bounds = (
        [Group("frequencies", frequency="all")],
        dict.fromkeys(model.parameters, (0.2, 5.0)),
    )
    bounds["k2"] = (0.2, 1.2)
    problem = updating_problem(model, data, groups, bounds, dict.fromkeys(bounds, 1.0))
    said = check(Study(problem, noise=NoisePrior(weight=weight))).mistakes
    assert [(x.kind, x.subject) for x in said] == [("bound", "k2")] * (weight > 0)
    assert all("k2 is at its upper bound 1.2. With k2 = 2.5, errors of" in str(x) for x in said)


def long_chain() -> tuple[MatrixModel, Modes]:
    """Return a chain of twelve masses, and the modes of a structure with a spring that differs."""
    springs = [f"k{i // 4 + 1}" for i in range(12)]
    model = chain(["k1", "k2", "k3"], [1.0] * 12, [1e4] * 12, stiffness_parameters=springs)
    return model, model.modes(np.array([1.1, 2.5, 0.9]), 5, derivatives=False)


def test_two_mistakes_at_once() -> None:
    """The frequencies are in rad/s, and of twelve sensors two are exchanged and one is reversed."""
    model, structure = long_chain()
    shape = structure.phi.T.copy()
    shape[:, [2, 7]] = shape[:, [7, 2]]
    shape[:, 10] *= -1
    data = modal_data(2 * np.pi * structure.frequency, shape, model.sensors)
    groups, unit = (Group("shapes", shape="all"),), np.ones(3)
    result = diagnose(compare(UpdatingProblem(model, data, groups, 0.2 * unit, 5 * unit, unit)))
    names = model.sensors
    assert {each.subject for each in result} == {
        "frequencies",
        f"{names[2]}, {names[7]}, all data",
        f"{names[10]}, all data",
    }
