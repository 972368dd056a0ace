#!/usr/bin/env python3
"""That a large mesh loads and renders within the memory that docs/performance.md states for a triangle.

    tests/bench/memory_test.py build/release/bin/etendue
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from make_large_glb import write_glb

SMALL, LARGE = 1_000, 1_000_000
# 1.5 GB for ten million triangles.
MOST_BYTES_PER_TRIANGLE = 150.0


def peak_bytes(etendue, directory, triangles):
    """Of a process that renders one sample of a mesh of so many triangles."""
    scene = directory / f"{triangles}.glb"
    write_glb(scene, triangles, 1)
    process = subprocess.Popen([etendue, "render", scene, "--size", "16x16", "--spp", "1", "--quiet",
                                "-o", directory / "image.exr"])
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{etendue} failed on a mesh of {triangles} triangles")
    return usage.ru_maxrss * 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("etendue", type=Path)
    etendue = parser.parse_args().etendue.resolve()
    with tempfile.TemporaryDirectory() as directory:
        small, large = (peak_bytes(etendue, Path(directory), n) for n in (SMALL, LARGE))
    each = (large - small) / (LARGE - SMALL)
    print(f"{each:.0f} bytes a triangle at the peak; {MOST_BYTES_PER_TRIANGLE:.0f} are allowed")
    return 0 if each <= MOST_BYTES_PER_TRIANGLE else 1


if __name__ == "__main__":
    sys.exit(main())
