"""Growth curves: how time and memory grow with what a scene or a render has more of."""

import json
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass

from benchmark import etendue, layers, standard
from benchmark.fit import last_exponent, straight_line
from benchmark.plots import Panel, Series, curve_plot
from benchmark.tables import count_text, exponent_text, figure, table

FIXED_SCENE = "cornell-box"
NO_ROULETTE = "no roulette"
SIZE = "256x256"


@dataclass
class Column:
    """A quantity of a curve, in one of the panels of its plot."""

    panel: str  # quantity and unit of the panel's axis
    label: str  # of the line in the panel
    value: Callable  # of a point: its fastest render by variant


@dataclass
class Curve:
    """What grows, how it is rendered, and what is told of it."""

    name: str
    what: str  # grows
    title: str
    points: list
    quick_points: list
    variants: list
    columns: list
    commands: Callable  # (setup, point, variant) -> scene, options of `etendue render`
    note: str
    logarithmic: bool = True
    generated: bool = False  # the scenes


def per_sample(variant):
    """Processor time of a sample, in microseconds."""
    return lambda point: 1e6 * point[variant]["cpu"] / point[variant]["samples"]


def of(key, scale, variant):
    return lambda point: point[variant][key] * scale


SECONDS, MICROSECONDS, MEGABYTES = "seconds", "CPU µs a sample", "peak memory, MB"

SCENE_COLUMNS = [
    Column(SECONDS, "load", of("load", 1, "path")),
    Column(SECONDS, "compile", of("build", 1, "path")),
    Column(SECONDS, "BVH", of("bvh", 1, "path")),
    Column(MICROSECONDS, "render", per_sample("path")),
    Column(MEGABYTES, "peak", of("peak", 1e-6, "path")),
]


def integrator_columns(variants=standard.INTEGRATORS):
    return [Column(MICROSECONDS, name, per_sample(name)) for name in variants] \
        + [Column(MEGABYTES, name, of("peak", 1e-6, name)) for name in standard.INTEGRATORS]


def generated_scene(options):
    """Scenes that make_large_glb.py writes, with `options` of it for a point. They are there once for all repetitions."""
    def command(setup, point, _):
        scene = setup.folder / f"{point}.glb"
        if not scene.exists():
            etendue.run([sys.executable, "-B", setup.root / "tests/bench/make_large_glb.py", scene, *options(point)])
        return scene, ["--integrator", "path", "--size", SIZE, "--spp", setup.mode.spp]

    return command


def without_roulette(setup):
    """The fixed scene, where no path ends by Russian roulette."""
    folder = setup.folder / "no-roulette"
    if not folder.exists():
        # Copied, since Etendue follows no link out of a scene directory.
        shutil.copytree(setup.scenes / FIXED_SCENE, folder)
        settings = json.loads((folder / "render.json").read_text())
        settings["integrator"]["roulette_depth"] = 1_000_000
        (folder / "render.json").write_text(json.dumps(settings))
    return folder


def deep(setup, point, variant):
    integrator, _, kind = variant.partition(", ")
    scene = without_roulette(setup) if kind == NO_ROULETTE else setup.scenes / FIXED_SCENE
    return scene, ["--integrator", integrator, "--max-depth", point, "--size", "128x128", "--spp", setup.mode.spp]


