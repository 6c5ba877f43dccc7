"""Where a chart goes around an axis, textures end with v: no pole takes colour from the other one."""

import pickle

import numpy as np
import pytest

import raybound as rb
from raybound import _core

HEIGHT, WIDTH = 8, 16
WHITE_ABOVE = np.zeros((HEIGHT, WIDTH, 3), np.float32)
WHITE_ABOVE[: HEIGHT // 2] = 1
SIDES = {
    "sphere": rb.Sphere(),
    "framed sphere": rb.Sphere().transformed(rb.Transform.scale((1, 1, 1.5))),
    "cylinder": rb.Cylinder((0, 0, -1), (0, 0, 1)),
    "cone": rb.Cone((0, 0, -1), (0, 0, 1), radius=1.0, top_radius=0.5),
    "quadric": rb.Quadric((1, 1, 0, 0, 0, 0, 0, 0, 0, -1), rb.Box((-1.5, -1.5, -1), (1.5, 1.5, 1))),
    "part of a union": rb.Union(rb.Box((5, 5, 5), (6, 6, 6)), rb.Sphere()),
}


def seen(shape: rb.shapes.Shape, texture: rb.Texture, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    scene = rb.Scene(ambient=1)
    scene.add(shape, rb.Material(texture))
    with rb.Renderer(scene) as renderer:
        return renderer.trace(origins, directions).radiance


def along_the_side(shape: rb.shapes.Shape, texture: rb.Texture, n: int = 3000) -> tuple[np.ndarray, np.ndarray]:
    """v and colours, seen from the side all the way up."""
    low, high = shape.bounds if not isinstance(shape, rb.Union) else rb.Sphere().bounds
    z = np.linspace(low[2], high[2], n + 2)[1:-1]
    origins = np.stack([np.full(n, 3.0), 0 * z, z], axis=1)
    directions = np.tile([-1.0, 0, 0], (n, 1))
    scene = rb.Scene()
    scene.add(shape, rb.Material())
    hits = scene.intersect(origins, directions)
    assert hits["hit"].sum() >= n // 2
    colours = seen(shape, texture, origins, directions)
    return hits["uv"][hits["hit"], 1], colours[hits["hit"]]


def test_the_poles_of_a_globe() -> None:
    x = np.array([0, 0.02, 0.1, 0.18])
    for sign, expected in ((1, 1), (-1, 0)):
        origins = np.stack([x, 0 * x, 0 * x + 5 * sign], axis=1)
        colours = seen(rb.Sphere(), rb.Texture(WHITE_ABOVE), origins, np.tile([0, 0, -1.0 * sign], (4, 1)))
        assert (colours == expected).all()


@pytest.mark.parametrize("scale", [1, 2, 3, -1, -2, 1.5, 0.75])
@pytest.mark.parametrize("name", SIDES)
def test_only_the_ends_differ_from_repeat(name: str, scale: float) -> None:
    rng = np.random.default_rng(3)
    texels = rng.random((HEIGHT, WIDTH, 3), np.float32)
    v, colours = along_the_side(SIDES[name], rb.Texture(texels, (1, scale)))
    _, repeated = along_the_side(SIDES[name], rb.Texture(texels, (1, scale), wrap="repeat"))
    half_texel = 0.5 / HEIGHT / abs(scale)
    inside = (v > half_texel * 1.001) & (v < 1 - half_texel * 1.001)
    assert inside.sum() > 100
    assert (colours[inside] == repeated[inside]).all()
    ends = [v < half_texel * 0.9, v > 1 - half_texel * 0.9]
    assert sum(end.any() for end in ends) == 2
    if float(scale).is_integer():
        rows = texels[::-1]
        for end, row in zip(ends, (rows[0], rows[-1]) if scale > 0 else (rows[-1], rows[0]), strict=True):
            lowest, highest = row.min(axis=0), row.max(axis=0)
            assert (colours[end] >= lowest * (1 - 1e-6)).all()
            assert (colours[end] <= highest * (1 + 1e-6)).all()
            assert (repeated[end] != colours[end]).any()


def test_around_the_axis_there_is_no_seam() -> None:
    around = np.zeros((1, WIDTH, 3))
    around[0, :, 0] = 0.5 + 0.5 * np.sin(2 * np.pi * (np.arange(WIDTH) + 0.5) / WIDTH)
    a = np.linspace(-0.2, 0.2, 2001)
    origins = np.stack([5 * np.cos(a), 5 * np.sin(a), 0 * a], axis=1)
    steps = np.abs(np.diff(seen(rb.Sphere(), rb.Texture(around), origins, -origins)[:, 0]))
    assert 0 < steps.max() < 0.001


@pytest.mark.parametrize("shape", [rb.Disk(), rb.Box((-1, -1, -1), (1, 1, 0)), rb.Cylinder((0, 0, -1), (0, 0, 0))])
def test_flat_charts_repeat_as_they_did(shape: rb.shapes.Shape) -> None:
    texels = np.random.default_rng(4).random((4, 4, 3), np.float32)
    x = np.random.default_rng(5).uniform(-0.7, 0.7, (500, 2))
    origins, directions = np.column_stack([x, np.full(500, 3.0)]), np.tile([0, 0, -1.0], (500, 1))
    plain = seen(shape, rb.Texture(texels, (1.7, 2.3)), origins, directions)
    assert np.array_equal(plain, seen(shape, rb.Texture(texels, (1.7, 2.3), wrap="repeat"), origins, directions))


@pytest.mark.parametrize("pair", [("repeat", "clamp"), ("mirror", "repeat"), ("clamp", "mirror")])
def test_a_pair_wraps_each_coordinate_by_itself(pair: tuple[str, str]) -> None:
    rng = np.random.default_rng(6)
    texels = rng.random((5, 7, 3), np.float32)
    inside = rng.uniform(0, 1, 300).astype(np.float32)
    outside = rng.uniform(-3, 3, 300).astype(np.float32)
    both = rb.Texture(texels, wrap=pair)._native
    for axis, word in enumerate(pair):
        uv = np.stack([outside, inside] if axis == 0 else [inside, outside], axis=1)
        inner = (uv[:, 1 - axis] > 0.15) & (uv[:, 1 - axis] < 0.85)  # no wrapping there
        alone = rb.Texture(texels, wrap=word)._native
        assert np.array_equal(both.lookup(uv[inner]), alone.lookup(uv[inner]))
        assert inner.sum() > 150


@pytest.mark.parametrize("height", [1, 2, 3, 7, 100, 1000])
@pytest.mark.parametrize("scale", [1, 7, -3, 1000.0, -12345.0, 2.0**19, 0.3, 1e-3, 1e-30, 1e9])
def test_nothing_of_the_other_end_is_in_an_end(height: int, scale: float) -> None:
    texels = np.full((height, 1, 3), 0.5, np.float32)
    texels[0], texels[-1] = 1, 0  # at v = 1 and v = 0
    native = _core.texture(np.ascontiguousarray(texels[::-1]), 1.0, scale, "chart", "chart")
    low, high = native.lookup(np.array([[0.3, 0.0], [0.3, 1.0]], np.float32), True)[:, 0]
    if float(scale).is_integer() and abs(scale) <= 2**19 and height > 2:
        if scale < 0:
            low, high = high, low
        assert low <= 0.5 <= high  # with what is next to it, where a float cannot tell texels apart
        assert abs(scale) * height > 2000 or (low < 0.01 and high > 0.99)
    around = native.lookup(np.random.default_rng(7).random((1000, 2), np.float32), True)
    assert ((around >= 0) & (around <= 1)).all()


def test_pictures_of_all_methods_agree_at_the_poles() -> None:
    scene = rb.Scene(ambient=0.7)
    texels = np.random.default_rng(8).random((HEIGHT, WIDTH, 3))
    for i, (shape, wrap) in enumerate([(rb.Sphere(), None), (SIDES["cone"], None), (rb.Sphere(), ("mirror", "clamp"))]):
        place = rb.Transform.translate(2.5 * i, 0, 0) @ rb.Transform.rotate(40 + 30 * i, axis=(1, 0.2, 0))
        scene.add(shape, rb.Material(rb.Texture(texels, (2, 2), wrap=wrap), reflect=0.2), transform=place)
    scene.add_light(rb.PointLight((3, -3, 6), 20))
    camera = rb.Camera((2.5, -7, 3), (2.5, 0, 0), fov=30, width=160, height=90)
    base = rb.render(scene, camera, method="base")
    exact = rb.render(scene, camera, method="exact")
    assert (base.object_id >= 0).mean() > 0.2
    assert base.image.tobytes() == exact.image.tobytes()


def test_wraps_are_kept_in_documents_and_pickles() -> None:
    scene = rb.Scene()
    wraps = (None, "repeat", "clamp", "mirror", ("repeat", "clamp"), ("clamp", "clamp"))
    for wrap in wraps:
        scene.add(rb.Sphere(), rb.Material(rb.Texture(WHITE_ABOVE, wrap=wrap)))
    for restored in (rb.Scene.from_dict(scene.to_dict()), pickle.loads(pickle.dumps(scene))):
        assert restored == scene
        kept = [item.material.diffuse.wrap for item in restored.objects]
        assert kept == [None, "repeat", "clamp", "mirror", ("repeat", "clamp"), "clamp"]
    assert len({item.material for item in scene.objects}) == len(wraps) - 1  # "clamp" twice
    assert "wrap" not in repr(rb.Texture(WHITE_ABOVE))
    assert repr(rb.Texture(WHITE_ABOVE, wrap=("mirror", "clamp"))).endswith(", wrap=('mirror', 'clamp'))")


def test_documents_of_earlier_versions_keep_their_pictures() -> None:
    scene = rb.Scene(ambient=1)
    scene.add(rb.Sphere(), rb.Material(rb.Texture(WHITE_ABOVE)))
    document = scene.to_dict()
    document["textures"][0]["wrap"] = "repeat"  # as it was written
    scene = rb.Scene.from_dict(document)
    with rb.Renderer(scene) as renderer:
        assert renderer.trace([(0, 0, 5)], [(0, 0, -1)]).radiance[0, 0] == 0.5


@pytest.mark.parametrize(
    ("wrap", "error", "words"),
    [
        ("chart", ValueError, "wrap must be one of 'repeat', 'clamp', 'mirror', got 'chart'"),
        (("repeat",), ValueError, r"wrap must be a word or a pair of words \(u, v\), got \('repeat',\)"),
        (("repeat", "around"), ValueError, r"wrap\[1\] must be one of 'repeat', 'clamp', 'mirror', got 'around'"),
        ((1, "repeat"), TypeError, r"wrap\[0\] must be one of .*, got 1 of type int"),
        (3, TypeError, "wrap must be one of .*, got 3 of type int"),
    ],
)
def test_bad_wraps(wrap: object, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=f"Texture: {words}"):
        rb.Texture(WHITE_ABOVE, wrap=wrap)
