"""Testing with bounds."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np

from . import _validate, images
from ._validate import DoubleArray
from .enums import Path as Kind
from .frame import Frame


def differences(frame: Frame, reference: Frame, who: str) -> DoubleArray:
    """The largest difference over channels at each pixel, (h, w) float64, NaN where a radiance is NaN.

    ValueError if the frames show other cameras, sizes or revisions.
    """
    _validate.instance(who, "frame", frame, Frame)
    _validate.instance(who, "reference", reference, Frame)
    if frame.image.shape != reference.image.shape:
        raise ValueError(f"{who}: frames must have one size, got {frame.image.shape} and {reference.image.shape}")
    if frame.camera != reference.camera:
        raise ValueError(f"{who}: frames must have one camera, got {frame.camera!r} and {reference.camera!r}")
    if frame.revision != reference.revision:
        raise ValueError(f"{who}: frames must show one revision, got {frame.revision} and {reference.revision}")
    a, b = frame.image.astype(np.float64), reference.image.astype(np.float64)
    with np.errstate(invalid="ignore"):
        error: DoubleArray = np.where(a == b, 0.0, np.abs(a - b)).max(axis=2)
    return error


def assert_within_bound(frame: Frame, reference: Frame, *, directory: str | os.PathLike[str] | None = None) -> None:
    """Asserts that every pixel of `frame` lies within its certified bound of `reference`, the base image.

    If the reference itself has bounds, they are added. A failure raises AssertionError that names the worst pixel, and
    saves frame.png, reference.png and error.png (white: the largest error; red: outside the bound) in `directory`,
    which is made if needed; default: a fresh temporary one, named in the message.

    ValueError for frames of other cameras, sizes or revisions.
    """
    error = differences(frame, reference, "assert_within_bound")
    bound = frame.error_bound.astype(np.float64) + reference.error_bound
    outside = ~(error <= bound)  # so that NaN is outside
    if not outside.any():
        return
    with np.errstate(invalid="ignore"):
        excess = np.where(outside, np.where(np.isnan(error), np.inf, error - bound), -np.inf)
    y, x = (int(i) for i in np.unravel_index(np.argmax(excess), excess.shape))
    folder = _save(frame, reference, error, outside, directory)
    raise AssertionError(
        f"assert_within_bound: {int(outside.sum())} of {outside.size} pixels lie outside their bounds; "
        f"worst at (x, y) = ({x}, {y}): error {error[y, x]:.9g}, bound {bound[y, x]:.9g}, "
        f"path {Kind(int(frame.path[y, x])).name}; pictures in {folder}"
    )


def _save(
    frame: Frame,
    reference: Frame,
    error: DoubleArray,
    outside: np.ndarray[tuple[int, ...], np.dtype[np.bool_]],
    directory: str | os.PathLike[str] | None,
) -> Path:
    """Saves both pictures and a map of the error; returns the folder."""
    if directory is None:
        folder = Path(tempfile.mkdtemp(prefix="raybound-"))
    else:
        folder = Path(_validate.file_path("assert_within_bound", "directory", directory))
        folder.mkdir(parents=True, exist_ok=True)
    finite = np.where(np.isfinite(error), error, 0.0)
    grey = (finite / (finite.max() or 1.0)).astype(np.float32)
    picture = np.repeat(grey[:, :, None], 3, axis=2)
    picture[outside] = (1.0, 0.0, 0.0)
    for name, pixels in (("frame", frame.image), ("reference", reference.image), ("error", picture)):
        images.write_srgb(str(folder / f"{name}.png"), pixels, "assert_within_bound")
    return folder
