"""Decks of CalculiX: what parameters multiply, jobs that are made and run, updated decks."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import modefront as mf
from modefront.programs.changes import (
    CHANGES,
    changes,
    read_changes,
    write_changes,
    write_deck,
)
from modefront.study.examples import write_example
from modefront.study.importing import (
    job_text,
    lines_of,
    model_of,
    printed_frequencies,
    targets_of,
)

CCX = shutil.which("ccx")
needs_ccx = pytest.mark.skipif(CCX is None, reason="CalculiX (ccx) is not installed")

DECK = """\
** *ELASTIC in a comment
*INCLUDE, INPUT=steel.inp
*Material, Name=Wood
*Elastic, Type=Engineering Constants
11e9, 5e8, 5e8, 0.3, 0.3, 0.4, 7e8, 7e8,
4e8, 293.
*Density
600.
*Shell section, elset=Deck, material=Wood
0.02
*Spring, elset=Feet

2e5
*Spring, elset=Ends
3
4000
*Mass, elset=Box
12.5
*Step
*Frequency, Solver=Matrixstorage
*End step
"""
STEEL = "*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1E11, 0.3, 293.\n2.0E11, 0.3, 400.\n*DENSITY\n7850,\n"


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    (tmp_path / "steel.inp").write_text(STEEL)
    (tmp_path / "bridge.inp").write_text(DECK)
    return tmp_path / "bridge.inp"


@pytest.mark.parametrize(
    ("kind", "name", "places"),
    [
        ("material", "steel", [[0], [0]]),
        ("material", "WOOD", [[0, 1, 2, 6, 7], [0]]),
        ("density", "Steel", [[0]]),
        ("density", "wood", [[0]]),
        ("section", "DECK", [[0]]),
        ("spring", "feet", [[0]]),
        ("spring", "ends", [[0]]),
        ("mass", "box", [[0]]),
    ],
)
def test_a_parameter_multiplies_what_the_deck_says_of_a_name(
    kind: str, name: str, places: list[list[int]], deck: Path
) -> None:
    lines = list(lines_of(deck))
    multiplied, _ = targets_of(deck, lines, {"x": f"{kind}:{name}"})
    before = job_text(deck, lines, multiplied, {}, stored=True).splitlines()
    after = job_text(deck, lines, multiplied, {"x": 2.0}, stored=True).splitlines()
    pairs = [(x.split(","), y.split(",")) for x, y in zip(before, after, strict=True) if x != y]
    scaled = [[k for k, (a, b) in enumerate(zip(x, y, strict=True)) if a != b] for x, y in pairs]
    assert scaled == places
    for x, y in pairs:
        for a, b in zip(x, y, strict=True):
            if a != b:
                assert float(b) == 2 * float(a)
                assert "." in b or "e" in b, "a number with a point, as programs want it"


def test_jobs_store_matrices_or_print_frequencies(deck: Path) -> None:
    lines = list(lines_of(deck))
    assert "*FREQUENCY, SOLVER=MATRIXSTORAGE\n*End" in job_text(deck, lines, [], {}, stored=True)
    assert "*FREQUENCY\n10\n*End" in job_text(deck, lines, [], {}, stored=False)
    assert "INCLUDE" not in job_text(deck, lines, [], {}, stored=True)


def test_what_cannot_be_run_is_refused(deck: Path, tmp_path: Path) -> None:
    with pytest.raises(mf.InputError, match="expected a program that is installed, found 'no-ccx'"):
        mf.import_deck(deck, {"E": "material:STEEL"}, run="no-ccx")
    wrong = {"E": "material:STEAL", "k": "spring:BOX", "x": "colour:RED", "t": "section"}
    with pytest.raises(mf.InputError) as caught:
        mf.import_deck(deck, wrong, run=sys.executable)
    E, k, x, t = map(str, caught.value.faults)
    assert "--parameter E: expected a name with *ELASTIC" in E
    assert "did you mean 'STEEL'" in E
    assert "a name with *SPRING" in k
    assert "one of material, density, spring, mass, section, found 'colour:RED'" in x
    assert "found 'section'" in t
    assert not list(tmp_path.glob("*-jobs"))
    with pytest.raises(mf.InputError, match=r"a run of .* that writes \.sti"):
        mf.import_deck(deck, {"E": "material:STEEL"}, run=sys.executable)
    functions: Any = {"t": {"stifness": ["t^3"]}}
    with pytest.raises(mf.InputError, match="functions 't': expected stiffness or mass, found"):
        mf.import_deck(deck, {"t": "section:DECK"}, run=sys.executable, functions=functions)
    deck.write_text(DECK.replace("*Frequency", "*Static"))
    with pytest.raises(mf.InputError, match=r"expected a step with \*FREQUENCY, found none"):
        mf.import_deck(deck, {"E": "material:STEEL"}, run=sys.executable)
    with pytest.raises(mf.InputError, match="a deck of CalculiX"):
        mf.import_deck(tmp_path / "none.inp", {"E": "material:STEEL"}, run=sys.executable)


def test_what_is_no_number_in_a_deck_is_nothing_to_multiply(deck: Path) -> None:
    (deck.parent / "steel.inp").write_text(STEEL.replace("7850", "heavy"))
    with pytest.raises(mf.InputError, match=r"a name with \*DENSITY, found 'STEEL'"):
        mf.import_deck(deck, {"rho": "density:STEEL"}, run=sys.executable)


@needs_ccx
def test_a_deck_is_imported_with_jobs_of_its_own_and_comes_back_whole(tmp_path: Path) -> None:
    write_example("calculix", tmp_path / "decks")
    own = (tmp_path / "decks" / "nominal.inp").read_text()
    assert "*INCLUDE" in own
    deck = tmp_path / "decks" / "floor.inp"
    deck.write_text(own.replace("*FREQUENCY, SOLVER=MATRIXSTORAGE", "*FREQUENCY\n8"))
    parameters = {"columns": "material:COLUMNS", "t": "section:PLATE", "k": "spring:SPRING"}
    parameters |= {"E": "material:PLATE", "rho": "density:PLATE"}
    imported = mf.import_deck(deck, parameters)
    assert max(imported.errors) < 1e-10
    names = set(imported.terms.ranks)
    assert {"E*t", "E/t", "rho*t"} <= names
    assert "t" not in names
    assert any("those that the program prints" in note for note in imported.notes)
    imported.write(tmp_path / "study")
    assert '\nname = "floor"\n' in (tmp_path / "study" / "study.toml").read_text()
    theta = {"columns": 1.3, "t": 1.2, "k": 0.6, "E": 0.8, "rho": 1.1}
    write_deck(tmp_path / "study", theta, tmp_path / "decks")
    subprocess.run([str(CCX), "floor"], cwd=deck.parent, check=True, capture_output=True)
    expected = printed_frequencies(tmp_path / "decks" / "floor.dat")
    lam = model_of(imported.terms).full_modes(np.array(list(theta.values())), 8).lam
    assert np.sqrt(lam) / (2 * np.pi) == pytest.approx(expected, rel=2e-5)


PLATE = """\
*NODE, NSET=ALL
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
*ELEMENT, TYPE=S4, ELSET=DECK
1, 1, 2, 3, 4
*MATERIAL, NAME=STEEL
*ELASTIC
2.1e11, 0.3
*DENSITY
7850
*SHELL SECTION, ELSET=DECK, MATERIAL=STEEL
0.02
*BOUNDARY
1, 1, 3
2, 1, 3
*STEP
*FREQUENCY
3
*END STEP
"""


@needs_ccx
def test_terms_of_a_thickness_that_are_zero_are_left_out(tmp_path: Path) -> None:
    deck = tmp_path / "plate.inp"
    deck.write_text(PLATE)
    imported = mf.import_deck(deck, {"t": "section:DECK"})
    assert [*imported.terms.ranks] == ["t", "1/t"]
    assert max(imported.errors) < 1e-10
    deck.write_text(PLATE.replace("\n0.02\n", "\n0.002\n"))
    for what, is_lost in (("section:DECK", True), ("material:STEEL", False)):
        notes = mf.import_deck(deck, {"x": what}).notes
        assert any("shells so thin lose digits" in note for note in notes) is is_lost


@needs_ccx
def test_what_the_program_says_of_a_deck_is_not_cut_at_a_star(tmp_path: Path) -> None:
    deck = tmp_path / "plate.inp"
    deck.write_text(PLATE.replace("*BOUNDARY", "*SPRING, ELSET=DECK\n*BOUNDARY"))
    with pytest.raises(mf.InputError, match=r"found reading \*SPRING: \*SPRING card"):
        mf.import_deck(deck, {"t": "section:DECK"})


def test_factors_of_powers_of_ten_have_a_point(deck: Path) -> None:
    deck.write_text(DECK.replace("4000", "4e20"))
    lines = list(lines_of(deck))
    multiplied, _ = targets_of(deck, lines, {"k": "spring:ENDS"})
    assert "\n8.e+20\n" in job_text(deck, lines, multiplied, {"k": 2.0}, stored=True)


def test_a_study_beside_its_deck_has_it_back_whole_and_no_other_one(tmp_path: Path) -> None:
    write_example("calculix", tmp_path / "study")
    deck, theta = tmp_path / "study" / "nominal.inp", dict.fromkeys(("plate", "columns"), 0.5)
    theta |= dict.fromkeys(("spring", "mass"), 2.0)
    assert not write_deck(tmp_path / "study", theta, tmp_path)
    before, after = deck.read_text().splitlines(), (tmp_path / "nominal.inp").read_text()
    changed = [y for x, y in zip(before, after.splitlines(), strict=True) if x != y]
    assert changed == ["1.05e+11, 0.3", "1.05e+11, 0.3", "800000.", "16."]
    (tmp_path / "nominal.inp").unlink()
    deck.write_text(deck.read_text().replace("2.100000e+11", "7.000000e+10"))
    left_out = write_deck(tmp_path / "study", theta, tmp_path)
    assert re.match(r"nominal\.inp: line \d+ of .* is not as it was imported: ", left_out)
    assert not (tmp_path / "nominal.inp").exists()


@pytest.mark.parametrize("comment", ["** Träger, 3 µm".encode("latin-1"), "** Träger".encode()])
def test_a_deck_comes_back_with_the_bytes_that_no_parameter_changes(
    comment: bytes, tmp_path: Path
) -> None:
    """Comments in Latin-1 and UTF-8, ends of lines of Windows, a changed line with both."""
    parts = [b"** made by hand", comment, b"*ELASTIC", b"2.0E11, 0.3, " + comment]
    nominal, run = tmp_path / "beam.inp", tmp_path / "E.inp"
    nominal.write_bytes(b"\r\n".join(parts))
    run.write_bytes(nominal.read_bytes().replace(b"2.0E11", b"4.0E11"))
    known, _ = changes("E", nominal, run, 2.0)
    write_changes(tmp_path / CHANGES, known)
    assert read_changes(tmp_path / CHANGES) == known
    (tmp_path / "out").mkdir()
    for factor, number in ((1.0, b"2.e+11"), (1.5, b"3.e+11")):
        assert not write_deck(tmp_path, {"E": factor}, tmp_path / "out")
        expected = nominal.read_bytes().replace(b"2.0E11", number)
        assert (tmp_path / "out" / "beam.inp").read_bytes() == expected


def test_numbers_of_nastran_stay_in_their_fields(tmp_path: Path) -> None:
    deck = tmp_path / "plate.bdf"
    fixed = "MAT1           1  2.1+11             0.3  7850.0"
    large = f"{'MAT1*':8}{'1':>16}{'2.1+11':>16}{'':16}{'0.3':>16}"
    free = "MAT1,1,2.1+11,,.3"
    for name, E in (("plate", "2.1+11"), ("run", "4.2+11")):
        rows = (text.replace("2.1+11", E) for text in (fixed, large, free))
        deck.with_stem(name).write_text("\n".join(rows))
    found, _ = changes("E", deck, deck.with_stem("run"), 2.0)
    write_changes(tmp_path / CHANGES, found)
    (tmp_path / "out").mkdir()
    assert not write_deck(tmp_path, {"E": 0.8512345678}, tmp_path / "out")
    first, second, third = (tmp_path / "out" / deck.name).read_text().splitlines()
    assert first == "MAT1           11.788+11             0.3  7850.0"
    assert second == large.replace("       2.1+11", "1.78759259+11")
    assert third == "MAT1,1,1.78759259e+11,,.3"


def test_the_deck_of_a_job_with_a_point_in_its_name(tmp_path: Path) -> None:
    for job, text in (("base", "2.0,"), ("k-1", "2.0,"), ("k-1.5", "3.0,")):
        (tmp_path / f"{job}.inp").write_text(f"*SPRING\n{text}\n")
    (change,), other = changes("k", tmp_path / "base", tmp_path / "k-1.5", 1.5)
    assert (change.line, change.text, other) == (2, "2.0,", None)


def test_a_deck_of_which_some_numbers_are_not_known_is_not_written(tmp_path: Path) -> None:
    """Of a rod, the radius of which doubles, area and moment have no factor of two."""
    nominal, text = tmp_path / "rod.inp", "*ELASTIC\n{E},\n*SECTION\n{r},\n{A},\n"
    nominal.write_text(text.format(E=2.0, r=3.0, A=9.0))
    nominal.with_stem("E").write_text(text.format(E=4.0, r=3.0, A=9.0))
    nominal.with_stem("r").write_text(text.format(E=2.0, r=6.0, A=36.0))
    (known, _), (unknown, _) = (changes(x, nominal, nominal.with_stem(x), 2.0) for x in "Er")
    assert (len(known), unknown) == (1, [])
    write_changes(tmp_path / CHANGES, known)
    (tmp_path / "out").mkdir()
    assert "which numbers belong to r is not known" in write_deck(
        tmp_path, {"E": 1.5, "r": 1.1}, tmp_path / "out"
    )
    assert not list((tmp_path / "out").iterdir())
