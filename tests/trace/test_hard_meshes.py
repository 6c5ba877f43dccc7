"""What is hard about meshes with needles, with triangles of all sizes, and far away."""

import numpy as np
from tests.support.support_hard import all_scales, hard

import raybound as rb
from raybound.scenes.hard.meshes import globe


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
