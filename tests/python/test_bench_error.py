"""`python -m raybound bench error`: bounded origins do nothing wrong on hard cases, and what is wrong would be seen."""

from __future__ import annotations

import json
import math
import shutil
from collections import Counter
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.support_oracle import at as value_at
from tests.support.support_oracle import build, exact, is_member, real_roots

import raybound as rb
from raybound.bench import error, error_probe, error_seams, error_speed, error_visits
from raybound.bench.error_bodies import ZOO, Body, body_of, kind_of
from raybound.bench.error_exact import TwoDoubles
from raybound.bench.error_oracle import nearest_root
from raybound.bench.error_probe import Policy, probe
from raybound.bench.error_rays import rays_at
from raybound.bench.error_tables import share
from raybound.bench.error_tally import COUNTS, SAMPLES, Tally
from raybound.cli import main

ROOT = Path(__file__).resolve().parents[2]
BOUNDED = [policy for policy in error.POLICIES if policy.offsets == "bounded"]
KINDS = {kind_of(make(np.random.default_rng(1), np.zeros(3), 1.0)) for make in ZOO.values()}
NEVER = ("missed", "nans", "self_hits", "leaks", "behind", "broken")


def assert_clean(tallies: error.Tallies, totals: Counter[str]) -> None:
    """No failure of bounded origins; but for `inner_hits`, see `test_rays_into_a_far_sphere_leave_it_next`."""
    for (kind, policy), tally in tallies.items():
        wrong = {name: tally.counts[name] for name in NEVER if tally.counts[name]}
        assert not wrong, (kind, policy, wrong)
        totals += tally.counts


def test_bounded_origins_do_nothing_wrong_on_any_hard_case_and_shape() -> None:
    totals: Counter[str] = Counter()
    kinds: dict[str, int] = {}
    moved = []
    for i, (name, case) in enumerate(rb.scenes.HARD_CASES.items()):
        found = error.measure_scene(name, case.default, 4, BOUNDED if i % 3 == 0 else BOUNDED[:1])
        assert_clean(found, totals)
        for (kind, policy), tally in found.items():
            kinds[kind] = kinds.get(kind, 0) + tally.counts["spawned"]
            if policy.precision == "float32":
                moved += tally.samples["offset_ulp"]
    assert set(kinds) == KINDS
    assert min(kinds.values()) > 400
    assert totals["spawned"] > 20_000
    assert totals["enclosed"] > 2000
    assert totals["lost"] <= 0.01 * totals["sent_back"]  # seen: 0
    assert totals["sent_back"] > 2000
    assert totals["inner_hits"] <= 1e-3 * totals["entered"]  # seen: 1e-5
    assert np.median(np.concatenate(moved)) <= 8  # seen: 0.5


@pytest.mark.soak
@pytest.mark.parametrize("name", rb.scenes.HARD_CASES)
def test_bounded_origins_do_nothing_wrong_at_any_scale(name: str) -> None:
    totals: Counter[str] = Counter()
    for scale in rb.scenes.HARD_CASES[name].scales:
        assert_clean(error.measure_scene(name, scale, 128, BOUNDED), totals)
    assert totals["spawned"] > 50_000


def tally_of(name: str, scale: float, offsets: str, precision: str) -> Counter[str]:
    total = Tally()
    for tally in error.measure_scene(name, scale, 8, [Policy(offsets, precision)]).values():
        total.add(tally)
    return total.counts


def test_epsilons_do_fail() -> None:
    """A fixed one is too small far away and too large in small scenes; a scaled one is too small near the origin."""
    far = tally_of("far-mirror", 1e5, "epsilon", "float32")
    assert far["self_hits"] > 0.02 * far["spawned"] > 0
    small = tally_of("scene-scale", 1e-6, "epsilon", "float64")
    assert small["leaks"] > 0.2 * small["enclosed"] > 0
    assert small["lost"] > 0.2 * small["sent_back"] > 0
    for precision in ("float32", "float64"):
        near = tally_of("scene-scale", 1.0, "scaled-epsilon", precision)
        assert near["self_hits"] > 0.002 * near["spawned"] > 0


class Broken(Policy):
    """Answers that are spoilt on the way."""

    def meet(self, body: Body, origins: Any, directions: Any, *, inward: bool = False) -> Any:
        answers = super().meet(body, origins, directions, inward=inward).copy()
        if self.offsets == "bounded":
            self.spoil(body, answers, inward)
        return answers

    def spoil(self, body: Body, answers: Any, inward: bool) -> None:
        raise NotImplementedError


