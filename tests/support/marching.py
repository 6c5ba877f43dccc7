"""Rays marched through solids: random solids of every kind, rays aimed at what is hard, and chains of crossings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

import raybound as rb
from raybound import Transform

Points = npt.NDArray[np.float64]

KINDS = ("sphere", "box", "cylinder", "cone", "frustum", "quadric", "csg", "mesh")


def units(rng: np.random.Generator, count: int) -> Points:
    v = rng.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1)[:, None]


def circle(rng: np.random.Generator, count: int, radius: float, z: float) -> Points:
    a = rng.uniform(0, 2 * np.pi, count)
    return np.stack([radius * np.cos(a), radius * np.sin(a), np.full(count, z)], 1)


def segments(rng: np.random.Generator, count: int, ends: Points) -> Points:
    """Points of random segments: `ends` is (n, 2, 3). A quarter are ends."""
    s = rng.choice([0.0, 1.0], count) * (rng.random(count) < 0.25) + rng.random(count) * (rng.random(count) >= 0.25)
    chosen = ends[rng.integers(len(ends), size=count)]
    s = np.minimum(s, 1.0)[:, None]
    return chosen[:, 0] * (1 - s) + chosen[:, 1] * s


def tetrahedron() -> tuple[Points, npt.NDArray[np.int64]]:
    v = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    return v, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def pyramid(n: int, height: float) -> tuple[Points, npt.NDArray[np.int64]]:
    """A flat cone with `n` sides: acute edges all around."""
    a = 2 * np.pi * np.arange(n) / n
    v = np.concatenate([np.stack([np.cos(a), np.sin(a), 0 * a], 1), [[0, 0, 0], [0, 0, height]]])
    k, m = np.arange(n), (np.arange(n) + 1) % n
    return v, np.concatenate([np.stack([m, k, 0 * k + n], 1), np.stack([k, m, 0 * k + n + 1], 1)])


def torus(n: int, m: int) -> tuple[Points, npt.NDArray[np.int64]]:
    a, b = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    v = np.stack([(1 + 0.4 * np.cos(b)) * np.cos(a), (1 + 0.4 * np.cos(b)) * np.sin(a), 0.4 * np.sin(b)], -1)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))

    def at(x: Any, y: Any) -> Any:
        return (x % n) * m + y % m

    p, q, r, s = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return v.reshape(-1, 3), np.concatenate([np.stack([p, q, r], 1), np.stack([p, r, s], 1)])


def mesh_of(vertices: Points, faces: npt.NDArray[np.int64]) -> tuple[rb.Shape, Any]:
    v = vertices.astype(np.float32)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends = v.astype(float)[edges]
    return rb.Mesh(v, faces), lambda rng, count: segments(rng, count, ends)


BOX_EDGES = np.array(
    [[[a, b, -1], [a, b, 1]] for a in (-1, 1) for b in (-1, 1)]
    + [[[a, -1, b], [a, 1, b]] for a in (-1, 1) for b in (-1, 1)]
    + [[[-1, a, b], [1, a, b]] for a in (-1, 1) for b in (-1, 1)],
    float,
)


def _both(*samplers: Any) -> Any:
    def sample(rng: np.random.Generator, count: int) -> Points:
        which = rng.integers(len(samplers), size=count)
        all_points = np.stack([s(rng, count) for s in samplers])
        return all_points[which, np.arange(count)]

    return sample


def lens(rng: np.random.Generator) -> tuple[rb.Shape, Any]:
    """Two spheres' common part: an acute rim."""
    d = rng.uniform(0.3, 0.98)
    rim = np.sqrt(1 - d * d)
    turned = lambda r, n: circle(r, n, rim, 0.0)[:, [0, 1, 2]]  # noqa: E731
    return rb.Sphere((0, 0, -d)) & rb.Sphere((0, 0, d)), turned


