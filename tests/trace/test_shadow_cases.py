"""Shadows where things touch: lights on surfaces, contact, coincident faces, closed rooms, glass."""

import math

import numpy as np
import pytest
from tests.support.support_light import f32, floor, radiance, random_units, unit

import raybound as rb

N = 3000
WHITE = rb.Material(1.0)


def scene_of(*shapes: rb.Shape, light: object, material: rb.Material = WHITE) -> rb.Scene:
    scene = rb.Scene()
    for shape in shapes:
        scene.add(shape, material)
    scene.add_light(light)
    return scene


def spread(rng: np.random.Generator, z: float, reach: float = 4.0) -> np.ndarray:
    return np.column_stack([rng.uniform(-reach, reach, (N, 2)), np.full(N, z)])


@pytest.mark.parametrize(
    "sheet",
    [
        rb.Disk((0, 0, 0), (0, 0, 1), radius=2.0),
        rb.Disk((0, 0, 0), (0, 0, -1), radius=2.0),
        floor(half=2.0),
        rb.Disk((0.2, -0.1, 0), (0, 0, 1), radius=0.7),
    ],
    ids=["disk", "disk upside down", "polygon", "small disk"],
)
@pytest.mark.parametrize("at", [(0, 0, 0), (0.3, -0.2, 0), (1 / 3, 0.1, 0)])
def test_a_light_exactly_on_a_sheet_shines_on_both_sides(sheet: rb.Shape, at: tuple) -> None:
    scene = scene_of(sheet, floor(-1.0), floor(1.0), light=rb.PointLight(at))
    rng = np.random.default_rng(50)
    for z, direction in ((0.999, (0, 0, 1)), (-0.999, (0, 0, -1))):
        shown = radiance(scene, spread(rng, z), direction)
        assert (shown > 0).all()


@pytest.mark.parametrize(
    ("solid", "at"),
    [
        (rb.Sphere((0, 0, 0), 1.0), (0, 0, 1)),
        (rb.Sphere((0, 0, 0), 1.0), (0.6, 0, 0.8)),
        (rb.Box((-1, -1, -1), (1, 1, 1)), (0.3, 0.2, 1)),
        (rb.Cylinder((0, 0, -1), (0, 0, 1), radius=1.0), (0.3, 0.2, 1)),
        (rb.Sphere((0, 0, 0), 0.5) | rb.Box((-1, -1, -1), (1, 1, 1)), (0.3, 0.2, 1)),
    ],
    ids=["pole", "flank", "box", "cap", "union"],
)
def test_a_light_exactly_on_a_solid_shines_outward(solid: rb.Shape, at: tuple) -> None:
    """Where the light is on the surface up to the rounding of its position, what it faces outside is lit."""
    scene = scene_of(solid, floor(3.0), light=rb.PointLight(at))
    points = spread(np.random.default_rng(51), 2.99)
    normal = unit(at) if isinstance(solid, rb.Sphere) else np.array([0, 0, 1.0])
    faced = (points - f32(at)) @ normal > 0.05
    assert faced.sum() > N / 4
    assert (radiance(scene, points, (0, 0, 1))[faced] > 0).all()


def test_a_light_on_the_top_of_a_box_lights_the_inside_too() -> None:
    scene = scene_of(rb.Box((-1, -1, -1), (1, 1, 1)), light=rb.PointLight((0.25, 0.5, 1)))
    directions = random_units(np.random.default_rng(52), N)
    hits = scene.intersect(np.zeros((N, 3)), f32(directions))
    shown = radiance(scene, (0, 0, 0), directions)
    assert (shown[hits["face_id"] != 5] > 0).all()
    assert (hits["face_id"] != 5).sum() > N / 2


@pytest.mark.parametrize(
    "room",
    [
        rb.Sphere((0, 0, 0), 1.0),
        rb.Box((-1, -1, -1), (1, 1, 1)),
        rb.Cylinder((0, 0, -1), (0, 0, 1), radius=1.0),
        rb.Cone((0, 0, -1), (0, 0, 2), radius=1.5),
        rb.Sphere((0, 0, 0), 1.0) | rb.Box((-0.9, -0.9, -0.9), (0.9, 0.9, 0.9)),
        rb.Box((-1, -1, -1), (1, 1, 1)).transformed(rb.Transform.rotate(30, axis=(1, 2, 3))),
    ],
    ids=["sphere", "box", "cylinder", "cone", "union", "turned box"],
)
@pytest.mark.parametrize("at", [(0, 0, 0), (0.3, -0.2, 0.1), (0.0, 0.0, -0.9999)])
def test_no_light_leaks_out_of_a_closed_solid(room: rb.Shape, at: tuple) -> None:
    scene = scene_of(room, floor(-4.0), floor(4.0), light=rb.PointLight(at))
    rng = np.random.default_rng(53)
    outside = [(spread(rng, 3.9), (0, 0, 1)), (spread(rng, -3.9), (0, 0, -1)), (20 * random_units(rng, N), None)]
    for origins, direction in outside:
        assert not radiance(scene, origins, -origins if direction is None else direction).any()
    inside = radiance(scene, at, random_units(rng, N))
    assert (inside > 0).all()


