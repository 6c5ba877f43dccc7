"""Argument checking, in one place.

Every function takes `who` (the object, such as "Sphere") and `name` (the argument), and returns the argument in the
form that is kept: Python floats rounded to float32, tuples of three, C-contiguous float32 arrays. Wrong types raise
`TypeError`, wrong values and shapes `ValueError`; messages name the object, the argument, the value and what was
expected. What needs geometry (is this polygon convex?) is checked by the core, in the same words.
"""

from __future__ import annotations

import operator
import os
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from . import _core

Vector = tuple[float, float, float]
Colour = float | Vector
FloatArray = npt.NDArray[np.float32]
IndexArray = npt.NDArray[np.int32]
DoubleArray = npt.NDArray[np.float64]

T = TypeVar("T")


def describe(value: object) -> str:
    """`value` as error messages show it: numbers and short vectors in full, arrays by shape and dtype."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray):
        if value.size <= 4 and value.ndim <= 1:
            return str(tuple(value.tolist()) if value.ndim else value.item())
        return f"an array of shape {value.shape} and dtype {value.dtype}"
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."


def _type_error(who: str, name: str, value: object, expected: str) -> TypeError:
    return TypeError(f"{who}: {name} must be {expected}, got {describe(value)} of type {type(value).__name__}")


def _value_error(who: str, name: str, value: object, expected: str) -> ValueError:
    return ValueError(f"{who}: {name} must be {expected}, got {describe(value)}")


def numeric(who: str, name: str, value: object, expected: str) -> npt.NDArray[Any]:
    """`value` as an array with a float or integer dtype; never bool, complex, str or object."""
    if isinstance(value, (list, tuple)) and any(isinstance(item, (bool, np.bool_)) for item in value):
        raise _type_error(who, name, value, expected)
    try:
        array = np.asarray(value)
        is_ours = array is not value and array.dtype.kind == "O"
        if is_ours and array.size and all(type(item) is int for item in array.flat):
            array = array.astype(np.float64)  # Python integers of more than 64 bits
    except OverflowError:
        raise _value_error(who, name, value, f"{expected} (at most 3.4028235e+38)") from None
    except ValueError:
        raise _value_error(who, name, value, expected) from None  # rows of different lengths
    if array.dtype.kind not in "fiu":
        raise _type_error(who, name, value, expected)
    return array


def _culprit(array: npt.NDArray[Any], good: npt.NDArray[np.bool_]) -> str:
    """The first bad element of `array`, with its index if it has one."""
    index = tuple(int(i) for i in np.argwhere(~good)[0])
    text = describe(array[index])
    return f"{text} at index {index if len(index) > 1 else index[0]}" if index else text


def _round(who: str, name: str, array: npt.NDArray[Any], *, copy: bool) -> FloatArray:
    """`array` rounded once to float32, C-contiguous; NaN, infinities and overflow are errors."""
    good = np.isfinite(array)
    if not good.all():
        raise ValueError(f"{who}: {name} must be finite, got {_culprit(array, good)}")
    with np.errstate(over="ignore", under="ignore"):
        rounded = np.array(array, np.float32, order="C") if copy else np.asarray(array, np.float32, order="C")
    good = np.isfinite(rounded)
    if not good.all():
        raise ValueError(f"{who}: {name} must fit in float32 (at most 3.4028235e+38), got {_culprit(array, good)}")
    return rounded


def double(who: str, name: str, value: object) -> float:
    """A finite number, not rounded to float32 (tolerances, angles of transforms)."""
    array = numeric(who, name, value, "a number")
    if array.ndim:
        raise _value_error(who, name, value, "a number")
    if not np.isfinite(array):
        raise _value_error(who, name, value, "finite")
    return float(array)


def number(who: str, name: str, value: object) -> float:
    """A finite number, rounded to float32."""
    array = numeric(who, name, value, "a number")
    if array.ndim:
        raise _value_error(who, name, value, "a number")
    return float(_round(who, name, array, copy=False))


def positive(who: str, name: str, value: object) -> float:
    """A number > 0, rounded to float32."""
    result = number(who, name, value)
    if result <= 0:
        raise _value_error(who, name, value, "> 0")
    return result


def array(who: str, name: str, value: object, *, shape: tuple[int | None, ...], copy: bool = True) -> FloatArray:
    """An array of that `shape` (None: any length), rounded to float32. `copy=False` may share the caller's memory."""
    letters = iter("hw" if shape.count(None) == 2 else "n")
    lengths = ", ".join(next(letters) if length is None else str(length) for length in shape)
    text = f"({lengths},)" if len(shape) == 1 else f"({lengths})"
    expected = f"an array of numbers with shape {text}" if shape else "a number"
    given = numeric(who, name, value, expected)
    matches = given.ndim == len(shape) and all(n in (None, m) for n, m in zip(shape, given.shape, strict=True))
    if not matches:
        raise ValueError(f"{who}: {name} must be {expected}, got shape {given.shape}")
    return _round(who, name, given, copy=copy)


