"""Groups and given weights that make no front."""

from pathlib import Path

import pytest
from faultless import DATA, STUDY, WEIGHTED
from refusals import Check, edited, refuses

WEIGHT = "[[weighted]] 1 ('mine') weights shapes: expected a weight above 0, found "

CONTRADICTIONS = [
    # groups
    ('"frequencies"', '"shapes"', "[[group]]: expected each name once, found 'shapes' twice"),
    (
        'frequency = "all"\n',
        "",
        "[[group]] 1 ('frequencies'): ... one measured mode, found nothing",
    ),
    (
        'scale = "measured"',
        'scale = "std"',
        "1 ('frequencies') scale: expected 'std' with standard deviations above 1e-09 of all "
        "measured frequencies, found others for the frequency of mode 2",
    ),
    (
        "shape = [1, 2]",
        'shape = [1, 2]\nscale = "std"',
        "2 ('shapes') scale: expected 'std' with standard deviations of all measured components, "
        "one of them above 0, found others for the shape of mode 1",
    ),
    ('frequency = "all"', "frequency = []", "1 ('frequencies'): ... measured mode, found nothing"),
    ('frequency = "all"', "frequency = [3]", "expected one of the measured modes [1, 2], found 3"),
    ("shape = [1, 2]", "shape = [3]", "shape: expected one of the measured modes [1, 2], found 3"),
    ("shape = [1, 2]", "shape = [1, 1]", "shape: expected ... each once, found [1, 1]"),
    # weights
    ("shapes = 2.0", "shape = 2.0", "weights shape: ... found 'shape' (did you mean 'shapes'?)"),
    (", shapes = 2.0", "", WEIGHT + "nothing"),
    ("shapes = 2.0", "shapes = 0", WEIGHT + "0"),
    ("shapes = 2.0", "shapes = -1", WEIGHT + "-1"),
    ("shapes = 2.0", "shapes = nan", WEIGHT + "nan"),
    ("shapes = 2.0", "shapes = inf", WEIGHT + "inf"),
    ("shapes = 2.0", 'shapes = "2"', WEIGHT + "'2'"),
    ("shapes = 2.0", "shapes = true", WEIGHT + "true"),
    (WEIGHTED, 2 * WEIGHTED, "[[weighted]]: expected each name once, found 'mine' twice"),
    *(
        ('"mine"', f'"{label}"', f"name: expected another name than ... , found '{label}'")
        for label in (
            *("nbi-3", "weights-12", "spea2-1", "nsga2-40", "edge-shapes", "edge-frequencies"),
            *("equal-weights", "optimal-weights", "most-probable", "iterated-weights"),
            *("identifiable-1", "identifiable-edge-shapes", "nominal"),
        )
    ),
]


test_contradictions_of_groups_and_weights = refuses(*CONTRADICTIONS)


def more_groups(*lines: str) -> str:
    """Return further groups, and a study without given weights, which would have to name them."""
    groups = [f'[[group]]\nname = "more {i}"\n{line}\n\n' for i, line in enumerate(lines)]
    return "".join(groups) + "[pareto]"


MANY = [
    f"frequency = {frequency}\nshape = {shape}"
    for frequency in ([], [1], [2])
    for shape in ([], [1], [2])
    if frequency or shape
]
"""Groups of which no two are equal, nor equal to those of the study."""

GROUPED = [
    (
        more_groups(*MANY),
        f"[[group]]: expected at most ... groups, as many as measured ... , found {2 + len(MANY)}",
    ),
    (
        more_groups("shape = [2, 1]"),
        "[[group]]: expected other members than those of 'shapes', found 'more 0'",
    ),
    (
        more_groups("frequency = [1]") + "\npoints = 500",
        "[pareto] points: expected a number with at most 10000 points on ... 3 groups, found 500",
    ),
]


@pytest.mark.parametrize(("more", "says"), GROUPED)
def test_groups_that_cannot_make_a_front(
    more: str, says: str, folder: Path, refused: Check
) -> None:
    study = folder / "wrong.toml"
    text = edited(STUDY, (WEIGHTED, ""), ("points = 5\n", ""))
    study.write_text(edited(text, ("[pareto]", more)))
    refused(study, says)


def test_a_group_of_which_nothing_is_measured(folder: Path, refused: Check) -> None:
    data = edited(DATA, (",4.0,", ",,"), (",11.0,", ",,"), (",4.1,", ",,"))
    (folder / "modes.csv").write_text(data)
    says = "[[group]] 1 ('frequencies'): expected at least one measured property, found none"
    refused(folder / "chain.toml", says)
