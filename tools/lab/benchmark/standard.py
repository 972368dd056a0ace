"""The standard set: every scene of scenes/ with path and bdpt on one thread and on all."""

import json

from benchmark import etendue
from benchmark.plots import DotRow, dot_plot
from benchmark.tables import figure, table

INTEGRATORS = ("path", "bdpt")


def scene_names(folder):
    """Of the scene directories that have been generated, in order of the alphabet."""
    return sorted(file.parent.name for file in folder.glob("*/scene.gltf"))


def missing_scenes(folder):
    return sorted(file.parent.name for file in folder.glob("*/render.json")
                  if not (file.parent / "scene.gltf").exists())


def thread_counts(processors):
    return sorted({1, processors})


def measure(setup, name):
    """The profile of a scene, and what of it the tables say that no profile has."""
    mode = setup.mode
    size = ["--size", mode.size] if mode.size else []
    threads = ",".join(map(str, thread_counts(setup.processors)))
    data = etendue.profile(setup.program, setup.scenes / name, setup.folder / "profile",
                           ["--integrators", ",".join(INTEGRATORS), "--threads", threads, "--seconds", mode.seconds,
                            "--repeat", mode.repeat, *size])
    document = json.loads((setup.scenes / name / "scene.gltf").read_text())
    data["materials"], data["textures"] = (len(document.get(key, [])) for key in ("materials", "textures"))
    return data


def run_of(data, integrator, threads):
    return next((run for run in data["runs"] if (run["integrator"], run["threads"]) == (integrator, threads)), None)


def percent(share):
    return "–" if share is None else f"{100 * share:.0f}%"


def integrator_table(scenes, integrator, threads):
    """Where there is only one processor, what all threads would do is left out."""
    many = threads[-1]
    head = [f"`{integrator}`"]
    for quantity in ("Ms/s", "Mrays/s", "single", "best"):
        head += [f"{quantity}, {threads[0]}", *(f"on {count}" for count in threads[1:])]
    if many > 1:
        head.append("parallel")
    rows = []
    for name, data in scenes.items():
        runs = [run_of(data, integrator, count) for count in threads]
        row = [name]
        for key, unit, digits in (("samples_per_second", 1e6, 3), ("rays_per_second", 1e6, 3),
                                  ("efficiency_single", 1, 2), ("efficiency_best", 1, 2)):
            row += [figure(None if run[key] is None else run[key] / unit, digits) for run in runs]
        if many > 1:
            row.append(percent(runs[-1]["parallel_efficiency"]))
        rows.append(row)
    return table(head, rows)


def start_table(scenes):
    rows = []
    for name, data in scenes.items():
        bvh = data["bvh"]
        rows.append([name, f"{data['scene']['width']} × {data['scene']['height']}", f"{bvh['triangles']:,}",
                     f"{bvh['instances']:,}", figure(data["first_pixel"]), figure(1000 * bvh["build_seconds"]),
                     figure(bvh["triangles_per_second"] / 1e6, 2), figure(data["peak"] / 1e6)])
    return table(["scene", "pixels", "triangles", "instances", "first pixel, s", "BVH, ms", "Mtris/s", "peak, MB"], rows)


def plot(scenes, threads):
    """Efficiency on one thread beside samples per second on all of them."""
    many = threads[-1]
    left, right = [], []
    for name, data in scenes.items():
        one = [run_of(data, integrator, 1)["efficiency_single"] for integrator in INTEGRATORS]
        rates = [run_of(data, integrator, many)["samples_per_second"] / 1e6 for integrator in INTEGRATORS]
        left.append(DotRow(name, one))
        right.append(DotRow(name, rates))
    on_all = "1 thread" if many == 1 else f"{many} threads"
    return dot_plot("The standard set", [("efficiency against single rays, 1 thread", left, False),
                                         (f"million samples a second, {on_all}", right, True)], INTEGRATORS)
