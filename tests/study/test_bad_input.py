"""Whatever is wrong with an input is said in one message, and nothing is left behind.

Every key of the study file and every column of the data is left out, misspelt and given values
that it cannot have. A message is one line a fault, ``file: place: expected ..., found ...``, on
standard error with exit status 2.
"""

import io
import re
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse
from refusals import Check, command, edited

from modefront.fronts.methods import evolutionary

STUDY = """\
[study]
name = "two masses"
seed = 1
memory = 2.0

[data]
file = "modes.csv"

[model]
kind = "chain"
masses = [2.0, 1.0]
stiffnesses = [3000.0, 2000.0]
added_masses = [0.5, 0.0]
stiffness_parameters = ["k1", "k2"]
mass_parameters = ["", ""]
sensors = { low = 0, top = [[0, 0.5], [1, 0.5]] }
outputs = { middle = [[0, 0.7], [1, 0.3]] }

[[parameter]]
name = "k1"
nominal = 1.0
bounds = [0.2, 5.0]

[[parameter]]
name = "k2"
nominal = 1.1
bounds = [0.3, 4.0]

[[group]]
name = "frequencies"
frequency = "all"
scale = "measured"

[[group]]
name = "shapes"
shape = [1, 2]

[[weighted]]
name = "mine"
weights = { frequencies = 1.0, shapes = 2.0 }

[pareto]
method = "nbi"
points = 5
population = 20
evaluations = 2000

[pairing]
method = "mac"
window = 3.0
spare = 0

[search]
starts = 3
limit = 9
evolutions = 1

[identifiability]
flat = 0.01
models = 50
step = 0.05

[uncertainty]
source = "sets"
bootstrap = 2
draws = 3
[[predict.frf]]
name = "peak"
force = "top"
response = ["low", "middle"]
quantity = "mobility"
band = [0.5, 15.0]
static = true
damping = "measured"
modes = 2

[[predict.first_passage]]
name = "drifts"
base = "x"
response = { drift = { top = 1.0, low = -1.0 } }
density = 0.5
sided = "two"
filter = { frequency = 2.5, damping = 0.6 }
modulation = [[0.0, 0.0], [2.0, 1.0]]
levels = [0.1, 0.2]
duration = 4.0
step = 0.02
samples = 20
method = "additive"
damping = 0.03
"""

CHAIN = STUDY[STUDY.index('kind = "chain"') : STUDY.index("sensors =")]
MATRICES = """\
kind = "matrices"
stiffness = { base = "K0.mtx", k1 = "K1.npy", k2 = "K2.npz" }
mass = { base = "M.mtx" }
base = { x = [0, 1] }
"""

DATA = """\
set,mode,frequency,damping,low,top,frequency_std,low_std
a,1,4.0,0.01,0.5,1.0,0.1,0.01
a,2,11.0,,1.0,-0.5,,
b,1,4.1,0.02,0.5,1.1,0.1,
"""

