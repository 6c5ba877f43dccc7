"""(u, v) of each shape, by what a texture of ramps shows and by `scene.intersect`."""

import numpy as np
import pytest
from tests.support.support_light import EMITTER_AMBIENT, f32, radiance, random_units, unit

import raybound as rb

LIMIT = 1e-6  # of u and v; largest observed 3.0e-7
N = 500


def ramps(n: int = 512) -> rb.Texture:
    """Red is u and green is v, linear between the outermost texel centres."""
    centre = (np.arange(n) + 0.5) / n
    u, v = np.meshgrid(centre, centre[::-1])
    return rb.Texture(np.stack([u, v, 0 * u], axis=-1), wrap="clamp")


def uv_shown(shape: rb.Shape, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Checks that the texture and `intersect` agree, and returns (u, v)."""
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    scene.add(shape, rb.Material(ramps()))
    shown = radiance(scene, origins, directions)[:, :2]
    hits = scene.intersect(*np.broadcast_arrays(origins, directions))
    assert hits["hit"].all()
    inner = (np.abs(shown - 0.5) < 0.499).all(axis=1)
    assert inner.mean() > 0.9
    assert np.abs(shown - hits["uv"])[inner].max() < 4e-6  # the directions of `intersect` are not made unit vectors
    assert ((hits["uv"] >= -LIMIT) & (hits["uv"] <= 1 + LIMIT)).all()
    return hits["uv"].astype(np.float64)


def turn(y: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.arctan2(y, x) / (2 * np.pi) % 1


def cyclic(difference: np.ndarray) -> np.ndarray:
    """Angles are equal modulo a full turn."""
    return np.abs((difference + 0.5) % 1 - 0.5)


def test_sphere_longitude_and_latitude() -> None:
    p = unit(f32(random_units(np.random.default_rng(70), N)))
    uv = uv_shown(rb.Sphere((1, 2, 3), 2.0), f32([1, 2, 3]) + f32(p * 5), f32(-p))
    clear = np.hypot(p[:, 0], p[:, 1]) > 0.1
    assert cyclic(uv[:, 0] - turn(p[:, 1], p[:, 0]))[clear].max() < 2e-6  # largest observed 6.3e-7
    # From the south pole (0) to the north pole (1).
    assert np.abs(uv[:, 1] - (1 - np.arccos(p[:, 2]) / np.pi))[clear].max() < 2e-6  # largest observed 5.0e-7


BOX_LOW, BOX_HIGH = f32([-1, 0.5, 2]), f32([2, 1.5, 6])
# face: axis, (u, v) from the place s in the box: seen from outside, u to the right; v is z, and y on top and bottom
BOX_FACES = {
    0: (0, -1, lambda s: (1 - s[:, 1], s[:, 2])),
    1: (0, 1, lambda s: (s[:, 1], s[:, 2])),
    2: (1, -1, lambda s: (s[:, 0], s[:, 2])),
    3: (1, 1, lambda s: (1 - s[:, 0], s[:, 2])),
    4: (2, -1, lambda s: (1 - s[:, 0], s[:, 1])),
    5: (2, 1, lambda s: (s[:, 0], s[:, 1])),
}


@pytest.mark.parametrize("face", BOX_FACES)
def test_box_faces_are_upright_seen_from_outside(face: int) -> None:
    axis, side, expected = BOX_FACES[face]
    points = f32(np.random.default_rng(71).uniform(BOX_LOW, BOX_HIGH, (N, 3)))
    outward = np.eye(3)[axis] * side
    points[:, axis] = BOX_HIGH[axis] if side > 0 else BOX_LOW[axis]
    uv = uv_shown(rb.Box(BOX_LOW, BOX_HIGH), points + outward, np.broadcast_to(-outward, points.shape))
    exact = np.column_stack(expected((points - BOX_LOW) / (BOX_HIGH - BOX_LOW)))
    assert np.abs(uv - exact).max() < LIMIT


def test_box_textures_are_not_mirrored_from_outside() -> None:
    """The direction of growing u, crossed with that of growing v, points outward."""
    for axis, side, expected in BOX_FACES.values():
        s = np.full((4, 3), 0.5)
        others = [k for k in range(3) if k != axis]
        s[1, others[0]] += 0.1
        s[2, others[1]] += 0.1
        uv = np.column_stack(expected(s))
        jacobian = np.column_stack([uv[1] - uv[0], uv[2] - uv[0]]) / 0.1
        sign = np.linalg.det(jacobian) * (-1 if axis == 1 else 1)  # (x, z) is left-handed about y
        assert sign == pytest.approx(side)


def test_polygon_u_runs_along_the_first_edge() -> None:
    rng = np.random.default_rng(72)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    corner, edge, across = rng.normal(size=3), axes[0] * 3, axes[1] * 2
    shape = rb.Polygon([corner, corner + edge, corner + edge + across, corner + across])
    st = rng.uniform(0.01, 0.99, (N, 2))
    points = corner + st @ np.stack([edge, across])
    normal = np.cross(edge, across) / 6
    uv = uv_shown(shape, f32(points + normal), np.broadcast_to(f32(-normal), points.shape))
    assert np.abs(uv - st).max() < LIMIT


def test_polygon_that_is_no_rectangle_fills_the_unit_square() -> None:
    shape = rb.Polygon([(0, 0, 0), (2, 0, 0), (3, 2, 0), (-1, 2, 0)])
    points = np.array([[0, 0, 1], [2, 0, 1], [2.9, 1.9, 1], [-0.9, 1.9, 1], [1, 1, 1.0]])
    uv = rb.Scene()
    uv.add(shape, rb.Material())
    found = uv.intersect(points, np.broadcast_to([0.0, 0, -1], points.shape))["uv"]
    assert np.abs(found - np.column_stack([(points[:, 0] + 1) / 4, points[:, 1] / 2])).max() < LIMIT


@pytest.mark.parametrize(
    "shape", [rb.Cylinder((0, 0, 1), (0, 0, 3), radius=2.0), rb.Cone((0, 0, 1), (0, 0, 3), radius=2.0, top_radius=2.0)]
)
def test_cylinder_side_and_caps(shape: rb.Shape) -> None:
    rng = np.random.default_rng(73)
    angles, heights = rng.uniform(0, 2 * np.pi, N), f32(rng.uniform(1.02, 2.98, N))
    outward = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    points = outward * 2 + np.array([0, 0, 1]) * heights[:, None]
    uv = uv_shown(shape, f32(points + outward), f32(-outward))
    assert cyclic(uv[:, 0] - angles / (2 * np.pi)).max() < LIMIT
    assert np.abs(uv[:, 1] - (heights - 1) / 2).max() < LIMIT
    for z, side in ((3.0, 1), (1.0, -1)):  # the square around the disk, seen from outside
        flat = f32(rng.uniform(-1.4, 1.4, (N, 2)))
        origins = np.column_stack([flat, np.full(N, z + side)])
        caps = uv_shown(shape, origins, np.broadcast_to([0.0, 0, -side], origins.shape))
        assert np.abs(caps - np.column_stack([side * flat[:, 0] / 4 + 0.5, flat[:, 1] / 4 + 0.5])).max() < LIMIT


def test_disk_carries_the_square_around_it() -> None:
    flat = f32(np.random.default_rng(74).uniform(-0.7, 0.7, (N, 2)))
    origins = np.column_stack([flat, np.full(N, 2.0)])
    uv = uv_shown(rb.Disk((0, 0, 0), (0, 0, 1), radius=1.0), origins, np.broadcast_to([0.0, 0, -1], origins.shape))
    assert np.abs(uv - (flat + 1) / 2).max() < LIMIT


def test_textures_move_with_transforms() -> None:
    turned = (
        rb.Transform.translate(5, -3, 2) @ rb.Transform.rotate(40, axis=(1, 2, 3)) @ rb.Transform.scale((1, 2, 0.5))
    )
    p = unit(random_units(np.random.default_rng(75), N))
    plain, moved = rb.Scene(), rb.Scene()
    plain.add(rb.Sphere(), rb.Material())
    moved.add(rb.Sphere(), rb.Material(), transform=turned)
    matrix = np.array(turned.matrix)
    origins, directions = p * 3 @ matrix[:3, :3].T + matrix[:3, 3], -p @ matrix[:3, :3].T
    a, b = plain.intersect(p * 3, -p), moved.intersect(origins, directions)
    clear = np.hypot(p[:, 0], p[:, 1]) > 0.1
    assert cyclic(a["uv"][:, 0] - b["uv"][:, 0])[clear].max() < 2e-6  # largest observed 8.0e-7
    assert np.abs(a["uv"][:, 1] - b["uv"][:, 1])[clear].max() < 2e-6
