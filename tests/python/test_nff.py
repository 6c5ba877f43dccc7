"""Scenes in NFF: what each entity becomes, and errors that name file, line, entity, value and expectation."""

from __future__ import annotations

import logging
import math
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import raybound as rb
from raybound.cli import main
from raybound.nff import fit_highlight

BALLS = Path(__file__).parent.parent / "data" / "balls_s1.nff"  # of the Standard Procedural Databases 3.14, CC0

VIEW = "v\nfrom 0 -5 1\nat 0 0 0\nup 0 0 1\nangle 40\nhither 1\nresolution 32 24\n"
GREY = "f 1 0.5 0.25 0.5 0.25 8 0 0\n"
HEAD = VIEW + GREY  # 8 lines
ELL = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]


def load(tmp_path: Path, text: str | bytes) -> rb.Scene:
    path = tmp_path / "scene.nff"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return rb.load_scene(path)


def only_shape(tmp_path: Path, text: str) -> rb.Shape:
    (item,) = load(tmp_path, HEAD + text).objects
    return item.shape


def polygon(vertices: list[tuple[float, ...]], entity: str = "p") -> str:
    return f"{entity} {len(vertices)}\n" + "".join(" ".join(map(str, v)) + "\n" for v in vertices)


def test_a_scene_of_the_databases() -> None:
    scene = rb.load_scene(BALLS)
    ambient = math.sqrt(3) / 6
    assert scene.camera == rb.Camera((2.1, 1.3, 1.7), (0, 0, 0), up=(0, 0, 1), fov=45, width=512, height=512)
    assert scene.ambient == pytest.approx((ambient,) * 3)
    assert scene.background == pytest.approx((0.078, 0.361, 0.753))
    assert [item.light for item in scene.lights] == [
        rb.PointLight(at, ambient) for at in ((4, 3, 2), (1, -4, 4), (-3, 1, 5))
    ]
    floor, *balls = scene.objects
    assert floor.shape == rb.Polygon([(12, 12, -0.5), (-12, 12, -0.5), (-12, -12, -0.5), (12, -12, -0.5)])
    assert floor.material.diffuse == pytest.approx((0.8, 0.6, 0.264))
    assert (floor.material.specular, floor.material.reflect, floor.material.transmit) == (0, 0, 0)
    assert len(balls) == 10
    assert balls[0].shape == rb.Sphere((0, 0, 0), 0.5)
    assert balls[0].material.reflect == 0.5
    assert all(item.name is None and item.transform == rb.Transform() for item in scene.objects)
    assert rb.Scene.from_dict(scene.to_dict()) == scene


def test_the_picture_is_not_mirrored(tmp_path: Path) -> None:
    """A ball to the right of the view, cross(view, up), is in the right half; one above, in the upper half."""
    scene = load(tmp_path, HEAD + "s 1 0 0 0.3\ns 0 0 1.2 0.3")
    right, above = (np.argwhere(rb.render(scene).object_id == i).mean(axis=0) for i in (0, 1))
    assert right[1] > 20
    assert above[0] < 8


def test_angle_is_the_full_vertical_angle(tmp_path: Path) -> None:
    scene = load(tmp_path, "v from 0 -1 0 at 0 0 0 up 0 0 1 angle 90 hither 0 resolution 40 20")
    assert scene.camera is not None
    directions = scene.camera.rays()[1].astype(float)
    top = directions[0, 20]
    assert top[2] / top[1] == pytest.approx(0.95)  # the centre of the first of 20 rows


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_white_space_and_comments(tmp_path: Path, newline: str) -> None:
    text = """# a comment

        v from 0 -5 1   # not up 1 2 3
        at 0 0 0 up 0
        0 1 angle
            40 hither 1 resolution 32
        24
        f 1 .5 25e-2 +0.5 0.25 8 0 0#none
        s 0 0
        0\t1"""
    assert load(tmp_path, text.replace("\n", newline)) == load(tmp_path, HEAD + "s 0 0 0 1")


