"""What a scene knows of its objects and lights beside the core's document: names, and the values they came from."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple

from ._validate import Vector
from .camera import Camera
from .lights import Light
from .materials import Material
from .shapes import Shape
from .transform import Transform

Kind = Literal["object", "light"]


class ObjectRecord(NamedTuple):
    """An object. `stamp` tells it from one of the same id that was rolled back."""

    stamp: int
    name: str | None
    shape: Shape
    material: Material
    transform: Transform

    @property
    def label(self) -> str:
        """How explanations call it."""
        return _label(self.name, self.shape)


class LightRecord(NamedTuple):
    """A light."""

    stamp: int
    name: str | None
    light: Light

    @property
    def label(self) -> str:
        """How explanations call it."""
        return _label(self.name, self.light)


def _label(name: str | None, value: object) -> str:
    kind = type(value).__name__
    return kind if name is None else f"{name!r} ({kind})"


@dataclass
class Records:
    """All records of a scene, by id in order of creation; `made` counts those made so far, removed ones too."""

    ambient: Vector
    background: Vector
    camera: Camera | None = None
    objects: dict[int, ObjectRecord] = field(default_factory=dict)
    lights: dict[int, LightRecord] = field(default_factory=dict)
    names: dict[str, tuple[Kind, int]] = field(default_factory=dict)
    made: dict[Kind, int] = field(default_factory=lambda: {"object": 0, "light": 0})

    def copy(self) -> Records:
        """A copy with dictionaries of its own (records are immutable)."""
        return replace(
            self,
            objects=dict(self.objects),
            lights=dict(self.lights),
            names=dict(self.names),
            made=dict(self.made),
        )

    def get(self, kind: Kind, id: int) -> ObjectRecord | LightRecord | None:
        """The record of that id, if there is one."""
        return self.objects.get(id) if kind == "object" else self.lights.get(id)

    def check_name(self, who: str, name: str | None) -> None:
        """Raises ValueError if the name is taken."""
        if name is not None and name in self.names:
            raise ValueError(f"{who}: name must be unique in the scene, got {name!r}, which is taken")

    def put(self, kind: Kind, id: int, record: ObjectRecord | LightRecord) -> None:
        """Adds or replaces a record."""
        if isinstance(record, ObjectRecord):
            self.objects[id] = record
        else:
            self.lights[id] = record
        if record.name is not None:
            self.names[record.name] = (kind, id)
        self.made[kind] = max(self.made[kind], id + 1)

    def drop(self, kind: Kind, id: int) -> None:
        """Removes a record and its name."""
        record = self.objects.pop(id) if kind == "object" else self.lights.pop(id)
        if record.name is not None:
            del self.names[record.name]

    def content(self) -> tuple[object, ...]:
        """What two equal scenes have in common: everything but ids and stamps."""
        objects, lights = self.objects.values(), self.lights.values()
        return self.ambient, self.background, self.camera, [r[1:] for r in objects], [r[1:] for r in lights]
