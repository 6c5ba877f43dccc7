"""`python -m raybound bench exact`: what is measured, tables, the plot and the README's block. No times are judged."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.python.samples import ball_scene

import raybound as rb
from raybound.bench import exact, exact_plot, exact_run, workloads
from raybound.bench.exact_run import Run
from raybound.bench.exact_tables import KINDS
from raybound.cli import main

ROOT = Path(__file__).resolve().parents[2]
SMALL = ["--repeat=1", "--width=32", "--height=24"]


@pytest.fixture
def ball(monkeypatch: pytest.MonkeyPatch) -> rb.Scene:
    """A small scene under the name of a large one."""
    scene = ball_scene()
    monkeypatch.setitem(workloads.READY, "sphereflake:4", lambda: scene)
    return scene


def test_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    readme, out, plot = tmp_path / "README.md", tmp_path / "exact.json", tmp_path / "exact.png"
    shutil.copy(ROOT / "README.md", readme)
    arguments = ["--scenes=museum", "--json", str(out), "--plot", str(plot), "--readme", str(readme), "--markdown"]
    assert main(["bench", "exact", *SMALL, *arguments]) == 0
    printed, result = capsys.readouterr().out, json.loads(out.read_text())
    scene = result["scenes"]["museum"]
    assert (result["width"], result["height"], result["repeat"], result["left_out"]) == (32, 24, 1, {})
    assert scene["moved"] == rb.scenes.museum()["sculpture-top"].id
    assert list(scene["frames"]) == list(KINDS)
    assert {kind: frame["frames"] for kind, frame in scene["frames"].items()} == {**dict.fromkeys(KINDS, 1), "walk": 12}
    assert list(scene["threads"]) == ["1", "2"]
    for times in (*scene["frames"].values(), *(kind for kinds in scene["threads"].values() for kind in kinds.values())):
        assert times["equal"]
        assert all(times[key] > 0 for key in ("base", "exact", "speedup"))
    assert scene["threads"]["1"]["walk"]["scaling"] == {"base": 1, "exact": 1}
    assert plot.stat().st_size > 10_000
    block = readme.read_text().partition("<!-- bench exact -->\n")[2].partition("<!-- /bench exact -->")[0]
    assert block.count("\n| museum |") == 3
    assert block.splitlines()[0] in printed
    assert printed.count("\n| museum |") == 2 + len(KINDS)


def test_what_frames_did(ball: rb.Scene) -> None:
    result = exact.measure(width=120, height=80, repeat=2, threads=[1], names=["sphereflake:4"])
    scene = result["scenes"]["sphereflake:4"]
    frames = scene["frames"]
    assert (scene["painted"], scene["moved"]) == (ball["floor"].id, ball["ball"].id)
    assert scene["cells_made_by_repainting"] == 0
    assert frames["walk"]["frames"] == exact.ORBIT_FRAMES
    assert frames["first"]["made"] > 20
    assert frames["again"]["made"] == frames["colour"]["made"] == frames["light"]["made"] == 0
    assert frames["move"]["made"] > 0
    for kind, frame in frames.items():
        asked = kind not in ("again", "colour", "light")  # where nothing has changed for rays nothing is asked
        assert (sum(frame["searches"].values()) > 0) == (frame["tests"] > 0) == asked, kind
    for frame in frames.values():
        assert frame["equal"]
        assert 0.5 < frame["certified"] <= 1
        assert sum(frame["searches"].values()) < 0.5 * frame["base_searches"]
        assert frame["bytes"] > frame["block_bytes"] > 1000
    assert frames["first"]["base_searches"] > 1.5
    assert set(ball.to_dict()) == set(ball_scene().to_dict())
    assert ball.revision == ball_scene().revision  # edits are made to copies


def test_edits_change_the_picture(ball: rb.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[rb.Frame] = []

    def keep(a: rb.Frame, b: rb.Frame) -> bool:
        shown.append(b)
        return len(shown) != 2

    monkeypatch.setattr(exact_run, "same_bytes", keep)
    run = Run(ball, 1)
    camera = ball.camera
    assert camera is not None
    run.walk([camera, camera.orbit(1, 0)])
    run.edits(camera, ball["floor"].id, ball["ball"].id)
    run.close()
    assert list(run.made) == list(KINDS)
    first, again, walk, colour, light, moved, back = (frame.image for frame in shown)
    assert (first == again).all()
    for a, b in ((again, walk), (again, colour), (colour, light), (light, moved)):
        assert (a != b).any()
    assert (back == light).all()
    assert [made.equal for made in run.made.values()] == [True, False, *[True] * 5]


def test_a_difference_is_seen() -> None:
    scene = ball_scene()
    a = rb.render(scene, method="base")
    assert exact_run.same_bytes(a, rb.render(scene, method="exact"))
    make, (arrays, *state) = a.__reduce__()
    image = arrays["image"].copy()
    image[3, 4, 1] = np.nextafter(image[3, 4, 1], np.float32(9))
    assert not exact_run.same_bytes(a, make({**arrays, "image": image}, *state))


def test_scenes_without_lights_and_without_objects(monkeypatch: pytest.MonkeyPatch) -> None:
    dark = ball_scene()
    dark["lamp"].remove()
    empty = rb.Scene()
    empty.camera = dark.camera
    monkeypatch.setitem(workloads.READY, "museum", lambda: empty)
    monkeypatch.setitem(workloads.READY, "sphereflake:4", lambda: dark)
    result = exact.measure(width=24, height=16, repeat=1, threads=[2, 1], names=["museum", "sphereflake:4"])
    assert result["left_out"] == {"museum": "its camera sees no object"}
    assert list(result["scenes"]["sphereflake:4"]["frames"]) == [kind for kind in KINDS if kind != "light"]
    speeds, scaling, work = exact.tables(result)
    assert speeds.rows[0][KINDS_COLUMN] == "-"
    assert "2 threads" in speeds.title
    assert [row[:2] for row in scaling.rows] == [["sphereflake:4", "1"]]
    assert len(work.rows) == len(KINDS) - 1
    assert all(len(row) == len(table.columns) for table in (speeds, scaling, work) for row in table.rows)
    assert len(exact_plot.figure(result).axes[0].patches) == len(KINDS) - 1
    assert not list(exact.tables({**result, "scenes": {}}))


KINDS_COLUMN = 1 + list(KINDS).index("light")


def test_unequal_bytes_are_shown(ball: rb.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exact_run, "same_bytes", lambda a, b: False)
    result = exact.measure(width=8, height=6, repeat=1, threads=[1], names=["sphereflake:4"])
    speeds, _work = exact.readme_tables(result)  # and nothing on more threads
    assert speeds.rows[0][-1] == "NOT ALL"


BAD = [
    (["--rays=3"], "--rays cannot be chosen for bench exact: it draws scenes alone"),
    (["--triangles=3"], "--triangles cannot be chosen for bench exact"),
    (["--scenes=house"], "scenes must be among museum, "),
    (["--plot=a.txt"], "--plot must end in one of .png, .svg, .pdf, got 'a.txt'"),
    (["--repeat=0"], "--repeat must be >= 1, got 0"),
]


@pytest.mark.parametrize(("arguments", "words"), BAD, ids=[" ".join(arguments) for arguments, _ in BAD])
def test_bad_arguments(arguments: list[str], words: str, capsys: Any) -> None:
    assert main(["bench", "exact", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err
