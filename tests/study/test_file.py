"""The study file: what a right one says."""

from collections.abc import Callable, Sequence
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.sparse

import modefront as mf
from modefront.front.options import Pareto, Weighted
from modefront.front.search import Search
from modefront.models.base import Model
from modefront.models.chain import chain
from modefront.models.files import read_matrix
from modefront.options import Table
from modefront.pairing.match import Pairing
from modefront.residuals.groups import Group
from modefront.study.definition import Study
from modefront.study.file import load

HEAD = """
[study]
name = "two masses"

[data]
file = "../data/modes.csv"

[[parameter]]
name = "k1"
nominal = 1
bounds = [0.2, 5]

[[parameter]]
name = "k2"
nominal = 1.5
bounds = [0.3, 4.0]

[[group]]
name = "frequencies"
frequency = "all"

[[group]]
name = "second"
frequency = [2]
shape = [2, 1]
"""

CHAIN = """
[model]
kind = "chain"
masses = [2.0, 1.0]
stiffnesses = [3000.0, 2000.0]
stiffness_parameters = ["k1", "k2"]
"""

MATRICES = """
[model]
kind = "matrices"
stiffness = { k1 = "../model/K1.mtx", k2 = "../model/K2.npz" }
mass = { base = "../model/M.npy" }
sensors = { floor1 = 0, floor2 = [[1, 1.0]] }
"""

K1 = np.array([[3000.0, 0.0], [0.0, 0.0]])
K2 = 2000.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
M = np.diag([2.0, 1.0])


@pytest.fixture
def study(tmp_path: Path) -> Callable[[str], Study]:
    """Return a study file, with data and matrices in folders beside its own."""
    for name in ("data", "model", "studies"):
        (tmp_path / name).mkdir()
    (tmp_path / "data" / "modes.csv").write_text(
        "set,mode,frequency,damping,floor1,floor2\na,1,4,,0.6,1\na,2,11,,1,-0.8\n"
    )
    scipy.io.mmwrite(tmp_path / "model" / "K1.mtx", K1)
    scipy.sparse.save_npz(tmp_path / "model" / "K2.npz", scipy.sparse.csr_array(K2))
    np.save(tmp_path / "model" / "M.npy", M)

    def read(text: str) -> Study:
        file = tmp_path / "studies" / "study.toml"
        file.write_text(text)
        return load(file)

    return read


def test_what_is_not_said_has_defaults(study: Callable[[str], Study]) -> None:
    read = study(HEAD + CHAIN)
    assert (read.name, read.seed) == ("two masses", 0)
    assert read.pareto == Pareto("nbi", None, "bounds", 0.0)
    assert read.weighted == ()
    assert read.search == Search()
    assert read.problem.pairing == Pairing(spare=3)
    assert read.problem.model.sensors == ("floor1", "floor2")


def test_parameters_and_groups(study: Callable[[str], Study]) -> None:
    problem = study(HEAD + CHAIN).problem
    assert problem.model.parameters == ("k1", "k2")
    assert problem.start.tolist() == [1.0, 1.5]
    assert problem.lower.tolist() == [0.2, 0.3]
    assert problem.upper.tolist() == [5.0, 4.0]
    assert problem.groups == (
        Group("frequencies", frequency="all"),
        Group("second", frequency=(2,), shape=(2, 1)),
    )
    assert problem.properties.tolist() == [2.0, 5.0]


def test_the_rest(study: Callable[[str], Study]) -> None:
    read = study(
        HEAD
        + CHAIN
        + """
        [[weighted]]
        name = "by hand"
        weights = { second = 2, frequencies = 0.5 }

        [pareto]
        points = 7
        programme = "equations"

        [pairing]
        method = "order"
        window = 2
        spare = 4

        [search]
        evaluations = 500
        tolerance = 0.01
        doubt = 0.5
        """
    )
    assert read.weighted == (Weighted("by hand", {"second": 2.0, "frequencies": 0.5}),)
    assert read.pareto == Pareto(points=7, programme="equations")
    assert read.problem.pairing == Pairing("order", 2.0, 4)
    assert read.search == Search(500, 0.01, 0.5)


def test_matrices_in_every_format_make_the_model_of_the_chain(
    study: Callable[[str], Study],
) -> None:
    theta = np.array([0.9, 1.2])
    expected = chain(
        ["k1", "k2"], [2.0, 1.0], [3000.0, 2000.0], stiffness_parameters=["k1", "k2"]
    ).modes(theta, 2)
    for text in (CHAIN, MATRICES):
        modes = study(HEAD + text).problem.model.modes(theta, 2)
        np.testing.assert_allclose(modes.lam, expected.lam, rtol=1e-12)
        np.testing.assert_allclose(np.abs(modes.phi), np.abs(expected.phi), rtol=1e-10)
        np.testing.assert_allclose(modes.dlam, expected.dlam, rtol=1e-10)


def test_added_masses_and_scaled_masses(study: Callable[[str], Study]) -> None:
    text = CHAIN.replace('["k1", "k2"]', '["k1", ""]') + (
        'added_masses = [0.5, 0.25]\nmass_parameters = ["", "k2"]\n'
        "sensors = { floor1 = 0, floor2 = [[0, 0.25], [1, 0.75]] }\n"
    )
    model = study(HEAD + text).problem.model
    direct = chain(
        ["k1", "k2"],
        [2.0, 1.0],
        [3000.0, 2000.0],
        added_masses=[0.5, 0.25],
        stiffness_parameters=["k1", None],
        mass_parameters=[None, "k2"],
        sensors={"floor1": 0, "floor2": [(0, 0.25), (1, 0.75)]},
    )
    theta = np.array([0.9, 1.2])
    np.testing.assert_array_equal(model.modes(theta, 2).lam, direct.modes(theta, 2).lam)
    np.testing.assert_array_equal(model.modes(theta, 2).phi, direct.modes(theta, 2).phi)


