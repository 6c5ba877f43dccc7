"""Cases with known answers, from the table of hard cases in the design notes."""

import numpy as np
import pytest
from tests.support.support_shapes import f32

import raybound as rb

FIELDS = ("t", "t_error", "point", "point_error", "normal", "uv", "next_origin")


def one(shape: rb.Shape, origin: object, direction: object) -> np.void:
    answer = rb.intersect(shape, [origin], [direction])[0]
    for name in FIELDS:
        assert not np.isnan(answer[name]).any(), name
    return answer


def test_degenerate_triangle_is_refused() -> None:
    with pytest.raises(ValueError, match="collinear"):
        rb.Polygon(
            [
                (-1113.45459, -79.049614, -56.2431908),
                (-1113.45459, -87.0922699, -56.2431908),
                (-1113.45459, -79.2090149, -56.2431908),
            ]
        )


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


def test_ray_at_a_shared_diagonal() -> None:
    first = rb.Polygon([(-5, -5, 0), (5, -5, 0), (5, 5, 0)])
    second = rb.Polygon([(-5, -5, 0), (5, 5, 0), (-5, 5, 0)])
    answers = [one(shape, (0, 0, 10), (0.30458447, 0.30458447, -0.9024725)) for shape in (first, second)]
    hits = [a for a in answers if a["hit"]]
    assert hits
    for a in hits:
        assert (np.abs(a["point"] - (3.375, 3.375, 0)) <= a["point_error"] + 1e-6).all()


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
