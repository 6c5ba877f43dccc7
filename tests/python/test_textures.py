"""Textures: files by OpenImageIO, arrays, orientation, colour encoding, wrapping and errors."""

from __future__ import annotations

import os
import pickle
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

import raybound as rb


def write(path: Path, pixels: np.ndarray, kind: str = "uint8", channels: tuple[str, ...] = ("R", "G", "B")) -> Path:
    """An image file written by OpenImageIO itself."""
    height, width, count = pixels.shape
    spec = oiio.ImageSpec(width, height, count, kind)
    spec.channelnames = channels
    spec.attribute("oiio:UnassociatedAlpha", 1)  # pixels are what is written, not multiplied by alpha
    output = oiio.ImageOutput.create(str(path))
    assert output is not None
    assert output.open(str(path), spec)
    assert output.write_image(pixels)
    output.close()
    return path


def srgb_to_linear(code: float) -> float:
    """IEC 61966-2-1."""
    return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4


CODES = np.arange(24, dtype=np.uint8).reshape(2, 4, 3) * 11


def test_files_of_8_bits_are_srgb(tmp_path: Path) -> None:
    expected = np.vectorize(srgb_to_linear)(CODES / 255)
    for name in ("a.png", "a.tif", "a.bmp"):
        texture = rb.Texture(write(tmp_path / name, CODES))
        np.testing.assert_allclose(texture.texels, expected, rtol=1e-6)
        assert texture.texels.dtype == np.float32
        assert texture == rb.Texture(CODES)
    white = rb.Texture(write(tmp_path / "white.png", np.full((1, 1, 3), 255, np.uint8)))
    assert (white.texels == 1).all()


def test_files_of_16_bits_are_srgb(tmp_path: Path) -> None:
    codes = CODES.astype(np.uint16) * 257
    texture = rb.Texture(write(tmp_path / "a.png", codes, "uint16"))
    np.testing.assert_allclose(texture.texels, rb.Texture(CODES).texels, rtol=1e-6)
    assert texture == rb.Texture(codes)


def test_files_of_floats_are_linear(tmp_path: Path) -> None:
    radiance = (CODES / 7).astype(np.float32)
    for name in ("a.exr", "a.tif"):
        texture = rb.Texture(write(tmp_path / name, radiance, "float"))
        assert (texture.texels == radiance).all()
        assert texture == rb.Texture(radiance)
    half = rb.Texture(write(tmp_path / "half.exr", radiance, "half"))
    np.testing.assert_allclose(half.texels, radiance, rtol=1e-3)


def test_grey_is_repeated_and_alpha_left_out(tmp_path: Path) -> None:
    grey = rb.Texture(write(tmp_path / "grey.png", CODES[:, :, :1], channels=("Y",)))
    assert (grey.texels == rb.Texture(np.repeat(CODES[:, :, :1], 3, axis=2)).texels).all()
    alpha = np.concatenate([CODES, np.full((2, 4, 1), 60, np.uint8)], axis=2)
    rgba = rb.Texture(write(tmp_path / "rgba.png", alpha, channels=("R", "G", "B", "A")))
    assert rgba == rb.Texture(CODES)


def looked_up(texture: rb.Texture) -> np.ndarray:
    """The texture on a quad of 4 by 2, seen from above with ambient light only: the picture of `CODES`."""
    scene = rb.Scene(ambient=1)
    quad = [(0, 0, 0), (4, 0, 0), (4, 2, 0), (0, 2, 0)]
    scene.add(rb.Polygon(quad), rb.Material(texture))
    x, y = np.meshgrid(np.arange(4) + 0.5, 1.5 - np.arange(2))
    origins = np.stack([x, y, np.ones_like(x)], axis=2).reshape(-1, 3)
    found = rb.Renderer(scene).trace(origins, np.broadcast_to((0, 0, -1), origins.shape))
    uv = scene.intersect(origins, np.broadcast_to((0, 0, -1), origins.shape))["uv"]
    assert (uv >= 0).all()
    return found.radiance.reshape(2, 4, 3)


