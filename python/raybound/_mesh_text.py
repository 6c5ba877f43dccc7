"""Checks of mesh files that are text, before a library reads them: errors name the line, and nothing gets lost unsaid.

Each function returns the text in the one form that every reader takes alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NoReturn


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """The lines that are not empty, with their numbers, as words."""
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split()
        if words:
            yield number, words


def _fail(line: int, message: str) -> NoReturn:
    raise ValueError(f"line {line}: {message}")


def _numbers(line: int, what: str, words: list[str], least: int) -> None:
    """The words must be finite numbers, `least` or more."""
    if len(words) < least:
        _fail(line, f"{what} must have {least} numbers, got {len(words)}")
    if not _are_finite(words):
        culprit = next(word for word in words if not _are_finite([word]))
        _fail(line, f"{what} must have finite numbers, got {culprit!r}")


def _are_finite(words: list[str]) -> bool:
    try:
        return all(map(math.isfinite, map(float, words))) and "_" not in "".join(words)
    except ValueError:
        return False


# Wavefront OBJ

_KINDS = {"v": "vertex", "vt": "texture coordinate", "vn": "normal"}
_LEAST = {"v": 3, "vt": 2, "vn": 3}


def checked_obj(text: str) -> tuple[str, bool]:
    """An OBJ file's vertices and faces, and whether some but not all corners have texture coordinates or normals.

    Indices are made absolute; colours, materials, groups, lines and points are left out.
    """
    counts = dict.fromkeys(_KINDS, 0)
    corners = _Corners(counts)
    result: list[str] = []
    for line, (key, *words) in _lines(_joined(text)):
        words = words[: words.index("#")] if "#" in words else words
        if key in _KINDS:
            _numbers(line, key, words, _LEAST[key])
            counts[key] += 1
            result.append(f"{key} {' '.join(words[: _LEAST[key]])}")
        elif key == "f":
            if len(words) < 3:
                _fail(line, f"f must have at least 3 corners, got {len(words)}")
            known = corners.known
            result.append("f " + " ".join([known.get(word) or corners.read(line, word) for word in words]))
    corners.check_range()
    return "\n".join(result) + "\n", corners.mixed


def _joined(text: str) -> str:
    """The text with continued lines joined, keeping the number of each line's start."""
    if "\\\n" not in text.replace("\r\n", "\n"):
        return text
    lines = text.splitlines()
    for i in range(len(lines) - 1, 0, -1):
        if lines[i - 1].endswith("\\"):
            lines[i - 1] = lines[i - 1][:-1] + " " + lines[i]
            lines[i] = ""
    return "\n".join(lines)


class _Corners:
    """The corners of faces, such as 3/1/2 or -1//-1, with absolute indices."""

    def __init__(self, counts: dict[str, int]) -> None:
        self.counts = counts  # of each kind, so far
        self.known: dict[str, str] = {}  # corners that mean the same wherever they stand
        self.highest = dict.fromkeys(_KINDS, (0, 0))  # an index and its line: faces may precede what they refer to
        self.forms: set[tuple[bool, bool]] = set()  # with texture coordinates, with normals

    def read(self, line: int, word: str) -> str:
        parts = word.split("/")
        if len(parts) > 3 or not parts[0]:
            _fail(line, f"a corner of f must be v, v/vt, v//vn or v/vt/vn, got {word!r}")
        found = [self.index(line, word, kind, part) if part else "" for kind, part in zip(_KINDS, parts, strict=False)]
        self.forms.add((len(found) > 1 and found[1] != "", len(found) > 2 and found[2] != ""))
        result = "/".join(found).rstrip("/")
        if "-" not in word:
            self.known[word] = result
        return result

    def index(self, line: int, word: str, kind: str, part: str) -> str:
        index = int(part) if part.removeprefix("-").isdecimal() else 0
        absolute = index if index > 0 else self.counts[kind] + 1 + index
        if index == 0 or absolute < 1:
            _fail(line, f"a corner of f must have indices from 1, or from -1 back to the first, got {word!r}")
        if absolute > self.highest[kind][0]:
            self.highest[kind] = (absolute, line)
        return str(absolute)

    def check_range(self) -> None:
        for kind, (index, line) in self.highest.items():
            if index > self.counts[kind]:
                _fail(line, f"f refers to {_KINDS[kind]} {index}, but the file has {self.counts[kind]}")

    @property
    def mixed(self) -> bool:
        return any(len({form[kind] for form in self.forms}) > 1 for kind in (0, 1))


# STL

_STL_ORDER = {  # what may come before each keyword
    "facet": ("solid", "endfacet"),
    "outer": ("facet",),
    "vertex": ("outer", "vertex"),
    "endloop": ("vertex",),
    "endfacet": ("endloop",),
    "endsolid": ("solid", "endfacet"),
    "solid": ("", "endsolid"),
}


def checked_stl(text: str) -> str:
    """All triangles of an ASCII STL file as one solid."""
    before, corners, line = "", 0, 0
    result: list[str] = []
    for line, (key, *words) in _lines(text):
        key = key.lower()
        if before not in _STL_ORDER.get(key, ()):
            _fail(line, f"{' or '.join(k for k, v in _STL_ORDER.items() if before in v)} must follow, got {key!r}")
        corners = corners + 1 if key == "vertex" else 0 if key == "facet" else corners
        if corners > 3 or (key == "endloop" and corners < 3):
            _fail(line, f"a facet must have 3 vertices, got {corners}{' or more' * (corners > 3)}")
        if key == "vertex":
            _numbers(line, "vertex", words, 3)
            result.append(f"vertex {' '.join(words[:3])}")
        before = key
    if before != "endsolid":
        _fail(max(line, 1), "the file must go on to endsolid, got its end")
    return "\n".join(["solid mesh", *result, "endsolid mesh"]) + "\n"


# PLY


def checked_ply(text: str) -> str:
    """An ASCII PLY file without empty lines, its rows checked against the header."""
    _check_rows(_lines(text))
    return "\n".join(" ".join(words) for _, words in _lines(text)) + "\n"


def _check_rows(lines: Iterator[tuple[int, list[str]]]) -> None:
    elements: list[tuple[str, int, list[bool]]] = []  # name, rows, and for each property whether it is a list
    line, last = 1, "ply"
    for line, words in lines:
        last = words[0]
        if last == "end_header":
            break
        if last == "element":
            if len(words) != 3 or not words[2].isdecimal():
                _fail(line, f"element must have a name and a count, got {' '.join(words[1:])!r}")
            elements.append((words[1], int(words[2]), []))
        elif last == "property":
            if not elements:
                _fail(line, "property must follow an element, got none")
            elements[-1][2].append(words[1:2] == ["list"])
    if last != "end_header":
        _fail(line, "the header must go on to end_header, got the end of the file")
    for name, count, properties in elements:
        for row in range(count):
            line, words = next(lines, (line, []))
            if not words:
                _fail(line, f"element {name!r} must have {count} rows, got {row}")
            _check_row(line, name, words, properties)


def _check_row(line: int, name: str, words: list[str], properties: list[bool]) -> None:
    """A row must have a number for each property, or a count and as many for a list."""
    _numbers(line, name, words, 1)
    at = 0
    for is_list in properties:
        length = 1
        if is_list and at < len(words):
            if not words[at].isdecimal():
                _fail(line, f"a list of {name} must start with its length, got {words[at]!r}")
            length += int(words[at])
        at += length
    if at != len(words):
        _fail(line, f"{name} must have {at} numbers, got {len(words)}")
