"""Polygons of any outline into triangles, by the library mapbox_earcut (the extra `raybound[mesh]`)."""

from __future__ import annotations

import numpy as np

from ._validate import DoubleArray, IndexArray

# Rounding moves the sum of the triangles' areas by about n 2^-53 of it; an outline that crosses itself by whole parts.
SELF_CROSSING = 1e-6


def triangulate(vertices: DoubleArray) -> IndexArray:
    """The triangles (m, 3) of a simple polygon, as indices of its vertices (n, 3) and turning as they do.

    The polygon may be concave, and its vertices somewhat off a common plane: they are looked at along the axis that is
    closest to its normal. Raises ValueError if it has no area or crosses itself, ImportError without mapbox_earcut.
    """
    points = _flattened(vertices)
    try:
        import mapbox_earcut
    except ImportError:
        raise ImportError(
            "polygons that are not convex and planar need mapbox_earcut: pip install 'raybound[mesh]'"
        ) from None
    ends = np.array([len(points)], np.uint32)
    triangles = mapbox_earcut.triangulate_float64(points, ends).astype(np.int32).reshape(-1, 3)
    corners = points[triangles]
    twice = _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    triangles[twice < 0] = triangles[twice < 0][:, ::-1]
    whole = _twice_area(points)
    if not abs(np.abs(twice).sum() - whole) <= SELF_CROSSING * whole:
        raise ValueError("vertices must go around once, they cross themselves")
    kept: IndexArray = triangles[twice != 0]
    return kept


def _flattened(vertices: DoubleArray) -> DoubleArray:
    """The vertices (n, 2) without their coordinate along the axis closest to the normal; they turn left."""
    around = vertices - vertices.mean(axis=0)
    normal = np.cross(around, np.roll(around, -1, axis=0)).sum(axis=0)  # Newell's: its length is twice the area
    if not np.abs(normal).max() > 1e-12 * np.abs(around).max() ** 2:
        raise ValueError("vertices must enclose an area, they are collinear or cross themselves")
    axis = int(np.abs(normal).argmax())
    first, second = ((1, 2), (2, 0), (0, 1))[axis]
    kept = (first, second) if normal[axis] > 0 else (second, first)
    return np.ascontiguousarray(vertices[:, kept])


def _cross(a: DoubleArray, b: DoubleArray) -> DoubleArray:
    product: DoubleArray = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product


def _twice_area(points: DoubleArray) -> float:
    around = points - points[0]
    return float(_cross(around, np.roll(around, -1, axis=0)).sum())
