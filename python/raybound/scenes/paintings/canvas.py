"""A small drawing kit: antialiased fills of signed distances on an sRGB canvas, curves and periodic noise.

Coordinates: the canvas is one unit high, x runs right from 0 to the aspect ratio, y runs up. Colours are
sRGB in [0, 1].
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Value = float | Array  # one number, or one for each pixel
Point = tuple[float, float]


def colour(code: str) -> Array:
    """The colour of a code such as "e8b04a"."""
    return np.array([int(code[i : i + 2], 16) / 255 for i in (0, 2, 4)])


def mix(a: Array, b: Array, weight: Value) -> Array:
    """Blend from colours a to b, for a number or a whole picture of weights."""
    w = np.asarray(weight, dtype=np.float64)[..., None]
    return np.asarray(a * (1 - w) + b * w)


def ramp(position: Value, *stops: tuple[float, str]) -> Array:
    """A gradient through the (position, colour code) stops."""
    places = [place for place, _ in stops]
    colours = np.array([colour(code) for _, code in stops])
    return np.stack([np.interp(np.asarray(position), places, colours[:, k]) for k in range(3)], axis=-1)


def smoothstep(low: float, high: float, value: Value) -> Array:
    """0 below low, 1 above high, smooth between; low may be the larger."""
    t = np.clip((np.asarray(value, dtype=np.float64) - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


class Canvas:
    """A picture that is painted in layers."""

    def __init__(self, width: int, height: int, ground: str = "ffffff") -> None:
        self.aspect = width / height
        self.pixel = 1 / height
        rows, columns = np.mgrid[0:height, 0:width]
        self.x: Array = (columns + 0.5) / height
        self.y: Array = 1 - (rows + 0.5) / height
        self.image: Array = np.ones((height, width, 3)) * colour(ground)

    def lay(self, paint: str | Array, weight: Value = 1.0) -> None:
        """Blend a colour, or a picture of colours, over everything."""
        flat = colour(paint) if isinstance(paint, str) else paint
        self.image = mix(self.image, flat, weight)

    def fill(self, distance: Array, paint: str | Array, alpha: Value = 1.0) -> None:
        """Paint where the signed distance is negative."""
        self.lay(paint, np.clip(0.5 - distance / self.pixel, 0, 1) * alpha)

    def stroke(self, distance: Array, width: float, paint: str | Array, alpha: Value = 1.0) -> None:
        """Paint a line of the given width along the zero set of the distance."""
        self.fill(np.abs(distance) - width / 2, paint, alpha)

    def circle(self, x: float, y: float, radius: float) -> Array:
        """Signed distance to a disk."""
        return np.asarray(np.hypot(self.x - x, self.y - y) - radius)

    def box(self, x: float, y: float, half: Point, degrees: float = 0.0) -> Array:
        """Signed distance to a rectangle of the given half sides, turned about its centre."""
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        u, v = self.x - x, self.y - y
        p, q = np.abs(c * u + s * v) - half[0], np.abs(c * v - s * u) - half[1]
        return np.asarray(np.hypot(np.maximum(p, 0), np.maximum(q, 0)) + np.minimum(np.maximum(p, q), 0))

    def line(self, points: Sequence[Point] | Array) -> Array:
        """Distance to a polyline."""
        best = np.full(self.x.shape, np.inf)
        for (x0, y0), (x1, y1) in itertools.pairwise(points):
            dx, dy = x1 - x0, y1 - y0
            t = np.clip(((self.x - x0) * dx + (self.y - y0) * dy) / max(dx * dx + dy * dy, 1e-12), 0, 1)
            best = np.minimum(best, np.hypot(self.x - x0 - t * dx, self.y - y0 - t * dy))
        return best

    def polygon(self, points: Sequence[Point] | Array) -> Array:
        """Signed distance to a simple polygon."""
        closed = [*points, points[0]]
        inside = np.zeros(self.x.shape, dtype=bool)
        for (x0, y0), (x1, y1) in itertools.pairwise(closed):
            if y0 != y1:
                across = x0 + (self.y - y0) * (x1 - x0) / (y1 - y0)
                inside ^= ((y0 > self.y) != (y1 > self.y)) & (self.x < across)
        edge = self.line(closed)
        return np.where(inside, -edge, edge)

    def bytes(self) -> NDArray[np.uint8]:
        """The picture as 8-bit sRGB."""
        return np.asarray(np.clip(self.image, 0, 1) * 255 + 0.5).astype(np.uint8)


def curve(points: Sequence[Point], closed: bool = False, steps: int = 12) -> Array:
    """A Catmull-Rom curve through the points, as a polyline."""
    p = np.asarray(points, dtype=np.float64)
    p = np.vstack([p[-1:], p, p[:2]]) if closed else np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    t = np.linspace(0, 1, steps, endpoint=False)[:, None]
    pieces = []
    for a, b, c, d in zip(p[:-3], p[1:-2], p[2:-1], p[3:], strict=True):
        pieces.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3))
    return np.vstack(pieces if closed else [*pieces, p[-2:-1]])


def noise(u: Array, v: Array, cells: tuple[int, int], seed: int) -> Array:
    """Smooth value noise in [0, 1], of period one in u and v, on a lattice of `cells`."""
    lattice = np.random.default_rng(seed).random((cells[1], cells[0]))
    x, y = u * cells[0], v * cells[1]
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b = smoothstep(0, 1, x - i), smoothstep(0, 1, y - j)
    i0, i1, j0, j1 = i % cells[0], (i + 1) % cells[0], j % cells[1], (j + 1) % cells[1]
    low = lattice[j0, i0] * (1 - a) + lattice[j0, i1] * a
    high = lattice[j1, i0] * (1 - a) + lattice[j1, i1] * a
    return np.asarray(low * (1 - b) + high * b)


def fractal(u: Array, v: Array, cells: tuple[int, int], seed: int, octaves: int = 4) -> Array:
    """A sum of octaves of periodic noise, scaled to about [0, 1]."""
    total = np.zeros(np.broadcast(u, v).shape)
    for k in range(octaves):
        total = total + noise(u, v, (cells[0] << k, cells[1] << k), seed + k) * 0.5**k
    return total / (2 - 0.5 ** (octaves - 1))
