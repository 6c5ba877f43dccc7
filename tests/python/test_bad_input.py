"""Bad arguments of constructors: the message names the object, the argument, the value and what was expected."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from tests.python.samples import TEXELS

import raybound as rb

NAN, INF = float("nan"), float("inf")
ORIGIN, X, Z = (0, 0, 0), (1, 0, 0), (0, 0, 1)

# How each class is made, and which of its arguments are numbers, vectors, colours, flags and integers.
MAKERS: dict[str, tuple[Any, dict[str, Any]]] = {
    "Sphere": (rb.Sphere, {"center": ORIGIN, "radius": 1}),
    "Box": (rb.Box, {"min": ORIGIN, "max": (1, 1, 1)}),
    "Cylinder": (rb.Cylinder, {"base": ORIGIN, "top": Z, "radius": 1}),
    "Cone": (rb.Cone, {"base": ORIGIN, "apex": Z, "radius": 1, "top_radius": 0.5}),
    "Disk": (rb.Disk, {"center": ORIGIN, "normal": Z, "radius": 1}),
    "Polygon": (rb.Polygon, {"vertices": [ORIGIN, X, (0, 1, 0)]}),
    "Quadric": (rb.Quadric, {"coefficients": (1, 1, 1, 0, 0, 0, 0, 0, 0, -1), "clip": rb.Box()}),
    "Transform": (rb.Transform, {"matrix": np.eye(4)}),
    "Material": (
        rb.Material,
        {"diffuse": 0.5, "specular": 0, "roughness": 0.2, "reflect": 0, "transmit": 0, "ior": 1.5},
    ),
    "Texture": (rb.Texture, {"source": TEXELS, "scale": (1, 1), "wrap": "repeat"}),
    "DirectionalLight": (rb.DirectionalLight, {"direction": Z, "radiance": 1}),
    "PointLight": (rb.PointLight, {"position": ORIGIN, "intensity": 1, "falloff": False}),
    "SpotLight": (rb.SpotLight, {"position": ORIGIN, "direction": Z, "cutoff": 30, "intensity": 1, "falloff": False}),
    "Camera": (rb.Camera, {"eye": (5, 0, 0), "target": ORIGIN, "up": Z, "fov": 60, "width": 8, "height": 6}),
    "Tolerance": (rb.Tolerance, {"relative": 0.1, "absolute": 0.1}),
    "Scene": (rb.Scene, {"ambient": 0, "background": 0}),
    "Renderer": (
        rb.Renderer,
        {
            "scene": rb.Scene(),
            "tolerance": 0,
            "method": "auto",
            "bound": "taylor",
            "memory": 2**20,
            "threads": 0,
            "max_depth": 5,
            "editable": True,
        },
    ),
}
NUMBERS = {"radius", "top_radius", "roughness", "ior", "cutoff", "fov", "relative", "absolute", "tolerance"}
POSITIVE = {"radius", "roughness", "ior", "cutoff", "fov"}
VECTORS = {"center", "min", "max", "base", "top", "apex", "normal", "direction", "position", "eye", "target", "up"}
COLOURS = {"diffuse", "specular", "reflect", "transmit", "radiance", "intensity", "ambient", "background"}
INTEGERS = {"width", "height", "memory", "threads", "max_depth"}
CHOICES = {"wrap", "method", "bound"}
FLAGS = {"falloff", "editable"}
ARRAYS = {"vertices": (3, 3), "matrix": (4, 4), "source": (2, 3, 3), "scale": (2,)}

# (bad value, exception, what the message must show of it)
Case = tuple[Any, type[Exception], str]
ANY_NUMBER: list[Case] = [
    ("a", TypeError, "'a'"),
    (True, TypeError, "True"),
    (2j, TypeError, "2j"),
    (NAN, ValueError, "nan"),
    (-INF, ValueError, "-inf"),
    ([1], ValueError, "[1]"),
    (-0.5, ValueError, "-0.5"),
]
ANY_VECTOR: list[Case] = [
    ("abc", TypeError, "'abc'"),
    (3, ValueError, "shape ()"),
    ((1, 2), ValueError, "shape (2,)"),
    ([[1, 2, 3]], ValueError, "shape (1, 3)"),
    ((1, [2], 3), ValueError, "[2]"),
    ((1, NAN, 3), ValueError, "nan at index 1"),
    ((1, 2, INF), ValueError, "inf at index 2"),
    ((1e39, 2, 3), ValueError, "1e+39 at index 0"),
    ((10**400, 2, 3), ValueError, "1000"),
    ((True, 0, 1), TypeError, "True"),
    ((1, 2j, 3), TypeError, "2j"),
    (None, TypeError, "None"),
]
ANY_COLOUR: list[Case] = [
    ("red", TypeError, "'red'"),
    ((1, 2), ValueError, "shape (2,)"),
    (-0.25, ValueError, "-0.25"),
    ((0, 0, -0.25), ValueError, "-0.25"),
    ((0, NAN, 0), ValueError, "nan at index 1"),
    (INF, ValueError, "inf"),
    (None, TypeError, "None"),
]
ANY_INTEGER: list[Case] = [
    ("a", TypeError, "'a'"),
    (2.0, TypeError, "2.0"),
    (True, TypeError, "True"),
    (-1, ValueError, "-1"),
    (None, TypeError, "None"),
    (2**70, ValueError, "1180591620717411303424"),
]


def cases() -> list[Any]:
    found = []
    for name, (_, arguments) in MAKERS.items():
        for argument in arguments:
            bad: list[Case] = []
            if argument in NUMBERS:
                bad = ANY_NUMBER + (
                    [(0, ValueError, "0"), (1e-60, ValueError, "1e-60")] if argument in POSITIVE else []
                )
            elif argument in VECTORS:
                bad = ANY_VECTOR + (
                    [(ORIGIN, ValueError, "(0, 0, 0)")] if argument in ("normal", "direction", "up") else []
                )
            elif argument in COLOURS:
                bad = ANY_COLOUR
            elif argument in INTEGERS:
                bad = ANY_INTEGER
            elif argument in CHOICES:
                bad = [("nearest", ValueError, "'nearest'"), (3, TypeError, "3")]
                bad += [] if argument == "wrap" else [(None, TypeError, "None")]  # which leaves wrapping to the chart
            elif argument in FLAGS:
                bad = [(1, TypeError, "1"), ("yes", TypeError, "'yes'"), (None, TypeError, "None")]
            elif argument in ARRAYS:
                wrong, shape = np.zeros((5, 7)), ARRAYS[argument]
                holes = np.ones(shape)
                holes.flat[-1] = NAN
                bad = [(wrong, ValueError, "(5, 7)"), (holes, ValueError, "nan at index"), ({}, TypeError, "{}")]
            found += [
                pytest.param(name, argument, *case, id=f"{name}-{argument}-{repr(case[0])[:24]}")
                for case in bad
                if not (argument == "absolute" and case[0] is None)
            ]
    return found


@pytest.mark.parametrize(("name", "argument", "value", "error", "shown"), cases())
def test_message(name: str, argument: str, value: Any, error: type[Exception], shown: str) -> None:
    maker, arguments = MAKERS[name]
    maker(**arguments)
    with pytest.raises(error) as caught:
        maker(**{**arguments, argument: value})
    message = str(caught.value)
    owner = "Tolerance|Renderer" if argument == "tolerance" else name
    inner = "relative" if argument == "tolerance" and message.startswith("Tolerance") else argument
    assert re.match(rf"({owner}): {inner} must ", message), message
    assert shown in message, message
    assert "\n" not in message
    assert len(message) < 300


def test_the_cases_are_many() -> None:
    assert len(cases()) > 300


@pytest.mark.parametrize("name", MAKERS)
def test_unknown_keyword(name: str) -> None:
    maker, arguments = MAKERS[name]
    with pytest.raises(TypeError, match=f"{name}.*sise"):
        maker(**arguments, sise=3)


@pytest.mark.parametrize("name", MAKERS)
def test_arguments_after_the_first_two_are_keyword_only(name: str) -> None:
    maker, arguments = MAKERS[name]
    values = list(arguments.values())
    names = list(arguments)
    maker(*values[:2], **dict(zip(names[2:], values[2:], strict=True)))
    if len(values) > 2:
        with pytest.raises(TypeError, match=f"{name}.*positional"):
            maker(*values[:3], **dict(zip(names[3:], values[3:], strict=True)))


GEOMETRY: list[tuple[Any, str, str]] = [
    (lambda: rb.Box(X, X), "Box: max", "(1, 0, 0)"),
    (lambda: rb.Box(ORIGIN, (1, 1, -2)), "Box: max", "(1, 1, -2)"),
    (lambda: rb.Cylinder(X, X), "Cylinder: base and top", "(1, 0, 0)"),
    (lambda: rb.Cone(X, X), "Cone: base and apex", "(1, 0, 0)"),
    (lambda: rb.Polygon([ORIGIN, X]), "Polygon: vertices", "2"),
    (lambda: rb.Polygon(np.zeros((0, 3))), "Polygon: vertices", "0"),
    (lambda: rb.Polygon([ORIGIN, X, (2, 0, 0)]), "Polygon: vertices", "collinear"),
    (lambda: rb.Polygon([ORIGIN, X, (0.1, 0.1, 0), (0, 1, 0)]), "Polygon: vertices", "convex, vertex 2"),
    (lambda: rb.Polygon([ORIGIN, X, (1, 1, 1), (0, 1, 0)]), "Polygon: vertices", "planar, vertex"),
    (lambda: rb.Polygon([ORIGIN, X, X, (0, 1, 0)]), "Polygon: vertices", "coincide"),
    (lambda: rb.Union(), "Union: shapes", "none"),
    (lambda: rb.Intersection(), "Intersection: shapes", "none"),
    (lambda: rb.Union(rb.Sphere(), rb.Disk()), "Union: shape 1 must be a solid", "Disk()"),
    (lambda: rb.Polygon([ORIGIN, X, (0, 1, 0)]) & rb.Sphere(), "Intersection: shape 0 must be a solid", "Polygon("),
    (lambda: rb.Union(rb.Disk().transformed(rb.Transform.scale(2))), "Union: shape 0 must be a solid", "Disk()"),
    (lambda: rb.Transform(np.zeros((4, 4))), "Transform: matrix", "(0.0, 0.0, 0.0, 0.0)"),
    (lambda: rb.Transform(np.diag([1, 1, 0, 1.0])), "Transform: matrix", "singular"),
    (lambda: rb.Transform(np.vstack([np.eye(4)[:3], [0, 0, 1, 1]])), "Transform: matrix", "(0.0, 0.0, 1.0, 1.0)"),
    (lambda: rb.Transform.scale(0), "Transform.scale: s", "0"),
    (lambda: rb.Transform.scale((1, 0, 1)), "Transform.scale: s", "(1, 0, 1)"),
    (lambda: rb.Transform.scale((1, 2)), "Transform.scale: s", "(2,)"),
    (lambda: rb.Transform.rotate(30, axis=ORIGIN), "Transform.rotate: axis", "(0, 0, 0)"),
    (lambda: rb.Transform.rotate(NAN), "Transform.rotate: degrees", "nan"),
    (lambda: rb.Transform.translate(0, INF, 0), "Transform.translate: y", "inf"),
    (lambda: rb.SpotLight(ORIGIN, X, cutoff=181), "SpotLight: cutoff", "181"),
    (lambda: rb.Texture(TEXELS, scale=(0, 1)), "Texture: scale", "0"),
    (lambda: rb.Texture(-TEXELS), "Texture: texels", "-"),
    (lambda: rb.Texture(np.zeros((0, 2, 3))), "Texture: source", "(0, 2, 3)"),
    (lambda: rb.Camera(X, X), "Camera: target must differ from eye", "(1, 0, 0)"),
    (lambda: rb.Camera(ORIGIN, Z), "Camera: up must not be parallel to the view", "(0, 0, 1)"),
    (lambda: rb.Camera(ORIGIN, X, fov=180), "Camera: fov", "180"),
    (lambda: rb.Camera(ORIGIN, X, width=0), "Camera: width", "0"),
    (lambda: rb.Camera(ORIGIN, X, height=65537), "Camera: height", "65537"),
    (lambda: rb.Tolerance(None, 0.1), "Tolerance: absolute", "0.1"),
    (lambda: rb.Renderer(rb.Scene(), method="taylor"), "Renderer: method", "'taylor'"),
]


@pytest.mark.parametrize(("make", "named", "shown"), GEOMETRY)
def test_geometry(make: Any, named: str, shown: str) -> None:
    with pytest.raises(ValueError, match=re.escape(named)) as caught:
        make()
    assert shown in str(caught.value)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: rb.Union([rb.Sphere()]), "Union: shape 0 must be a Shape, got [Sphere()] of type list"),
        (lambda: rb.Sphere().transformed(np.eye(4)), "transformed: t must be a Transform"),
        (lambda: rb.Sphere().transformed(None), "transformed: t must be a Transform, got None"),
        (lambda: rb.Sphere() | 3, "unsupported operand"),
        (lambda: rb.Transform() @ np.eye(4), "Transform.*does not support"),
        (lambda: rb.Texture(None), "Texture: source must be"),
        (lambda: rb.Renderer("scene"), "Renderer: scene must be a Scene, got 'scene'"),
        (lambda: rb.Renderer(rb.Scene(), None), re.escape("use Tolerance(None)")),
    ],
)
def test_wrong_types(make: Any, words: str) -> None:
    with pytest.raises(TypeError, match=words.replace("[", r"\[").replace("()", r"\(\)")):
        make()
