"""Check that dependencies point one way: each layer of cpp/raybound uses only itself and the layers before it.

Also: nothing in cpp/raybound knows of Python (pybind11, cpp/bindings), and no file of the package imports from cpp.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

LAYERS = ["numbers", "geometry", "shapes", "scene", "trace", "certify", "interpolants", "edits", "frame"]
INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]+)[>\"]", re.MULTILINE)
CPP_SUFFIXES = {".cpp", ".cc", ".h", ".hpp", ".inl"}


def cpp_faults(root: Path) -> Iterator[str]:
    """Faults in the includes of the engine, as `file:line: what is wrong`."""
    engine = root / "cpp" / "raybound"
    for path in sorted(p for p in engine.rglob("*") if p.suffix in CPP_SUFFIXES):
        layer = path.relative_to(engine).parts[0]
        if layer not in LAYERS:
            yield f"{path.relative_to(root)}:1: is in no layer; the layers are {', '.join(LAYERS)}"
            continue
        text = path.read_text(encoding="utf-8")
        for match in INCLUDE.finditer(text):
            fault = include_fault(layer, match[1])
            if fault:
                line = text.count("\n", 0, match.start(1)) + 1
                yield f'{path.relative_to(root)}:{line}: includes "{match[1]}": {fault}'


def include_fault(layer: str, name: str) -> str | None:
    """What is wrong with a file of `layer` including `name`, if anything."""
    parts = name.split("/")
    if ".." in parts:
        return "includes start at cpp/, without '..'"
    if parts[0] in ("pybind11", "bindings", "cpp") or parts[-1] == "Python.h":
        return "the engine knows nothing of Python or its bindings"
    if parts[0] != "raybound":
        return None
    if parts[1] not in LAYERS:
        return f"{parts[1]} is no layer; the layers are {', '.join(LAYERS)}"
    if LAYERS.index(parts[1]) > LAYERS.index(layer):
        return f"{layer} may not use {parts[1]}, which comes after it"
    return None


def python_faults(root: Path) -> Iterator[str]:
    """Faults in the imports of the package, as `file:line: what is wrong`."""
    for path in sorted((root / "python").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"), filename=str(path))):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module or ""]
            else:
                continue
            for name in names:
                if name.split(".")[0] in ("cpp", "tests"):
                    yield f"{path.relative_to(root)}:{node.lineno}: imports {name}: the package stands without it"


def main() -> int:
    """Print every fault; the exit code is 1 if there is one."""
    root = Path(__file__).resolve().parent.parent
    faults = [*cpp_faults(root), *python_faults(root)]
    for fault in faults:
        print(fault)
    if not faults:
        print("layers: every dependency points to the same or an earlier layer")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
