"""Pictures of things: a wave, a still life, a sunflower, a portrait, a window, a town."""

from __future__ import annotations

import numpy as np

from .canvas import Array, Canvas, colour, curve, fractal, mix, ramp, smoothstep


def wave() -> Canvas:
    """A great wave breaks before a far mountain, after Hokusai."""
    c = Canvas(480, 340)
    c.lay(ramp(c.y, (0.2, "e9dcb8"), (0.6, "efe3c4"), (1.0, "c9bb9c")))
    c.lay(
        "8d8a86",
        0.5
        * smoothstep(0.25, 0.55, c.y)
        * smoothstep(1.0, 0.5, c.y)
        * smoothstep(0.5, 0.8, fractal(c.x / 2, c.y, (3, 5), 6, 3)),
    )
    c.fill(
        c.polygon(
            curve([(0.62, 0.26), (0.74, 0.35), (0.83, 0.45), (0.86, 0.46), (0.89, 0.45), (0.98, 0.35), (1.12, 0.26)])
        ),
        "5f6f86",
    )
    c.fill(c.polygon([(0.775, 0.39), (0.83, 0.455), (0.86, 0.467), (0.89, 0.455), (0.945, 0.39), (0.90, 0.415),
                      (0.87, 0.39), (0.83, 0.42)]),
           "f6f1e4")  # fmt: skip
    swell = c.y - 0.20 - 0.07 * np.sin(4.2 * c.x + 2.3)
    c.fill(swell, ramp(np.sin(swell * 90 + 5 * np.sin(3 * c.x)), (-1, "2f5f8f"), (0.2, "dfe6dc"), (1, "31638f")))
    back = [
        (-0.05, -0.05),
        (-0.05, 0.50),
        (0.10, 0.66),
        (0.26, 0.82),
        (0.46, 0.90),
        (0.66, 0.865),
        (0.80, 0.765),
        (0.865, 0.65),
    ]
    front = [(0.80, 0.665), (0.70, 0.70), (0.58, 0.67), (0.50, 0.56), (0.50, 0.42), (0.60, 0.26), (0.78, 0.15),
             (1.00, 0.09), (1.25, 0.10), (1.46, 0.17), (1.46, -0.05)]  # fmt: skip
    body = c.polygon(np.vstack([curve(back), curve(front)]))
    c.fill(body, ramp(c.y + 0.2 * c.x, (0.0, "173a6a"), (0.5, "1f4b84"), (1.0, "2a5d95")))
    stripes(c, body)
    foam(c, curve([(-0.05, 0.52), *back[2:], *front[:3]], steps=16))
    spray = np.random.default_rng(3)
    for _ in range(46):
        x, y = spray.uniform(0.62, 1.12), spray.uniform(0.42, 0.93)
        if (x - 0.55) ** 2 / 0.3 + (y - 0.62) ** 2 / 0.12 < 1.25:
            c.fill(c.circle(x, y, spray.uniform(0.003, 0.008)), "f8f5ea")
    c.stroke(c.box(c.aspect / 2, 0.5, (c.aspect / 2 - 0.012, 0.488)), 0.006, "6d6250", 0.8)
    return c


def stripes(c: Canvas, body: Array) -> None:
    """Pale bands that follow the hollow of the wave."""
    inside = np.clip(-body / c.pixel, 0, 1)
    for k in range(7):
        s = k / 6
        line = curve([(0.05 + 0.20 * s, -0.05), (0.10 + 0.22 * s, 0.30), (0.22 + 0.20 * s, 0.56 - 0.02 * s),
                      (0.42 + 0.12 * s, 0.78 - 0.08 * s), (0.62 + 0.04 * s, 0.80 - 0.09 * s)])  # fmt: skip
        taper = 0.014 * (0.5 + 0.5 * np.cos(5 * c.y + k)) + 0.004
        c.lay("cfe0e4" if k % 2 == 0 else "6f9dc0", inside * np.clip((taper - c.line(line)) / c.pixel + 0.5, 0, 1))
    for k in range(4):
        low = curve(
            [
                (0.45 + 0.12 * k, -0.05),
                (0.62 + 0.12 * k, 0.10 - 0.02 * k),
                (0.90 + 0.1 * k, 0.045 - 0.015 * k),
                (1.46, 0.13 - 0.035 * k),
            ]
        )
        c.lay("9fc1d2", inside * np.clip((0.006 - c.line(low)) / c.pixel + 0.5, 0, 1))


