"""Bad shapes and transforms: errors that name the object, the argument and the value."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import raybound as rb

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
BAD_RADII = [0, -1.5, float("nan"), float("inf"), -float("inf"), 1e30, 1e39, 1e-40, 1e-300]
SIZED: dict[str, Callable[[Any], rb.Shape]] = {
    "Sphere": lambda r: rb.Sphere((0, 0, 0), r),
    "Cylinder": lambda r: rb.Cylinder((0, 0, 0), (0, 0, 1), radius=r),
    "Cone": lambda r: rb.Cone((0, 0, 0), (0, 0, 1), radius=r),
    "Disk": lambda r: rb.Disk((0, 0, 0), (0, 0, 1), radius=r),
}


def refused(make: Callable[[], Any], *parts: str, kind: type[Exception] = ValueError) -> str:
    with pytest.raises(kind) as caught:
        make()
    message = str(caught.value)
    for part in parts:
        assert part in message, message
    return message


@pytest.mark.parametrize("name", SIZED)
@pytest.mark.parametrize("radius", BAD_RADII)
def test_radii(name: str, radius: float) -> None:
    message = refused(lambda: SIZED[name](radius), f"{name}: radius must")
    shown = message.split("got ")[1]
    float_shown = float(shown.split()[0])
    assert float_shown == pytest.approx(radius, rel=1e-6, abs=2e-45, nan_ok=True), message


@pytest.mark.parametrize("name", SIZED)
@pytest.mark.parametrize("radius", ["1", None, True, 1j, (1, 2)])
def test_radii_of_wrong_types(name: str, radius: Any) -> None:
    refused(lambda: SIZED[name](radius), f"{name}: radius", kind=(TypeError, ValueError))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("make", "argument"),
    [
        (lambda v: rb.Sphere(v, 1), "Sphere: center"),
        (lambda v: rb.Box(v, (9, 9, 9)), "Box: min"),
        (lambda v: rb.Box((-9, -9, -9), v), "Box: max"),
        (lambda v: rb.Cylinder(v, (5, 5, 5)), "Cylinder: base"),
        (lambda v: rb.Cylinder((5, 5, 5), v), "Cylinder: top"),
        (lambda v: rb.Cone(v, (5, 5, 5)), "Cone: base"),
        (lambda v: rb.Cone((5, 5, 5), v), "Cone: apex"),
        (lambda v: rb.Disk(v, (0, 0, 1)), "Disk: center"),
        (lambda v: rb.Disk((0, 0, 0), v), "Disk: normal"),
    ],
)
def test_vectors(make: Callable[[Any], rb.Shape], argument: str) -> None:
    for bad in (
        (0, float("nan"), 0),
        (float("inf"), 0, 0),
        (0, 0, 1e30),
        (0, 0, -1e39),
        (1, 2),
        (1, 2, 3, 4),
        5,
        [[1, 2, 3]],
    ):
        refused(lambda b=bad: make(b), argument)
    for bad in ("abc", None, (True, False, True), (1j, 0, 0), {1, 2, 3}):
        refused(lambda b=bad: make(b), argument, kind=TypeError)


@pytest.mark.parametrize(
    ("make", "parts"),
    [
        (lambda: rb.Box((0, 0, 0), (1, 1, 0)), ("Box: max must be greater than min", "(1, 1, 0)")),
        (lambda: rb.Box((0, 2, 0), (1, 1, 1)), ("Box: max must be greater than min", "(0, 2, 0)")),
        (lambda: rb.Box((1e9, 0, 0), (1e9 + 1, 1, 1)), ("Box: max must be greater than min",)),
        (lambda: rb.Cylinder((1, 2, 3), (1, 2, 3)), ("Cylinder: base and top must differ", "(1, 2, 3)")),
        (lambda: rb.Cone((1, 2, 3), (1, 2, 3)), ("Cone: base and apex must differ", "(1, 2, 3)")),
        (lambda: rb.Cone(top_radius=-1), ("Cone: top_radius must be >= 0", "-1")),
        (lambda: rb.Cone(top_radius=1e30), ("Cone: top_radius must", "e+30")),
        (lambda: rb.Cone(top_radius=float("nan")), ("Cone: top_radius must be finite", "nan")),
        (lambda: rb.Disk(normal=(0, 0, 0)), ("Disk: normal must", "(0, 0, 0)")),
    ],
)
def test_arguments_that_do_not_fit_together(make: Callable[[], rb.Shape], parts: tuple[str, ...]) -> None:
    refused(make, *parts)


@pytest.mark.parametrize(
    ("vertices", "what"),
    [
        ([(0, 0, 0), (1, 0, 0)], "at least 3"),
        ([(0, 0, 0), (1, 1, 1), (2, 2, 2)], "collinear"),
        ([(0, 0, 0), (0, 0, 0), (0, 0, 0)], "collinear"),
        ([(0, 0, 0), (4, 0, 0), (1, 1, 0), (0, 4, 0)], "convex"),
        ([(0, 0, 0), (1, 0, 0), (1, 1, 0.01), (0, 1, 0)], "planar"),
        ([(0, 0, 0), (1, 0, 0), (1, 0, 0), (0, 1, 0)], "coincide"),
        ([(np.cos(i * 4 * np.pi / 5), np.sin(i * 4 * np.pi / 5), 0) for i in range(5)], "Polygon: vertices must"),
        ([(0, 0, 0), (1, 1, 0), (1, 0, 0), (0, 1, 0)], "Polygon: vertices must"),
        ([(0, 0, float("nan")), (1, 0, 0), (0, 1, 0)], "finite"),
        ([(0, 0, 1e30), (1, 0, 0), (0, 1, 0)], "2**60"),
        (np.zeros((3, 2)), "shape"),
        (np.zeros(9), "shape"),
        (np.zeros((1, 4, 3)), "shape"),
        ([], "Polygon: vertices"),
    ],
)
def test_polygons(vertices: Any, what: str) -> None:
    refused(lambda: rb.Polygon(vertices), "Polygon: vertices", what)


def test_polygons_of_wrong_types() -> None:
    for bad in (
        None,
        "square",
        np.array(SQUARE, bool),
        np.array(SQUARE, complex),
        np.array(SQUARE, object),
        np.array(SQUARE, str),
    ):
        refused(lambda b=bad: rb.Polygon(b), "Polygon: vertices", kind=TypeError)


@pytest.mark.parametrize("dtype", [np.int8, np.uint16, np.int64, np.float16, np.float32, np.float64, np.longdouble])
def test_any_number_type_and_any_strides_will_do(dtype: type) -> None:
    plain = rb.Polygon(SQUARE)
    wide = np.zeros((8, 6), dtype)
    wide[::2, ::2] = np.array(SQUARE, dtype)
    for vertices in (np.array(SQUARE, dtype), np.asfortranarray(np.array(SQUARE, dtype)), wide[::2, ::2]):
        assert rb.Polygon(vertices) == plain
    assert rb.Polygon(np.array(SQUARE, dtype)[::-1]) == rb.Polygon(SQUARE[::-1])


@pytest.mark.parametrize("operation", [rb.Union, rb.Intersection, rb.Difference])
def test_combinations(operation: type) -> None:
    name = operation.__name__
    refused(lambda: operation(), name)
    for sheet in (rb.Disk(), rb.Polygon(SQUARE), rb.Disk().transformed(rb.Transform.scale(2))):
        refused(lambda s=sheet: operation(rb.Sphere(), s), name, "solid", "1")
        refused(lambda s=sheet: operation(s, rb.Sphere()), name, "solid", "0")
    for bad in (None, 5, "sphere", [rb.Sphere()]):
        refused(lambda b=bad: operation(rb.Sphere(), b), name, "shape 1", kind=TypeError)
    refused(lambda: rb.Sphere() | rb.Disk(), "Union")
    with pytest.raises(TypeError):
        rb.Sphere() | 5


def test_disjoint_intersections() -> None:
    refused(lambda: rb.Intersection(rb.Sphere(), rb.Sphere((5, 0, 0))), "Intersection", "overlap")
    refused(
        lambda: rb.Box((0, 0, 0), (1, 1, 1)) & rb.Box((0, 0, 2), (1, 1, 3)) & rb.Sphere(), "Intersection", "overlap"
    )


@pytest.mark.parametrize(
    "matrix",
    [
        np.zeros((4, 4)),
        np.diag([1, 1, 0, 1]),
        np.diag([1, 1, 1, 2]),
        np.diag([1, 1, 1, 0]),
        np.array([[1, 2, 3, 0], [2, 4, 6, 0], [0, 0, 1, 0], [0, 0, 0, 1]]),
        np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1e-3, 1]]),
        np.full((4, 4), np.nan),
        np.diag([np.inf, 1, 1, 1]),
        np.diag([1e39, 1, 1, 1]),
        np.eye(3),
        np.eye(4)[:3],
    ],
)
def test_matrices(matrix: np.ndarray) -> None:
    refused(lambda: rb.Transform(matrix), "Transform: matrix must")


def test_transforms_of_wrong_types() -> None:
    for bad in ("eye", np.eye(4, dtype=bool), np.eye(4, dtype=complex), object()):
        refused(lambda b=bad: rb.Transform(b), "Transform: matrix", kind=TypeError)
    refused(lambda: rb.Transform.scale(0), "Transform.scale", "got 0")
    refused(lambda: rb.Transform.scale((1, 0, 1)), "Transform.scale")
    refused(lambda: rb.Transform.scale((1, 2)), "Transform.scale: s")
    refused(lambda: rb.Transform.rotate(30, (0, 0, 0)), "Transform.rotate", "axis")
    refused(lambda: rb.Transform.rotate(float("nan")), "Transform.rotate: degrees", "nan")
    refused(lambda: rb.Transform.translate(0, float("inf"), 0), "Transform.translate: y", "inf")
    refused(lambda: rb.Sphere().transformed(np.eye(4)), "transformed: t", kind=TypeError)
    refused(lambda: rb.Sphere().transformed(None), "transformed: t", kind=TypeError)


def test_vertices_that_a_transform_makes_one_are_refused() -> None:
    """Numbers cannot hold a unit square at 1e17: not as an object's shape, and not with rays."""
    far = rb.Transform.translate(1e17, 0, 0)
    scene = rb.Scene()
    refused(lambda: scene.add(rb.Polygon(SQUARE).transformed(far), rb.Material()), "Polygon")
    refused(lambda: scene.add(rb.Polygon(SQUARE), rb.Material(), transform=far), "Polygon")
    assert len(scene) == 0
    refused(lambda: rb.intersect(rb.Polygon(SQUARE).transformed(far), [(0, 0, 0)], [(1, 0, 0)]), "Polygon")


