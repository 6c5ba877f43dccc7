"""Surface cells as a picture: their outlines on the surface, as a camera sees them, and what they know of lights."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .camera import Camera
from .floats import intersect
from .frame import Frame
from .handles import Object

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, LogNorm
    from matplotlib.figure import Figure

Doubles = npt.NDArray[np.float64]
COLOURS = {"lit": "#fbe9a9", "lit or blocked": "#9fc3d9", "blocked": "#56708f", "not known": "#e4e4e4"}
PER_EDGE = 4  # points of an outline
THIN = 1e-3  # a patch so flat is its own surface
NEAR = 1e-6  # of the scene's depth in front of the eye, where outlines are cut


def leaves(cells: npt.NDArray[np.void]) -> npt.NDArray[np.void]:
    """The cells that are not divided further and that rays leave to the outside, or to the inside if there are none.

    "candidates" are those of the smallest cell around each, itself included, that knows something of a light.
    """
    known = cells.copy()
    within = np.zeros((int(cells["depth"].max(initial=0)) + 1, cells["candidates"].shape[1]), np.int32)
    for row in known:  # parents come before their children
        depth, own = row["depth"], row["candidates"]
        within[depth] = np.where((own > -2) | (depth == 0), own, within[depth - 1])
        row["candidates"] = within[depth]
    leaf = cells["leaf"]
    outside = leaf & cells["outward"]
    chosen: npt.NDArray[np.void] = known[outside if outside.any() else leaf]
    return chosen


def outlines(object: Object, cells: npt.NDArray[np.void]) -> tuple[Doubles, npt.NDArray[np.bool_]]:
    """Points of the surface around each cell (n, 4 PER_EDGE, 3), and whether all were found.

    Where charts leave the surface, points are those of the patch's middle, within the object's bounds.
    """
    t = np.linspace(-1, 1, PER_EDGE, endpoint=False)
    one = np.ones(PER_EDGE)
    u, v = np.concatenate([t, one, -t, -one]), np.concatenate([-one, t, one, -t])
    middle, first, second, third = np.moveaxis(cells["patch"][:, np.newaxis], 2, 0)
    points = middle + u[:, np.newaxis] * first + v[:, np.newaxis] * second
    toward = np.where(cells["piece"] % 2 == 1, -1.0, 1.0)[:, np.newaxis, np.newaxis] * third
    rays = [np.ascontiguousarray(part).reshape(-1, 3) for part in np.broadcast_arrays(points - 1.01 * toward, toward)]
    found = intersect(object.shape.transformed(object.transform), *rays, precision="float64")
    surface = found["point"].reshape(points.shape)
    height = ((surface - points) * third).sum(axis=-1) / (third * third).sum(axis=-1)
    inside = found["hit"].reshape(height.shape) & (np.abs(height) <= 1.01)
    least, most = object.bounds
    around = np.where(inside[..., np.newaxis], surface, np.clip(points, least, most))
    thin = np.linalg.norm(third, axis=-1) < THIN * np.linalg.norm(first + second, axis=-1)
    return around, (inside | thin).all(axis=1)


def project(camera: Camera, points: Doubles) -> Doubles:
    """Column, row and depth in front of the eye of points (n, 3); pixel centres have whole coordinates."""
    eye, target, up = (np.asarray(v, np.float64) for v in (camera.eye, camera.target, camera.up))
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    x, y, depth = ((points - eye) @ axis for axis in (right, np.cross(right, ahead), ahead))
    scale = camera.height / (2 * np.tan(np.radians(camera.fov) / 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        columns, rows = camera.width / 2 + scale * x / depth, camera.height / 2 - scale * y / depth
    return np.stack([columns - 0.5, rows - 0.5, depth], axis=-1)


def in_front(outline: Doubles, camera: Camera) -> Doubles:
    """The part of an outline (n, 3) in front of the eye."""
    eye, target = np.asarray(camera.eye, np.float64), np.asarray(camera.target, np.float64)
    depth = (outline - eye) @ (target - eye) / np.linalg.norm(target - eye)
    least = NEAR * float(np.abs(depth).max())
    kept = []
    for a, b, p, q in zip(depth, np.roll(depth, -1), outline, np.roll(outline, -1, axis=0), strict=True):
        if a > least:
            kept.append(p)
        if (a > least) != (b > least):
            kept.append(p + (least - a) / (b - a) * (q - p))
    return np.array(kept).reshape(-1, 3)


def verdicts(candidates: npt.NDArray[np.int32]) -> tuple[npt.NDArray[np.str_], npt.NDArray[np.int32]]:
    """What each cell knows of some lights (n, lights): a key of `COLOURS`, and the length of its longest list."""
    lit, blocked = (candidates == 0).any(axis=1), (candidates == -1).any(axis=1)
    names = np.select([lit & blocked, lit, blocked], ["lit or blocked", "lit", "blocked"], "not known")
    return names, np.maximum(candidates.max(axis=1, initial=0), 0)


def draw(
    figure: Figure,
    object: Object,
    cells: npt.NDArray[np.void],
    lights: list[int],
    camera: Camera,
    frame: Frame | None,
) -> None:
    """Draws cells and what they know of some lights, those in front over those behind."""
    from matplotlib import collections, colors

    axes = figure.subplots()
    around, found = outlines(object, cells)
    shown = found | (cells["candidates"][:, lights] > -2).any(axis=1)
    around, cells = around[shown], cells[shown]
    names, lengths = verdicts(cells["candidates"][:, lights])
    norm = colors.LogNorm(1, max(2, int(lengths.max(initial=0))))
    distance = np.linalg.norm(around - np.asarray(camera.eye, np.float64), axis=2).max(axis=1)
    order = np.lexsort((-distance, names != "not known"))  # cells that know nothing hide none that do
    polygons = [project(camera, in_front(around[k], camera))[:, :2] for k in order]
    faces = np.array([colors.to_rgba(COLOURS[name]) for name in names]).reshape(-1, 4)
    listed = lengths > 0
    faces[listed] = _lists()(norm(lengths[listed]))
    axes.add_collection(
        collections.PolyCollection(polygons, facecolors=[*faces[order]], edgecolors="#404040", linewidths=0.4)
    )
    if frame is not None:
        axes.imshow(_veil(frame, object.id), zorder=3)
    axes.set(xlim=(-0.5, camera.width - 0.5), ylim=(camera.height - 0.5, -0.5), aspect="equal")
    axes.set_axis_off()
    _key(figure, axes, names[~listed], norm if listed.any() else None)


def _lists() -> Colormap:
    """The colours of lists: short ones light."""
    from matplotlib import colormaps, colors

    return colors.ListedColormap(colormaps["RdPu"](np.linspace(0.3, 1, 128)))


def _veil(frame: Frame, object_id: int) -> npt.NDArray[np.float64]:
    """The picture, pale where something else is seen, and almost transparent where the object is."""
    picture = np.ones((*frame.object_id.shape, 4))
    picture[..., :3] = frame.to_srgb() / 255.0
    seen = frame.object_id == object_id
    picture[~seen, :3] = 0.45 * picture[~seen, :3] + 0.55
    picture[seen, 3] = 0.25
    return picture


def _key(figure: Figure, axes: Axes, names: npt.NDArray[np.str_], norm: LogNorm | None) -> None:
    """The legend of verdicts, and the scale of lists."""
    from matplotlib import cm, patches, ticker

    handles = [patches.Patch(facecolor=c, edgecolor="#404040", label=n) for n, c in COLOURS.items() if n in names]
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
    if norm is not None:
        scale = cm.ScalarMappable(norm, _lists())
        bar = figure.colorbar(scale, ax=axes, shrink=0.8, label="objects on the list (the longest)")
        bar.ax.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        bar.ax.yaxis.set_major_formatter(ticker.FormatStrFormatter("%d"))
        bar.ax.minorticks_off()
