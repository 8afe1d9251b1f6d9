"""A study of a chain and of matrices in which nothing is wrong, to be spoilt by tests."""

from __future__ import annotations

import numpy as np

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
programme = "bounds"
points = 5
population = 20
evaluations = 2000

[pairing]
method = "mac"
window = 3.0
spare = 0

[search]
evaluations = 5000
tolerance = 0.01
doubt = 0.4

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

GROUPS = STUDY[STUDY.index("[[group]]") : STUDY.index("[[weighted]]")]
WEIGHTED = STUDY[STUDY.index("[[weighted]]") : STUDY.index("[pareto]")]
PARAMETERS = STUDY[STUDY.index("[[parameter]]") : STUDY.index("[[group]]")]
PREDICTIONS = STUDY[STUDY.index("[[predict.frf]]") :]