def foam(c: Canvas, crest: Array) -> None:
    """Scalloped foam with claws along the crest."""
    steps = np.random.default_rng(8)
    for tint, grow in (("31557f", 0.006), ("f7f4e8", 0.0)):
        steps = np.random.default_rng(8)
        for k in range(len(crest) - 1):
            (x, y), (x1, y1) = crest[k], crest[k + 1]
            normal = np.array([y1 - y, x - x1]) / max(np.hypot(x1 - x, y1 - y), 1e-9)
            weight = smoothstep(0, 40, k)
            r = (0.010 + 0.020 * float(weight)) * steps.uniform(0.6, 1.15)
            c.fill(c.circle(x, y, r + grow), tint)
            tip = (
                np.array([x, y]) + normal * steps.uniform(0.02, 0.05) * float(weight) + steps.uniform(-0.012, 0.012, 2)
            )
            c.fill(c.circle(tip[0], tip[1], 0.5 * r + grow), tint)
            c.fill(c.line([(x, y), (tip[0], tip[1])]) - 0.35 * r - grow, tint)


def shade(nx: Array, ny: Array, nz: Array, dark: str, base: str, light: str) -> Array:
    """Shading of a painted solid lit from the upper left, with a highlight and a warm bounce from below."""
    lit = np.clip(-0.55 * nx + 0.60 * ny + 0.58 * nz, 0, 1)
    body = ramp(lit, (0.0, dark), (0.55, base), (1.0, light))
    bounce = 0.25 * np.clip(0.6 * nx - 0.7 * ny, 0, 1)
    gleam = np.clip(-0.30 * nx + 0.33 * ny + 0.89 * nz, 0, 1) ** 60
    return mix(mix(body, colour("e0a878"), bounce), np.ones(3), 0.8 * gleam)


def still_life() -> Canvas:
    """A blue vase and fruit on a table, lit from the left."""
    c = Canvas(400, 360)
    c.lay(ramp(np.hypot(c.x - 0.25, c.y - 0.8), (0.0, "a39272"), (0.5, "6b5a48"), (1.2, "2c2430")))
    table = smoothstep(0.305, 0.300, c.y)
    c.lay(ramp(c.x - 0.5 * c.y, (-0.1, "a8683c"), (0.5, "8a4e2c"), (1.1, "4d2a1e")), table)
    c.lay("c98a56", 0.5 * table * smoothstep(0.55, 0.7, fractal(c.x / 1.2, c.y, (2, 26), 19, 2)))
    things = [
        (0.30, 0.25, 0.105, "e"),
        (0.80, 0.235, 0.095, "r"),
        (0.94, 0.185, 0.075, "g"),
        (0.66, 0.16, 0.085, "o"),
        (0.14, 0.17, 0.07, "p"),
    ]
    for x, y, r, _ in [(0.52, 0.20, 0.17, "v"), *things]:
        c.lay(
            "1a0e12",
            0.65 * np.exp(-(((c.x - x - 0.7 * r) / (1.3 * r)) ** 2 + ((c.y - y + 0.88 * r) / (0.32 * r)) ** 2)),
        )
    vase(c, 0.52)
    paints = {"e": ("5f1a12", "c23a22", "f0835a"), "r": ("64200e", "d2691e", "f8b04f"),
              "g": ("2b3d12", "7f9a2e", "d2dc74"),
              "o": ("6a3208", "e48a1e", "ffca5c"), "p": ("2a1233", "5d2f6e", "a377b4")}  # fmt: skip
    for x, y, r, kind in things:
        nx, ny = (c.x - x) / r, (c.y - y) / r
        nz = np.sqrt(np.clip(1 - nx * nx - ny * ny, 0, 1))
        c.fill(c.circle(x, y, r), shade(nx, ny, nz, *paints[kind]))
        c.stroke(c.line(curve([(x, y + 0.80 * r), (x + 0.02, y + 1.05 * r), (x + 0.05, y + 1.2 * r)])), 0.009, "3a2413")
    return c