def large(setup, point, variant):
    # As many samples whatever the resolution, but for the largest.
    spp = max(1, setup.mode.resolution_samples // point ** 2)
    return setup.scenes / FIXED_SCENE, ["--integrator", variant, "--size", f"{point}x{point}", "--spp", spp]


def layered(setup, point, variant):
    words = [word for layer in layers.SETS[point] for word in ("--aov", layer)]
    return setup.scenes / FIXED_SCENE, ["--integrator", variant, "--size", SIZE, "--spp", setup.mode.spp, *words]


ROULETTE_VARIANTS = [*standard.INTEGRATORS, *(f"{name}, {NO_ROULETTE}" for name in standard.INTEGRATORS)]

CURVES = [
    Curve("triangles", "triangles", "Triangles: one mesh, the same view", [10 ** k for k in range(3, 8)],
          [10 ** k for k in range(3, 6)], ["path"], SCENE_COLUMNS, generated_scene(lambda n: ["--triangles", n]),
          "A height field of so many triangles under an even sky; `path`, 256 × 256 pixels.",
          generated=True),
    Curve("instances", "instances", "Instances: one small mesh in many places", [10 ** k for k in range(2, 7)],
          [10 ** k for k in range(2, 5)], ["path"], SCENE_COLUMNS,
          generated_scene(lambda n: ["--triangles", 8, "--instances", n]),
          "A mesh of 8 triangles in so many places, each a node of the file and all in view; `path`, 256 × 256 pixels.",
          generated=True),
    Curve("lights", "lights", "Lights: points above one mesh", [10 ** k for k in range(6)], [10 ** k for k in range(0, 5, 2)],
          ["path"], SCENE_COLUMNS, generated_scene(lambda n: ["--triangles", 1000, "--lights", n]),
          "So many point lights above a height field of 968 triangles, together as bright as one; `path`, 256 × 256 pixels.",
          generated=True),
    Curve("depth", "longest path, edges", "Depth: the longest path allowed, cornell-box", [2, 4, 8, 16, 32, 64], [2, 8, 32],
          ROULETTE_VARIANTS,
          integrator_columns(ROULETTE_VARIANTS),
          deep, "cornell-box, 128 × 128 pixels, CPU µs a sample. Russian roulette ends paths from the third edge on; with "
          "*no roulette* they go on until they leave the box or are as long as is allowed."),
    Curve("resolution", "pixels a side", "Resolution: cornell-box", [128, 256, 512, 1024, 2048], [128, 256, 512],
          list(standard.INTEGRATORS), integrator_columns(), large, "cornell-box, square images."),
    Curve("aovs", "layers", "Layers besides the image, cornell-box", list(layers.SETS), list(layers.SETS),
          list(standard.INTEGRATORS), integrator_columns(), layered,
          "cornell-box, 256 × 256 pixels, so many layers by `--aov`: one is `direct`, four are `direct`, `indirect`, `albedo` "
          "and `N`, ten are `passes`, and forty add first hits, costs and sixteen expressions.", logarithmic=False),
]


def measure(setup, curve):
    """The runs of every variant of every point. They take turns, so that what slows the machine slows all of them."""
    points = curve.quick_points if setup.mode.quick else curve.points
    runs = {str(point): {variant: [] for variant in curve.variants} for point in points}
    for turn in range(setup.mode.turns):
        for point in points:
            setup.say(f"{curve.name}, {point:,} (turn {turn + 1} of {setup.mode.turns})")
            for variant in curve.variants:
                scene, options = curve.commands(setup, point, variant)
                runs[str(point)][variant].append(
                    etendue.render(setup.program, scene, setup.folder / "image.exr", options))
    return {"turns": setup.mode.turns, "points": runs}


def fastest(data):
    """By point and variant, the least of every time over the turns; other figures are the same in all, or the most."""
    def least(runs):
        return {key: (max if key == "peak" else min)(run[key] for run in runs) for key in runs[0]}

    return {int(point): {variant: least(runs) for variant, runs in of_point.items()}
            for point, of_point in data["points"].items()}


def exponent(value, points):
    """That of the last three points."""
    return last_exponent([(x, value(point)) for x, point in points.items()])


def share_of_each(value, points):
    """By how much of the value without any, each one raises it: the slope of a line through all points."""
    slope, _ = straight_line(list(points), [value(point) for point in points.values()])
    return slope / value(points[0])


def growth_table(data):
    """Of each curve that there is data of by name, and each integrator: the values of the first and the last point, and how
    they grow in between."""
    rows = []
    for curve in CURVES:
        if curve.name not in data:
            continue
        points = fastest(data[curve.name])
        first, last = next(iter(points.items())), next(reversed(points.items()))
        for integrator in standard.INTEGRATORS:
            if integrator not in curve.variants:
                continue
            row = [curve.what, f"`{integrator}`", f"{count_text(first[0])} to {count_text(last[0])}"]
            for value in (per_sample(integrator), of("peak", 1e-6, integrator)):
                growth = (exponent_text(exponent(value, points)) if curve.logarithmic
                          else f"{100 * share_of_each(value, points):+.1f}% each")
                row += [f"{figure(value(first[1]))} to {figure(value(last[1]))}", growth]
            rows.append(row)
    return table(["what grows", "", "from, to", "CPU µs a sample", "exponent", "peak, MB", "exponent"], rows, words=(0, 1, 2))


def what_each_adds(data):
    """A sentence on a curve of scenes: from the last point but one to the last, where what is constant weighs least."""
    (few, before), (many, now) = list(fastest(data).items())[-2:]

    def each(key, scale):
        return figure(scale * (now["path"][key] - before["path"][key]) / (many - few), 2)

    return (f"From {count_text(few)} to {count_text(many)} each one more adds {each('peak', 1)} bytes to the peak, "
            f"{each('load', 1e6)} µs of loading and {each('build', 1e6)} µs of compiling.")


def plot(curve, data):
    points = fastest(data)
    exponents = [exponent(column.value, points) for column in curve.columns]
    panels = []
    for title in dict.fromkeys(column.panel for column in curve.columns):
        series = [Series(column.label, [(x, column.value(point)) for x, point in points.items()],
                         k if curve.logarithmic else None)
                  for column, k in zip(curve.columns, exponents) if column.panel == title]
        panels.append(Panel(title, curve.what, series, curve.logarithmic, curve.logarithmic))
    return curve_plot(curve.title, panels)
