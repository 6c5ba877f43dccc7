"""Paints the museum's pictures and textures afresh: python -m raybound.scenes.paintings.make_paintings

The pictures are written beside this file as 8-bit sRGB PNG. The same code gives the same pixels every time.
"""

from __future__ import annotations

import argparse
import pathlib
from collections.abc import Callable

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray

from . import abstract, fancies, figures, landscapes, surfaces
from .canvas import Canvas

PICTURES: dict[str, Callable[[], Canvas]] = {
    "birches": landscapes.birches,
    "bulge": abstract.bulge,
    "cameo": fancies.cameo,
    "circles": abstract.circles,
    "discs": abstract.discs,
    "fields": abstract.fields,
    "golden_tree": fancies.golden_tree,
    "grid": abstract.grid,
    "mist": landscapes.mist,
    "night": landscapes.night,
    "squares": abstract.squares,
    "still_life": figures.still_life,
    "sunflower": figures.sunflower,
    "sunset": landscapes.sunset,
    "town": fancies.town,
    "wave": figures.wave,
    "window": fancies.window,
    "carpet": surfaces.carpet,
    "chessboard": surfaces.chessboard,
    "floor": surfaces.floor,
    "marble": surfaces.marble,
    "planks": surfaces.planks,
    "verde": surfaces.verde,
    "wallpaper": surfaces.wallpaper,
    "wood": surfaces.wood,
}


def write(pixels: NDArray[np.uint8], path: pathlib.Path) -> None:
    """Write (h, w, 3) bytes as PNG."""
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, "uint8")
    spec.attribute("png:compressionLevel", 9)
    picture = oiio.ImageBuf(spec)
    picture.set_pixels(oiio.ROI(), np.ascontiguousarray(pixels))
    if not picture.write(str(path)):
        raise OSError(f"cannot write {path}: {picture.geterror()}")


def main() -> None:
    """Paint everything, or the pictures that are named."""
    parser = argparse.ArgumentParser(description="Paint the museum's pictures and textures.")
    parser.add_argument("names", nargs="*", help="pictures to paint (default: all)")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).parent, help="folder to write to")
    options = parser.parse_args()
    for name in options.names or PICTURES:
        if name not in PICTURES:
            parser.error(f"names: no picture {name!r}; expected one of {', '.join(PICTURES)}")
        write(PICTURES[name]().bytes(), options.out / f"{name}.png")


if __name__ == "__main__":
    main()
