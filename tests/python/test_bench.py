"""`python -m raybound bench`: what is measured, tables, JSON and the README's blocks. No times are judged."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import raybound as rb
from raybound.bench import base, embree, tables, workloads, yardstick
from raybound.cli import main

ROOT = Path(__file__).resolve().parents[2]
SMALL = ["--repeat=1", "--triangles=60", "--rays=500"]
SMALL_BASE = [*SMALL, "--width=24", "--height=18"]


@pytest.fixture
def small_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    """A mesh as separate polygons, for versions that have no meshes."""

    def polygons(vertices: np.ndarray, faces: np.ndarray) -> rb.Scene:
        scene = rb.Scene()
        for face in faces:
            scene.add(rb.Polygon(vertices[face]), rb.Material())
        return scene

    if not hasattr(rb, "Mesh"):
        monkeypatch.setattr(workloads, "mesh_scene", polygons)


def positive(values: dict[str, float]) -> bool:
    return all(np.isfinite(value) and value > 0 for value in values.values())


@pytest.mark.usefixtures("small_mesh")
def test_base_json_and_tables(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "bench.json"
    assert main(["bench", "base", *SMALL_BASE, "--scenes=museum,sphereflake:4", "--json", str(out)]) == 0
    lines = capsys.readouterr().out.splitlines()
    result = json.loads(out.read_text())
    assert result["machine"]["raybound"] == rb.__version__
    assert set(result["scenes"]) == {"museum", "sphereflake:4"}
    assert result["left_out"] == {}
    for name, scene in result["scenes"].items():
        assert sum(line.startswith(f"{name} ") for line in lines) == 3
        assert scene["rays"]["eye"] == 24 * 18
        assert scene["bytes"] > 100 * scene["objects"]
        assert scene["primitives"] >= scene["objects"]
        assert list(scene["threads"]) == ["1", "2"]
        assert scene["threads"]["1"]["scaling"] == 1
        for times in scene["threads"].values():
            assert set(times) == {"seconds", "ns_per_pixel", "ns_per_ray", "ns_per_primary_ray", "scaling"}
            assert positive(times)
    assert result["mesh"]["triangles"] >= 50
    assert 100 < result["mesh"]["hits"] < 500
    assert all(positive(times) for times in result["mesh"]["threads"].values())
    for title in ("The base tracer, 24 x 18 pixels", "Rays a pixel", "Closest hits of 500 scattered rays"):
        assert sum(line.startswith(title) for line in lines) == 1


def test_scenes_that_cannot_be_measured_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("RAYBOUND_DATA", raising=False)
    monkeypatch.setattr(
        workloads, "mesh_scene", lambda *_: (_ for _ in ()).throw(workloads.UnavailableError("too large"))
    )
    result = base.measure(width=8, height=6, repeat=1, threads=[1], names=["museum", *workloads.SPD])
    assert set(result["scenes"]) == {"museum"}
    assert result["left_out"] == {**dict.fromkeys(workloads.SPD, "RAYBOUND_DATA is not set"), "mesh": "too large"}
    assert next(tables.left_out(result["left_out"])) == "left out: balls_s4 (RAYBOUND_DATA is not set)"
    assert len(list(base.tables(result))) == 2
    with pytest.raises(ValueError, match=r"scenes must be among museum, .*, got 'house'"):
        base.measure(names=["house"])


def test_files_that_cannot_be_read_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAYBOUND_DATA", str(tmp_path))
    assert workloads.default_names() == ["museum", "sphereflake:4", *workloads.SPD]
    with pytest.raises(workloads.UnavailableError, match=r"RAYBOUND_DATA has no nff/balls_s4\.nff"):
        workloads.load("balls_s4")
    (tmp_path / "nff").mkdir()
    (tmp_path / "nff" / "balls_s4.nff").write_text("nonsense 1 2 3\n")
    assert workloads.default_names() == ["museum", *workloads.SPD]
    with pytest.raises(workloads.UnavailableError, match="balls_s4"):
        workloads.load("balls_s4")


def test_the_mesh_is_closed_and_faces_outward() -> None:
    vertices, faces = workloads.mesh(1000)
    assert abs(len(faces) - 1000) < 50
    edges = {(int(face[k]), int(face[k - 1])) for face in faces for k in range(3)}
    assert len(edges) == 3 * len(faces)
    assert all((b, a) in edges for a, b in edges)
    a, b, c = (vertices[faces[:, k]].astype(float) for k in range(3))
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) > 0).all()
    assert len(workloads.mesh(1_000_000)[1]) == 1_000_000


def test_native_searches_agree_with_intersect(small_mesh: None) -> None:
    vertices, faces = workloads.mesh(300)
    scene = workloads.mesh_scene(vertices, faces)
    rays = workloads.scattered_rays(vertices, 2000)
    expected = scene.intersect(*rays)
    assert 500 < expected["hit"].sum() < 2000
    for threads in (1, 2):
        found = rb._core.closest_hits(scene._document.snapshot(), *rays, threads=threads)
        assert (found["object_id"] == expected["object_id"]).all()
        assert (found["face_id"] == expected["face_id"]).all()
        np.testing.assert_allclose(found["t"], expected["t"], rtol=1e-5)
        assert found["seconds"] > 0
    with pytest.raises(ValueError, match="same shape"):
        rb._core.closest_hits(scene._document.snapshot(), rays[0], rays[1][1:], threads=1)


def test_primary_hits_are_those_of_a_frame() -> None:
    scene = rb.scenes.three_spheres()
    assert scene.camera is not None
    camera = scene.camera.replace(width=80, height=50)
    frame = rb.render(scene, camera)
    for threads in (1, 2):
        hits, seconds = rb._core.primary_hits(scene._document.snapshot(), camera._native, threads=threads)
        assert hits == (frame.object_id >= 0).sum()
        assert seconds > 0


def test_tables() -> None:
    table = tables.Table("Title", ["name", "ns"], [["a", "1.5"], ["long", "200.0"]])
    assert list(table.text()) == ["Title", "name     ns", "a       1.5", "long  200.0"]
    expected = ["Title", "", "| name | ns |", "| --- | --: |", "| a | 1.5 |", "| long | 200.0 |"]
    assert list(table.markdown()) == expected


@pytest.mark.usefixtures("small_mesh")
def test_the_readme_is_rewritten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    copy = tmp_path / "README.md"
    shutil.copy(ROOT / "README.md", copy)
    for _ in range(2):  # the second time over the first
        assert main(["bench", "base", *SMALL_BASE, "--scenes=museum", "--markdown", "--readme", str(copy)]) == 0
    text, before = copy.read_text(), (ROOT / "README.md").read_text()
    start, end = "<!-- bench base -->\n", "<!-- /bench base -->"
    assert text.partition(start)[0] == before.partition(start)[0]
    assert text.partition(end)[2] == before.partition(end)[2]
    block = text.partition(start)[2].partition(end)[0]
    assert block.strip("\n") in capsys.readouterr().out
    assert block.count("\n| museum |") == 3
    with pytest.raises(ValueError, match="has no block from '<!-- bench speed -->'"):
        tables.rewrite_block(copy, "bench speed", [])
    assert "<!-- bench embree -->\n" in before


BAD = [
    (["bench", "base", "--repeat=0"], "--repeat must be >= 1, got 0"),
    (["bench", "base", "--threads=1,x"], "--threads must be numbers in 1..1024 with commas between them, got '1,x'"),
    (["bench", "base", "--scenes=house"], "scenes must be among museum, "),
    (["bench", "base", "--readme=none.md"], "none.md"),
    (["bench", "base", "--json=none/a.json"], "--json: no such folder: 'none'"),
    (["bench", "embree", "--width=3"], "--width cannot be chosen for bench embree"),
]


@pytest.mark.parametrize(("arguments", "words"), BAD, ids=[" ".join(arguments) for arguments, _ in BAD])
def test_bad_arguments(
    arguments: list[str],
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err


def test_what_is_missing_beside_embree_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def no_module(name: str) -> Any:
        raise ImportError(name)

    monkeypatch.setattr(embree.importlib, "import_module", no_module)
    monkeypatch.setattr(workloads, "mesh_scene", lambda *_: rb.Scene())
    monkeypatch.delenv("RAYBOUND_BENCH", raising=False)
    assert main(["bench", "embree", *SMALL]) == 2
    error = capsys.readouterr().err
    assert "balls_s4 (RAYBOUND_BENCH is not set to the folder of embree_whitted.cpp)" in error
    assert "mesh (embreex is missing: pip install 'raybound[bench]')" in error
    monkeypatch.setenv("RAYBOUND_BENCH", str(tmp_path))
    with pytest.raises(workloads.UnavailableError, match="has no embree_whitted"):
        yardstick.build(tmp_path)
    (tmp_path / "embree_whitted.cpp").write_text("#include <embree3/no_such_header.h>\n")
    with pytest.raises(workloads.UnavailableError, match="Embree 3 is missing: libembree-dev"):
        yardstick.build(tmp_path)


def test_one_core_is_kept_and_given_back() -> None:
    if not hasattr(os, "sched_setaffinity"):
        pytest.skip("this system has no affinities")
    before = os.sched_getaffinity(0)
    with yardstick.pinned() as core:
        assert os.sched_getaffinity(0) == {core}
    assert os.sched_getaffinity(0) == before


SIDE = {"rays": {"eye": 4, "shadow": 2, "reflected": 1, "refracted": 0}, "rays_per_second": 2e6}


def test_tables_beside_embree() -> None:
    sides = {"embree": {**SIDE, "ns_per_primary_ray": 100.0}, "raybound": {**SIDE, "ns_per_primary_ray": 50.0}}
    found = {"seconds_to_build": 1.0, "ns_per_ray": 500.0, "hits": 7}
    mesh = {"triangles": 50, "rays": 9, "embreex": "4", "embree": found, "raybound": found, "ratio": 1.0}
    scenes = {name: {**sides, "ratio": 1.0} for name in embree.NAMES}
    result = {"repeat": 3, "scenes": scenes, "mesh": {**mesh, "overhead_ns": 80.0}}
    first, primary, second = embree.tables(result)
    assert [row[0] for row in first.rows] == list(embree.NAMES)
    assert first.rows[0][1:] == ["7", "7", "2.00", "2.00", "1.00"]
    assert primary.rows[0] == ["balls_s4", "100.0", "50.0", "2.00"]
    assert [row[0] for row in second.rows] == ["embree", "raybound"]
    assert all(len(row) == len(table.columns) for table in (first, primary, second) for row in table.rows)
