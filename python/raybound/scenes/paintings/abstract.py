"""Abstract pictures: circles, grids, colour fields, discs, illusions."""

from __future__ import annotations

import numpy as np

from .canvas import Canvas, fractal, mix, ramp, smoothstep


def circles() -> Canvas:
    """Floating discs and rays on a glowing ground, after Kandinsky."""
    c = Canvas(400, 320)
    c.lay(ramp(np.hypot(c.x - 0.55, c.y - 0.55), (0.0, "f6ead0"), (0.5, "ecd6b0"), (0.9, "b99678")))
    c.fill(c.circle(0.43, 0.60, 0.30), "22202b")
    for k, code in enumerate(("5b3a8c", "c2356b", "e9803b", "f4c84b")):
        c.fill(c.circle(0.43 + 0.012 * k, 0.60 + 0.01 * k, 0.245 - 0.052 * k), code)
    c.fill(c.circle(0.47, 0.635, 0.04), "1c5f8a")
    discs = [
        (0.88, 0.68, 0.15, "2f7fa8"), (0.98, 0.56, 0.11, "d94a38"), (0.80, 0.30, 0.18, "f0b63c"),
        (0.92, 0.26, 0.10, "3b7d5a"), (0.20, 0.24, 0.12, "c9443e"), (0.30, 0.17, 0.07, "254a7d"),
        (0.12, 0.80, 0.06, "3f8f86"), (1.14, 0.86, 0.07, "7c4a92"), (0.60, 0.15, 0.055, "e27f36"),
        (1.13, 0.20, 0.045, "27324f"), (0.69, 0.85, 0.045, "d9577f"),
    ]  # fmt: skip
    for x, y, r, code in discs:
        c.fill(c.circle(x, y, r), code, 0.86)
        c.fill(c.circle(x - 0.02, y + 0.02, r * 0.45), "fff3d8", 0.28)
        c.stroke(c.circle(x, y, r * 1.14), 0.004, "2a2433", 0.8)
    c.fill(c.polygon([(0.02, 0.03), (1.20, 0.60), (1.20, 0.66)]), "3a2b4a", 0.55)
    c.fill(c.polygon([(0.62, 0.98), (0.98, 0.05), (1.04, 0.05)]), "f8f0dc", 0.55)
    for k in range(5):
        c.stroke(c.line([(0.05 + 0.05 * k, 0.42), (0.28 + 0.05 * k, 0.98)]), 0.004 + 0.002 * k, "2a2433")
    for k in range(4):
        for j in range(4):
            if (k + j) % 2 == 0:
                c.fill(c.box(0.99 + 0.032 * k, 0.42 - 0.032 * j + 0.012 * k, (0.016, 0.016), 20), "2a2433")
    for k in range(4):
        ring = np.maximum(np.abs(c.circle(0.55, 0.02, 0.10 + 0.03 * k)) - 0.004, 0.02 - c.y)
        c.fill(ring, ("c2356b", "2f7fa8", "2a2433", "e9803b")[k])
    return c


def grid() -> Canvas:
    """Black bars and primary fields, after Mondrian."""
    c = Canvas(320, 400, "efeae0")
    fields = [
        (0.00, 0.52, 0.20, 1.00, "f1ece2"), (0.24, 0.52, 0.80, 1.00, "b3241c"), (0.00, 0.00, 0.20, 0.22, "1f4488"),
        (0.60, 0.00, 0.80, 0.12, "e9bd2e"), (0.24, 0.16, 0.56, 0.48, "f4f0e8"), (0.00, 0.26, 0.20, 0.48, "e6e2da"),
        (0.60, 0.16, 0.80, 0.30, "232328"), (0.24, 0.00, 0.56, 0.12, "ece7dc"),
    ]  # fmt: skip
    for x0, y0, x1, y1, code in fields:
        c.fill(c.box((x0 + x1) / 2, (y0 + y1) / 2, ((x1 - x0) / 2 + 0.02, (y1 - y0) / 2 + 0.02)), code)
    c.image *= 0.985 + 0.03 * fractal(c.x, c.y, (3, 9), 5, 2)[..., None]
    bars = [
        ((0.22, 0.0), (0.22, 1.0), 0.034), ((0.0, 0.50), (0.8, 0.50), 0.034), ((0.58, 0.0), (0.58, 0.50), 0.026),
        ((0.0, 0.24), (0.21, 0.24), 0.034), ((0.22, 0.14), (0.8, 0.14), 0.026), ((0.58, 0.31), (0.8, 0.31), 0.02),
        ((-0.1, 0.80), (0.21, 0.80), 0.044),
    ]  # fmt: skip
    for start, end, width in bars:
        c.stroke(c.line([start, end]), width, "17161a")
    return c