def contact_points(radii: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Float32 points of the floor near the contact, and eyes above them within the gap below the sphere."""
    points = f32(np.column_stack([radii * np.cos(angles), radii * np.sin(angles), 0 * radii]))
    gap = (points**2).sum(-1) / 2
    return points, f32(points + [0, 0, 1] * (gap / 4)[:, None])


@pytest.mark.parametrize("light", [(0, 0, 5), (2, 1, 3), (9, 0, 0.5)])
@pytest.mark.parametrize("directional", [False, True])
def test_contact_shadow_of_a_sphere_on_a_plane(light: tuple, directional: bool) -> None:
    rng = np.random.default_rng(54)
    points, eyes = contact_points(10 ** rng.uniform(-6, 0.2, N), rng.uniform(0, 2 * math.pi, N))
    lamp = rb.DirectionalLight(-f32(light)) if directional else rb.PointLight(light)
    shown = radiance(scene_of(floor(), rb.Sphere((0, 0, 1), 1.0), light=lamp), eyes, (0, 0, -1))[:, 0] > 0
    to_light = np.broadcast_to(f32(light), points.shape) if directional else f32(light) - points
    centre = np.array([0, 0, 1.0]) - points
    along = (centre * to_light).sum(-1) / np.linalg.norm(to_light, axis=1)
    margin = np.sqrt(np.maximum((centre**2).sum(-1) - along**2, 0)) - 1  # > 0: the line passes by
    clear = np.abs(margin) > 1e-6
    assert (shown == (margin > 0))[clear].all()
    assert clear.mean() > 0.8
    assert (~shown)[clear & (np.hypot(*points[:, :2].T) < 1e-3)].sum() > N / 4


def test_the_sphere_itself_has_no_false_shadow_next_to_the_contact() -> None:
    """Lit from the side and seen from there: the whole near half down to the floor."""
    scene = scene_of(floor(), rb.Sphere((0, 0, 1), 1.0), light=rb.DirectionalLight((1, 0, 0)))
    heights = f32(np.geomspace(1e-6, 0.9, 400))
    origins = np.column_stack([np.full(400, -5.0), np.zeros(400), heights])
    found = rb.Renderer(scene).trace(origins, np.broadcast_to([1.0, 0, 0], origins.shape))
    assert (found.object_id == 1).all()
    assert np.allclose(found.radiance[:, 0], np.sqrt(1 - (1 - heights) ** 2), rtol=1e-4)


@pytest.mark.parametrize("distance", [1e-2, 1e-4, 1e-6])
def test_a_box_that_stands_on_the_floor_leaks_no_light_below_it(distance: float) -> None:
    scene = scene_of(floor(), rb.Box((-1, -1, 0), (1, 1, 1)), light=rb.PointLight((3, 0.1, 0.5)))
    y = np.linspace(-0.9, 0.9, 500)
    for x, lit in ((-1 - distance, False), (1 + distance, True)):
        origins = np.column_stack([np.full(500, x), y, np.full(500, distance / 8)])
        shown = radiance(scene, origins, (0, 0, -1))[:, 0]
        assert ((shown > 0) == lit).all()
    walls = np.column_stack([np.full(500, 1 + distance), y, np.full(500, distance / 8)])
    assert (radiance(scene, walls, (-1, 0, 0))[:, 0] > 0).all()


def test_stacked_boxes_with_a_common_face_make_one_shadow() -> None:
    boxes = [rb.Box((-1, -1, k / 3), (1, 1, (k + 1) / 3)) for k in range(3)]
    single = scene_of(floor(), rb.Box((-1, -1, 0), (1, 1, 1)), light=rb.PointLight((4, 1, 3)))
    stack = scene_of(floor(), *boxes, light=rb.PointLight((4, 1, 3)))
    origins = spread(np.random.default_rng(55), 20.0)
    shown = [radiance(scene, origins, (0, 0, -1)) for scene in (single, stack)]
    assert (shown[0] == shown[1]).all()
    assert (shown[0] == 0).sum() > 300


def test_glass_and_mirrors_cast_full_shadows() -> None:
    for material in (rb.Material(0.0, transmit=1.0), rb.Material(0.0, reflect=1.0)):
        scene = scene_of(floor(), light=rb.PointLight((0, 0, 5)))
        scene.add(rb.Sphere((0, 0, 2), 1.0), material)
        shown = radiance(scene, [(0, 0, 0.5), (0.5, 0, 0.5), (3, 0, 0.5)], (0, 0, -1))[:, 0]
        assert (shown > 0).tolist() == [False, False, True]


def test_nothing_behind_the_light_casts_a_shadow() -> None:
    scene = scene_of(
        floor(), rb.Box((-1, -1, 5.000001), (1, 1, 6)), rb.Sphere((0, 0, 9)), light=rb.PointLight((0, 0, 5))
    )
    assert (radiance(scene, spread(np.random.default_rng(56), 0.5), (0, 0, -1)) > 0).all()
    assert not scene.occluded([(0.3, 0, 0)], [(0, 0, 5)]).any()
    assert scene.occluded([(0.3, 0, 0)], [(0, 0, 5.1)]).all()


def test_no_surface_shadows_itself() -> None:
    """Convex solids under a light that they face: every point seen by the light is lit."""
    rng = np.random.default_rng(57)
    shapes = [
        rb.Sphere((1e3, 0, 0), 1.0),
        rb.Box((999, -1, -1), (1001, 1, 1)).transformed(rb.Transform.translate(0.1, 0.2, 0.3)),
        rb.Cylinder((1000, -1, 0.3), (1000, 1, -0.2), radius=0.7),
        rb.Cone((1000, -1, 0.3), (1000, 1, -0.2), radius=0.9),
    ]
    for shape in shapes:
        scene = scene_of(shape, light=rb.DirectionalLight((1, 0.3, 0.2)))
        targets = f32([1000, 0, 0] + rng.normal(size=(N, 3)) * 0.4)
        eye = f32([0, 100, 30])
        hits = scene.intersect(np.broadcast_to(eye, targets.shape), targets - eye)
        cosine = -(hits["normal"] @ unit(f32([1, 0.3, 0.2])))
        facing = hits["hit"] & (cosine > 1e-5)
        assert facing.sum() > N / 4
        assert (radiance(scene, eye, targets - eye)[facing] > 0).all()
