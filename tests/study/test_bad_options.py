"""Options that contradict each other or the data."""

from pathlib import Path

import pytest
from faultless import DATA, PREDICTIONS, STUDY
from refusals import Check, edited, refuses

from modefront.front import methods

CONTRADICTIONS = [
    ("points = 5", "points = 10001", "points: expected a whole number from 2 to 10000, found 1000"),
    ("spare = 0", "spare = 1001", "spare: expected a whole number from 0 to 1000, found 1001"),
    ("evaluations = 2000", "evaluations = 19", "evaluations: expected at least the population, 20"),
    (
        'source = "sets"',
        'source = "none"',
        "[uncertainty] bootstrap: expected 0 with source = 'none', found 2",
    ),
    (PREDICTIONS, "", "[uncertainty] draws: expected 0 without predictions, found 3"),
]


test_contradictions_of_options = refuses(*CONTRADICTIONS)


def test_a_method_whose_package_is_missing(
    folder: Path, refused: Check, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(methods, "find_spec", lambda _: None)
    for method in ("spea2", "nsga2"):
        study = folder / "wrong.toml"
        study.write_text(edited(STUDY, ('method = "nbi"', f'method = "{method}"')))
        refused(study, f"[pareto] method: expected the package pymoo for '{method}': pip install")


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
