"""Random scenes with every shape, transforms, CSG, glass, mirrors, textures and lights; the same for the same seed."""

from __future__ import annotations

import math

import numpy as np

import raybound as rb

Rng = np.random.Generator


def point(rng: Rng, reach: float = 3.0) -> tuple[float, ...]:
    return tuple(rng.uniform(-reach, reach, 3).tolist())


def size(rng: Rng) -> float:
    return float(10 ** rng.uniform(-1.0, 0.1))


def near(rng: Rng, at: tuple[float, ...], scale: float) -> tuple[float, ...]:
    return tuple((np.array(at) + rng.normal(size=3) * scale).tolist())


def sphere(rng: Rng) -> rb.Shape:
    return rb.Sphere(point(rng), size(rng))


def box(rng: Rng) -> rb.Shape:
    low = np.array(point(rng))
    return rb.Box(tuple(low.tolist()), tuple((low + [size(rng) for _ in range(3)]).tolist()))


def cylinder(rng: Rng) -> rb.Shape:
    base = point(rng)
    return rb.Cylinder(base, near(rng, base, 0.8), radius=size(rng) * 0.6)


def cone(rng: Rng) -> rb.Shape:
    base = point(rng)
    return rb.Cone(base, near(rng, base, 0.8), radius=size(rng) * 0.8, top_radius=float(rng.choice([0.0, 0.2, 1.1])))


def disk(rng: Rng) -> rb.Shape:
    return rb.Disk(point(rng), tuple(rng.normal(size=3).tolist()), radius=size(rng))


def polygon(rng: Rng) -> rb.Shape:
    """A convex polygon on an ellipse in a random plane; some lie in the plane of two axes."""
    count = int(rng.integers(3, 8))
    angles = (np.arange(count) + rng.uniform(0, 0.7, count)) * (2 * math.pi / count)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0] if rng.random() < 0.7 else np.eye(3)[rng.permutation(3)]
    flat = np.cos(angles)[:, None] * axes[0] * size(rng) + np.sin(angles)[:, None] * axes[1] * size(rng)
    return rb.Polygon(np.array(point(rng)) + flat)


def quadric(rng: Rng) -> rb.Shape:
    """Ellipsoids, hyperboloids, saddles, bowls and cones, turned, in a box around a point."""
    middle, half = np.array(point(rng)), size(rng)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    signs = rng.choice([-1, 1], 3) * [1, *rng.choice([0, 1, 1], 2)]
    m = turn @ np.diag(signs * rng.uniform(0.5, 2, 3)) @ turn.T / half
    slope = rng.normal(size=3) * rng.choice([0, 0.5])
    linear, constant = slope - 2 * m @ middle, middle @ m @ middle - slope @ middle - half * rng.uniform(0.01, 0.3)
    coefficients = (*np.diag(m), 2 * m[0, 1], 2 * m[1, 2], 2 * m[0, 2], *linear, constant)
    return rb.Quadric(coefficients, rb.Box(middle - half, middle + half))


def solid(rng: Rng) -> rb.Shape:
    return [sphere, box, cylinder, cone, quadric][int(rng.integers(5))](rng)


def csg(rng: Rng) -> rb.Shape:
    """A union of two or three solids, or the overlap of a solid with a ball or a box around its middle."""
    if rng.random() < 0.5:
        return rb.Union(*(solid(rng) for _ in range(int(rng.integers(2, 4)))))
    first = solid(rng)
    middle = np.mean(first.bounds, axis=0)
    extent = float(np.min(first.bounds[1] - first.bounds[0]))
    cut = rb.Sphere(near(rng, tuple(middle.tolist()), extent * 0.1), extent * float(rng.uniform(0.4, 0.8)))
    overlap = first & cut
    return overlap | solid(rng) if rng.random() < 0.3 else overlap


def difference(rng: Rng) -> rb.Shape:
    """A solid with a ball or a box taken out of it, sometimes put back in part."""
    first = solid(rng)
    middle = np.mean(first.bounds, axis=0)
    extent = float(np.min(first.bounds[1] - first.bounds[0]))
    away: rb.Shape = rb.Sphere(near(rng, tuple(middle.tolist()), extent * 0.3), extent * float(rng.uniform(0.2, 0.45)))
    if rng.random() < 0.3:
        away = away - rb.Box(tuple((middle - extent * 0.1).tolist()), tuple((middle + extent * 0.2).tolist()))
    return first - away


def touching(rng: Rng) -> list[rb.Shape]:
    """Solids that share faces, rims or points, or the same one twice."""
    at, r = np.array(point(rng, 2.0)), size(rng)

    def moved(x: float, y: float, z: float) -> tuple[float, ...]:
        return tuple((at + np.array([x, y, z])).tolist())

    block = rb.Box(moved(-r, -r, -r), moved(r, r, 0))
    kind = int(rng.integers(7))
    if kind == 0:
        return [block, rb.Box(moved(-r / 2, -r, 0), moved(2 * r, r, r))]
    if kind == 1:
        return [
            block,
            rb.Cylinder(moved(0, 0, 0), moved(0, 0, r), radius=r),
            rb.Cone(moved(0, 0, r), moved(0, 0, 2 * r), radius=r),
        ]
    if kind == 2:
        return [
            rb.Box(moved(-r, -r, -r), moved(r, r, r)) - rb.Sphere(moved(0, 0, 0), r * 0.8),
            rb.Sphere(moved(0, 0, 0), r * 0.8),
        ]
    if kind == 3:
        return [block, rb.Sphere(moved(0, 0, r), r)]
    if kind == 4:
        first = solid(rng)
        return [first, first]
    if kind == 5:
        ball = rb.Sphere(moved(0, 0, 0), r)
        return [ball & block, ball - block]
    corners = np.array([[x, y, z] for x in (-r, r) for y in (-r, r) for z in (0, r)]) + at
    faces = [
        [0, 2, 4],
        [4, 2, 6],
        [1, 5, 3],
        [5, 7, 3],
        [0, 4, 1],
        [4, 5, 1],
        [2, 3, 6],
        [6, 3, 7],
        [0, 1, 2],
        [2, 1, 3],
        [4, 6, 5],
        [6, 7, 5],
    ]
    faces = [face if _outward(corners, face, at + np.array([0, 0, r / 2])) else face[::-1] for face in faces]
    return [block, rb.Mesh(corners, faces)]


