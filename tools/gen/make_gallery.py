#!/usr/bin/env python3
"""Generates the scenes of docs/gallery.md: a directory for each, with glTF, environment and render.json.

tools/gallery calls this, renders what it wrote, and makes the pictures of the page.
"""

import argparse
import json
import sys
from pathlib import Path

from scenegen.gallery import SCENES
from scenegen.write import write_files


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"scenes, all if none: {', '.join(SCENES)}")
    parser.add_argument("-o", "--output", type=Path, required=True, help="directory of the scenes")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in SCENES]
    if unknown:
        parser.error(f"no scene {', '.join(unknown)}; there are {', '.join(SCENES)}")
    for name in arguments.names or SCENES:
        scene = SCENES[name]()
        settings = json.dumps(scene.settings(), indent=2) + "\n"
        write_files(arguments.output / name, {**scene.contents(), "render.json": settings.encode()})
    return 0


if __name__ == "__main__":
    sys.exit(main())