class AtThePoint(Broken):
    """Origins a little on the wrong side."""

    def spoil(self, body: Body, answers: Any, inward: bool) -> None:
        answers["next_origin"] -= 1e-4 * body.size * answers["normal"] * (-1 if inward else 1)


class FarAway(Broken):
    """Origins moved by more than the size."""

    def spoil(self, body: Body, answers: Any, inward: bool) -> None:
        answers["next_origin"] += 4 * body.size * answers["normal"] * (-1 if inward else 1)


class NoBounds(Broken):
    def spoil(self, body: Body, answers: Any, inward: bool) -> None:
        answers["t_error"] /= 1e3
        answers["point_error"] /= 1e3


class NotANumber(Broken):
    def spoil(self, body: Body, answers: Any, inward: bool) -> None:
        answers["uv"][::2, 0] = np.nan


class Blind(Broken):
    """Half of the hits are not seen."""

    def spoil(self, body: Body, answers: Any, inward: bool) -> None:
        answers["hit"][::2] = False


WAYS_TO_BREAK = [
    (AtThePoint, ["self_hits"]),
    (FarAway, ["lost"]),
    (NoBounds, ["broken"]),
    (NotANumber, ["nans"]),
    (Blind, ["missed", "leaks"]),
]


@pytest.mark.parametrize("kind", ZOO)
def test_every_failure_would_be_seen_on_every_shape(kind: str) -> None:
    rng = np.random.default_rng(5)
    body = body_of(ZOO[kind](rng, np.array([0.5, 1.0, 2.0]), 1.0))
    rays = rays_at(rng, body, np.array([4.0, 5.0, 6.0]), 64)
    for policy, names in WAYS_TO_BREAK:
        tally = probe(body, rays, policy("bounded", "float32"), 1.0, np.random.default_rng(6))
        for name in names:
            assert tally.counts[name] > 0 or (body.is_sheet and name in ("missed", "leaks")), (policy, name)
    clean = probe(body, rays, Policy("bounded", "float32"), 1.0, np.random.default_rng(6))
    assert not any(clean.counts[name] for name in (*NEVER, "inner_hits"))


def test_hits_behind_the_origin_would_be_seen() -> None:
    body = body_of(rb.Sphere((1, 2, 3), 1))
    o, d = np.array([[-3.0, 2.0, 3.0]]), np.array([[1.0, 0.0, 0.0]])
    hits = rb.intersect(body.shape, o, d)
    for start, behind in ((-3.0, 0), (0.5, 1)):
        tally, moved = Tally(), hits.copy()
        moved["t"] = -start
        error_probe._look_behind(tally, body, np.array([[start, 2.0, 3.0]]), d, moved)
        assert (tally.counts["checked"], tally.counts["behind"]) == (1, behind)


def fractions(x: TwoDoubles) -> list[Fraction]:
    return [Fraction(float(h)) + Fraction(float(low)) for h, low in zip(np.ravel(x.high), np.ravel(x.low))]


def test_two_doubles_have_a_hundred_bits() -> None:
    rng = np.random.default_rng(3)

    def numbers(n: int = 4000) -> TwoDoubles:
        high = rng.normal(size=n) * 2 ** rng.uniform(-150, 150, n)
        return TwoDoubles(high, high * 2.0**-54 * rng.normal(size=n))

    a, b = numbers(), numbers()
    cancels = rng.random(4000) < 0.25
    b = TwoDoubles(np.where(cancels, -a.high * (1 + 2.0**-30), b.high), np.where(cancels, a.low, b.low))
    x, y = fractions(a), fractions(b)
    worst, products = {}, [Fraction(float(h)) * p for h, p in zip(b.high, x)]
    for name, found, true, size in (
        ("+", a + b, [p + q for p, q in zip(x, y)], [abs(p) + abs(q) for p, q in zip(x, y)]),
        ("-", a - b, [p - q for p, q in zip(x, y)], [abs(p) + abs(q) for p, q in zip(x, y)]),
        ("*", a * b, [p * q for p, q in zip(x, y)], [p * q for p, q in zip(x, y)]),
        ("/", a / b, [p / q for p, q in zip(x, y)], [p / q for p, q in zip(x, y)]),
        ("sqrt", (a * a).sqrt(), [abs(p) for p in x], [abs(p) for p in x]),
        ("array", b.high * a, products, products),
        ("number", a - 1.5, [p - Fraction(3, 2) for p in x], [abs(p) + 1 for p in x]),
    ):
        worst[name] = max(abs(float((f - t) / s)) for f, t, s in zip(fractions(found), true, size))
    assert max(worst[name] for name in "+-*") < 2.0**-100, worst  # seen: 2^-104.7
    assert max(worst.values()) < 2.0**-96, worst  # seen: 2^-104.9


