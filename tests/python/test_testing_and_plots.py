"""assert_within_bound, the report, and figures."""

from __future__ import annotations

import json
import pickle
import re
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
import pytest
from tests.python.samples import ball_scene

import raybound as rb

FRAME = rb.render(ball_scene())
assert_within_bound = rb.testing.assert_within_bound


def altered(image: np.ndarray, error_bound: np.ndarray | None = None, **others: Any) -> rb.Frame:
    """The frame with other pixels, as a renderer with errors would make it."""
    make, (arrays, camera, tolerance, revision, stats) = FRAME.__reduce__()
    arrays = {**arrays, "image": image.copy()}
    if error_bound is not None:
        arrays["error_bound"] = error_bound.astype(np.float32)
    state = {"camera": camera, "tolerance": tolerance, "revision": revision, "stats": stats, **others}
    frame: rb.Frame = make(arrays, *state.values())
    return frame


def off_by(amount: float, x: int = 5, y: int = 3) -> np.ndarray:
    image = FRAME.image.copy()
    image[y, x, 1] += amount
    return image


def test_frames_within_their_bounds_pass(tmp_path: Path) -> None:
    bound = np.full((32, 48), 0.25)
    assert_within_bound(FRAME, FRAME, directory=tmp_path)
    assert_within_bound(altered(off_by(0.125), bound), FRAME, directory=tmp_path)
    assert_within_bound(FRAME, altered(off_by(0.125), bound))  # the reference's bounds count, too
    assert_within_bound(altered(FRAME.image + 7, np.full((32, 48), np.inf)), FRAME)
    for frame in rb.Renderer(ball_scene()).refine():
        assert_within_bound(frame, FRAME)
    assert list(tmp_path.iterdir()) == []


def test_a_failure_names_the_worst_pixel_and_saves_pictures(tmp_path: Path) -> None:
    bound = np.zeros((32, 48))
    bound[3, 5] = 0.0625
    image = off_by(0.25)
    image[10, 20] += 0.125
    folder = tmp_path / "new" / "pictures"
    with pytest.raises(AssertionError) as caught:
        assert_within_bound(altered(image, bound), FRAME, directory=folder)
    message = str(caught.value)
    assert "2 of 1536 pixels lie outside their bounds" in message
    assert re.search(r"worst at \(x, y\) = \(5, 3\): error 0\.25\d*, bound 0\.0625, path BACKGROUND", message)
    assert str(folder) in message
    assert sorted(path.name for path in folder.iterdir()) == ["error.png", "frame.png", "reference.png"]
    error = rb.Texture(folder / "error.png").texels
    assert (error[3, 5] == (1, 0, 0)).all()
    assert (error[10, 20] == (1, 0, 0)).all()
    assert (error.sum(axis=2) > 0).sum() == 2


def test_pictures_of_a_failure_go_to_a_temporary_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(AssertionError, match=re.escape(str(tmp_path))):
        assert_within_bound(altered(off_by(0.25)), FRAME)
    assert len(list(tmp_path.glob("raybound-*/*.png"))) == 3


def test_the_least_error_outside_fails(tmp_path: Path) -> None:
    image = FRAME.image.copy()
    image[3, 5, 1] = np.nextafter(image[3, 5, 1], np.float32(9))
    with pytest.raises(AssertionError, match="1 of 1536"):
        assert_within_bound(altered(image), FRAME, directory=tmp_path)
    for value in (np.nan, np.inf):
        image[3, 5, 1] = value
        with pytest.raises(AssertionError, match=r"\(5, 3\)"):
            assert_within_bound(altered(image, np.ones((32, 48))), FRAME, directory=tmp_path)


def test_other_frames_are_refused(tmp_path: Path) -> None:
    scene = ball_scene()
    scene["ball"].move(rb.Transform.translate(0, 0, 1))
    cases: list[tuple[Any, type[Exception], str]] = [
        (rb.render(scene, FRAME.camera), ValueError, "frames must show one revision, got 3 and 4"),
        (rb.render(ball_scene(), FRAME.camera.dolly(0.1)), ValueError, "frames must have one camera"),
        (rb.render(ball_scene(47, 32)), ValueError, "frames must have one size"),
        (FRAME.image, TypeError, "reference must be a Frame"),
    ]
    for reference, error, words in cases:
        for name, call in (("assert_within_bound", assert_within_bound), ("plot.error_map", rb.plot.error_map)):
            with pytest.raises(error, match=f"{name}: {words}"):
                call(FRAME, reference)
    with pytest.raises(TypeError, match="assert_within_bound: frame must be a Frame, got None"):
        assert_within_bound(None, FRAME)
    with pytest.raises(TypeError, match=r"plot\.path_map: frame must be a Frame"):
        rb.plot.path_map(3)


def test_the_report_is_complete_and_prints() -> None:
    report = rb.report()
    keys = ("raybound", "python", "numpy", "OpenImageIO", "compiler", "instruction_level", "hardware_threads", "flags")
    assert set(keys) <= set(report)
    assert report["raybound"] == rb.__version__
    lines = str(report).splitlines()
    assert len(lines) == len(report)
    assert f"raybound: {rb.__version__}" in lines
    assert json.loads(json.dumps(report)) == report
    assert pickle.loads(pickle.dumps(report)) == report


def test_path_maps(tmp_path: Path) -> None:
    figure = rb.plot.path_map(rb.render(ball_scene(), method="base"))
    assert isinstance(figure, matplotlib.figure.Figure)
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    share = (FRAME.object_id == -1).mean()
    assert texts == [f"traced {1 - share:.1%}", f"background {share:.1%}"]
    exact = rb.render(ball_scene(), method="exact")
    texts = [text.get_text() for text in rb.plot.path_map(exact).legends[0].get_texts()]
    assert texts == [f"{path.name.lower()} {(exact.path == path).mean():.1%}" for path in rb.Path if path in exact.path]
    figure.savefig(tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 1000
    first = next(iter(rb.Renderer(ball_scene()).refine()))
    assert any(text.get_text().startswith("extrapolated 9") for text in rb.plot.path_map(first).legends[0].get_texts())


def test_error_maps(tmp_path: Path) -> None:
    bound = np.full((32, 48), 0.25)
    bound[0] = np.inf
    for frame in (FRAME, altered(off_by(0.125), bound), altered(off_by(0.5)), altered(off_by(np.nan))):
        figure = rb.plot.error_map(frame, FRAME)
        assert [axes.get_title() for axes in figure.axes[:2]] == ["|image - reference|", "certified bound"]
        figure.savefig(tmp_path / "map.png")


def test_figures_are_not_kept_by_pyplot() -> None:
    from matplotlib import pyplot

    before = pyplot.get_fignums()
    rb.plot.path_map(FRAME)
    rb.plot.error_map(FRAME, FRAME)
    assert pyplot.get_fignums() == before
