"""What is hard about scenes of all sizes, far away, and moved by transforms."""

import numpy as np
import pytest
from tests.support.support_hard import CASES, all_scales, flat, hard, rays_of, render
from tests.support.support_light import f32

import raybound as rb


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
