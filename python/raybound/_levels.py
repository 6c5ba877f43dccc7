"""Chooses the build of the C++ module: the best installed one that this CPU can run. Imported before all others.

A local build has one module, `_core`, for the machine it was made on ("native"). A wheel for x86-64 has `_core_v2`,
`_core_v3` and `_core_v4`, the same sources for three instruction levels, of which one is imported and becomes
`raybound._core`. All give the same bytes. The environment variable RAYBOUND_LEVEL names one to use instead of the best.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from collections.abc import Sequence

PACKAGE = __name__.rpartition(".")[0]
NATIVE = "native"
MODULES = {
    "x86-64-v4": "_core_v4",
    "x86-64-v3": "_core_v3",
    "x86-64-v2": "_core_v2",
    NATIVE: "_core",
}
VARIABLE = "RAYBOUND_LEVEL"


def choose(installed: Sequence[str], supported: Sequence[str], wanted: str) -> str:
    """The level to use: `wanted`, or the first of `installed` that is `supported` if that is empty.

    Raises ImportError if `wanted` is unknown, not installed or not supported, or if there is no choice at all.
    """
    usable = [level for level in installed if level in supported]
    if not wanted:
        if usable:
            return usable[0]
        needs = f"the package is built for {', '.join(installed)}" if installed else "the C++ module is not installed"
        raise ImportError(f"raybound: {needs}, and this CPU supports {', '.join(supported)}")
    if wanted in usable:
        return wanted
    if wanted not in MODULES:
        fault = f"must be one of {', '.join(MODULES)}"
    elif wanted not in installed:
        fault = "names an instruction level that is not installed"
    else:
        fault = "names an instruction level that this CPU does not support"
    raise ImportError(f"raybound: {VARIABLE} {fault}, got {wanted!r}; usable here: {', '.join(usable) or 'none'}")


def _installed() -> list[str]:
    """The levels whose modules are there, the best first."""
    return [level for level, name in MODULES.items() if importlib.util.find_spec(f"{PACKAGE}.{name}") is not None]


def _supported(installed: Sequence[str]) -> list[str]:
    """The levels that this CPU can run; a native build is taken at its word."""
    if list(installed) in ([], [NATIVE]):
        return [NATIVE]
    levels: list[str] = importlib.import_module(f"{PACKAGE}._cpu").supported_levels()
    return [*levels, NATIVE]


def _load(level: str) -> None:
    """Imports a level's module as `raybound._core`."""
    module = importlib.import_module(f"{PACKAGE}.{MODULES[level]}")
    sys.modules[f"{PACKAGE}._core"] = module
    setattr(sys.modules[PACKAGE], "_core", module)  # noqa: B010  `from . import _core` reads it


_found = _installed()
_runs = _supported(_found)
LEVEL = choose(_found, _runs, os.environ.get(VARIABLE, ""))
"""The instruction level in use."""
AVAILABLE = tuple(level for level in _found if level in _runs)
"""The installed levels that this CPU can run, the best first."""
_load(LEVEL)
