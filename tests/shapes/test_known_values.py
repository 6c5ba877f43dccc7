"""Cases with known answers, from the table of hard cases in the design notes."""

import numpy as np
import pytest
from tests.support.support_meshes import on_grid, tube
from tests.support.support_shapes import f32

import raybound as rb

FIELDS = ("t", "t_error", "point", "point_error", "normal", "uv", "next_origin")


def one(shape: rb.Shape, origin: object, direction: object) -> np.void:
    answer = rb.intersect(shape, [origin], [direction])[0]
    for name in FIELDS:
        assert not np.isnan(answer[name]).any(), name
    return answer


DEGENERATE = [
    (-1113.45459, -79.049614, -56.2431908),
    (-1113.45459, -87.0922699, -56.2431908),
    (-1113.45459, -79.2090149, -56.2431908),
]


def test_degenerate_triangle_is_refused() -> None:
    with pytest.raises(ValueError, match="collinear"):
        rb.Polygon(DEGENERATE)


def test_degenerate_triangle_of_a_mesh_is_refused_or_missed() -> None:
    try:
        mesh = rb.Mesh(DEGENERATE, [(0, 1, 2)])
    except ValueError:
        with pytest.raises(ValueError, match=r"^Mesh: "):
            rb.Mesh(DEGENERATE, [(0, 1, 2)])
        return
    origin, direction = (-1081.47925, 99.9999542, 87.7701111), (-32.1072998, -183.355865, -144.607635)
    answer = one(mesh, origin, direction)
    assert not answer["hit"] or answer["t"] > 0.9999


def test_eye_just_above_the_earth() -> None:
    answer = one(rb.Sphere(radius=6371000), (0, 0, 6371000.5), (0, 0, -1))
    assert answer["hit"]
    assert abs(answer["t"] - 0.5) <= answer["t_error"] <= 0.5  # float32 gives exactly 0.5
    assert answer["t"] == 0.5
    assert one(rb.Sphere(radius=6371000), (6371000.5, 0, 0), (-2, 0, 0))["t"] == 0.25


@pytest.mark.parametrize("radius", [1e-4, 0.1, 1.0, 3e5])
@pytest.mark.parametrize("distance", [2.0, 1e3, 1e6, 1e7, 1e9])
def test_ray_through_the_centre(radius: float, distance: float) -> None:
    """Also where t rounds to the distance of the centre itself."""
    for direction in ((1, 0, 0), (0, -1, 0), (1, 1, 1), (-1, 1, 0)):
        answer = one(rb.Sphere(radius=radius), -np.array(direction) * distance * radius, direction)
        assert answer["hit"]
        assert np.linalg.norm(answer["normal"]) == pytest.approx(1, abs=1e-6)
        assert np.dot(answer["normal"], direction) == pytest.approx(-np.linalg.norm(direction), abs=1e-6)


def test_origins_on_slab_planes() -> None:
    """A direction component of zero and an origin exactly on the slab's plane: a touching box is never rejected."""
    box = rb.Box((0, 0, 0), (1, 1, 1))
    for zero in (0.0, -0.0, 1e-45):
        assert one(box, (0, 0.5, -1), (zero, 0, 1))["t"] == 1
        assert one(box, (1, 0.5, -1), (zero, zero, 1))["t"] == 1
        assert one(box, (1, 1, 2), (zero, zero, -1))["t"] == 1
        assert one(box, (0, 0, -1), (zero, zero, 1))["hit"]
    assert not one(box, (np.nextafter(np.float32(1), np.float32(2)), 0.5, -1), (0, 0, 1))["hit"]


def test_denormal_box_is_refused() -> None:
    tiny = 5.693442e-39
    with pytest.raises(ValueError, match="Box: max must be greater than min"):
        rb.Box((tiny, -5000, 5000), (tiny, -5000, 5000))
    with pytest.raises(ValueError, match="Box: max must be greater than min"):
        rb.Box((0, -5000, 0), (tiny, 5000, 5000))


