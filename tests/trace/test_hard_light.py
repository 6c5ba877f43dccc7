"""What is hard about the hard cases of light: mirrors, glass, many bounces, contacts, grazing light."""

import numpy as np
from tests.support.support_hard import CASES, all_scales, flat, hard, rays_of, render
from tests.support.support_light import f32
from tests.support.support_paths import folded, path_in_sphere

import raybound as rb

IOR = 1.5


@all_scales(["far-mirror"])
def test_images_in_a_far_mirror_are_in_their_places(name: str, scale: float) -> None:
    """The mirror is x = y: what it shows is what an eye behind it sees, with x and y exchanged, without the mirror."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    mirror, (o, d) = frame.object_id.ravel() == 0, rays_of(cam)
    behind = scene.copy()
    behind.objects[0].remove()
    with rb.Renderer(behind) as renderer:
        image = renderer.trace(o[mirror][:, [1, 0, 2]], d[mirror][:, [1, 0, 2]])
    expected = image.radiance * f32((0.92, 0.93, 0.95))
    differs = np.abs(flat(frame.image)[mirror] - expected).max(axis=1) > 0.01  # one part in 128 of a ball's radius
    assert differs.mean() <= 0.02  # on outlines; largest observed 0.0047
    assert mirror.sum() > 800
    assert len(np.unique(image.object_id)) == 6
    assert (flat(frame.image)[mirror].max(axis=1) > 0.02).all()


@all_scales(["critical-angle"])
def test_total_reflection_begins_exactly_at_the_critical_angle(name: str, scale: float) -> None:
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    d = rays_of(cam)[1]
    sine = np.hypot(d[:, 0], d[:, 1]) / np.linalg.norm(d, axis=1) * IOR
    checked = totals = 0
    for row in range(49):
        for column in (0, 20, 32, 47, 64):
            tree, exact = frame.explain(column, row).tree, sine[row * 65 + column]
            if abs(exact - 1) > 4e-7:  # four roundings
                assert tree["total_internal_reflection"] == (exact > 1), (row, column, exact)
                (child,) = tree["children"]
                assert child["kind"] == ("reflected" if exact > 1 else "refracted")
                checked, totals = checked + 1, totals + int(exact > 1)
    assert checked >= 200
    assert min(totals, checked - totals) >= 20


@all_scales(["light-pipe"])
def test_a_light_pipe_shows_the_unfolded_panel(name: str, scale: float) -> None:
    """Within the rod a ray is straight in the unfolded rod: the quadrant that it ends in is known."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    o, d = rays_of(cam)
    d = d / np.linalg.norm(d, axis=1)[:, None]
    entry = o + d * (-o[:, 1] / d[:, 1])[:, None]
    enters = (np.abs(entry[:, 0]) < 0.499) & (np.abs(entry[:, 2]) < 0.499)
    inside = d / IOR
    inside[:, 1] = np.sqrt(1 - (inside[:, [0, 2]] ** 2).sum(axis=1))
    unfolded = entry + inside * (scale / inside[:, 1])[:, None]
    bounces = np.floor(unfolded + 0.5)[:, [0, 2]].astype(int)
    leaves = folded(unfolded, -0.5, 0.5)
    # Each bounce turns a component round, and so the direction behind the rod.
    away = d[:, [0, 2]] * (1 - 2 * (bounces % 2)) / d[:, 1:2]
    panel = leaves[:, [0, 2]] + 0.25 * away
    material = {(False, False): 1, (True, False): 2, (False, True): 3, (True, True): 4}
    expected = np.array([f32(scene.objects[material[tuple(p)]].material.diffuse) for p in (panel > 0).tolist()])
    # Near a corner of the rod or of a quadrant it is rounding that decides.
    clear = enters & (np.abs(panel) > 1e-3).all(axis=1) & (np.abs(np.abs(leaves[:, [0, 2]]) - 0.5) > 1e-3).all(axis=1)
    assert (np.abs(flat(frame.image) - expected)[clear].max(axis=1) < 1e-6).all()
    assert clear.sum() > 500
    assert np.abs(bounces).max() >= min(scale / 4, 10)


