"""The command ``modefront identify``."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from written import write

from modefront.cli.main import cli
from modefront.data.csv import read_csv
from modefront.errors import InputError, UnfinishedError
from modefront.study.file import load


def _invoke(*arguments: object) -> str:
    result = CliRunner().invoke(cli, ["identify", *map(str, arguments)], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def test_the_example_gives_the_modal_data_it_comes_with(tmp_path: Path) -> None:
    write("hammer-test", tmp_path)
    output = tmp_path / "again.csv"
    text = _invoke(tmp_path / "test-m0.toml", "-o", output)
    result, kept = read_csv(output), read_csv(tmp_path / "modes-m0.csv")
    np.testing.assert_allclose(result.frequency, kept.frequency, rtol=1e-6)
    np.testing.assert_allclose(result.shape, kept.shape, atol=1e-5)
    assert (result.frequency_std > 0).all()
    assert (result.shape_std > 0).all()
    assert "next: modefront identify" in text
    report = json.loads((tmp_path / "again-identification.json").read_text())
    assert [len(identified["modes"]) for identified in report["sets"]] == [3, 3, 3]

    study, file = tmp_path / "study.toml", tmp_path / "again-covariance.csv"
    text = study.read_text(encoding="utf-8").replace(
        "[data]", f'[data]\ncovariance = "{file.name}"'
    )
    study.write_text(text, encoding="utf-8")
    loaded = load(study)
    data, C = loaded.problem.data, loaded.problem.data.shape_covariance
    assert C is not None
    np.testing.assert_allclose(np.einsum("krss->krs", C), data.shape_std**2, rtol=1e-6)
    along = np.einsum("krst,krt->krs", C, data.shape)
    assert np.abs(along[:, 0]).max() < 1e-6 * C.max()  # of unit norm, where sets agree
    file.write_text(file.read_text(encoding="utf-8").replace("floor3", "roof"), encoding="utf-8")
    with pytest.raises(InputError, match=r"again-covariance.csv: line 1, column 'roof': expected"):
        load(study)


@pytest.mark.slow(20)
def test_an_ambient_test_of_three_setups_is_one_set(tmp_path: Path) -> None:
    write("ambient-test", tmp_path)
    pictures = tmp_path / "pictures"
    output = tmp_path / "again.csv"
    _invoke(tmp_path / "test.toml", "-o", output, "--figures", pictures)
    result, kept = read_csv(output), read_csv(tmp_path / "modes.csv")
    np.testing.assert_allclose(result.frequency, kept.frequency, rtol=1e-4)
    np.testing.assert_allclose(result.shape, kept.shape, atol=1e-4)
    assert set(result.sensors) == {"floor1", "floor2", "floor3"}
    true = np.array([[4.7357, 13.089, 17.957]])
    assert (np.abs(result.frequency - true) < 3 * result.frequency_std).all()
    assert (result.shape_std > 0).all()
    assert len(list(pictures.iterdir())) == 4
    report = json.loads((tmp_path / "again-identification.json").read_text())
    assert "harmonic" in report["sets"][0]["rejected"][0]["reason"]
    assert not any("records of more" in text for text in report["warnings"]), "they are short"


@pytest.mark.slow(3)
def test_universal_files_are_written(tmp_path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    write("hammer-test", tmp_path)
    pictures = tmp_path / "pictures"
    _invoke(tmp_path / "m0-set1-floor3.csv", "-o", tmp_path / "m.uff", "--figures", pictures)
    assert len(list(pictures.iterdir())) == 4
    sets = pyuff.UFF(str(tmp_path / "m.uff")).read_sets()
    assert [part["type"] for part in sets] == [55, 55, 55]
    assert abs(sets[0]["eig"]) / (2 * np.pi) == pytest.approx(4.7357, rel=1e-3)


def test_a_band_without_modes_is_said_and_nothing_is_written(tmp_path: Path) -> None:
    write("hammer-test", tmp_path)
    with pytest.raises(UnfinishedError, match="no mode was found in the band"):
        _invoke(tmp_path / "test-m0.toml", "-o", tmp_path / "o.csv", "--band", 20.5, 24)
    assert not (tmp_path / "o.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["-o", "o.csv", "--band", "40", "50"], "the files reach from 1 to 25 Hz"),
        (["-o", "o.txt"], r"ends in \.csv"),
    ],
)
def test_wrong_input_is_named(tmp_path: Path, arguments: list[str], message: str) -> None:
    write("hammer-test", tmp_path)
    with pytest.raises(InputError, match=message):
        _invoke(tmp_path / "test-m0.toml", *arguments)


def test_a_band_of_too_few_lines_of_an_ambient_test_is_named(tmp_path: Path) -> None:
    write("ambient-test", tmp_path)
    with pytest.raises(InputError, match=r"band: .*a band of 40 lines of set .* 2 to 2\.01 Hz"):
        _invoke(tmp_path / "test.toml", "-o", tmp_path / "o.csv", "--band", 2, 2.01)


@pytest.mark.slow(5)
def test_modes_are_chosen_by_hand(tmp_path: Path) -> None:
    write("hammer-test", tmp_path)
    test, output = tmp_path / "test-m0.toml", tmp_path / "o.csv"
    chosen = ("--keep", "1,2", "--drop", "1", "--seed", "18.5,4.7")
    text = _invoke(test, "-o", output, *chosen)
    assert f"{' '.join(chosen)} -o {output} --report test.html" in text, "pasted, it loses nothing"
    found = read_csv(output)
    assert found.frequency.shape[0] == 3
    dropped, first, *at_the_seed = found.mean_frequency
    assert dropped == pytest.approx(4.7, rel=0.02)  # mode 1 of the table, but there is a seed
    assert first == pytest.approx(13.09, rel=0.01)  # mode 2 of the table without a seed
    assert at_the_seed == pytest.approx([18.5] * len(at_the_seed), rel=0.03)
    assert at_the_seed
    report = json.loads((tmp_path / "o-identification.json").read_text())
    assert "left out by hand" in [x["reason"] for x in report["sets"][0]["rejected"]]
    with pytest.raises(InputError, match="numbers of modes, from 1 to 3"):
        _invoke(test, "-o", output, "--drop", "9")
    with pytest.raises(UnfinishedError, match="--drop left no mode"):
        _invoke(test, "-o", output, "--drop", "1,2,3")
    with pytest.raises(InputError, match="frequencies of the lines, 1 to 25 Hz, found 900"):
        _invoke(test, "-o", output, "--seed", "900")


def test_a_mode_at_a_seed_stays_and_is_flagged(tmp_path: Path) -> None:
    write("hammer-test", tmp_path)
    functions, output = tmp_path / "m0-set1-floor3.csv", tmp_path / "o.csv"
    _invoke(functions, "-o", output, "--seed", "9,4.7")
    report = json.loads((tmp_path / "o-identification.json").read_text())
    (modes,) = [each["modes"] for each in report["sets"]]
    assert len(modes) == 4
    assert any("kept by hand" in flag for mode in modes for flag in mode["flags"])
