"""Pictures of land, sea and sky."""

from __future__ import annotations

import numpy as np

from .canvas import Array, Canvas, colour, curve, fractal, mix, noise, ramp, smoothstep


def ridge(c: Canvas, level: float, height: float, cells: int, seed: int) -> Array:
    """Signed distance (in y) to a fractal ridge: negative below it."""
    u = c.x / 4 + 0.13 * seed
    crest = level + height * (fractal(u, np.full_like(u, 0.37), (cells * 4, 3), seed, 5) - 0.5)
    return np.asarray(c.y - crest)


def mist() -> Canvas:
    """Blue ridges one behind the other in morning mist, on a tall scroll."""
    c = Canvas(280, 480)
    c.lay(ramp(c.y, (0.45, "f6d9b8"), (0.72, "f3c79f"), (0.88, "d99f8f"), (1.0, "a97f8e")))
    c.fill(c.circle(0.40, 0.80, 0.055), "fff4da")
    c.lay("fff0d0", 0.6 * np.exp(-(((c.x - 0.40) ** 2 + (c.y - 0.80) ** 2) / 0.012)))
    layers = ("c9a9a6", "a493a3", "7f7f99", "5d6a89", "425673", "2b4159", "182b3d")
    for k, code in enumerate(layers):
        level = 0.70 - 0.095 * k
        below = ridge(c, level, 0.20 + 0.01 * k, 3 + k % 3, 11 * k + 7)
        haze = smoothstep(level + 0.06, level - 0.13, c.y) * (0.85 if k < 6 else 0.0)
        c.fill(below, mix(colour(code), colour("ead2c0"), haze))
    trunk_x = 0.13
    for k in range(9):
        y, half = 0.16 + 0.032 * k, 0.085 * (1 - k / 9.5)
        c.fill(c.polygon([(trunk_x - half, y), (trunk_x + half, y), (trunk_x, y + 0.075)]), "0c1a26")
    c.fill(c.box(trunk_x, 0.14, (0.008, 0.05)), "0c1a26")
    return c


def sunset() -> Canvas:
    """The sun goes down over a calm sea."""
    c = Canvas(480, 320)
    horizon, sun = 0.42, 0.92
    c.lay(ramp(c.y, (0.42, "ffd27a"), (0.52, "f79a52"), (0.68, "cf5a5a"), (0.85, "6b3a6e"), (1.0, "2d2a5c")))
    clouds = fractal(c.x / 1.5, c.y * 1.0 + 0.1 * c.x, (3, 12), 41, 5)
    band = smoothstep(0.50, 0.72, clouds) * smoothstep(0.46, 0.62, c.y)
    c.lay(ramp(c.y, (0.5, "ffe2a0"), (0.66, "f2806a"), (0.9, "7a4a80")), 0.75 * band)
    glow = np.exp(-((c.x - sun) ** 2 + 2.2 * (c.y - horizon - 0.06) ** 2) / 0.05)
    c.lay("fff0b8", 0.75 * glow)
    c.fill(c.circle(sun, horizon + 0.055, 0.075), "fffbe6")
    water = ramp(c.y, (0.0, "141b3d"), (0.2, "3a3566"), (0.36, "a5565f"), (0.42, "f0a765"))
    depth = np.maximum(horizon - c.y, 0) + 0.012
    ripple = np.sin(9.0 / depth + 6 * noise(c.x / 1.5, c.y, (9, 40), 3)) * smoothstep(0.0, 0.05, depth)
    spread = 0.03 + 0.55 * depth
    path = np.exp(-(((c.x - sun) / spread) ** 2)) * smoothstep(-0.4, 0.9, ripple)
    sea = mix(water, colour("ffe6a6"), 0.9 * path)
    sea = mix(sea, colour("20204a"), 0.20 * smoothstep(0.2, 1.0, -ripple))
    c.fill(c.y - horizon, sea)
    c.fill(
        c.polygon(curve([(0.0, 0.415), (0.0, 0.50), (0.12, 0.53), (0.26, 0.47), (0.42, 0.44), (0.52, 0.416)])), "3d2348"
    )
    for x, size in ((0.62, 0.06), (0.70, 0.035)):
        c.fill(c.polygon([(x, horizon - 0.01), (x + size * 0.7, horizon - 0.01), (x, horizon + size * 1.7)]), "f7e3c4")
        c.fill(c.polygon([(x - size * 0.5, horizon - 0.005), (x + size * 0.8, horizon - 0.005),
                          (x + size * 0.5, horizon - 0.03), (x - size * 0.3, horizon - 0.03)]), "2a1638")  # fmt: skip
    return c


