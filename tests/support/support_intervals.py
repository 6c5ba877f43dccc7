"""Operations on intervals given as arrays of shape (2, n), infs before sups."""

import numpy as np
from numpy.typing import NDArray

from raybound import _core

Rows = NDArray[np.float64]

KINDS = {
    "double": "interval_float64",
    "float": "interval_float32",
    "double float32": "interval_float64_executed",
    "float float32": "interval_float32_executed",
    "double portable": "interval_float64_portable",
    "float portable": "interval_float32_portable",
}


def interval_operation(name: str, operands: Rows, kind: str, parameter: float = 0) -> Rows:
    """`operands` (k, 2, n) gives ends (2, n)."""
    rows = [np.ascontiguousarray(ends.T) for ends in operands]
    return np.ascontiguousarray(np.asarray(_core.apply(KINDS[kind], name, rows, parameter), np.float64).T)
