"""Chains, sensors and parameters that contradict each other."""

from pathlib import Path

from faultless import STUDY
from refusals import Check, edited, refuses

SENSOR = "expected a degree of freedom from 0, or a list [[degree of freedom, weight], ...], found "

CONTRADICTIONS = [
    # the chain
    ("[2.0, 1.0]", "[2.0, 1e308]", "masses: ... found [2.0, a number beyond 1e+100]"),
    (
        "[2.0, 1.0]",
        "[2.0, 1.0, 1.0]",
        "[model] added_masses: expected one a mass, found 2",
    ),
    ("[3000.0, 2000.0]", "[1.0, 1.0, 1.0, 1.0]", "[model] stiffnesses: expected 2 or 3, as there "),
    ('["k1", "k2"]', '["k1"]', "[model] stiffness_parameters: expected one a spring, found 1"),
    ('["", ""]', '["", "", ""]', "[model] mass_parameters: expected one a mass, found 3"),
    ('["k1", "k2"]', '["k1", "k3"]', "stiffness_parameters: ... found 'k3' (did you mean 'k2'?)"),
    ('["k1", "k2"]', '["k1", "base"]', "stiffness_parameters: ... found 'base'"),
    ('["", ""]', '["m", ""]', "mass_parameters: expected names of parameters, found 'm'"),
    ('["k1", "k2"]', '["k1", "k1"]', "[[parameter]] 'k2': ... that the model uses, found no use"),
    ("[3000.0, 2000.0]", "[0.0, 0.0]", "[model]: expected modes at the nominal parameters, found"),
    ("[model]\n", '[model]\nstiffness = "K"\n', "[model]: expected a known key, found 'stiffness'"),
    # sensors
    ("{ low = 0, top = [[0, 0.5], [1, 0.5]] }", "{}", "sensors: expected at least one sensor"),
    (
        "low = 0",
        "low = 2",
        "[model] sensors low: expected degrees of freedom from 0 to 1 ... , found 2",
    ),
    ("low = 0", "low = [[7, 1]]", "sensors low: expected degrees of freedom from 0 to 1, found 7"),
    ("low = 0", f"low = {'9' * 30}", "sensors low: ... degree of freedom from 0, ... found 999"),
    ("low = 0", "low = -1", SENSOR + "-1"),
    ("low = 0", "low = 0.0", SENSOR + "0.0"),
    ("low = 0", "low = false", SENSOR + "false"),
    ("low = 0", 'low = "0"', SENSOR + "'0'"),
    ("low = 0", "low = []", SENSOR + "[]"),
    ("low = 0", "low = {}", SENSOR + "a table"),
    ("low = 0", "low = [0, 1]", SENSOR + "[0, 1]"),
    ("low = 0", "low = [[0]]", SENSOR + "[[0]]"),
    ("low = 0", "low = [[0, inf]]", SENSOR + "[[0, inf]]"),
    ("low = 0", "low = [[0, nan]]", SENSOR + "[[0, nan]]"),
    ("low = 0", "low = [[0, 1e200]]", SENSOR + "[[0, a number beyond 1e+100]]"),
    ("low = 0", "low = [[0, 0.0]]", "sensors low: expected weights that do not cancel, found [[0"),
    ("low = 0", "low = [[0, 1], [0, -1]]", "sensors low: expected weights that do not cancel"),
    ("low = 0", '"" = 0', "[model] sensors '': expected a name that a column of the data can have"),
    ("low = 0", '" low" = 0', "sensors ' low': expected a name that a column of the data can have"),
    ("low = 0", "frequency = 0", "sensors 'frequency': expected a name that a column of the data"),
    ("low = 0", "top_std = 0", "sensors 'top_std': expected a name that a column of the data can"),
    ("low = 0", '"a\\nb" = 0', "sensors 'a\\nb': expected a name that a column of the data can"),
    ("low = 0", "law = 0", "line 1, column 'low': ... found 'low' (did you mean 'law'?)"),
    # parameters
    ('"k1"\nnom', '"k2"\nnom', "[[parameter]]: expected each name once, found 'k2' twice"),
    ('"k1"\nnom', '"base"\nnom', "1 ('base') name: expected another name: 'base' is the constant"),
    ("nominal = 1.0", "nominal = 6", "1 ('k1') nominal: ... its bounds, 0.2 to 5, found 6"),
    ("nominal = 1.0", f"nominal = 1{'0' * 400}", "nominal: ... found a number beyond 1e+100"),
    ("nominal = 1.0", f"nominal = 0x{'f' * 5000}", "nominal: ... found a number beyond 1e+100"),
    ("[0.3, 4.0]", "[4.0, 0.3]", "[[parameter]] 2 ('k2') bounds: ... found [4.0, 0.3]"),
    ("bounds = [0.3", "unit = 1\nbounds = [0.3", "[[parameter]] 2 ('k2'): ... found 'unit'"),
]


def test_an_unknown_key_hides_no_other_fault(folder: Path, refused: Check) -> None:
    study = folder / "wrong.toml"
    study.write_text(edited(STUDY, ("[model]\n", "[model]\nmases = [1]\n"), ("low = 0", "low = 2")))
    known = "[model]: expected a known key, found 'mases' (did you mean 'masses'?)"
    refused(study, known, "[model] sensors low: expected degrees of freedom from 0 to 1")


test_contradictions_of_models = refuses(*CONTRADICTIONS)
