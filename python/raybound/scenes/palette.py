"""The museum's materials."""

from __future__ import annotations

from ..materials import Material
from .kit import picture


class Palette:
    """Every material that more than one part of the museum uses."""

    def __init__(self) -> None:
        # Stone and plaster.
        self.plaster = Material((0.74, 0.70, 0.62))
        self.ceiling = Material((0.80, 0.78, 0.73))
        self.cream = Material((0.66, 0.60, 0.49))
        self.panelling = Material((0.60, 0.56, 0.47))
        self.marble = Material(picture("marble"), (0.06, 0.06, 0.06), roughness=0.15)
        self.limestone = Material((0.72, 0.68, 0.60), (0.06, 0.06, 0.06), roughness=0.18)
        self.verde = Material(picture("verde"), (0.10, 0.10, 0.10), roughness=0.12)
        self.polished_verde = self.verde.replace(reflect=0.10)
        self.alabaster = Material((0.78, 0.72, 0.62), (0.10, 0.10, 0.10), roughness=0.15)
        # Wood and leaves.
        self.walnut = Material(picture("wood"), (0.05, 0.04, 0.03), roughness=0.18)
        self.cabinet = Material(picture("wood", (2.0, 1.0)), (0.05, 0.04, 0.03), roughness=0.18)
        self.dark_wood = Material((0.085, 0.045, 0.025), (0.05, 0.05, 0.05), roughness=0.15)
        self.leaf = Material((0.075, 0.19, 0.055), (0.03, 0.03, 0.03), roughness=0.25)
        self.soil = Material((0.06, 0.04, 0.03))
        # Metals.
        self.gilt = Material((0.50, 0.33, 0.10), (0.30, 0.22, 0.08), roughness=0.22)
        self.brass = Material((0.36, 0.25, 0.09), (0.35, 0.27, 0.12), roughness=0.12, reflect=(0.28, 0.21, 0.10))
        self.dull_brass = Material((0.42, 0.30, 0.12), (0.28, 0.21, 0.10), roughness=0.18)
        self.iron = Material((0.035, 0.035, 0.04), (0.10, 0.10, 0.10), roughness=0.15)
        self.silver = Material((0.06, 0.06, 0.065), (0.5, 0.5, 0.5), roughness=0.06, reflect=(0.80, 0.80, 0.82))
        # Glass: a pane is one thin face that does not bend light.
        self.glass = Material((0.0, 0.0, 0.0), (0.5, 0.5, 0.5), roughness=0.05, reflect=0.10, transmit=0.86, ior=1.5)
        self.pane = Material((0.0, 0.01, 0.008), reflect=0.06, transmit=(0.88, 0.92, 0.90), ior=1.0)
        self.mirror = Material((0.012, 0.015, 0.018), reflect=(0.66, 0.72, 0.74))
        # Cloth and colour.
        self.velvet = Material((0.30, 0.025, 0.035), (0.03, 0.02, 0.02), roughness=0.4)
        self.blue_velvet = Material((0.045, 0.065, 0.18))
        self.ivory = Material((0.80, 0.72, 0.56), (0.10, 0.10, 0.10), roughness=0.12)
        self.ebony = Material((0.045, 0.035, 0.03), (0.14, 0.14, 0.14), roughness=0.12)

    def gem(self, red: float, green: float, blue: float) -> Material:
        """A bright enamel of the given colour."""
        return Material((red, green, blue), (0.22, 0.22, 0.22), roughness=0.10)
