"""Solids that touch: what is entered is seen, with the index relative to what is left, whichever was added first."""

from itertools import permutations

import numpy as np
import pytest
from tests.support.random_scenes import glass, material, touching
from tests.support.support_shapes import unit

import raybound as rb

GLASS = rb.Material(0.0, transmit=1.0, ior=1.5)
WATER = rb.Material(0.0, transmit=1.0, ior=4 / 3)
LOWER, UPPER = rb.Box((-9, -9, -1), (9, 9, 0)), rb.Box((-9, -9, 0), (9, 9, 1))


def scene_of(*things: tuple[rb.Shape, rb.Material]) -> rb.Scene:
    scene = rb.Scene(ambient=1, background=(0.2, 0.4, 0.6))
    for shape, made_of in things:
        scene.add(shape, made_of)
    return scene


def lands_at(scene: rb.Scene, angle: float, depth: int = 8) -> tuple[float, np.ndarray]:
    """Where a ray that meets the origin of the top face at `angle` from the vertical leaves the solids, and its way."""
    way = np.array([np.sin(angle), 0, -np.cos(angle)])
    with rb.Renderer(scene, max_depth=depth) as renderer:
        paths = renderer.paths(np.array([0, 0, 1.0]) - 3 * way, way)
    last = paths[np.isinf(paths["t"])][-1]
    return float(last["origin"][0]), last["point"].astype(float)


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.9, 1.3])
@pytest.mark.parametrize("indices", [(1.5, 1.5), (1.5, 4 / 3), (4 / 3, 1.5), (2.4, 1.0), (1.0, 2.4)])
def test_stacked_slabs(indices: tuple[float, float], angle: float) -> None:
    """x grows by tan of each layer's angle, by Snell's law across the shared face; the way is what it was."""
    upper, lower = (rb.Material(0.0, transmit=1.0, ior=n) for n in indices)
    sines = [np.sin(angle) / n for n in (np.float32(indices[0]), np.float32(indices[1]))]
    expected = sum(s / np.sqrt(1 - s * s) for s in sines)
    for things in permutations([(UPPER, upper), (LOWER, lower)]):
        x, way = lands_at(scene_of(*things), angle)
        assert abs(x - expected) < 1e-5
        assert np.allclose(way, [np.sin(angle), 0, -np.cos(angle)], atol=1e-6)


def test_total_reflection_between_touching_solids() -> None:
    """From glass of 1.5 to air of 1.0, both solids, beyond the critical angle: nothing is refracted there."""
    thin = rb.Material(0.0, transmit=1.0, ior=1.0)
    for order in (1, -1):
        scene = scene_of(*[(LOWER, thin), (UPPER, GLASS)][::order])
        hit = scene.intersect((0, 0, 3), (0.0, 0, -1))
        inside = scene.intersect(hit, (0.9, 0, -0.3))  # steeper than the critical angle
        assert inside["touching"]
        assert inside["object_id"] == (0 if order == 1 else 1)
        with rb.Renderer(scene, max_depth=3) as renderer:
            paths = renderer.paths(hit, (0.9, 0, -0.3))
        assert (paths["kind"][1:] == rb.RayKind.REFLECTED).sum() >= 1
        assert paths["kind"][1] == rb.RayKind.REFLECTED
        assert (paths["parent"] == 0).sum() == 1


def test_a_block_on_a_floor_shows_the_floor() -> None:
    red, blue = rb.Material((1, 0, 0)), rb.Material((0, 0, 1))
    for order in (1, -1):
        scene = scene_of(*[(UPPER, GLASS), (LOWER, red)][::order])
        with rb.Renderer(scene) as renderer:
            seen = renderer.trace((0.1, 0.2, 5), (0.1, 0, -1.0))
        assert np.allclose(seen.radiance, (1, 0, 0), atol=1e-6)
        hit = scene.intersect(scene.intersect((0.1, 0.2, 5), (0.1, 0, -1.0)), (0.1, 0, -1.0))
        assert hit["touching"]
        assert hit["entering"]
        assert np.allclose(hit["normal"], (0, 0, 1))
    open_floor = rb.Polygon([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)])
    seen = []
    for things in permutations([(UPPER, GLASS), (open_floor, blue)]):
        with rb.Renderer(scene_of(*things)) as renderer:
            seen.append(renderer.trace((0.1, 0.2, 5), (0, 0, -1.0)).radiance)
    assert np.allclose(seen[1], (0, 0, 1))  # the open surface has the lower id: seen, as ever


