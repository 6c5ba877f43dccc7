"""Frames saved by OpenImageIO and read back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from tests.python.samples import ball_scene

import raybound as rb

FRAME = rb.render(ball_scene())


def read(path: Path, kind: str = "float") -> tuple[np.ndarray, oiio.ImageSpec]:
    image = oiio.ImageInput.open(str(path))
    assert image is not None, oiio.geterror()
    pixels = image.read_image(kind)
    spec = image.spec()
    image.close()
    return pixels, spec


def test_exr_keeps_everything_as_named_channels(tmp_path: Path) -> None:
    FRAME.save(tmp_path / "frame.exr")
    pixels, spec = read(tmp_path / "frame.exr")
    assert sorted(spec.channelnames) == sorted(["R", "G", "B", "error_bound", "Z", "object_id", "path"])
    assert spec.format == oiio.FLOAT
    channel = {name: pixels[:, :, index] for index, name in enumerate(spec.channelnames)}
    for index, name in enumerate("RGB"):
        assert channel[name].tobytes() == FRAME.image[:, :, index].tobytes()
    assert (channel["Z"] == FRAME.depth).all()
    assert (channel["object_id"] == FRAME.object_id).all()
    assert (channel["path"] == FRAME.path).all()
    assert (channel["error_bound"] == FRAME.error_bound).all()


def test_exr_keeps_open_pixels(tmp_path: Path) -> None:
    first = next(iter(rb.Renderer(ball_scene()).refine()))
    first.save(tmp_path / "open.EXR")
    pixels, spec = read(tmp_path / "open.EXR")
    bound = pixels[:, :, spec.channelnames.index("error_bound")]
    assert np.isinf(bound).any()
    assert (bound == first.error_bound).all()


@pytest.mark.parametrize("name", ["frame.png", "frame.tif", "frame.bmp", "frame.PNG"])
def test_other_formats_are_srgb_bytes(name: str, tmp_path: Path) -> None:
    FRAME.save(str(tmp_path / name))
    pixels, spec = read(tmp_path / name, "uint8")
    assert spec.format == oiio.UINT8
    assert spec.channelnames == ("R", "G", "B")
    assert np.abs(pixels.astype(int) - FRAME.to_srgb()).max() <= 1


def test_png_holds_the_bytes_of_to_srgb(tmp_path: Path) -> None:
    FRAME.save(tmp_path / "frame.png")
    assert (read(tmp_path / "frame.png", "uint8")[0] == FRAME.to_srgb()).all()
    assert (tmp_path / "frame.png").read_bytes()[:16] == FRAME._repr_png_()[:16]


def test_jpeg(tmp_path: Path) -> None:
    for name in ("frame.jpg", "frame.jpeg"):
        FRAME.save(tmp_path / name)
        pixels, _ = read(tmp_path / name, "uint8")
        assert np.abs(pixels.astype(int) - FRAME.to_srgb()).mean() < 6


def test_a_saved_picture_is_a_texture_of_the_same_light(tmp_path: Path) -> None:
    FRAME.save(tmp_path / "frame.exr")
    assert (rb.Texture(tmp_path / "frame.exr").texels == FRAME.image).all()
    FRAME.save(tmp_path / "frame.png")
    clipped = np.clip(FRAME.image, 0, 1)
    np.testing.assert_allclose(rb.Texture(tmp_path / "frame.png").texels, clipped, atol=0.005)


def test_saving_overwrites(tmp_path: Path) -> None:
    path = tmp_path / "frame.png"
    path.write_text("old")
    FRAME.save(path)
    assert read(path)[0].shape == (32, 48, 3)
    assert [item.name for item in tmp_path.iterdir()] == ["frame.png"]


def test_errors(tmp_path: Path) -> None:
    for name in ("frame.xyz", "frame"):
        with pytest.raises(
            ValueError, match=r"Frame\.save: path must end in the extension of an image format"
        ) as caught:
            FRAME.save(tmp_path / name)
        assert "\n" not in str(caught.value)
    for name in ("none/frame.png", "none/frame.exr"):
        with pytest.raises(FileNotFoundError, match=r"Frame\.save: no such folder: .*none"):
            FRAME.save(tmp_path / name)
    for name in ("folder.png", "folder.exr"):
        (tmp_path / name).mkdir()
        with pytest.raises((ValueError, OSError), match="folder"):
            FRAME.save(tmp_path / name)
    with pytest.raises(TypeError, match=r"Frame\.save: path must be a path \(str or pathlib\.Path\), got 3"):
        FRAME.save(3)
    with pytest.raises(ValueError, match=r"Frame\.save: path must be a path, got ''"):
        FRAME.save("")
