"""Settings and fixtures of all tests."""

from __future__ import annotations

import gc
import re
import shutil
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.linalg
import scipy.sparse
from faultless import CHAIN, DATA, K0, K1, K2, MATRICES, STUDY, M
from hypothesis import settings
from refusals import Check, command
from threadpoolctl import threadpool_limits

from modefront.study.file import FAMILIES
from modefront.work.task import Costs, counted

# Threads wait for each other on small matrices. SciPy brings a BLAS of its own: `scipy.linalg`.
threadpool_limits(1, user_api="blas")

settings.register_profile(
    "modefront", max_examples=40, deadline=None, derandomize=True, print_blob=False
)
settings.load_profile("modefront")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Have the files with the longest tests begin first, so that none is left alone at the end.

    Tests of a file stay together: they share what is solved once for all of them.
    """
    seconds = Counter[Path]()
    for item in items:
        seconds[item.path] += sum(mark.args[0] for mark in item.iter_markers("slow"))
    items.sort(key=lambda item: -seconds[item.path])


def pytest_collection_finish() -> None:
    """Leave all modules and tests out of garbage collections, each of which would visit them."""
    gc.freeze()


@pytest.fixture(autouse=True, scope="module")
def nothing_stays_registered_after_a_file() -> Iterator[None]:
    """Forget what the tests of a file have registered."""
    before = [dict(family.added) for family in FAMILIES]
    yield
    for family, added in zip(FAMILIES, before, strict=True):
        family.added = added


@pytest.fixture(scope="module")
def short_chains() -> Iterator[None]:
    """Draw fewer models from posteriors than users have, in a file that looks at few of them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("modefront.study.session.DRAWS", 20)
        patch.setattr("modefront.uncertainty.sampling.ROUND", 5)
        yield


@pytest.fixture
def costs() -> Iterator[Costs]:
    """Count what the test spends."""
    with counted() as spent:
        yield spent


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str]) -> Check:
    """Assert that a run refuses a study, say these things, and write nothing.

    What is said is given as ``place: expected ... found ...`` with " ... " for any text between.
    """

    def refuse(study: Path, *says: str) -> None:
        output = study.parent / "output"
        status = command("run", study, "-o", output)
        out, err = capsys.readouterr()
        assert status == 2, err
        assert out == ""
        lines = err.splitlines()
        for line in lines:
            assert re.fullmatch(r"\S.*: .+: expected .+, found .+", line), line
            assert line.startswith(str(study.parent)), "the file is named"
        for text in says:
            pattern = ".*".join(map(re.escape, text.split(" ... ")))
            assert any(re.search(pattern, line) for line in lines), (text, err)
        assert not output.exists()
        assert not list(study.parent.glob("*-results"))

    return refuse


@pytest.fixture(scope="session")
def faultless(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a study of a chain and of matrices in which nothing is wrong."""
    root = tmp_path_factory.mktemp("faultless")
    (root / "chain.toml").write_text(STUDY)
    (root / "matrices.toml").write_text(STUDY.replace(CHAIN, MATRICES))
    (root / "modes.csv").write_text(DATA)
    scipy.io.mmwrite(root / "K0.mtx", K0)
    np.save(root / "K1.npy", K1)
    scipy.sparse.save_npz(root / "K2.npz", scipy.sparse.csr_array(K2))
    scipy.io.mmwrite(root / "M.mtx", scipy.sparse.coo_array(M))
    (root / "folder.csv").mkdir()
    scipy.io.savemat(root / "all.mat", {"K0": K0, "K1": K1, "text": "K1", "rows": 2.0})
    scipy.io.savemat(root / "none.mat", {"rows": 2.0})
    (root / "bad.mat").write_bytes((root / "all.mat").read_bytes()[:150])
    (root / "folder.mtx").mkdir()
    return root


@pytest.fixture
def folder(faultless: Path, tmp_path: Path) -> Path:
    """A copy of that folder."""
    return Path(shutil.copytree(faultless, tmp_path, dirs_exist_ok=True))
