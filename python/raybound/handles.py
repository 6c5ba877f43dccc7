"""Handles: what scripts hold of the objects and lights in a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from . import _validate
from ._records import Kind, LightRecord, ObjectRecord
from ._validate import DoubleArray
from .lights import Light
from .materials import Material
from .shapes import Shape
from .transform import Transform, rounded

if TYPE_CHECKING:
    from .scene import Scene


class Handle:
    """The base of handles. Made by `scene.add` and `scene.add_light`; raises ReferenceError once it is removed.

    Two handles are equal if they mean the same id in the same scene (or in equal scenes). Pickling one pickles its
    scene.
    """

    _kind: ClassVar[Kind]
    __slots__ = ("_id", "_scene", "_stamp")

    def __init__(self, scene: Scene, id: int, stamp: int) -> None:
        self._scene, self._id, self._stamp = scene, id, stamp

    def _find(self) -> ObjectRecord | LightRecord | None:
        record = self._scene._records.get(self._kind, self._id)
        return record if record is not None and record.stamp == self._stamp else None

    def _removed(self) -> ReferenceError:
        return ReferenceError(f"{type(self).__name__} {self._id} was removed from its scene")

    @property
    def id(self) -> int:
        """The number that `frame.object_id` and structured arrays show; never reused in a scene."""
        self._name_or_none()
        return self._id

    @property
    def name(self) -> str | None:
        """The unique name given to it, or None."""
        return self._name_or_none()

    def _name_or_none(self) -> str | None:
        with self._scene._lock:
            record = self._find()
        if record is None:
            raise self._removed()
        return record.name

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Handle):
            return NotImplemented
        alike = (self._kind, self._id, self._stamp) == (other._kind, other._id, other._stamp)
        return alike and (self._scene is other._scene or self._scene == other._scene)

    def __hash__(self) -> int:
        return hash((self._kind, self._id, self._stamp))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._scene, self._id, self._stamp)

    def __repr__(self) -> str:
        with self._scene._lock:
            record = self._find()
        if record is None:
            return f"<removed {type(self).__name__} {self._id}>"
        value = record.shape if isinstance(record, ObjectRecord) else record.light
        named = "" if record.name is None else f" {record.name!r}"
        return f"<{type(self).__name__} {self._id}{named}: {type(value).__name__}>"


class Object(Handle):
    """A handle of an object: a shape with a material, under a transform.

    Assigning `shape`, `material` or `transform` is an edit; wrong types raise TypeError and change nothing.
    """

    _kind = "object"
    __slots__ = ()

    def _record(self) -> ObjectRecord:
        with self._scene._lock:
            record = self._find()
        if not isinstance(record, ObjectRecord):
            raise self._removed()
        return record

    def _change(self, **changes: Any) -> None:
        with self._scene._lock:
            self._scene._set_object(self._id, self._record()._replace(**changes))

    @property
    def shape(self) -> Shape:
        """The shape, before the transform."""
        return self._record().shape

    @shape.setter
    def shape(self, value: Shape) -> None:
        self._change(shape=_validate.instance("Object", "shape", value, Shape, "a Shape"))

    @property
    def material(self) -> Material:
        """The material."""
        return self._record().material

    @material.setter
    def material(self, value: Material) -> None:
        self._change(material=_validate.instance("Object", "material", value, Material))

    @property
    def transform(self) -> Transform:
        """The transform from the shape's coordinates to the scene's, rounded to float32. Assigning None resets it."""
        return self._record().transform

    @transform.setter
    def transform(self, value: Transform | None) -> None:
        self._change(transform=rounded("Object", "transform", value))

    @property
    def bounds(self) -> DoubleArray:
        """The box around the object: (2, 3) float64, scene units, to within double rounding."""
        with self._scene._lock:
            self._record()
            return self._scene._document.object_bounds(self._id)

    def move(self, t: Transform) -> None:
        """Moves the object: `transform = t @ transform`."""
        by = _validate.instance("Object.move", "t", t, Transform)
        with self._scene._lock:
            self._change(transform=(by @ self._record().transform)._rounded())

    def remove(self) -> None:
        """Takes the object out of the scene; using its handles afterwards raises ReferenceError."""
        with self._scene._lock:
            self._record()
            self._scene._remove("object", self._id)


class LightHandle(Handle):
    """A handle of a light. Assigning `light` is an edit of the scene."""

    _kind = "light"
    __slots__ = ()

    def _record(self) -> LightRecord:
        with self._scene._lock:
            record = self._find()
        if not isinstance(record, LightRecord):
            raise self._removed()
        return record

    @property
    def light(self) -> Light:
        """The light."""
        return self._record().light

    @light.setter
    def light(self, value: Light) -> None:
        checked = _validate.instance("LightHandle", "light", value, Light)
        with self._scene._lock:
            self._scene._set_light(self._id, self._record()._replace(light=checked))

    def remove(self) -> None:
        """Takes the light out of the scene; using its handles afterwards raises ReferenceError."""
        with self._scene._lock:
            self._record()
            self._scene._remove("light", self._id)
