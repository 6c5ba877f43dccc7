"""What is hard about the hard cases of geometry: scales, distances, grazing views, edges, transforms, meshes."""

import numpy as np
import pytest
from tests.support.support_hard import CASES, all_scales, flat, hard, rays_of, render
from tests.support.support_light import f32

import raybound as rb
from raybound.scenes.hard.meshes import globe

SKY = f32((0.30, 0.42, 0.58))


@pytest.mark.parametrize(
    ("name", "scale"),
    [(n, 2.0**k) for n, exponents in (("scene-scale", (-20, -3, 7, 20)), ("huge", (57, 40)), ("tiny", (-59, -40)))
     for k in exponents],
)  # fmt: skip
def test_a_power_of_two_changes_no_byte(name: str, scale: float) -> None:
    """No length of its own is anywhere: no epsilon, no smallest distance; nothing overflows or underflows."""
    scene, cam = hard(name, scale)
    plain, cam1 = hard("scene-scale", 1.0)
    shown, expected = render(scene, cam, name), render(plain, cam1, name)
    assert len(np.unique(expected.object_id)) == 8
    assert shown.image.tobytes() == expected.image.tobytes()
    assert (shown.object_id == expected.object_id).all()
    assert (shown.depth == expected.depth * np.float32(scale)).all()


@all_scales(["scene-scale", "huge", "tiny", "touching-boxes"])
def test_other_scales_change_outlines_only(name: str, scale: float) -> None:
    scene, cam = hard(name, scale)
    plain, cam1 = hard(name, CASES[name].default)
    difference = np.abs(flat(render(scene, cam, name).image) - flat(render(plain, cam1, name).image)).max(axis=1)
    assert (difference > 1e-4).mean() <= 0.003  # largest observed 0.0006


@all_scales(["two-scales"])
def test_a_tiny_ball_on_a_vast_floor_has_its_shadow(name: str, scale: float) -> None:
    """All pixels of the floor near the ball, against the closed form."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    o, d = rays_of(cam)
    points = (o - d * (o[:, 2] / d[:, 2])[:, None]) / scale
    ball = (frame.object_id.ravel() == 0) & (np.hypot(points[:, 0], points[:, 1]) < 5) & (points[:, 0] > -0.5)
    to_light = -np.array([0.5, 0.375, -1.0])
    w = np.array([0.0, 0.0, 1.0]) - points
    along = (w @ to_light) / np.linalg.norm(to_light)
    margin = np.sqrt((w**2).sum(axis=1) - along**2) - 1
    clear = ball & (np.abs(margin) > 1e-3)
    lit = flat(frame.image)[:, 0] > 0.2
    assert (lit == (margin > 0))[clear].all()
    assert (clear & (margin < 0)).sum() > 30
    assert (clear & (margin > 0)).sum() > 200


@all_scales(["far-eye"])
def test_the_shading_of_far_spheres_has_no_rings(name: str, scale: float) -> None:
    """Radiance on the balls is that of the exact normals, up to the last digits."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    ids, shown = frame.object_id.ravel(), flat(frame.image)
    o, d = rays_of(cam)
    d = d / np.linalg.norm(d, axis=1)[:, None]
    near = o + d * (-o[:, 1] / d[:, 1])[:, None]  # in the plane of the balls' centres, where numbers are small
    lamp = np.array([-0.5, 0.625, -0.75])
    lamp = lamp / np.linalg.norm(lamp)
    checked = 0
    for item in scene.objects:
        if isinstance(item.shape, rb.Sphere):
            at = np.flatnonzero(ids == item.id)
            w = near[at] - f32(item.shape.center)
            b = (w * d[at]).sum(axis=1)
            inside = b * b - (w * w).sum(axis=1) + 1
            normal = w + d[at] * (-b - np.sqrt(np.maximum(inside, 0)))[:, None]
            cosine = np.maximum(-(normal @ lamp), 0)
            expected = f32(item.material.diffuse) * (0.25 + 0.9 * cosine)[:, None]
            fair = inside > 1e-4  # not within 1/100 of a radius from the outline
            assert np.abs(shown[at] - expected)[fair].max(initial=0) < 1e-5  # largest observed 6e-7
            checked += int(fair.sum())
    assert checked > (100 if scale < 1e7 else 80)


