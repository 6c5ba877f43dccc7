"""refine and sequence: the last frame is the render, earlier ones are honest about what they guess."""

import numpy as np
import pytest
from tests.support.random_scenes import random_scene

import raybound as rb

ARRAYS = ("image", "error_bound", "path", "object_id", "depth")


def view(width: int = 71, height: int = 45) -> tuple[rb.Scene, rb.Camera]:
    scene = rb.scenes.three_spheres()
    return scene, scene.camera.replace(width=width, height=height)


def assert_same(a: rb.Frame, b: rb.Frame) -> None:
    for name in ARRAYS:
        assert getattr(a, name).tobytes() == getattr(b, name).tobytes(), name


@pytest.mark.parametrize("method", ["base", "exact"])
@pytest.mark.parametrize("size", [(71, 45), (64, 64), (1, 1), (9, 3)])
def test_the_last_frame_is_what_render_gives(size: tuple, method: str) -> None:
    scene, cam = view(*size)
    with rb.Renderer(scene, method=method) as renderer:
        expected = renderer.render(cam)
        frames = list(renderer.refine(cam))
    assert len(frames) >= 3
    assert_same(frames[-1], expected)
    if method == "base":  # which traces no pixel twice
        assert frames[-1].stats["rays"] == expected.stats["rays"]


def test_earlier_frames_flag_what_they_guess() -> None:
    scene, cam = view()
    with rb.Renderer(scene) as renderer:
        expected = renderer.render(cam)
        frames = list(renderer.refine(cam))
    shares = []
    for frame in frames:
        guessed = frame.path == rb.Path.EXTRAPOLATED
        assert (np.isinf(frame.error_bound) == guessed).all()
        assert not frame.error_bound[~guessed].any()
        assert (frame.image == expected.image)[~guessed].all()
        assert (frame.depth == expected.depth)[~guessed].all()
        assert frame.stats["pixels"]["EXTRAPOLATED"] == guessed.sum()
        shares.append(guessed.mean())
    assert shares[0] > 0.9
    assert shares[-1] == 0
    assert (np.diff(shares) < 0).all()


def test_a_guess_is_the_colour_of_a_traced_pixel_nearby() -> None:
    scene, cam = view()
    frame = next(rb.Renderer(scene).refine(cam))
    traced = np.argwhere(np.isfinite(frame.error_bound))
    step = int(np.diff(np.unique(traced[:, 0])).min())
    assert step >= 4
    for y, x in np.argwhere(np.isinf(frame.error_bound)):
        corner = frame.image[y // step * step, x // step * step]
        assert (frame.image[y, x] == corner).all()


def test_frames_of_a_refinement_are_kept_as_they_were() -> None:
    scene, cam = view()
    copies, frames = [], []
    for frame in rb.Renderer(scene).refine(cam):
        frames.append(frame)
        copies.append((np.array(frame.image), np.array(frame.error_bound)))
    for frame, (image, bound) in zip(frames, copies, strict=True):
        assert (frame.image == image).all()
        assert (frame.error_bound == bound).all()
        with pytest.raises(ValueError, match="read-only"):
            frame.image[0, 0] = 1


def test_a_refinement_shows_the_scene_of_its_start() -> None:
    scene, cam = view()
    with rb.Renderer(scene) as renderer:
        expected = renderer.render(cam)
        frames = renderer.refine(cam)
        next(frames)
        scene["mirror"].remove()
        assert_same(list(frames)[-1], expected)
        assert (renderer.render(cam).image != expected.image).any()


def test_renders_between_the_frames_of_a_refinement() -> None:
    scene, cam = view()
    other = cam.orbit(20, 0)
    with rb.Renderer(scene) as renderer:
        expected, expected_other = renderer.render(cam), renderer.render(other)
        for frame in renderer.refine(cam):
            assert_same(renderer.render(other), expected_other)
            last = frame
        assert_same(last, expected)


def test_a_sequence_is_its_renders() -> None:
    scene = random_scene(17, pixels=40)
    cameras = [scene.camera.orbit(15 * k, 0) for k in range(5)]
    with rb.Renderer(scene) as renderer:
        expected = [renderer.render(cam) for cam in cameras]
        frames = list(renderer.sequence(iter(cameras)))
    assert [frame.camera for frame in frames] == cameras
    for frame, one in zip(frames, expected, strict=True):
        assert_same(frame, one)


def test_a_sequence_renders_each_frame_when_it_is_asked_for() -> None:
    scene, cam = view()
    with rb.Renderer(scene) as renderer:
        frames = renderer.sequence([cam, cam])
        first = next(frames)
        scene.background = (7, 7, 7)
        second = next(frames)
    assert first.revision < second.revision == scene.revision
    assert (second.image == 7).any()
    assert not (first.image == 7).any()


def test_every_quality_of_a_renderer_without_cells_is_traced() -> None:
    scene, cam = view()
    with rb.Renderer(scene, method="base") as renderer:
        expected = renderer.render(cam)
        for quality in ("extrapolate-1", "extrapolate-2", "extrapolate-3", "extrapolate-4"):
            assert_same(renderer.render(cam, quality), expected)


def test_the_same_frame_again_has_the_same_bytes_and_counts() -> None:
    scene, cam = view()
    with rb.Renderer(scene, method="base") as renderer:
        frames = [renderer.render(cam) for _ in range(3)]
    assert frames[0] == frames[1] == frames[2]
    assert frames[0].stats["rays"] == frames[2].stats["rays"]