@pytest.mark.parametrize(
    ("origins", "directions", "parts"),
    [
        ([(0, 0, 0)], [(0, 0, 0)], ("intersect: directions must be non-zero", "index 0")),
        ([(0, 0, 0)] * 2, [(0, 0, 1)] * 3, ("intersect: origins and directions must broadcast", "(2, 3)", "(3, 3)")),
        ([(0, 0, float("nan"))], [(0, 0, 1)], ("intersect: origins must be finite", "nan")),
        ([(0, 0, 0)], [(0, 0, 1e39)], ("intersect: directions must", "e+39")),
        ((0, 0), (0, 0, 1), ("intersect: origins", "shape (..., 3)", "(2,)")),
        (np.zeros((2, 2)), np.ones((2, 2)), ("intersect: origins", "(2, 2)")),
    ],
)
def test_rays(origins: Any, directions: Any, parts: tuple[str, ...]) -> None:
    refused(lambda: rb.intersect(rb.Sphere(), origins, directions), *parts)


def test_options_of_intersect() -> None:
    ray = ([(0, 0, 5)], [(0, 0, -1)])
    refused(lambda: rb.intersect("sphere", *ray), "intersect: shape", kind=TypeError)
    refused(lambda: rb.intersect(rb.Sphere(), *ray, precision="half"), "intersect: precision", "half")
    refused(lambda: rb.intersect(rb.Sphere(), *ray, offsets="none"), "intersect: offsets", "none")
    refused(lambda: rb.intersect(rb.Sphere(), *ray, precision=32), "intersect: precision", kind=TypeError)
    with pytest.raises(TypeError):
        rb.intersect(rb.Sphere(), *ray, "float64")  # type: ignore[misc]
    assert len(rb.intersect(rb.Sphere(), np.zeros((0, 3)), np.zeros((0, 3)))) == 0