def make(kind: str, rng: np.random.Generator) -> tuple[rb.Shape, Any]:
    """A random solid of about unit size, and a sampler of points on its edges, rims and tips."""
    if kind == "sphere":
        return rb.Sphere(), lambda r, n: units(r, n)
    if kind == "box":
        return rb.Box(), lambda r, n: segments(r, n, BOX_EDGES)
    if kind == "cylinder":
        return rb.Cylinder(), _both(lambda r, n: circle(r, n, 1, 0), lambda r, n: circle(r, n, 1, 1))
    if kind == "cone":
        h = float(rng.choice([0.05, 0.5, 1, 3]))
        tip = lambda r, n: np.tile([0, 0, h], (n, 1))  # noqa: E731
        return rb.Cone((0, 0, 0), (0, 0, h)), _both(lambda r, n: circle(r, n, 1, 0), tip)
    if kind == "frustum":
        top = float(rng.choice([0.25, 0.5, 2]))
        rims = _both(lambda r, n: circle(r, n, 1, 0), lambda r, n: circle(r, n, top, 1))
        return rb.Cone((0, 0, 0), (0, 0, 1), top_radius=top), rims
    if kind == "quadric":
        choice = rng.integers(3)
        if choice == 0:  # an ellipsoid, cut by its box
            shape = rb.Quadric((1, 1, 2, 0, 0, 0, 0, 0, 0, -1), rb.Box((-1.5, -1.5, 0), (1.5, 1.5, 1.5)))
            return shape, lambda r, n: circle(r, n, 1, 0)
        if choice == 1:  # a hyperboloid of one sheet: not convex
            shape = rb.Quadric((1, 1, -1, 0, 0, 0, 0, 0, 0, -0.25), rb.Box((-1, -1, -0.75), (1, 1, 0.75)))
            rim = float(np.sqrt(0.25 + 0.75**2))
            return shape, _both(lambda r, n: circle(r, n, rim, 0.75), lambda r, n: circle(r, n, rim, -0.75))
        shape = rb.Quadric((1, 1, 0, 0, 0, 0, 0, 0, -1, 0), rb.Box((-1, -1, 0), (1, 1, 1)))  # a paraboloid
        return shape, lambda r, n: circle(r, n, 1, 1)
    if kind == "csg":
        choice = rng.integers(5)
        if choice == 0:
            return lens(rng)
        if choice == 1:  # a box with a hole
            shape = rb.Box() - rb.Cylinder((0, 0, -2), (0, 0, 2), radius=0.5)
            rims = (lambda r, n: circle(r, n, 0.5, 1), lambda r, n: circle(r, n, 0.5, -1))
            return shape, _both(lambda r, n: segments(r, n, BOX_EDGES), *rims)
        if choice == 2:  # a bowl: a thin acute rim
            shape = rb.Sphere() - rb.Sphere((0, 0, 0.5))
            return shape, lambda r, n: circle(r, n, float(np.sqrt(1 - 0.0625)), 0.25)
        if choice == 3:  # two balls in one
            shape = rb.Sphere((-0.5, 0, 0)) | rb.Sphere((0.5, 0, 0))
            return shape, lambda r, n: circle(r, n, float(np.sqrt(0.75)), 0)[:, [2, 0, 1]]
        shape = (rb.Box() & rb.Sphere((0, 0, 0), 1.3)) - (rb.Sphere((1, 1, 1)) - rb.Box((0.7, 0.7, 0.7), (2, 2, 2)))
        return shape, lambda r, n: segments(r, n, BOX_EDGES) * 0.9
    choice = rng.integers(4)
    if choice == 0:
        return mesh_of(*tetrahedron())
    if choice == 1:
        return mesh_of(*pyramid(int(rng.integers(3, 24)), float(rng.choice([0.02, 0.3, 1]))))
    if choice == 2:
        return mesh_of(*torus(12, 8))
    v, f = torus(7, 5)
    return mesh_of(v * [1, 1, 0.05], f)


