"""What a bug report should say about the machine and the build."""

from __future__ import annotations

import platform

import numpy as np

from . import _core, _levels, images


class Report(dict[str, object]):
    """A dictionary that prints as lines of `key: value`."""

    def __str__(self) -> str:
        return "\n".join(f"{key}: {value}" for key, value in self.items())

    __repr__ = __str__


def report() -> Report:
    """Versions, compiler, instruction level (in use, and all usable here) and threads: for bug reports.

    A dictionary that prints as lines. A wheel holds several levels, of which the environment variable RAYBOUND_LEVEL
    can name one to use instead of the best.
    """
    build = dict(_core.build_info())
    found = Report(raybound=build.pop("version"))
    found.update(
        python=f"{platform.python_implementation()} {platform.python_version()}",
        numpy=np.__version__,
        OpenImageIO=images.version(),
        platform=platform.platform(),
        processor=platform.processor() or platform.machine(),
    )
    found.update(build)
    found["instruction_levels_available"] = ", ".join(_levels.AVAILABLE)
    return found
