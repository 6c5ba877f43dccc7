"""Check the stub of the extension module against the module: by mypy's stubtest, and argument names by docstrings.

stubtest is mypy's own, less one complaint that no stub can meet: pybind11's metaclass has no importable name. It
cannot see the arguments of pybind11's functions either, so these are read from the signatures that pybind11 writes at
the top of each docstring.
"""

from __future__ import annotations

import ast
import importlib
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parent.parent
MODULE = "raybound._core"
STUB = ROOT / "python" / "raybound" / "_core.pyi"
IMPOSSIBLE = re.compile(r"metaclass differs|^Found \d+ error")

Signature = tuple[str, ...]


def stubtest_faults() -> list[str]:
    """What stubtest finds, one a line."""
    command = [sys.executable, "-m", "mypy.stubtest", MODULE, "--concise", "--mypy-config-file", "pyproject.toml"]
    command += ["--allowlist", ".ci/stubtest-allowlist.txt", "--ignore-unused-allowlist"]
    environment = {**os.environ, "MYPYPATH": str(ROOT / "python")}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    lines = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
    if done.returncode == 0:
        return []
    if not lines:
        return [f"stubtest failed with exit code {done.returncode}"]
    return [line for line in lines if not IMPOSSIBLE.search(line)]


def argument_names(function: ast.FunctionDef, method: bool) -> Signature:
    """The names by which a function can be called; those that begin with '_' or are positional-only count as '_'."""
    a = function.args
    names = ["_" for _ in a.posonlyargs] + [x.arg for x in a.args]
    if method and names:
        names = names[1:]
    names += ["*"] if a.vararg else []
    names += [x.arg for x in a.kwonlyargs]
    names += ["**"] if a.kwarg else []
    # pybind11 calls nameless arguments arg0, arg1, ...: they can only be given by position.
    return tuple("_" if re.fullmatch(r"_.*|arg\d+", name) else name for name in names)


def runtime_signatures(function: object, name: str, method: bool) -> set[Signature] | None:
    """The signatures in a pybind11 docstring, or None where there are none that can be read."""
    doc = getattr(function, "__doc__", None) or ""
    lines = re.findall(rf"^(?:\d+\. )?({re.escape(name)}\(.*\) -> .*)$", doc, re.MULTILINE)
    if not doc.startswith((f"{name}(",)):
        return None
    overloaded = [line for line in lines if not line.startswith(f"{name}(*args, **kwargs)")]
    lines = overloaded if "Overloaded function." in doc else lines[:1]
    found = set()
    for line in lines:
        # Defaults may print as anything: `radius: float = <object at ...>`.
        text = re.sub(r"<[^<>]*>", "None", line)
        try:
            tree = ast.parse(f"def {text}: ...").body[0]
        except SyntaxError:
            return None
        assert isinstance(tree, ast.FunctionDef)
        found.add(argument_names(tree, method))
    return found or None


def stub_signatures(body: list[ast.stmt], in_class: bool) -> dict[str, tuple[set[Signature], int]]:
    """The functions of a module's or class's body: name to signatures and line. Properties are left out."""
    functions: dict[str, tuple[set[Signature], int]] = {}
    for node in body:
        if isinstance(node, ast.FunctionDef):
            marks = {ast.unparse(d).split(".")[-1] for d in node.decorator_list}
            if marks & {"property", "setter"}:
                continue
            method = in_class and "staticmethod" not in marks
            functions.setdefault(node.name, (set(), node.lineno))[0].add(argument_names(node, method))
    return functions


def name_faults(owner: ModuleType | type, body: list[ast.stmt], where: str, checked: list[str]) -> Iterator[str]:
    """Functions whose argument names differ between stub and docstring; all that were compared go to `checked`."""
    in_class = isinstance(owner, type)
    for node in body:
        if isinstance(node, ast.ClassDef) and hasattr(owner, node.name):
            yield from name_faults(getattr(owner, node.name), node.body, f"{where}.{node.name}", checked)
    for name, (stub, line) in stub_signatures(body, in_class).items():
        method = in_class and not isinstance(vars(owner).get(name), staticmethod)
        found = runtime_signatures(getattr(owner, name, None), name, method)
        if found is None:
            continue
        checked.append(f"{where}.{name}")
        if found != stub:
            shown = [" or ".join(sorted(f"({', '.join(s)})" for s in group)) for group in (stub, found)]
            path = STUB.relative_to(ROOT)
            yield f"{path}:{line}: {where}.{name}: the arguments are {shown[0]} in the stub, {shown[1]} in the module"


def main() -> int:
    """Print every fault; the exit code is 1 if there is one."""
    faults = stubtest_faults()
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    checked: list[str] = []
    faults += name_faults(importlib.import_module(MODULE), tree.body, MODULE, checked)
    for fault in faults:
        print(fault)
    if not faults:
        print(f"stub: agrees with {MODULE}; argument names of {len(checked)} functions checked")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
