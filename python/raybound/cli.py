"""The command line: `python -m raybound render|demo|bench`. The only module that prints."""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

from . import images, scenes
from .camera import Camera
from .demo import make_demo
from .renderer import METHODS, Renderer
from .scene import Scene
from .scene_file import camera_from_dict, load_scene
from .tolerance import Tolerance

PLOTS = (".png", ".svg", ".pdf")
PLOTTED = ("error", "exact")
PICTURE = "1200 x 900 pixels, one thread"  # of bench embree
SMALL = "small pictures of hard cases, one thread"
FIXED: dict[str, dict[str, str]] = {  # by bench, what cannot be chosen, and what it is
    "base": {},
    "embree": dict.fromkeys(("width", "height", "threads"), PICTURE),
    "exact": dict.fromkeys(("triangles", "rays"), "it draws scenes alone"),
    "error": {**dict.fromkeys(("width", "height", "threads"), SMALL), "triangles": "it has its own meshes"},
    "numbers": dict.fromkeys(("width", "height", "threads", "names", "triangles", "rays"), "it draws nothing"),
}
READY = {"museum": False, "three_spheres": False, "sphereflake": True}  # whether a number follows, as in sphereflake:4


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {' '.join(message.split())}\n")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="raybound", description="Ray tracing by certified interpolation.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="{render,demo,bench}")
    _add_render(commands.add_parser("render", help="render a scene to an image file"))
    demo = commands.add_parser("demo", help="render the museum walk-through and more to a folder")
    demo.add_argument("--frames", type=int, default=60, help="frames of the walk-through (default 60)")
    demo.add_argument("--width", type=int, default=600, help="of the walk-through's frames, pixels (default 600)")
    demo.add_argument("--height", type=int, default=450, help="of the walk-through's frames, pixels (default 450)")
    demo.add_argument("--out", default="out", help="folder for pictures and statistics (default ./out)")
    demo.set_defaults(run=_demo)
    _add_bench(commands.add_parser("bench", help="measure speed, and error"))
    return parser


def _add_render(render: argparse.ArgumentParser) -> None:
    render.add_argument(
        "scene", metavar="SCENE", help="a .json or .nff file, museum, three_spheres, or sphereflake:LEVELS"
    )
    render.add_argument("-o", "--out", metavar="OUT", required=True, help="the image file, such as a.png or a.exr")
    render.add_argument(
        "--camera", help="a JSON object with Camera's arguments, or --camera=ex,ey,ez,tx,ty,tz (eye and target)"
    )
    render.add_argument(
        "--tolerance", type=_tolerance, default=Tolerance(0), help="relative error (default 0), or none"
    )
    render.add_argument("--width", type=int, help="pixels (default: the camera's)")
    render.add_argument("--height", type=int, help="pixels (default: the camera's)")
    render.add_argument("--threads", type=int, default=0, help="0: as many as may be used (default)")
    render.add_argument("--max-depth", type=int, default=5, help="depth of the ray tree (default 5)")
    render.add_argument("--method", choices=METHODS, default="auto", help="default auto")
    render.add_argument("--progress", action="store_true", help="show a progress bar")
    render.set_defaults(run=_render)


def _add_bench(bench: argparse.ArgumentParser) -> None:
    what = (
        "base: the base tracer (default); exact: frames from kept lists beside it; embree: beside Embree, one "
        "thread; error: speed against error on hard cases; numbers: intervals and Taylor models beside double"
    )
    bench.add_argument("what", nargs="?", choices=list(FIXED), default="base", help=what)
    bench.add_argument("--width", type=int, help="of base and exact, pixels (default 1200)")
    bench.add_argument("--height", type=int, help="of base and exact, pixels (default 900)")
    bench.add_argument("--threads", help="of base and exact, numbers of threads (default 1,2)")
    bench.add_argument(
        "--repeat",
        type=int,
        help="runs to take the median of, or rounds to take the best of (default 5; exact: 3; error, numbers: 9)",
    )
    bench.add_argument("--scenes", help="their names, with commas; of error, hard cases (default all)")
    bench.add_argument("--triangles", type=int, help="of the mesh (default 1000000)")
    bench.add_argument(
        "--rays", type=int, help="scattered at the mesh (default 1000000); of error, at a shape (default 32)"
    )
    bench.add_argument("--json", metavar="FILE", help="write the measurements to a file, too")
    bench.add_argument("--markdown", action="store_true", help="print the tables in Markdown")
    bench.add_argument("--plot", metavar="FILE", help="of error and exact, draw the result (.png, .svg, .pdf)")
    readme = "put the tables into the block <!-- bench WHAT --> of a Markdown file (default README.md)"
    bench.add_argument("--readme", nargs="?", const="README.md", metavar="FILE", help=readme)
    bench.set_defaults(run=_bench)


def _tolerance(text: str) -> Tolerance:
    if text.lower() == "none":
        return Tolerance(None)
    try:
        return Tolerance(float(text))
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number >= 0 or none, got {text!r}") from None


def _scene(text: str) -> Scene:
    """A scene from a .json or .nff file or by the name of a ready one."""
    name, colon, argument = text.partition(":")
    if name not in READY or Path(text).exists():
        if not Path(text).exists() and not Path(text).suffix:
            raise ValueError(f"SCENE must be a .json or .nff file or one of {', '.join(READY)}, got {text!r}")
        return load_scene(text)
    if bool(colon) != READY[name] or (colon and not argument.isdecimal()):
        raise ValueError(f"SCENE must be {name + ':LEVELS' if READY[name] else name}, got {text!r}")
    scene: Scene = getattr(scenes, name)(*([int(argument)] if colon else []))
    return scene