def test_nearest_legal_flat_boxes() -> None:
    """A point grown to the least sizes that are allowed: a miss; a sheet of that thickness: a hit at its middle."""
    thin, step = 2.0**-60, float(np.spacing(np.float32(5000)))
    origin, direction = (-5000, -5000, 5000), (0.70710677, 0.70710677, 0)
    point = rb.Box((0, -5000, 5000), (thin, -5000 + step, 5000 + step))
    assert not one(point, origin, direction)["hit"]
    sheet = one(rb.Box((0, -5000, 0), (thin, 5000, 10000)), origin, direction)
    assert sheet["hit"]
    assert (np.abs(sheet["point"] - (0, 0, 5000)) <= sheet["point_error"] + 1e-3).all()
    for low in (0.0, 1.0, -5000.0):
        flat = rb.Box((low, -5000, 0), (np.nextafter(np.float32(low + thin), np.float32(np.inf)), 5000, 10000))
        assert one(flat, (-6000, 0, 5000), (1, 0, 0))["t"] == pytest.approx(6000 + low, rel=1e-6)
        assert one(flat, (7000, 0, 5000), (-1, 0, 0))["t"] == pytest.approx(7000 - low, rel=1e-6)


QUAD = [(-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)]
DIAGONAL = (0.30458447, 0.30458447, -0.9024725)


def test_ray_at_a_shared_diagonal() -> None:
    answers = [one(rb.Polygon([QUAD[k] for k in face]), (0, 0, 10), DIAGONAL) for face in ((0, 1, 2), (0, 2, 3))]
    hits = [a for a in answers if a["hit"]]
    assert hits
    for a in hits:
        assert (np.abs(a["point"] - (3.375, 3.375, 0)) <= a["point_error"] + 1e-6).all()


def test_ray_at_the_shared_diagonal_of_a_mesh() -> None:
    a = one(rb.Mesh(QUAD, [(0, 1, 2), (0, 2, 3)]), (0, 0, 10), DIAGONAL)
    assert a["hit"]
    assert a["face_id"] in (0, 1)
    assert (np.abs(a["point"] - (3.375, 3.375, 0)) <= a["point_error"] + 1e-6).all()


def test_rays_at_vertices_and_edges_of_nested_cylinders() -> None:
    """From outside, exactly at each vertex and edge of ten nested meshes, inward: each ray hits each at its place."""
    middle = np.array([0, 0, 4.0])
    outer = np.array([(40, 3, 9.0), (-25, 30, -6.0), (8, -50, 5.0), (0, 1, 60.0)])
    aimed = 0
    for k in range(1, 11):
        points, faces = tube(24, float(k), 8.0)
        points = on_grid(points, (0, 0, 0), 64.0).astype(float)
        mesh = rb.Mesh(points, faces)
        edges = np.unique(np.sort(np.concatenate([faces[:, :2], faces[:, 1:], faces[:, ::2]]), axis=1), axis=0)
        targets = np.concatenate([points, (points[edges[:, 0]] + points[edges[:, 1]]) / 2])
        reach = 0.97 * k * np.cos(np.pi / 24)
        for eye in outer:
            # Mirrored at the target, the middle is outside; from the eye, a bit behind the target is inside.
            origins = np.concatenate([2 * targets - middle, np.broadcast_to(eye, targets.shape)])
            directions = np.concatenate([middle - targets, targets - eye])
            behind = targets + 0.1 * k * (targets - eye) / np.linalg.norm(targets - eye, axis=1)[:, None]
            enters = (np.hypot(behind[:, 0], behind[:, 1]) < reach) & (np.abs(behind[:, 2] - 4) < 3.999)
            found = rb.intersect(mesh, f32(origins), f32(directions))
            assert found["hit"][: len(targets)].all()
            assert found["hit"][len(targets) :][enters].all()
            aimed += len(targets) + int(enters.sum())
    assert aimed >= 9000