@pytest.mark.parametrize("kind", [kind for kind in ZOO if kind != "mesh"])
def test_the_oracle_is_that_of_arbitrary_precision(kind: str) -> None:
    rng = np.random.default_rng(8)
    body = body_of(ZOO[kind](rng, np.array([100.0, -20.0, 3.0]), 2.0))
    model = build(body.shape)
    rays = rays_at(rng, body, np.array([1e4, 5.0, 6.0]), 40)
    compared = 0
    for precision in ("float32", "float64"):
        hits = rb.intersect(body.shape, rays.origins, rays.directions, precision=precision)
        hit = np.flatnonzero(hits["hit"])
        form, low, _ = body.oracle.along(hits["face_id"][hit], rays.origins[hit], rays.directions[hit])
        roots = nearest_root(form, 0 * low, hits["t"][hit])
        for k, i in enumerate(hit):
            leaf = model.leaf_of_face(int(hits["face_id"][i]))
            found = leaf.along(exact(rays.origins[i]), exact(rays.directions[i]))
            true = real_roots(found[int(hits["face_id"][i]) - leaf.first_face])
            off = min(abs(float(t - float(roots.high[k]) - float(roots.low[k]))) for t in true)
            assert off <= 2.0**-85 * max(1.0, hits["t"][i]), (kind, i, off)  # a root of multiplicity two loses half
            compared += 1
    assert compared >= 10
    if body.is_sheet:
        return
    points = rng.uniform(*body.bounds, (60, 3))
    zero = exact([0, 0, 0])
    for point, inside in zip(points, body.oracle.contains(points)):
        forms = [leaf.along(exact(point), zero) for leaf in model.leaves]
        assert inside == is_member(model.member, [all(value_at(f, 0) <= 0 for f in leaf) for leaf in forms])