def squares() -> Canvas:
    """Nested squares of neighbouring hues, after Albers."""
    c = Canvas(320, 320)
    c.lay(ramp(c.y, (0.0, "8f2f1d"), (1.0, "a63a22")))
    for half, code in ((0.40, "c9562b"), (0.295, "e58a32"), (0.19, "f5bf4f")):
        centre = 0.5 - (0.5 - half) * 0.5
        c.fill(c.box(0.5, centre, (half, half)), code)
        glow = smoothstep(half * 1.5, 0, np.hypot(c.x - 0.5, c.y - centre))
        c.fill(c.box(0.5, centre, (half, half)), "ffe7a0", 0.14 * glow)
    return c


def discs() -> Canvas:
    """Simultaneous discs: rings cut into quarters of changing colour, after Delaunay."""
    c = Canvas(400, 320)
    c.lay(ramp(c.x + 0.3 * c.y, (0.0, "2b4c80"), (0.5, "e2c58a"), (1.0, "c05a3e"), (1.5, "3d2f55")))
    wheel = ["d8432f", "f2b134", "2f8f6b", "1f5fa8", "f3e9d2", "6b3b8c", "ef7d3c", "26343f", "8cc0c4", "c9345f"]
    for n, (x, y, radius) in enumerate(
        [(0.30, 0.66, 0.31), (0.90, 0.36, 0.36), (0.98, 0.88, 0.17), (0.28, 0.12, 0.19)]
    ):
        angle = np.arctan2(c.y - y, c.x - x) + 0.35 * n
        quarter = np.floor(angle / (np.pi / 2)).astype(int)
        rings = 6 if radius > 0.25 else 4
        for k in range(rings):
            for q in range(-2, 4):
                paint = wheel[(3 * q + 2 * k + 5 * n + k * k) % len(wheel)]
                c.fill(c.circle(x, y, radius * (1 - k / rings)), paint, (quarter == q).astype(float))
    return c


def fields() -> Canvas:
    """Two glowing clouds of colour, after Rothko."""
    c = Canvas(300, 400)
    c.lay(ramp(c.y, (0.0, "5a1520"), (1.0, "7c1f22")))
    for y, half, inner, outer in (
        (0.70, (0.31, 0.205), "f0a23c", "d9612c"),
        (0.335, (0.31, 0.095), "6e1a3a", "4a1230"),
        (0.135, (0.31, 0.075), "e0542f", "b8332a"),
    ):
        ragged = 0.02 * (fractal(c.x, c.y, (7, 7), int(100 * y), 3) - 0.5)
        veil = fractal(c.x, c.y, (3, 3), 7 + int(100 * y), 2)
        depth = ((c.x - 0.375) / half[0]) ** 4 + ((c.y - y) / half[1]) ** 4
        # The product of two fades has round corners and no mitre lines.
        across = smoothstep(0.022, -0.03, np.abs(c.x - 0.375) - half[0] + ragged)
        upward = smoothstep(0.022, -0.03, np.abs(c.y - y) - half[1] + ragged)
        c.lay(ramp(depth + 0.7 * (veil - 0.5), (0.0, inner), (1.0, outer)), across * upward)
    return c


def bulge() -> Canvas:
    """A chequered plane that swells into a globe, after Vasarely."""
    c = Canvas(360, 360)
    u, v = c.x - 0.5, c.y - 0.5
    r = np.hypot(u, v) / 0.40
    inside = r < 1
    swell = np.where(inside, np.arcsin(np.minimum(r, 1)) / np.maximum(r, 1e-9) / (np.pi / 2), 1.0)
    # Inside the globe the sheet is seen on a sphere; its edge joins the flat sheet.
    p, q = u * swell * 16, v * swell * 16
    wave = np.sin(np.pi * p) * np.sin(np.pi * q)
    edge = np.clip(0.5 + wave * 12 / np.where(inside, 1.2, 1.0), 0, 1)
    light = np.clip(1.15 - 0.9 * np.hypot(u + 0.12, v - 0.14) / 0.45, 0, 1)
    dark = np.where(
        inside[..., None], ramp(light, (0.0, "101c4a"), (1.0, "2f62c9")), ramp(c.y, (0, "1a1033"), (1, "2c1a50"))
    )
    pale = np.where(inside[..., None], ramp(light, (0.0, "a8402f"), (0.6, "f08a3c"), (1.0, "ffe39a")),
                    ramp(c.y, (0.0, "4a2b78"), (1.0, "7a4fae")))  # fmt: skip
    c.lay(mix(dark, pale, edge))
    c.stroke(c.circle(0.5, 0.5, 0.40), 0.006, "0c1030", 0.9)
    return c