def test_comments_may_be_of_any_encoding(tmp_path: Path) -> None:
    assert len(load(tmp_path, HEAD.encode() + b"# caf\xe9 \xff\ns 0 0 0 1")) == 1


def test_view_keywords_in_any_order(tmp_path: Path) -> None:
    text = "v\nresolution 32 24\nhither 1\nangle 40\nup 0 0 1\nat 0 0 0\nfrom 0 -5 1\n"
    assert load(tmp_path, text).camera == load(tmp_path, VIEW).camera


# Light


@pytest.mark.parametrize("count", [1, 2, 3, 7])
def test_lights_without_colour_share_the_suggested_intensity(tmp_path: Path, count: int) -> None:
    scene = load(tmp_path, VIEW + "l 1 2 3\n" * count)
    expected = pytest.approx((math.sqrt(count) / (2 * count),) * 3)
    assert scene.ambient == expected
    assert [item.light.intensity for item in scene.lights] == [expected] * count
    assert not any(item.light.falloff for item in scene.lights)


def test_lights_with_colour(tmp_path: Path) -> None:
    scene = load(tmp_path, VIEW + "l 1 2 3 1 0.5 0\nl 4 5 6\nl 7 8 9\n0 0 2\nl 0 0 0")
    first, second, third, _ = (item.light.intensity for item in scene.lights)
    assert (first, second, third) == ((0.25, 0.125, 0), (0.25, 0.25, 0.25), (0, 0, 0.5))
    assert scene.ambient == (0.25, 0.25, 0.25)


def test_no_lights_leave_the_ambient_of_one(tmp_path: Path) -> None:
    assert load(tmp_path, VIEW).ambient == (0.5, 0.5, 0.5)
    assert load(tmp_path, VIEW).background == (0, 0, 0)


def test_lights_may_follow_objects(tmp_path: Path) -> None:
    assert load(tmp_path, HEAD + "s 0 0 0 1\nl 1 2 3") == load(tmp_path, HEAD + "l 1 2 3\ns 0 0 0 1")


# Materials


def test_surfaces(tmp_path: Path) -> None:
    scene = load(tmp_path, HEAD + "s 0 0 0 1\nf 1 1 1 0.1 0.2 50 0.9 1.33\ns 0 0 0 1\ns 0 0 0 2")
    first, second, third = (item.material for item in scene.objects)
    assert first == rb.Material((0.5, 0.25, 0.125), 0.0625, roughness=0.25, reflect=0.25, ior=1)
    assert second.diffuse == pytest.approx((0.1, 0.1, 0.1))
    assert (second.reflect, second.transmit, second.ior) == pytest.approx((0.2, 0.9, 1.33))
    assert second.roughness == pytest.approx(0.1)
    assert third == second


@pytest.mark.parametrize("shine", [0.5, 1, 3.0827, 10, 101.148, 1e4, 1e6])
def test_the_highlight_is_phongs(shine: float) -> None:
    """Peak and width: down to a tenth, Ward's lobe differs from Phong's by little; the narrower, the less."""
    specular, sigma = fit_highlight(0.7, shine)
    assert specular / (4 * sigma**2) == pytest.approx(0.7)
    phong = np.linspace(1, 0.1, 50)
    delta = np.arccos(phong ** (1 / shine)) / 2
    ward = specular / (4 * sigma**2) * np.exp(-((np.tan(delta) / sigma) ** 2)) / 0.7
    # exp(-2 n x) against exp(-2 n artanh x), at most where Phong's is 0.1 and 2 n artanh(x) = ln 10
    x = np.tanh(math.log(10) / (2 * shine))
    assert np.abs(ward / phong - 1).max() <= math.exp(2 * shine * (np.arctanh(x) - x)) - 1 + 1e-6
    if shine > 3:
        np.testing.assert_allclose(ward, phong, rtol=0.2, atol=0.03)


