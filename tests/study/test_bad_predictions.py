"""Predictions that cannot be made."""

from pathlib import Path

import pytest
from faultless import DATA, STUDY
from refusals import Check, edited, refuses

CONTRADICTIONS = [
    ("[[predict.frf]]", "[[predict.fft]]", "[predict]: ... found 'fft' (did you mean 'frf'?)"),
    ("[[predict.frf]]", "[predict.frf]", "[predict] frf: expected tables [[predict.frf]], found a"),
    ("[[predict.frf]]", "[[predicted.frf]]", "found 'predicted' (did you mean 'predict'?)"),
    ('"drifts"', '"peak"', "[predict]: expected each name once, found 'peak' twice"),
    ('force = "top"', 'force = "tip"', "('peak') force: ... found 'tip' (did you mean 'top'?)"),
    ('force = "top"', "force = { tip = 2.0 }", "('peak') force: ... found 'tip' (did you mean 't"),
    ('force = "top"\n', "", "('peak'): expected either force or base, found neither"),
    ('force = "top"', 'force = "top"\nbase = "x"', "either force or base, found both"),
    (
        'base = "x"',
        'base = "y"',
        "base: expected one of the directions of the base, 'x', found 'y'",
    ),
    ('"low", "middle"', '"low", "midle"', "response: ... found 'midle' (did you mean 'middle'?)"),
    (
        "top = 1.0, low",
        "top = 1.0, lo",
        "('drifts') response: ... found 'lo' (did you mean 'low'?)",
    ),
    ('"mobility"', '"absolute accelerance"', "quantity: ... where forces act, found 'absolute acc"),
    ("modes = 2", "modes = 3", "modes: expected a whole number from 1 to 2, found 3"),
    ("modes = 2", "modes = 1", "modes: ... up to the end of the band, 15 Hz: 2, found 1, up to 4."),
    (
        'damping = "measured"\nmodes = 2',
        "damping = [0.01]",
        "('peak') damping: ... up to the end of the band, 15 Hz: 2, found 1, up to 4.",
    ),
    ("modes = 2", "modes = 2\nmode = 2", "('peak'): ... found 'mode' (did you mean 'modes'?)"),
    (
        'damping = "measured"',
        "damping = [0.01]",
        "damping: expected a list of 2, one a mode, found 1 of them",
    ),
    ('"measured"\nmodes = 2', "[0.1,0.1,0.1]", "damping: expected at most 2 ratios, as the model"),
    (
        "step = 0.02",
        "step = 0.1",
        "('drifts') step: expected at most 0.02 ... s, a quarter of the s",
    ),
    (
        "step = 0.02",
        "step = 0.03",
        "step: expected a whole number of steps of 0.03 s in 4 s, found 1",
    ),
    ("step = 0.02", "step = 1e-7", "step: expected at most 1000000 time steps, found 4e+07"),
    (
        "frequency = 2.5",
        "frequency = 0.0",
        "filter frequency: expected a frequency of the soil abo",
    ),
    (
        "damping = 0.6",
        "damping = -0.6",
        "filter damping: expected a damping ratio of the soil above",
    ),
    ("damping = 0.6", "damp = 0.6", "filter: ... found 'damp' (did you mean 'damping'?)"),
    (
        "middle = [",
        "low = [",
        "[model] outputs low: expected a name that no sensor has, found 'low'",
    ),
    ("middle = [[0,", "middle = [[2,", "outputs middle: expected degrees of freedom from 0 to 1"),
]


test_contradictions_of_predictions = refuses(*CONTRADICTIONS)


APART = [
    ("[3000.0, 2000.0]", "[3000.0, 0.0, 2000.0]"),
    ('stiffness_parameters = ["k1", "k2"]', 'stiffness_parameters = ["k1", "", "k2"]'),
    ('force = "top"', "force = { low = 2.0 }"),
    ('"low", "middle"', '"middle"'),
    ("[[0, 0.7], [1, 0.3]]", "1"),
]
FREE = [("[3000.0, 2000.0]", "[0.0, 2000.0]"), ('["", ""]', '["k1", ""]')]


@pytest.mark.parametrize(
    ("edits", "says"),
    [
        (APART, "('peak') response: expected responses that the load can move, found none"),
        (
            [("band = [0.5, 15.0]", "band = [0.1, 0.2]")],
            "('peak') band: expected a band with a frequency of the nominal model, or a measured ",
        ),
        (FREE, "('peak') static: expected false, as a model with rigid-body modes has no static"),
        (
            [*FREE, ("static = true", "static = false"), ("band = [0.5,", "band = [0.0,")],
            "('peak') band: expected a lowest frequency above 0, as rigid-body modes have no",
        ),
        (
            [("step = 0.02\n", ""), ("duration = 4.0", "duration = 1e6")],
            "('drifts') step: expected at most 1000000 time steps, found ",
        ),
        (
            [("frequency = 2.5", "frequency = 25.0")],
            "('drifts') step: expected at most 0.01 s, a quarter of the shortest period (25 Hz), ",
        ),
    ],
)
def test_predictions_that_the_nominal_model_cannot_make(
    edits: list[tuple[str, str]], says: str, folder: Path, refused: Check
) -> None:
    study = folder / "wrong.toml"
    study.write_text(edited(STUDY, *edits))
    refused(study, says)


def test_damping_that_was_not_measured(folder: Path, refused: Check) -> None:
    data = edited(DATA, ("4.0,0.01", "4.0,"), ("4.1,0.02", "4.1,"))
    (folder / "modes.csv").write_text(data)
    says = "('peak') damping: expected a ratio, as the data have none, found 'measured'"
    refused(folder / "chain.toml", says)
    (folder / "modes.csv").write_text(edited(DATA, ("4.0,0.01", "4.0,0"), ("4.1,0.02", "4.1,")))
    refused(folder / "chain.toml", "damping: expected a ratio, as measured ones are 0, found 'mea")
