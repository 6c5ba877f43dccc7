"""The examples in docstrings do what they say."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import raybound as rb


def test_examples() -> None:
    tried = 0
    for module in pkgutil.walk_packages(rb.__path__, "raybound."):
        if module.name.rpartition(".")[2] in ("__main__", "_core") or "._cpu" in module.name:
            continue
        found = doctest.testmod(importlib.import_module(module.name), report=True)
        assert found.failed == 0, module.name
        tried += found.attempted
    assert tried >= 5
