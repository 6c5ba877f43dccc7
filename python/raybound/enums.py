"""How a pixel was made, why it was traced, and what is certain: the numbers that arrays of these hold."""

from __future__ import annotations

from enum import IntEnum


class Path(IntEnum):
    """How a pixel was made: the values of `frame.path`."""

    TRACED = 0  # the whole ray tree, by searching the scene
    PARTIAL = 1  # some terms of it
    EXACT = 2  # along a certified ray tree: the same bytes
    INTERPOLATED = 3
    REPROJECTED = 4
    EXTRAPOLATED = 5  # no bound
    BACKGROUND = 6


class Reason(IntEnum):
    """Why a pixel was traced: the values of `frame.reason`."""

    NONE = 0
    SILHOUETTE = 1
    OCCLUDER = 2
    SHADOW = 3
    SELF_SHADOW = 4
    REFLECTION = 5
    REFRACTION = 6
    TIR = 7
    ERROR_BOUND = 8
    COST = 9
    UNSUPPORTED = 10


class RayKind(IntEnum):
    """What a ray is in its tree: the values of `kind` in `Renderer.paths`."""

    EYE = 0  # the ray that was asked for
    REFLECTED = 1
    REFRACTED = 2


class Verdict(IntEnum):
    """What is certain of a statement about numbers with errors. UNKNOWN is never to be read as NO."""

    NO = 0  # whatever the exact numbers are
    YES = 1  # whatever they are
    UNKNOWN = 2