def night() -> Canvas:
    """Stars that swirl over a sleeping village, after van Gogh."""
    c = Canvas(480, 380)
    x, y = c.x, c.y
    swirls = [(0.50, 0.66, 0.17, 1.0), (0.78, 0.52, 0.11, -0.9), (0.16, 0.52, 0.09, 0.8), (1.12, 0.40, 0.09, 0.6)]
    u, v = np.full_like(x, 0.55), 0.22 * np.cos(7 * x)
    for sx, sy, r, power in swirls:
        weight = 3.4 * power * np.exp(-((x - sx) ** 2 + (y - sy) ** 2) / (2 * r * r)) / r
        u, v = u - weight * (y - sy), v + weight * (x - sx)
    length = np.hypot(u, v) + 1e-9
    u, v = u / length, v / length
    strokes = sweep(c, u, v, 0.09)
    tone = np.clip(0.30 + 0.5 * (y - 0.2) + 1.25 * (strokes - 0.5), 0, 1)
    c.lay(ramp(tone, (0.0, "0d1c4f"), (0.35, "1f4390"), (0.6, "4f86bd"), (0.8, "a8c7c8"), (1.0, "f0e8b0")))
    stars = [(0.12, 0.88, 0.05), (0.33, 0.92, 0.04), (0.62, 0.91, 0.045), (0.86, 0.80, 0.05), (0.33, 0.70, 0.035),
             (0.98, 0.60, 0.04), (0.10, 0.68, 0.03), (0.74, 0.70, 0.03)]  # fmt: skip
    for sx, sy, r in [*stars, (1.10, 0.84, 0.095)]:
        d = np.hypot(x - sx, y - sy)
        halo = np.exp(-((d / (1.9 * r)) ** 2)) * (0.72 + 0.4 * strokes + 0.16 * np.cos(d / r * 8))
        c.lay(ramp(d / r, (0.4, "ffe98a"), (1.6, "f2cf54"), (2.6, "b9cf9a")), np.clip(halo, 0, 1))
        c.fill(d - 0.42 * r, "fff6c4")
    c.fill(np.maximum(c.circle(1.10, 0.84, 0.06), -c.circle(1.075, 0.855, 0.052)), "f6b43a")
    village(c, strokes)
    return c


def sweep(c: Canvas, u: Array, v: Array, length: float) -> Array:
    """Brush strokes: noise averaged along the flow (u, v), in [0, 1] about one half."""
    total, steps = np.zeros_like(c.x), 16
    px, py = c.x.copy(), c.y.copy()
    height, width = c.x.shape
    for _ in range(steps):
        total += noise(px / 2, py / 2, (190, 190), 17) + 0.5 * noise(px / 2, py / 2, (60, 60), 18)
        i = np.clip((px * height).astype(int), 0, width - 1)
        j = np.clip(((1 - py) * height).astype(int), 0, height - 1)
        px, py = px + u[j, i] * length / steps, py + v[j, i] * length / steps
    total = total / steps / 1.5
    return np.asarray(np.clip(0.5 + (total - total.mean()) / (4.5 * total.std()), 0, 1))


