"""Checked reading of descriptions: plain JSON whose faults are told with their places.

`who` is the place of what is read, as error messages say it: a string, or a `Place`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from . import _validate
from ._value import Value

T = TypeVar("T")


class Place:
    """Where in a description something is, put into words when an error needs them: places may lie deep."""

    def __init__(self, outer: object, name: str) -> None:
        self.outer, self.name = outer, name

    def __str__(self) -> str:
        names = []
        place: object = self
        while isinstance(place, Place):
            names.append(place.name)
            place = place.outer
        return str(place) + "".join(reversed(names))


def make(who: object, maker: Callable[..., T], *positional: Any, **named: Any) -> T:
    """`maker(...)`, whose errors say where in the description they arose."""
    try:
        return maker(*positional, **named)
    except TypeError as error:
        raise TypeError(f"{who}: {error}") from None
    except ValueError as error:
        raise ValueError(f"{who}: {error}") from None


def items(who: str, d: Mapping[str, Any], key: str) -> list[tuple[str, Any]]:
    """The entries of a list, each with its place for error messages."""
    return [(f"{who}: {key}[{i}]", item) for i, item in enumerate(entries(who, d, key))]


def entries(who: object, d: Mapping[str, Any], key: str) -> list[Any]:
    items = d.get(key, [])
    if not isinstance(items, list):
        raise TypeError(f"{who}: {key} must be a list, got {_validate.describe(items)}")
    return items


def check_keys(who: object, d: object, allowed: tuple[str, ...], required: tuple[str, ...] = ()) -> dict[str, Any]:
    """`d`, which must be an object with these keys."""
    if not isinstance(d, Mapping):
        raise TypeError(f"{who} must be an object with keys {', '.join(allowed)}, got {_validate.describe(d)}")
    for key in d:
        if key not in allowed:
            raise ValueError(f"{who} has the unknown key {key!r} (expected {', '.join(allowed)})")
    for key in required:
        if key not in d:
            raise ValueError(f"{who} lacks the key {key!r}")
    return dict(d)


def arguments_of(who: object, d: object, cls: type[Value], extra: tuple[str, ...] = ()) -> dict[str, Any]:
    """The constructor's arguments for `cls` in `d`, without the keys in `extra`."""
    required = tuple(name for name in cls._fields if name not in cls._defaults)
    found = check_keys(who, d, extra + cls._fields, extra + required)
    return {key: value for key, value in found.items() if key not in extra}


def class_named(who: object, d: object, classes: dict[str, type[Any]]) -> type[Any]:
    """The class that the key "type" names."""
    kind = d.get("type") if isinstance(d, Mapping) else None
    if not isinstance(kind, str) or kind not in classes:
        raise ValueError(
            f"{who} must be an object whose type is one of {', '.join(classes)}, got {_validate.describe(d)}"
        )
    return classes[kind]


def pick(who: object, index: object, items: list[Any]) -> Any:
    """The item that an index refers to."""
    if not items:
        raise ValueError(f"{who} refers to an empty list, got {_validate.describe(index)}")
    return items[_validate.integer(str(who), "index", index, lowest=0, highest=len(items) - 1)]
