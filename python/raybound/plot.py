"""Figures, by matplotlib (imported when the first one is made).

The figures are not registered with pyplot: a notebook shows them once, and `figure.savefig` writes them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _cell_plot, _validate
from .camera import Camera
from .enums import Path, Reason
from .frame import Frame
from .handles import LightHandle, Object
from .renderer import Renderer
from .testing import differences

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PATH_COLOURS = {
    Path.TRACED: "#d62728",
    Path.PARTIAL: "#ff9f4a",
    Path.EXACT: "#1f4e9c",
    Path.INTERPOLATED: "#5aa0dc",
    Path.REPROJECTED: "#a8d5f2",
    Path.EXTRAPOLATED: "#9467bd",
    Path.BACKGROUND: "#d9d9d9",
}


REASON_COLOURS = {
    Reason.NONE: "#e9e9e9",
    Reason.SILHOUETTE: "#1f4e9c",
    Reason.OCCLUDER: "#5aa0dc",
    Reason.SHADOW: "#3a3a3a",
    Reason.SELF_SHADOW: "#8c8c8c",
    Reason.REFLECTION: "#2c8c4a",
    Reason.REFRACTION: "#8fce9b",
    Reason.TIR: "#17becf",
    Reason.ERROR_BOUND: "#9467bd",
    Reason.COST: "#ff9f4a",
    Reason.UNSUPPORTED: "#d62728",
}


def _figure(shape: tuple[int, ...], columns: int = 1) -> Figure:
    """An empty figure for so many pictures of a shape (height, width), side by side."""
    from matplotlib import pyplot

    height, width = shape
    side = 8 if columns == 1 else 5
    figure = pyplot.figure(figsize=(side * columns, min(max(side * height / width, 2), 12)), layout="constrained")
    pyplot.close(figure)
    return figure


def path_map(frame: Frame) -> Figure:
    """How each pixel was made, one colour for each `Path`, with the share of pixels in the legend."""
    _validate.instance("plot.path_map", "frame", frame, Frame)
    return _code_map(frame.path, PATH_COLOURS)


def reason_map(frame: Frame) -> Figure:
    """Why pixels were traced, wholly or in part: one colour for each `Reason`, with its share in the legend."""
    _validate.instance("plot.reason_map", "frame", frame, Frame)
    return _code_map(frame.reason, REASON_COLOURS)


def _code_map(codes: npt.NDArray[np.uint8], colours: Mapping[Any, str]) -> Figure:
    """A picture of codes (h, w), each in its colour."""
    from matplotlib import colors, patches

    figure = _figure(codes.shape)
    axes = figure.subplots()
    axes.imshow(codes, cmap=colors.ListedColormap(list(colours.values())), vmin=-0.5, vmax=len(colours) - 0.5)
    counts = np.bincount(codes.ravel(), minlength=len(colours))
    handles = [
        patches.Patch(color=colour, label=f"{code.name.lower().replace('_', ' ')} {counts[code] / codes.size:.1%}")
        for code, colour in colours.items()
        if counts[code]
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
    axes.set_axis_off()
    return figure


def error_map(frame: Frame, reference: Frame) -> Figure:
    """The difference from the reference and the certified bound, side by side on one logarithmic scale.

    Pixels of difference or bound 0 are white, infinite bounds grey, differences outside their bound red. ValueError for
    frames of other cameras, sizes or revisions.
    """
    from matplotlib import colors

    error = differences(frame, reference, "plot.error_map")
    bound = frame.error_bound.astype(np.float64)
    positive = np.concatenate([values[(values > 0) & np.isfinite(values)] for values in (error, bound)])
    low, high = (positive.min(), positive.max()) if positive.size else (1e-6, 1.0)
    norm = colors.LogNorm(max(low, high * 1e-6), high if high > low else low * 10)
    figure = _figure(frame.path.shape, columns=2)
    axes = figure.subplots(1, 2)
    for axis, values, title in zip(axes, (error, bound), ("|image - reference|", "certified bound"), strict=True):
        axis.imshow(np.where(np.isinf(values), 0.75, 1.0), cmap="gray", vmin=0, vmax=1)
        shown = axis.imshow(np.ma.masked_where(~(values > 0) | np.isinf(values), values), cmap="viridis", norm=norm)
        axis.set_title(title)
        axis.set(xticks=[], yticks=[])
    outside = ~(error <= bound + reference.error_bound)
    axes[0].imshow(np.ma.masked_where(~outside, outside), cmap=colors.ListedColormap(["#d62728"]))
    figure.colorbar(shown, ax=axes, label="radiance", shrink=0.8)
    return figure


def cells(
    renderer: Renderer,
    object: Object,
    *,
    cam: Camera | None = None,
    frame: Frame | None = None,
    light: LightHandle | None = None,
) -> Figure:
    """The surface cells that a renderer keeps for an object, as a camera sees them, and what they know of the lights.

    Parameters
    ----------
    renderer, object
        See `Renderer.linetrees`. Only cells that are not divided further are drawn, of the outside if there are some.
    cam : Camera
        Default: that of `frame`, else the scene's.
    frame : Frame
        Lies over the cells, so that they show where the object is seen. Without it, nothing hides them but other cells.
    light : LightHandle
        The light that colours tell of; default: all. A cell is lit where nothing can be between it and the lights,
        blocked where something certainly is, "lit or blocked" for some lights the one and for others the other; else
        its colour is the length of its longest list of objects that may be in between.

    Raises ValueError if no cells are kept for the object (or its scene has no such light), or if there is no camera.
    """
    who = "plot.cells"
    _validate.instance(who, "renderer", renderer, Renderer)
    kept = _cell_plot.leaves(renderer.linetrees(object))
    if not len(kept):
        raise ValueError(f"{who}: object must be one that the renderer keeps cells for, got {object!r}")
    if frame is not None:
        cam = _validate.instance(who, "frame", frame, Frame).camera if cam is None else cam
    camera = renderer.scene.camera if cam is None else _validate.instance(who, "cam", cam, Camera)
    if camera is None:
        raise ValueError(f"{who}: cam must be given, as the scene has no camera")
    if frame is not None and frame.camera != camera:
        raise ValueError(f"{who}: frame must be one of the camera {camera!r}, got {frame.camera!r}")
    figure = _figure((camera.height, camera.width))
    _cell_plot.draw(figure, object, kept, _columns(renderer, light), camera, frame)
    return figure


def linetree(renderer: Renderer, object: Object, *, cam: Camera | None = None, frame: Frame | None = None) -> Figure:
    """The data structure that a renderer keeps for an object; today always its surface cells, see `cells`."""
    return cells(renderer, object, cam=cam, frame=frame)


def _columns(renderer: Renderer, light: LightHandle | None) -> list[int]:
    """Which lights of `Renderer.linetrees` are meant."""
    lights = list(renderer.scene.lights)
    if light is None:
        return list(range(len(lights)))
    handle = _validate.instance("plot.cells", "light", light, LightHandle, "a light of the scene")
    if handle not in lights:
        raise ValueError(f"plot.cells: light must be one of the renderer's scene, got {handle!r}")
    return [lights.index(handle)]