def village(c: Canvas, strokes: Array) -> None:
    """Hills, a few lit houses, a steeple and a cypress, over the lower part of the night."""
    for level, height, seed, codes in ((0.30, 0.22, 5, ("1b3566", "35609a")), (0.20, 0.12, 9, ("10233f", "2b4d62"))):
        hill = ridge(c, level, height, 2, seed)
        c.fill(hill, ramp(strokes, (0.2, codes[0]), (0.9, codes[1])))
    for k, x in enumerate((0.46, 0.55, 0.66, 0.75, 0.86, 0.96, 1.08)):
        y, w = 0.10 + 0.015 * (k * 5 % 3), 0.034
        c.fill(c.box(x, y, (w, 0.035)), ("1d2c4c", "26395a", "172440")[k % 3])
        c.fill(
            c.polygon([(x - w - 0.01, y + 0.035), (x + w + 0.01, y + 0.035), (x, y + 0.08)]),
            ("3c3152", "472f46")[k % 2],
        )
        c.fill(c.box(x - 0.01, y, (0.008, 0.011)), "ffd564")
    c.fill(c.polygon([(0.690, 0.12), (0.722, 0.12), (0.716, 0.22), (0.706, 0.33), (0.696, 0.22)]), "15233f")
    shape = curve([(0.10, -0.02), (0.11, 0.20), (0.155, 0.42), (0.17, 0.60), (0.195, 0.80), (0.215, 0.60), (0.25, 0.44),
                   (0.285, 0.22), (0.31, -0.02)])  # fmt: skip
    flame = c.polygon(shape) + 0.022 * (noise(c.x, c.y, (22, 14), 8) - 0.5)
    c.fill(flame, ramp(strokes + 0.25 * np.sin(60 * c.x + 9 * c.y), (0.2, "0a1410"), (0.9, "2e4a2c")))


def birches() -> Canvas:
    """White trunks in an autumn wood."""
    c = Canvas(300, 400)
    c.lay(ramp(c.y, (0.0, "5c3a1e"), (0.25, "b8702a"), (0.6, "e3a63c"), (1.0, "f3cf6e")))
    rng = np.random.default_rng(12)
    litter = fractal(c.x, c.y, (24, 40), 77, 2)
    autumn = ramp(litter, (0.25, "6b3517"), (0.5, "b4652a"), (0.75, "e0a040"))
    for depth in range(3):
        leaves = noise(c.x, c.y, (26 - 5 * depth, 26 - 5 * depth), 30 + depth)
        paint = ("d9852b", "c8591f", "f4d35e")[depth]
        c.lay(paint, 0.8 * smoothstep(0.60, 0.72, leaves) * smoothstep(0.22, 0.5, c.y))
        for _ in range((9, 5, 3)[depth]):
            x, lean, width = rng.uniform(0, 0.75), rng.uniform(-0.05, 0.05), (0.018, 0.032, 0.055)[depth]
            axis = x + lean * c.y + 0.006 * np.sin(9 * c.y + 20 * x)
            side = (c.x - axis) / (width / 2)
            bark = ramp(side, (-1.0, "8f7f7a"), (-0.3, "f7f1e6"), (0.3, "e6dccd"), (1.0, "6f5f63"))
            marks = noise(c.x * 0.7 + x, c.y, (6, 46), int(1000 * x)) * (0.6 + 0.4 * np.abs(side))
            bark = mix(bark, colour("2b2226"), smoothstep(0.62, 0.72, marks))
            bark = mix(bark, colour("d99a4a"), (0.55, 0.25, 0.0)[depth])
            c.fill(np.maximum(np.abs(c.x - axis) - width / 2, -c.y), bark)
        ground = c.y - (0.20, 0.155, 0.10)[depth] - 0.05 * (litter - 0.5) - 0.03 * noise(c.x, c.y, (5, 2), 4)
        c.lay(autumn * (0.82, 0.92, 1.0)[depth], smoothstep(0.006, -0.006, ground))  # hides the ends of the trunks
    return c
