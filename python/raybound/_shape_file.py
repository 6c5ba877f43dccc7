"""Shapes as plain JSON (scene_file.py): what reads them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from ._description import Place, arguments_of, check_keys, class_named, entries, make, pick
from ._nest import Nest
from .meshes import Mesh
from .shapes import (
    Box,
    Cone,
    Cylinder,
    Difference,
    Disk,
    Intersection,
    Polygon,
    Quadric,
    Shape,
    Sphere,
    Transformed,
    Union,
)
from .transform import Transform

SHAPES: dict[str, type[Shape]] = {
    cls.__name__: cls
    for cls in (Sphere, Box, Cylinder, Cone, Disk, Polygon, Quadric, Mesh, Union, Intersection, Difference, Transformed)
}


class Known(NamedTuple):
    """What shapes may refer to."""

    meshes: list[Mesh]
    shapes: list[Shape]


_Described = tuple[object, object]  # a description and its place


class _Opened(NamedTuple):
    """A shape of shapes whose parts are being read: how many there are, and what makes it of them."""

    parts: int
    close: Callable[[list[Shape]], Shape]


def shape_from_dict(d: object, known: Known, who: str) -> Shape:
    """The shape that `d` describes. It may nest to any depth: no recursion."""
    made: list[Shape] = []
    rest: list[_Described | _Opened] = [(d, who)]
    while rest:
        item = rest.pop()
        if isinstance(item, _Opened):
            parts = made[len(made) - item.parts :]
            made[len(made) - item.parts :] = [item.close(parts)]
            continue
        description, place = item
        if isinstance(description, Mapping) and set(description) == {"shape"}:
            made.append(pick(Place(place, ".shape"), description["shape"], known.shapes))
            continue
        cls = class_named(place, description, SHAPES)
        if issubclass(cls, Nest):
            opened, inside = _open(cls, description, place)
            rest.append(opened)
            rest.extend(reversed(inside))
        else:
            made.append(_plain_shape(cls, description, known, place))
    return made[0]


def _open(cls: type[Any], d: object, who: object) -> tuple[_Opened, list[_Described]]:
    """A shape of shapes, and the descriptions of its parts with their places."""
    arguments = arguments_of(who, d, cls, ("type",))
    if cls is Transformed:
        matrix = arguments["transform"]
        inside: list[_Described] = [(arguments["shape"], Place(who, ".shape"))]
        return _Opened(1, lambda parts: make(who, cls, parts[0], make(who, Transform, matrix))), inside
    inside = [(part, Place(who, f": shapes[{i}]")) for i, part in enumerate(entries(who, arguments, "shapes"))]
    return _Opened(len(inside), lambda parts: make(who, cls, *parts)), inside


def _plain_shape(cls: type[Shape], d: object, known: Known, who: object) -> Shape:
    """A shape that is not made of shapes."""
    if cls is Mesh:
        found = check_keys(who, d, ("type", "mesh"), ("mesh",))
        picked: Shape = pick(Place(who, ".mesh"), found["mesh"], known.meshes)
        return picked
    arguments = arguments_of(who, d, cls, ("type",))
    if cls is Quadric and "clip" in arguments:
        clip = Place(who, ".clip")
        arguments["clip"] = _plain_shape(
            class_named(clip, arguments["clip"], {"Box": Box}), arguments["clip"], known, clip
        )
    return make(who, cls, **arguments)
