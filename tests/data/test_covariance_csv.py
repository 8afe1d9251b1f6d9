"""Covariances of shapes as CSV: written and read, by hand or not, and what is wrong with them."""

from pathlib import Path

import numpy as np
import pytest

import modefront as mf
from modefront.data.csv import read_covariance, write_covariance
from modefront.data.modal import ModalData

SENSORS = ("low", "mid", "top")
HEADER = "set,mode,sensor,low,mid,top\n"
ROWS = "1,1,low,4e-4,1e-4,0\n1,1,mid,1e-4,1.0e-4,0\n1,1,top,0,0,9e-4\n"


def bare(std: bool = False) -> ModalData:
    shape = np.array([[0.2, 0.5, 1.0], [1.0, 0.3, -0.8]])
    known = np.tile([0.02, 0.01, 0.03], (2, 1)) if std else None
    return mf.modal_data(np.array([1.0, 3.0]), shape, SENSORS, shape_std=known)


def read(folder: Path, text: str, data: ModalData | None = None) -> ModalData:
    (folder / "c.csv").write_text(text, encoding="utf-8")
    return read_covariance(folder / "c.csv", data or bare(), {"lower": "low"})


def test_what_is_written_is_read(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    half = rng.normal(size=(1, 2, 3, 3))
    data = bare().with_covariance(half @ half.swapaxes(2, 3))
    write_covariance(tmp_path / "c.csv", data)
    again = read_covariance(tmp_path / "c.csv", bare(), {})
    assert data.shape_covariance is not None
    assert again.shape_covariance is not None
    np.testing.assert_allclose(again.shape_covariance, data.shape_covariance, rtol=1e-8)
    np.testing.assert_allclose(again.shape_std, data.shape_std, rtol=1e-8)


def test_a_mode_without_rows_has_deviations_alone_and_names_are_mapped(tmp_path: Path) -> None:
    text = (HEADER + ROWS).replace("low", "lower").replace("set,", "").replace("1,1,", "1,")
    data = read(tmp_path, text.replace(",", ";"), bare(std=True))
    assert data.shape_covariance is not None
    assert data.shape_covariance[0, 0, 0].tolist() == [4e-4, 1e-4, 0.0]
    assert np.isnan(data.shape_covariance[0, 1]).all()
    assert data.shape_std[0, 1].tolist() == [0.02, 0.01, 0.03]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "file: expected a file of covariances of shapes, found an empty file"),
        (HEADER, "line 2: expected at least one row below the header, found the end"),
        (HEADER.replace("top", "tip") + ROWS, "column 'tip': expected a sensor of the data, once"),
        (HEADER + ROWS.replace("1,1,low", "2,1,low"), "line 2, column 'set': expected one of 1, f"),
        (HEADER + ROWS.replace("1,1,low", "1,7,low"), "column 'mode': expected one of 1, 2, found"),
        (HEADER + ROWS.replace("mid", "mud"), "line 3, column 'sensor': .*did you mean 'mid'"),
        (HEADER + ROWS.replace("mid", "low"), "line 3, column 'sensor': expected each component"),
        (HEADER + ROWS.replace("9e-4", "x"), "line 4, column 'top': expected a finite number or"),
        (HEADER + ROWS.replace(",9e-4", ""), "line 4: expected 6 fields, as in the header, found"),
        (HEADER + ROWS.replace("9e-4", ""), "c.csv: covariance of mode 1 in set '1': .*top, top"),
        (HEADER + ROWS.replace("low,4e-4,1e-4", "low,4e-4,2e-4"), "found 0.0002 and 0.0001"),
        (HEADER + ROWS.replace("9e-4", "-9e-4"), "expected 0 or more as the variance of top"),
        (HEADER + ROWS.replace("e-4,1e-4,0", "e-4,3e-4,0").replace("mid,1", "mid,3"), "eigenval"),
    ],
)
def test_what_is_wrong_is_said(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(mf.InputError, match=message):
        read(tmp_path, text)


def test_a_file_of_other_modes_is_found_by_its_variances(tmp_path: Path) -> None:
    text = HEADER + ROWS.replace("9e-4", "1e-4")
    expected = "expected 0.0009, the square of its deviation, as the variance of top, found 0.0001"
    with pytest.raises(mf.InputError, match=expected):
        read(tmp_path, text, bare(std=True))
    with pytest.raises(
        mf.InputError, match="shape_covariance: expected 2 modes x 3 sensors x 3 sensors, found"
    ):
        bare().with_covariance(np.zeros((2, 2, 2)))
