"""Progress of long calls."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager

ProgressCall = Callable[[float], object]
Progress = bool | ProgressCall | None


def check(who: str, progress: object) -> None:
    """Raises TypeError if `progress` is not True, False, None or callable."""
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise TypeError(f"{who}: progress must be True, None or a callable progress(fraction), got {progress!r}")


@contextmanager
def reporter(progress: Progress) -> Iterator[ProgressCall | None]:
    """What to call with the fraction done: the caller's function, or one that moves a tqdm bar; None for nothing."""
    if not isinstance(progress, bool):
        yield progress
    elif not progress:
        yield None
    else:
        layout = "{percentage:3.0f}%|{bar}| {elapsed}<{remaining}"
        with importlib.import_module("tqdm.auto").tqdm(total=1.0, bar_format=layout) as bar:
            yield lambda fraction: bar.update(max(0.0, fraction - bar.n))


def part(report: ProgressCall | None, index: int, count: int) -> ProgressCall | None:
    """The reporter of one of `count` equal parts of a call."""
    if report is None:
        return None
    return lambda fraction: report((index + fraction) / count)
