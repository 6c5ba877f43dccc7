"""The yardstick: a minimal Whitted tracer over Embree 3, built from one C++ file and run on one core."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .workloads import UnavailableError

VARIABLE = "RAYBOUND_BENCH"
SOURCE = "embree_whitted.cpp"
WIDTH, HEIGHT, DEPTH = 1200, 900, 5  # fixed in the source
FLAGS = ("-O3", "-march=native", "-std=c++20")


def build(folder: Path) -> Path:
    """Compiles the yardstick into `folder`. UnavailableError without its source, a compiler or Embree."""
    where = os.environ.get(VARIABLE)
    if not where:
        raise UnavailableError(f"{VARIABLE} is not set to the folder of {SOURCE}")
    source = Path(where, SOURCE)
    if not source.is_file():
        raise UnavailableError(f"{VARIABLE} has no {SOURCE}")
    compiler = shutil.which(os.environ.get("CXX") or "g++")
    if compiler is None:
        raise UnavailableError("there is no C++ compiler")
    program = folder / "embree_whitted"
    command = [compiler, *FLAGS, str(source), "-lembree3", "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        missing = "embree3" in done.stderr
        raise UnavailableError("Embree 3 is missing: libembree-dev" if missing else f"{SOURCE} does not compile")
    return program


def run(program: Path, scene: Path, frames: int) -> dict[str, Any]:
    """What the yardstick measures on an NFF file: its line of JSON, of the best of some frames."""
    done = subprocess.run([program, scene, str(frames)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise UnavailableError(f"the yardstick ended with exit code {done.returncode}")
    measured: dict[str, Any] = json.loads(done.stdout)
    return measured


@contextmanager
def pinned() -> Iterator[int | None]:
    """Keeps this thread, and what it starts, on one core; yields its number, or None where that is impossible."""
    if not hasattr(os, "sched_setaffinity"):
        yield None
        return
    before = os.sched_getaffinity(0)
    core = max(before)
    os.sched_setaffinity(0, {core})
    try:
        yield core
    finally:
        os.sched_setaffinity(0, before)
