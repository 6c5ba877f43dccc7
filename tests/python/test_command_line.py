"""`python -m raybound`: render, demo, bench; bad input gives one line and the exit code 2."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from tests.python.samples import ball_scene

import raybound as rb
from raybound.cli import main


def run(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "raybound", *arguments]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=120, check=False)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    ball_scene().save("ball.json")
    return tmp_path


def test_render_a_file_as_a_user_does(tmp_path: Path) -> None:
    ball_scene().save(tmp_path / "ball.json")
    done = run("render", "ball.json", "-o", "ball.exr", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("ball.exr: 48 x 32 pixels, ")
    assert (rb.Texture(tmp_path / "ball.exr").texels == rb.render(ball_scene()).image).all()


def test_options_of_render(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    camera = rb.Camera((-1, -7, 3), (0, 0, 1), fov=40, width=20, height=10)
    ways = {
        "json": ["--camera", '{"eye": [-1, -7, 3], "target": [0, 0, 1], "fov": 40, "width": 20, "height": 10}'],
        "sizes": ["--camera", '{"eye": [-1, -7, 3], "target": [0, 0, 1], "fov": 40}', "--width=20", "--height=10"],
        "numbers": ["--camera=-1,-7,3,0,0,1", "--width", "20", "--height", "10"],
    }
    for name, options in ways.items():
        rest = ["--threads=1", "--max-depth=2", "--method=base", "--tolerance=none"]
        assert main(["render", "ball.json", "-o", f"{name}.exr", *options, *rest]) == 0
        view = camera.replace(fov=60) if name == "numbers" else camera
        expected = rb.render(ball_scene(), view, max_depth=2)
        assert (rb.Texture(f"{name}.exr").texels == expected.image).all()
    assert capsys.readouterr().out.count("20 x 10 pixels") == 3


@pytest.mark.parametrize("name", ["museum", "three_spheres", "sphereflake:1"])
def test_ready_scenes(name: str, folder: Path) -> None:
    assert main(["render", name, "-o", "out.png", "--width=32", "--height=24"]) == 0
    texels = rb.Texture("out.png").texels
    assert texels.shape == (24, 32, 3)
    assert texels.std() > 0.01


def test_progress_bar(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "ball.json", "-o", "a.png", "--progress"]) == 0
    out, err = capfd.readouterr()
    assert "100%" in err
    assert len(out.splitlines()) == 1


BAD = [
    ([], "required"),
    (["paint"], "invalid choice: 'paint'"),
    (["render"], "SCENE"),
    (["render", "ball.json"], "-o"),
    (["render", "ball.json", "-o", "a.xyz"], "--out: path must end in the extension of an image format, got 'a.xyz'"),
    (["render", "ball.json", "-o", "none/a.png"], "--out: no such folder: 'none'"),
    (["render", "none.json", "-o", "a.png"], "none.json"),
    (
        ["render", "none", "-o", "a.png"],
        "SCENE must be a .json or .nff file or one of museum, three_spheres, sphereflake",
    ),
    (["render", "bad.json", "-o", "a.png"], "'bad.json' is not JSON: Expecting"),
    (["render", "empty.json", "-o", "a.png"], "empty.json has no camera; give one with --camera"),
    (["render", "sphereflake", "-o", "a.png"], "SCENE must be sphereflake:LEVELS, got 'sphereflake'"),
    (["render", "sphereflake:x", "-o", "a.png"], "SCENE must be sphereflake:LEVELS, got 'sphereflake:x'"),
    (["render", "museum:2", "-o", "a.png"], "SCENE must be museum, got 'museum:2'"),
    (["render", "ball.json", "-o", "a.png", "--width=0"], "Camera: width must be an integer in 1..65536, got 0"),
    (["render", "ball.json", "-o", "a.png", "--width=a"], "--width: invalid int value: 'a'"),
    (["render", "ball.json", "-o", "a.png", "--threads=-1"], "Renderer: threads must be an integer in 0..1024, got -1"),
    (["render", "ball.json", "-o", "a.png", "--max-depth=0"], "Renderer: max_depth must be"),
    (["render", "ball.json", "-o", "a.png", "--tolerance=x"], "--tolerance: must be a number >= 0 or none, got 'x'"),
    (["render", "ball.json", "-o", "a.png", "--tolerance=-1"], "--tolerance: must be a number >= 0 or none, got '-1'"),
    (["render", "ball.json", "-o", "a.png", "--method=taylor"], "method 'taylor' is not available in this version"),
    (["render", "ball.json", "-o", "a.png", "--method=best"], "invalid choice: 'best'"),
    (["render", "ball.json", "-o", "a.png", "--camera=1,2,3"], "--camera must be a JSON object or ex,ey,ez,tx,ty,tz"),
    (["render", "ball.json", "-o", "a.png", "--camera={"], "--camera is not JSON"),
    (["render", "ball.json", "-o", "a.png", '--camera={"fow": 3}'], "--camera has the unknown key 'fow'"),
    (["render", "ball.json", "-o", "a.png", "--camera=0,0,0,0,0,0"], "Camera: target must differ from eye"),
    (["demo", "--frames=0"], "frames must be >= 1, got 0"),
    (["demo", "--width=-1"], "Camera: width must be"),
    (["bench", "speed"], "invalid choice: 'speed'"),
    (["bench", "base", "--repeat=0"], "--repeat must be >= 1, got 0"),
    (["bench", "base", "--rays=many"], "--rays: invalid int value: 'many'"),
]


@pytest.mark.parametrize(("arguments", "words"), BAD, ids=[" ".join(arguments) for arguments, _ in BAD])
def test_bad_input(arguments: list[str], words: str, folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    Path("bad.json").write_text("{\n")
    rb.Scene().save("empty.json")
    before = sorted(path.name for path in folder.iterdir())
    try:
        code = main(arguments)
    except SystemExit as end:
        code = int(end.code or 0)
    out, err = capfd.readouterr()
    assert (code, out) == (2, "")
    assert err.startswith("raybound")
    assert err.count("\n") == 1
    assert words in err
    assert sorted(path.name for path in folder.iterdir()) == before


def test_bad_input_as_a_user_sees_it(tmp_path: Path) -> None:
    done = run("render", "none.json", "-o", "a.png", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert "Traceback" not in done.stderr


def test_help() -> None:
    for arguments in ([], ["render"], ["demo"], ["bench"]):
        with pytest.raises(SystemExit) as caught:
            main([*arguments, "--help"])
        assert caught.value.code == 0


def test_demo(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demo", "--frames=2", "--width=32", "--height=24", "--out", "pictures"]) == 0
    names = {path.relative_to("pictures").as_posix() for path in Path("pictures").rglob("*") if path.is_file()}
    assert names == {"walk/000.png", "walk/001.png", "museum.png", "three_spheres.png", "statistics.json"}
    walk = [rb.Texture(Path("pictures", "walk", f"00{i}.png")).texels for i in range(2)]
    assert walk[0].shape == (24, 32, 3)
    assert (walk[0] != walk[1]).any()
    statistics = json.loads(Path("pictures", "statistics.json").read_text())
    assert statistics["walk"]["frames"] == 2
    assert set(statistics["pictures"]) == names - {"statistics.json"}
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split()[:2] == ["picture", "seconds"]
    assert len(lines) == 7
