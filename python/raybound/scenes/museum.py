"""The museum: the thesis's test scene (section 7.2), made anew.

A hall of 24 by 12 by 6.5 metres with more than 1100 convex primitives, unions and intersections of them, textures,
mirrors, glass and eight lights.
"""

from __future__ import annotations

from ..scene import Scene
from .columns import build_columns
from .display import build_display
from .furniture import build_furniture
from .gallery import build_gallery
from .hall import build_hall
from .lighting import build_lights
from .palette import Palette
from .portal import build_portal
from .sculpture import build_sculpture
from .walk import walkthrough


def museum() -> Scene:
    """A hall of pictures, with a sculpture on a mirror base; its camera looks down the hall at 1200 by 900 pixels."""
    scene = Scene(ambient=(0.21, 0.21, 0.22), background=(0.50, 0.66, 0.90))
    palette = Palette()
    for build in (
        build_hall,
        build_columns,
        build_portal,
        build_gallery,
        build_sculpture,
        build_furniture,
        build_display,
        build_lights,
    ):
        build(scene, palette)
    scene.camera = walkthrough(1)[0]
    return scene
