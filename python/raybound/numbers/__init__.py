"""Numbers that carry their error, and the functions of all numbers."""

from .functions import (
    abs,
    acos,
    asin,
    atan,
    cos,
    exp,
    fma,
    log,
    maximum,
    minimum,
    power,
    reciprocal,
    rsqrt,
    sin,
    sqrt,
    square,
    tan,
    ward_lobe,
)
from .interval import Interval
from .linear_interval import LinearInterval
from .running_error import RunningError, quadratic
from .taylor_model import TaylorModel

__all__ = [
    "Interval",
    "LinearInterval",
    "RunningError",
    "TaylorModel",
    "abs",
    "acos",
    "asin",
    "atan",
    "cos",
    "exp",
    "fma",
    "log",
    "maximum",
    "minimum",
    "power",
    "quadratic",
    "reciprocal",
    "rsqrt",
    "sin",
    "sqrt",
    "square",
    "tan",
    "ward_lobe",
]
