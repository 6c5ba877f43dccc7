"""Frames: arrays, statistics, explanations, pictures in notebooks, pickling, equality."""

from __future__ import annotations

import json
import pickle
from typing import Any

import numpy as np
import pytest
from tests.python.samples import ball_scene

import raybound as rb

KINDS: dict[str, tuple[Any, tuple[int, ...]]] = {
    "image": (np.float32, (32, 48, 3)),
    "error_bound": (np.float32, (32, 48)),
    "path": (np.uint8, (32, 48)),
    "reason": (np.uint8, (32, 48)),
    "object_id": (np.int32, (32, 48)),
    "depth": (np.float32, (32, 48)),
}
FRAME = rb.render(ball_scene(), method="base")


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("frame", [FRAME, pickle.loads(pickle.dumps(FRAME))], ids=["rendered", "unpickled"])
def test_arrays(frame: rb.Frame, name: str) -> None:
    array = getattr(frame, name)
    kind, shape = KINDS[name]
    assert (array.dtype, array.shape) == (kind, shape)
    assert array.flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        array[0, 0] = 1
    with pytest.raises(ValueError, match="WRITEABLE"):
        array.flags.writeable = True
    with pytest.raises(AttributeError, match=f"Frame: {name} is read-only"):
        setattr(frame, name, array)
    assert getattr(frame, name) is array  # no copies


def test_refined_frames_are_read_only_too() -> None:
    for frame in rb.Renderer(ball_scene()).refine():
        with pytest.raises(ValueError, match="WRITEABLE"):
            frame.image.flags.writeable = True


def test_what_the_pixels_say() -> None:
    scene = ball_scene()
    assert set(np.unique(FRAME.object_id)) == {-1, scene["floor"].id, scene["ball"].id}
    sky = FRAME.object_id == -1
    assert (np.isinf(FRAME.depth) == sky).all()
    assert ((FRAME.path == rb.Path.BACKGROUND) == sky).all()
    assert (FRAME.path[~sky] == rb.Path.TRACED).all()
    assert (FRAME.image[sky] == np.float32((0.2, 0.3, 0.5))).all()
    assert not FRAME.error_bound.any()
    assert not FRAME.reason.any()
    assert FRAME.object_id[0, 0] == -1  # row 0 is the top
    assert FRAME.object_id[-1, 0] == scene["floor"].id


def test_arrays_outlive_frame_and_renderer() -> None:
    image = rb.render(ball_scene()).image
    kept = image.copy()
    for _ in range(5):
        rb.render(ball_scene())
    assert image.tobytes() == kept.tobytes() == FRAME.image.tobytes()


def test_statistics_are_complete_and_plain() -> None:
    stats = FRAME.stats
    assert type(stats) is dict
    assert json.loads(json.dumps(stats)) == stats
    assert set(stats) == {
        *("seconds", "seconds_by_phase", "threads", "rays", "tests", "pixels", "reasons", "cells", "bytes", "edits")
    }
    assert set(stats["rays"]) == {"eye", "shadow", "reflected", "refracted"}
    assert set(stats["pixels"]) == {path.name for path in rb.Path}
    assert set(stats["reasons"]) == {reason.name for reason in rb.Reason}
    assert set(stats["cells"]) == {"made", "valid", "invalid"}
    assert stats["rays"]["eye"] == sum(stats["pixels"].values()) == sum(stats["reasons"].values()) == 48 * 32
    assert stats["rays"]["shadow"] > 0
    assert stats["rays"]["reflected"] > 0
    assert stats["pixels"]["BACKGROUND"] == (FRAME.object_id == -1).sum()
    assert stats["seconds"] == pytest.approx(sum(stats["seconds_by_phase"].values()))
    assert stats["seconds"] > 0


def test_numpy_reads_the_image() -> None:
    assert np.shares_memory(np.asarray(FRAME), FRAME.image)
    assert not np.shares_memory(np.array(FRAME), FRAME.image)
    assert np.array(FRAME).flags.writeable
    assert np.asarray(FRAME, np.float64).dtype == np.float64
    assert (np.asarray(FRAME, np.float64) == FRAME.image).all()
    assert np.mean(FRAME) == np.mean(FRAME.image)
    with pytest.raises(ValueError, match="cannot become float64 without a copy"):
        np.array(FRAME, np.float64, copy=False)