def test_the_inside_of_a_mesh_is_told_by_its_winding_number() -> None:
    body = body_of(ZOO["mesh"](np.random.default_rng(2), np.array([5.0, 0.0, 0.0]), 2.0))
    radius = np.linalg.norm(np.asarray(body.shape.vertices) - (5, 0, 0), axis=1)
    ways = np.random.default_rng(3).normal(size=(50, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    assert body.oracle.contains(body.oracle.leaves[0].world(np.array([5.0, 0, 0]) + 0.7 * radius.min() * ways)).all()
    assert not body.oracle.contains(np.array([5.0, 0, 0]) + 1.01 * radius.max() * ways).any()


def test_shared_edges_are_found_and_a_gap_between_them_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(1)
    for name, least in (("touching-boxes", 300), ("touching-glass", 200), ("csg-coincident", 8)):
        scene = rb.scenes.hard_case(name)
        assert len(error_seams.shared_edges(scene)) >= least
        for precision in ("float32", "float64"):
            tried, through = error_seams.leaks(scene, precision, 20, rng)
            assert tried >= 100
            assert through == 0
    assert error_seams.leaks(rb.scenes.hard_case("far-eye"), "float32", 20, rng) == (0, 0)
    monkeypatch.setattr(error_seams._core, "intersect_shape", lambda s, o, *_: np.zeros(len(o), [("hit", bool)]))
    tried, through = error_seams.leaks(scene, "float32", 20, rng)
    assert through == tried > 100


def test_bounces_are_the_same_whether_rays_skip_what_they_left() -> None:
    scene = rb.scenes.hard_case("far-mirror")
    assert scene.camera is not None
    o, d = (np.float64(x).reshape(-1, 3) for x in scene.camera.replace(width=48, height=36).rays())
    snapshot = scene._document.snapshot()
    for precision in ("float32", "float64"):
        both = [
            rb._core.trace_bounces(snapshot, o, d, precision=precision, offsets="bounded", skips=skips)
            for skips in (False, True)
        ]
        assert all(found.pop("seconds") > 0 for found in both)
        assert both[0] == both[1]
        assert both[0]["rays"] > both[0]["hits"] > len(o) > both[0]["blocked"] > 0
    epsilon = rb._core.trace_bounces(snapshot, o, d, precision="float32", offsets="epsilon", skips=False)
    assert epsilon["blocked"] > both[0]["blocked"]  # by the surfaces that they leave
    with pytest.raises(ValueError, match=r"trace_bounces: offsets must be 'bounded', .*, got 'none'"):
        rb._core.trace_bounces(snapshot, o, d, precision="float32", offsets="none", skips=False)
    with pytest.raises(ValueError, match=r"trace_bounces: directions must have a length .* at index 0"):
        rb._core.trace_bounces(snapshot, o, 0 * d, precision="float32", offsets="bounded", skips=False)


def test_what_is_counted_is_what_the_search_visits() -> None:
    """Counting changes nothing else, and nothing is counted unless it is asked for."""
    scene = rb.scenes.hard_case("far-mesh")
    snapshot, (o, d) = scene._document.snapshot(), error_speed.eye_rays(scene)
    for precision in ("float32", "float64"):
        plain, counted = (
            rb._core.trace_bounces(snapshot, o, d, precision=precision, offsets="bounded", skips=True, count=count)
            for count in (False, True)
        )
        for name in ("rays", "hits", "blocked", "spawned", "radiance"):
            assert plain[name] == counted[name], name  # type: ignore[literal-required]
        assert plain["nodes"] == plain["primitives"] == 0
        assert plain["spawned"] == plain["rays"] - len(o)
        assert counted["nodes"] > counted["spawned"]  # a mesh has nodes of its own
        assert counted["primitives"] > 0


def bounces_off(shapes: list[Any], skips: bool) -> dict[str, Any]:
    """One ray straight down at the origin."""
    scene = rb.Scene()
    for shape in shapes:
        scene.add(shape, rb.Material())
    scene.add_light(rb.DirectionalLight((0, 0, -1)))
    o, d = np.array([[0.1, 0.0, 5.0]]), np.array([[0.0, 0.0, -1.0]])
    snapshot = scene._document.snapshot()
    found: Any = rb._core.trace_bounces(snapshot, o, d, precision="float32", offsets="bounded", skips=skips, count=True)
    assert (found["rays"], found["spawned"], found["hits"]) == (3, 2, 1)
    return {name: found[name] for name in ("nodes", "primitives")}


def test_visits_of_one_ray() -> None:
    """A shadow ray and a mirrored one leave a floor upward: one node each, the floor, and whatever is above it."""
    floor, aside = rb.Box((-9, -9, -1), (9, 9, 0)), rb.Box((3, 3, 1), (4, 4, 2))
    grazed = rb.Cone((0.95, 0.95, 9), (0.95, 0.95, 10), radius=1)  # whose box is met, at a corner, and not itself
    for skips in (False, True):
        asked = 0 if skips else 2  # a ray that leaves the floor is still in its box
        assert bounces_off([floor], skips) == {"nodes": 2, "primitives": asked}
        assert bounces_off([floor, aside], skips) == {"nodes": 2, "primitives": asked}
        assert bounces_off([floor, aside, grazed], skips) == {"nodes": 2, "primitives": asked + 2}


def test_visits_are_measured() -> None:
    visits = error_visits.measure(["huge", "far-mirror"])
    assert list(visits) == ["hard cases", "museum", "sphereflake"]
    for found in visits.values():
        assert list(found) == [error_speed.key(way) for way in error_speed.WAYS]
        for counts in found.values():
            assert counts["nodes"] >= counts["spawned"] > 0
            assert counts["primitives"] > 0
        skipping, asking = (found[error_speed.key(("bounded", "float32", skips))] for skips in (True, False))
        assert skipping["nodes"] == asking["nodes"]
        assert skipping["primitives"] < asking["primitives"]


CLOSED = ("sphere", "cylinder", "disk", "mesh")


@pytest.mark.parametrize("kind", ZOO)
def test_closed_forms_are_those_of_the_seed(kind: str) -> None:
    """In own coordinates, by hand: their points and bounds; the others have none."""
    rng = np.random.default_rng(12)
    body = body_of(ZOO[kind](rng, np.array([0.5, 1.0, 2.0]), 1.0))
    rays = rays_at(rng, body, np.array([4.0, 5.0, 6.0]), 200)
    for precision in ("float32", "float64"):
        hits = rb.intersect(body.shape, rays.origins, rays.directions, precision=precision)
        forms = rb._core.closed_forms(body.shape._native, rays.origins, rays.directions, precision == "float64")
        assert np.array_equal(forms["known"], hits["hit"] & (kind in CLOSED))
        known = forms["known"]
        if kind not in CLOSED:
            continue
        assert known.sum() > 50
        off = np.abs(forms["point"] - hits["point"])[known]
        room = 100 * np.finfo(precision).eps  # t is rounded, and grazing rays make the most of it
        assert (off <= room * 20).all()
        assert np.median(off) < room / 20
        # On top of the closed form come gamma_3 of the terms of the map to the world.
        bound, low = forms["point_error"][known], 3 * np.finfo(precision).eps / 2
        assert (bound >= low * np.abs(forms["point"][known]) * 0.99).all()
        assert (bound <= 40 * np.finfo(precision).eps * 4).all()


def test_closed_forms_at_the_origin() -> None:
    """A sphere about the origin is mapped by the identity: gamma_5 of each coordinate, and no more."""
    ways = np.random.default_rng(4).normal(size=(200, 3))
    forms = rb._core.closed_forms(rb.Sphere((0, 0, 0), 2)._native, -5 * ways, ways, False)
    assert forms["known"].all()
    point = np.float32(forms["point"])
    assert np.array_equal(np.float32(forms["point_error"]), np.abs(point) * rb.gamma(5))
    gap = [abs(sum(Fraction(float(x)) ** 2 for x in p) - 4) for p in point]
    assert all(g <= 4 * 2 * Fraction(float(rb.gamma(5))) * Fraction(101, 100) for g in gap)
    assert sum(g > 0 for g in gap) > 100
    with pytest.raises(
        ValueError, match=r"closed_forms: directions must have a length of at least 2\*\*-64 .* at index 1"
    ):
        rb._core.closed_forms(rb.Sphere()._native, ways[:2], ways[:2] * [[1], [0]], False)


def test_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    readme, out, plot = tmp_path / "README.md", tmp_path / "error.json", tmp_path / "error.png"
    shutil.copy(ROOT / "README.md", readme)
    arguments = ["--scenes=huge", "--rays=2", "--repeat=1", "--json", str(out), "--plot", str(plot)]
    assert main(["bench", "error", *arguments, "--markdown", "--readme", str(readme)]) == 0
    printed = capsys.readouterr().out
    result = json.loads(out.read_text())
    assert (result["rays"], result["repeat"], result["left_out"]) == (2, 1, {})
    case = result["cases"]["huge"]
    assert case["scales"] == list(rb.scenes.HARD_CASES["huge"].scales)
    assert set(result["kinds"]) == set(case["kinds"]) == KINDS
    for where in (result["totals"], case["totals"], *result["kinds"].values()):
        for precision in ("float32", "float64"):
            assert list(where[precision]) == ["bounded", "epsilon", "scaled-epsilon", "whole-epsilon"]
            for summary in where[precision].values():
                assert set(summary) == {*COUNTS, *SAMPLES, "failures"}
            assert not any(where[precision]["bounded"][name] for name in NEVER)
    for way in result["speed"]["ways"]:
        assert way["ns_per_ray"] > 0
        assert way[f"over {way['offsets']} float32"] > 0 if way["offsets"] != "bounded" else True
    for counts in result["visits"]["hard cases"].values():
        assert counts["nodes"] >= counts["spawned"] > 0
    for kind in CLOSED:
        assert result["kinds"][kind]["float32"]["bounded"]["closed"] > 0
    assert plot.stat().st_size > 10_000
    block = readme.read_text().partition("<!-- bench error -->\n")[2].partition("<!-- /bench error -->")[0]
    assert block.count("| bounded, float32 |") == 3
    assert block.count("| cylinder, float32 |") == 1
    assert "| huge |" in block
    assert block.splitlines()[0] in printed
    assert math.isfinite(case["totals"]["float32"]["bounded"]["offset_ulp"]["largest"])


def test_shares() -> None:
    assert [share(0, 0), share(0, 9), share(1, 8), share(1, 3000)] == ["-", "0", "12 %", "0.033 %"]


BAD = [
    (["--scenes=house"], "scenes must be among far-mirror, "),
    (["--scenes=,"], "scenes must name at least one hard case"),
    (["--rays=0"], "--rays must be >= 1, got 0"),
    (["--width=8"], "--width cannot be chosen for bench error"),
    (["--threads=2"], "--threads cannot be chosen for bench error"),
    (["--triangles=8"], "--triangles cannot be chosen for bench error: it has its own meshes"),
    (["--plot=a.txt"], "--plot must end in one of .png, .svg, .pdf, got 'a.txt'"),
    (["--plot=none/a.png"], "--plot: no such folder: 'none'"),
    (["--json=none/a.json"], "--json: no such folder: 'none'"),
]


@pytest.mark.parametrize(("arguments", "words"), BAD, ids=[" ".join(arguments) for arguments, _ in BAD])
def test_bad_arguments(
    arguments: list[str], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["bench", "error", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err


def test_other_benches_have_no_plot(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "base", "--plot=a.png"]) == 2
    assert "--plot is of bench error and exact, got bench base" in capsys.readouterr().err
