"""Pictures from the studio's quieter hours: a cameo, a window, a town, a golden tree."""

from __future__ import annotations

import numpy as np

from .canvas import Canvas, colour, curve, fractal, mix, noise, ramp, smoothstep


def cameo() -> Canvas:
    """A lady's profile in an oval, like a jasperware cameo."""
    c = Canvas(320, 400)
    c.lay(ramp(c.y, (0.0, "5a2f3a"), (1.0, "7a4550")))
    diamonds = np.abs(((c.x + c.y) * 9) % 1 - 0.5) + np.abs(((c.x - c.y) * 9) % 1 - 0.5)
    c.lay("8c5560", 0.55 * smoothstep(0.16, 0.10, diamonds))
    oval = (np.hypot((c.x - 0.4) / 0.33, (c.y - 0.5) / 0.43) - 1) * 0.36
    c.fill(oval - 0.030, "3c2018")
    c.fill(oval - 0.026, ramp(c.x + c.y, (0.3, "f0cf7a"), (0.9, "a8762c"), (1.5, "e8c46a")))
    c.fill(oval, ramp(np.hypot(c.x - 0.32, c.y - 0.62), (0.0, "a9c4d6"), (0.7, "54789c")))
    profile = [
        (0.50, 0.815), (0.545, 0.775), (0.562, 0.735), (0.563, 0.700), (0.556, 0.668), (0.560, 0.648),
        (0.580, 0.618), (0.594, 0.596), (0.588, 0.582), (0.566, 0.575), (0.564, 0.562), (0.574, 0.547),
        (0.570, 0.535), (0.560, 0.529), (0.568, 0.519), (0.566, 0.506), (0.552, 0.498), (0.552, 0.482),
        (0.560, 0.462), (0.550, 0.440), (0.525, 0.428), (0.490, 0.428), (0.462, 0.415), (0.448, 0.380),
        (0.450, 0.335), (0.475, 0.290), (0.530, 0.250), (0.575, 0.205), (0.58, 0.12), (0.40, 0.05), (0.20, 0.12),
        (0.165, 0.215), (0.225, 0.275), (0.290, 0.320), (0.310, 0.375), (0.315, 0.440), (0.295, 0.500),
        (0.285, 0.60), (0.30, 0.70), (0.36, 0.80), (0.43, 0.83),
    ]  # fmt: skip
    face = np.maximum(c.polygon(curve(profile, True, 8)), oval + 0.02)
    c.fill(np.roll(face, (5, 4), (0, 1)), "35536f", 0.55)
    c.fill(face, ramp(c.x - 0.4 * c.y, (0.0, "d9d2c4"), (0.35, "fbf6ea")))
    hair(c)
    gown = np.maximum(np.maximum(face, c.y - 0.215 - 0.35 * (c.x - 0.39) ** 2), -2.0)
    c.fill(gown, ramp(np.sin(70 * c.x + 30 * c.y), (-1, "c4b9a8"), (1, "efe8da")))
    for k in range(9):
        c.fill(c.circle(0.455 - 0.0165 * k, 0.352 - 0.006 * k + 0.0007 * k * k, 0.0105), "54789c")
        c.fill(c.circle(0.453 - 0.0165 * k, 0.354 - 0.006 * k + 0.0007 * k * k, 0.0075), "fdfaf0")
    return c


def hair(c: Canvas) -> None:
    """The lady's hair: a swept crown, a knot behind and a ribbon."""
    crown = c.polygon(curve([(0.525, 0.800), (0.535, 0.745), (0.500, 0.690), (0.455, 0.640), (0.425, 0.575),
                             (0.400, 0.520), (0.340, 0.490), (0.280, 0.505), (0.235, 0.580), (0.235, 0.690),
                             (0.290, 0.800), (0.390, 0.865), (0.480, 0.855)], True))  # fmt: skip
    knot = np.hypot((c.x - 0.205) / 0.082, (c.y - 0.615) / 0.078) * 0.08 - 0.08
    waves = np.sin(85 * np.hypot(c.x - 0.53, c.y - 0.62) + 5 * np.sin(9 * c.y))
    rings = np.sin(150 * np.hypot(c.x - 0.205, c.y - 0.615))
    c.fill(knot - 0.006, "54789c")
    c.fill(knot, ramp(rings, (-1, "c8baa2"), (1, "f4ecdc")))
    c.fill(crown - 0.005, "7d95ab")
    c.fill(crown, ramp(waves, (-1, "cdbfa8"), (1, "f7f0e2")))
    ribbon = c.line(curve([(0.51, 0.83), (0.40, 0.760), (0.30, 0.665), (0.262, 0.560)]))
    c.fill(np.maximum(ribbon - 0.014, crown + 0.004), "54789c")


