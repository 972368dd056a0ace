#!/usr/bin/env python3
"""Generates the scenes of scenes/: scene.gltf, scene.bin and environment images of each directory.

Sources are published measurements and closed forms, in tools/gen/scenegen/scenes/. render.json and README.md beside them
are written by hand; --check says where render.json disagrees with the numbers that are derived here.
"""

import argparse
import sys
from pathlib import Path

from scenegen.check import check_scene
from scenegen.scenes import SCENES
from scenegen.write import write_files

DEFAULT_OUTPUT = Path(__file__).resolve().parents[2] / "scenes"


def check(name, directory):
    """Prints the problems of the scene `name` and its render.json in `directory`; returns True if there are none."""
    settings = directory / "render.json"
    problems = check_scene(SCENES[name](), settings.read_text() if settings.exists() else "{}")
    for problem in problems:
        print(f"{name}: {problem}", file=sys.stderr)
    print(f"{name}: {'ok' if not problems else f'{len(problems)} problems'}")
    return not problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"scenes, all if none: {', '.join(SCENES)}")
    parser.add_argument("-o", "--output", type=Path, default=DEFAULT_OUTPUT, help="directory of the scenes")
    parser.add_argument("--check", action="store_true", help="write nothing; check geometry and render.json")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in SCENES]
    if unknown:
        parser.error(f"no scene {', '.join(unknown)}; there are {', '.join(SCENES)}")

    good = True
    for name in arguments.names or SCENES:
        directory = arguments.output / name
        if arguments.check:
            good = check(name, directory) and good
        else:
            write_files(directory, SCENES[name]().contents())
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
