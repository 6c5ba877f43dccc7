"""The scene: the document that scripts edit."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _validate
from ._records import Kind, LightRecord, ObjectRecord, Records
from ._validate import DoubleArray, Vector, packed
from .camera import Camera
from .handles import LightHandle, Object
from .lights import Light, PointLight
from .materials import Material
from .shapes import Shape, Sphere
from .transform import Transform, rounded


class Scene:
    """Objects and lights, with ambient light, a background and a default camera.

    Calls are safe from any thread. Renderers read immutable snapshots: an edit takes effect at the next frame.

    Parameters
    ----------
    ambient, background : (3,) array_like or float
        Linear RGB, >= 0: the ambient term `ambient * rho_d`, and the radiance of a ray that meets nothing.

    Two scenes are equal if they have equal contents in equal order; ids and revisions do not count.
    """

    # So that assigning to a misspelt name is an error.
    __slots__ = ("__weakref__", "_committed", "_document", "_lock", "_next_stamp", "_records")

    def __init__(self, ambient: npt.ArrayLike = (0.0, 0.0, 0.0), background: npt.ArrayLike = (0.0, 0.0, 0.0)) -> None:
        records = Records(_validate.rgb("Scene", "ambient", ambient), _validate.rgb("Scene", "background", background))
        self._begin(_core.Document(packed(records.ambient), packed(records.background)), records)

    def _begin(self, document: _core.Document, records: Records, next_stamp: int = 0) -> None:
        self._lock = threading.RLock()
        self._document = document
        self._records = records
        self._committed = records  # what renderers see: differs from `_records` inside an `edit` block only
        self._next_stamp = next_stamp  # never goes back, not even by a rollback

    # Adding

    def add(
        self, shape: Shape, material: Material, *, name: str | None = None, transform: Transform | None = None
    ) -> Object:
        """Adds an object and returns its handle.

        `name` must be unique among objects and lights (ValueError). `transform` goes from the shape's coordinates to
        the scene's and is rounded to float32.

        Solids may touch. Where a ray leaves one solid and enters another at the same t, it crosses both: the entered
        surface is seen, with the index of refraction relative to the solid that is left, whichever was added first.
        Where it enters two at the same t, or meets open surfaces there (a picture on a wall), the one with the lowest
        id is seen. Solids that overlap have no order: see `Material`.
        """
        shape = _validate.instance("Scene.add", "shape", shape, Shape, "a Shape")
        material = _validate.instance("Scene.add", "material", material, Material)
        name, by = _validate.label("Scene.add", "name", name), rounded("Scene.add", "transform", transform)
        with self._lock:
            self._records.check_name("Scene.add", name)
            id = self._document.add_object(shape._native, material._native, np.array(by.matrix))
            record = ObjectRecord(self._stamp(), name, shape, material, by)
            self._records.put("object", id, record)
            return Object(self, id, record.stamp)

    def add_light(self, light: Light, name: str | None = None) -> LightHandle:
        """Adds a light and returns its handle; `name` as for `add`."""
        light = _validate.instance("Scene.add_light", "light", light, Light)
        name = _validate.label("Scene.add_light", "name", name)
        with self._lock:
            self._records.check_name("Scene.add_light", name)
            id = self._document.add_light(light._native)
            record = LightRecord(self._stamp(), name, light)
            self._records.put("light", id, record)
            return LightHandle(self, id, record.stamp)

    def _stamp(self) -> int:
        self._next_stamp += 1
        return self._next_stamp - 1

    # Editing (handles call these, with the lock held)

    def _set_object(self, id: int, record: ObjectRecord) -> None:
        self._document.set_object(id, record.shape._native, record.material._native, np.array(record.transform.matrix))
        self._records.put("object", id, record)

    def _set_light(self, id: int, record: LightRecord) -> None:
        self._document.set_light(id, record.light._native)
        self._records.put("light", id, record)

    def _remove(self, kind: Kind, id: int) -> None:
        if kind == "object":
            self._document.remove_object(id)
        else:
            self._document.remove_light(id)
        self._records.drop(kind, id)

    @contextmanager
    def edit(self) -> Iterator[Scene]:
        """`with scene.edit(): ...` makes several edits one revision; if an exception leaves the block, none is made.

        Until the block ends, renderers and `intersect` see the scene as it was before, and other threads' edits wait.
        After a rollback, handles made in the block are removed ones. A block inside a block joins the outer one.
        """
        with self._lock:
            if self._editing:
                yield self
                return
            self._document.begin_edit()
            try:
                self._records = self._committed.copy()
                yield self
                self._document.commit_edit()
                self._committed = self._records
            except BaseException:
                self._document.rollback_edit()
                self._records = self._committed
                raise

    @property
    def _editing(self) -> bool:
        return self._records is not self._committed

    # Reading

    @property
    def ambient(self) -> Vector:
        """Ambient light, linear RGB. Assigning is an edit."""
        with self._lock:
            return self._records.ambient

    @ambient.setter
    def ambient(self, value: npt.ArrayLike) -> None:
        checked = _validate.rgb("Scene", "ambient", value)
        with self._lock:
            self._document.set_ambient(packed(checked))
            self._records.ambient = checked

    @property
    def background(self) -> Vector:
        """The radiance of a ray that meets nothing, linear RGB. Assigning is an edit."""
        with self._lock:
            return self._records.background

    @background.setter
    def background(self, value: npt.ArrayLike) -> None:
        checked = _validate.rgb("Scene", "background", value)
        with self._lock:
            self._document.set_background(packed(checked))
            self._records.background = checked

    @property
    def camera(self) -> Camera | None:
        """The default view, saved with the scene. Assigning it (or None) makes no new revision."""
        with self._lock:
            return self._records.camera

    @camera.setter
    def camera(self, value: Camera | None) -> None:
        if value is not None:
            _validate.instance("Scene", "camera", value, Camera, "a Camera or None")
        with self._lock:
            self._records.camera = value

    @property
    def objects(self) -> tuple[Object, ...]:
        """Handles of all objects, in order of creation."""
        with self._lock:
            return tuple(Object(self, id, record.stamp) for id, record in self._records.objects.items())

    @property
    def lights(self) -> tuple[LightHandle, ...]:
        """Handles of all lights, in order of creation."""
        with self._lock:
            return tuple(LightHandle(self, id, record.stamp) for id, record in self._records.lights.items())

    @property
    def revision(self) -> int:
        """Counts edits: one more for each, or for each `edit` block that changed something."""
        return self._document.revision

    @property
    def bounds(self) -> DoubleArray:
        """The box around all objects: (2, 3) float64, scene units. ValueError if there are none."""
        with self._lock:
            bounds = self._document.bounds()
        if bounds is None:
            raise ValueError("Scene: bounds of an empty scene are undefined")
        return bounds

    def __len__(self) -> int:
        with self._lock:
            return len(self._records.objects)

    def __iter__(self) -> Iterator[Object]:
        return iter(self.objects)

    def __contains__(self, item: object) -> bool:
        if isinstance(item, (Object, LightHandle)):
            return item._scene is self and item._find() is not None
        return isinstance(item, str) and item in self._records.names

    def __getitem__(self, name: str) -> Any:
        """The handle of that name, an `Object` or a `LightHandle`; KeyError if there is none."""
        if not isinstance(name, str):
            raise TypeError(f"Scene: a key must be the name of an object or light, got {_validate.describe(name)}")
        with self._lock:
            if name not in self._records.names:
                raise KeyError(f"Scene: no object or light is named {name!r}")
            kind, id = self._records.names[name]
            if kind == "object":
                return Object(self, id, self._records.objects[id].stamp)
            return LightHandle(self, id, self._records.lights[id].stamp)

    # Queries

    def intersect(self, origins: npt.ArrayLike, directions: npt.ArrayLike) -> npt.NDArray[np.void]:
        """The closest hits of rays.

        Parameters
        ----------
        origins : (..., 3) array_like, or (...) records of hits
            Scene units. From records, rays leave the hits' surfaces on the side that they go to: such a ray never meets
            the surface that it leaves, and one that goes inward is inside of the solid until it leaves it. A record of
            a miss starts no ray, and so is answered by a miss.
        directions : (..., 3) array_like
            Of length 2**-64 or more. Both broadcast: `scene.intersect(*camera.rays())` is a picture of records.

        Returns a structured array (...) with the fields
            hit (bool); t, t_error (float32, in lengths of the direction, from the ray's own origin); point,
            point_error, normal (3 float32; the outward unit normal); uv (2 float32); object_id, face_id (int32);
            entering (bool; the ray comes from outside of a solid, or from the side of a sheet's normal); within_id
            (int32; the closed solid that the ray was inside of on its way, -1 if in none or in several at once);
            touching (bool; it leaves that solid where it enters this one); direction (3 float32; the ray's, scaled by a
            power of two); seal (uint32; of the other fields, so that changed records are noticed).
        A miss has t = inf, ids -1, and 0 elsewhere. Sees the scene as a renderer does.

        `t_error` bounds how far `t` is from where the ray exactly meets the surface. `point_error` bounds how far
        `point` is from the surface: the box point +- point_error holds a point of it. That need not be the very point
        where the ray meets it, which may be as far off as t_error, times the direction, reaches: far for a ray that
        comes from far away or grazes. Where t is beyond float32, which only origins beyond 2**60 can make it, it is the
        largest float and t_error is infinite.

        ValueError for shapes that do not broadcast, directions that are too short, and records that were changed or
        that are not hits of this scene as it is now.
        """
        rays = _validate.rays("Scene.intersect", origins, directions)
        return self._document.snapshot().intersect(rays.origins, rays.ends).reshape(rays.shape)

    def intersect_all(
        self, origins: npt.ArrayLike, directions: npt.ArrayLike
    ) -> tuple[npt.NDArray[np.void], npt.NDArray[np.int64]]:
        """Every crossing along each ray, in order: `records, offsets = scene.intersect_all(origins, directions)`.

        Arguments are those of `intersect`. The n rays count in C order of their shape. The crossings of ray i are
        `records[offsets[i]:offsets[i + 1]]`, records as `intersect` returns them, with every t along the ray as given;
        offsets is (n + 1,) int64. Each closed solid is entered and left in turn. Where solids touch, the one is left
        before the other is entered.
        """
        rays = _validate.rays("Scene.intersect_all", origins, directions)
        return self._document.snapshot().intersect_all(rays.origins, rays.ends)

    def occluded(self, origins: npt.ArrayLike, targets: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether an object lies between each origin and its target. Returns a (...) bool array.

        `targets` is (..., 3), scene units; `origins` is the same or (...) records of hits, and both broadcast. Points
        are taken as they are: one that was computed on a surface may lie on either side of it. From records, rays leave
        the surface toward the target, so `scene.occluded(hits, lamp)` is right for every hit; a miss sees everything.
        ValueError as for `intersect`.
        """
        segments = _validate.rays("Scene.occluded", origins, targets, end_name="targets")
        return self._document.snapshot().occluded(segments.origins, segments.ends).reshape(segments.shape)

    def containing(self, points: npt.ArrayLike) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int64]]:
        """The closed solids around each point: `object_ids, offsets = scene.containing(points)`.

        `points` is (..., 3), scene units, rounded to float32; its n points count in C order. The ids of the objects
        that hold point i, in order, are `object_ids[offsets[i]:offsets[i + 1]]`; offsets is (n + 1,) int64. Open
        surfaces (disks, polygons, meshes with a border) hold nothing. Along any ray from a point, the solids around it
        are those that are left once more often than they are entered.
        """
        checked = _validate.vectors("Scene.containing", "points", points)
        return self._document.snapshot().containing(np.ascontiguousarray(checked.reshape(-1, 3)))

    # Copies, files, comparison

    def copy(self) -> Scene:
        """An independent scene with the same contents and ids, and outside of `edit` blocks the same revision.

        Handles of this scene do not refer to the copy.
        """
        with self._lock:
            if self._editing:  # the core's document shows the state before the block until it ends
                return _restore_scene(self._records.copy(), self._next_stamp)
            result = object.__new__(Scene)
            result._begin(self._document.copy(), self._records.copy(), self._next_stamp)
            return result

    def to_dict(self) -> dict[str, Any]:
        """A plain-JSON description, with the camera; paths of textures are absolute."""
        from . import scene_file

        return scene_file.to_dict(self)

    @staticmethod
    def from_dict(d: Mapping[str, Any]) -> Scene:
        """The scene that `to_dict` described. Unknown or missing keys raise ValueError naming them."""
        from . import scene_file

        return scene_file.from_dict(d)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene and its camera as a .json file; textures from files are kept by path."""
        from . import scene_file

        scene_file.save_scene(self, path)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return self is other or self._content() == other._content()

    def _content(self) -> tuple[object, ...]:
        with self._lock:
            return self._records.content()

    def __copy__(self) -> Scene:
        return self.copy()

    def __deepcopy__(self, memo: object) -> Scene:
        return self.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        with self._lock:
            return _restore_scene, (self._records.copy(), self._next_stamp)

    def __repr__(self) -> str:
        with self._lock:
            objects, lights = len(self._records.objects), len(self._records.lights)
        return f"<Scene: {objects} objects, {lights} lights, revision {self.revision}>"


def _restore_scene(records: Records, next_stamp: int) -> Scene:
    """A scene with these records under their ids: gaps are filled with objects and lights that are removed again."""
    document = _core.Document(packed(records.ambient), packed(records.background))
    document.begin_edit()
    for id in range(records.made["object"]):
        record = records.objects.get(id)
        if record is None:
            document.remove_object(document.add_object(Sphere()._native, Material()._native, np.eye(4)))
        else:
            document.add_object(record.shape._native, record.material._native, np.array(record.transform.matrix))
    for id in range(records.made["light"]):
        lamp = records.lights.get(id)
        if lamp is None:
            document.remove_light(document.add_light(PointLight((0, 0, 0))._native))
        else:
            document.add_light(lamp.light._native)
    document.commit_edit()
    result = object.__new__(Scene)
    result._begin(document, records, next_stamp)
    return result