def test_srgb_bytes() -> None:
    codes = FRAME.to_srgb()
    assert (codes.dtype, codes.shape) == (np.uint8, (32, 48, 3))
    assert codes.flags.c_contiguous
    linear = np.clip(FRAME.image.astype(float), 0, 1)
    exact = 255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(codes - exact).max() <= 0.51
    codes[:] = 0
    assert FRAME.to_srgb().any()


def test_srgb_clips() -> None:
    scene = rb.Scene(background=(7, 1, 0))
    codes = rb.render(scene, rb.Camera((0, 0, 0), (1, 0, 0), width=2, height=2)).to_srgb()
    assert (codes == (255, 255, 0)).all()


def test_notebooks_show_a_png() -> None:
    png = FRAME._repr_png_()
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    assert int.from_bytes(png[16:20]) == 48
    assert int.from_bytes(png[20:24]) == 32
    assert png == pickle.loads(pickle.dumps(FRAME))._repr_png_()


def test_equality_and_pickles() -> None:
    again = pickle.loads(pickle.dumps(FRAME))
    assert again == FRAME
    assert again.stats == FRAME.stats
    assert (again.camera, again.tolerance, again.revision) == (FRAME.camera, FRAME.tolerance, FRAME.revision)
    assert rb.render(ball_scene(), method="base") == FRAME
    scene = ball_scene()
    scene["ball"].move(rb.Transform.translate(1, 0, 0))
    assert rb.render(scene, revised := FRAME.camera, method="base") != FRAME
    assert rb.render(ball_scene(), revised.dolly(0.1), method="base") != FRAME
    assert rb.render(ball_scene(), tolerance=0.1, method="base") != FRAME
    assert FRAME != 3
    with pytest.raises(TypeError, match="unhashable"):
        hash(FRAME)


def test_repr() -> None:
    assert repr(FRAME).startswith("<Frame 48 x 32, revision 3, Tolerance(0.0), pixels {")
    assert '"BACKGROUND": ' in repr(FRAME)


def test_explanations_print_the_ray_tree() -> None:
    seen = FRAME.explain(24, 16)
    text = str(seen)
    assert repr(seen) == text
    assert seen.object == "'ball' (Sphere)"
    assert (seen.x, seen.y, seen.object_id, seen.path, seen.reason) == (24, 16, 1, rb.Path.TRACED, rb.Reason.NONE)
    assert text.splitlines()[0].startswith("pixel (24, 16) shows object 1, 'ball' (Sphere); path TRACED")
    assert "eye ray from (0.0, -6.0, 2.5)" in text
    assert "reflected ray from" in text
    assert "light 0, 'lamp' (PointLight): " in text
    assert tuple(np.float32(seen.tree["radiance"])) == tuple(FRAME.image[16, 24])
    sky = FRAME.explain(0, 0)
    assert sky.object is None
    assert "shows the background" in str(sky)
    assert "meets nothing" in str(sky)


def test_explanations_agree_with_the_picture() -> None:
    for y in range(0, 32, 3):
        for x in range(0, 48, 3):
            tree = FRAME.explain(x, y).tree
            assert np.float32(tree["radiance"]).tobytes() == FRAME.image[y, x].tobytes()
            assert (tree["object_id"] if tree["hit"] else -1) == FRAME.object_id[y, x]


def test_old_frames_explain_what_was_rendered() -> None:
    scene = ball_scene()
    frame = rb.render(scene)
    before = str(frame.explain(24, 16))
    scene["ball"].shape = rb.Box()
    scene["floor"].remove()
    scene["lamp"].light = rb.DirectionalLight((0, 0, -1))
    assert str(frame.explain(24, 16)) == before
    with scene.edit():
        scene["ball"].remove()
        assert "Box" in str(rb.render(scene).explain(24, 16))


@pytest.mark.parametrize(
    ("x", "y", "error", "words"),
    [
        (48, 0, ValueError, "x must be an integer in 0..47, got 48"),
        (-1, 0, ValueError, "x must be an integer in 0..47, got -1"),
        (0, 32, ValueError, "y must be an integer in 0..31, got 32"),
        (0.5, 0, TypeError, "x must be an integer, got 0.5"),
        (0, None, TypeError, "y must be an integer, got None"),
    ],
)
def test_explaining_pixels_outside(x: Any, y: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=f"Frame.explain: {words}"):
        FRAME.explain(x, y)


def test_unpickled_frames_cannot_explain() -> None:
    with pytest.raises(ValueError, match=r"Frame\.explain: needs the scene, which a frame loses"):
        pickle.loads(pickle.dumps(FRAME)).explain(0, 0)
