"""Maps of reasons, and pictures of surface cells."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
import pytest
from tests.python.samples import ball_scene

import raybound as rb
from raybound import _cell_plot

SCENE = ball_scene(480, 360)
RENDERER = rb.Renderer(SCENE, method="exact")
FRAME = RENDERER.render()


def labels(figure: matplotlib.figure.Figure) -> list[str]:
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def colours(figure: matplotlib.figure.Figure) -> np.ndarray:
    return np.asarray(figure.axes[0].collections[0].get_facecolor())


def test_reason_maps(tmp_path: Path) -> None:
    figure = rb.plot.reason_map(FRAME)
    shares = {reason: count / FRAME.path.size for reason, count in FRAME.stats["reasons"].items() if count}
    assert len(shares) > 1
    assert labels(figure) == [f"{name.lower().replace('_', ' ')} {share:.1%}" for name, share in shares.items()]
    figure.savefig(tmp_path / "map.png")
    assert len(rb.plot.REASON_COLOURS) == len(set(rb.plot.REASON_COLOURS.values())) == len(rb.Reason)
    with pytest.raises(TypeError, match=r"plot\.reason_map: frame must be a Frame"):
        rb.plot.reason_map(3)  # type: ignore[arg-type]


def test_every_leaf_on_the_floor_is_drawn_in_its_colour(tmp_path: Path) -> None:
    from matplotlib import colors, pyplot

    before = pyplot.get_fignums()
    figure = rb.plot.cells(RENDERER, SCENE["floor"], frame=FRAME)
    kept = _cell_plot.leaves(RENDERER.linetrees(SCENE["floor"]))
    assert kept["outward"].all()
    counts = kept["candidates"][:, 0]
    assert set(counts.tolist()) >= {-1, 0, 1}
    assert labels(figure)[:2] == ["lit", "blocked"]
    drawn = colours(figure)
    assert len(drawn) == len(kept)
    for name, count in (("lit", (counts == 0).sum()), ("blocked", (counts == -1).sum())):
        assert (drawn == colors.to_rgba(_cell_plot.COLOURS[name])).all(axis=1).sum() == count
    figure.savefig(tmp_path / "cells.png")
    assert len(rb.plot.linetree(RENDERER, SCENE["floor"]).axes) == len(figure.axes)
    assert pyplot.get_fignums() == before


def test_outlines_lie_on_the_surface() -> None:
    kept = _cell_plot.leaves(RENDERER.linetrees(SCENE["ball"]))
    around, found = _cell_plot.outlines(SCENE["ball"], kept)
    assert found.sum() > 20
    assert np.abs(np.linalg.norm(around[found] - (0, 0, 1), axis=-1) - 1).max() < 1e-5
    assert (np.abs(around - (0, 0, 1)) < 1 + 1e-6).all()
    around, found = _cell_plot.outlines(SCENE["floor"], _cell_plot.leaves(RENDERER.linetrees(SCENE["floor"])))
    assert found.all()
    assert np.abs(around[..., 2]).max() < 1e-3


def test_what_is_seen_at_a_pixel_is_projected_to_it() -> None:
    camera = rb.Camera((1, -6, 2.5), (0.3, 0, 0.8), up=(0.1, 0, 1), fov=40, width=64, height=48)
    origins, directions = (np.asarray(part, np.float64).reshape(-1, 3) for part in camera.rays())
    columns, rows, depth = _cell_plot.project(camera, origins + 3 * directions).T
    y, x = np.mgrid[:48, :64]
    assert np.abs(columns - x.ravel()).max() < 1e-3
    assert np.abs(rows - y.ravel()).max() < 1e-3
    assert (depth > 2).all()


def test_outlines_are_cut_before_the_eye() -> None:
    camera = rb.Camera((0, 0, 0), (0, 1, 0), width=40, height=30)
    square = np.array([(-1.0, -2, -1), (1, -2, -1), (1, 2, -1), (-1, 2, -1)])
    cut = _cell_plot.in_front(square, camera)
    assert len(cut) == 4
    assert sorted(cut[:, 1].round(3)) == [0, 0, 2, 2]
    assert (cut[:, 1] > 0).all()
    ahead = square + np.array([0, 9, 0])
    assert (_cell_plot.in_front(ahead, camera) == ahead).all()
    assert len(_cell_plot.in_front(-ahead, camera)) == 0


def test_leaves_know_what_is_known_around_them() -> None:
    kept = RENDERER.linetrees(SCENE["floor"])[:6].copy()
    kept["depth"], kept["leaf"], kept["outward"] = [0, 1, 2, 2, 1, 0], [0, 0, 1, 1, 1, 1], True
    kept["candidates"][:, 0] = [5, 3, -2, 1, -2, -2]
    assert _cell_plot.leaves(kept)["candidates"][:, 0].tolist() == [3, 1, 5, -2]
    kept["outward"] = False
    assert len(_cell_plot.leaves(kept)) == 4
    kept["outward"][3] = True
    assert _cell_plot.leaves(kept)["candidates"][:, 0].tolist() == [1]


def test_verdicts_of_several_lights() -> None:
    names, longest = _cell_plot.verdicts(np.array([[0, 0], [0, -1], [-1, -2], [-2, -2], [-1, 7]], np.int32))
    assert names.tolist() == ["lit", "lit or blocked", "blocked", "not known", "blocked"]
    assert longest.tolist() == [0, 0, 0, 0, 7]


def test_one_light_of_several() -> None:
    scene = ball_scene(240, 180)
    sun = scene.add_light(rb.DirectionalLight((0, 0, -1)), name="sun")
    renderer = rb.Renderer(scene, method="exact")
    renderer.render()
    one, other = (colours(rb.plot.cells(renderer, scene["floor"], light=light)) for light in (scene["lamp"], sun))
    assert len(one) == len(other)
    assert (one != other).any()


def test_bad_arguments() -> None:
    other = ball_scene()
    floor = SCENE["floor"]
    blind = SCENE.copy()
    blind.camera = None
    follower = rb.Renderer(blind, method="exact")
    follower.render(FRAME.camera)
    calls: list[tuple[type[Exception], str, Any]] = [
        (TypeError, "renderer must be a Renderer", lambda: rb.plot.cells(SCENE, floor)),  # type: ignore[arg-type]
        (ValueError, "object must be one of the renderer's scene", lambda: rb.plot.cells(RENDERER, other["floor"])),
        (ValueError, "keeps cells for", lambda: rb.plot.cells(rb.Renderer(SCENE, method="base"), floor)),
        (ValueError, "cam must be given", lambda: rb.plot.cells(follower, blind["floor"])),
        (
            ValueError,
            "frame must be one of the camera",
            lambda: rb.plot.cells(RENDERER, floor, cam=FRAME.camera.dolly(1), frame=FRAME),
        ),
        (ValueError, "light must be one of", lambda: rb.plot.cells(RENDERER, floor, light=other["lamp"])),
        (TypeError, "light must be a light", lambda: rb.plot.cells(RENDERER, floor, light=floor)),
    ]
    for error, words, call in calls:
        with pytest.raises(error, match=words):
            call()