def _outward(corners: np.ndarray, face: list[int], middle: np.ndarray) -> bool:
    a, b, c = corners[face]
    return bool(np.dot(np.cross(b - a, c - a), a - middle) > 0)


def glass(rng: Rng) -> rb.Material:
    return rb.Material(
        0.1, reflect=0.2, transmit=float(rng.uniform(0.5, 0.8)), ior=float(rng.choice([1.5, 1.33, 1.0, 2.4]))
    )


def add_close_ones(scene: rb.Scene, seed: int) -> None:
    """Differences, and solids that touch or coincide, most of them of glass."""
    rng = np.random.default_rng([seed, 20261])
    shapes = [difference(rng), *touching(rng), *touching(rng)]
    for shape in shapes:
        scene.add(shape, glass(rng) if rng.random() < 0.7 else material(rng))


def add_glass_around_the_eye(scene: rb.Scene, seed: int) -> None:
    rng = np.random.default_rng([seed, 20262])
    assert scene.camera is not None
    scene.add(rb.Sphere(scene.camera.eye, float(rng.uniform(0.1, 1))), glass(rng))


def transform(rng: Rng) -> rb.Transform | None:
    if rng.random() < 0.5:
        return None
    turn = rb.Transform.rotate(float(rng.uniform(0, 360)), axis=tuple(rng.normal(size=3).tolist()))
    stretch = rb.Transform.scale(tuple((10 ** rng.uniform(-0.3, 0.3, 3) * rng.choice([-1, 1], 3)).tolist()))
    return rb.Transform.translate(*point(rng, 0.5)) @ turn @ stretch


WRAPS = (None, "repeat", "clamp", "mirror", ("mirror", "clamp"))


def texture(rng: Rng) -> rb.Texture:
    texels = rng.uniform(0, 1, (int(rng.integers(1, 6)), int(rng.integers(1, 6)), 3))
    scale = tuple(rng.uniform(0.5, 3.0, 2).tolist())
    return rb.Texture(texels, scale, wrap=WRAPS[int(rng.integers(len(WRAPS)))])


def material(rng: Rng) -> rb.Material:
    diffuse = texture(rng) if rng.random() < 0.2 else tuple(rng.uniform(0, 1, 3).tolist())
    specular = float(rng.choice([0.0, 0.3]))
    kind = rng.random()
    reflect = float(rng.uniform(0.2, 0.8)) if kind < 0.45 else 0.0
    transmit = float(rng.uniform(0.3, 0.9)) if kind > 0.7 or kind < 0.15 else 0.0
    ior = float(rng.choice([1.5, 1.33, 2.4, 0.8, 1.0]))
    roughness = float(rng.uniform(0.15, 0.5))
    return rb.Material(diffuse, specular, roughness=roughness, reflect=reflect, transmit=transmit, ior=ior)


def light(rng: Rng) -> rb.DirectionalLight | rb.PointLight | rb.SpotLight:
    kind, colour = rng.random(), tuple(rng.uniform(0.2, 0.8, 3).tolist())
    if kind < 0.3:
        return rb.DirectionalLight(tuple(rng.normal(size=3).tolist()), colour)
    position = tuple(np.add(point(rng), (0, 0, 3.0)).tolist())
    falloff = bool(rng.random() < 0.4)
    if kind < 0.7:
        return rb.PointLight(position, colour, falloff=falloff)
    aim = tuple((-np.array(position) + rng.normal(size=3)).tolist())
    return rb.SpotLight(position, aim, cutoff=float(rng.uniform(10, 70)), intensity=colour, falloff=falloff)


MAKERS = (sphere, box, cylinder, cone, disk, polygon, quadric, csg)


def has_close_ones(seed: int) -> bool:
    return seed % 3 == 2


def random_scene(seed: int, objects: int = 24, pixels: int = 48) -> rb.Scene:
    """A scene with its camera: each kind of shape at least once, 1 to 4 lights, a floor every other time.

    A third of the scenes also have solids that touch, coincide or have been taken from each other.
    """
    rng = np.random.default_rng([seed, 20240])
    scene = rb.Scene(ambient=0.1, background=tuple(rng.uniform(0, 0.5, 3).tolist()))
    kinds = [*MAKERS, *(MAKERS[int(k)] for k in rng.integers(len(MAKERS), size=objects - len(MAKERS)))]
    for maker in kinds:
        scene.add(maker(rng), material(rng), transform=transform(rng))
    if seed % 2:
        scene.add(rb.Box((-9, -9, -4.5), (9, 9, -4)), material(rng))
    for _ in range(int(rng.integers(1, 5))):
        scene.add_light(light(rng))
    eye = rng.normal(size=3)
    eye[2] = abs(eye[2])  # above the floor
    eye = tuple((7.5 * eye / np.linalg.norm(eye)).tolist())
    scene.camera = rb.Camera(eye, point(rng, 1.0), fov=float(rng.uniform(35, 70)), width=pixels, height=pixels * 3 // 4)
    if has_close_ones(seed):
        add_close_ones(scene, seed)
    return scene
