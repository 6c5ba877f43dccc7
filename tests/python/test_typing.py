"""The script that `make lint` type-checks runs, and the package says that it is typed."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.python import typed_script

import raybound as rb


def test_the_typed_script_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    frame = typed_script.main(tmp_path)
    assert frame.image.shape == (24, 32, 3)
    assert "pixel (16, 12) shows" in capsys.readouterr().out
    assert {path.name for path in tmp_path.iterdir()} == {"scene.json", "frame.png", "map.png"}


def test_the_package_is_marked_as_typed() -> None:
    assert Path(rb.__file__).with_name("py.typed").exists()
