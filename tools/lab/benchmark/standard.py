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


def standard_table(scenes, threads):
    """One row for each scene: after an integrator's name its million samples a second on all threads, and the efficiency of one
    thread against single rays."""
    head = ["scene", "triangles", "first, s", "peak"]
    for integrator in INTEGRATORS:
        head += [f"`{integrator}`", "single"]
    rows = []
    for name, data in scenes.items():
        row = [name, f"{data['bvh']['triangles']:,}", figure(data["first_pixel"]), figure(data["peak"] / 1e6)]
        for integrator in INTEGRATORS:
            one, on_all = (run_of(data, integrator, count) for count in (threads[0], threads[-1]))
            rate = on_all["samples_per_second"]
            row += [figure(None if rate is None else rate / 1e6), figure(one["efficiency_single"], 2)]
        rows.append(row)
    return table(head, rows)


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
