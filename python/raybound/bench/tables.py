"""Tables of measurements: aligned text, Markdown, and blocks of a text file that are made anew."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass
class Table:
    """A title, the names of the columns, and rows of text; the first column is aligned to the left."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]

    def text(self) -> Iterator[str]:
        """The lines of the table, in columns."""
        widths = [max(len(row[k]) for row in (self.columns, *self.rows)) for k in range(len(self.columns))]
        yield self.title
        for row in (self.columns, *self.rows):
            yield "  ".join(cell.rjust(width) if k else cell.ljust(width) for k, (cell, width) in _cells(row, widths))

    def markdown(self) -> Iterator[str]:
        """The lines of the table in Markdown, after its title."""
        yield self.title
        yield ""
        yield f"| {' | '.join(self.columns)} |"
        yield f"| {' | '.join('--:' if k else '---' for k in range(len(self.columns)))} |"
        for row in self.rows:
            yield f"| {' | '.join(row)} |"


def _cells(row: Sequence[str], widths: Sequence[int]) -> Iterator[tuple[int, tuple[str, int]]]:
    return enumerate(zip(row, widths, strict=True))


def left_out(reasons: dict[str, str]) -> Iterator[str]:
    """A line for each thing that could not be measured."""
    for name, reason in reasons.items():
        yield f"left out: {name} ({reason})"


def split_block(path: Path, name: str) -> tuple[str, str]:
    """What stands before and after the text between `<!-- name -->` and `<!-- /name -->`, the marks included.

    Raises ValueError if the file has no such block.
    """
    begin, end = f"<!-- {name} -->\n", f"<!-- /{name} -->"
    before, first, rest = path.read_text(encoding="utf-8").partition(begin)
    _, last, after = rest.partition(end)
    if not first or not last:
        raise ValueError(f"{path} has no block from {begin.strip()!r} to {end!r}")
    return before + begin, end + after


def rewrite_block(path: Path, name: str, tables: Sequence[Table]) -> None:
    """Puts tables in Markdown into a block of a file, in place of what is there; see `split_block`."""
    before, after = split_block(path, name)
    body = "\n\n".join("\n".join(table.markdown()) for table in tables)
    path.write_text(f"{before}{body}\n{after}", encoding="utf-8")
