"""The first script in the README makes the picture that is shown beside it; the others say what they do."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import raybound as rb

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
SCRIPTS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


def test_the_script_makes_its_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(SCRIPTS) == 3
    assert len(SCRIPTS[0].splitlines()) == 10
    monkeypatch.chdir(tmp_path)
    exec(compile(SCRIPTS[0], "README.md", "exec"), {})
    made, shown = (
        rb.Texture(folder / "three_spheres.png").texels for folder in (tmp_path, ROOT / "notebooks/pictures")
    )
    assert made.shape == shown.shape
    assert np.abs(made - shown).mean() < 0.002


def test_the_lens_brings_light_together() -> None:
    names = {"rb": rb}
    exec(compile(SCRIPTS[1], "README.md", "exec"), names)
    last: np.ndarray = names["last"]  # type: ignore[assignment]
    assert last["ray"].tolist() == [0, 1]
    axis = last["origin"][:, 0] - last["origin"][:, 2] * last["point"][:, 0] / last["point"][:, 2]
    assert np.ptp(axis) < 0.2  # spherical aberration
    assert (np.abs(axis - 2) < 0.7).all()  # about R / (n - 1) = 4 behind the curved side


def test_the_function_is_bounded_over_its_cell() -> None:
    names = {"rb": rb}
    exec(compile(SCRIPTS[2], "README.md", "exec"), names)
    cosine: rb.TaylorModel = names["cosine"]
    x, y = np.meshgrid(np.linspace(0.28, 0.32, 9), np.linspace(0.18, 0.22, 9))
    values = 0.6 / np.sqrt((x - 0.1) ** 2 + y**2 + 0.36)
    assert all(value in cosine.range() for value in values.ravel())
    assert cosine.range().wid < 1.1 * np.ptp(values)
    assert cosine.remainder < 0.1 * cosine.interpolation_bound() < 1e-4


def test_what_the_readme_points_to_exists() -> None:
    links = re.findall(r"\]\(([^)#:]+)\)", TEXT)
    assert len(links) >= 5
    for link in links:
        assert (ROOT / link).exists(), link
    for picture in (ROOT / "notebooks" / "pictures").iterdir():
        assert picture.stat().st_size < 600_000
        assert f"notebooks/pictures/{picture.name}" in TEXT
