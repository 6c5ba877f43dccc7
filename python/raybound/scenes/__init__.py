"""Ready scenes, made by code: each call returns a new scene with its camera."""

from .museum import museum
from .simple import sphereflake, three_spheres
from .walk import walkthrough

__all__ = ["museum", "sphereflake", "three_spheres", "walkthrough"]
