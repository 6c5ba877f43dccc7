"""Figures, by matplotlib (imported when the first one is made).

The figures are not registered with pyplot: a notebook shows them once, and `figure.savefig` writes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _validate
from .enums import Path
from .frame import Frame
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


def _figure(frame: Frame, columns: int = 1) -> Figure:
    """An empty figure for so many pictures in the shape of the frame, side by side."""
    from matplotlib import pyplot

    height, width = frame.path.shape
    side = 8 if columns == 1 else 5
    figure = pyplot.figure(figsize=(side * columns, min(max(side * height / width, 2), 12)), layout="constrained")
    pyplot.close(figure)
    return figure


def path_map(frame: Frame) -> Figure:
    """How each pixel was made, one colour for each `Path`, with the share of pixels in the legend."""
    from matplotlib import colors, patches

    _validate.instance("plot.path_map", "frame", frame, Frame)
    figure = _figure(frame)
    axes = figure.subplots()
    axes.imshow(frame.path, cmap=colors.ListedColormap(list(PATH_COLOURS.values())), vmin=-0.5, vmax=len(Path) - 0.5)
    counts = np.bincount(frame.path.ravel(), minlength=len(Path))
    handles = [
        patches.Patch(color=colour, label=f"{path.name.lower()} {counts[path] / frame.path.size:.1%}")
        for path, colour in PATH_COLOURS.items()
        if counts[path]
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
    figure = _figure(frame, columns=2)
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
