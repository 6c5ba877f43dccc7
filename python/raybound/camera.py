"""The camera: an immutable value."""

from __future__ import annotations

import numpy.typing as npt

from . import _core, _validate
from ._validate import FloatArray, Vector, packed
from ._value import Value


class Camera(Value):
    """A pinhole camera. An immutable value.

    Parameters
    ----------
    eye, target : (3,) array_like
        Where the camera is and where it looks, scene units; different points.
    up : (3,) array_like
        The direction that is up in the picture; not parallel to the view.
    fov : float
        Vertical field of view in degrees, 0.001..179.9.
    width, height : int
        Size of the picture in pixels, 1..65536. Pixel (0, 0) is top left, x grows to the right.

    Raises ValueError or TypeError naming the argument. Attributes have the same names, rounded to float32.
    """

    eye: Vector
    target: Vector
    up: Vector
    fov: float
    width: int
    height: int
    _native: _core.Camera

    def __init__(
        self,
        eye: npt.ArrayLike,
        target: npt.ArrayLike,
        *,
        up: npt.ArrayLike = (0.0, 0.0, 1.0),
        fov: float = 60.0,
        width: int = 640,
        height: int = 480,
    ) -> None:
        self._set(eye=_validate.vector("Camera", "eye", eye), target=_validate.vector("Camera", "target", target))
        self._set(up=_validate.direction("Camera", "up", up), fov=_validate.positive("Camera", "fov", fov))
        self._set(width=_validate.integer("Camera", "width", width, lowest=1, highest=65536))
        self._set(height=_validate.integer("Camera", "height", height, lowest=1, highest=65536))
        self._set(_native=self._make())

    def _make(self) -> _core.Camera:
        eye, target, up = packed(self.eye), packed(self.target), packed(self.up)
        return _core.Camera(eye, target, up, self.fov, self.width, self.height)

    def _moved(self, native: _core.Camera) -> Camera:
        """The same camera where the core's camera is."""
        return self.replace(eye=native.eye, target=native.target, up=native.up)

    def orbit(self, azimuth: float, elevation: float) -> Camera:
        """A camera moved around the target by two angles in degrees: about `up`, and towards it."""
        turn = _validate.double("Camera.orbit", "azimuth", azimuth)
        return self._moved(self._native.orbit(turn, _validate.double("Camera.orbit", "elevation", elevation)))

    def dolly(self, distance: float) -> Camera:
        """A camera moved along the view by `distance`, scene units; the target moves along."""
        return self._moved(self._native.dolly(_validate.double("Camera.dolly", "distance", distance)))

    def pan(self, right: float, up: float) -> Camera:
        """A camera moved within the picture's plane, scene units; the target moves along."""
        who = "Camera.pan"
        return self._moved(self._native.pan(_validate.double(who, "right", right), _validate.double(who, "up", up)))

    def look(self, yaw: float, pitch: float) -> Camera:
        """A camera turned in place by two angles in degrees: about `up`, and towards it."""
        who = "Camera.look"
        return self._moved(self._native.look(_validate.double(who, "yaw", yaw), _validate.double(who, "pitch", pitch)))

    def rays(self) -> tuple[FloatArray, FloatArray]:
        """The rays through the pixels' centres, exactly those that are traced.

        Returns (origins, directions), each (height, width, 3) float32; row 0 is the top. Directions need not have
        length 1.
        """
        return self._native.rays()
