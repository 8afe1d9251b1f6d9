"""Statements on few data: each once, in order of weight, and none on rounding."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from texts import two_of_each

import modefront as mf
from modefront.cli.main import cli
from modefront.results.remarks import MOST, digest, findings_of
from modefront.study.file import load

SEARCH = mf.Search(doubt=0.5)
GROUPS = (mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all"))


def stiffnesses_and_masses() -> mf.UpdatingProblem:
    """A chain of which all stiffnesses and masses are unknown: together they scale for nothing."""
    k, m = ("k1", "k2", "k3"), ("m1", "m2", "m3")
    model = mf.chain((*k, *m), [2.0] * 3, [3e3] * 3, stiffness_parameters=k, mass_parameters=m)
    modes = model.modes(np.array([1.1, 0.9, 1.2, 1.05, 0.95, 1.1]), 3)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    names = model.parameters
    bounds, nominal = dict.fromkeys(names, (0.5, 2.0)), dict.fromkeys(names, 1.0)
    return mf.updating_problem(model, data, GROUPS, bounds, nominal)


@pytest.fixture(scope="module")
def solved() -> mf.Results:
    """The results of these; no posterior, which no test looks at."""
    without = mf.NoisePrior(weight=0)
    return mf.solve(stiffnesses_and_masses(), points=2, search=SEARCH, noise=without)


def test_a_null_manifold_is_followed_once_and_said_once(solved: mf.Results) -> None:
    problem, data = stiffnesses_and_masses(), solved.dataset
    message = data["finding"].values.tolist()
    assert len(message) <= MOST
    manifolds = [text for text in message if "equally well" in text]
    assert len({text.split(" of models")[0] for text in manifolds}) == len(manifolds)
    of, theta = data["equal_of"].values, data["equal_theta"].values
    assert all("(1 model" not in text and ":  (" not in text for text in manifolds)
    for i, name in enumerate(problem.objectives):
        models = theta[of == name]
        J = np.array([problem.evaluate(model, derivatives=False).J[i] for model in models])
        assert J == pytest.approx(J.min(), rel=1e-5, abs=1e-12), "as good, computed again"
        assert data["equal_objective"].values[of == name, i] == pytest.approx(J, abs=1e-12)
    # Frequencies fix 3 of 6 combinations, shapes 4 of 6; both leave stiffness over mass scales.
    dimension = data["equal_dimension"].values
    assert set(dimension[of == "frequencies"]) == {3}
    assert set(dimension[of == "shapes"]) == {2}
    assert any(
        "all data determine 5 of 6" in text and "all 6 parameters can be scaled together" in text
        for text in message
    )
    ends = theta[of == "shapes"]
    for column in ends.T:
        assert np.ptp(column) > 0.5, "far from where it began, not next to it"


def test_findings_are_cut_where_they_are_printed_and_nowhere_else(solved: mf.Results) -> None:
    data = solved.dataset
    many = np.array([f"finding {i}" for i in range(25)])
    data = data.drop_vars(["finding", "finding_record"]).assign(finding=(("finding",), many))
    said = [text for text in map(str, findings_of(data, full=True)) if text.startswith("finding")]
    assert said == many.tolist()
    cut = digest(said, "modefront show --all DIR")
    assert cut[-2:] == ["finding 9", "and 15 more findings: modefront show --all DIR"]
    assert len(cut) == MOST + 1
    assert digest(["a"], "there") == ["a"]


STUDY = """
[study]
name = "one sensor"

[data]
file = "modes.csv"

[model]
kind = "chain"
masses = [2.0, 1.0]
stiffnesses = [3000.0, 2000.0]
stiffness_parameters = ["k1", "k2"]
sensors = {top = 1}

"""


@pytest.mark.parametrize("command", ["check", "run"])
def test_a_group_that_no_parameter_changes_is_an_error_of_the_study(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "modes.csv").write_text(
        "set,mode,frequency,damping,top\na,1,4.2,,1.0\na,2,10.5,,-0.7\n"
    )
    (tmp_path / "study.toml").write_text(STUDY + two_of_each())
    result = CliRunner().invoke(cli, [command, str(tmp_path / "study.toml")])
    assert isinstance(result.exception, mf.InputError)
    text = str(result.exception)
    assert "study.toml: [[group]] 'shapes': expected residuals that a parameter changes" in text
    assert "remove the group" in text
    assert not (tmp_path / "study-results" / "results.nc").exists()


def test_check_prints_ten_findings_and_how_many_more(tmp_path: Path) -> None:
    """Eleven groups, one a frequency or a shape, make twelve sentences."""
    n = 6
    model = mf.chain([], [2.0] * n, [3e3] * n)
    modes = model.modes(np.zeros(0), n, derivatives=False)
    rows = [
        f"a,{r + 1},{f!r},," + ",".join(repr(float(x)) for x in phi)
        for r, (f, phi) in enumerate(zip(modes.frequency.tolist(), modes.phi.T, strict=True))
    ]
    header = "set,mode,frequency,damping," + ",".join(model.sensors)
    (tmp_path / "modes.csv").write_text("\n".join([header, *rows]) + "\n")
    names = [f"k{i + 1}" for i in range(n)]
    text = (
        '[study]\nname = "many"\n[data]\nfile = "modes.csv"\n[model]\nkind = "chain"\n'
        f"masses = {[2.0] * n}\nstiffnesses = {[3e3] * n}\nstiffness_parameters = {names}\n"
    )
    for name in names:
        text += f'[[parameter]]\nname = "{name}"\nnominal = 1.0\nbounds = [0.2, 5.0]\n'
    for r in range(1, n + 1):
        text += f'[[group]]\nname = "f{r}"\nfrequency = [{r}]\n'
        text += f'[[group]]\nname = "s{r}"\nshape = [{r}]\n'
    (tmp_path / "study.toml").write_text(text + "[pareto]\npoints = 2\n")
    study = str(tmp_path / "study.toml")
    assert load(tmp_path / "study.toml").problem.objectives[0] == "f1"
    first = CliRunner().invoke(cli, ["check", study])
    assert first.exception is None
    lines = first.output.splitlines()
    shown = [line for line in lines if " determine" in line or line.startswith("warning")]
    assert len(shown) == MOST
    (more,) = [line for line in lines if line.startswith("and ")]
    assert "more finding" in more
    assert "modefront check --all" in more
    every = CliRunner().invoke(cli, ["check", "--all", study]).output.splitlines()
    full = [line for line in every if " determine" in line or line.startswith("warning")]
    assert len(full) == MOST + int(more.split()[1])
    assert set(shown) <= set(full)
