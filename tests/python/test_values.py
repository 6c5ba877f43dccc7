"""Shapes, materials, lights, cameras, transforms and tolerances are immutable values."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from tests.python.samples import CAMERA, CORNERS, TEXELS, TEXTURED, TILT, VALUES

import raybound as rb

NAMES = {name: getattr(rb, name) for name in rb.__all__}
EVERY = {**VALUES, **TEXTURED}
# One changed argument of each, which must make the value another one.
CHANGES: dict[str, dict[str, Any]] = {
    "Sphere": {"radius": 0.4},
    "Box": {"max": (1, 3, 4)},
    "Cylinder": {"top": (1, 2, 4)},
    "Cone": {"top_radius": 0.2},
    "Disk": {"normal": (1, 2, 4)},
    "Polygon": {"vertices": [*CORNERS[:3], (0, 0.5, 0)]},
    "Quadric": {"clip": rb.Box((-1, -1, -0.7), (1, 1, 0.8))},
    "Union": {"shapes": (rb.Sphere(),)},
    "Intersection": {"shapes": (rb.Sphere(), rb.Sphere((0, 0, 1)))},
    "Transformed": {"transform": rb.Transform.scale(2)},
    "Nested": {"shapes": [rb.Cone()]},
    "DirectionalLight": {"radiance": 2},
    "PointLight": {"falloff": False},
    "SpotLight": {"cutoff": 13},
    "Material plain": {"diffuse": 0.1},
    "Material rgb": {"ior": 1.4},
    "Material scalar": {"transmit": 0.1},
    "Material textured": {"diffuse": rb.Texture(TEXELS + 1)},
    "Camera": {"eye": (0, -7, 3)},
    "Tolerance zero": {"relative": 0.1},
    "Tolerance some": {"absolute": 0.2},
    "Tolerance none": {"relative": 0},
    "Transform": {"matrix": np.eye(4)},
    "identity": {"matrix": 2 * np.eye(4) - np.diag([0, 0, 0, 1.0])},
    "Texture": {"wrap": "clamp"},
}


@pytest.mark.parametrize("name", VALUES)
def test_repr_is_an_expression(name: str) -> None:
    assert eval(repr(VALUES[name]), dict(NAMES)) == VALUES[name]


def test_repr_leaves_out_defaults_and_has_float32_digits() -> None:
    assert repr(rb.Sphere()) == "Sphere()"
    assert repr(rb.Sphere((0, 0, 0.1))) == "Sphere(center=(0.0, 0.0, 0.1))"
    assert repr(rb.Material(0.1, reflect=0.2)) == "Material(diffuse=0.1, reflect=0.2)"
    assert repr(rb.Tolerance(0.1)) == "Tolerance(0.1)"
    assert repr(rb.Transform()) == "Transform()"
    assert repr(rb.Sphere() | rb.Box()) == "Union(Sphere(), Box())"


def test_repr_of_a_texture_from_an_array_is_short() -> None:
    assert repr(rb.Texture(TEXELS)) == "Texture(<array of 2 x 3 texels>)"


@pytest.mark.parametrize("name", EVERY)
def test_pickle_and_copies_are_equal(name: str) -> None:
    value = EVERY[name]
    for again in (pickle.loads(pickle.dumps(value)), copy.copy(value), copy.deepcopy(value), value.replace()):
        assert again == value
        assert hash(again) == hash(value)
        assert type(again) is type(value)
        assert (again != value) is False


@pytest.mark.parametrize("name", EVERY)
def test_replace_makes_a_changed_copy(name: str) -> None:
    value = EVERY[name]
    before = pickle.dumps(value)
    changed = value.replace(**CHANGES[name])
    assert type(changed) is type(value)
    assert changed != value
    assert pickle.dumps(value) == before
    (field,) = CHANGES[name]
    if name != "Tolerance none":  # its `absolute` is None only as long as `relative` is
        assert changed.replace(**{field: getattr(value, field)}) == value


def test_every_value_has_a_change() -> None:
    assert CHANGES.keys() == EVERY.keys()


@pytest.mark.parametrize("name", EVERY)
def test_unknown_arguments_of_replace(name: str) -> None:
    with pytest.raises(TypeError, match="colour"):
        EVERY[name].replace(colour=3)


def test_values_of_all_kinds_differ() -> None:
    values = list(EVERY.values())
    for i, a in enumerate(values):
        for j, b in enumerate(values):
            assert (a == b) == (i == j)
    assert len(set(values)) == len(values)
    assert all(value != 3 and value != repr(value) for value in values)


@pytest.mark.parametrize("name", EVERY)
def test_fields_are_read_only(name: str) -> None:
    value = EVERY[name]
    field = next(iter(CHANGES[name]))
    before = repr(value)
    with pytest.raises(AttributeError, match=f"{type(value).__name__}.*{field}.*read-only"):
        setattr(value, field, 3)
    with pytest.raises(AttributeError, match="read-only"):
        delattr(value, field)
    with pytest.raises(AttributeError, match="read-only"):
        value.misspelt = 3
    assert repr(value) == before


@pytest.mark.parametrize("array", [TILT.matrix, rb.Polygon(CORNERS).vertices, rb.Texture(TEXELS).texels])
def test_arrays_are_read_only(array: np.ndarray) -> None:
    with pytest.raises(ValueError, match="read-only"):
        array[0, 0] = 1


def test_the_callers_arrays_are_copied() -> None:
    corners, texels, matrix = np.array(CORNERS, np.float32), TEXELS.astype(np.float32), np.eye(4)
    values = [rb.Polygon(corners), rb.Texture(texels), rb.Transform(matrix)]
    again = [rb.Polygon(corners), rb.Texture(texels), rb.Transform(matrix)]
    for array in (corners, texels, matrix):
        array[:] = 7
    assert values == again


def test_negative_zero_equals_zero() -> None:
    pairs = [
        (rb.Sphere((0.0, 0, 0)), rb.Sphere((-0.0, 0, 0))),
        (rb.Texture(np.zeros((1, 1, 3))), rb.Texture(-np.zeros((1, 1, 3)))),
    ]
    for a, b in pairs:
        assert a == b
        assert hash(a) == hash(b)


def test_scalars_and_triples_stay_as_they_were() -> None:
    material = rb.Material(0.5, (0.5, 0.5, 0.5))
    assert material.diffuse == 0.5
    assert material.specular == (0.5, 0.5, 0.5)
    assert rb.PointLight((0, 0, 0), 2).intensity == (2.0, 2.0, 2.0)


def test_combinations_keep_their_parts() -> None:
    a, b, c = rb.Sphere(), rb.Box(), rb.Cone()
    assert rb.Union(a, b, c).shapes == (a, b, c)
    assert (a | b) == rb.Union(a, b)
    assert (a & b) == rb.Intersection(a, b)
    assert (a & b) != rb.Union(a, b)
    assert a.transformed(TILT).shape == a


def test_bounds_of_shapes() -> None:
    for name, value in VALUES.items():
        if isinstance(value, rb.Shape):
            assert value.bounds.shape == (2, 3), name
            assert value.bounds.dtype == np.float64
            assert (value.bounds[0] <= value.bounds[1]).all()
    assert (rb.Sphere((1, 2, 3), 0.5).bounds == [(0.5, 1.5, 2.5), (1.5, 2.5, 3.5)]).all()
    moved = rb.Box((0, 0, 0), (1, 1, 1)).transformed(rb.Transform.translate(1, 2, 3)).bounds
    np.testing.assert_allclose(moved, [(1, 2, 3), (2, 3, 4)], rtol=1e-6)
    assert (moved[0] <= (1, 2, 3)).all()
    assert (moved[1] >= (2, 3, 4)).all()


def test_tolerances() -> None:
    assert rb.Tolerance(0.1).absolute == 0.1 / 10
    assert rb.Tolerance(0.1, 0.3).absolute == 0.3
    assert rb.Tolerance(0) == rb.Tolerance(0.0, 0)
    assert rb.Tolerance(None).relative is None
    assert rb.Tolerance(None) != rb.Tolerance(0)


def test_orbits_of_a_camera_keep_the_rest() -> None:
    for moved in (CAMERA.orbit(30, 10), CAMERA.dolly(1), CAMERA.pan(1, 2), CAMERA.look(10, -5)):
        assert moved != CAMERA
        assert (moved.fov, moved.width, moved.height) == (CAMERA.fov, CAMERA.width, CAMERA.height)
