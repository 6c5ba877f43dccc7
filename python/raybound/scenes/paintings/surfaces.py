"""Tileable textures: floors, wood, marble, wallpaper and a carpet."""

from __future__ import annotations

import numpy as np

from .canvas import Array, Canvas, colour, fractal, mix, noise, ramp, smoothstep


def veins(u: Array, v: Array, seed: int, cells: int = 3) -> Array:
    """Marble veins in [0, 1], of period one: ridges of warped fractal noise."""
    warp = fractal(u, v, (cells, cells), seed, 4) - 0.5
    ridges = np.abs(fractal(u + 0.22 * warp, v + 0.30 * warp, (cells, cells), seed + 20, 4) - 0.5)
    return np.asarray(np.clip(1 - 9 * ridges, 0, 1) ** 2)


def marble() -> Canvas:
    """White marble with grey veins."""
    c = Canvas(256, 256)
    cloud = fractal(c.x, c.y, (2, 2), 4, 4)
    c.lay(ramp(cloud, (0.2, "d2cdc6"), (0.5, "ebe7e0"), (0.8, "f6f3ee")))
    c.lay("8d8a8c", 0.55 * veins(c.x, c.y, 9))
    c.lay("b59a78", 0.25 * veins(c.x, c.y, 41, 2))
    return c


def verde() -> Canvas:
    """Dark green marble with pale veins."""
    c = Canvas(256, 256)
    cloud = fractal(c.x, c.y, (3, 3), 14, 4)
    c.lay(ramp(cloud, (0.25, "12241d"), (0.5, "1f4034"), (0.75, "356150")))
    c.lay("a9c9b4", 0.55 * veins(c.x, c.y, 33))
    c.lay("d9e4d2", 0.30 * veins(c.x, c.y, 57, 4))
    return c


def floor() -> Canvas:
    """Two by two marble flags, cream and grey-rose, with dark lozenges where they meet."""
    c = Canvas(512, 512)
    column, row = np.floor(c.x * 2).astype(int) % 2, np.floor(c.y * 2).astype(int) % 2
    tone = fractal(c.x, c.y, (5, 5), 71, 4)
    cream = ramp(tone, (0.2, "d6c6a8"), (0.8, "ecdfc6"))
    rose = ramp(tone, (0.2, "8a6a5c"), (0.8, "ab8a7a"))
    c.lay(mix(cream, rose, (column ^ row).astype(float)))
    c.lay("f7efe0", 0.30 * veins(c.x, c.y, 90, 5))
    c.lay("6f5c50", 0.22 * veins(c.x, c.y, 130, 4))
    u, v = (c.x * 2 + 0.5) % 1 - 0.5, (c.y * 2 + 0.5) % 1 - 0.5
    joint = np.minimum(np.abs(u), np.abs(v)) / 2
    c.fill(joint - 0.0016, "7d6a58", 0.8)
    lozenge = (np.abs(u) + np.abs(v) - 0.17) / 2 / np.sqrt(2)
    c.fill(lozenge - 0.004, "cdb890")
    c.fill(lozenge, ramp(tone, (0.2, "1e2f2c"), (0.8, "35504a")))
    return c


def planks() -> Canvas:
    """A basket-weave parquet of oak blocks."""
    c = Canvas(256, 256)
    column, row = np.floor(c.x * 2), np.floor(c.y * 2)
    turned = (column + row) % 2 == 1
    along, across = np.where(turned, c.y, c.x) * 2 % 1, np.where(turned, c.x, c.y) * 2 % 1
    board = np.floor(across * 4)
    tint = np.sin(12.9 * column + 78.2 * row + 37.7 * board) * 43.7 % 1
    grain = noise(np.where(turned, c.y, c.x), np.where(turned, c.x, c.y), (4, 64), 6)
    c.lay(ramp(0.55 * tint + 0.45 * grain, (0.0, "8a5a30"), (0.5, "a9743f"), (1.0, "c8955a")))
    seam = np.minimum(np.abs(across * 4 - np.round(across * 4)) / 8, np.abs(along - np.round(along)) / 2)
    c.fill(seam - 0.003, "4d2f18", 0.7)
    return c


