"""Array types used in signatures."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Ints = NDArray[np.intp]
Ints32 = NDArray[np.int32]
Bools = NDArray[np.bool_]
Arrays = Mapping[str, Floats]  # by name
