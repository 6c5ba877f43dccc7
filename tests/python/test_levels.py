"""Instruction levels: how one is chosen, and that all give the same bytes."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import raybound as rb
from raybound import _levels

ROOT = Path(__file__).resolve().parents[2]
ALL = ("x86-64-v4", "x86-64-v3", "x86-64-v2")


def run(*arguments: str, level: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "RAYBOUND_LEVEL": level}
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300, check=False)


@pytest.mark.parametrize(
    ("installed", "supported", "wanted", "chosen"),
    [
        (ALL, ALL, "", "x86-64-v4"),
        (ALL, ALL[1:], "", "x86-64-v3"),
        (ALL, ALL, "x86-64-v2", "x86-64-v2"),
        (["native"], ["native"], "", "native"),
        (["native"], ["native"], "native", "native"),
        (ALL[2:], ALL, "", "x86-64-v2"),
    ],
)
def test_the_best_usable_level_is_chosen(installed: list[str], supported: list[str], wanted: str, chosen: str) -> None:
    assert _levels.choose(installed, supported, wanted) == chosen


@pytest.mark.parametrize(
    ("installed", "supported", "wanted", "words"),
    [
        (ALL, ALL[1:], "x86-64-v4", "names an instruction level that this CPU does not support, got 'x86-64-v4'"),
        (ALL[1:], ALL, "x86-64-v4", "names an instruction level that is not installed, got 'x86-64-v4'; usable here:"),
        (ALL, ALL, "v9", "RAYBOUND_LEVEL must be one of x86-64-v4, x86-64-v3, x86-64-v2, native, got 'v9'"),
        (ALL, ["native"], "", "the package is built for x86-64-v4, x86-64-v3, x86-64-v2, and this CPU supports native"),
        ([], ["native"], "", "the C\\+\\+ module is not installed"),
    ],
)
def test_a_level_that_cannot_be_used(installed: list[str], supported: list[str], wanted: str, words: str) -> None:
    with pytest.raises(ImportError, match=words):
        _levels.choose(installed, supported, wanted)


def test_the_variable_is_read_at_import() -> None:
    done = run("-c", "import raybound", level="none")
    assert done.returncode != 0
    assert "RAYBOUND_LEVEL must be one of" in done.stderr
    done = run("-c", "import raybound; print(raybound.report()['instruction_level'])", level=_levels.AVAILABLE[-1])
    assert done.returncode == 0, done.stderr
    if len(_levels.AVAILABLE) > 1:
        assert done.stdout.strip() == _levels.AVAILABLE[-1]


def test_the_report_tells_the_level() -> None:
    report = rb.report()
    assert report["instruction_levels_available"] == ", ".join(_levels.AVAILABLE)
    assert _levels.LEVEL in _levels.AVAILABLE


def test_the_module_has_one_name_at_every_level() -> None:
    core = sys.modules["raybound._core"]
    assert core is rb._core
    assert core.__name__ == core.Shape.__module__ == "raybound._core"
    assert pickle.loads(pickle.dumps(core.Snapshot)) is core.Snapshot


def test_all_levels_give_the_same_bytes(tmp_path: Path) -> None:
    if len(_levels.AVAILABLE) < 2:
        pytest.skip(f"only the level {_levels.LEVEL} is usable here; `make levels` builds and compares all")
    results = {}
    for level in _levels.AVAILABLE:
        out = tmp_path / f"{level}.npz"
        done = run("-m", "tests.support.support_levels", str(out), level=level)
        assert done.returncode == 0, done.stderr
        results[level] = np.load(out)
        assert results[level]["level"] == level
    first = results[_levels.AVAILABLE[0]]
    names = [name for name in first.files if name != "level"]
    assert len(names) == 9 * 7
    hits = np.sum([first[name] for name in names if name.endswith("number of hits")], axis=0)
    assert (hits > (200_000, 40_000)).all(), hits
    for level, other in results.items():
        different = [name for name in names if first[name].tobytes() != other[name].tobytes()]
        assert not different, f"{level} differs from {_levels.AVAILABLE[0]} in {different}"