@all_scales(["grazing-plane", "grazing-cylinder", "grazing-cone", "grazing-sphere"])
def test_nothing_shades_or_mirrors_itself_at_grazing_angles(name: str, scale: float) -> None:
    """The surface alone: all of it is lit, and mirrors the sky, not itself."""
    scene, cam = hard(name, scale)
    for item in scene.objects[1:]:
        item.remove()
    frame = render(scene, cam, name)
    seen = frame.object_id == 0
    o, d = rays_of(cam)
    hits = scene.intersect(o[seen.ravel()], d[seen.ravel()])
    light = scene.lights[0].light
    toward = -f32(light.direction) / np.linalg.norm(f32(light.direction))
    cosine = hits["normal"].astype(float) @ toward
    expected = f32((0.42, 0.40, 0.37)) * (0.25 + f32(light.radiance[0]) * cosine)[:, None] + 0.35 * SKY
    assert np.abs(frame.image[seen] - expected).max() < 2e-6
    assert seen.mean() > 0.3
    assert cosine.min() > 0.5


@pytest.mark.parametrize(
    "shape",
    [
        rb.Sphere((0, 0, -1), 1.0),
        rb.Cylinder((0, -2, -1), (0, 2, -1), radius=1.0),
        rb.Cone((-1, 0, -3), (3, 0, 0), radius=3.75).transformed(rb.Transform.rotate(90.0)),
    ],
    ids=["sphere", "cylinder", "cone"],
)
def test_tangent_rays_do_not_see_the_inside(shape: rb.Shape) -> None:
    """A ray that begins outside, and touches within rounding, misses or sees the lit outside: never the dark inside."""
    rng = np.random.default_rng(4)
    scene = rb.Scene()
    scene.add(shape, rb.Material(1.0))
    scene.add_light(rb.DirectionalLight((0, 0, -1)))
    n = 4000
    o = np.column_stack([-(10 ** rng.uniform(-5, 1, n)), rng.choice([0.0, 0.25], n), np.zeros(n)])
    d = np.column_stack([np.ones(n), rng.choice([-1, 0, 1], n) * 10 ** rng.uniform(-12, -4, n), np.zeros(n)])
    d[:, 2] = rng.choice([0.0, 0.0, 1e-12, -1e-12, -1e-9], n)
    with rb.Renderer(scene) as renderer:
        found = renderer.trace(o, d)
    hit = found.object_id == 0
    assert hit.sum() > 500
    dark = hit & (found.radiance[:, 0] < 0.5)
    assert not dark.any(), (int(dark.sum()), o[dark][0].tolist(), d[dark][0].tolist())


