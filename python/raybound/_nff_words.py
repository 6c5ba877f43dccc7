"""The words of an NFF file, and errors that say where in it they arose."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NoReturn, TypeVar

T = TypeVar("T")


class Words:
    """The words of a file with their lines, and errors that name both."""

    def __init__(self, path: str, data: bytes) -> None:
        self.path = path
        self.words: list[str] = []
        self.lines: list[int] = []
        text = data.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n")
        for number, line in enumerate(text.split("\n"), 1):
            words = line.partition("#")[0].split()
            self.words += words
            self.lines += [number] * len(words)
        self.last_line = number - text.endswith("\n")
        self.at = self.start = 0  # the next word, and the entity that is being read

    @property
    def entity(self) -> str:
        return self.words[self.start]

    def take(self) -> str | None:
        """The next word; None at the end."""
        self.at += 1
        return self.words[self.at - 1] if self.at <= len(self.words) else None

    def fail(self, message: str, at: int | None = None) -> NoReturn:
        """Raises ValueError for the word at `at` (default: the entity's first)."""
        at = self.start if at is None else at
        line = self.lines[at] if at < len(self.lines) else max(self.last_line, 1)
        raise ValueError(f"load_scene: {self.path!r}, line {line}: {message}")

    def expect(self, what: str, at: int) -> NoReturn:
        """Raises ValueError because the word at `at` is not what it must be."""
        got = repr(self.words[at]) if at < len(self.words) else "the end of the file"
        begun = f" (begun in line {self.lines[self.start]})" if at >= len(self.words) else ""
        self.fail(f"{self.entity}{begun}: {what}, got {got}", at)

    def numbers(self, names: tuple[str, ...]) -> list[float]:
        """As many finite numbers as there are names."""
        end = self.at + len(names)
        try:
            values = [float(word) for word in self.words[self.at : end]]
        except ValueError:
            values = []
        # A sum is finite if all are; Python alone takes underscores in numbers.
        if len(values) < len(names) or not math.isfinite(sum(values)) or "_" in "".join(self.words[self.at : end]):
            self.blame(names)
        self.at = end
        return values

    def blame(self, names: tuple[str, ...]) -> None:
        """Raises ValueError for the first that is not a finite number."""
        for at, name in enumerate(names, self.at):
            word = self.words[at] if at < len(self.words) else ""
            if not is_number(word):
                self.expect(f"{name} must be a number", at)
            if not math.isfinite(float(word)):
                self.expect(f"{name} must be finite", at)

    def whole(self, name: str, least: int) -> int:
        """An integer >= least."""
        word = self.take()
        if word is None or not word.isdecimal() or len(word) > 9 or int(word) < least:
            self.expect(f"{name} must be an integer in {least}..999999999", self.at - 1)
        return int(word)

    def make(self, maker: Callable[..., T], *positional: Any, **named: Any) -> T:
        """`maker(...)`, whose errors say where in the file they arose."""
        try:
            return maker(*positional, **named)
        except ValueError as error:
            self.fail(f"{self.entity}: {error}")
        except ImportError as error:
            where = f"load_scene: {self.path!r}, line {self.lines[self.start]}: {self.entity}"
            raise ImportError(f"{where}: {error}") from None


def is_number(word: str) -> bool:
    """Whether a word is a number, finite or not."""
    try:
        float(word)
    except ValueError:
        return False
    return "_" not in word