K0 = np.array([[100.0, 0.0], [0.0, 0.0]])
K1 = np.array([[3000.0, 0.0], [0.0, 0.0]])
K2 = 2000.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
M = np.diag([2.5, 1.0])


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a study of a chain and of matrices in which nothing is wrong."""
    (tmp_path / "chain.toml").write_text(STUDY)
    (tmp_path / "matrices.toml").write_text(STUDY.replace(CHAIN, MATRICES))
    (tmp_path / "modes.csv").write_text(DATA)
    scipy.io.mmwrite(tmp_path / "K0.mtx", K0)
    np.save(tmp_path / "K1.npy", K1)
    scipy.sparse.save_npz(tmp_path / "K2.npz", scipy.sparse.csr_array(K2))
    scipy.io.mmwrite(tmp_path / "M.mtx", scipy.sparse.coo_array(M))
    (tmp_path / "folder.csv").mkdir()
    scipy.io.savemat(tmp_path / "all.mat", {"K0": K0, "K1": K1, "text": "K1", "rows": 2.0})
    scipy.io.savemat(tmp_path / "none.mat", {"rows": 2.0})
    (tmp_path / "bad.mat").write_bytes((tmp_path / "all.mat").read_bytes()[:150])
    (tmp_path / "folder.mtx").mkdir()
    return tmp_path


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
NO_MASSES = '[] 2.0 "2" true nan {} [2.0] [2.0,-1.0] [2.0,nan] [inf,1.0] [2.0,"1"] [2.0,true]'
NO_NAMES = '["k1"] ["k1","k2",""] "k1" 1 true nan {} [1,2] [true,"k2"] [nan,"k2"]'

NO_POSITIVE = NO_NUMBER + " 0 0.0 -1.0"
NO_RATIO = '-0.01 0 0.0 1.0 2 "" "mesured" true nan inf [] {} [0.02,-0.02] [0.02,"0.02"] [true]'
NO_FORCE = '"" 1 true nan [] ["top"] {} {top=0} {top=nan} {top="1"} {top=true}'
NO_RESPONSE = '"" 1 true nan [] [1] [""] ["low","low"] {} {a=1} {a={}} {a={top=0}} {a={top=inf}}'
FRF, PASSAGE = "[[predict.frf]] 1", "[[predict.first_passage]] 1"

KEYS = [
    Key('name = "two masses"', "[study] name", "a text", True, NO_TEXT),
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
        "a list of 2 spring stiffnesses of 0 or more",
        True,
        NO_MASSES + " [1.0,1.0,1.0,1.0]",
    ),
    Key(
        "added_masses = [0.5, 0.0]",
        "[model] added_masses",
        "a list of 2 masses of 0 or more",
        False,
        NO_MASSES + " [1.0,1.0,1.0]",
    ),
    Key(
        'stiffness_parameters = ["k1", "k2"]',
        "[model] stiffness_parameters",
        "a list of 2 names of parameters",
        False,
        NO_NAMES,
    ),
    Key(
        'mass_parameters = ["", ""]',
        "[model] mass_parameters",
        "a list of 2 names of parameters",
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
    Key("starts = 3", "[search] starts", "a whole number from 1", False, NO_WHOLE + " 0"),
    Key("limit = 9", "[search] limit", "a whole number from 1", False, NO_WHOLE + " 0"),
    Key("evolutions = 1", "[search] evolutions", "a whole number from 0", False, NO_WHOLE),
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


def found(place: str, expected: str, what: str) -> str:
    """Return what is said of an item of a list, whose name stands behind its number or not."""
    head = re.sub(r"(\]\] \d)", r"\1 ... ", place)
    return f"{head}: expected ... {expected} ... , found {what}"


@pytest.mark.parametrize("key", KEYS, ids=lambda key: key.place)
def test_every_key_of_the_study_refuses_what_it_cannot_be(
    key: Key, folder: Path, refused: Check
) -> None:
    for value in key.values():
        study = folder / "wrong.toml"
        study.write_text(edited(STUDY, (key.line, f"{key.name} = {value}")))
        refused(study, found(key.place, key.expected, ""))


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
        says.append(found(key.table, "a known key", f"'{misspelt}' (did you mean '{key.name}'?)"))
    if key.required:
        says.append(found(key.place, key.expected.replace("a list of 2", ""), "nothing"))
    refused(study, *says)


@pytest.mark.parametrize("key", [key for key in KEYS if key.required], ids=lambda key: key.place)
def test_a_missing_key_is_asked_for(key: Key, folder: Path, refused: Check) -> None:
    study = folder / "wrong.toml"
    study.write_text(edited(STUDY, (key.line + "\n", "")))
    refused(study, found(key.place, key.expected, "nothing"))


GROUPS = STUDY[STUDY.index("[[group]]") : STUDY.index("[[weighted]]")]
WEIGHTED = STUDY[STUDY.index("[[weighted]]") : STUDY.index("[pareto]")]
PARAMETERS = STUDY[STUDY.index("[[parameter]]") : STUDY.index("[[group]]")]
PREDICTIONS = STUDY[STUDY.index("[[predict.frf]]") :]
SENSOR = "expected a degree of freedom from 0, or a list [[degree of freedom, weight], ...], found "
WEIGHT = "[[weighted]] 1 ('mine') weights shapes: expected a weight above 0, found "

CONTRADICTIONS = [
    # tables
    ("[study]\n", "[stduy]\n", "top level: expected a known key, found 'stduy' (did you mean 'st"),
    ("[study]\n", "[stduy]\n", "study: expected a table [study], found nothing"),
    ("[study]\n", "[[study]]\n", "study: expected a table [study], found a list of 1"),
    ("[data]\n", "[dat]\n", "data: expected a table [data], found nothing"),
    ("[data]\n", "[[data]]\n", "data: expected a table [data], found a list of 1"),
    ("[model]\n", "[modell]\n", "model: expected a table [model], found nothing"),
    ("[model]\n", "[[model]]\n", "model: expected a table [model], found a list of 1"),
    (PARAMETERS, "", "parameter: expected at least one table [[parameter]], found nothing"),
    (PARAMETERS, "[parameter]\n", "parameter: expected at least one table ... found a table"),
    (GROUPS, "", "group: expected at least one table [[group]], found nothing"),
    (GROUPS, "[group]\n", "group: expected at least one table [[group]], found a table"),
    ("[study]\n", "group = 1\n[study]\n", "file: expected TOML in UTF-8, found "),
    (WEIGHTED, "[weighted]\n", "weighted: expected tables [[weighted]], found a table"),
    ("[pareto]", "[[pareto]]", "pareto: expected a table, found a list of 1"),
    ("[pareto]", "[paretto]", "expected a known key, found 'paretto' (did you mean 'pareto'?)"),
    ("[pairing]", "[pair]", "expected a known key, found 'pair' (did you mean 'pairing'?)"),
    ("[search]", "[research]", "expected a known key, found 'research' (did you mean 'search'?)"),
    ("[identifiability]", "[identifiable]", "found 'identifiable' (did you mean 'identifiabil"),
    ("[uncertainty]", "[[uncertainty]]", "uncertainty: expected a table, found a list of 1"),
    ("[uncertainty]", "[certainty]", "found 'certainty' (did you mean 'uncertainty'?)"),
    # files
    ("modes.csv", "absent.csv", "absent.csv: file: expected a file of modal data, found no such"),
    ("modes.csv", "folder.csv", "folder.csv: file: expected CSV in UTF-8, found [Errno 21]"),
    ("modes.csv", "modes.xls", "[data] file: expected a file that ends in .csv, found 'modes.xls'"),
    # the chain
    ("[2.0, 1.0]", "[2.0, 1e308]", "masses: ... found [2.0, a number beyond 1e+100]"),
    ("[2.0, 1.0]", "[2.0, 1.0, 1.0]", "[model] added_masses: expected a list of 3 masses"),
    ('["k1", "k2"]', '["k1", "k3"]', "stiffness_parameters: ... found 'k3' (did you mean 'k2'?)"),
    ('["k1", "k2"]', '["k1", "base"]', "stiffness_parameters: ... found 'base'"),
    ('["", ""]', '["m", ""]', "mass_parameters: expected names of parameters, found 'm'"),
    ('["k1", "k2"]', '["k1", "k1"]', "[[parameter]] 'k2': ... that the model uses, found no use"),
    ("[3000.0, 2000.0]", "[0.0, 0.0]", "[model]: expected modes at the nominal parameters, found"),
    ("[model]\n", '[model]\nstiffness = "K"\n', "[model]: expected a known key, found 'stiffness'"),
    # sensors
    ("{ low = 0, top = [[0, 0.5], [1, 0.5]] }", "{}", "sensors: expected at least one sensor"),
    ("low = 0", "low = 2", "[model] sensors low: expected degrees of freedom from 0 to 1, found 2"),
    ("low = 0", "low = [[7, 1]]", "sensors low: expected degrees of freedom from 0 to 1, found 7"),
    ("low = 0", f"low = {'9' * 30}", "sensors low: ... degrees of freedom from 0 to 1, found 999"),
    ("low = 0", "low = -1", SENSOR + "-1"),
    ("low = 0", "low = 0.0", SENSOR + "0.0"),
    ("low = 0", "low = false", SENSOR + "false"),
    ("low = 0", 'low = "0"', SENSOR + "the text '0'"),
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
    ("low = 0", "law = 0", "line 1, column 'law': expected this column, found no such column"),
    ("low = 0", "law = 0", "line 1, column 'low': ... found 'low' (did you mean 'law'?)"),
    # parameters
    ('"k1"\nnom', '"k2"\nnom', "[[parameter]]: expected each name once, found 'k2' twice"),
    ('"k1"\nnom', '"base"\nnom', "1 ('base') name: expected another name: 'base' is the constant"),
    ("nominal = 1.0", "nominal = 6", "1 ('k1') nominal: ... its bounds, 0.2 to 5, found 6"),
    ("nominal = 1.0", f"nominal = 1{'0' * 400}", "nominal: ... found a number beyond 1e+100"),
    ("nominal = 1.0", f"nominal = 0x{'f' * 5000}", "nominal: ... found a number beyond 1e+100"),
    ("[0.3, 4.0]", "[4.0, 0.3]", "[[parameter]] 2 ('k2') bounds: ... found [4.0, 0.3]"),
    ("bounds = [0.3", "unit = 1\nbounds = [0.3", "[[parameter]] 2 ('k2'): ... found 'unit'"),
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
    ("shape = [1, 2]", "shape = [1, 1]", "shape: expected each mode once, found [1, 1]"),
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
            *("equal-weights", "optimal-weights", "bounded-weights", "iterated-weights"),
            *("identifiable-1", "identifiable-edge-shapes", "nominal"),
        )
    ),
    # predictions
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
    ("modes = 2", "modes = 1", "modes: ... reach the end of the band, 15 Hz: 2, found 1, up to 4."),
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
    # the rest
    ("points = 5", "points = 10001", "points: expected a whole number from 2 to 10000, found 1000"),
    ("spare = 0", "spare = 1001", "spare: expected a whole number from 0 to 1000, found 1001"),
    ("limit = 9", "limit = 2", "[search] limit: expected at least starts, 3, found 2"),
    (
        'source = "sets"',
        'source = "none"',
        "[uncertainty] bootstrap: expected 0 with source = 'none', found 2",
    ),
    (PREDICTIONS, "", "[uncertainty] draws: expected 0 without predictions, found 3"),
    # what is no TOML
    ("[study]", "[study", "file: expected TOML in UTF-8, found ... line "),
    ("seed = 1", "seed =", "file: expected TOML in UTF-8, found ... line "),
    ("seed = 1", "seed = 1\nseed = 2", "file: expected TOML in UTF-8, found ... line "),
    ("[pareto]", "[study]", "file: expected TOML in UTF-8, found ... line "),
    ("seed = 1", f"seed = {'9' * 5000}", "file: expected TOML in UTF-8, found "),
    ("seed = 1", f"seed = {'[' * 20000}", "file: expected TOML in UTF-8, found "),
]


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

GIVEN = STUDY[STUDY.index("[[weighted]]") : STUDY.index("[pareto]")]

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
    text = edited(STUDY, (GIVEN, ""), ("points = 5\n", ""))
    study.write_text(edited(text, ("[pareto]", more)))
    refused(study, says)


def test_a_method_whose_package_is_missing(
    folder: Path, refused: Check, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(evolutionary, "available", lambda: False)
    for method in ("spea2", "nsga2"):
        study = folder / "wrong.toml"
        study.write_text(edited(STUDY, ('method = "nbi"', f'method = "{method}"')))
        refused(study, f"[pareto] method: expected the package pymoo for '{method}': pip install")


@pytest.mark.parametrize(("old", "new", "says"), CONTRADICTIONS)
def test_contradictions_of_the_study(
    old: str, new: str, says: str, folder: Path, refused: Check
) -> None:
    study = folder / "wrong.toml"
    study.write_text(edited(STUDY, (old, new)))
    refused(study, says)


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


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "study: expected a table [study], found nothing"),
        (b"", "parameter: expected at least one table [[parameter]], found nothing"),
        (b"\xff\xfe\x00", "file: expected TOML in UTF-8, found 'utf-8' codec"),
        (STUDY.encode("utf-16"), "file: expected TOML in UTF-8, found "),
        (b"\x00" * 100, "file: expected TOML in UTF-8, found "),
        (b"PK\x03\x04\x14\x00", "file: expected TOML in UTF-8, found "),
    ],
)
def test_files_that_are_no_study(content: bytes, says: str, folder: Path, refused: Check) -> None:
    study = folder / "wrong.toml"
    study.write_bytes(content)
    refused(study, f"wrong.toml: {says}")


def test_a_study_that_is_not_there_or_a_folder(folder: Path, refused: Check) -> None:
    refused(folder / "absent.toml", "absent.toml: file: expected a study file, found no such file")
    refused(folder / "folder.mtx", "folder.mtx: file: expected a study file, found a folder")


def test_a_byte_order_mark_and_other_line_ends_change_nothing(folder: Path) -> None:
    (folder / "windows.toml").write_bytes(b"\xef\xbb\xbf" + STUDY.replace("\n", "\r\n").encode())
    quoted = DATA.replace("low,", '"low",').replace("a,2", '"a","2"').replace("\n", "\r\n")
    (folder / "modes.csv").write_bytes(b"\xef\xbb\xbf" + quoted.encode())
    assert command("check", folder / "windows.toml") == 0


NO_FIELD = "x nan NaN inf -inf infinity 1e999 1_0 0x10 1,5 ٤ １ 1e 1.2.3 -- true 4.0Hz =1+1"
COLUMNS = [
    # column, expected, wrong fields
    ("set", "the name of a data set", ['""', '" "', '"a\nb"', "a\x1b[0m"]),
    (
        "mode",
        "a whole number from 1 to 1000000",
        ["", "0", "-1", "+1", "1.0", "1e0", "first", "nan", "1_0", "٤", "²", "1000001", "9" * 5000],
    ),
    (
        "frequency",
        "a frequency above 0 Hz",
        ["0", "-4.0", "1e-300", "1e300"],
    ),
    ("damping", "a damping ratio from 0 to below 1", ["-0.01", "1", "2.5"]),
    ("frequency_std", "a standard deviation of 0 or more", ["-0.1"]),
    ("low_std", "a standard deviation of 0 or more", ["-0.1"]),
    *(
        (column, "a finite number or an empty field", NO_FIELD.replace("1,5", '"1,5"').split())
        for column in ("frequency", "damping", "low", "top", "frequency_std", "low_std")
    ),
]


@pytest.mark.parametrize(
    ("column", "expected", "fields"), COLUMNS, ids=[f"{c}: {e}" for c, e, _ in COLUMNS]
)
def test_every_column_of_the_data_refuses_what_it_cannot_hold(
    column: str, expected: str, fields: list[str], folder: Path, refused: Check
) -> None:
    header, first, *others = DATA.splitlines()
    for field in fields:
        row = first.split(",")
        row[header.split(",").index(column)] = field
        (folder / "modes.csv").write_text("\n".join([header, ",".join(row), *others]))
        line = 2 + field.count("\n")
        refused(
            folder / "chain.toml",
            f"modes.csv: line {line}, column '{column}': expected {expected} ... , found ",
        )


@pytest.mark.parametrize("column", DATA.splitlines()[0].split(","))
def test_every_column_of_the_data_misspelt_missing_and_repeated(
    column: str, folder: Path, refused: Check
) -> None:
    rows = [line.split(",") for line in DATA.splitlines()]
    i = rows[0].index(column)
    place = f"modes.csv: line 1, column '{column}'"

    def write(rows: list[list[str]]) -> Path:
        (folder / "modes.csv").write_text("\n".join(map(",".join, rows)))
        return folder / "chain.toml"

    misspelt = [[*rows[0][:i], column + "x", *rows[0][i + 1 :]], *rows[1:]]
    unknown = f"expected the name of a quantity or of a sensor of the model, found '{column}x'"
    refused(write(misspelt), f"column '{column}x': {unknown} (did you mean '{column}'?)")
    if not column.endswith("_std"):
        refused(write(misspelt), f"{place}: expected this column, found no such column")
        missing = [row[:i] + row[i + 1 :] for row in rows]
        refused(write(missing), f"{place}: expected this column, found no such column")
    repeated = [[*row, row[i]] for row in rows]
    refused(write(repeated), f"{place}: expected each column once, found 2 of this name")


TWICE = "columns 'set' and 'mode': expected each mode of a data set once, found ('a', 1) again"
SHAPE = "line 2, column 'low': expected a mode shape "

ROWS = [
    ("a,2,11.0,", "a,1,11.0,", f"modes.csv: line 3, {TWICE}"),
    ("a,2,11.0,", "a,01,11.0,", f"modes.csv: line 3, {TWICE}"),
    ("0.01\na", "0.01,7\na", "modes.csv: line 2: expected 8 fields, as in the header, found 9"),
    ("0.1,0.01\na", "0.1\na", "modes.csv: line 2: expected 8 fields, as in the header, found 7"),
    ("set,", "set;", "modes.csv: line 1, column 'set': expected this column, found no such"),
    ("low_std\n", "low_std,\n", "modes.csv: line 1, column '': ... found ''"),
    ("low_std\n", "mode_std\n", "line 1, column 'mode_std': ... found 'mode_std'"),
    ("low_std\n", "lοw_std\n", "line 1, column 'lοw_std': expected the name of a quantity"),
    ("0.5,1.0,0.1", "0,0.0,0.1", SHAPE + "that is not zero at all sensors, found only zeros"),
    ("0.5,1.0,0.1", "0.5,1e200,0.1", SHAPE + "with its greatest component ... , found 1e+200"),
    ("0.5,1.0,0.1", "1e-200,0,0.1", SHAPE + "with its greatest component ... , found 1e-200"),
    ("4.0,0.01,0.5,1.0,", ",0.01,,,", "column 'frequency': expected a frequency or a mode shape"),
    ("a,2,11.0,", 'a,"2,11.0,', "modes.csv: line 4: expected CSV, found unexpected end of data"),
    ("a,2,11.0,", '"a"x,2,11.0,', "modes.csv: line 3: expected CSV, found ',' expected after"),
    ("b,1,4.1", "b,3,4.1", "[data] file: expected at most 2 modes, as the model has, found 3"),
    ("a,2,11.0,,1.0,-0.5", "a,2,11.0,,,", "shape: expected one of the measured modes [1], found 2"),
]


@pytest.mark.parametrize(("old", "new", "says"), ROWS)
def test_contradictions_of_the_data(
    old: str, new: str, says: str, folder: Path, refused: Check
) -> None:
    (folder / "modes.csv").write_text(edited(DATA, (old, new)))
    refused(folder / "chain.toml", says)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "line 1: expected a header of column names, found an empty file"),
        (b"\n\n , ,\n", "line 1: expected a header of column names, found an empty file"),
        (DATA.splitlines()[0].encode(), "line 2: expected a row for each measured mode, found"),
        (b"\xff\xfe\x00", "file: expected CSV in UTF-8, found 'utf-8' codec"),
        (DATA.encode("utf-16"), "file: expected CSV in UTF-8, found 'utf-8' codec"),
        (DATA.encode() + b"x" * 200_000, "line 5: expected CSV, found field larger than"),
        (b"\x00" * 100, "line 1, column 'set': expected this column, found no such column"),
    ],
)
def test_files_that_are_no_data(content: bytes, says: str, folder: Path, refused: Check) -> None:
    (folder / "modes.csv").write_bytes(content)
    refused(folder / "chain.toml", f"modes.csv: {says}")


def test_a_group_of_which_nothing_is_measured(folder: Path, refused: Check) -> None:
    data = edited(DATA, (",4.0,", ",,"), (",11.0,", ",,"), (",4.1,", ",,"))
    (folder / "modes.csv").write_text(data)
    says = "[[group]] 1 ('frequencies'): expected at least one measured property, found none"
    refused(folder / "chain.toml", says)


@pytest.mark.parametrize(
    ("source", "key", "expected", "what"),
    [
        ("std", "source", "standard deviations above 0 in the data for 'std'", "none"),
        ("sets", "source", "a mode measured in two data sets for 'sets'", "none"),
        ("auto", "bootstrap", "0, or data with standard deviations or a mode measured in two", "2"),
    ],
)
def test_uncertainty_that_the_data_do_not_tell(
    source: str, key: str, expected: str, what: str, folder: Path, refused: Check
) -> None:
    data = edited(DATA, (",0.1,0.01", ",,"), ("b,1,4.1,0.02,0.5,1.1,0.1,\n", ""))
    (folder / "modes.csv").write_text(data)
    study = folder / "wrong.toml"
    study.write_text(edited(STUDY, ('source = "sets"', f'source = "{source}"')))
    refused(study, f"[uncertainty] {key}: expected {expected} ... , found {what}")


# --- matrices -------------------------------------------------------------------------------

MTX = "%%MatrixMarket matrix"


def npy(A: object) -> bytes:
    stream = io.BytesIO()
    np.save(stream, np.asarray(A), allow_pickle=True)
    return stream.getvalue()


def npz(**arrays: Any) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def sparse(A: object) -> bytes:
    stream = io.BytesIO()
    scipy.sparse.save_npz(stream, scipy.sparse.csc_array(A))
    return stream.getvalue()


def compressed(indices: list[int], indptr: list[int]) -> bytes:
    """Return a file of a 2 x 2 matrix whose indices need not be right."""
    return npz(format=b"csr", shape=(2, 2), data=np.ones(2), indices=indices, indptr=indptr)


EYE = [[1.0, 0.0], [0.0, 1.0]]
UNREADABLE = "file: expected a readable matrix, found "

MATRIX_FILES = [
    # file, content, what is said of it
    ("K0.mtx", b"", UNREADABLE),
    ("K0.mtx", b"\xff\xfe\x00", UNREADABLE),
    ("K0.mtx", b"1 0\n0 1\n", UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n2 2 3\n1 1 1.0\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n2 2 1\n3 3 1.0\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n2 2 1\n1 1 abc\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n{'9' * 30} 2 1\n1 1 1\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate integer general\n1 1 1\n1 1 {'9' * 30}\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} array real general\n-2 2\n1\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n{'9' * 13} {'9' * 13} 0\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} array real general\n0 0\n".encode(), "a square matrix, found 0 x 0"),
    ("K0.mtx", f"{MTX} array real general\n0 2\n".encode(), "a square matrix, found 0 x 2"),
    ("K0.mtx", f"{MTX} array real general\n2 1\n1\n1\n".encode(), "a square matrix, found 2 x 1"),
    (
        "K0.mtx",
        f"{MTX} coordinate complex general\n2 2 1\n1 1 1.0 2.0\n".encode(),
        "real numbers, found complex128",
    ),
    (
        "K0.mtx",
        f"{MTX} coordinate real skew-symmetric\n2 2 1\n2 1 1.0\n".encode(),
        "row 0, column 1 (from 0): expected a symmetric matrix, found -1, and 1 across",
    ),
    (
        "K0.mtx",
        f"{MTX} coordinate real general\n2 2 1\n2 2 nan\n".encode(),
        "row 1, column 1 (from 0): expected finite numbers, found nan",
    ),
    ("K1.npy", b"", UNREADABLE),
    ("K1.npy", b"garbage", UNREADABLE),
    ("K1.npy", npy(EYE)[:-5], UNREADABLE),
    ("K1.npy", npy(EYE)[:20], UNREADABLE),
    ("K1.npy", npz(A=EYE), UNREADABLE),
    ("K1.npy", npy([[{}, {}], [{}, {}]]), UNREADABLE + "Object arrays cannot be loaded"),
    ("K1.npy", npy([["1", "0"], ["0", "1"]]), "real numbers, found <U1"),
    ("K1.npy", npy(np.array(EYE) * 1j), "real numbers, found complex128"),
    ("K1.npy", npy(1.0), "a square matrix, found a single number"),
    ("K1.npy", npy([1.0, 2.0]), "a square matrix, found 2"),
    ("K1.npy", npy(np.ones((2, 3))), "a square matrix, found 2 x 3"),
    ("K1.npy", npy(np.ones((2, 2, 2))), "a square matrix, found 2 x 2 x 2"),
    ("K1.npy", npy(np.ones((0, 0))), "a square matrix, found 0 x 0"),
    ("K1.npy", npy([[1, np.inf], [np.inf, 1]]), "column 1 (from 0): expected finite numbers"),
    ("K1.npy", npy([[1, 2], [3, 1]]), "symmetric matrix, found 2, and 3 across the diagonal"),
    ("K1.npy", npy([[1e308, 0], [0, 1]]), "numbers up to 1e+100, found 1e+308"),
    ("K1.npy", npy(np.eye(3)), "k1: expected 2 x 2, as the other matrices, found 3 x 3"),
    ("K2.npz", b"", UNREADABLE),
    ("K2.npz", b"PK\x03\x04garbage", UNREADABLE),
    ("K2.npz", sparse(EYE)[:-30], UNREADABLE),
    ("K2.npz", sparse(EYE)[:200] + b"damage" + sparse(EYE)[206:], UNREADABLE),
    ("K2.npz", npz(A=EYE), UNREADABLE + "The file ... does not contain a sparse"),
    ("K2.npz", npz(format=b"xyz", shape=(2, 2), data=[1.0]), UNREADABLE),
    ("K2.npz", npz(format=np.array([{}]), shape=(2, 2)), UNREADABLE + "Object arrays cannot"),
    ("K2.npz", compressed([0, 10**8], [0, 1, 2]), UNREADABLE),
    ("K2.npz", compressed([0, 1], [0, 10**6, 2]), UNREADABLE),
    ("K2.npz", sparse(np.ones((2, 3))), "a square matrix, found 2 x 3"),
    ("K2.npz", sparse([[1.0, 2.0], [0.0, 1.0]]), "symmetric matrix, found 2, and 0 across"),
    ("K2.npz", sparse(np.eye(3)), "k2: expected 2 x 2, as the other matrices, found 3 x 3"),
    ("K2.npz", sparse(np.zeros((2, 2))), "'k2': expected a parameter that the model uses, found"),
    ("K2.npz", sparse(-K2), "[model]: expected modes at the nominal parameters, found ... indefi"),
    ("M.mtx", f"{MTX} coordinate real general\n2 2 0\n".encode(), "mass matrix that is not zero"),
    (
        "M.mtx",
        f"{MTX} coordinate real symmetric\n2 2 2\n1 1 1\n2 2 -1\n".encode(),
        "[model]: expected modes at the nominal parameters, found the mass matrix is indefinite",
    ),
]


@pytest.mark.parametrize(("name", "content", "says"), MATRIX_FILES)
def test_matrices_that_are_none(
    name: str, content: bytes, says: str, folder: Path, refused: Check
) -> None:
    (folder / name).write_bytes(content)
    of_file = "as the other" not in says and "model" not in says and "not zero" not in says
    refused(folder / "matrices.toml", f"{name}: [model] ... {says}" if of_file else says)


BASE, FIRST, MASS = 'base = "K0.mtx"', 'k1 = "K1.npy"', 'mass = { base = "M.mtx" }'
TERMS = "expected a table of files, base = ... and one a parameter, found "

MATRIX_KEYS = [
    (MASS, f"{MASS}\nfloating = 1", "[model] floating: expected true or false, found 1"),
    (
        f"{{ {BASE}, {FIRST},",
        '{ k1 = "K2.npz",',
        "[model]: expected a structure that is held, or floating = true for rigid-body modes, "
        "found a singular stiffness matrix at the nominal parameters",
    ),
    (MASS, "", f"[model] mass: {TERMS}nothing"),
    (MASS, 'mass = "M.mtx"', f"[model] mass: {TERMS}the text 'M.mtx'"),
    (MASS, "mass = [1]", f"[model] mass: {TERMS}[1]"),
    (MASS, "mass = {}", "[model] mass: expected at least one matrix, found none"),
    (MASS, 'maas = { base = "M.mtx" }', "expected a known key, found 'maas' (did you mean 'mass'"),
    (MASS, 'mass = { bas = "M.mtx" }', "[model] mass bas: ... found 'bas' (did you mean 'base'?)"),
    ("stiffness = {", "stifness = {", f"[model] stiffness: {TERMS}nothing"),
    (FIRST, 'k3 = "K1.npy"', "[model] stiffness k3: expected 'base' or a parameter, found 'k3'"),
    (FIRST, "k1 = 1", "[model] stiffness k1: expected the name of a file, found 1"),
    (FIRST, "k1 = nan", "[model] stiffness k1: expected the name of a file, found nan"),
    (FIRST, "k1 = true", "[model] stiffness k1: expected the name of a file, found true"),
    (FIRST, "k1 = [[1.0]]", "[model] stiffness k1: expected the name of a file, found [[1.0]]"),
    (FIRST, 'k1 = ""', "[model] stiffness k1: expected the name of a file, found the text ''"),
    (FIRST, 'k1 = "a\\u0000.npy"', "k1: expected the name of a file, found the text 'a\\x00.npy'"),
    (FIRST, 'k1 = "K1.bin"', "k1, file: expected a name that ends in .mtx, .npz, .npy, .mat, fo"),
    (
        FIRST,
        'k1 = "all.mat"',
        'k1, file: expected one matrix, or { file = "...", name = "..." } to',
    ),
    (FIRST, 'k1 = "all.mat"', "to say which, found K0, K1"),
    (FIRST, 'k1 = "none.mat"', "to say which, found none"),
    (FIRST, 'k1 = "no.mat"', "no.mat: [model] stiffness k1, file: ... found no such file"),
    (FIRST, 'k1 = "bad.mat"', "bad.mat: [model] stiffness k1, file: expected a readable matrix"),
    (FIRST, 'k1 = { file = "all.mat", name = "k1" }', "a variable in it, found 'k1' (did you mean"),
    (
        FIRST,
        'k1 = { file = "all.mat", name = "text" }',
        "k1, file: expected a square matrix, found 1",
    ),
    (FIRST, 'k1 = { file = "all.mat", name = 1 }', "stiffness k1 name: expected the name of a mat"),
    (
        FIRST,
        'k1 = { name = "K1" }',
        "stiffness k1 file: expected the name of a file, found nothing",
    ),
    (FIRST, 'k1 = { file = "all.mat", nam = "K1" }', "expected a known key, found 'nam' (did you"),
    (FIRST, 'k1 = { file = "K1.npy", name = "K1" }', "expected a .mat file, as only these have"),
    (FIRST, 'k1 = "K.npy"', "K.npy: [model] stiffness k1, file: expected a matrix, found no such"),
    (BASE, 'base = "no.mtx"', "no.mtx: [model] stiffness base, file: ... found no such file"),
    (BASE, 'base = "no.npz"', "no.npz: [model] stiffness base, file: ... found no such file"),
    (BASE, 'base = "folder.mtx"', "folder.mtx: [model] stiffness base, file: ... Is a directory"),
    (
        f", {FIRST}",
        "",
        "[[parameter]] 'k1': expected a parameter that the model uses, found no use",
    ),
    ("low = 0", "low = 2", "[model] sensors low: expected degrees of freedom from 0 to 1, found 2"),
    (
        "sensors = {",
        "sensers = {",
        "[model] sensors: expected a table of sensors ... found nothing",
    ),
    ("[model]\n", "[model]\nmasses = [1.0]\n", "[model]: expected a known key, found 'masses'"),
    (
        "x = [0, 1]",
        "x = [0, 2]",
        "[model] base x: expected degrees of freedom from 0 to 1, found 2",
    ),
    (
        "x = [0, 1]",
        "x = [0, 1.5]",
        "[model] base x: expected a degree of freedom from 0, or a list",
    ),
    ("x = [0, 1]", "x = []", "[model] base x: expected a degree of freedom from 0, or a list"),
    (
        "base = { x",
        "bas = { x",
        "[model]: expected a known key, found 'bas' (did you mean 'base'?)",
    ),
    ("base = { x = [0, 1] }", "base = [0, 1]", "base: expected a table, direction = list of the"),
    (
        "x = [0, 1]",
        "y = [0, 1]",
        "base: expected one of the directions of the base, 'y', found 'x'",
    ),
]


@pytest.mark.parametrize(("old", "new", "says"), MATRIX_KEYS)
def test_contradictions_of_a_study_of_matrices(
    old: str, new: str, says: str, folder: Path, refused: Check
) -> None:
    study = folder / "wrong.toml"
    study.write_text(edited(STUDY, (CHAIN, MATRICES), (old, new)))
    refused(study, says)


# --- several faults at once, and names that look like something else --------------------------


def test_everything_that_is_wrong_is_said_at_once_before_a_run_and_by_check(
    folder: Path, refused: Check, capsys: pytest.CaptureFixture[str]
) -> None:
    study = folder / "wrong.toml"
    edits = [
        ("seed = 1", "seed = -1"),
        ("[2.0, 1.0]", "[2.0, -1.0]"),
        ("low = 0", "low = 1.5"),
        ("bounds = [0.2, 5.0]", "bounds = [5.0, 0.2]"),
        ("shape = [1, 2]", "shape = [1, 7]"),
        ("shapes = 2.0", "shapes = -2.0"),
        ("points = 5", "points = 1"),
        ("window = 3.0", "window = 0.5"),
        ("starts = 3", "stars = 3"),
    ]
    study.write_text(edited(STUDY, *edits))
    (folder / "modes.csv").write_text(
        edited(DATA, ("4.0", "-4.0"), ("11.0", "eleven"), ("0.02", "2"))
    )
    refused(
        study,
        "wrong.toml: [study] seed: ",
        "wrong.toml: [model] masses: ",
        "wrong.toml: [model] sensors low: ",
        "wrong.toml: [[parameter]] 1 ('k1') bounds: ",
        "modes.csv: line 2, column 'frequency': ",
        "modes.csv: line 3, column 'frequency': ",
        "modes.csv: line 4, column 'damping': ",
        "wrong.toml: [[weighted]] 1 ('mine') weights shapes: ",
        "wrong.toml: [pareto] points: ",
        "wrong.toml: [pairing] window: ",
        "wrong.toml: [search]: expected a known key, found 'stars'",
    )
    command("run", study)
    said = capsys.readouterr().err
    assert command("check", study) == 2
    assert capsys.readouterr() == ("", said)


def test_names_may_hold_what_a_path_or_a_terminal_gives_a_meaning(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = folder / "names.toml"
    text = STUDY.replace('"k1"', '"../k/1 [red]"').replace('"k2"', '"%s"')
    text = text.replace('"frequencies"', '"a/b [bold]"').replace("{ frequencies", '{ "a/b [bold]"')
    text = text.replace(
        "starts = 3\nlimit = 9\nevolutions = 1", "starts = 1\nlimit = 1\nevolutions = 0"
    )
    text = text.replace('"mine"', '"../[/]"').replace('"two masses"', '"[/] ${x}"')
    text = text.replace('"low"', '"[/low]"').replace("low = ", '"[/low]" = ')
    study.write_text(text.replace('"peak"', '"../[/peak] $_"'))
    (folder / "modes.csv").write_text(DATA.replace("low", "[/low]"))
    assert command("check", study) == 0, capsys.readouterr().err
    assert "a/b [bold]" in capsys.readouterr().out
    assert command("run", study, "-o", folder / "output") == 0, capsys.readouterr().err
    assert command("show", folder / "output") == 0, capsys.readouterr().err
    out = capsys.readouterr().out
    assert "../k/1 [red]" in out
    assert "../[/]" in out
    assert "../[/peak] $_: force at top" in out
    assert command("show", folder / "output", "--figures") == 0, capsys.readouterr().err
    assert not (folder / "k").exists()


# --- the command line -------------------------------------------------------------------------

COMMANDS = [
    (["--colour"], "No such option"),
    (["check"], "Missing argument 'STUDY'"),
    (["chekc", "{}/chain.toml"], "No such command 'chekc'"),
    (["check", "--fast", "{}/chain.toml"], "No such option"),
    (["check", "{}/chain.toml", "more"], "Got unexpected extra argument (more)"),
    (["run", "{}/chain.toml", "-o"], "Option '-o' requires an argument"),
    (["show", "{}", "--format", "xml"], "'xml' is not one of 'table', 'json'"),
    (["show", "{}/absent"], "absent/results.nc: file: expected results of a finished run, found"),
    (["show", "{}"], "results.nc: file: expected results of a finished run, found no such file"),
    (["show", "{}/chain.toml"], "results.nc: file: expected results of a finished run, found no"),
    (["run", "{}/chain.toml", "--refine", "2"], "2.0 is not in the range"),
    (["run", "{}/three.toml", "--refine", "0.1"], "--refine: expected two groups and method 'nbi'"),
    (["compare"], "Missing argument 'DIRECTORIES...'"),
    (["compare", "{}", "{}/absent"], "absent/results.nc: file: expected results of a finished run"),
    (["init", "{}/new", "--example", "x"], "--example: expected one of hammer-test, three-"),
    (["init", "{}/new", "--example", "three-story-c2"], "(did you mean 'three-story-c"),
    (
        ["init", "{}/new", "--example", "../examples"],
        "--example: expected one of hammer-test, three-",
    ),
    (["init", "{}/new", "--example", ""], "--example: expected one of hammer-test, three-"),
    (["init", "{}/chain.toml"], "chain.toml: folder: expected a folder that can be written to"),
    (["init", "{}"], "modes.csv: file: expected no such file: nothing is overwritten, found one"),
    (["run", "{}/chain.toml", "-o", "{}/modes.csv"], "modes.csv: folder: expected a folder that"),
    (["run", "{}/chain.toml", "-o", "{}/modes.csv/x"], "x: folder: expected a folder that can be"),
]


@pytest.mark.parametrize(("arguments", "says"), COMMANDS)
def test_misuse_of_the_command_line(
    arguments: list[str], says: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    third = ('[[group]]\nname = "mode 1"\nfrequency = [1]\n\n[[weighted]]', "[[weighted]]")
    three = edited(STUDY, third[::-1], ("shapes = 2.0 }", 'shapes = 2.0, "mode 1" = 1.0 }'))
    (folder / "three.toml").write_text(three)
    before = {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    status = command(*(argument.format(folder) for argument in arguments))
    out, err = capsys.readouterr()
    assert status == 2, err
    assert out == ""
    assert says in err
    assert {path: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before
    assert not (folder / "new").exists()


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "results.nc: file: expected results in netCDF, found "),
        (b"no netCDF", "results.nc: file: expected results in netCDF, found "),
        (b"\x89HDF\r\n\x1a\n" + b"\x00" * 500, "results.nc: file: expected results in netCDF, fou"),
    ],
)
def test_results_that_are_none(
    content: bytes, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "results.nc").write_bytes(content)
    for form in ("table", "json"):
        assert command("show", tmp_path, "--format", form) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert says in err


def test_results_of_another_program(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import xarray as xr

    xr.Dataset({"label": ("point", ["a"])}).to_netcdf(tmp_path / "results.nc", engine="h5netcdf")
    assert command("show", tmp_path) == 2
    err = capsys.readouterr().err
    assert (
        "results.nc: variables: expected results of modefront, found none called kind, pareto"
        in err
    )


def test_a_folder_that_cannot_be_written_to(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(self: Path, *_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", str(self))

    # Permissions do not bind the administrator, as whom containers often run their tests.
    monkeypatch.setattr(Path, "mkdir", refuse)
    for arguments in (["run", folder / "chain.toml", "-o", folder / "x"], ["init", folder / "x"]):
        assert command(*arguments) == 2
        err = capsys.readouterr().err
        assert "x: folder: expected a folder that can be written to, found" in err
        assert "Permission denied" in err


def test_the_module_is_the_command(folder: Path) -> None:
    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "modefront", *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    (folder / "wrong.toml").write_text(edited(STUDY, ("seed = 1", "seed = -1")))
    done = run("run", str(folder / "wrong.toml"))
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith(f"{folder}/wrong.toml: [study] seed: expected a whole number")
    assert done.stderr.count("\n") == 1
    assert not (folder / "wrong-results").exists()
    assert run("--help").returncode == 0
