"""One body under one policy and precision: what its hits, and the rays that are spawned from them, do wrong."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .error_bodies import Body, Rng
from .error_exact import Doubles
from .error_oracle import Flags, nearest_root
from .error_rays import Rays, hemisphere, surely_inside
from .error_tally import Tally

Hits = npt.NDArray[np.void]
FAN = 8  # rays spawned from a hit
DEPTHS = (0.5, 0.125, 0.03125)  # of a body's size: how far from the surface an interior point is looked for
NUMBERS = ("t", "t_error", "point", "point_error", "normal", "uv", "next_origin")


@dataclass(frozen=True)
class Policy:
    """How origins leave surfaces, and in which precision everything is computed."""

    offsets: str
    precision: str

    def meet(self, body: Body, origins: Doubles, directions: Doubles, *, inward: bool = False) -> Hits:
        """The answers to rays; `next_origin` against the normal if `inward`."""
        return _core.intersect_shape(body.shape._native, origins, directions, self.precision, self.offsets, inward)


@dataclass(frozen=True)
class Leaving:
    """Hits of a body with the origins that a policy spawns on either side, and unit directions outward."""

    hits: Hits
    outer: Doubles
    inner: Doubles
    ways: Doubles


def probe(body: Body, rays: Rays, policy: Policy, scene_size: float, rng: Rng) -> Tally:
    """All that is measured of a body, but the time."""
    tally = Tally()
    with np.errstate(all="ignore"):  # an epsilon may make infinities and NaNs, which are counted
        answers = policy.meet(body, rays.origins, rays.directions)
        inward = policy.meet(body, rays.origins, rays.directions, inward=True)
        hit = answers["hit"]
        tally.count(rays=len(hit), sure=rays.sure & ~rays.seam, missed=rays.sure & ~rays.seam & ~hit, hits=hit)
        tally.count(enclosed=rays.sure & rays.seam, leaks=rays.sure & rays.seam & ~hit)
        hits, inner = answers[hit], inward["next_origin"][hit]
        tally.count(nans=_has_nan(hits) | np.isnan(inner).any(axis=1))
        if len(hits):
            _offsets(tally, body, policy, hits, scene_size)
            if policy.offsets == "bounded":
                _bounds(tally, body, policy, rays.origins[hit], rays.directions[hit], hits)
            _send_back(tally, body, policy, rays.origins[hit], rays.directions[hit], hits, inner)
            leaving = _leaving(rng, hits, inner)
            _leave(tally, body, policy, leaving)
            if not body.is_sheet:
                _enter(tally, body, policy, leaving)
    return tally


def _has_nan(hits: Hits) -> Flags:
    flags: Flags = np.zeros(len(hits), bool)
    for numbers in (hits[name] for name in NUMBERS):
        flags |= np.isnan(numbers).any(axis=tuple(range(1, numbers.ndim)))
    return flags


def _offsets(tally: Tally, body: Body, policy: Policy, hits: Hits, scene_size: float) -> None:
    """How far origins are from the points, in ulps of the largest coordinate and relative to the scene."""
    moved = np.abs(hits["next_origin"] - hits["point"]).max(axis=1)
    kept = np.isfinite(moved)
    tally.sample("offset_ulp", (moved / _ulp(body, policy, hits))[kept])
    tally.sample("offset_relative", (moved / scene_size)[kept])


def _ulp(body: Body, policy: Policy, hits: Hits) -> Doubles:
    """The distance between numbers at the largest coordinate."""
    reach = np.maximum(np.abs(hits["point"]).max(axis=1), body.reach)
    return np.asarray(np.spacing(reach.astype(policy.precision)), np.float64)


def _bounds(tally: Tally, body: Body, policy: Policy, origins: Doubles, directions: Doubles, hits: Hits) -> None:
    """Bounds over true errors: of t, and of the point along its normal, which is how far an origin must move; and the
    same of the point that has a closed form.
    """
    t_error = _distance(body, hits["face_id"], origins, directions, hits["t"])
    broken = _point_bounds(tally, body, policy, hits, "point")
    tally.count(bounds=2 * len(hits), broken=broken)
    tally.count(broken=~(t_error <= hits["t_error"]))
    _sample_ratio(tally, "t_ratio", t_error, hits["t_error"])
    forms = _core.closed_forms(body.shape._native, origins, directions, policy.precision == "float64")
    known, closed = forms["known"], hits.copy()
    for name in ("point", "point_error"):
        closed[name] = forms[name]
    tally.count(closed=known, own_broken=broken & known)
    tally.count(closed_broken=_point_bounds(tally, body, policy, closed[known], "closed"))


def _point_bounds(tally: Tally, body: Body, policy: Policy, hits: Hits, name: str) -> Flags:
    """Samples the bounds of points along their normals, in ulps and over the true error; which ones are below it."""
    error = _distance(body, hits["face_id"], hits["point"], hits["normal"], np.zeros(len(hits)))
    bound = np.sum(np.abs(hits["normal"]) * hits["point_error"], axis=1)
    broken: Flags = ~(error <= bound)
    broken[broken] = ~_holds_surface(body, hits[broken])
    _sample_ratio(tally, f"{name}_ratio", error, bound)
    kept = np.isfinite(bound)
    tally.sample(f"{name}_ulp", (bound / _ulp(body, policy, hits))[kept])
    return broken


def _sample_ratio(tally: Tally, name: str, error: Doubles, bound: Doubles) -> None:
    real = (error > 0) & (error <= bound)
    tally.sample(name, bound[real] / error[real])


def _distance(body: Body, faces: Any, p: Doubles, d: Doubles, t: Doubles) -> Doubles:
    """How far t is from the exact crossing of a face's surface along p + t d; NaN where that cannot be told."""
    form, low, high = body.oracle.along(faces, p, d)
    ends = [(nearest_root(form, level, t) - t).value() for level in (low, high)]
    between = (low < high) & (np.minimum(*ends) <= 0) & (np.maximum(*ends) >= 0)
    return np.where(between, 0.0, np.minimum(*np.abs(ends)))


