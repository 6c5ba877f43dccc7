"""Ready scenes, made by code: each call returns a new scene with its camera."""

from .hard import HARD_CASES, HardCase, hard_case
from .museum import museum
from .simple import sphereflake, three_spheres
from .walk import walkthrough

__all__ = ["HARD_CASES", "HardCase", "hard_case", "museum", "sphereflake", "three_spheres", "walkthrough"]
