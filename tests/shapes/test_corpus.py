"""Failures of the past (tests/corpus/shapes.json), played again."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.support_hits import UNIT, Tally, check_hit
from tests.support.support_oracle import build, first_hit

import raybound as rb

CASES = json.loads((Path(__file__).parent.parent / "corpus" / "shapes.json").read_text())
FIELDS = ("t", "t_error", "point", "point_error", "normal", "uv", "next_origin")


def shape_of(case: dict[str, Any]) -> rb.Shape:
    """`repr` of a shape is a valid expression; nothing but the package's names is in reach."""
    names = {
        name: getattr(rb, name)
        for name in (
            "Sphere",
            "Box",
            "Cylinder",
            "Cone",
            "Disk",
            "Polygon",
            "Mesh",
            "Quadric",
            "Union",
            "Intersection",
            "Transform",
        )
    }
    return eval(case["shape"], {"__builtins__": {}}, names)


@pytest.mark.parametrize("case", CASES, ids=[c["why"] for c in CASES])
def test_past_failure(case: dict[str, Any]) -> None:
    shape = shape_of(case)
    low, high = shape.bounds
    assert (low <= high).all()
    origin, direction = np.float32(case["origin"]), np.float32(case["direction"])
    answer = rb.intersect(shape, [origin], [direction])[0]
    for name in FIELDS:
        assert not np.isnan(answer[name]).any(), name
    assert answer["hit"] or case["expect"] == "clean"
    if case["expect"] == "exact t":
        found = first_hit(build(shape), origin, direction)
        assert found is not None
        assert abs(float(found.t) - answer["t"]) <= answer["t_error"] * (1 + 1e-12)
    if case["expect"] == "normal +z":
        assert answer["normal"].tolist() == [0, 0, 1]
    if answer["hit"]:
        assert (answer["point"] >= low - 8 * UNIT * np.abs(shape.bounds).max()).all()
        assert (answer["point"] <= high + 8 * UNIT * np.abs(shape.bounds).max()).all()
        assert answer["uv"].min() >= 0
        assert answer["uv"].max() <= 1
    if case["expect"] == "clean hit":
        tally = Tally()
        check_hit(tally, build(shape), origin, direction, answer, shape)
        assert not tally.failures, str(tally)
        assert np.dot(answer["normal"], direction) < 0
        size = np.ptp(shape.bounds, axis=0).max()
        assert answer["point_error"].max() <= max(0.6 * size, 8 * UNIT * np.abs(shape.bounds).max())
