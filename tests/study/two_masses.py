"""A study of two masses on springs with predictions, and its response in closed matrices."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.linalg
import xarray as xr
from numpy.typing import NDArray
from texts import two_of_each

import modefront as mf
from modefront._typing import Floats

Complex = NDArray[np.complex128]

MASSES = np.array([2.0, 1.0])
STIFFNESS = np.array([3000.0, 2000.0])
ZETA = np.array([0.02, 0.03])

STUDY = (
    """
[study]
name = "two masses"
seed = 3

[data]
file = "modes.csv"

[model]
kind = "chain"
masses = [2.0, 1.0]
stiffnesses = [3000.0, 2000.0]
stiffness_parameters = ["k1", "k2"]
sensors = { low = 0, high = 1 }
outputs = { middle = [[0, 0.5], [1, 0.5]] }

"""
    + two_of_each()
    + """
[pareto]
points = 3

[pairing]
method = "order"

[search]
doubt = 0.5

[noise]
weight = 0
"""
)

FRF = """
[[predict.frf]]
name = "pushed"
force = { high = 2.0 }
response = { low = "low", drift = { high = 1, low = -1 } }
band = [0.0, 20.0]
damping = [0.02, 0.03]
quantity = "mobility"

[[predict.frf]]
name = "shaken"
base = "x"
response = ["low", "middle"]
quantity = "accelerance"

[[predict.frf]]
name = "as if shaken"
force = { low = -2.0, high = -1.0 }
response = ["low", "middle"]
quantity = "accelerance"

[[predict.frf]]
name = "ridden"
base = "x"
response = ["high"]
damping = 0.02
quantity = "absolute accelerance"

[[predict.frf]]
name = "overdamped"
force = "low"
response = ["low"]
band = [0.1, 20.0]
modes = 2
damping = 0.8
"""

PASSAGE = """
[[predict.first_passage]]
name = "drifts"
base = "x"
response = { lower = "low", upper = { high = 1, low = -1 } }
density = 0.05
sided = "one"
filter = { frequency = 4.0, damping = 0.6 }
modulation = [[0.0, 0.0], [2.0, 1.0], [4.0, 0.5]]
levels = [0.02, 0.025]
duration = 6.0
step = 0.01
samples = 1500
damping = 0.02
"""

QUICK = PASSAGE.replace("samples = 1500", "samples = 20")

DATA = """set,mode,frequency,damping,low,high
a,1,4.2,0.02,0.6,1.0
a,2,10.5,,1.0,-0.7
b,1,4.1,0.04,,1.0
"""


def write_study(folder: Path, predictions: str) -> Path:
    (folder / "modes.csv").write_text(DATA)
    (folder / "study.toml").write_text(STUDY + predictions)
    return folder / "study.toml"


def run(folder: Path, predictions: str) -> xr.Dataset:
    return mf.run(mf.load(write_study(folder, predictions)), folder / "results").dataset


def matrices(theta: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return K, M, the circular frequencies and the modes of the chain."""
    k1, k2 = STIFFNESS * theta
    K = np.array([[k1 + k2, -k2], [-k2, k2]])
    M = np.diag(MASSES)
    lam, phi = scipy.linalg.eigh(K, M)
    return K, M, np.sqrt(lam), phi


def direct(theta: Floats, zeta: Floats, load: Floats, output: Floats, f: Floats) -> Complex:
    """Return output (K - w^2 M + i w C)^-1 load at frequencies in Hz."""
    K, M, omega, phi = matrices(theta)
    C = M @ phi @ np.diag(2 * zeta * omega) @ phi.T @ M
    w = 2 * np.pi * f[:, None, None]
    u = np.linalg.solve(K - w**2 * M + 1j * w * C, np.broadcast_to(load[:, None], (f.size, 2, 1)))
    return np.asarray(output @ u, dtype=np.complex128)[:, 0]
