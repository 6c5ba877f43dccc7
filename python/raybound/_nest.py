"""Values that are made of values, to any depth: a loop may have wrapped them a hundred thousand times.

What walks them does not recurse: walks go over `postorder`, where parts come before what they are part of, and what a
shape has several times is once.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar

from ._value import Value, construct

# How deep what is written may nest where its writers and readers recurse (pickles, JSON).
DEEPEST = 16


class Nest(Value):
    """A value of which one field, `_nested`, holds its parts: a value or a tuple of values."""

    _nested: ClassVar[str]

    def _parts(self) -> tuple[Value, ...]:
        held = getattr(self, self._nested)
        return held if isinstance(held, tuple) else (held,)

    def _pieces(self) -> list[str | Value]:
        """The expression that `repr` gives, in pieces; a value stands for its own."""
        raise NotImplementedError

    def _key(self) -> object:
        """What equality and hash look at beside the parts."""
        return self._key_of(name for name in self._fields if name != self._nested)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Value) or type(self) is not type(other):
            return NotImplemented
        compared: set[tuple[int, int]] = set()
        pairs: list[tuple[Value, Value]] = [(self, other)]
        while pairs:
            a, b = pairs.pop()
            if a is b or (id(a), id(b)) in compared:
                continue
            if not isinstance(a, Nest) or not isinstance(b, Nest):
                if a != b:
                    return False
                continue
            if type(a) is not type(b) or len(a._parts()) != len(b._parts()) or a._key() != b._key():
                return False
            compared.add((id(a), id(b)))
            pairs.extend(zip(a._parts(), b._parts(), strict=True))
        return True

    def __hash__(self) -> int:
        hashes: dict[int, int] = {}
        for value in postorder([self]):
            if isinstance(value, Nest):
                parts = tuple(hashes[id(part)] for part in value._parts())
                hashes[id(value)] = hash((type(value).__name__, value._key(), parts))
            else:
                hashes[id(value)] = hash(value)
        return hashes[id(self)]

    def __repr__(self) -> str:
        text: list[str] = []
        rest: list[str | Value] = [self]
        while rest:
            piece = rest.pop()
            if isinstance(piece, Nest):
                rest.extend(reversed(piece._pieces()))
            else:
                text.append(piece if isinstance(piece, str) else repr(piece))
        return "".join(text)

    def __reduce__(self) -> tuple[Any, ...]:
        heights = heights_of([self])
        if heights[id(self)] <= DEEPEST:
            return super().__reduce__()
        return _assemble, (_flat(self, heights),)


def postorder(roots: Iterable[Value]) -> list[Value]:
    """The values and all their parts, each once, parts before what they are part of."""
    done: dict[int, Value] = {}
    rest = list(roots)[::-1]
    while rest:
        value = rest[-1]
        before = [] if id(value) in done or not isinstance(value, Nest) else value._parts()
        missing = [part for part in before if id(part) not in done]
        if missing:
            rest.extend(reversed(missing))
        else:
            done[id(value)] = rest.pop()
    return list(done.values())


def heights_of(roots: Iterable[Value]) -> dict[int, int]:
    """How deep values nest, by `id`: 0 for those without parts."""
    heights: dict[int, int] = {}
    for value in postorder(roots):
        heights[id(value)] = _above(value, heights)
    return heights


def apart(roots: Iterable[Value]) -> list[Value]:
    """The values to write apart, parts first, so that none of what is left nests deeper than DEEPEST."""
    depths: dict[int, int] = {}
    found = []
    for value in postorder(roots):
        depths[id(value)] = _above(value, depths)
        if depths[id(value)] > DEEPEST:
            depths[id(value)] = 0
            found.append(value)
    return found


def _above(value: Value, heights: dict[int, int]) -> int:
    return 1 + max(heights[id(part)] for part in value._parts()) if isinstance(value, Nest) else 0


# A value that is too high for a pickle: its class, the fields beside the parts, and the parts' places in the list.
_Entry = Value | tuple[type[Value], dict[str, Any], tuple[int, ...]]


def _flat(root: Nest, heights: dict[int, int]) -> list[_Entry]:
    """What `_assemble` makes `root` from: its high parts one after the other, with those that are not as they are."""
    places: dict[int, int] = {}
    entries: list[_Entry] = []

    def place(value: Value, entry: _Entry) -> None:
        if id(value) not in places:
            places[id(value)] = len(entries)
            entries.append(entry)

    for value in postorder([root]):
        if not isinstance(value, Nest) or heights[id(value)] <= DEEPEST:
            continue
        for part in value._parts():
            place(part, part)
        others = {name: getattr(value, name) for name in value._fields if name != value._nested}
        place(value, (type(value), others, tuple(places[id(part)] for part in value._parts())))
    return entries


def _assemble(entries: list[_Entry]) -> Value:
    """Makes a value from its parts; what pickles call."""
    made: list[Value] = []
    for entry in entries:
        if isinstance(entry, tuple):
            cls, others, places = entry
            made.append(construct(cls, tuple(made[place] for place in places), others))
        else:
            made.append(entry)
    return made[-1]
