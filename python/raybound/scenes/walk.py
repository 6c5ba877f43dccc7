"""A walk through the museum at the thesis's pace (section 7.2): the hall's length in 300 frames, a full turn in 150."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from ..camera import Camera
from .hall import LENGTH

STEP = LENGTH / 300  # metres a frame
TURN = 360.0 / 150 - 1e-4  # degrees a frame; a little less, for the rounding of cameras
EYE_LEVEL = 1.68
FIELD_OF_VIEW, PICTURE = 55.0, (1200, 900)


@dataclass(frozen=True)
class Pose:
    """Where one stands and looks: heading in degrees from the x axis to the left, pitch upward."""

    x: float
    y: float
    heading: float
    pitch: float = 0.0

    def frames_to(self, other: Pose) -> int:
        """How many frames it takes to get to another pose without haste."""
        way = math.hypot(other.x - self.x, other.y - self.y) / STEP
        turn = math.hypot(other.heading - self.heading, other.pitch - self.pitch) / TURN
        return max(1, math.ceil(max(way, turn) - 1e-9))

    def toward(self, other: Pose, t: float) -> Pose:
        """The pose a part t of the way to another."""
        pairs = ((self.x, other.x), (self.y, other.y), (self.heading, other.heading), (self.pitch, other.pitch))
        return Pose(*(a + t * (b - a) for a, b in pairs))

    def camera(self) -> Camera:
        """What one sees, in 1200 by 900 pixels."""
        heading, pitch = math.radians(self.heading), math.radians(self.pitch)
        ahead = (math.cos(heading) * math.cos(pitch), math.sin(heading) * math.cos(pitch), math.sin(pitch))
        eye = (self.x, self.y, EYE_LEVEL)
        target = tuple(e + 10 * a for e, a in zip(eye, ahead, strict=True))
        return Camera(eye, target, fov=FIELD_OF_VIEW, width=PICTURE[0], height=PICTURE[1])


# The tour, a closed line clear of everything that stands in the hall. It opens with 22 frames straight ahead, 12
# sideways to the left, a turn of 16 and 10 ahead, then passes the sculpture, crosses the medallion, visits the portal
# and comes back.
TOUR = (
    Pose(1.60, 4.65, 6.0, -0.5),
    Pose(3.35, 4.834, 6.0, -0.5),
    Pose(3.25, 5.788, 6.0, -0.5),
    Pose(3.25, 5.788, 44.0, -0.5),
    Pose(3.80, 6.32, 44.0, -0.5),
    Pose(7.40, 5.70, 50.0),
    Pose(11.10, 5.40, 128.0),
    Pose(12.90, 6.90, 60.0),
    Pose(14.60, 6.60, 0.0),
    Pose(20.80, 6.10, 0.0, 1.0),
    Pose(20.80, 6.10, -40.0),
    Pose(20.60, 5.30, -130.0),
    Pose(18.00, 4.90, -180.0),
    Pose(13.60, 4.60, -180.0),
    Pose(12.00, 4.40, -215.0),
    Pose(8.20, 5.30, -210.0),
    Pose(3.00, 6.30, -180.0),
    Pose(2.40, 6.00, -270.0),
    Pose(1.60, 4.65, -354.0, -0.5),
)


def walkthrough(frames: int = 60) -> list[Camera]:
    """Cameras along a walk through the museum, one a frame; a long walk goes round and round its closed tour.

    A frame moves at most 1/300 of the hall's length and turns at most 1/150 of a circle. The first camera is the
    museum's own. `frames` >= 1; ValueError otherwise.
    """
    if isinstance(frames, bool) or not isinstance(frames, int):
        raise TypeError(f"walkthrough: frames must be an int, got {frames!r}")
    if frames < 1:
        raise ValueError(f"walkthrough: frames must be >= 1, got {frames}")
    return [pose.camera() for pose in itertools.islice(itertools.cycle(poses()), frames)]


def poses() -> list[Pose]:
    """One round of the tour, frame by frame; its end leads into its beginning."""
    result = []
    for start, end in itertools.pairwise(TOUR):
        count = start.frames_to(end)
        result += [start.toward(end, k / count) for k in range(count)]
    return result
