"""What the project wants to reach, and whether it has."""

import statistics

from benchmark import standard, threads
from benchmark.curves import CURVES, fastest, per_sample
from benchmark.tables import NOT_KNOWN, figure, table

TEXTURED = "glossy-interior"
TRIANGLES = next(curve for curve in CURVES if curve.name == "triangles")


def row(what, bound, at_least, value, note):
    """`bound` is met by a value on its side; a value of None was not measured."""
    met = "not measured" if value is None else "met" if (value >= bound if at_least else value <= bound) else "**not met**"
    return [what, f"{'≥' if at_least else '≤'} {bound:g}", figure(value), met, note]


def efficiency(results, scene, integrator):
    """Against single rays on one thread, and a note with those against packets and on all threads."""
    data = results.get(f"standard/{scene}")
    if data is None:
        return None, NOT_KNOWN
    one, *more = sorted((run for run in data["runs"] if run["integrator"] == integrator), key=lambda run: run["threads"])
    note = f"1 thread; {figure(one['efficiency_best'], 2)} against the best packets"
    for run in more:
        note += f"; {figure(run['efficiency_single'], 2)} on {run['threads']} threads"
    return one["efficiency_single"], note


def textured_note(results, note):
    data = results.get(f"standard/{TEXTURED}")
    return note if data is None else f"{data['materials']} materials, {data['textures']} textures; {note}"


def growth(results, many, few):
    """Processor time of a sample with `many` triangles over that with `few`."""
    data = results.get(TRIANGLES.name)
    points = fastest(data) if data else {}
    if many not in points or few not in points:
        return None, NOT_KNOWN
    cost = per_sample("path")
    rays = [points[count]["path"]["rays"] / points[count]["path"]["samples"] for count in (many, few)]
    return cost(points[many]) / cost(points[few]), (f"CPU time of a sample; {figure(rays[0])} and {figure(rays[1])} rays of "
                                                    "each sample")


def aims_table(results):
    """`results` has the data by part; parts that are not there were not measured."""
    path, path_note = efficiency(results, "cornell-box", "path")
    textured, note = efficiency(results, TEXTURED, "path")
    bdpt, bdpt_note = efficiency(results, "caustic-glass", "bdpt")
    pairs = threads.speed_ups(results["threads"], "path", 2) if "threads" in results else []
    ratio, ratio_note = growth(results, 10 ** 7, 10 ** 5)
    start = results.get("start")
    first, first_note = None, NOT_KNOWN
    if start:
        seconds = start["first_pixel"]
        first = statistics.median(seconds)
        first_note = (f"median of {len(seconds)} processes, {min(seconds):.2f} to {max(seconds):.2f} s; "
                      f"{start['width']} × {start['height']} pixels")
    return table(["aim", "bound", "measured", "", "how"], [
        row("efficiency of `path` on cornell-box", 0.6, True, path, path_note),
        row("the same, the next step", 1.0, True, path, ""),
        row(f"efficiency of `path` on {TEXTURED}", 0.45, True, textured, textured_note(results, note)),
        row("efficiency of `bdpt` on caustic-glass", 0.6, True, bdpt, bdpt_note),
        row("speed of 2 threads over 1, `path` on cornell-box", 1.95, True, statistics.median(pairs) if pairs else None,
            f"{threads.speed_up_text(pairs)} of {len(pairs)} pairs" if pairs else NOT_KNOWN),
        row("time with 10⁷ triangles over that with 10⁵, the same view", 3.0, False, ratio, ratio_note),
        row("first pixel of cornell-box, whole process, s", 0.15, False, first, first_note)], words=(0, 3, 4))