def _camera(text: str, default: Camera | None) -> Camera:
    """A camera from the command line; what it leaves open is as in the default camera."""
    if text.lstrip().startswith("{"):
        try:
            given: dict[str, Any] = json.loads(text)
        except json.JSONDecodeError as error:
            raise ValueError(f"--camera is not JSON: {error}") from None
    else:
        try:
            numbers = [float(item) for item in text.split(",")]
        except ValueError:
            numbers = []
        if len(numbers) != 6:
            raise ValueError(f"--camera must be a JSON object or ex,ey,ez,tx,ty,tz, got {text!r}")
        given = {"eye": numbers[:3], "target": numbers[3:]}
    base = {} if default is None else {name: getattr(default, name) for name in Camera._fields}
    return camera_from_dict({**base, **given}, "--camera")


def _render(options: argparse.Namespace) -> None:
    images.check_writable(options.out, "--out")
    scene = _scene(options.scene)
    camera = scene.camera if options.camera is None else _camera(options.camera, scene.camera)
    if camera is None:
        raise ValueError(f"{options.scene} has no camera; give one with --camera")
    sizes = {"width": options.width, "height": options.height}
    camera = camera.replace(**{name: value for name, value in sizes.items() if value is not None})
    renderer = Renderer(
        scene, options.tolerance, method=options.method, threads=options.threads, max_depth=options.max_depth
    )
    with renderer:
        frame = renderer.render(camera, progress=options.progress)
    frame.save(options.out)
    rays = sum(frame.stats["rays"].values())
    size = f"{camera.width} x {camera.height} pixels"
    print(f"{options.out}: {size}, {rays} rays, {frame.stats['seconds']:.3f} s, {frame.stats['threads']} threads")


def _demo(options: argparse.Namespace) -> None:
    for line in make_demo(Path(options.out), frames=options.frames, width=options.width, height=options.height):
        print(line, flush=True)


def _bench(options: argparse.Namespace) -> None:
    from .bench import base, embree, error, exact, numbers, tables  # makes scenes

    bench = {"base": base, "exact": exact, "embree": embree, "error": error, "numbers": numbers}[options.what]
    arguments, block = _bench_arguments(options), f"bench {options.what}"
    _check_outputs(options)  # raises before time is spent
    if options.readme is not None:
        tables.split_block(Path(options.readme), block)
    result = bench.measure(**arguments)
    made = list(bench.tables(result))
    missing = list(tables.left_out(result["left_out"]))
    if not made:
        raise ValueError(f"nothing could be measured; {'; '.join(missing)}")
    for table in made:
        print(*(table.markdown() if options.markdown else table.text()), sep="\n", end="\n\n")
    for line in missing:
        print(line)
    if options.json is not None:
        Path(options.json).write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    if options.readme is not None:
        short = list(bench.readme_tables(result)) if hasattr(bench, "readme_tables") else made
        tables.rewrite_block(Path(options.readme), block, short)
    if options.plot is not None:
        plot = importlib.import_module(f".bench.{options.what}_plot", __package__)
        plot.figure(result).savefig(options.plot, dpi=150)


def _check_outputs(options: argparse.Namespace) -> None:
    """That the files which a bench is to write can be written."""
    for name in ("json", "plot"):
        path = getattr(options, name)
        if path is not None and not Path(path).parent.is_dir():
            raise ValueError(f"--{name}: no such folder: {str(Path(path).parent)!r}")
    if options.plot is None:
        return
    if options.what not in PLOTTED:
        raise ValueError(f"--plot is of bench {' and '.join(PLOTTED)}, got bench {options.what}")
    if Path(options.plot).suffix.lower() not in PLOTS:
        raise ValueError(f"--plot must end in one of {', '.join(PLOTS)}, got {options.plot!r}")
    if importlib.util.find_spec("matplotlib") is None:
        raise ImportError("--plot needs matplotlib: pip install 'raybound[plot]'")


def _bench_arguments(options: argparse.Namespace) -> dict[str, Any]:
    """The arguments of `measure` that were given, checked."""
    given: dict[str, Any] = {}
    for name in ("width", "height", "repeat", "triangles", "rays"):
        value = getattr(options, name)
        if value is not None:
            if value < 1:
                raise ValueError(f"--{name} must be >= 1, got {value}")
            given[name] = value
    if options.scenes is not None:
        given["names"] = [name for name in options.scenes.split(",") if name]
    if options.threads is not None:
        numbers = options.threads.split(",")
        if not all(number.isdecimal() and 0 < int(number) <= 1024 for number in numbers):
            raise ValueError(f"--threads must be numbers in 1..1024 with commas between them, got {options.threads!r}")
        given["threads"] = [int(number) for number in numbers]
    fixed = [name for name in FIXED[options.what] if name in given]
    if fixed:
        option = "scenes" if fixed[0] == "names" else fixed[0]
        raise ValueError(f"--{option} cannot be chosen for bench {options.what}: {FIXED[options.what][fixed[0]]}")
    return given


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs a command; returns the exit code: 0, or 2 for bad input with a message of one line, 130 after Ctrl-C."""
    options = _parser().parse_args(arguments)
    try:
        options.run(options)
    except (ValueError, TypeError, OSError, ImportError) as error:
        message = " ".join(str(error).split())
        print(f"raybound {options.command}: {message}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0
