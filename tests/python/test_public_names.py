"""The names that users import, their documentation, and float utilities and intersections as functions."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np
import pytest

import raybound as rb

NAMES = """
    Sphere Box Cylinder Cone Disk Polygon Quadric Mesh Union Intersection Difference Shape Transform Material Texture
    DirectionalLight PointLight SpotLight Scene Object LightHandle load_scene load_mesh Camera Renderer Tolerance render
    Frame Path RayKind Reason Verdict next_float_up next_float_down gamma epsilon float_bits float_from_bits
    spawn_origin intersect testing report plot scenes TraceResult Interval RunningError LinearInterval TaylorModel abs
    acos asin atan cos exp fma log maximum minimum power quadratic reciprocal rsqrt sin sqrt square tan ward_lobe
    __version__
""".split()  # noqa: SIM905  a page of names reads better than a list of strings


def test_all_names_are_there() -> None:
    assert sorted(rb.__all__) == sorted(NAMES)
    assert all(hasattr(rb, name) for name in NAMES)
    for owner, names in {
        rb.scenes: ["museum", "three_spheres", "sphereflake", "walkthrough", "hard_case"],
        rb.plot: ["path_map", "reason_map", "error_map", "cells", "linetree"],
        rb.testing: ["assert_within_bound"],
    }.items():
        assert all(callable(getattr(owner, name)) for name in names)


def test_paths_and_reasons_have_the_numbers_that_arrays_hold() -> None:
    paths = "TRACED PARTIAL EXACT INTERPOLATED REPROJECTED EXTRAPOLATED BACKGROUND"
    reasons = "NONE SILHOUETTE OCCLUDER SHADOW SELF_SHADOW REFLECTION REFRACTION TIR ERROR_BOUND COST UNSUPPORTED"
    assert " ".join(path.name for path in sorted(rb.Path)) == paths
    assert " ".join(reason.name for reason in sorted(rb.Reason)) == reasons
    assert [*rb.Path] == list(range(7))
    assert [*rb.Reason] == list(range(11))


def test_everything_public_is_documented() -> None:
    count = 0
    for name in NAMES:
        thing = getattr(rb, name)
        if name == "__version__":
            continue
        assert thing.__doc__, name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                is_ours = inspect.isfunction(value) or isinstance(value, (property, classmethod, staticmethod))
                if is_ours and not member.startswith("_"):
                    count += 1
                    assert inspect.getdoc(getattr(thing, member)), f"{name}.{member}"
    assert count > 50


def test_nothing_names_the_raw_module() -> None:
    for name in NAMES:
        module = getattr(getattr(rb, name), "__module__", "raybound")
        assert "_core" not in module


def test_next_floats() -> None:
    assert rb.next_float_up(1.0) == 1 + 2**-52
    assert type(rb.next_float_up(1.0)) is float
    assert type(rb.next_float_up(1)) is float
    assert rb.next_float_up(np.float32(1)) == np.float32(1 + 2**-23)
    assert type(rb.next_float_down(np.float32(1))) is np.float32
    for dtype in (np.float32, np.float64):
        x = np.array([[0, -0.0, 1, -1, 1e-40, np.finfo(dtype).max, np.inf, -np.inf]], dtype).T[::-1]
        with np.errstate(over="ignore", under="ignore"):
            up, down = np.nextafter(x, dtype(np.inf)), np.nextafter(x, dtype(-np.inf))
        assert (rb.next_float_up(x) == up).all()
        assert (rb.next_float_down(x) == down).all()
        assert rb.next_float_up(x).dtype == dtype
        assert rb.next_float_up(x).shape == x.shape
    assert np.isnan(rb.next_float_up(np.nan))
    for bad in ("a", None, True, 1j):
        with pytest.raises(TypeError, match="next_float_up: x must be a number or an array of numbers"):
            rb.next_float_up(bad)


def test_gamma() -> None:
    for dtype, unit in ((np.float32, 2.0**-24), (np.float64, 2.0**-53)):
        n = np.array([1, 2, 7, 1000])
        exact = n * unit / (1 - n * unit)
        assert (rb.gamma(n, dtype) >= exact).all()
        np.testing.assert_allclose(rb.gamma(n, dtype), exact, rtol=2e-7)
        assert rb.gamma(n, dtype).dtype == dtype
    assert rb.gamma(3).dtype == np.float32
    assert 0 <= rb.gamma(0) < 1e-44
    cases: list[tuple[Any, type[Exception], str]] = [
        (-1, ValueError, r"n must be an integer in 0\.\.16777215, got -1"),
        (2**24, ValueError, "got 16777216"),
        (1.5, TypeError, "n must be an integer"),
        ("a", TypeError, "n must be an integer"),
        (True, TypeError, "n must be an integer"),
    ]
    for bad, error, words in cases:
        with pytest.raises(error, match=f"gamma: .*{words}"):
            rb.gamma(bad)
    with pytest.raises(TypeError, match="gamma: dtype must be float32 or float64, got int32"):
        rb.gamma(1, np.int32)


def test_spawned_origins_leave_their_box() -> None:
    p, e, n = np.array([[1, 2, 3.0]] * 2), np.full((2, 3), 1e-5), np.array([[0, 0, 1.0]] * 2)
    found = rb.spawn_origin(p, e, n, [(0, 0, 1), (1, 0, -1)])
    assert found.shape == (2, 3)
    assert found.dtype == np.float32
    assert found[0, 2] > 3 + 1e-5
    assert found[1, 2] < 3 - 1e-5
    assert (found[:, :2] == (1, 2)).all()
    assert (rb.spawn_origin(p[0], e[0], n[0], (0, 0, 1)) == found[0]).all()
    with pytest.raises(ValueError, match="spawn_origin: p_error must be >= 0"):
        rb.spawn_origin(p, -e, n, n)
    with pytest.raises(ValueError, match="spawn_origin: w must have the shape of p"):
        rb.spawn_origin(p, e, n, n[:1])
    with pytest.raises(ValueError, match="spawn_origin: n must be an array of numbers with shape"):
        rb.spawn_origin(p, e, n[0], n)


def test_intersections_with_one_shape() -> None:
    origins, directions = [(0, 0, 5), (3, 0, 5)], [(0, 0, -2), (0, 0, -1)]
    for precision in ("float32", "float64"):
        for offsets in ("bounded", "epsilon", "scaled-epsilon", "whole-epsilon"):
            found = rb.intersect(rb.Sphere(), origins, directions, precision=precision, offsets=offsets)
            assert found["hit"].tolist() == [True, False]
            assert found["t"][0] == pytest.approx(2)
            assert found["next_origin"][0, 2] > 1
    names = ("hit", "t", "t_error", "point", "point_error", "normal", "uv", "face_id", "next_origin")
    assert set(found.dtype.names or ()) == set(names)
    with pytest.raises(ValueError, match="intersect: precision must be one of 'float32', 'float64', got 'float16'"):
        rb.intersect(rb.Sphere(), origins, directions, precision="float16")
    names = "'bounded', 'epsilon', 'scaled-epsilon', 'whole-epsilon', got 'none'"
    with pytest.raises(ValueError, match=f"intersect: offsets must be one of {names}"):
        rb.intersect(rb.Sphere(), origins, directions, offsets="none")
    with pytest.raises(TypeError, match="intersect: shape must be a Shape, got 3"):
        rb.intersect(3, origins, directions)
    with pytest.raises(TypeError, match="positional"):
        rb.intersect(rb.Sphere(), origins, directions, "float32")
