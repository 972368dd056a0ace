"""Running the program that is measured."""

import json
import subprocess


class Failed(Exception):
    """A program has failed; the message has its command and what it said."""


def run(words):
    words = [str(word) for word in words]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        raise Failed(f"'{' '.join(words)}' failed with exit code {done.returncode}:\n{done.stderr.strip()}")
    return done.stdout


def render(program, scene, image, options):
    """What a growth curve needs of a render: times in seconds, sizes in bytes."""
    report = json.loads(run([program, "render", scene, "-o", image, "--quiet", "--json", *options]))
    return {"load": report["seconds"]["load"]["wall"], "build": report["seconds"]["build"]["wall"],
            "bvh": report["bvh_build_seconds"], "cpu": report["seconds"]["render"]["cpu"], "samples": report["samples"],
            "rays": report["rays"]["total"], "peak": report["peak_memory_bytes"], "triangles": report["triangles"]}


def profile(program, scene, folder, options):
    """profile.json without what is there for each tile, pixel and stage."""
    run([program, "profile", scene, "-o", folder, "--quiet", *options])
    report = json.loads((folder / "profile.json").read_text())
    keys = ("integrator", "threads", "spp", "seconds", "cpu_seconds", "samples", "samples_per_second", "rays_per_second",
            "efficiency_single", "efficiency_best", "parallel_efficiency", "tracing_share")
    runs = [{key: of[key] for key in keys} for of in report["runs"]]
    kept = ("program", "scene", "machine", "bvh", "notes")
    return {**{key: report[key] for key in kept}, "first_pixel": report["load"]["first_pixel_seconds"],
            "peak": report["memory"]["peak_bytes"], "runs": runs}
