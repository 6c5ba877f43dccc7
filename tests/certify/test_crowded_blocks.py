"""A crowd of small polygons in one spot: only the block that it lies in goes ray by ray, not the whole tile."""

import numpy as np
import pytest

import raybound as rb

TILE, BLOCK = 32, 8


def crowd_at(x: float, y: float, count: int) -> rb.Scene:
    """A floor seen from above, a pixel to a unit, with so many triangles over two by two pixels."""
    scene = rb.Scene(ambient=0.2)
    scene.add(rb.Polygon([(-99, -99, 0), (99, -99, 0), (99, 99, 0), (-99, 99, 0)]), rb.Material(0.7))
    rng = np.random.default_rng(9)
    for _ in range(count):
        corner = np.array([x, y, 1]) + rng.uniform(-1, 1, 3) * (1, 1, 0.5)
        scene.add(rb.Polygon(corner + rng.uniform(-0.1, 0.1, (3, 3))), rb.Material((0.9, 0.2, 0.1)))
    scene.add_light(rb.DirectionalLight((0.2, 0.1, -1)))
    return scene


def rendered(scene: rb.Scene) -> tuple[rb.Frame, rb.Frame]:
    """64 x 64 pixels, by both methods; pixel (i, j) sees (i - 31.5, 31.5 - j)."""
    fov = 2 * np.degrees(np.arctan(32 / 500))
    camera = rb.Camera((0, 0, 500), (0, 0, 0), up=(0, 1, 0), fov=fov, width=64, height=64)
    return rb.render(scene, camera, method="base"), rb.render(scene, camera, method="exact", threads=1)


@pytest.mark.parametrize(("i", "j"), [(4, 4), (20, 12), (27, 28), (36, 44)])
def test_only_the_crowded_block_is_traced(i: int, j: int) -> None:
    base, exact = rendered(crowd_at(i - 31.5, 31.5 - j, 300))
    assert base.image.tobytes() == exact.image.tobytes()
    assert (base.object_id == exact.object_id).all()
    traced = exact.path == rb.Path.TRACED
    assert 1 <= traced.sum() <= BLOCK * BLOCK
    assert traced[j // BLOCK * BLOCK :, i // BLOCK * BLOCK :][:BLOCK, :BLOCK].sum() == traced.sum()


def test_crowds_in_several_blocks() -> None:
    scene = crowd_at(4 - 31.5, 31.5 - 4, 300)
    for item in list(crowd_at(20 - 31.5, 31.5 - 20, 300).objects)[1:]:
        scene.add(item.shape, item.material)
    base, exact = rendered(scene)
    assert base.image.tobytes() == exact.image.tobytes()
    traced = exact.path == rb.Path.TRACED
    for block in (traced[0:8, 0:8], traced[16:24, 16:24]):
        assert block.any()
    assert traced.sum() <= 2 * BLOCK * BLOCK


def test_a_few_polygons_are_no_crowd() -> None:
    base, exact = rendered(crowd_at(4 - 31.5, 31.5 - 4, 15))
    assert base.image.tobytes() == exact.image.tobytes()
    assert not (exact.path == rb.Path.TRACED).any()
