"""Image files, by OpenImageIO: nothing else in the package knows about files of pixels.

Arrays here have row 0 at the top of the picture.
"""

from __future__ import annotations

import errno
import functools
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._validate import FloatArray

LINEAR, SRGB = "lin_rec709", "sRGB"  # OpenImageIO's names
EXR_CHANNELS = ("R", "G", "B", "error_bound", "Z", "object_id", "path")


def _oiio() -> Any:
    """OpenImageIO, imported when the first image is read or written (its libraries take a while to load)."""
    import OpenImageIO

    return OpenImageIO


def _message(errors: str) -> str:
    """OpenImageIO's errors in one line; it may say one more than once."""
    return "; ".join(dict.fromkeys(line.strip() for line in errors.splitlines()))


def read_linear(path: str, who: str) -> FloatArray:
    """The picture in a file as linear RGB, (h, w, 3) float32; integers are sRGB, floats are linear.

    Raises FileNotFoundError if there is no such file, ValueError with OpenImageIO's message if it cannot be read.
    """
    oiio = _oiio()
    if not Path(path).is_file():
        raise FileNotFoundError(errno.ENOENT, f"{who}: no such image file", path)
    straight = oiio.ImageSpec()
    straight.attribute("oiio:UnassociatedAlpha", 1)  # colours as they are, not multiplied by alpha
    buffer = oiio.ImageBuf(path, 0, 0, straight)
    kind = buffer.nativespec().format.basetype
    wanted = {oiio.UINT8: oiio.UINT8, oiio.UINT16: oiio.UINT16}.get(kind, oiio.FLOAT)
    pixels = None if buffer.has_error else buffer.get_pixels(wanted)
    if pixels is None or buffer.has_error:
        message = _message(buffer.geterror()) or "unknown format"
        raise ValueError(f"{who}: cannot read the image file {path!r}: {message}")
    colours = _rgb_channels(pixels.reshape(*pixels.shape[:2], -1), buffer.spec().channelnames)
    if wanted == oiio.FLOAT:
        return np.array(colours, np.float32)
    return linear_from_codes(colours)


def _rgb_channels(pixels: npt.NDArray[Any], names: tuple[str, ...]) -> npt.NDArray[Any]:
    """The three colour channels of (h, w, channels): R, G, B by name, else grey, else the first three."""
    if {"R", "G", "B"} <= set(names):
        return pixels[:, :, [names.index(name) for name in "RGB"]]
    return pixels[:, :, [0, 0, 0] if len(names) < 3 else [0, 1, 2]]


def linear_from_codes(codes: npt.NDArray[Any]) -> FloatArray:
    """Linear values of sRGB codes of dtype uint8 or uint16."""
    table: FloatArray = _decoding_table(int(np.iinfo(codes.dtype).max))
    return np.take(table, codes)


@functools.cache
def _decoding_table(highest: int) -> FloatArray:
    """The linear value of every sRGB code 0..highest (IEC 61966-2-1), computed in float64 and rounded once.

    Not by OpenImageIO's colour conversion as encoding is: that uses fast powers, which make white 1.00002 and depend on
    the processor, and texels are part of the base image, whose bytes must not.
    """
    code = np.arange(highest + 1) / highest
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4).astype(np.float32)


def _buffer(pixels: FloatArray, channels: tuple[str, ...] = ("R", "G", "B")) -> Any:
    """An image in memory, float32, with a copy of the pixels (h, w, channels)."""
    oiio = _oiio()
    height, width, count = pixels.shape
    spec = oiio.ImageSpec(width, height, count, oiio.FLOAT)
    spec.channelnames = channels
    buffer = oiio.ImageBuf(spec)
    buffer.set_pixels(spec.roi, np.ascontiguousarray(pixels, np.float32))
    return buffer


def _encoded(image: FloatArray) -> Any:
    """A linear RGB picture converted to sRGB."""
    buffer = _oiio().ImageBufAlgo.colorconvert(_buffer(image), LINEAR, SRGB)
    if buffer.has_error:
        raise ValueError(f"cannot convert to sRGB: {buffer.geterror()}")
    return buffer


def srgb_bytes(image: FloatArray) -> npt.NDArray[np.uint8]:
    """A linear RGB picture (h, w, 3) as sRGB bytes; values outside [0, 1] are clipped."""
    buffer = _encoded(image)
    pixels: npt.NDArray[np.uint8] = np.ascontiguousarray(buffer.get_pixels(_oiio().UINT8))
    return pixels


def check_writable(path: str, who: str) -> None:
    """Raises ValueError if no image format has the path's extension, FileNotFoundError if its folder is missing."""
    oiio = _oiio()
    if oiio.ImageOutput.create(path) is None:
        message = _message(oiio.geterror())
        raise ValueError(f"{who}: path must end in the extension of an image format, got {path!r}: {message}")
    folder = Path(path).parent
    if not folder.is_dir():
        raise FileNotFoundError(errno.ENOENT, f"{who}: no such folder", str(folder))


def _write(buffer: Any, path: str, who: str) -> None:
    if not buffer.write(path):
        message = _message(buffer.geterror() or _oiio().geterror())
        raise ValueError(f"{who}: cannot write {path!r}: {message}")


def write_srgb(path: str, image: FloatArray, who: str) -> None:
    """Writes a linear RGB picture as 8-bit sRGB, in the format of the path's extension."""
    check_writable(path, who)
    buffer = _encoded(image)
    buffer.set_write_format("uint8")
    if path.lower().endswith((".jpg", ".jpeg")):
        buffer.specmod().attribute("Compression", "jpeg:95")
    _write(buffer, path, who)


def write_layers(path: str, layers: dict[str, npt.NDArray[Any]], who: str) -> None:
    """Writes named channels, each (h, w), as float32, without any conversion of colours."""
    check_writable(path, who)
    pixels = np.stack([layer.astype(np.float32) for layer in layers.values()], axis=2)
    buffer = _buffer(pixels, tuple(layers))
    buffer.specmod().attribute("compression", "zip")
    buffer.specmod().attribute("oiio:ColorSpace", LINEAR)
    _write(buffer, path, who)


def png_bytes(image: FloatArray) -> bytes:
    """A linear RGB picture as the bytes of a PNG file (sRGB)."""
    with tempfile.TemporaryDirectory(prefix="raybound-") as folder:
        path = Path(folder, "frame.png")
        write_srgb(str(path), image, "Frame")
        return path.read_bytes()


def version() -> str:
    """OpenImageIO's version."""
    return str(_oiio().VERSION_STRING)