def test_the_highlight_is_rendered_as_phongs(tmp_path: Path) -> None:
    """The specular light at the mirror angle is Ks times the light's intensity."""
    text = (
        "v from 0 0 5 at 0 0 0 up 0 1 0 angle 0.01 hither 1 resolution 1 1\nl 0 0 9\nf 0 0 0 0 0.25 30 0 0\ns 0 0 0 1"
    )
    frame = rb.render(load(tmp_path, text), max_depth=1)
    np.testing.assert_allclose(frame.image[0, 0], 0.25 * 0.5, rtol=1e-3)


def test_extreme_exponents_are_clamped() -> None:
    assert fit_highlight(1, 0) == (4, 1)
    assert fit_highlight(1, 0.1) == (4, 1)
    assert fit_highlight(1, 5e-324) == (4, 1)
    assert fit_highlight(1, 1e30) == (4e-8, 1e-4)


def test_exponents_beyond_the_roughness_limit_load(tmp_path: Path) -> None:
    (item,) = load(tmp_path, VIEW + "f 1 1 1 0 0.5 1e12 0 0\ns 0 0 0 1").objects
    assert item.material.roughness == pytest.approx(1e-4)


# Primitives


def test_spheres(tmp_path: Path) -> None:
    assert only_shape(tmp_path, "s 1 2 3 4") == rb.Sphere((1, 2, 3), 4)
    assert only_shape(tmp_path, "s 1 2 3 -4") == rb.Sphere((1, 2, 3), 4)


@pytest.mark.parametrize(
    ("text", "shape"),
    [
        ("0 0 0 2 0 0 3 1", rb.Cone((0, 0, 0), (0, 0, 3), radius=2, top_radius=1)),
        ("0 0 0 2 0 0 3 0", rb.Cone((0, 0, 0), (0, 0, 3), radius=2)),
        ("0 0 0 1 0 0 3 2", rb.Cone((0, 0, 3), (0, 0, 0), radius=2, top_radius=1)),
        ("0 0 0 0 0 0 3 2", rb.Cone((0, 0, 3), (0, 0, 0), radius=2)),
        ("0 0 0 2\n0 0 3 2", rb.Cylinder((0, 0, 0), (0, 0, 3), radius=2)),
        ("0 0 0 -2 0 0 3 -2", rb.Cylinder((0, 0, 0), (0, 0, 3), radius=2)),
        ("0 0 0 -2 0 0 3 -1", rb.Cone((0, 0, 0), (0, 0, 3), radius=2, top_radius=1)),
        ("0 0 0 0.1 0 0 3 0.1000000001", rb.Cylinder((0, 0, 0), (0, 0, 3), radius=0.1)),
    ],
)
def test_cones_and_cylinders(tmp_path: Path, text: str, shape: rb.Shape) -> None:
    assert only_shape(tmp_path, f"c {text}") == shape


def test_convex_polygons(tmp_path: Path) -> None:
    for vertices in (ELL[:3], [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)]):
        assert only_shape(tmp_path, polygon(vertices)) == rb.Polygon(vertices)


def area(shape: rb.Shape) -> float:
    assert isinstance(shape, rb.Mesh)
    corners = shape.vertices.astype(float)[shape.faces]
    return (
        float(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()) / 2
    )