def test_v_points_up_and_row_0_is_the_top() -> None:
    texels = rb.Texture(CODES).texels
    assert (rb.Texture(texels).texels == texels).all()
    native = rb.Texture(texels)._native
    u, v = (np.arange(4) + 0.5) / 4, (np.arange(2) + 0.5) / 2
    uv = np.stack(np.meshgrid(u, v), axis=2).reshape(-1, 2).astype(np.float32)
    np.testing.assert_allclose(native.lookup(uv).reshape(2, 4, 3)[::-1], texels, rtol=1e-6)


def test_a_picture_seen_from_outside_is_upright() -> None:
    seen = looked_up(rb.Texture(CODES))
    texels = rb.Texture(CODES).texels
    spread = texels[:, -1, 0] - texels[:, 0, 0]
    assert (spread > 0).all()
    assert (seen[:, -1, 0] > seen[:, 0, 0]).all()  # left to right
    assert seen[0].mean() < seen[1].mean()  # the dark row is at the top


def test_scale_and_wrap() -> None:
    texels = np.zeros((1, 4, 3))
    texels[0, :, 0] = (1, 2, 3, 4)

    def first(u: list[float], **arguments: object) -> list[float]:
        uv = np.array([(x, 0.5) for x in u], np.float32)
        texture = rb.Texture(texels, **arguments)
        return np.round(texture._native.lookup(uv)[:, 0], 5).tolist()

    assert first([0.125, 0.375, 0.25]) == [1, 2, 1.5]
    assert first([1.125, -0.875]) == [1, 1]
    assert first([1.125, -0.875], wrap="clamp") == [4, 1]
    assert first([1.125, -0.125], wrap="mirror") == [4, 1]
    assert first([0.0625, 0.5625], scale=(2, 1)) == [1, 1]


def test_missing_and_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"Texture: no such image file.*none\.png"):
        rb.Texture(tmp_path / "none.png")
    with pytest.raises(FileNotFoundError, match="Texture: no such image file"):
        rb.Texture(str(tmp_path))
    for name, content in (("text.png", b"no picture"), ("text.xyz", b"no picture"), ("empty.exr", b"")):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ValueError, match=rf"Texture: cannot read the image file .*{name}") as caught:
            rb.Texture(tmp_path / name)
        assert "\n" not in str(caught.value)
    whole = write(tmp_path / "whole.png", np.random.default_rng(1).integers(0, 255, (64, 64, 3)).astype(np.uint8))
    (tmp_path / "cut.png").write_bytes(whole.read_bytes()[:2000])
    with pytest.raises(ValueError, match=r"Texture: cannot read the image file .*cut\.png"):
        rb.Texture(tmp_path / "cut.png")
    bad = np.full((1, 1, 3), np.nan, np.float32)
    with pytest.raises(ValueError, match=r"Texture: source must be finite, got nan at index \(0, 0, 0\)"):
        rb.Texture(write(tmp_path / "nan.exr", bad, "float"))


def test_the_file_is_read_once(tmp_path: Path) -> None:
    path = write(tmp_path / "a.png", CODES)
    texture = rb.Texture(path, (2, 2))
    path.unlink()
    assert texture.path == str(path)
    assert texture.source == str(path)
    for again in (pickle.loads(pickle.dumps(texture)), texture.replace(wrap="clamp").replace(wrap=None)):
        assert again == texture
        assert again.path == texture.path
    with pytest.raises(FileNotFoundError):
        texture.replace(source=path)


def test_repr_of_a_texture_from_a_file(tmp_path: Path) -> None:
    path = write(tmp_path / "a.png", CODES)
    texture = rb.Texture(path, (2, 0.1), wrap="clamp")
    assert eval(repr(texture), {"Texture": rb.Texture}) == texture
    assert repr(rb.Texture(path)) == f"Texture({os.fspath(path)!r})"


def test_textures_are_equal_by_their_texels(tmp_path: Path) -> None:
    a, b = rb.Texture(write(tmp_path / "a.png", CODES)), rb.Texture(write(tmp_path / "b.png", CODES))
    assert a == b
    assert hash(a) == hash(b)
    assert a != rb.Texture(CODES + np.uint8(1))
    assert a != rb.Texture(CODES, (1, 2))
    assert rb.Texture(np.ones((1, 4, 3))) != rb.Texture(np.ones((4, 1, 3)))
