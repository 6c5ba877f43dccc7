"""Reads test vectors of interval arithmetic in the ITL format (github.com/oheim/ITF1788)."""

import math
import os
import re
from dataclasses import dataclass
from pathlib import Path

Ends = tuple[float, float]
EMPTY: Ends = (math.inf, -math.inf)
ENTIRE: Ends = (-math.inf, math.inf)


@dataclass(frozen=True)
class Case:
    testcase: str
    operation: str
    inputs: tuple[Ends | float | bool, ...]
    outputs: tuple[Ends | float | bool, ...]


def folder() -> Path | None:
    """Where the vectors are: RAYBOUND_DATA/itl, if there."""
    data = os.environ.get("RAYBOUND_DATA")
    path = Path(data) / "itl" if data else None
    return path if path and path.is_dir() else None


def number(text: str) -> float:
    text = text.strip()
    if text in ("infinity", "+infinity"):
        return math.inf
    if text == "-infinity":
        return -math.inf
    return float.fromhex(text) if "0x" in text.lower() else float(text)


def value(text: str) -> Ends | float | bool:
    if text in ("true", "false"):
        return text == "true"
    if not text.startswith("["):
        return number(text)
    inside = text[1:-1].strip()
    if inside == "empty":
        return EMPTY
    if inside == "entire":
        return ENTIRE
    low, _, high = inside.partition(",")
    return number(low), number(high or low)


def cases(path: Path) -> list[Case]:
    """All cases of a file. Raises ValueError for a line that it cannot read."""
    text = re.sub(r"/\*.*?\*/", "", path.read_text(), flags=re.DOTALL)
    text = re.sub(r"//[^\n]*", "", text)
    found = []
    for name, body in re.findall(r"testcase\s+(\S+)\s*\{(.*?)\}", text, flags=re.DOTALL):
        for statement in filter(None, (s.strip() for s in body.split(";"))):
            left, equals, right = statement.partition("=")
            if not equals:
                raise ValueError(f"{path.name}: cannot read '{statement}'")
            operation, _, operands = left.strip().partition(" ")
            tokens = [re.findall(r"\[[^\]]*\]|[^\s\[\]]+", side) for side in (operands, right)]
            found.append(Case(name, operation, *(tuple(map(value, side)) for side in tokens)))
    return found
