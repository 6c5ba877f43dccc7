"""What the numbers that carry their error have in common: records in an array, operators, indexing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from .. import _core, _validate

KINDS: dict[str, tuple[int, list[str]]] = _core.number_kinds()


class Number:
    """One number with its error, or an array of them: immutable values.

    A number is a record of floats on the last axis of `_records`; what the record holds is the core's business. `kind`
    names it there. Operators and the functions of this package work element by element and broadcast as NumPy's do.
    """

    __slots__ = ("_kind", "_records")
    __array_ufunc__: ClassVar[None] = None  # arrays leave operators to this class
    _rank: ClassVar[int] = 0  # where kinds meet, the others become one of the highest

    _kind: str
    _records: npt.NDArray[Any]

    def __init__(self, *_: object) -> None:
        raise TypeError(f"{type(self).__name__} cannot be made directly")

    @classmethod
    def _made(cls, kind: str, records: npt.NDArray[Any], template: Any = None) -> Self:
        """The object of these records; `template` is a number of the same class whose further attributes it takes."""
        made = object.__new__(cls)
        records.flags.writeable = False
        made._kind = kind
        made._records = records
        made._adopt(template)
        return made

    def _adopt(self, template: Any) -> None:
        """Takes what belongs to a number besides its record: nothing, usually."""

    def _lift(self, value: object, who: str, name: str) -> Number:
        """A plain number or array as one of this kind, without error; a Number that fits. TypeError, ValueError."""
        raise NotImplementedError  # pragma: no cover - every class has its own

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the array of numbers; () for one number."""
        return self._records.shape[:-1]

    @property
    def ndim(self) -> int:
        """The number of dimensions of `shape`."""
        return self._records.ndim - 1

    def __len__(self) -> int:
        if not self.ndim:
            raise TypeError(f"a single {type(self).__name__} has no len()")
        return len(self._records)

    def __getitem__(self, index: Any) -> Self:
        if not self.ndim:
            raise TypeError(f"a single {type(self).__name__} cannot be indexed")
        where = index if isinstance(index, tuple) else (index,)
        if not any(item is Ellipsis for item in where):
            where = (*where, Ellipsis)
        return self._made(self._kind, self._records[(*where, slice(None))].copy(), (self, where))

    def __iter__(self) -> Iterator[Self]:
        return (self[i] for i in range(len(self)))

    def __eq__(self, other: object) -> bool:
        """Whether both are of one class and shape and hold the same, number for number."""
        if type(other) is not type(self):
            return NotImplemented
        return self._kind == other._kind and np.array_equal(self._records, other._records, equal_nan=True)

    def __hash__(self) -> int:
        records = np.where(np.isnan(self._records), np.nan, self._records + 0)  # equal numbers alike: -0 as 0, one NaN
        return hash((self._kind, self.shape, records.tobytes()))

    def __setattr__(self, name: str, value: object) -> None:
        if hasattr(self, name):
            raise AttributeError(f"{type(self).__name__}: {name} is read-only")
        object.__setattr__(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self._kind, np.asarray(self._records), self._extra())

    def _extra(self) -> Any:
        """What `_adopt` takes, for pickling."""
        return None

    def __neg__(self) -> Self:
        result: Self = operate("negate", self)
        return result

    def __pos__(self) -> Self:
        return self

    def __abs__(self) -> Self:
        result: Self = operate("abs", self)
        return result

    def __add__(self, other: object) -> Any:
        return _operator("add", self, other)

    def __radd__(self, other: object) -> Any:
        return _operator("add", other, self)

    def __sub__(self, other: object) -> Any:
        return _operator("subtract", self, other)

    def __rsub__(self, other: object) -> Any:
        return _operator("subtract", other, self)

    def __mul__(self, other: object) -> Any:
        return _operator("multiply", self, other)

    def __rmul__(self, other: object) -> Any:
        return _operator("multiply", other, self)

    def __truediv__(self, other: object) -> Any:
        return _operator("divide", self, other)

    def __rtruediv__(self, other: object) -> Any:
        return _operator("divide", other, self)

    def __pow__(self, exponent: object) -> Any:
        if isinstance(exponent, (bool, float)) or not isinstance(exponent, (int, np.integer)):
            return NotImplemented
        n = _validate.integer("power", "n", exponent, lowest=-(2**20), highest=2**20)
        return operate("power", self, parameter=n)


def _restore(cls: type[Number], kind: str, records: npt.NDArray[Any], extra: Any) -> Number:
    return cls._made(kind, np.array(records), extra)


def _operator(name: str, *operands: object) -> Any:
    try:
        return operate(name, *operands)
    except _NotOursError:
        return NotImplemented


class _NotOursError(TypeError):
    """An operand that is no number of any kind: another class may know what to do."""