def test_equal_indices_bend_nothing() -> None:
    ball = rb.Sphere((0, 0, 0), 0.8)
    block = rb.Box() - ball
    for things in permutations([(ball, GLASS), (block, GLASS)]):
        scene = scene_of(*things)
        rng = np.random.default_rng(4)
        ways = rng.normal(size=(300, 3))
        with rb.Renderer(scene, max_depth=8) as renderer:
            whole = rb.Renderer(scene_of((rb.Box(), GLASS)), max_depth=8)
            for origin in (-4 * ways, -4 * ways + rng.normal(size=(300, 3)) * 0.3):
                ours, plain = renderer.paths(origin, ways), whole.paths(origin, ways)
                for i in range(300):
                    a, b = ours[ours["ray"] == i], plain[plain["ray"] == i]
                    first = a[(a["kind"] == rb.RayKind.REFLECTED)]
                    if len(first) or (b["kind"] == rb.RayKind.REFLECTED).any():
                        continue
                    if np.isinf(a["t"][-1]) and np.isinf(b["t"][-1]):
                        assert np.allclose(a["point"][-1], b["point"][-1], atol=2e-5)


@pytest.mark.parametrize("shape", [rb.Sphere(), rb.Box(), rb.Cone(), rb.Sphere() & rb.Box((-1, -1, -1), (1, 1, 0.3))])
def test_doubled_solids_are_one(shape: rb.Shape) -> None:
    camera = rb.Camera((3, 2, 1.5), (0, 0, 0), fov=45, width=60, height=60)
    pictures = []
    for things in ([(shape, GLASS)], [(shape, GLASS), (shape, GLASS)]):
        with rb.Renderer(scene_of(*things)) as renderer:
            pictures.append(renderer.render(camera).image)
    assert np.array_equal(*pictures)


@pytest.mark.parametrize("scenes", [60, pytest.param(2000, marks=pytest.mark.soak)])
def test_the_order_of_adding_does_not_matter(scenes: int) -> None:
    touched = 0
    for seed in range(scenes):
        rng = np.random.default_rng([seed, 31])
        shapes = touching(rng)
        first = int(rng.integers(len(shapes) - 1))
        shapes = shapes[first : first + 2]
        if shapes[0] == shapes[1]:
            continue
        things = [(shape, glass(rng) if rng.random() < 0.7 else material(rng)) for shape in shapes]
        middle = np.mean([shape.bounds for shape in shapes], axis=(0, 1))
        extent = max(float(np.ptp(shape.bounds, axis=0).max()) for shape in shapes)
        away = rng.normal(size=3) + np.array([0.5, 0, 0])
        camera = rb.Camera(middle + away / np.linalg.norm(away) * extent * 2.5, middle, fov=50, width=48, height=48)
        pictures = []
        for order in permutations(things):
            scene = scene_of(*order)
            scene.add_light(rb.PointLight((5, 4, 9)))
            for method in ("base", "exact"):
                with rb.Renderer(scene, method=method) as renderer:
                    pictures.append(renderer.render(camera).image)
            hits = scene.intersect(*camera.rays())
            touched += int(scene.intersect(hits, camera.rays()[1])["touching"].sum())
        assert all(np.array_equal(pictures[0], other) for other in pictures[1:]), f"seed {seed}"
    assert touched > 100 * scenes


def test_parts_of_one_ball_are_the_ball() -> None:
    """Two halves of glass with one index look as the whole does, but where light is cast."""
    ball, upper = rb.Sphere(), rb.Box((-2, -2, 0), (2, 2, 2))
    camera = rb.Camera((4, 1, 0.7), (0, 0, 0), fov=40, width=60, height=60)
    pictures = []
    for things in ([(ball, GLASS)], [(ball & upper, GLASS), (ball - upper, GLASS)]):
        with rb.Renderer(scene_of(*things), max_depth=12) as renderer:
            pictures.append(renderer.render(camera).image)
    off = np.abs(pictures[0] - pictures[1]).max(axis=-1) > 1e-5
    assert off.mean() < 0.02


