"""Long paths of rays, exactly: inside a mirrored sphere, and between parallel mirrors."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np


def exact(v: Any) -> list[Any]:
    return [mpmath.mpf(float(x)) for x in v]


def path_in_sphere(origin: Any, direction: Any, radius: float, bounces: int) -> list[np.ndarray]:
    """The points where a ray inside a mirrored sphere about the origin meets it.

    Errors of this recurrence grow exponentially: hence so many digits.
    """
    mpmath.mp.dps = 100
    o, d, points = exact(origin), exact(direction), []
    size = mpmath.sqrt(mpmath.fsum(x * x for x in d))
    d = [x / size for x in d]
    for _ in range(bounces):
        b = mpmath.fsum(x * y for x, y in zip(o, d))
        c = mpmath.fsum(x * x for x in o) - mpmath.mpf(radius) ** 2
        t = -b + mpmath.sqrt(b * b - (c if not points else 0))
        o = [x + t * y for x, y in zip(o, d)]
        n = [x / radius for x in o]
        k = 2 * mpmath.fsum(x * y for x, y in zip(d, n))
        d = [x - k * y for x, y in zip(d, n)]
        points.append(np.array([float(x) for x in o]))
    mpmath.mp.dps = 15
    return points


def folded(x: np.ndarray, low: float, high: float) -> np.ndarray:
    """The place between two mirrors of a point in the unfolded corridor."""
    width = high - low
    phase = (x - low) % (2 * width)
    return low + np.minimum(phase, 2 * width - phase)
