"""Running the program, and looking at what it leaves."""

import json
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from .pixels import read_pixels

ROOT = Path(__file__).resolve().parents[3]
TIMEOUT = 300  # seconds for any render
FINAL = (".exr", ".png", ".json")


def make_scenes(names, directory):
    """Those scenes, as tools/gen/make_scenes.py makes them, with their render.json."""
    subprocess.run([sys.executable, "-B", ROOT / "tools/gen/make_scenes.py", *sorted(names), "-o", directory], check=True,
                   stdout=subprocess.DEVNULL)
    for name in names:
        shutil.copy(ROOT / "scenes" / name / "render.json", directory / name)


@dataclass(frozen=True)
class Case:
    """One image to render. `options` make it small."""

    scene: Path
    integrator: str
    options: tuple

    @property
    def name(self):
        return f"{self.scene.name}-{self.integrator}"


def command(program, case, output, *more):
    return [str(program), "render", str(case.scene), "-o", str(output), "--integrator", case.integrator, "--float",
            *case.options, *more]


def run(arguments):
    return subprocess.run(arguments, capture_output=True, text=True, errors="replace", timeout=TIMEOUT, check=False)


def render(program, case, output, *more, quiet=True):
    """The finished process."""
    return run(command(program, case, output, *(["--quiet"] if quiet else []), *more))


def temporary_files(directory):
    """Of writers that live, or died."""
    return [path for path in directory.rglob(".*.tmp")]


def stray_files(directory, outputs):
    """All files below `directory` but those of the images `outputs`."""
    wanted = {output.with_suffix(suffix) for output in outputs for suffix in FINAL}
    return sorted(path for path in directory.rglob("*") if path.is_file() and path not in wanted)


class Reference:
    """An image that nothing interrupted."""

    def __init__(self, output):
        self.pixels = {suffix: read_pixels(output.with_suffix(suffix)) for suffix in (".exr", ".png")}

    def faults(self, output, finished):
        """What is wrong with the files of `output`; while it is not finished they may be missing, but never else."""
        for suffix, expected in self.pixels.items():
            path = output.with_suffix(suffix)
            if not path.exists():
                if finished:
                    yield f"{path} is missing"
                continue
            try:
                if read_pixels(path) != expected:
                    yield f"{path} has other pixels than the image of an uninterrupted render"
            except ValueError as error:
                yield str(error)
        path = output.with_suffix(".json")
        if path.exists() or finished:
            try:
                if json.loads(path.read_text())["complete"] is not True:
                    yield f"{path} says that the image is not complete"
            except (OSError, ValueError, KeyError) as error:
                yield f"{path}: {error}"
