"""raybound: fast ray tracing by interpolating radiance with a certified error.

    import raybound as rb

    scene = rb.Scene(background=(0.2, 0.3, 0.5))
    ball = scene.add(rb.Sphere(), rb.Material(diffuse=(0.8, 0.2, 0.1)))
    scene.add_light(rb.PointLight((3, -4, 5)))
    frame = rb.render(scene, rb.Camera(eye=(0, -5, 1), target=(0, 0, 0)))
    frame.save("ball.png")

Lengths are in scene units, angles in degrees, colours linear RGB (Rec. 709 primaries). The package logs under
"raybound".
"""

import logging as _logging

from . import _levels  # noqa: F401  isort: skip  # it makes `_core` the best build for this CPU
from . import _core
from .camera import Camera
from .enums import Path, RayKind, Reason, Verdict
from .floats import (
    epsilon,
    float_bits,
    float_from_bits,
    gamma,
    intersect,
    next_float_down,
    next_float_up,
    spawn_origin,
)
from .frame import Frame
from .handles import LightHandle, Object
from .lights import DirectionalLight, PointLight, SpotLight
from .materials import Material, Texture
from .mesh_file import load_mesh
from .meshes import Mesh
from .numbers import (
    Interval,
    LinearInterval,
    RunningError,
    TaylorModel,
    abs,
    acos,
    asin,
    atan,
    cos,
    exp,
    fma,
    log,
    maximum,
    minimum,
    power,
    quadratic,
    reciprocal,
    rsqrt,
    sin,
    sqrt,
    square,
    tan,
    ward_lobe,
)
from .renderer import Renderer, TraceResult, render
from .reporting import report
from .scene import Scene
from .scene_file import load_scene
from .shapes import Box, Cone, Cylinder, Difference, Disk, Intersection, Polygon, Quadric, Shape, Sphere, Union
from .tolerance import Tolerance
from .transform import Transform

from . import plot, scenes, testing  # isort: skip  # they use the names above

__version__ = str(_core.build_info()["version"])

__all__ = [
    "Box",
    "Camera",
    "Cone",
    "Cylinder",
    "Difference",
    "DirectionalLight",
    "Disk",
    "Frame",
    "Intersection",
    "Interval",
    "LightHandle",
    "LinearInterval",
    "Material",
    "Mesh",
    "Object",
    "Path",
    "PointLight",
    "Polygon",
    "Quadric",
    "RayKind",
    "Reason",
    "Renderer",
    "RunningError",
    "Scene",
    "Shape",
    "Sphere",
    "SpotLight",
    "TaylorModel",
    "Texture",
    "Tolerance",
    "TraceResult",
    "Transform",
    "Union",
    "Verdict",
    "__version__",
    "abs",
    "acos",
    "asin",
    "atan",
    "cos",
    "epsilon",
    "exp",
    "float_bits",
    "float_from_bits",
    "fma",
    "gamma",
    "intersect",
    "load_mesh",
    "load_scene",
    "log",
    "maximum",
    "minimum",
    "next_float_down",
    "next_float_up",
    "plot",
    "power",
    "quadratic",
    "reciprocal",
    "render",
    "report",
    "rsqrt",
    "scenes",
    "sin",
    "spawn_origin",
    "sqrt",
    "square",
    "tan",
    "testing",
    "ward_lobe",
]

_logging.getLogger("raybound").addHandler(_logging.NullHandler())
