"""Bilinear lookups at known places, wrapping, scale, orientation, decoding: seen on a square of size 1."""

import numpy as np
import pytest
from tests.support.support_light import EMITTER_AMBIENT, f32, radiance

import raybound as rb

LIMIT = 2e-6  # absolute, for texels up to 1; largest observed 8.9e-7 (scaled 3.7 times)


def shown(texture: rb.Texture, uv: np.ndarray) -> np.ndarray:
    """What a polygon with u = x and v = y shows at (u, v)."""
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    scene.add(rb.Polygon([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]), rb.Material(texture))
    origins = np.column_stack([uv, np.ones(len(uv))])
    return radiance(scene, origins, (0, 0, -1))


def wrapped(index: np.ndarray, size: int, wrap: str) -> np.ndarray:
    if wrap == "clamp":
        return np.clip(index, 0, size - 1)
    if wrap == "repeat":
        return index % size
    index = index % (2 * size)
    return np.where(index < size, index, 2 * size - 1 - index)


def bilinear(texels: np.ndarray, uv: np.ndarray, scale: tuple, wrap: str) -> np.ndarray:
    """The definition in float64: texel centres at (i + 1/2)/n, row 0 at the top, which is v = 1."""
    height, width, _ = texels.shape
    x, y = uv[:, 0] * scale[0] * width - 0.5, uv[:, 1] * scale[1] * height - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    total = 0
    for dj in (0, 1):
        for di in (0, 1):
            weight = np.abs(1 - di - (x - i)) * np.abs(1 - dj - (y - j))
            row, column = wrapped(j + dj, height, wrap), wrapped(i + di, width, wrap)
            total = total + texels[height - 1 - row, column] * weight[:, None]
    return total


def random_uv(seed: int, n: int = 1000) -> np.ndarray:
    return f32(np.random.default_rng(seed).uniform(0, 1, (n, 2)))


def test_texel_centres_show_their_texels() -> None:
    texels = f32(np.random.default_rng(60).uniform(0, 1, (3, 5, 3)))
    rows, columns = np.mgrid[0:3, 0:5]
    uv = np.column_stack([(columns.ravel() + 0.5) / 5, 1 - (rows.ravel() + 0.5) / 3])
    assert np.abs(shown(rb.Texture(texels), uv) - texels.reshape(-1, 3)).max() < LIMIT


def test_halfway_between_texels_is_their_mean() -> None:
    texture = rb.Texture([[[1, 0, 0], [0, 1, 0]], [[0, 0, 1], [1, 1, 1]]], wrap="clamp")
    assert shown(texture, np.array([[0.5, 0.5]]))[0].tolist() == [0.5, 0.5, 0.5]
    assert shown(texture, np.array([[0.5, 0.75]]))[0].tolist() == [0.5, 0.5, 0]
    assert shown(texture, np.array([[0.25, 0.5]]))[0].tolist() == [0.5, 0, 0.5]


def test_row_zero_is_at_the_top() -> None:
    texture = rb.Texture([[[1, 0, 0]], [[0, 1, 0]]])
    assert shown(texture, np.array([[0.5, 0.75], [0.5, 0.25]])).tolist() == [[1, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize("wrap", ["repeat", "clamp", "mirror"])
@pytest.mark.parametrize("scale", [(1, 1), (2, 3), (3.7, 0.4), (-1.5, 2), (1, -1)])
@pytest.mark.parametrize("shape", [(1, 1), (2, 2), (3, 5), (7, 1)])
def test_random_lookups_against_the_definition(wrap: str, scale: tuple, shape: tuple) -> None:
    texels = f32(np.random.default_rng(61).uniform(0, 1, (*shape, 3)))
    uv = random_uv(62)
    exact = bilinear(texels, uv, f32(scale), wrap)
    error = np.abs(shown(rb.Texture(texels, scale, wrap=wrap), uv) - exact)
    assert error.max() < LIMIT * max(1, np.abs(scale).max() * max(shape) / 4)
    assert shape == (1, 1) or exact.std() > 0.05


def test_repeat_joins_the_last_texel_to_the_first() -> None:
    texture = rb.Texture([[[0, 0, 0], [1, 1, 1]]], wrap="repeat")
    assert shown(texture, np.array([[2.0**-20, 0.5]]))[0, 0] == pytest.approx(0.5, abs=1e-5)
    assert shown(texture, np.array([[1 - 2.0**-20, 0.5]]))[0, 0] == pytest.approx(0.5, abs=1e-5)


@pytest.mark.parametrize("wrap", ["repeat", "clamp", "mirror"])
def test_huge_scales_stay_within_the_texels(wrap: str) -> None:
    texture = rb.Texture([[[0.25, 1, 0.5], [0.75, 0, 0.5]]], (1e9, -1e9), wrap=wrap)
    values = shown(texture, random_uv(63))
    assert values[:, 0].min() >= 0.25
    assert values[:, 0].max() <= 0.75
    assert np.abs(values[:, 2] - 0.5).max() < 1e-6


def srgb_to_linear(code: np.ndarray) -> np.ndarray:
    c = code / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def test_bytes_are_decoded_from_srgb() -> None:
    codes = np.arange(256, dtype=np.uint8)
    texels = np.repeat(codes.reshape(16, 16, 1), 3, axis=2)
    rows, columns = np.mgrid[0:16, 0:16]
    uv = np.column_stack([(columns.ravel() + 0.5) / 16, 1 - (rows.ravel() + 0.5) / 16])
    values = shown(rb.Texture(texels), uv)
    # Largest observed 3.5e-6: positions are rounded, and neighbours in a row of bytes differ by up to 0.6.
    assert np.abs(values[:, 1] - srgb_to_linear(codes.astype(float))).max() < 1e-5
    assert np.abs(rb.Texture(texels).texels[..., 0].ravel() - srgb_to_linear(codes.astype(float))).max() < 1e-6


def test_floats_are_linear_and_may_exceed_one() -> None:
    assert shown(rb.Texture(np.full((1, 1, 3), 123.5)), np.array([[0.5, 0.5]]))[0].tolist() == [123.5] * 3


def test_bytes_read_from_a_file_are_decoded_like_those_of_an_array(tmp_path) -> None:
    import OpenImageIO as oiio

    codes = np.random.default_rng(64).integers(0, 256, (4, 6, 3)).astype(np.uint8)
    path = str(tmp_path / "t.png")
    image = oiio.ImageBuf(oiio.ImageSpec(6, 4, 3, oiio.UINT8))
    image.set_pixels(oiio.ROI(), codes)
    assert image.write(path)
    uv = random_uv(65, 100)
    assert (shown(rb.Texture(path), uv) == shown(rb.Texture(codes), uv)).all()
    assert np.abs(shown(rb.Texture(path), uv) - bilinear(srgb_to_linear(codes), uv, (1, 1), "repeat")).max() < 5e-6