def window() -> Canvas:
    """A rose of stained glass."""
    c = Canvas(360, 400)
    rng = np.random.default_rng(21)
    spin = [(0.45, 0.5)]
    for ring, (radius, count) in enumerate(((0.085, 6), (0.175, 12), (0.27, 16), (0.365, 20), (0.47, 24), (0.58, 26))):
        for k in range(count):
            a = 2 * np.pi * (k + 0.5 * (ring % 2)) / count + rng.uniform(-0.04, 0.04)
            spin.append((0.45 + radius * np.cos(a), 0.5 + radius * np.sin(a)))
    sites = np.array(spin)
    distances = np.hypot(c.x[..., None] - sites[:, 0], c.y[..., None] - sites[:, 1])
    order = np.argsort(distances, axis=-1)[..., :2]
    near = np.take_along_axis(distances, order, axis=-1)
    owner = order[..., 0]
    wheel = ("f6d24a", "e2572b", "b3182f", "6a1f7a", "23389a", "1582b0", "1c8f63", "e9a02e")
    centre = np.hypot(sites[:, 0] - 0.45, sites[:, 1] - 0.5)
    band = np.searchsorted([0.04, 0.13, 0.22, 0.32, 0.42, 0.52], centre)
    picks = [colour(wheel[(2 * int(b) + (k % 3 == 0) * 3 + (k % 2)) % 8]) for k, b in enumerate(band)]
    glass = np.array(picks)[owner] * (0.80 + 0.45 * fractal(c.x / 2, c.y, (9, 9), 3, 2))[..., None]
    glow = np.exp(-(near[..., 0] ** 2) / 0.004)
    c.lay(mix(glass, colour("fff4c8"), 0.30 * glow))
    gap = (near[..., 1] ** 2 - near[..., 0] ** 2) / np.linalg.norm(sites[order[..., 1]] - sites[owner], axis=-1) / 2
    c.fill(gap - 0.0065, "15131a")
    for radius in (0.13, 0.32):
        c.stroke(c.circle(0.45, 0.5, radius), 0.012, "15131a")
    c.stroke(c.box(0.45, 0.5, (0.44, 0.49)), 0.03, "15131a")
    return c


def town() -> Canvas:
    """A moonlit town of coloured blocks, after Klee."""
    c = Canvas(400, 340)
    c.lay(ramp(c.y, (0.0, "7a3b46"), (0.5, "3f3a66"), (1.0, "1c2148")))
    wheel = ("c8553d", "e09f3e", "588b8b", "8e5572", "d8b26e", "3d5a80", "b56576", "e8c07d", "6d597a", "457b6b")
    rng = np.random.default_rng(5)
    for row in range(5):
        base, x = 0.52 - 0.125 * row, -0.06 * (row % 2)
        while x < c.aspect:
            w, h = rng.uniform(0.075, 0.15), rng.uniform(0.12, 0.24)
            code = wheel[int(rng.integers(len(wheel)))]
            tone = 0.72 + 0.07 * row
            c.fill(c.box(x + w / 2, base + h / 2 - 0.2, (w / 2 - 0.002, h / 2 + 0.2)), colour(code) * tone)
            if rng.random() < 0.6:
                roof = wheel[int(rng.integers(len(wheel)))]
                c.fill(
                    c.polygon([(x, base + h), (x + w, base + h), (x + w / 2, base + h + 0.75 * w)]), colour(roof) * tone
                )
            else:
                dome = np.maximum(c.circle(x + w / 2, base + h, w * 0.42), base + h - c.y)
                c.fill(dome, colour(wheel[int(rng.integers(len(wheel)))]) * tone)
            for k in range(2):
                lit = "ffe08a" if rng.random() < 0.45 else "2a2440"
                c.fill(c.box(x + w * (0.30 + 0.40 * k), base + h - 0.045, (0.010, 0.015)), lit)
            x += w
    c.lay("ffd98a", 0.5 * np.exp(-((c.x - 0.86) ** 2 + (c.y - 0.84) ** 2) / 0.02))
    c.fill(c.circle(0.86, 0.84, 0.075), "f9e3a8")
    c.fill(c.circle(0.845, 0.855, 0.045), "fdf0c8", 0.6)
    weave = 0.5 * noise(c.x / 2, c.y, (150, 12), 2) + 0.5 * noise(c.x / 2, c.y, (24, 75), 4)
    c.image *= (0.93 + 0.14 * weave)[..., None]
    return c


