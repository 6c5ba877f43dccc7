"""The renderer: options, progress, cancelling, refining, sequences, statistics, closing."""

from __future__ import annotations

import json
import pickle
from collections.abc import Iterator

import numpy as np
import pytest
from tests.python.samples import ball_scene, small_scene

import raybound as rb

ARRAYS = ("image", "error_bound", "path", "reason", "object_id", "depth")


def same(a: rb.Frame, b: rb.Frame) -> bool:
    return all(getattr(a, name).tobytes() == getattr(b, name).tobytes() for name in ARRAYS)


@pytest.fixture
def renderer() -> Iterator[rb.Renderer]:
    with rb.Renderer(ball_scene()) as made:
        yield made


def test_an_empty_scene_renders_the_background() -> None:
    scene = rb.Scene(background=(0.25, 0.5, 1))
    frame = rb.render(scene, rb.Camera((0, -5, 0), (0, 0, 0), width=7, height=5))
    assert (frame.image == np.float32((0.25, 0.5, 1))).all()
    assert (frame.object_id == -1).all()
    assert np.isinf(frame.depth).all()
    assert (frame.path == rb.Path.BACKGROUND).all()
    assert (frame.error_bound == 0).all()


def test_default_camera_and_options(renderer: rb.Renderer) -> None:
    camera = renderer.scene.camera
    assert camera is not None
    frame = renderer.render()
    assert frame.camera == camera
    assert frame.tolerance == renderer.tolerance == rb.Tolerance(0)
    assert frame.revision == renderer.scene.revision
    for options in ({"method": "exact"}, {"tolerance": 0.1}, {"tolerance": rb.Tolerance(None)}, {"threads": 2}):
        other = rb.render(renderer.scene, camera, **options)
        assert same(other, frame)
    base = rb.render(renderer.scene, camera, method="base")
    assert base.image.tobytes() == frame.image.tobytes()
    assert repr(renderer).startswith("<Renderer of <Scene: 2 objects, 1 lights, revision 3>, Tolerance(0.0), method=")


def test_every_option_is_accepted() -> None:
    for bound in ("constant", "hansen", "second-order", "taylor", "estimate"):
        rb.Renderer(ball_scene(), rb.Tolerance(0.1), method="base", bound=bound, memory=1, threads=3, editable=False)
    for quality in ("bounded", *(f"extrapolate-{level}" for level in range(1, 5))):
        rb.Renderer(ball_scene(4, 4)).render(quality=quality)
    for method in ("taylor", "quadrilinear"):
        with pytest.raises(ValueError, match=f"method '{method}' is not available in this version"):
            rb.Renderer(rb.Scene(), method=method)


def test_max_depth() -> None:
    scene = small_scene()
    rays = [rb.render(scene, max_depth=depth).stats["rays"] for depth in (1, 2, 3)]
    assert rays[0]["reflected"] == rays[0]["refracted"] == 0
    assert 0 < rays[1]["reflected"] < rays[2]["reflected"]


@pytest.mark.parametrize("threads", [1, 2, 3, 8])
def test_bytes_do_not_depend_on_threads(threads: int) -> None:
    scene = small_scene()
    assert same(rb.render(scene, threads=threads), rb.render(scene, threads=1))


def test_edits_take_effect_at_the_next_frame(renderer: rb.Renderer) -> None:
    first = renderer.render()
    scene = renderer.scene
    scene["ball"].move(rb.Transform.translate(1, 0, 0))
    second = renderer.render()
    scene["ball"].move(rb.Transform.translate(-1, 0, 0))
    third = renderer.render()
    assert not same(first, second)
    assert same(first, third)
    assert [frame.revision - first.revision for frame in (first, second, third)] == [0, 1, 2]
    assert [frame.stats["edits"] for frame in (first, second, third)] == [0, 1, 1]