@all_scales(["mirror-corridor"])
def test_a_mirror_corridor_shows_each_image_in_its_place(name: str, scale: float) -> None:
    """The unfolded way is straight: balls, wall and sky, dimmed by one mirror for each plane x = n on the way."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    o, d = rays_of(cam)
    silver, lit = f32((0.985, 0.99, 0.98)), 0.9
    end, doubtful = scale / d[:, 1], np.zeros(len(d), bool)
    colour = np.broadcast_to(f32(scene.background), d.shape).copy()
    far = o + d * ((scale + 0.5) / d[:, 1])[:, None]
    x = far[:, 0] - np.floor((o + d * end[:, None])[:, 0])  # behind the mirrors' ends the way is straight
    turned = np.floor((o + d * end[:, None])[:, 0]) % 2 == 1
    x = np.where(turned, 1 - x, x)
    wall = (x > -1) & (x < 2) & (far[:, 2] < 0)
    doubtful |= (np.abs(x + 1) < 1e-3) | (np.abs(x - 2) < 1e-3) | (np.abs(far[:, 2]) < 1e-3)
    colour[wall] = lit * f32(scene.objects[5].material.diffuse)
    stop = end.copy()
    for item in scene.objects[2:5]:
        _, y, z = item.shape.center
        for image in np.arange(0.5, 2.5 * scale + 3):
            w = o - (image, y, z)
            b, c = (w * d).sum(axis=1), (w * w).sum(axis=1) - float(f32(0.125)) ** 2
            inside = b * b - c
            t = -b - np.sqrt(np.maximum(inside, 0))
            hit = (inside > 0) & (t < stop)
            doubtful |= np.abs(inside) < 1e-4
            stop, colour = np.where(hit, t, stop), np.where(hit[:, None], lit * f32(item.material.diffuse), colour)
    passed = np.floor((o + d * stop[:, None])[:, 0])
    place = (o + d * stop[:, None])[:, 0] % 1
    doubtful |= (stop == end) & (np.minimum(place, 1 - place) < 1e-3)
    expected = colour * silver ** np.maximum(passed, 0)[:, None]
    differs = np.abs(flat(frame.image) - expected).max(axis=1) > 1e-4
    assert not (differs & ~doubtful).any()
    assert doubtful.mean() < 0.15
    assert passed.max() >= 1.2 * scale
    assert len(np.unique(expected.round(3), axis=0)) > 20


@all_scales(["mirror-sphere"])
def test_paths_in_a_mirrored_sphere_are_those_of_exact_arithmetic(name: str, scale: float) -> None:
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    radius, total, longest = float(f32(scale)), 0, 0
    for y in range(4, 49, 10):
        for x in range(4, 65, 10):
            nodes = [frame.explain(x, y).tree]
            while nodes[-1]["children"]:
                nodes += nodes[-1]["children"]
            mirrored = [node for node in nodes if node["object_id"] == 0]
            if mirrored:
                way = path_in_sphere(nodes[0]["origin"], nodes[0]["direction"], radius, len(mirrored))
                errors = [np.linalg.norm(np.subtract(n["point"], p)) / radius for n, p in zip(mirrored, way)]
                assert max(errors) < 1e-3  # errors grow with the square of the bounces; largest observed 1e-4
                total, longest = total + 1, max(longest, len(mirrored))
    assert total >= 20
    assert longest == CASES[name].max_depth


@all_scales(["touching-glass"])
def test_a_common_face_of_two_glass_blocks_counts_once(name: str, scale: float) -> None:
    """A ray that leaves a block there enters the other at the same t: the entered face is seen, at all pixels alike."""
    scene, _ = hard(name, scale)
    first, second = scene.objects[144].id, scene.objects[145].id
    passed = 0
    for y in np.linspace(0.1, 0.7, 7):
        for slope in (-0.0625, 0.0, 0.03125):
            eye = np.array([-2.0, y, 0.5]) * scale
            cam = rb.Camera(eye, eye + np.array([1.0, slope / 4, slope]) * scale, fov=1.0, width=1, height=1)
            nodes = [rb.render(scene, cam, max_depth=6).explain(0, 0).tree]
            while through := [c for c in nodes[-1]["children"] if c["kind"] == "refracted"]:
                nodes += through
            assert [n["object_id"] for n in nodes[:3]] == [first, second, second]
            assert [n["point"][0] for n in nodes[:3]] == [np.float32(x * scale) for x in (-1.5, -0.25, 1.0)]
            for one, other in ((2, 1), (3, 0)):  # equal indices bend nothing; then out again
                assert np.abs(np.subtract(nodes[one]["direction"], nodes[other]["direction"])).max() < 1e-6
            passed += 1
    assert passed == 21


@all_scales(["contact-shadow"])
def test_the_shadow_begins_at_the_contact(name: str, scale: float) -> None:
    """All pixels of the floor against the closed form; those at the contact are dark."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    floor, (o, d) = frame.object_id.ravel() == 0, rays_of(cam)
    points = o + d * (-o[:, 2] / d[:, 2])[:, None]
    toward = -f32(scene.lights[0].light.direction)
    w = np.array([0.0, 0.0, 1.0]) - points
    along = (w @ toward) / np.linalg.norm(toward)
    margin = np.sqrt((w**2).sum(axis=1) - along**2) - 1
    clear = floor & (np.abs(margin) > 1e-5 * (1 + np.abs(points).max(axis=1)))
    lit = flat(frame.image)[:, 1] > 0.3
    assert (lit == (margin > 0))[clear].all()
    assert clear.sum() > 0.9 * floor.sum()
    assert (clear & (margin < 0)).sum() > 60
    assert (clear & (margin > 0)).sum() > 300


