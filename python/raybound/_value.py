"""Immutable values: the base of shapes, materials, lights, cameras and tolerances."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from typing import Any, ClassVar, NoReturn, Self

import numpy as np


class Value:
    """A value whose fields are the parameters of its constructor.

    Two values are equal if they are of one class and their fields are equal; equal values have equal hashes. `repr` is
    an expression that gives an equal value, with defaults left out. Fields are read-only; `replace` makes a changed
    copy.
    """

    _fields: ClassVar[tuple[str, ...]] = ()
    _defaults: ClassVar[Mapping[str, object]] = {}
    _is_double: ClassVar[bool] = False  # fields are float64: repr needs all digits
    __array_ufunc__: ClassVar[None] = None  # an operator with an array is a TypeError, not NumPy's attempt at it

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        if "__init__" in cls.__dict__:
            parameters = list(inspect.signature(cls.__init__).parameters.values())[1:]
            cls._fields = tuple(item.name for item in parameters)
            cls._defaults = {
                p.name: _rounded(p.default) for p in parameters if p.default is not inspect.Parameter.empty
            }

    def _set(self, **fields: object) -> None:
        """Sets fields; for constructors only."""
        for name, value in fields.items():
            object.__setattr__(self, name, value)

    def _arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """The constructor's arguments, positional and by name, that give this value again."""
        return (), {name: getattr(self, name) for name in self._fields}

    def replace(self, **changes: Any) -> Self:
        """A copy with some of the constructor's arguments changed.

        Raises TypeError for unknown names, and what the constructor raises.
        """
        positional, named = self._arguments()
        return type(self)(*positional, **{**named, **changes})

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"{type(self).__name__}: {name} is read-only; use replace() for a changed copy")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"{type(self).__name__}: {name} is read-only")

    def _key(self) -> object:
        """What equality and hash look at."""
        return self._key_of(self._fields)

    def _key_of(self, names: Iterable[str]) -> object:
        return tuple(_hashable(getattr(self, name)) for name in names)

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if not isinstance(other, Value) or type(self) is not type(other):
            return NotImplemented
        return bool(self._key() == other._key())

    def __hash__(self) -> int:
        return hash((type(self).__name__, self._key()))

    def __repr__(self) -> str:
        shown = {name: getattr(self, name) for name in self._fields}
        changed = {k: v for k, v in shown.items() if k not in self._defaults or not _same(v, self._defaults[k])}
        inside = ", ".join(f"{name}={expression(value, self._is_double)}" for name, value in changed.items())
        return f"{type(self).__name__}({inside})"

    def __reduce__(self) -> tuple[Any, ...]:
        return construct, (type(self), *self._arguments())

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self


def construct(cls: type[Value], positional: tuple[Any, ...], named: dict[str, Any]) -> Value:
    """Makes a value again; what pickles call."""
    return cls(*positional, **named)


def _rounded(default: object) -> object:
    """A default as it is kept: floats rounded to float32."""
    if isinstance(default, tuple):
        return tuple(_rounded(item) for item in default)
    return float(np.float32(default)) if isinstance(default, float) else default


def _same(a: object, b: object) -> bool:
    return _hashable(a) == _hashable(b)


def _hashable(value: object) -> object:
    """`value`, with arrays as nested tuples (so that 0.0 and -0.0 are equal and hash alike)."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    return tuple(_hashable(item) for item in value) if isinstance(value, (list, tuple)) else value


def expression(value: object, is_double: bool = False) -> str:
    """`value` as Python source: a float is written with the digits that give the same float32 (or float64)."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, float):
        return repr(value) if is_double else str(np.float32(value))
    if isinstance(value, list):
        return "[" + ", ".join(expression(item, is_double) for item in value) + "]"
    if isinstance(value, tuple):
        return "(" + ", ".join(expression(item, is_double) for item in value) + ")"
    return repr(value)