def test_progress_is_called_with_growing_fractions(renderer: rb.Renderer) -> None:
    seen: list[float] = []
    frame = renderer.render(progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1
    assert 0 <= seen[0]
    assert same(frame, renderer.render(progress=False))


def test_progress_bar_goes_to_stderr_only(renderer: rb.Renderer, capfd: pytest.CaptureFixture[str]) -> None:
    renderer.render(progress=True)
    out, err = capfd.readouterr()
    assert out == ""
    assert "100%" in err


def test_an_exception_from_progress_cancels_the_frame(renderer: rb.Renderer) -> None:
    big = ball_scene(600, 400).camera

    def stop(fraction: float) -> None:
        raise ZeroDivisionError(f"at {fraction}")

    with pytest.raises(ZeroDivisionError):
        renderer.render(big, progress=stop)
    partial = renderer.partial_frame
    assert partial is not None
    done = partial.error_bound == 0
    assert np.isinf(partial.error_bound[~done]).all()
    whole = renderer.render(big)
    assert renderer.partial_frame is None
    assert (partial.image[done] == whole.image[done]).all()
    assert (whole.error_bound == 0).all()
    assert renderer.stats["frames"] == 1


def test_refining_ends_with_the_frame_itself(renderer: rb.Renderer) -> None:
    frames = list(renderer.refine())
    assert len(frames) == 4
    assert same(frames[-1], rb.render(renderer.scene))
    shares = [float((frame.error_bound == 0).mean()) for frame in frames]
    assert shares == sorted(shares)
    assert shares[0] < 0.05
    assert shares[-1] == 1
    for frame in frames[:-1]:
        open_ = np.isinf(frame.error_bound)
        assert (frame.path[open_] == rb.Path.EXTRAPOLATED).all()
        assert (frame.path[~open_] != rb.Path.EXTRAPOLATED).all()
        assert (frame.image[~open_] == frames[-1].image[~open_]).all()
        assert (frame.image[0:8, 0:8] == frame.image[0, 0]).all() or frame is not frames[0]
    assert frames[-1].stats["pixels"] == rb.render(renderer.scene).stats["pixels"]


def test_refining_shows_one_revision(renderer: rb.Renderer) -> None:
    before = rb.render(renderer.scene)
    frames = []
    for frame in renderer.refine():
        frames.append(frame)
        renderer.scene["ball"].move(rb.Transform.translate(0.1, 0, 0))
    assert {frame.revision for frame in frames} == {before.revision}
    assert same(frames[-1], before)


def test_a_sequence_is_the_frames_one_by_one(renderer: rb.Renderer) -> None:
    camera = renderer.scene.camera
    assert camera is not None
    cameras = [camera.orbit(angle, 0) for angle in (0, 20, 40)]
    seen: list[float] = []
    frames = list(renderer.sequence(iter(cameras), progress=seen.append))
    assert [frame.camera for frame in frames] == cameras
    assert {1 / 3, 2 / 3, 1.0} <= set(seen)  # each frame is a third of the way
    assert all(same(frame, rb.render(renderer.scene, cam)) for frame, cam in zip(frames, cameras, strict=True))
    assert seen == sorted(seen)
    assert seen[-1] == 1
    assert list(renderer.sequence([])) == []


def test_kept_frames_are_never_overwritten(renderer: rb.Renderer) -> None:
    camera = renderer.scene.camera
    assert camera is not None
    frames = [*renderer.refine(), *renderer.sequence([camera, camera.dolly(1), camera])]
    copies = [{name: getattr(frame, name).copy() for name in ARRAYS} for frame in frames]
    renderer.scene["floor"].remove()
    renderer.render()
    renderer.clear()
    renderer.render(camera.dolly(2))
    renderer.close()
    for frame, copy in zip(frames, copies, strict=True):
        for name in ARRAYS:
            assert getattr(frame, name).tobytes() == copy[name].tobytes()


def test_totals(renderer: rb.Renderer) -> None:
    frames = [renderer.render() for _ in range(3)]
    totals = renderer.stats
    assert totals["frames"] == 3
    assert totals["rays"]["eye"] == sum(frame.stats["rays"]["eye"] for frame in frames)
    assert totals["pixels"]["TRACED"] == sum(frame.stats["pixels"]["TRACED"] for frame in frames)
    assert totals["seconds"] == pytest.approx(sum(frame.stats["seconds"] for frame in frames))
    assert totals["threads"] == frames[0].stats["threads"]
    assert json.loads(json.dumps(totals)) == totals
    eye = totals["rays"]["eye"]
    totals["rays"]["eye"] = 0
    assert renderer.stats["rays"]["eye"] == eye > 0
    assert 0 < renderer.memory_used <= 256 * 2**20
    renderer.clear()
    assert renderer.memory_used == 0


def test_any_rays(renderer: rb.Renderer) -> None:
    found = renderer.trace([(0, -9, 1), (0, 0, 5)], [(0, 1, 0), (0, 0, 1)])
    assert found.object_id.tolist() == [1, -1]
    assert found.path.tolist() == [rb.Path.TRACED, rb.Path.BACKGROUND]
    assert (found.radiance[1] == np.float32(renderer.scene.background)).all()
    assert (found.error_bound.tolist(), found.reason.tolist()) == ([0, 0], [0, 0])
    assert found == renderer.trace(np.array([(0, -9, 1), (0, 0, 5)]), [(0, 1, 0), (0, 0, 1)])
    assert found == pickle.loads(pickle.dumps(found))
    assert found != renderer.trace([(0, -9, 1), (0, 0, 5)], [(0, 1, 0), (0, 0, -1)])
    scene = renderer.scene
    assert renderer.linetrees(scene["ball"]).shape == (0,)
    with pytest.raises(ValueError, match=r"Renderer\.linetrees: object must be one of the renderer's scene"):
        renderer.linetrees(ball_scene()["ball"])


def test_closing() -> None:
    with rb.Renderer(ball_scene()) as renderer:
        frame = renderer.render()
    for name, call in (
        ("render", renderer.render),
        ("clear", renderer.clear),
        ("refine", lambda: [*renderer.refine()]),
    ):
        with pytest.raises(RuntimeError, match=f"Renderer: closed, {name} was called after its end"):
            call()
    renderer.close()
    assert frame.image.any()
    assert renderer.stats["frames"] == 1
    with pytest.raises(RuntimeError, match="closed"), renderer:
        pass
    with pytest.raises(TypeError, match="Renderer: cannot be pickled"):
        pickle.dumps(renderer)