def random_transform(rng: np.random.Generator) -> Transform:
    """A turn, a stretch, perhaps a mirror."""
    turn = Transform.rotate(float(rng.uniform(0, 360)), tuple(float(x) for x in units(rng, 1)[0]))
    stretch = rng.uniform(0.3, 3, 3) * (rng.choice([-1, 1], 3) if rng.random() < 0.3 else 1)
    choice = rng.integers(4)
    if choice == 0:
        return Transform.translate(0, 0, 0)
    if choice == 1:
        return turn
    return turn @ Transform.scale(tuple(float(x) for x in stretch))


@dataclass
class March:
    """One solid with rays: origins, directions (float32)."""

    kind: str
    shape: rb.Shape
    transform: Transform
    origins: npt.NDArray[np.float32]
    directions: npt.NDArray[np.float32]

    def scene(self) -> rb.Scene:
        scene = rb.Scene()
        scene.add(self.shape, rb.Material(transmit=0.9, ior=1.5), transform=self.transform)
        return scene


def directions_to(rng: np.random.Generator, targets: Points, middle: Points, count: int) -> Points:
    """From anywhere, across the line to the middle (a tangent), or level with the axes."""
    d = units(rng, count)
    out = targets - middle
    across = np.cross(out, d)
    size = np.linalg.norm(across, axis=1)
    tangent = (rng.random(count) < 0.3) & (size > 1e-9)
    d[tangent] = across[tangent] / size[tangent][:, None]
    level = rng.random(count) < 0.2
    d[level, rng.integers(3, size=int(level.sum()))] = 0
    zero = ~d.any(axis=1)
    d[zero] = [1, 0, 0]
    return d


def random_march(kind: str, rng: np.random.Generator, count: int) -> March:
    shape, special = make(kind, rng)
    move = random_transform(rng)
    away = units(rng, 1)[0] * (rng.choice([0, 1, 1, 1]) * 2.0 ** rng.uniform(-2, 20))
    transform = Transform.translate(*(float(x) for x in away)) @ move if away.any() else move
    matrix = np.array(transform.matrix)
    hard = rng.random(count) < 0.5
    local = np.where(hard[:, None], special(rng, count), rng.uniform(-1.2, 1.2, (count, 3)))
    targets = local @ matrix[:3, :3].T + matrix[:3, 3]
    middle = np.array([0, 0, 0.3]) @ matrix[:3, :3].T + matrix[:3, 3]
    d = directions_to(rng, targets, middle, count)
    distance = np.where(rng.random(count) < 0.5, 8.0, 2.0 ** rng.uniform(3, 20, count))
    origins = (targets - d * distance[:, None]).astype(np.float32)
    directions = np.where((rng.random(count) < 0.5)[:, None], d, targets - origins).astype(np.float32)
    directions[~directions.any(axis=1)] = [1, 0, 0]
    return March(kind, shape, transform, origins, directions)


@dataclass
class Chains:
    """What marching found: rays whose crossings did not alternate, did not end outside, or faced the wrong way."""

    hits: int
    passed: int  # rays that have met the solid and ended outside
    broken: npt.NDArray[np.int64]
    why: list[str]


def march(
    scene: rb.Scene, origins: npt.NDArray[np.float32], directions: npt.NDArray[np.float32], longest: int = 60
) -> Chains:
    """Straight through: each hit starts the next ray, along the same direction."""
    alive = np.arange(len(origins))
    inside = np.diff(scene.containing(origins)[1]) == 1
    crossed = np.zeros(len(origins), bool)
    broken: dict[int, str] = {}
    total = 0
    records = scene.intersect(origins, directions)
    for _ in range(longest):
        met = records["hit"]
        for i in alive[~met & inside[alive]]:
            broken.setdefault(int(i), "ends inside")
        alive, records = alive[met], records[met]
        total += len(alive)
        if not len(alive):
            break
        wrong = records["entering"] == inside[alive]
        for i in alive[wrong]:
            broken.setdefault(int(i), "does not alternate")
        inside[alive] = records["entering"]
        crossed[alive] |= ~records["entering"]
        records = scene.intersect(records, directions[alive])
    for i in alive:
        broken.setdefault(int(i), "never ends")
    rows = np.array(sorted(broken), np.int64)
    return Chains(total, int(crossed.sum()), rows, [broken[int(i)] for i in rows])