def cube(low: float, high: float) -> rb.Mesh:
    corners = [(x, y, z) for z in (low, high) for y in (-1, 1) for x in (-1, 1)]
    faces = [
        *((0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4)),
        *((2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)),
    ]
    return rb.Mesh(corners, faces)


# Solids with the flat face z = 0, above it or below it.
FLAT: dict[str, tuple[rb.Shape, rb.Shape]] = {
    "box": (rb.Box((-1, -1, 0), (1, 1, 1)), rb.Box((-1, -1, -1), (1, 1, 0))),
    "cylinder": (rb.Cylinder((0, 0, 0), (0, 0, 1)), rb.Cylinder((0, 0, 0), (0, 0, -1))),
    "cone": (rb.Cone((0, 0, 0), (0, 0, 2)), rb.Cone((0, 0, 0), (0, 0, -2))),
    "frustum": (
        rb.Cone((0, 0, 0), (0, 0, 1), top_radius=0.6),
        rb.Cone((0, 0, -1), (0, 0, 0), radius=0.6, top_radius=1),
    ),
    "paraboloid": (
        rb.Quadric((1, 1, 0, 0, 0, 0, 0, 0, 1, -1), rb.Box((-1, -1, 0), (1, 1, 1))),
        rb.Quadric((1, 1, 0, 0, 0, 0, 0, 0, -1, -1), rb.Box((-1, -1, -1), (1, 1, 0))),
    ),
    "half ball": (rb.Sphere() & rb.Box((-2, -2, 0), (2, 2, 2)), rb.Sphere() - rb.Box((-2, -2, 0), (2, 2, 2))),
    "drilled": (
        rb.Box((-1, -1, 0), (1, 1, 1)) - rb.Cylinder((0.8, 0.8, -1), (0.8, 0.8, 2), radius=0.1),
        rb.Box((-1, -1, -1), (1, 1, 0)) | rb.Sphere((0, 0, -1), 0.5),
    ),
    "mesh": (cube(0, 1), cube(-1, 0)),
}


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("below", FLAT)
@pytest.mark.parametrize("above", FLAT)
def test_every_pair_that_shares_a_face(above: str, below: str, turned: bool) -> None:
    """From inside of the upper one to the shared face: Snell's law between the two, both orders byte for byte."""
    place = rb.Transform.translate(3, -2, 5) @ rb.Transform.rotate(37, (1, 2, -1)) if turned else rb.Transform()
    matrix = np.array(place.matrix)
    rng = np.random.default_rng(9)
    local = np.concatenate([rng.uniform(-0.25, 0.25, (40, 2)), np.full((40, 1), 0.2)], axis=1)
    ways = unit(rng, 40) * [0.6, 0.6, 0] - [0, 0, 1]
    origins = local @ matrix[:3, :3].T + matrix[:3, 3]
    directions = ways @ matrix[:3, :3].T
    sines = np.linalg.norm(ways[:, :2], axis=1) / np.linalg.norm(ways, axis=1)
    answers = []
    for order in (1, -1):
        scene = rb.Scene(ambient=1)
        for shape, index in ((FLAT[above][0], 1.5), (FLAT[below][1], 4 / 3))[::order]:
            scene.add(shape, rb.Material(0.0, transmit=1.0, ior=index), transform=place)
        upper = 0 if order == 1 else 1
        hits = scene.intersect(origins, directions)
        assert (hits["object_id"] == 1 - upper).all()
        assert hits["touching"].all()
        assert (hits["within_id"] == upper).all()
        with rb.Renderer(scene, max_depth=2) as renderer:
            paths = renderer.paths(origins, directions)
        first = paths[paths["depth"] == 1]
        second = paths[paths["depth"] == 2]
        assert (second["object_id"] == 1 - upper).all()  # on its way out of the lower one
        went = (second["point"].astype(float) - first["point"]) @ matrix[:3, :3]
        bent = np.linalg.norm(went[:, :2], axis=1) / np.linalg.norm(went, axis=1)
        assert np.allclose(bent * np.float32(4 / 3), sines * 1.5, atol=2e-5)
        answers.append([paths[name] for name in ("origin", "point", "t", "kind", "weight", "face_id")])
    for one, other in zip(*answers, strict=True):
        assert np.array_equal(one, other)
