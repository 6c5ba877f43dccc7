"""What `threads=0` stands for: the processors that the process is bound to, as far as its control group grants them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import raybound as rb
from raybound import _core

THREADS_USED = """
import os
import sys
os.sched_setaffinity(0, {int(sys.argv[1])})
import raybound as rb
from raybound import _core
scene = rb.scenes.three_spheres()
scene.camera = scene.camera.replace(width=128, height=96)
frames = [rb.render(scene, method=method) for method in ("base", "exact")]
print(_core.build_info()["usable_threads"], *(frame.stats["threads"] for frame in frames))
"""


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="only Linux binds processes to processors so")
def test_a_process_bound_to_one_processor_uses_one_thread() -> None:
    one = str(min(os.sched_getaffinity(0)))
    run = subprocess.run([sys.executable, "-c", THREADS_USED, one], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["1", "1", "1"]


def test_no_more_threads_are_used_than_the_process_is_bound_to() -> None:
    bound = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    assert 1 <= _core.build_info()["usable_threads"] <= bound
    assert rb.report()["usable_threads"] == _core.build_info()["usable_threads"]


def write(folder: Path, **files: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name.replace("__", ".")).write_text(text)


@pytest.mark.parametrize(
    ("text", "granted"),
    [
        ("max 100000\n", None),
        ("150000 100000\n", 1.5),
        ("50000 100000", 0.5),
        ("", None),
        ("100000", None),
        ("0 100000\n", None),
        ("-1 100000\n", None),
        ("100000 0\n", None),
        ("10x 100\n", None),
        ("nonsense\n", None),
    ],
)
def test_the_quota_of_version_2(tmp_path: Path, text: str, granted: float | None) -> None:
    write(tmp_path / "jobs" / "mine", cpu__max=text)
    assert _core.granted_processors("0::/jobs/mine\n", str(tmp_path)) == granted


@pytest.mark.parametrize(
    ("quota", "period", "granted"),
    [("-1\n", "100000\n", None), ("250000\n", "100000\n", 2.5), ("25000\n", "50000", 0.5), ("", "100000", None)],
)
@pytest.mark.parametrize("controllers", ["cpu", "cpu,cpuacct", "cpuacct,cpu"])
def test_the_quota_of_version_1(
    tmp_path: Path, controllers: str, quota: str, period: str, granted: float | None
) -> None:
    write(tmp_path / controllers / "docker" / "abc", cpu__cfs_quota_us=quota, cpu__cfs_period_us=period)
    memberships = f"11:memory:/docker/abc\n4:{controllers}:/docker/abc\n1:name=systemd:/\n0::/\n"
    assert _core.granted_processors(memberships, str(tmp_path)) == granted


def test_the_least_of_a_group_and_those_above_it_counts(tmp_path: Path) -> None:
    write(tmp_path / "a", cpu__max="300000 100000")
    write(tmp_path / "a" / "b", cpu__max="max 100000")
    write(tmp_path / "a" / "b" / "c", cpu__max="400000 100000")
    for group, granted in (("/a/b/c", 3.0), ("/a/b", 3.0), ("/", None), ("/a/b/c/gone", 3.0), ("/elsewhere", None)):
        assert _core.granted_processors(f"0::{group}\n", str(tmp_path)) == granted
    write(tmp_path, cpu__max="50000 100000")  # in a container: its own group, though the path is the host's
    assert _core.granted_processors("0::/elsewhere\n", str(tmp_path)) == 0.5


def test_both_versions_side_by_side(tmp_path: Path) -> None:
    write(tmp_path / "unified" / "x", cpu__max="150000 100000")
    write(tmp_path / "cpu" / "x", cpu__cfs_quota_us="125000", cpu__cfs_period_us="100000")
    assert _core.granted_processors("3:cpu:/x\n0::/x\n", str(tmp_path)) == 1.25
    assert _core.granted_processors("3:cpuset:/x\n0::/x\n", str(tmp_path)) == 1.5
    assert _core.granted_processors("", str(tmp_path)) is None
    assert _core.granted_processors("nonsense\n:::\n7\n", str(tmp_path)) is None