def test_the_hash_tells_of_every_input(study: Callable[[str], Study], tmp_path: Path) -> None:
    text = HEAD + MATRICES
    first = study(text).digest
    assert study(text).digest == first
    digests = {first, study(text + "\n# a remark").digest}
    data = tmp_path / "data" / "modes.csv"
    data.write_text(data.read_text().replace("0.6", "0.7"))
    digests.add(study(text).digest)
    np.save(tmp_path / "model" / "M.npy", 1.01 * M)
    digests.add(study(text).digest)
    assert len(digests) == 4


def test_files_of_any_kind_of_model_are_part_of_the_digest(tmp_path: Path) -> None:
    def read_springs(table: Table, parameters: Sequence[str]) -> Model:
        path = table.path(table.text("springs") or "")
        k = [float(x) for x in path.read_text().split()]
        return chain(parameters, [1.0, 1.0], k, stiffness_parameters=["theta1", "theta2"])

    mf.register(mf.ModelKind("springs", read_springs))
    parameters = "".join(
        f'[[parameter]]\nname = "theta{i}"\nnominal = 1.0\nbounds = [0.5, 2.0]\n' for i in (1, 2)
    )
    (tmp_path / "study.toml").write_text(
        '[study]\nname = "springs"\n[data]\nfile = "modes.csv"\n'
        f'[model]\nkind = "springs"\nsprings = "k.txt"\n{parameters}'
        '[[group]]\nname = "f"\nfrequency = "all"\n'
    )
    (tmp_path / "modes.csv").write_text(
        "set,mode,frequency,damping,floor1,floor2\na,1,2.5,,0.6,1\na,2,7,,1,-0.6\n"
    )
    digests = set()
    for k in ("900 800", "900 801"):
        (tmp_path / "k.txt").write_text(k)
        study = load(tmp_path / "study.toml")
        digests |= {study.digest, study.work}
    assert len(digests) == 4


@pytest.mark.parametrize("kind", ["csr", "csc", "coo", "bsr", "dia"])
def test_every_sparse_storage_is_read(kind: str, tmp_path: Path) -> None:
    scipy.sparse.save_npz(tmp_path / "K.npz", scipy.sparse.csr_array(K2).asformat(kind))
    np.testing.assert_array_equal(read_matrix(tmp_path / "K.npz").toarray(), K2)


def test_matrix_market_formats_are_read(tmp_path: Path) -> None:
    head = "%%MatrixMarket matrix"
    for text in (
        f"{head} coordinate real symmetric\n% a remark\n2 2 3\n1 1 2000\n2 2 2000\n2 1 -2e3\n",
        f"{head} coordinate integer general\n2 2 4\n1 1 2000\n2 2 2000\n2 1 -2000\n1 2 -2000\n",
        f"{head} array real general\n2 2\n2000\n-2000\n-2000\n2000\n",
    ):
        (tmp_path / "K.mtx").write_text(text)
        np.testing.assert_array_equal(read_matrix(tmp_path / "K.mtx").toarray(), K2)


def test_rounding_in_a_file_is_no_lack_of_symmetry(tmp_path: Path) -> None:
    np.save(tmp_path / "K.npy", K2 * np.array([[1.0, 1 + 1e-12], [1.0, 1.0]]))
    K = read_matrix(tmp_path / "K.npy").toarray()
    np.testing.assert_array_equal(K, K.T)
    np.save(tmp_path / "int.npy", K2.astype(np.int32))
    np.testing.assert_array_equal(read_matrix(tmp_path / "int.npy").toarray(), K2)


def write_version_7_3(path: Path, dense: bool) -> None:
    """Write K2 among other variables as MATLAB writes large files."""
    with h5py.File(path, "w") as file:
        file["rows"] = np.array([[2.0]])
        if dense:
            file["K"] = K2
            return
        K = scipy.sparse.csc_array(K2)
        group = file.create_group("K")
        group.attrs["MATLAB_sparse"] = np.uint64(2)
        group["data"], group["ir"], group["jc"] = K.data, K.indices, K.indptr


@pytest.mark.parametrize("sparse", [True, False])
@pytest.mark.parametrize("version", ["5", "7.3"])
def test_matrices_of_matlab_are_read(tmp_path: Path, version: str, sparse: bool) -> None:
    path = tmp_path / "model.mat"
    if version == "7.3":
        write_version_7_3(path, dense=not sparse)
    else:
        K = scipy.sparse.csc_array(K2) if sparse else K2
        scipy.io.savemat(path, {"K": K, "rows": 2.0})
    np.testing.assert_array_equal(read_matrix(path).toarray(), K2)
    np.testing.assert_array_equal(read_matrix(path, "K").toarray(), K2)


def test_a_study_takes_its_matrices_from_one_file_of_matlab(
    study: Callable[[str], Study], tmp_path: Path
) -> None:
    plain = study(HEAD + MATRICES)
    scipy.io.savemat(tmp_path / "model" / "all.mat", {"M": M, "K1": K1, "K2": K2, "rows": 2.0})
    text = MATRICES
    for file, name in (("K1.mtx", "K1"), ("K2.npz", "K2"), ("M.npy", "M")):
        text = text.replace(
            f'"../model/{file}"', f'{{ file = "../model/all.mat", name = "{name}" }}'
        )
    other = study(HEAD + text)
    theta = plain.problem.start
    np.testing.assert_array_equal(other.problem.evaluate(theta).J, plain.problem.evaluate(theta).J)
    scipy.io.savemat(tmp_path / "model" / "all.mat", {"M": 2 * M, "K1": K1, "K2": K2})
    assert study(HEAD + text).digest != other.digest
