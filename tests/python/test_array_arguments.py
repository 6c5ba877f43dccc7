"""Arrays of any float or integer dtype and any strides are accepted; scene inputs are rounded to float32 once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.python.samples import CORNERS, ball_scene, small_scene

import raybound as rb

DTYPES = [
    np.float16,
    np.float32,
    np.float64,
    np.longdouble,
    np.int8,
    np.int32,
    np.int64,
    np.uint8,
    np.uint64,
    ">f4",
    ">i2",
]


def layouts(array: np.ndarray) -> dict[str, np.ndarray]:
    """The same values with other strides."""
    wide = np.zeros((*array.shape[:-1], 2 * array.shape[-1]), array.dtype)
    wide[..., ::2] = array
    unaligned = np.zeros(array.nbytes + 1, np.uint8)[1:].view(array.dtype).reshape(array.shape)
    unaligned[...] = array
    read_only = array.copy()
    read_only.flags.writeable = False
    return {
        "C": np.ascontiguousarray(array),
        "Fortran": np.asfortranarray(array),
        "strided": wide[..., ::2],
        "reversed": np.ascontiguousarray(array[::-1])[::-1],
        "unaligned": unaligned,
        "read-only": read_only,
        "repeated": np.broadcast_to(array, array.shape),
    }


MAKERS: dict[str, tuple[Any, np.ndarray]] = {
    "Sphere": (rb.Sphere, np.array([1, 2, 3])),
    "Polygon": (rb.Polygon, np.array(CORNERS)),
    "Quadric": (rb.Quadric, np.array([1, 2, 3, 4, 5, 6, 7, 8, 9, 1])),
    "Transform": (rb.Transform, np.array([[2, 0, 0, 1], [0, 2, 0, 1], [0, 1, 2, 1], [0, 0, 0, 1]])),
    "scale": (rb.Transform.scale, np.array([1, 2, 3])),
    "Material": (rb.Material, np.array([1, 2, 3])),
    "PointLight": (rb.PointLight, np.array([1, 2, 3])),
    "Camera": (lambda eye: rb.Camera(eye, (0, 0, 0)), np.array([1, 2, 3])),
    "Scene": (rb.Scene, np.array([1, 2, 3])),
}


@pytest.mark.parametrize("dtype", DTYPES, ids=str)
@pytest.mark.parametrize("name", MAKERS)
def test_dtypes(name: str, dtype: Any) -> None:
    make, values = MAKERS[name]
    assert make(values.astype(dtype)) == make(values.tolist())


@pytest.mark.parametrize("name", MAKERS)
def test_strides(name: str) -> None:
    make, values = MAKERS[name]
    for layout, array in layouts(values.astype(np.float64)).items():
        assert make(array) == make(values.tolist()), layout
    for layout, array in layouts(values.astype(np.float32)).items():
        assert make(array) == make(values.tolist()), layout


@pytest.mark.parametrize("dtype", [bool, complex, "S1", "U1", "M8[s]", "m8[s]", object])
def test_dtypes_that_are_no_numbers(dtype: Any) -> None:
    with pytest.raises(TypeError, match="Sphere: center must be an array of numbers"):
        rb.Sphere(np.ones(3, dtype=object).astype(dtype))


def test_scalars_of_numpy() -> None:
    assert rb.Sphere(radius=np.float64(2)) == rb.Sphere(radius=np.int8(2)) == rb.Sphere(radius=np.array(2.0))
    assert rb.Camera((1, 0, 0), (0, 0, 0), width=np.int16(7)).width == 7
    assert rb.PointLight((0, 0, 0), falloff=np.bool_(True)).falloff is True
    assert rb.Material(np.float32(0.5)).diffuse == 0.5
    for field in (rb.Sphere(radius=np.float64(2)).radius, rb.Camera((1, 0, 0), (0, 0, 0), fov=np.float64(9)).fov):
        assert type(field) is float


def test_inputs_are_rounded_to_float32_once_and_read_back_rounded() -> None:
    odd = 1 + 2**-24 + 2**-50  # a double rounding by way of another format could go down
    up = float(np.float32(odd))
    assert up == 1 + 2**-23
    assert rb.Sphere((odd, 0.1, 0), odd).center == (up, float(np.float32(0.1)), 0)
    assert rb.Sphere((odd, 0.1, 0), odd).radius == up
    assert rb.Material(odd).diffuse == up
    assert rb.PointLight((0, 0, 0), odd).intensity == (up,) * 3
    assert rb.Camera((odd, 0, 0), (0, 0, 0), fov=odd).fov == up
    assert rb.Scene(odd).ambient == (up,) * 3
    assert rb.Polygon([(0, 0, 0), (odd, 0, 0), (0, odd, 0)]).vertices[1, 0] == np.float32(up)
    assert rb.Texture(np.full((1, 1, 3), odd)).texels[0, 0, 0] == np.float32(up)


def test_transforms_stay_double_until_a_shape_or_a_scene_takes_them() -> None:
    rng = np.random.default_rng(5)
    for _ in range(50):
        matrix = np.vstack([rng.normal(size=(3, 4)), [0, 0, 0, 1]])
        rounded = matrix.astype(np.float32).astype(np.float64)
        transform = rb.Transform(matrix)
        assert (transform.matrix == matrix).all()
        assert (rb.Sphere().transformed(transform).transform.matrix == rounded).all()
        ball = rb.Scene().add(rb.Sphere(), rb.Material(), transform=transform)
        assert (ball.transform.matrix == rounded).all()
        ball.transform = rb.Transform()
        ball.transform = transform
        assert (ball.transform.matrix == rounded).all()


def test_queries_take_any_layout_and_return_contiguous_arrays() -> None:
    scene = small_scene()
    rng = np.random.default_rng(2)
    origins = rng.integers(-20, 20, (800, 3)) + np.array([0, -40, 0])
    directions = rng.integers((-12, -1, 0), (12, 1, 3), (800, 3)) - origins
    expected = scene.intersect(origins, directions)
    blocked = scene.occluded(origins, origins + directions)
    assert 20 < expected["hit"].sum() < 780
    assert 10 < blocked.sum() < 780
    for dtype in (np.float16, np.float32, np.float64, np.int16):
        pairs = zip(layouts(origins.astype(dtype)).values(), layouts(directions.astype(dtype)).values(), strict=True)
        for o, d in pairs:
            found = scene.intersect(o, d)
            assert (found == expected).all()
            assert found.flags.c_contiguous
            assert (scene.occluded(o, o + d) == blocked).all()
    assert (scene.intersect(origins.tolist(), directions.tolist()) == expected).all()


def test_results_are_the_callers_to_keep() -> None:
    scene = ball_scene()
    rays = scene.camera.rays() if scene.camera else ()
    for make in (
        lambda: scene.intersect([(0, -5, 1)], [(0, 1, 0)]),
        lambda: scene.occluded([(0, -5, 1)], [(0, 5, 1)]),
        lambda: scene.bounds,
        lambda: scene["ball"].bounds,
        lambda: rb.Sphere().bounds,
        lambda: scene.camera.rays()[1] if scene.camera else None,
        lambda: rb.next_float_up(np.ones(3)),
    ):
        first: Any = make()
        assert first.flags.c_contiguous
        assert first.flags.writeable
        kept = first.copy()
        first[...] = np.zeros_like(first)
        assert (make() == kept).all()
    assert len(rays) == 2


@pytest.mark.parametrize(
    ("origins", "directions", "words"),
    [
        ((0, 0), (0, 0, 1), r"origins must be an array of numbers with shape \(..., 3\), got shape \(2,\)"),
        (0, (0, 0, 1), r"origins must be an array of numbers with shape \(..., 3\), got shape \(\)"),
        ([(0, 0, 0)] * 3, [(0, 0, 1)] * 2, r"origins and directions must broadcast, got shapes \(3, 3\) and \(2, 3\)"),
        ([(0, 0, 0)], [(0, 0, 0)], r"directions must be non-zero, got \(0.0, 0.0, 0.0\) at index 0"),
        ([(0, 0, np.nan)], [(0, 0, 1)], r"origins must be finite, got nan at index \(0, 2\)"),
        ([(0, 0, 0)], [(0, 0, 1e39)], r"directions must fit in float32 .* got 1e\+39 at index \(0, 2\)"),
    ],
)
def test_bad_rays(origins: Any, directions: Any, words: str) -> None:
    scene = rb.Scene()
    for name, call in (
        ("Scene.intersect", scene.intersect),
        ("Renderer.trace", rb.Renderer(scene).trace),
        ("intersect", lambda o, d: rb.intersect(rb.Sphere(), o, d)),
    ):
        with pytest.raises(ValueError, match=f"{name}: {words}"):
            call(origins, directions)


def test_no_rays_at_all() -> None:
    none = np.zeros((0, 3))
    scene = ball_scene()
    assert scene.intersect(none, none).shape == (0,)
    assert scene.occluded(none, none).shape == (0,)
    assert rb.Renderer(scene).trace(none, none).radiance.shape == (0, 3)
    assert rb.intersect(rb.Sphere(), none, none).shape == (0,)
