#!/usr/bin/env python3
"""Generates the rows of spheres that tests/regression renders: one directory each, with scene.gltf, scene.bin and
render.json. tools/gen/scenegen/rows/ describes them. row-compressed needs the program encode_gltf, which the build makes."""

import argparse
import sys
from pathlib import Path

from scenegen.rows import ROWS
from scenegen.write import write_files


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"rows, all if none: {', '.join(ROWS)}")
    parser.add_argument("-o", "--output", type=Path, required=True, help="directory of the scenes")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in ROWS]
    if unknown:
        parser.error(f"no row {', '.join(unknown)}; there are {', '.join(ROWS)}")
    for name in arguments.names or ROWS:
        write_files(arguments.output / name, ROWS[name]().contents())
    return 0


if __name__ == "__main__":
    sys.exit(main())