def indices(who: str, name: str, value: object) -> IndexArray:
    """Triples of indices, (m, 3): whole numbers of any dtype that fit in int32, as a C-contiguous copy."""
    expected = "an array of whole numbers with shape (m, 3)"
    given = numeric(who, name, value, expected)
    if given.ndim != 2 or given.shape[1] != 3:
        raise ValueError(f"{who}: {name} must be {expected}, got shape {given.shape}")
    limits = np.iinfo(np.int32)
    good = (given >= limits.min) & (given <= limits.max) & (given == np.floor(given))
    if not good.all():
        raise ValueError(f"{who}: {name} must be whole numbers that fit in int32, got {_culprit(given, good)}")
    return np.array(given, np.int32, order="C")


def vector(who: str, name: str, value: object) -> Vector:
    """Three finite numbers, rounded to float32."""
    x, y, z = array(who, name, value, shape=(3,)).tolist()
    return x, y, z


def direction(who: str, name: str, value: object) -> Vector:
    """A vector that is not zero (after rounding to float32); it is not normalised."""
    result = vector(who, name, value)
    if not any(result):
        raise _value_error(who, name, value, "non-zero")
    return result


def colour(who: str, name: str, value: object) -> Colour:
    """A scalar or an RGB triple, each >= 0, rounded to float32; a scalar stays a scalar."""
    expected = "a number or three numbers (RGB)"
    given = numeric(who, name, value, expected)
    if given.shape not in ((), (3,)):
        raise ValueError(f"{who}: {name} must be {expected}, got shape {given.shape}")
    rounded = _round(who, name, given, copy=False)
    if (rounded < 0).any():
        raise _value_error(who, name, value, ">= 0")
    result = rounded.tolist()
    return (result[0], result[1], result[2]) if isinstance(result, list) else float(result)


def rgb(who: str, name: str, value: object) -> Vector:
    """A colour as an RGB triple; a scalar stands for three equal channels."""
    result = colour(who, name, value)
    return result if isinstance(result, tuple) else (result, result, result)


def vectors(who: str, name: str, value: object) -> FloatArray:
    """An array (..., 3), rounded to float32; it may share the caller's memory. An empty list holds no vectors."""
    expected = "an array of numbers with shape (..., 3)"
    if isinstance(value, (list, tuple)) and len(value) == 0:
        return np.empty((0, 3), np.float32)
    given = numeric(who, name, value, expected)
    if given.ndim == 0 or given.shape[-1] != 3:
        raise ValueError(f"{who}: {name} must be {expected}, got shape {given.shape}")
    return _round(who, name, given, copy=False)


def points(who: str, name: str, value: object) -> DoubleArray:
    """An array (..., 3) of finite numbers, not rounded to float32. An empty list holds no points."""
    expected = "an array of numbers with shape (..., 3)"
    if isinstance(value, (list, tuple)) and len(value) == 0:
        return np.empty((0, 3))
    given = numeric(who, name, value, expected).astype(np.float64)
    if given.ndim == 0 or given.shape[-1] != 3:
        raise ValueError(f"{who}: {name} must be {expected}, got shape {given.shape}")
    good = np.isfinite(given)
    if not good.all():
        raise ValueError(f"{who}: {name} must be finite, got {_culprit(given, good)}")
    return given


@dataclass(frozen=True)
class Rays:
    """Where rays begin (points, or records of hits), their directions or targets, as rows, and their shape before."""

    origins: FloatArray | npt.NDArray[np.void]
    ends: FloatArray
    shape: tuple[int, ...]


