"""`python -m raybound bench numbers`: what is measured, tables, JSON, the block in the README. No times are judged."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from raybound import _core
from raybound.bench import numbers
from raybound.cli import main

ROOT = Path(__file__).resolve().parents[2]
KEYS = {"ns", "plain_ns", "ratio", "least", "most", "wanted"}


def kinds(result: dict[str, Any]) -> dict[str, dict[str, float]]:
    return {**result["multiply_add"], **result["cell"]}


def test_json_tables_and_readme(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, readme = tmp_path / "bench.json", tmp_path / "README.md"
    shutil.copy(ROOT / "README.md", readme)
    assert main(["bench", "numbers", "--repeat=2", "--json", str(out), "--readme", str(readme)]) == 0
    text, result = capsys.readouterr().out, json.loads(out.read_text())
    assert result["repeat"] == 2
    assert set(result["multiply_add"]) | set(result["left_out"]) == {numbers.PLAIN, *numbers.INTERVALS}
    assert set(result["cell"]) == set(numbers.MODELS)
    for kind, found in kinds(result).items():
        assert set(found) == KEYS
        assert found["wanted"] == numbers.WANTED.get(kind)
        assert 0 < found["least"] <= found["ratio"] <= found["most"]
        assert found["ns"] > 0
        assert found["plain_ns"] > 0
    plain = result["multiply_add"][numbers.PLAIN]
    assert plain["least"] == plain["most"] == 1
    for title in ("A multiply-add, medians of 2 runs", "Ward shading of a sphere's cell"):
        assert text.count(title) == readme.read_text().count(title) == 1


def test_what_the_machine_lacks_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def without_hardware(kind: str, n: int, repeats: int) -> float:
        if kind == "interval hardware":
            raise ValueError("time_multiply_add: kind must be ...")
        return 1.0 if kind == numbers.PLAIN else 3.0

    monkeypatch.setattr(_core, "time_multiply_add", without_hardware)
    monkeypatch.setattr(_core, "cell_times", lambda n, rounds: (2.0, 2.0 * n))
    result = numbers.measure(repeat=3)
    assert result["left_out"] == {"interval hardware": "compiled without AVX-512"}
    assert {kind: found["ratio"] for kind, found in kinds(result).items()} == {
        numbers.PLAIN: 1,
        "interval portable": 3,
        "interval best": 3,
        "interval array": 3,
        "TaylorModel<2>": 2,
        "TaylorModel<4>": 4,
    }
    intervals, cells = numbers.tables(result)
    assert intervals.rows[1][1:] == ["3.00", "3.00", "3.00", "3.00", "12"]
    assert cells.rows[1] == ["TaylorModel<4>", "2", "8.00", "4.00", "4.00", "4.00", "16"]


@pytest.mark.parametrize(("option", "value"), [("scenes", "museum"), ("threads", "2"), ("rays", "5")])
def test_options_of_other_benches(option: str, value: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "numbers", f"--{option}={value}"]) == 2
    assert f"--{option} cannot be chosen for bench numbers: it draws nothing" in capsys.readouterr().err