@pytest.mark.parametrize("turn", [(0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2)])
def test_concave_polygons_are_one_mesh(tmp_path: Path, turn: tuple[int, ...]) -> None:
    """An L in all planes and both directions: four triangles that cover it, turning as it does."""
    vertices = [tuple(v[i] for i in turn) for v in ELL]
    mesh = only_shape(tmp_path, polygon(vertices))
    assert isinstance(mesh, rb.Mesh)
    assert len(mesh.faces) == 4
    assert area(mesh) == pytest.approx(3)
    corners = mesh.vertices.astype(float)[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = np.cross(np.subtract(vertices[1], vertices[0]), np.subtract(vertices[2], vertices[1]))
    assert (normals @ outward > 0).all()


def test_concave_polygons_are_seen_as_they_are(tmp_path: Path) -> None:
    view = "v from 1 1 9 at 1 1 0 up 0 1 0 angle 14 hither 0 resolution 33 33\n"
    scene = load(tmp_path, view + GREY + polygon([(float(x), float(y), 0.0) for x, y, _ in ELL]))
    points = [(x, y) for x in (0.1, 0.5, 0.9, 1.1, 1.5, 1.9) for y in (0.1, 0.5, 0.9, 1.1, 1.5, 1.9)]
    hits = scene.intersect([(x, y, 5) for x, y in points], [(0, 0, -1)] * len(points))
    assert hits["hit"].tolist() == [x < 1 or y < 1 for x, y in points]
    assert (rb.render(scene).object_id == 0).any()


def test_polygons_off_their_plane_are_meshes(tmp_path: Path) -> None:
    mesh = only_shape(tmp_path, polygon([(0, 0, 0), (1, 0, 0), (1, 1, 0.01), (0, 1, 0)]))
    assert isinstance(mesh, rb.Mesh)
    assert len(mesh.faces) == 2


def test_gears_have_144_vertices(tmp_path: Path) -> None:
    """A wheel with 36 teeth: all of its area is covered."""
    angles = 2 * np.pi * np.arange(144) / 144
    radius = np.where(np.arange(144) // 2 % 2, 1.0, 0.9)
    vertices = [tuple(v) for v in np.stack([radius * np.cos(angles), radius * np.sin(angles), 0 * angles], axis=1)]
    mesh = only_shape(tmp_path, polygon(vertices))
    x, y = mesh.vertices.astype(float)[:, :2].T
    assert area(mesh) == pytest.approx(0.5 * abs((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()))


def test_patches_are_meshes_with_normals(tmp_path: Path) -> None:
    rows = [(0, 0, 0, 0, -1, 2), (1, 0, 0, 1, 0, 1), (0, 1, 0, 0, 1, 1)]
    vertices, normals = [row[:3] for row in rows], [row[3:] for row in rows]
    assert only_shape(tmp_path, polygon(rows, "pp")) == rb.Mesh(vertices, [(0, 1, 2)], normals=normals)
    mesh = only_shape(tmp_path, polygon([*rows[:2], (1, 1, 0, 0, 0, 1), rows[2]], "pp"))
    assert isinstance(mesh, rb.Mesh)
    assert len(mesh.faces) == 2


def test_without_the_extra_the_error_names_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mapbox_earcut", None)
    with pytest.raises(ImportError, match=r"scene\.nff', line 9: p: .*mapbox_earcut: pip install 'raybound\[mesh\]'"):
        load(tmp_path, HEAD + polygon(ELL))
    assert only_shape(tmp_path, polygon(ELL[:3])) == rb.Polygon(ELL[:3])


# Errors

BAD = [
    # what a file must have
    ("", 1, "v: the file must have a view, got none"),
    ("# nothing\n\n", 2, "v: the file must have a view"),
    (GREY + "s 0 0 0 1", 2, "v: the file must have a view"),
    (VIEW + VIEW, 8, "v: the file must have one view, got a second one"),
    (VIEW + "b 0 0 0\nb 1 1 1", 9, "b: the file must have one background, got a second one"),
    (VIEW + "s 0 0 0 1", 8, "s: an f entity must come before the first object, got none"),
    (HEAD + "q 1 2", 9, "an entity must be one of v, b, l, f, c, s, p, pp, got 'q'"),
    (HEAD + "s 0 0 0 1 5", 9, "an entity must be one of v, b, l, f, c, s, p, pp, got '5'"),
    # views
    (
        "v\nfrom 0 0 0\nat 0 0 1\nup 0 1 0\nangle 3\nhither 1",
        6,
        "v (begun in line 1): the next keyword must be resolution",
    ),
    (
        "v\nfrom 0 0 0\nform 1 1 1",
        3,
        "v: the next keyword must be at or up or angle or hither or resolution, got 'form'",
    ),
    ("v\nfrom 0 0 0\nfrom 0 0 0", 3, "got 'from'"),
    (VIEW.replace("angle 40", "angle 0"), 1, "v: Camera: fov must be > 0, got 0.0"),
    (VIEW.replace("angle 40", "angle abc"), 5, "v: angle must be a number, got 'abc'"),
    (VIEW.replace("at 0 0 0", "at 0 -5 1"), 1, "v: Camera: target must differ from eye"),
    (VIEW.replace("32 24", "32 0"), 7, "v: yres must be an integer in 1..999999999, got '0'"),
    (VIEW.replace("32 24", "32.5 24"), 7, "v: xres must be an integer in 1..999999999, got '32.5'"),
    (VIEW.replace("32 24", "70000 24"), 1, "v: Camera: width must be an integer in 1..65536, got 70000"),
    (VIEW.replace("hither 1", "hither nan"), 6, "v: hither must be finite, got 'nan'"),
    # colours and lights
    (VIEW + "b 0 -1 0", 8, "b: green must be >= 0, got '-1'"),
    (VIEW + "b 0 1", 8, "b (begun in line 8): blue must be a number, got the end of the file"),
    (VIEW + "b 0 0 1e39", 8, "b: Scene: background must fit in float32"),
    (VIEW + "l 1 2", 8, "l (begun in line 8): z must be a number, got the end of the file"),
    (VIEW + "l 1 2 3 4\n" + GREY, 9, "l: green must be a number, got 'f'"),
    (VIEW + "l 1 2 3 1 -1 1", 8, "l: green must be >= 0, got '-1'"),
    (VIEW + "l 1e40 2 3", 8, "l: PointLight: position must fit in float32"),
    # materials
    (VIEW + "f 1 1 1 1 0 1 0", 8, "f (begun in line 8): index_of_refraction must be a number"),
    (VIEW + "f 1 1 1 -1 0 1 0 0", 8, "f: Kd must be >= 0, got '-1'"),
    (VIEW + "f 1 1 1 1 0 -2 0 0", 8, "f: Shine must be >= 0, got '-2'"),
    (VIEW + "f 1 1 1 1 0 1 0.5\n0", 9, "f: index_of_refraction must be > 0 where T > 0, got '0'"),
    (VIEW + "f 1 1 1 1 0 x 0 0", 8, "f: Shine must be a number, got 'x'"),
    # primitives
    (HEAD + "s 0 0\nnan 1", 10, "s: center.z must be finite, got 'nan'"),
    (HEAD + "s 0 0 0 inf", 9, "s: radius must be finite, got 'inf'"),
    (HEAD + "s 0 0 0 1e999", 9, "s: radius must be finite, got '1e999'"),
    (HEAD + "s 0 0 0 1_0", 9, "s: radius must be a number, got '1_0'"),
    (HEAD + "s 0 0 0 0", 9, "s: Sphere: radius must be > 0, got 0"),
    (HEAD + "s 0 0 0\n\ns 0 0 0 1", 11, "s: radius must be a number, got 's'"),
    (HEAD + "s 0 0 0\n\n#\n", 11, "s (begun in line 9): radius must be a number, got the end of the file"),
    (HEAD + "c 0 0 0 1 0 0 1 -1", 9, "c: base_radius and apex_radius must have one sign, got 1.0 and -1.0"),
    (HEAD + "c 0 0 0 1 0 0 0 0.5", 9, "c: Cone: base and apex"),
    (HEAD + "c 0 0 0 0\n0 0 1 0", 9, "c: Cylinder: radius must be > 0, got 0"),
    (HEAD + "c 0 0 0 1\n0 0 1 1e39", 9, "c: c: apex_radius must fit in float32"),
    (HEAD + "c 0 0 0 1\n0 0 z 1", 10, "c: apex.z must be a number, got 'z'"),
    (HEAD + "p 2\n0 0 0\n1 1 1", 9, "p: total_vertices must be an integer in 3..999999999, got '2'"),
    (HEAD + "p -3\n", 9, "p: total_vertices must be an integer in 3..999999999, got '-3'"),
    (HEAD + "p", 9, "p (begun in line 9): total_vertices must be an integer"),
    (HEAD + "p 3\n0 0 0\n1 0 0\n1 1", 12, "p (begun in line 9): vertex 3: z must be a number, got the end of the file"),
    (HEAD + "p 3\n0 0 0\n1 0 0\ns 0 0 0 1", 12, "p: vertex 3: x must be a number, got 's'"),
    (HEAD + "p 999999999\n0 0 0", 10, "p (begun in line 9): vertex 2: x must be a number, got the end of the file"),
    (HEAD + "p " + "9" * 5000, 9, "p: total_vertices must be an integer"),
    (HEAD + "\np 3\n0 0 0\n1 0 0\n2 0 0", 10, "p: Polygon: vertices must not be collinear"),
    (HEAD + polygon([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)]), 9, "p: vertices must enclose an area"),
    (HEAD + polygon([(0, 0, 0), (2, 2, 0), (2, 0, 0), (0, 1, 0)]), 9, "p: vertices must"),
    (HEAD + "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 0\n0 1 0 0 0 1", 9, "pp: vertex 2: the normal must be non-zero"),
    (HEAD + "pp 3\n0 0 0 0 0 1\n1 0 0 0 a 1", 11, "pp: vertex 2: ny must be a number, got 'a'"),
]


@pytest.mark.parametrize(
    ("text", "line", "words"), BAD, ids=[f"{i} {words[:40]}" for i, (_, _, words) in enumerate(BAD)]
)
def test_errors_name_the_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    with pytest.raises(ValueError) as caught:
        load(tmp_path, text)
    assert f"scene.nff', line {line}: " in str(caught.value)
    assert words in str(caught.value)


def test_a_file_cut_anywhere_is_an_error_or_a_shorter_scene(tmp_path: Path) -> None:
    """Never another exception, and never more than the whole."""
    data = BALLS.read_bytes()
    loaded, messages = 0, []
    for end in range(0, len(data), 7):
        try:
            loaded += len(load(tmp_path, data[:end])) <= 11
        except ValueError as error:
            messages.append(str(error))
    assert all("scene.nff', line " in message for message in messages)
    assert 10 < loaded < len(data) // 7


def test_binary_rubbish_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"scene\.nff', line 1: an entity must be one of"):
        load(tmp_path, bytes(range(256)))
    with pytest.raises(FileNotFoundError, match=r"none\.nff"):
        rb.load_scene(tmp_path / "none.nff")


# Use


def test_the_command_line_renders_nff(tmp_path: Path) -> None:
    out = tmp_path / "balls.png"
    assert main(["render", str(BALLS), "-o", str(out), "--width=32", "--height=32"]) == 0
    assert rb.Texture(out).texels.std() > 0.05


def test_nine_thousand_objects_load_in_two_seconds(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    triangles = "".join(polygon([(i, 0, 0), (i + 0.5, 0, 0), (i, 1, 0)]) for i in range(4500))
    balls = "".join(f"s {i} 0 {i % 7} 0.25\n" for i in range(4500))
    best = math.inf
    with caplog.at_level(logging.INFO):
        for _ in range(3):
            start = time.perf_counter()
            scene = load(tmp_path, HEAD + triangles + balls)
            best = min(best, time.perf_counter() - start)
    assert len(scene) == 9000
    assert best < 2
    assert not caplog.records