@all_scales(["grazing-light"])
def test_grazing_light_leaves_no_speckles(name: str, scale: float) -> None:
    """The floor before the wall has one radiance; the wall's shadow is dark throughout."""
    scene, cam = hard(name, scale)
    frame = rb.render(scene, cam.replace(width=193, height=145))
    floor = frame.object_id.ravel() == 0
    o, d = rays_of(frame.camera)
    x, y = (o + d * (-o[:, 2] / d[:, 2])[:, None]).T[:2]
    values = flat(frame.image)
    light = scene.lights[0].light
    slope, strength = float(f32(scale)), f32(light.radiance[0])
    diffuse = f32(scene.objects[0].material.diffuse)
    free = floor & ((x < -4.01) | (y < -2.6) | ((y > -1.4) & (y < -1.01)) | ((y > 3.01) & (y < 3.4)))
    expected = diffuse * (0.25 + strength * slope / np.hypot(1, slope))
    assert np.abs(values[free] / expected - 1).max() < 1e-6
    reach = min(5.0, scene.objects[1].shape.max[2] / slope)
    shaded = floor & (x > -3.74) & (x < -3.76 + reach) & (y > -0.99) & (y < 2.99)
    assert np.abs(values[shaded] / (diffuse * 0.25) - 1).max() < 1e-6
    assert free.sum() > 4000
    assert shaded.sum() > 1000


@all_scales(["light-on-surface"])
def test_lights_that_all_but_touch_do_not_shine_through(name: str, scale: float) -> None:
    """The wall above the lights is lit by all three; the sides of what carries them, and the floor near it, by none."""
    scene, cam = hard(name, scale)
    frame = rb.render(scene, cam.replace(width=193, height=145))
    ids, (o, d), values = frame.object_id.ravel(), rays_of(frame.camera), flat(frame.image)
    hits = scene.intersect(o, d)
    z = hits["point"][:, 2]
    wall = (ids == 1) & (z > 1.01 + scale)
    expected = np.full(wall.sum(), 0.25)
    for lamp in scene.lights:
        w = f32(lamp.light.position) - hits["point"][wall].astype(float)
        expected += 0.5 * np.abs(w[:, 1]) / np.linalg.norm(w, axis=1)
    assert np.abs(values[wall][:, 0] / f32(0.75) - expected).max() < 1e-5
    side = (ids == 3) & (hits["face_id"] == 2) & (z < 0.99)  # the front of the box
    assert side.sum() > 200
    if scale <= 0.01:
        # Nothing but the light on the ball could reach it, and that is hidden by the ball.
        assert (values[side][:, 2] == np.float32(0.66) * np.float32(0.25)).all()
        near = (ids == 0) & (np.hypot(hits["point"][:, 0] - 0.0, hits["point"][:, 1]) < 1.25)
        assert near.sum() > 100
        assert np.abs(values[near][:, 0] / (0.25 * f32(0.48)) - 1).max() < 1e-6
    assert wall.sum() > 4000