def _holds_surface(body: Body, hits: Hits) -> Flags:
    """Whether the boxes point +- point_error certainly hold a point of the surface: its polynomial changes sign."""
    signs = np.array([(0, 0, 0), *np.ndindex(2, 2, 2)])
    signs[1:] = 2 * signs[1:] - 1
    below, above = np.zeros((2, len(hits)), bool)
    for sign in signs:
        corner = hits["point"] + sign * hits["point_error"]
        form, low, high = body.oracle.along(hits["face_id"], corner, hits["normal"])
        below, above = below | (form[0].value() <= high), above | (form[0].value() >= low)
    return below & above


def _send_back(
    tally: Tally, body: Body, policy: Policy, origins: Doubles, directions: Doubles, hits: Hits, inner: Doubles
) -> None:
    """Rays back from the far side, to see that origins are not moved too far."""
    cosine = np.sum(directions * hits["normal"], axis=1)
    near = body.reach <= 100 * body.size
    steep = (np.abs(cosine) > np.sin(np.radians(1))) & (hits["t"] <= 100 * body.size) & near
    far = np.where(cosine[:, None] < 0, inner, hits["next_origin"])[steep]
    if not len(far):
        return
    back = policy.meet(body, far, -directions[steep])
    tally.count(sent_back=len(back), lost=~back["hit"])
    _look_behind(tally, body, far, -directions[steep], back)


def _leaving(rng: Rng, hits: Hits, inner: Doubles) -> Leaving:
    rows = np.repeat(np.arange(len(hits)), FAN)
    normals = hits["normal"][rows]
    ways = hemisphere(rng, normals)
    # A normal rounded to float32 is off by at most sqrt(3) 2^-25 rad: these are above the true surface, surely.
    above = np.sum(ways * normals, axis=1) > 3**0.5 * 2.0**-25
    rows, ways = rows[above], ways[above]
    return Leaving(hits[rows], hits["next_origin"][rows], inner[rows], ways)


def _leave(tally: Tally, body: Body, policy: Policy, leaving: Leaving) -> None:
    """Rays outward (from a sheet, to both sides) must not meet the surface that they leave."""
    sides = [(leaving.outer, leaving.ways)] + ([(leaving.inner, -leaving.ways)] if body.is_sheet else [])
    for origins, ways in sides:
        again = policy.meet(body, origins, ways)
        found = again["hit"]
        tally.count(spawned=len(found), self_hits=found if body.is_convex else found & _is_false(body, leaving, again))
        _look_behind(tally, body, origins[found], ways[found], again[found])


def _is_false(body: Body, leaving: Leaving, again: Hits) -> Flags:
    """Whether rays that leave a hollow or compound solid met what they left, which they may legally meet elsewhere.

    They did if they come *out* of the solid first although their origin is not outside of the face that they left, or
    if that face has no such crossing. (A point on an edge may lie in the neighbouring face, and its rays with it.)
    """
    outward = np.sum(leaving.ways * again["normal"], axis=1) > 1e-3
    form, low, high = body.oracle.along(leaving.hits["face_id"], leaving.outer, leaving.ways)
    inside = form[0].value() <= high
    gap = np.minimum(*[np.abs((nearest_root(form, level, again["t"]) - again["t"]).value()) for level in (low, high)])
    same = again["face_id"] == leaving.hits["face_id"]
    phantom = same & ~(gap <= again["t_error"] + 1e-4 * again["t"])
    false: Flags = (outward & inside) | phantom
    return false


def _enter(tally: Tally, body: Body, policy: Policy, leaving: Leaving) -> None:
    """Rays into a solid that certainly pass its interior must come out, and, if it is convex, not before that."""
    is_mesh = body.kind == "mesh"  # whose interior takes long to ask about
    once = slice(None, None, 16 if is_mesh else 4)
    hits, origins, ways = leaving.hits[once], leaving.inner[once], -leaving.ways[once]
    depth = np.zeros(len(hits))
    for share in DEPTHS[1:2] if is_mesh else DEPTHS:
        deeper = surely_inside(body, hits["point"] + ways * (share * body.size))
        depth = np.where((depth == 0) & deeper, share * body.size, depth)
    sure = depth > 0
    answers = policy.meet(body, origins, ways)
    tally.count(enclosed=sure, leaks=sure & ~answers["hit"])
    if body.is_convex:
        tally.count(entered=sure, inner_hits=sure & answers["hit"] & (answers["t"] < depth / 2))
    found = sure & answers["hit"]
    _look_behind(tally, body, origins[found][:64], ways[found][:64], answers[found][:64])


def _look_behind(tally: Tally, body: Body, origins: Doubles, ways: Doubles, hits: Hits) -> None:
    """Hits whose exact crossing is not after the origin."""
    known = hits["hit"] & np.isfinite(origins).all(axis=1)
    if not known.any():
        return
    hits, origins, ways = hits[known], origins[known], ways[known]
    form, low, high = body.oracle.along(hits["face_id"], origins, ways)
    roots = [nearest_root(form, level, hits["t"]).value() for level in (low, high)]
    tally.count(checked=len(hits), behind=np.maximum(*roots) <= 0)