def apply(
    kind: str, name: str, records: Sequence[npt.NDArray[Any]], parameter: float = 0.0, width: int | None = None
) -> npt.NDArray[Any]:
    """An operation of the core on records of one kind, with broadcasting over all axes but the last.

    `width`: of the results, if they are no records of the kind.
    """
    shape = np.broadcast_shapes(*[r.shape[:-1] for r in records])
    own = KINDS[kind][0]
    whole = [np.ascontiguousarray(np.broadcast_to(r, (*shape, own))) for r in records]
    return np.asarray(_core.apply(kind, name, whole, parameter)).reshape(*shape, width or own)


def operate(name: str, *operands: object, parameter: float = 0.0) -> Any:
    """An operation on numbers of which at least one is a `Number`; the others are lifted to its kind.

    Raises TypeError for operands that do not go together.
    """
    lifted = together(name, *operands)
    widest = lifted[0]
    return widest._made(widest._kind, applied(name, lifted, parameter), widest)


def applied(name: str, lifted: Sequence[Number], parameter: float = 0.0, width: int | None = None) -> npt.NDArray[Any]:
    """`apply` to numbers of one kind; ValueError with their shapes if these do not go together."""
    try:
        return apply(lifted[0]._kind, name, [item._records for item in lifted], parameter, width)
    except ValueError as fault:
        shapes = " and ".join(str(item.shape) for item in lifted)
        raise ValueError(f"{name}: {fault} (shapes {shapes})") from None


def together(who: str, *operands: object) -> list[Number]:
    """The operands as numbers of one kind, the one that takes them all."""
    leader = max((item for item in operands if isinstance(item, Number)), key=lambda item: item._rank)
    lifted = [leader._lift(item, who, "operand") for item in operands]
    widest = max(lifted, key=lambda item: item._kind)  # "..._float64" after "..._float32"
    while any(item._kind != widest._kind for item in lifted):
        lifted = [widest._lift(item, who, "operand") for item in lifted]
        widest = max(lifted, key=lambda item: item._kind)
    return lifted


def plain(who: str, name: str, value: object, *, finite: bool = True, rounded: bool = False) -> npt.NDArray[Any]:
    """Numbers as an array, float32 if they were, else float64. TypeError; ValueError for NaN (and infinity), and for
    what float64 does not hold unless it may be `rounded`: what is made of it would not enclose it.
    """
    # A class that leaves no operator to NumPy: a Number, or a shape.
    if getattr(type(value), "__array_ufunc__", 0) is None:
        raise _NotOursError(f"{who}: {name} must be a number or an array of numbers, got a {type(value).__name__}")
    try:
        given = _validate.numeric(who, name, value, "a number or an array of numbers")
    except TypeError as fault:
        raise _NotOursError(str(fault)) from None
    with np.errstate(over="ignore", under="ignore"):
        array = np.asarray(given, np.float32 if given.dtype in (np.float16, np.float32) else np.float64)
    good = np.isfinite(array) if finite else ~np.isnan(array)
    if not good.all():
        raise ValueError(
            f"{who}: {name} must be {'finite' if finite else 'a number'}, got {_validate._culprit(array, good)}"
        )
    if not rounded:
        _check_exact(who, name, value, array)
    return array


def broadcast(who: str, **arrays: npt.NDArray[Any]) -> list[npt.NDArray[Any]]:
    """The arrays in their common shape; ValueError with their names if they have none."""
    try:
        return list(np.broadcast_arrays(*arrays.values()))
    except ValueError:
        shapes = " and ".join(str(array.shape) for array in arrays.values())
        raise ValueError(f"{who}: {' and '.join(arrays)} must broadcast, got shapes {shapes}") from None


def _check_exact(who: str, name: str, value: object, array: npt.NDArray[Any]) -> None:
    """ValueError unless `array` holds what `value` says: integers beyond 2^53 and long doubles may be rounded."""
    given = np.asarray(value)
    if given.dtype.kind == "f":
        good = array == given
    elif (np.abs(array) < 2.0**53).all():
        return
    else:  # one by one, as Python's integers
        good = np.array([int(a) == int(g) for a, g in zip(array.flat, given.flat)]).reshape(array.shape)
    if not good.all():
        raise ValueError(f"{who}: {name} must be a float64 exactly, got {_validate._culprit(given, good)}")


def narrowed(who: str, name: str, array: npt.NDArray[Any], dtype: np.dtype[Any]) -> npt.NDArray[Any]:
    """Finite numbers rounded to `dtype`. ValueError where that overflows."""
    with np.errstate(over="ignore", under="ignore"):
        result = np.asarray(array, dtype)
    good = np.isfinite(result)
    if not good.all():
        raise ValueError(
            f"{who}: {name} must fit in {dtype} (at most {np.finfo(dtype).max:.8g}), "
            f"got {_validate._culprit(array, good)}"
        )
    return result


def is_weak(value: object) -> bool:
    """Whether a plain number takes the precision of what it meets, as Python's own do in NumPy."""
    return type(value) in (int, float)
