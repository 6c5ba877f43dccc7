"""Tangent rays, rays along faces, through edges and vertices: the hierarchy agrees with brute force, no crack shows."""

import numpy as np
import pytest
from tests.support.support_light import EMITTER_AMBIENT, assert_same_picture, core_render, emitter, f32, trace

import raybound as rb

STEPS = np.array([-(2.0**-k) for k in range(10, 31, 4)] + [0.0] + [2.0**-k for k in range(30, 9, -4)])


def grid_of_boxes() -> rb.Scene:
    """Unit boxes that touch at faces, edges and corners; a floor in the plane of their bottoms."""
    scene = rb.Scene(ambient=0.2, background=0.1)
    for x in range(-2, 2):
        for y in range(-2, 2):
            for z in range(2):
                if (x + y + z) % 2 or z == 0:
                    scene.add(
                        rb.Box((x, y, z), (x + 1, y + 1, z + 1)),
                        rb.Material(((x + 2) / 4, (y + 2) / 4, z), reflect=0.2),
                    )
    scene.add(rb.Polygon([(-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)]), rb.Material(0.5))
    scene.add_light(rb.PointLight((0, 0, 5)))
    scene.add_light(rb.DirectionalLight((1, 0, 0)))
    return scene


# Cameras in planes of faces, on edges, on corners; views along axes and diagonals.
EYES = [(-6, 0, 1), (-6, 0.5, 1), (0, -6, 0), (-6, -6, 1), (0, 0, 6), (1, 1, 6), (-6, 0, 2), (-4, -4, 4), (0, 0, 1)]
TARGETS = [(0, 0, 1), (1, 0.5, 1), (0, 0, 0), (0, 0, 1), (0, 0, 0), (1, 1, 0), (0, 0, 2), (0, 0, 0), (3, 0, 1)]


@pytest.mark.parametrize(("eye", "target"), list(zip(EYES, TARGETS, strict=True)))
def test_cameras_in_the_planes_of_faces(eye: tuple, target: tuple) -> None:
    scene = grid_of_boxes()
    up = (0, 1, 0) if eye[:2] == target[:2] else (0, 0, 1)
    for size in (63, 64):  # odd: the middle pixels' rays run within the plane
        cam = rb.Camera(eye, target, up=up, fov=40, width=size, height=size)
        plain = core_render(scene, cam)
        assert_same_picture(plain, core_render(scene, cam, brute_force=True), str((eye, target)))
        assert len(np.unique(plain.object_id)) >= 3
        assert np.isfinite(plain.image).all()