def wood() -> Canvas:
    """Walnut with the grain running along u."""
    c = Canvas(256, 256)
    bend = fractal(c.x, c.y, (2, 3), 60, 3)
    rings = np.sin(2 * np.pi * (12 * c.y + 1.6 * bend))
    fine = noise(c.x, c.y, (3, 64), 61)
    c.lay(ramp(0.5 + 0.14 * rings + 0.32 * (fine - 0.5), (0.0, "3a2012"), (0.5, "5c351c"), (1.0, "7e4e2b")))
    return c


def wallpaper() -> Canvas:
    """A damask of two close greens: palmettes on a half-drop repeat."""
    c = Canvas(256, 256)
    c.lay(colour("7d9482"))
    for dx, dy in ((0.0, 0.0), (0.5, 0.5)):
        u = np.abs((c.x + dx) % 1 - 0.5)
        v = (c.y + dy) % 1 - 0.5
        frame = np.abs(u - 0.25 * np.cos(np.pi * v) ** 2 * smoothstep(0.5, 0.38, np.abs(v))) - 0.010
        c.lay("8da391", 0.9 * smoothstep(0.006, -0.004, frame))
        for k in range(4):
            a = np.radians((90, 55, 22, -12)[k])
            along = u * np.cos(a) + (v + 0.08) * np.sin(a)
            across = np.abs((v + 0.08) * np.cos(a) - u * np.sin(a))
            reach = (0.25, 0.20, 0.16, 0.12)[k]
            t = np.clip(along / reach, 0, 1)
            leaf = across - 0.036 * np.sin(np.pi * t**0.8)
            c.lay("93a997", 0.95 * smoothstep(0.006, -0.004, np.maximum(leaf, np.maximum(-along, along - reach))))
        bud = np.hypot(u / 0.7, v + 0.21) - 0.05
        c.lay("93a997", 0.95 * smoothstep(0.006, -0.004, bud))
        c.lay("7d9482", smoothstep(0.006, -0.004, np.abs(bud + 0.025) - 0.006))
    return c


def carpet() -> Canvas:
    """A runner with a Persian border; v is its length, which repeats, u its width."""
    c = Canvas(320, 320)
    u = np.abs(c.x - 0.5)
    c.lay(colour("7a1f25"))
    v = (c.y * 2) % 1 - 0.5
    diamond = np.abs(c.x - 0.5) / 0.28 + np.abs(v) / 0.5
    for limit, code in (
        (0.92, "d8b26a"),
        (0.87, "1f2f55"),
        (0.66, "c9a05a"),
        (0.62, "8f2a2c"),
        (0.40, "e3cfa0"),
        (0.34, "1f2f55"),
        (0.16, "d9a441"),
    ):
        c.fill((diamond - limit) * 0.2, code)
    corner = np.abs(np.abs(c.x - 0.5) - 0.28) / 0.10 + np.abs(np.abs(v) - 0.5) / 0.22
    for limit, code in ((0.9, "d8b26a"), (0.75, "2f5d50"), (0.4, "e3cfa0")):
        c.fill((corner - limit) * 0.08, code)
    c.lay("1f2f55", smoothstep(0.0, 0.003, u - 0.375))
    wave = np.abs(np.abs((c.y * 8) % 1 - 0.5) / 8 * 2 + np.abs(u - 0.4375)) - 0.045
    c.lay("c9a05a", smoothstep(0.004, 0.0, wave))
    c.lay("8f2a2c", smoothstep(0.004, 0.0, wave + 0.016))
    for place in (0.375, 0.492):
        c.fill(np.abs(u - place) - 0.005, "e3cfa0")
    weave = noise(c.x, c.y, (80, 80), 5)
    c.image *= (0.92 + 0.14 * weave)[..., None]
    return c


def chessboard() -> Canvas:
    """Eight by eight squares of maple and walnut within an edge; White sits at the right (u = 1), so a1 is dark."""
    c = Canvas(144, 144, "3a2213")
    u, v = (c.x - 0.055) / 0.89 * 8, (c.y - 0.055) / 0.89 * 8
    inside = np.maximum(np.abs(c.x - 0.5), np.abs(c.y - 0.5)) - 0.445
    grain = noise(c.x, c.y, (9, 60), 8)
    light, dark = ramp(grain, (0.0, "d8b480"), (1.0, "ecd2a4")), ramp(grain, (0.0, "5a3319"), (1.0, "764724"))
    cells = np.clip(0.5 + np.sin(np.pi * u) * np.sin(np.pi * v) * 12, 0, 1)
    c.fill(inside, mix(dark, light, cells))
    c.stroke(inside - 0.012, 0.008, "c9a05a")
    return c
