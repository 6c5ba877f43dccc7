"""Values and scenes that several tests use."""

from __future__ import annotations

import numpy as np

import raybound as rb

TEXELS = np.linspace(0, 1, 2 * 3 * 3).reshape(2, 3, 3)
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)]
TURN = rb.Transform.rotate(33.3, axis=(1, 2, 3))
TILT = rb.Transform.translate(0.1, -2, 3) @ TURN @ rb.Transform.scale((1, 2, 0.7))

SHAPES = {
    "Sphere": rb.Sphere((0.1, -2, 3), 0.3),
    "Box": rb.Box((-1, 0, 0.1), (0.2, 3, 4)),
    "Cylinder": rb.Cylinder((0, 0, 0.1), (1, 2, 3), radius=0.7),
    "Cone": rb.Cone((0, 0, 0.1), (1, 2, 3), radius=0.7, top_radius=0.1),
    "Disk": rb.Disk((0, 0, 0.1), (1, 2, 3), radius=0.7),
    "Polygon": rb.Polygon(CORNERS),
    "Quadric": rb.Quadric((1, 1, -1, 0.1, 0, 0, 0, 0.2, 0, -0.3), rb.Box((-1, -1, -0.7), (1, 1, 0.7))),
    "Union": rb.Union(rb.Sphere(), rb.Box((0, 0, 0), (1, 1, 2)), rb.Cone()),
    "Intersection": rb.Sphere() & rb.Box((0, 0, 0), (1, 1, 2)),
    "Transformed": rb.Cylinder(radius=0.3).transformed(TILT),
    "Nested": (rb.Sphere() & rb.Box((0, 0, 0), (1, 1, 2)).transformed(TURN)) | rb.Cone((0, 0, 5), (0, 0, 6)),
}
LIGHTS = {
    "DirectionalLight": rb.DirectionalLight((1, 2, -3), (0.1, 0.2, 0.3)),
    "PointLight": rb.PointLight((1, 2, 3), (0.1, 0.2, 0.3), falloff=True),
    "SpotLight": rb.SpotLight((1, 2, 3), (0, 0.1, -1), cutoff=12.3, intensity=(7, 8, 9), falloff=True),
}
MATERIALS = {
    "plain": rb.Material(),
    "rgb": rb.Material((0.1, 0.2, 0.3), (0.4, 0.5, 0.6), roughness=0.07, reflect=(0.1, 0, 0), transmit=0.9, ior=1.33),
    "scalar": rb.Material(0.1, 0.2, reflect=0.3),
}
CAMERA = rb.Camera((0.1, -7, 3), (0, 0, 0.3), up=(0, 0.1, 1), fov=37.5, width=33, height=21)
TOLERANCES = {"zero": rb.Tolerance(0), "some": rb.Tolerance(0.1, 0.3), "none": rb.Tolerance(None)}
VALUES = {
    **SHAPES,
    **LIGHTS,
    **{f"Material {name}": value for name, value in MATERIALS.items()},
    "Camera": CAMERA,
    **{f"Tolerance {name}": value for name, value in TOLERANCES.items()},
    "Transform": TILT,
    "identity": rb.Transform(),
}
TEXTURED = {
    "Texture": rb.Texture(TEXELS, (2, 0.1), wrap="mirror"),
    "Material textured": rb.Material(rb.Texture(TEXELS), reflect=0.1),
}


def small_scene() -> rb.Scene:
    """Every kind of shape and light, names, transforms, a texture and a camera."""
    scene = rb.Scene(ambient=(0.1, 0.2, 0.3), background=(0.3, 0.2, 0.1))
    materials = [*MATERIALS.values(), TEXTURED["Material textured"]]
    for index, (name, shape) in enumerate(SHAPES.items()):
        by = rb.Transform.translate(3 * (index - 4), index % 3, 0.1 * index) @ TURN
        scene.add(shape, materials[index % len(materials)], name=name if index % 2 else None, transform=by)
    for name, light in LIGHTS.items():
        scene.add_light(light, name=name)
    scene.camera = rb.Camera((0, -30, 12), (0, 0, 0), fov=40, width=64, height=48)
    return scene


def ball_scene(width: int = 48, height: int = 32) -> rb.Scene:
    """A mirror ball over a floor: a scene to render in a moment."""
    scene = rb.Scene(ambient=0.1, background=(0.2, 0.3, 0.5))
    scene.add(rb.Polygon([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)]), rb.Material((0.5, 0.4, 0.3)), name="floor")
    scene.add(rb.Sphere((0, 0, 1)), rb.Material(0.3, 0.4, reflect=0.5), name="ball")
    scene.add_light(rb.PointLight((4, -4, 6)), name="lamp")
    scene.camera = rb.Camera((0, -6, 2.5), (0, 0, 0.8), width=width, height=height)
    return scene