def compare_rays(scene: rb.Scene, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Rays through one-pixel cameras, by both methods; returns the ids seen."""
    seen = []
    for origin, direction in zip(origins, directions, strict=True):
        up = np.eye(3)[np.argmin(np.abs(direction))]
        cam = rb.Camera(origin, f32(origin) + direction, up=up, fov=1.0, width=1, height=1)
        plain = core_render(scene, cam, threads=1)
        assert_same_picture(plain, core_render(scene, cam, threads=1, brute_force=True), f"{origin} {direction}")
        seen.append(plain.object_id[0, 0])
    return np.array(seen)


def test_rays_within_a_few_units_of_edges_vertices_and_faces() -> None:
    scene = grid_of_boxes()
    origins, directions = [], []
    for dx in STEPS:
        for target in ((1, 0, 1), (1, 0.5, 1), (0, 0, 1), (-2, -2, 1), (0.5, 0.5, 2)):
            for eye in ((-6, 0, 1), (-6, -6, 3), (0, 0, 8), (7, 0.5, 1)):
                direction = np.add(np.subtract(target, eye), [0, 0, dx])
                if np.any(direction):
                    origins.append(eye)
                    directions.append(direction)
    seen = compare_rays(scene, np.array(origins), np.array(directions))
    assert len(seen) >= 200
    assert (seen >= 0).sum() >= 100


def test_no_ray_passes_between_touching_boxes() -> None:
    """A wall of boxes that share faces: rays through their common edges and corners hit something."""
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    for y in range(-3, 3):
        for z in range(-3, 3):
            scene.add(rb.Box((0, y / 3, z / 3), (0.1, (y + 1) / 3, (z + 1) / 3)), emitter())
    rng = np.random.default_rng(90)
    edge = f32(rng.integers(-2, 3, 4000) / 3)
    free = f32(rng.uniform(-0.9, 0.9, 4000))
    corner = f32(rng.integers(-2, 3, 4000) / 3)
    targets = np.column_stack([0 * edge, edge, np.where(rng.random(4000) < 0.5, free, corner)])
    eyes = f32(np.column_stack([-1 - rng.random(4000), rng.normal(size=(4000, 2))]))
    eyes[:2000, 1] = targets[:2000, 1]  # within the plane of the common faces
    assert (trace(scene, eyes, targets - eyes).object_id >= 0).all()


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_no_ray_passes_between_polygons_that_share_edges(scale: float) -> None:
    """A fan of triangles around a vertex, rays exactly at its edges and at the vertex."""
    rng = np.random.default_rng(91)
    rim = [(np.cos(a) * scale, np.sin(a) * scale, 0.3 * scale * np.sin(3 * a)) for a in np.arange(9) * 2 * np.pi / 9]
    tip = np.array([0.05, -0.1, 0.4]) * scale
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    for a, b in zip(rim, [*rim[1:], rim[0]], strict=True):
        scene.add(rb.Polygon([tip, a, b]), emitter())
    rim32, tip32 = f32(rim), f32(tip)
    share = np.where(rng.random(3000) < 0.2, 0, rng.random(3000) * 0.95)[:, None]
    targets = tip32 + (rim32[rng.integers(9, size=3000)] - tip32) * share
    eyes = f32([0.1, 0.2, 3.0]) * scale + rng.normal(size=(3000, 3)) * 0.2 * scale
    assert (trace(scene, f32(eyes), f32(targets) - f32(eyes)).object_id >= 0).all()


def test_spheres_that_touch_and_rays_that_graze_them() -> None:
    scene = rb.Scene(ambient=0.2, background=0.3)
    for x in range(-2, 3):
        for z in range(3):
            scene.add(rb.Sphere((x, 0, z), 0.5), rb.Material(0.4, reflect=0.4, transmit=0.2))
    scene.add(rb.Box((-4, -2, -1), (4, 2, -0.5)), rb.Material(0.5, reflect=0.3))  # they rest on it
    scene.add_light(rb.DirectionalLight((0, 0, -1)))
    scene.add_light(rb.PointLight((0.5, 0, 5)))  # shines through the points of contact
    for eye, target in (((0.5, -6, 0), (0.5, 0, 0)), ((-6, 0, 0.5), (0, 0, 0.5)), ((0, -6, -0.5), (0, 0, -0.5))):
        cam = rb.Camera(eye, target, fov=40, width=61, height=61)
        plain = core_render(scene, cam, max_depth=7)
        assert_same_picture(plain, core_render(scene, cam, max_depth=7, brute_force=True), str(eye))
        assert len(np.unique(plain.object_id)) >= 6
    origins = [(-6, s, 0.5 + d) for d in STEPS for s in (0.0, 0.5)]
    directions = [(1, 0, 0)] * len(origins)
    assert (compare_rays(scene, np.array(origins), np.array(directions)) >= 0).sum() >= 5


def test_rays_along_the_axes_of_round_shapes() -> None:
    """Through apex and axis, along generators and caps."""
    scene = rb.Scene(ambient=0.2, background=0.3)
    scene.add(rb.Cylinder((0, 0, 0), (0, 0, 2), radius=1.0), rb.Material(0.4, transmit=0.5))
    scene.add(rb.Cone((4, 0, 0), (4, 0, 2), radius=1.0), rb.Material(0.4, transmit=0.5))
    scene.add(rb.Cone((8, 0, 0), (8, 0, 2), radius=1.0, top_radius=0.5), rb.Material(0.4, reflect=0.5))
    scene.add_light(rb.PointLight((4, 0, 5)))
    origins, directions = [], []
    for x in (0, 4, 8):
        for d in STEPS:
            origins += [(x + d, 0, 5), (x + 1 + d, 0, 5), (x, -5, d), (x, -5, 2 + d), (x - 3, 0, -1 + d)]
            directions += [(0, 0, -1), (0, 0, -1), (0, 1, 0), (0, 1, 0), (1, 0, 1)]
    seen = compare_rays(scene, np.array(origins), np.array(directions))
    assert (seen >= 0).sum() >= 60
    middle = [i for i, (o, d) in enumerate(zip(origins, directions, strict=True)) if d == (0, 0, -1) and o[0] % 4 == 0]
    assert (seen[middle] >= 0).all()
    assert len(middle) == 3