def golden_tree() -> Canvas:
    """A tree of spiral branches on gold, after Klimt."""
    c = Canvas(460, 360)
    c.lay(ramp(fractal(c.x / 1.4, c.y, (7, 5), 31, 3), (0.3, "b98a36"), (0.5, "d9ae52"), (0.7, "efd387")))
    meadow = c.y - 0.13 - 0.025 * np.sin(5 * c.x)
    c.fill(meadow, ramp(fractal(c.x / 1.4, c.y, (30, 24), 13, 2), (0.3, "2e5a3c"), (0.5, "5d8a48"), (0.7, "c9b04a")))
    rng = np.random.default_rng(4)
    for _ in range(60):
        x, y = rng.uniform(0, c.aspect), rng.uniform(0.005, 0.13)
        c.fill(c.circle(x, y, 0.010), ("d9482f", "f4e6c0", "7a4a9c", "f2b632")[int(rng.integers(4))])
    branches(c)
    c.fill(c.polygon(curve([(0.53, 0.08), (0.595, 0.18), (0.608, 0.30), (0.612, 0.42), (0.658, 0.42), (0.662, 0.30),
                            (0.675, 0.18), (0.74, 0.08)])),
           "4a2c18")  # fmt: skip
    return c


def branches(c: Canvas) -> None:
    """Limbs that leave the trunk upward and roll into spirals set with little lozenges."""
    swirls = [(0.20, 0.70, 0.155, 1), (0.45, 0.82, 0.14, 1), (0.80, 0.82, 0.14, -1), (1.08, 0.70, 0.155, -1),
              (0.15, 0.36, 0.12, 1), (1.13, 0.36, 0.12, -1), (0.44, 0.55, 0.08, 1), (0.84, 0.55, 0.08, -1)]  # fmt: skip
    limbs = []
    for x, y, r, hand in swirls:
        away = np.arctan2(y - 0.46, x - 0.635)
        t = np.linspace(0, 1, 70)
        a = away - hand * np.pi / 2 + hand * t * 4.4 * np.pi
        spiral = np.column_stack([x + r * (1 - 0.93 * t) * np.cos(a), y + r * (1 - 0.93 * t) * np.sin(a)])
        ends = np.array(
            [(0.635, 0.36), (0.635, 0.50), spiral[0] - 0.12 * np.array([np.cos(away), np.sin(away)]), spiral[0]]
        )
        s = np.linspace(0, 1, 24)[:, None]
        weights = [(1 - s) ** 3, 3 * s * (1 - s) ** 2, 3 * s * s * (1 - s), s**3]
        stem = sum((w * p for w, p in zip(weights, ends, strict=True)), start=np.zeros((24, 2)))
        width = 0.05 * r + 0.004 + 0.016 * np.exp(-np.hypot(c.x - 0.635, c.y - 0.42) / 0.16)
        limbs.append((c.line(np.vstack([stem, spiral])) - width, spiral, r))
    for distance, _, _ in limbs:
        c.fill(distance - 0.004, "f7e6b0", 0.8)
    for distance, spiral, r in limbs:
        c.fill(distance, "4a2c18")
        for k in range(7):
            x, y = spiral[6 + 7 * k]
            size = 0.045 * r + 0.004
            c.fill(c.box(x, y, (size, size), 45), ("e9c14f", "2d6a78", "d9572f", "f3ead2")[k % 4])
        c.fill(c.circle(spiral[-1, 0], spiral[-1, 1], 0.09 * r), "c23b2a")
