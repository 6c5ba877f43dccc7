"""Nothing is printed; what there is to say goes to the logger "raybound"."""

from __future__ import annotations

import logging
import subprocess
import sys
from pathlib import Path

import pytest
from tests.python.samples import ball_scene, small_scene

import raybound as rb


def use_everything(folder: Path) -> None:
    """A little of all that could print."""
    scene = small_scene()
    with rb.Renderer(scene) as renderer:
        frame = renderer.render(progress=lambda fraction: None)
        list(renderer.refine())
        list(renderer.sequence([frame.camera]))
        renderer.trace([(0, 0, 50)], [(0, 0, -1)])
    frame.explain(10, 10)
    frame.save(folder / "a.exr")
    frame.save(folder / "a.png")
    scene.save(folder / "a.json")
    rb.load_scene(folder / "a.json")
    with pytest.raises(ValueError, match="cannot read"):
        rb.Texture(folder / "a.json")
    with pytest.raises(ValueError, match="radius"):
        rb.Sphere(radius=-1)
    rb.testing.assert_within_bound(frame, frame)
    rb.plot.path_map(frame)
    rb.report()


def test_nothing_is_printed(capfd: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    use_everything(tmp_path)
    assert capfd.readouterr() == ("", "")


def test_nothing_is_printed_without_logging_set_up(tmp_path: Path) -> None:
    ball_scene().save(tmp_path / "ball.json")
    code = "import raybound as rb; frame = rb.render(rb.load_scene('ball.json')); frame.save('ball.png')"
    command = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_frames_are_logged(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.DEBUG, logger="raybound"):
        rb.render(ball_scene())
    messages = [record.getMessage() for record in caplog.records]
    assert any(message.startswith("rendered 48 x 32 pixels in ") for message in messages)
    assert {record.name.split(".")[0] for record in caplog.records} == {"raybound"}


def test_importing_is_light() -> None:
    code = (
        "import sys, raybound; print([m for m in ('OpenImageIO', 'matplotlib', 'tqdm', 'IPython') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.strip() == "[]"
