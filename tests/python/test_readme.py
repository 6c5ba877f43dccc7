"""The script in the README makes the picture that is shown beside it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import raybound as rb

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_script_makes_its_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scripts = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
    assert len(scripts) == 1
    assert len(scripts[0].splitlines()) == 10
    monkeypatch.chdir(tmp_path)
    exec(compile(scripts[0], "README.md", "exec"), {})
    made, shown = (
        rb.Texture(folder / "three_spheres.png").texels for folder in (tmp_path, ROOT / "notebooks/pictures")
    )
    assert made.shape == shown.shape
    assert np.abs(made - shown).mean() < 0.002


def test_what_the_readme_points_to_exists() -> None:
    links = re.findall(r"\]\(([^)#:]+)\)", TEXT)
    assert len(links) >= 5
    for link in links:
        assert (ROOT / link).exists(), link
    for picture in (ROOT / "notebooks" / "pictures").iterdir():
        assert picture.stat().st_size < 600_000
        assert f"notebooks/pictures/{picture.name}" in TEXT
