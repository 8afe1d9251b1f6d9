"""Every key of the study file left out, misspelt and given values that it cannot have.

A message is one line a fault, ``file: place: expected ..., found ...``, on standard error with exit
status 2, and nothing is left behind.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

import pytest
from faultless import STUDY
from refusals import Check, command, edited


def test_the_study_that_the_rest_is_made_from_is_right(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("chain.toml", "matrices.toml"):
        assert command("check", folder / name) == 0, capsys.readouterr().err
        assert capsys.readouterr().err == ""


@dataclass(frozen=True)
class Key:
    """A key of the study file: its line, its place, what is expected, and what it cannot be."""

    line: str
    place: str
    expected: str
    required: bool
    wrong: str

    @property
    def name(self) -> str:
        return self.line.split(" = ")[0]

    @property
    def table(self) -> str:
        return self.place.removesuffix(f" {self.name}")

    def values(self) -> Iterable[str]:
        """Return the values that it cannot have; they are separated by blanks."""
        return self.wrong.split()


NO_WHOLE = '-1 1.5 1.0 true "1" [1] {} nan inf -inf 1979-05-27 99999999999999999999'
NO_NUMBER = '"1" true [1.0] {} nan inf -inf 07:32:00'
NO_TEXT = '"" "\\t" "\\n" "a\\nb" "a\\u0000b" "a\\u001b[31m" 5 5.0 true nan [] ["a"] {}'
NO_MODES = '"al" "" 1 1.0 true nan inf {} [0] [-1] [1.0] [true] ["1"] [nan] [inf] [[1]]'
NO_MASSES = '[] 2.0 "2" true nan {} [2.0,-1.0] [2.0,nan] [inf,1.0] [2.0,"1"] [2.0,true]'
NO_NAMES = '"k1" 1 true nan {} [1,2] [true,"k2"] [nan,"k2"]'

NO_POSITIVE = NO_NUMBER + " 0 0.0 -1.0"
NO_RATIO = '-0.01 0 0.0 1.0 2 "" "mesured" true nan inf [] {} [0.02,-0.02] [0.02,"0.02"] [true]'
NO_FORCE = '"" 1 true nan [] ["top"] {} {top=0} {top=nan} {top="1"} {top=true}'
NO_RESPONSE = '"" 1 true nan [] [1] [""] ["low","low"] {} {a=1} {a={}} {a={top=0}} {a={top=inf}}'
FRF, PASSAGE = "[[predict.frf]] 1", "[[predict.first_passage]] 1"

KEYS = [
    Key('name = "two masses"', "[study] name", "a text of printable characters", True, NO_TEXT),
    Key("seed = 1", "[study] seed", "a whole number from 0", False, NO_WHOLE),
    Key(
        "memory = 2.0",
        "[study] memory",
        "GiB for a reduced basis, above 0",
        False,
        NO_NUMBER + " 0.0 -1.0",
    ),
    Key('file = "modes.csv"', "[data] file", "a file of modal data", True, NO_TEXT),
    Key(
        'kind = "chain"',
        "[model] kind",
        "one of 'chain', 'matrices'",
        True,
        '"" "chian" "CHAIN" 1 true nan ["chain"] {}',
    ),
    Key(
        "masses = [2.0, 1.0]",
        "[model] masses",
        "a list of masses above 0",
        True,
        '[] [2.0,0.0] [2.0,-1.0] [2.0,nan] [inf,1.0] [-inf,1.0] [[2.0]] ["2"] 2.0 true "2" {}',
    ),
    Key(
        "stiffnesses = [3000.0, 2000.0]",
        "[model] stiffnesses",
        "a list of spring stiffnesses of 0 or more, as many as masses",
        True,
        NO_MASSES,
    ),
    Key(
        "added_masses = [0.5, 0.0]",
        "[model] added_masses",
        "a list of masses of 0 or more, as many as masses",
        False,
        NO_MASSES.removeprefix("[] "),  # as many as masses: see test_bad_models
    ),
    Key(
        'stiffness_parameters = ["k1", "k2"]',
        "[model] stiffness_parameters",
        "a list of names of parameters, as many as springs",
        False,
        NO_NAMES,
    ),
    Key(
        'mass_parameters = ["", ""]',
        "[model] mass_parameters",
        "a list of names of parameters, as many as masses",
        False,
        NO_NAMES,
    ),
    Key(
        "sensors = { low = 0, top = [[0, 0.5], [1, 0.5]] }",
        "[model] sensors",
        "a table of sensors",
        False,
        '0 [0,1] "low" true nan',
    ),
    Key(
        "outputs = { middle = [[0, 0.7], [1, 0.3]] }",
        "[model] outputs",
        "a table of outputs",
        False,
        '0 [0,1] "middle" true nan',
    ),
    Key('name = "k1"', "[[parameter]] 1 name", "the name of the parameter", True, NO_TEXT),
    Key("nominal = 1.0", "[[parameter]] 1 nominal", "a finite number", True, NO_NUMBER),
    Key(
        "bounds = [0.2, 5.0]",
        "[[parameter]] 1 bounds",
        "[lower, upper], two finite numbers with lower < upper",
        True,
        '[] [0.2] [5.0,0.2] [1.0,1.0] [0.2,1.0,5.0] [0.2,inf] [-inf,5.0] [nan,5.0] ["0",5.0] '
        "[false,5.0] 5.0 {}",
    ),
    Key('name = "frequencies"', "[[group]] 1 name", "the name of the group", True, NO_TEXT),
    Key('frequency = "all"', "[[group]] 1 frequency", "list of measured modes", False, NO_MODES),
    Key(
        'scale = "measured"',
        "[[group]] 1 scale",
        "one of 'measured', 'std'",
        False,
        '"" "Std" 1 true nan [] {}',
    ),
    Key("shape = [1, 2]", "[[group]] 2 shape", "list of measured modes", False, NO_MODES),
    Key('name = "mine"', "[[weighted]] 1 name", "a label", True, NO_TEXT),
    Key(
        "weights = { frequencies = 1.0, shapes = 2.0 }",
        "[[weighted]] 1 weights",
        "a table of weights",
        True,
        '1.0 [1.0,2.0] "equal" true nan',
    ),
    Key(
        'method = "nbi"',
        "[pareto] method",
        "one of 'nbi', 'weights', 'spea2', 'nsga2'",
        False,
        '"nib" "" 1 true nan ["nbi"] {}',
    ),
    Key(
        'programme = "bounds"',
        "[pareto] programme",
        "one of 'bounds', 'equations'",
        False,
        '"equation" "" 1 true nan []',
    ),
    Key("points = 5", "[pareto] points", "a whole number from 2", False, NO_WHOLE + " 0 1"),
    Key("population = 20", "[pareto] population", "a whole number from 4", False, NO_WHOLE + " 3"),
    Key(
        "evaluations = 2000",
        "[pareto] evaluations",
        "a whole number from 4",
        False,
        NO_WHOLE + " 3",
    ),
    Key(
        'method = "mac"',
        "[pairing] method",
        "one of 'mac', 'order'",
        False,
        '"MAC" "" 1 true nan []',
    ),
    Key(
        "window = 3.0",
        "[pairing] window",
        "a ratio of frequencies above 1",
        False,
        NO_NUMBER + " 1.0 0.0 -2.0",
    ),
    Key("spare = 0", "[pairing] spare", "a whole number from 0 to 1000", False, NO_WHOLE),
    Key(
        "evaluations = 5000",
        "[search] evaluations",
        "a whole number from 1",
        False,
        NO_WHOLE + " 0",
    ),
    Key("tolerance = 0.01", "[search] tolerance", "a share above 0", False, NO_NUMBER + " 0 1.0"),
    Key("doubt = 0.4", "[search] doubt", "a share above 0", False, NO_NUMBER + " 0 1.0"),
    Key(
        "flat = 0.01",
        "[identifiability] flat",
        "a share from 0 to 1",
        False,
        NO_NUMBER + " -0.1 1.1",
    ),
    Key("models = 50", "[identifiability] models", "a whole number from 0", False, NO_WHOLE),
    Key(
        "step = 0.05",
        "[identifiability] step",
        "a share of the ranges from 0.001 to 0.5",
        False,
        NO_NUMBER + " -0.1 0.0 0.0009 0.6",
    ),
    Key(
        'source = "sets"',
        "[uncertainty] source",
        "one of 'auto', 'std', 'sets', 'none'",
        False,
        '"set" "STD" "" 1 true nan ["std"] {}',
    ),
    Key("bootstrap = 2", "[uncertainty] bootstrap", "a whole number from 0", False, NO_WHOLE),
    Key("draws = 3", "[uncertainty] draws", "a whole number from 0", False, NO_WHOLE),
    Key('name = "peak"', f"{FRF} name", "what the prediction is called", True, NO_TEXT),
    Key('force = "top"', f"{FRF} force", "the name of a sensor or output", False, NO_FORCE),
    Key('response = ["low", "middle"]', f"{FRF} response", "a list of sensors", True, NO_RESPONSE),
    Key(
        'quantity = "mobility"',
        f"{FRF} quantity",
        "one of 'receptance', 'mobility', 'accelerance'",
        False,
        '"" "Mobility" 1 true nan ["mobility"] {}',
    ),
    Key(
        "band = [0.5, 15.0]",
        f"{FRF} band",
        "[lowest, highest] frequency in Hz",
        False,
        '[] [0.5] [15.0,0.5] [1.0,1.0] [-1.0,5.0] [0.5,inf] [nan,5.0] ["0",5.0] [1,2,3] 5.0 {}',
    ),
    Key("static = true", f"{FRF} static", "true or false", False, '1 0 "true" nan [] {}'),
    Key('damping = "measured"', f"{FRF} damping", "'measured', or a ratio", False, NO_RATIO),
    Key("modes = 2", f"{FRF} modes", "a whole number from 1 to", False, NO_WHOLE + " 0 3"),
    Key('name = "drifts"', f"{PASSAGE} name", "what the prediction is called", True, NO_TEXT),
    Key('base = "x"', f"{PASSAGE} base", "a direction in which the base moves", False, NO_TEXT),
    Key(
        "response = { drift = { top = 1.0, low = -1.0 } }",
        f"{PASSAGE} response",
        "a list of sensors or outputs, or a table",
        True,
        NO_RESPONSE,
    ),
    Key("density = 0.5", f"{PASSAGE} density", "a spectral density above 0", True, NO_POSITIVE),
    Key(
        'sided = "two"',
        f"{PASSAGE} sided",
        "one of 'one', 'two'",
        True,
        '"" "Two" 2 true nan [] {}',
    ),
    Key(
        "filter = { frequency = 2.5, damping = 0.6 }",
        f"{PASSAGE} filter",
        "a Kanai-Tajimi filter",
        False,
        '1 [1] "soil" true nan',
    ),
    Key(
        "modulation = [[0.0, 0.0], [2.0, 1.0]]",
        f"{PASSAGE} modulation",
        "a list of [time in s, factor]",
        False,
        '[] 1.0 "t" true nan {} [1.0] [[0.0]] [[0,0],[0,1]] [[1,0],[0,1]] [[-1,1]] [[0,0],[1,0]] '
        "[[0,nan]] [[0,1,2]] [[0,true]]",
    ),
    Key(
        "levels = [0.1, 0.2]",
        f"{PASSAGE} levels",
        "a list of different levels above 0",
        True,
        '[] 0.1 "0.1" true nan {} [0.0] [-0.1] [0.1,0.1] [0.1,nan] [inf] ["0.1"] [true]',
    ),
    Key("duration = 4.0", f"{PASSAGE} duration", "a duration above 0 s", True, NO_POSITIVE),
    Key("step = 0.02", f"{PASSAGE} step", "a time step above 0 s", False, NO_POSITIVE),
    Key("samples = 20", f"{PASSAGE} samples", "a whole number from 2", False, NO_WHOLE + " 0 1"),
    Key(
        'method = "additive"',
        f"{PASSAGE} method",
        "one of 'importance', 'directional', 'additive', 'monte-carlo'",
        False,
        '"" "subset" 1 true nan [] {}',
    ),
    Key("damping = 0.03", f"{PASSAGE} damping", "'measured', or a ratio", False, NO_RATIO),
]


def fault_text(place: str, expected: str, what: str) -> str:
    """Return the message on an item of a list, whose name stands behind its number or not."""
    head = re.sub(r"(\]\] \d)", r"\1 ... ", place)
    return f"{head}: expected ... {expected} ... , found {what}"


HIDING = ("[model] kind", "[[group]] 1 scale", "[[group]] 2 shape", "[[predict.")
"""Where faults that hide others begin, or are hidden by them."""

ALONE = [[key] for key in KEYS if key.place.startswith(HIDING)]
OTHERS = [key for key in KEYS if not key.place.startswith(HIDING)]
TOGETHER = [*ALONE, *(OTHERS[k : k + 8] for k in range(0, len(OTHERS), 8))]
"""Keys that are wrong at once, of which all are shown, and those that are wrong alone."""


@pytest.mark.parametrize("keys", TOGETHER, ids=lambda keys: keys[0].place)
def test_every_key_of_the_study_refuses_what_it_cannot_be(
    keys: list[Key], folder: Path, refused: Check
) -> None:
    study = folder / "wrong.toml"
    for values in zip_longest(*(key.values() for key in keys)):
        wrong = [(key, value) for key, value in zip(keys, values, strict=True) if value]
        edits = [(key.line, f"{key.name} = {value}") for key, value in wrong]
        study.write_text(edited(STUDY, *edits))
        refused(study, *(fault_text(key.place, key.expected, "") for key, _ in wrong))


def test_the_reduction_of_matrices_refuses_what_it_cannot_be(folder: Path, refused: Check) -> None:
    study = (folder / "matrices.toml").read_text()
    kind = 'kind = "matrices"'
    for value in [*NO_NUMBER.split(), "0.0", "-1e-8", "1e-13", "0.1", '"on"', '"AUTO"']:
        wrong = folder / "wrong.toml"
        wrong.write_text(edited(study, (kind, f"{kind}\nreduction = {value}")))
        refused(wrong, "[model] reduction: expected 'auto', 'off' or a relative error ... , found ")
    wrong.write_text(edited(study, (kind, f'{kind}\nreductoin = "off"')))
    refused(wrong, "expected a known key, found 'reductoin' (did you mean 'reduction'?)")


@pytest.mark.parametrize("key", KEYS, ids=lambda key: key.place)
def test_a_misspelt_key_is_answered_with_the_known_one(
    key: Key, folder: Path, refused: Check
) -> None:
    misspelt = key.name[0] + key.name[2:] + "s"
    study = folder / "wrong.toml"
    study.write_text(edited(STUDY, (key.line, key.line.replace(key.name, misspelt, 1))))
    says = []
    if key.name != "kind":  # without it, it is not known what keys there are
        says.append(
            fault_text(key.table, "a known key", f"'{misspelt}' (did you mean '{key.name}'?)")
        )
    if key.required:
        says.append(fault_text(key.place, key.expected, "nothing"))
    refused(study, *says)