def vase(c: Canvas, axis: float) -> None:
    """A round-bellied vase with two glazed bands and three sprigs."""
    heights = np.array([0.185, 0.20, 0.30, 0.42, 0.52, 0.60, 0.66, 0.70, 0.715])
    radii = np.array([0.085, 0.095, 0.165, 0.178, 0.135, 0.075, 0.058, 0.078, 0.085])
    fine = curve(list(zip(heights, radii, strict=True)), steps=16)
    for k, (x, y, code) in enumerate([(0.36, 0.90, "e8b43c"), (0.53, 0.95, "d8543f"), (0.70, 0.88, "f0e2d0"),
                                      (0.44, 0.83, "d8543f"), (0.62, 0.80, "e8b43c")]):  # fmt: skip
        c.stroke(c.line(curve([(axis, 0.68), (0.5 * (axis + x) - 0.02, 0.5 * (0.72 + y)), (x, y)])), 0.008, "3f5a30")
        for petal in range(7):
            a = 2 * np.pi * petal / 7 + k
            c.fill(c.circle(x + 0.032 * np.cos(a), y + 0.032 * np.sin(a), 0.022), code)
        c.fill(c.circle(x, y, 0.018), "6a3a1c")
    r = np.interp(c.y, fine[:, 0], fine[:, 1])
    slope = np.interp(c.y, fine[:, 0], np.gradient(fine[:, 1], fine[:, 0]))
    nx = np.clip((c.x - axis) / r, -1, 1)
    scale = 1 / np.sqrt(1 + slope * slope)
    glaze = shade(nx * scale, -slope * scale, np.sqrt(1 - nx * nx) * scale, "10203f", "2f5f9e", "8fc0dc")
    for level in (0.33, 0.48):
        band = shade(nx * scale, -slope * scale, np.sqrt(1 - nx * nx) * scale, "4a3a20", "d8c48a", "fff6d8")
        glaze = mix(glaze, band, smoothstep(0.016, 0.012, np.abs(c.y - level + 0.02 * np.sqrt(1 - nx * nx))))
    sides = [np.column_stack([axis + hand * fine[:, 1], fine[:, 0]])[::hand] for hand in (1, -1)]
    c.fill(c.polygon(np.vstack(sides)), glaze)
    c.fill(np.hypot((c.x - axis) / 0.083, (c.y - 0.713) / 0.016) * 0.02 - 0.02, "0f1c33")


def sunflower() -> Canvas:
    """A sunflower: two rings of petals about a golden-angle spiral of seeds."""
    c = Canvas(360, 400)
    c.lay(ramp(c.y, (0.0, "2f6f8f"), (0.6, "6fb0b8"), (1.0, "a8d0c4")))
    x0, y0, golden = 0.45, 0.55, np.pi * (3 - np.sqrt(5))
    c.stroke(c.line(curve([(0.40, -0.02), (0.44, 0.2), (x0, y0)])), 0.035, "2f5a2c")
    for sx, sy, tx, ty in ((0.42, 0.10, 0.14, 0.20), (0.43, 0.16, 0.76, 0.16)):
        c.fill(
            c.polygon(
                curve(
                    [(sx, sy), ((sx + tx) / 2, (sy + ty) / 2 + 0.07), (tx, ty), ((sx + tx) / 2, (sy + ty) / 2 - 0.04)],
                    True,
                )
            ),
            "3f7a35",
        )
    for ring, (reach, half, codes) in enumerate(
        ((0.40, 0.062, ("b8741a", "e8a422")), (0.365, 0.058, ("e09a1c", "fbd44a")))
    ):
        for k in range(21):
            a = 2 * np.pi * (k + 0.5 * ring) / 21
            along = (c.x - x0) * np.cos(a) + (c.y - y0) * np.sin(a)
            across = (c.y - y0) * np.cos(a) - (c.x - x0) * np.sin(a)
            t = np.clip(along / reach, 0, 1)
            leaf = np.abs(across) - half * np.sqrt(t) * (1 - t**5)
            distance = np.maximum(leaf, np.maximum(-along, along - reach))
            c.fill(
                distance,
                mix(
                    ramp(t, (0.3, codes[0]), (1.0, codes[1])),
                    colour("8a5210"),
                    0.35 * smoothstep(0.010, 0.0, np.abs(across)),
                ),
            )
    c.fill(c.circle(x0, y0, 0.205), "3a2110")
    for k in range(420, 0, -1):
        r, a = 0.198 * np.sqrt(k / 420), k * golden
        x, y, size = x0 + r * np.cos(a), y0 + r * np.sin(a), 0.0045 + 0.0042 * np.sqrt(k / 420)
        paint = ramp(np.array(r / 0.2), (0.0, "7f9a3a"), (0.35, "b98a2e"), (0.7, "8a5320"), (1.0, "c98a30"))
        near = (
            slice(max(int((1 - y - 0.02) * 400), 0), int((1 - y + 0.02) * 400)),
            slice(int((x - 0.02) * 400), int((x + 0.02) * 400)),
        )
        cover = np.clip((size - np.hypot(c.x[near] - x, c.y[near] - y)) * 400 + 0.5, 0, 1)
        c.image[near] = mix(c.image[near], paint, cover)
    return c