@all_scales(["grazing-plane"])
def test_images_in_a_grazing_mirror_are_in_their_places(name: str, scale: float) -> None:
    """What the floor mirrors is what an eye below it sees without the floor."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    below, o, d = scene.copy(), *rays_of(cam)
    floor = frame.object_id.ravel() == 0
    for lamp in below.lights:
        lamp.remove()
    without_light = render(below, cam, name)  # the floor's own light is constant then, and its shadows do not matter
    below.objects[0].remove()
    with rb.Renderer(below) as renderer:
        image = renderer.trace(o[floor] * [1, 1, -1], d[floor] * [1, 1, -1])
    # Rays from below must not meet the feet of things, which are below the floor.
    inside = (image.object_id >= 1) & (flat(without_light.image)[floor][:, 2] > 0.3)
    shown = flat(without_light.image)[floor] - f32((0.42, 0.40, 0.37)) * 0.25
    differs = np.abs(shown - 0.35 * image.radiance).max(axis=1) > 1e-3
    assert (differs & ~inside).mean() < 0.02
    if scale >= 1e-5:
        assert (image.object_id >= 1).sum() > 100


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


@all_scales(["rotation-chain"])
def test_a_thousand_steps_come_back(name: str, scale: float) -> None:
    """Rounding moves an object by at most half a unit in the last place a step."""
    scene, cam = hard(name, scale)
    for item in scene.objects[1:]:
        drift = np.abs(item.transform.matrix - np.eye(4)).max()
        assert drift <= 2.0**-23 * scale + 2.0**-22  # largest observed 2.9e-6 after 1000 steps
        assert scale < 100 or drift > 0
    frame, plain = render(scene, cam, name), render(*hard(name, 1.0), name)
    assert (frame.object_id != plain.object_id).mean() <= 0.002
    assert (np.abs(frame.image - plain.image).max(axis=2) > 1e-3).mean() <= 0.004


@all_scales(["transform-scales"])
def test_transforms_undo_the_size_of_shapes(name: str, scale: float) -> None:
    frame, plain = render(*hard(name, scale), name), render(*hard(name, 1.0), name)
    assert (frame.object_id != plain.object_id).mean() <= 0.001
    assert (np.abs(frame.image - plain.image).max(axis=2) > 1e-4).mean() <= 0.002
    assert len(np.unique(frame.object_id)) == 6


@all_scales(["near-singular"])
def test_squashed_shapes_become_flat_ones(name: str, scale: float) -> None:
    """Normals: all that is seen of the flattened cap of the cylinder shows one colour, as a disk would."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    top = np.array([1.0, 0.25, 0.0])
    turn = rb.Transform.rotate(65.0, top).matrix[:3, :3]
    hits = scene.intersect(*rays_of(cam))
    cylinder = (hits["object_id"] == 3) & (hits["face_id"] != 0)
    assert cylinder.sum() > 10
    normal = np.abs(hits["normal"][cylinder] @ turn[:, 2])
    assert (normal > 1 - 1e-6).all()
    if scale <= 1e-3:
        thinner = render(*hard(name, scale / 8), name)
        assert (frame.object_id != thinner.object_id).mean() <= 0.002


@all_scales(["graded-mesh", "far-mesh"])
def test_every_ray_from_inside_meets_the_mesh(name: str, scale: float) -> None:
    scene, cam = hard(name, scale)
    frame = rb.render(scene, cam.replace(width=193, height=145), max_depth=1)
    assert (frame.object_id >= 0).all()
    assert (frame.object_id == 0).mean() > 0.5


@all_scales(["far-mesh"])
def test_a_mesh_shades_itself_at_its_edges_only(name: str, scale: float) -> None:
    """Faces see all of the room: one that hides the light from another does so within rounding of their edge."""
    scene, cam = hard(name, scale)
    frame = rb.render(scene, cam.replace(width=193, height=145))
    mesh = scene.objects[0].shape
    step = float(np.spacing(np.float32(np.abs(mesh.bounds).max())))
    hidden = blocked = 0
    for y, x in np.argwhere((frame.object_id == 0) & (frame.image[..., 0] < 0.25)):
        tree = frame.explain(int(x), int(y)).tree
        (light,) = tree["lights"]
        blocked += 1
        if light["verdict"] != "lit" and light["blocker"] <= 0:
            corners = np.asarray(mesh.vertices, float)[np.asarray(mesh.faces)[tree["face_id"]]]
            along = np.roll(corners, -1, axis=0) - corners
            across = np.cross(np.array(tree["point"]) - corners, along)
            assert (np.linalg.norm(across, axis=1) / np.linalg.norm(along, axis=1)).min() <= 2 * step
            hidden += 1
    assert blocked > 300
    assert hidden <= 0.01 * 193 * 145


@all_scales(["needle-mesh"])
def test_no_light_leaks_out_of_a_closed_mesh(name: str, scale: float) -> None:
    """The lamp inside alone: all that is seen from outside is black."""
    scene, cam = hard(name, scale)
    scene.lights[1].remove()
    scene.ambient = scene.background = 0.0
    frame = rb.render(scene, cam.replace(width=193, height=145))
    assert {0, 1} <= set(np.unique(frame.object_id))
    assert not frame.image.any()


def test_globes_are_closed() -> None:
    """Each edge has two faces, once in either direction, and all faces look outward."""
    vertices, faces = globe(np.array([0.5, 1.0, 2.5]), np.arange(7) * (2 * np.pi / 7))
    edges = [tuple(e) for f in faces.tolist() for e in (f[:2], f[1:], (f[2], f[0]))]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    assert len(vertices) - len(edges) / 2 + len(faces) == 2
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    assert ((np.cross(b - a, c - a) * (a + b + c)).sum(axis=1) > 0).all()
