"""What is hard about points, rims, coincident and touching faces, and clipped quadrics."""

import numpy as np
import pytest
from tests.support.support_hard import all_scales, flat, hard, rays_of, render

import raybound as rb


@all_scales(["slab-planes"])
def test_rays_in_the_planes_of_faces_meet_touching_boxes(name: str, scale: float) -> None:
    """The middle row and column run within planes of faces; there the boxes touch, and are closed."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    plain = render(*hard(name, 1e-30), name)
    directions = cam.rays()[1]
    if scale < 1e-20:
        assert (directions[24, :, 2] < 1e-20).all()
        assert (directions[:, 32, 1] == 0).all()
    # The nearest boxes of the axis begin at x = 1, four that touch one another along it in pairs.
    assert frame.depth[24, 32] == 6
    rest = np.arange(49) != 24  # in the middle row it is rounding that decides between boxes above and below
    assert (frame.object_id != plain.object_id)[rest].mean() <= (0 if scale < 1e-20 else 0.002)
    assert (frame.object_id[24, 24:41] >= 0).all()


@all_scales(["cone-apex", "cylinder-rim"])
def test_points_and_rims_have_no_gaps(name: str, scale: float) -> None:
    """In each row and column, a surface that is convex in the picture is seen without a hole."""
    scene, cam = hard(name, scale)
    seen = render(scene, cam, name).object_id == 0
    for lines in (seen, seen.T):
        for line in lines:
            where = np.flatnonzero(line)
            if name == "cylinder-rim" and scale >= 1:
                continue  # the smaller one stands before it
            assert len(where) in (0, where[-1] - where[0] + 1 if len(where) else 0)
    assert seen.sum() > 300


@all_scales(["cylinder-rim"])
def test_light_along_a_cylinder_stays_on_its_cap(name: str, scale: float) -> None:
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    hits = scene.intersect(*rays_of(cam))
    large = hits["object_id"] == 0
    values = flat(frame.image)[:, 0]
    side = large & (hits["face_id"] == 0)
    cap = large & (hits["face_id"] == 2)
    assert (values[side] == np.float32(0.7) * np.float32(0.25)).all()
    if scale < 1:
        assert (np.abs(values[cap] - 0.7 * (0.25 + 0.7)) < 1e-6).all()
    assert side.sum() > 300
    assert cap.sum() > 300 or scale >= 1


@all_scales(["csg-coincident"])
def test_combinations_with_common_faces_are_those_without(name: str, scale: float) -> None:
    """Three equal boxes' intersection is one of them; the picture is the same wherever it is made."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    single = scene.copy()
    single.objects[3].shape = scene.objects[3].shape.shapes[0]
    assert render(single, cam, name).image.tobytes() == frame.image.tobytes()
    near, cam1 = hard(name, 1.0)
    assert (frame.object_id != render(near, cam1, name).object_id).mean() <= 0.003
    for index, lowest in ((0, 150), (1, 60), (3, 30)):
        assert (frame.object_id == index).sum() > lowest


@all_scales(["csg-coincident"])
def test_unions_with_common_faces_have_no_inner_walls(name: str, scale: float) -> None:
    """Rays through the stairs and the pillar: in, and out at the far side."""
    scene, _ = hard(name, scale)
    unit = (scene.bounds[1, 2] - scene.bounds[0, 2]) / 2.25
    for index, origin, direction, way in (
        (0, (-4.5, 0.5, 0.5), (1.0, 0, 0), 2.0),
        (0, (-3.0, 0.5, 3.0), (0, 0, -1.0), 2.0),
        (1, (0.0, 0.5, 3.25), (0, 0, -1.0), 2.25),
        (1, (0.125, 0.625, 3.25), (0, 0, -1.0), 2.25),
    ):
        shape = scene.objects[index].shape
        o = np.add(np.multiply(origin, unit), (scale, 0, 0))
        first = rb.intersect(shape, [o], [direction])[0]
        second = rb.intersect(shape, [first["point"] + 0.0625 * unit * np.array(direction)], [direction])[0]
        assert first["hit"]
        assert second["hit"]
        assert np.linalg.norm(second["point"] - first["point"]) == pytest.approx(way * unit, rel=1e-3)


def first_in_quadric(shape: rb.Shape, o: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where rays enter {q <= 0} within the box, inf for none; and whether they are too near to missing it to tell."""
    a, b, c, e, f, g, *rest = (float(x) for x in shape.coefficients)
    square, linear, constant = np.array([[a, e / 2, g / 2], [e / 2, b, f / 2], [g / 2, f / 2, c]]), rest[:3], rest[3]
    with np.errstate(all="ignore"):
        walls = np.sort((np.array([shape.clip.min, shape.clip.max])[:, None] - o) / d, axis=0)
        start, end = walls[0].max(axis=1), walls[1].min(axis=1)
        p = o + d * start[:, None]  # from here numbers are small
        qa, qb = ((d @ square) * d).sum(axis=1), ((p @ square) * d).sum(axis=1) + d @ linear / 2
        qc = ((p @ square) * p).sum(axis=1) + p @ linear + constant
        discriminant = qb * qb - qa * qc
        sum_ = -qb - np.copysign(np.sqrt(np.maximum(discriminant, 0)), qb)
        roots = np.sort(np.stack([sum_ / qa, qc / sum_]), axis=0)
        inside = np.where((roots > 0) & (discriminant > 0), roots, np.inf).min(axis=0)
        t = np.where(qc <= 0, 0, inside)
        hit = (end > start) & (t <= end - start)
        doubtful = (np.abs(end - start) < 1e-3) | (np.abs(t - (end - start)) < 1e-3)
        doubtful |= ((np.abs(discriminant) < 1e-5) & ~(qc < -1e-5)) | (np.abs(qc) < 1e-5)
    return np.where(hit, start + t, np.inf), doubtful & (end > start - 1e-3)


@all_scales(["quadric-clip"])
def test_clipped_quadrics_are_seen_where_they_are(name: str, scale: float) -> None:
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    o, d = rays_of(cam)
    ids, depth = frame.object_id.ravel(), frame.depth.ravel()
    expected, doubtful = np.full(len(o), np.inf), np.zeros(len(o), bool)
    for item in scene.objects[2:]:
        t, unsure = first_in_quadric(item.shape, o - item.transform.matrix[:3, 3], d)
        expected, doubtful = np.minimum(expected, t), doubtful | unsure
        assert (ids == item.id).sum() > 20
    ball = ids == 1  # it stands before them, in part
    clear = ~doubtful & ~ball
    assert ((ids >= 2) == np.isfinite(expected))[clear].all()
    seen = clear & (ids >= 2)
    assert np.abs(depth[seen] - expected[seen]).max() < 1e-4
    assert seen.sum() > 300
    assert clear.mean() > 0.8