def rays(who: str, origins: object, ends: object, *, end_name: str = "directions") -> Rays:
    """Origins (..., 3) or records of hits (...) that broadcast with directions, none of them zero, or with targets."""
    first: FloatArray | npt.NDArray[np.void]
    if isinstance(origins, (np.ndarray, np.void)) and origins.dtype.names is not None:
        first = _records(who, np.asarray(origins))
    else:
        first = vectors(who, "origins", origins)
    second = vectors(who, end_name, ends)
    tail = () if first.dtype.names else (3,)
    first_shape = first.shape[: first.ndim - len(tail)]
    try:
        shape = np.broadcast_shapes(first_shape, second.shape[:-1])
    except ValueError:
        raise ValueError(
            f"{who}: origins and {end_name} must broadcast, got shapes {first.shape} and {second.shape}"
        ) from None
    if end_name == "directions":
        bad = np.argwhere(~second.any(axis=-1))
        if bad.size:
            index = tuple(int(i) for i in bad[0])
            where = f" at index {index[0] if len(index) == 1 else index}" if index else ""
            raise ValueError(f"{who}: directions must be non-zero, got (0.0, 0.0, 0.0){where}")
    return Rays(
        np.ascontiguousarray(np.broadcast_to(first, shape + tail).reshape(-1, *tail)),
        np.ascontiguousarray(np.broadcast_to(second, (*shape, 3)).reshape(-1, 3)),
        shape,
    )


def _fields(dtype: np.dtype[Any]) -> list[tuple[str, np.dtype[Any]]]:
    return [(name, dtype[name]) for name in dtype.names or ()]


def _records(who: str, value: npt.NDArray[np.void]) -> npt.NDArray[np.void]:
    """Records of hits, as `Scene.intersect` returns them."""
    ours = _core.hit_record
    if value.dtype != ours and _fields(value.dtype) == _fields(ours):
        return value.astype(ours)  # np.stack and the like drop the padding
    if value.dtype != ours:
        raise ValueError(
            f"{who}: origins must be points (..., 3) or the records of Scene.intersect, got records with the fields "
            f"{', '.join(value.dtype.names or ())}"
        )
    return value


def integer(who: str, name: str, value: object, *, lowest: int, highest: int) -> int:
    """An integer (Python's or NumPy's, not a bool) with lowest <= value <= highest."""
    if isinstance(value, (bool, np.bool_)):
        raise _type_error(who, name, value, "an integer")
    try:
        result = operator.index(value)  # type: ignore[arg-type]  # the TypeError is ours to word
    except TypeError:
        raise _type_error(who, name, value, "an integer") from None
    if not lowest <= result <= highest:
        raise _value_error(who, name, value, f"an integer in {lowest}..{highest}")
    return result


def flag(who: str, name: str, value: object) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise _type_error(who, name, value, "True or False")
    return bool(value)


def choice(who: str, name: str, value: object, choices: Collection[str]) -> str:
    """One of `choices`."""
    expected = "one of " + ", ".join(repr(item) for item in choices)
    if not isinstance(value, str):
        raise _type_error(who, name, value, expected)
    if value not in choices:
        raise _value_error(who, name, value, expected)
    return str(value)


def instance(who: str, name: str, value: object, kind: type[T], expected: str | None = None) -> T:
    """`value`, which must be an instance of `kind`."""
    if not isinstance(value, kind):
        raise _type_error(who, name, value, expected or f"a {kind.__name__}")
    return value


def label(who: str, name: str, value: object) -> str | None:
    """A name: a non-empty string, or None."""
    if value is None:
        return None
    if not isinstance(value, str):
        raise _type_error(who, name, value, "a string or None")
    if not value:
        raise _value_error(who, name, value, "a non-empty string or None")
    return str(value)


def file_path(who: str, name: str, value: object) -> str:
    """A path: str or os.PathLike of str."""
    try:
        result = os.fspath(value)  # type: ignore[call-overload]  # the TypeError is ours to word
    except TypeError:
        result = None
    if not isinstance(result, str):
        raise _type_error(who, name, value, "a path (str or pathlib.Path)")
    if not result:
        raise _value_error(who, name, value, "a path")
    return result


def packed(value: Colour) -> FloatArray:
    """A checked vector or colour as the (3,) float32 array that the core takes."""
    return np.array(value if isinstance(value, tuple) else (value,) * 3, np.float32)