def test_tiny_far_sphere() -> None:
    answer = one(rb.Sphere(radius=0.1), (-1e7, 0.095, 0), (1, 0, 0))
    assert answer["hit"]
    exact = 1e7 - (float(np.float32(0.1)) ** 2 - float(np.float32(0.095)) ** 2) ** 0.5
    assert exact == pytest.approx(9999999.96877, abs=1e-5)
    assert abs(answer["t"] - exact) <= answer["t_error"] <= 1
    assert abs(answer["point"][0] + 0.03122499) <= answer["point_error"][0] + 1e-8
    assert np.abs(answer["point"] - (-0.0312249912, 0.095, 0)).max() < 1e-7


@pytest.mark.parametrize("distance", [10.0, 100.0, 1000.0, 1e5, 1e7])
def test_no_rings_in_the_cosine(distance: float) -> None:
    """N.V over the unit sphere is sqrt(1 - x^2 - y^2) from any distance, to the rounding of the hit point."""
    axis = np.linspace(-0.999, 0.999, 301)
    x, y = (g.ravel() for g in np.meshgrid(axis, axis))
    keep = x * x + y * y < 0.998
    origins = f32(np.stack([x, y, np.full(x.shape, distance)], axis=1)[keep])
    answers = rb.intersect(rb.Sphere(), origins, np.broadcast_to(f32([0, 0, -1]), origins.shape))
    assert answers["hit"].all()
    exact = np.sqrt(1 - (origins[:, :2].astype(float) ** 2).sum(axis=1))
    # Seen: 6e-8 up to 1000, 1.5e-7 at 1e5.
    assert np.abs(answers["normal"][:, 2] - exact).max() < (1.2e-7 if distance <= 1000 else 1e-6)
    assert len(exact) > 60000


@pytest.mark.parametrize("distance", [10.0, 100.0, 1000.0])
def test_the_cosine_falls_steadily_toward_the_outline(distance: float) -> None:
    """Next to each other, too: where the exact cosine falls, that of the hits does not rise by more than an ulp."""
    x = np.sort(f32(np.sqrt(np.linspace(0, 0.999, 20001))))
    origins = np.stack([x, 0 * x, np.full(x.shape, distance, np.float32)], axis=1)
    cosine = rb.intersect(rb.Sphere(), origins, np.broadcast_to(f32([0, 0, -1]), origins.shape))["normal"][:, 2]
    assert np.diff(cosine).max() <= 2.0**-23
    exact = np.sqrt(1 - x.astype(float) ** 2)
    assert np.abs(cosine / exact - 1).max() < 2.0**-21  # largest observed in the middle: half an ulp
    assert len(np.unique(cosine)) > 15000


@pytest.mark.parametrize(
    "shape", [rb.Cone((0, 0, 0), (0, 0, 1)), rb.Cone((0, 0, 0), (0, 0, 1)).transformed(rb.Transform.scale((1, 2, 1)))]
)
def test_rays_at_an_apex(shape: rb.Shape) -> None:
    """Exactly at the point of a cone: a clean hit there, or none."""
    for direction in ((0, 0, -1), (1, 0, -0.25), (-1, -1, -1), (0.3, 0.2, -2)):
        origin = np.array((0, 0, 1)) - 4 * np.array(direction)
        answer = one(shape, origin, direction)
        if answer["hit"]:
            assert np.abs(answer["point"] - (0, 0, 1)).max() < 1e-3
            assert np.linalg.norm(answer["normal"]) == pytest.approx(1, abs=1e-6)
    assert one(shape, (0, 0, 5), (0, 0, -1))["hit"]


def test_rays_at_a_rim() -> None:
    """Where a cap meets the side: always a hit from above, on either face."""
    cylinder = rb.Cylinder((0, 0, 0), (0, 0, 1), radius=1)
    turn = np.linspace(0, 2 * np.pi, 2000)
    rim = np.stack([np.cos(turn), np.sin(turn), np.ones_like(turn)], axis=1) * [1 - 1e-6, 1 - 1e-6, 1]
    origins = f32(rim + np.array([0.5, 0.25, 3]))
    answers = rb.intersect(cylinder, origins, f32(rim) - origins)
    assert answers["hit"].all()
    assert np.abs(answers["point"] - rim).max() < 1e-4
    assert set(answers["face_id"].tolist()) <= {0, 2}
