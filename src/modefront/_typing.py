"""Array types used in signatures."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Ints = NDArray[np.intp]
Ints32 = NDArray[np.int32]
Bools = NDArray[np.bool_]
