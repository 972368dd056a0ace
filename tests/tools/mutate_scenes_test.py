"""Tests of tools/lab/mutate_scenes: that mutants can be made again, and that it sees what programs do wrong.
With a program, which is etendue_served, it also tries some mutants on that.

Usage: mutate_scenes_test.py [PROGRAM]"""

import contextlib
import io
import json
import math
import stat
import struct
import sys
import tempfile
import unittest
import zlib
from pathlib import Path
from random import Random

from tool_module import load_tool

tool = load_tool("lab/mutate_scenes")

from faults.pixels import EXR_OF_ONE_PART  # noqa: E402
from scene_mutants.images import nonfinite_colors  # noqa: E402
from scene_mutants.model import models_below, read_glb, seeds_of_fuzzing  # noqa: E402
from scene_mutants.program import Program  # noqa: E402
from scene_mutants.trial import MUTATIONS, Laboratory, make_mutant, make_small, prepare, signature  # noqa: E402

PROGRAM = None
SIZE = (8, 8)


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def zipped(block):
    """As OpenEXR compresses rows: even bytes first, differences, deflated."""
    parts = block[0::2] + block[1::2]
    return zlib.compress(bytes([parts[0], *((one - before + 128) & 255 for before, one in zip(parts, parts[1:]))]))


def exr(values, code="f", compress=False):
    """One row of the channels G and Z."""
    kind = 2 if code == "f" else 1
    listed = b"".join(name + b"\0" + struct.pack("<iIii", kind, 0, 1, 1) for name in (b"G", b"Z")) + b"\0"
    width = len(values)
    block = struct.pack(f"<{2 * width}{code}", *values, *[math.inf] * width)
    header = EXR_OF_ONE_PART + attribute("channels", "chlist", listed) + attribute("compression", "compression", b"\3")
    header += attribute("dataWindow", "box2i", struct.pack("<4i", 0, 0, width - 1, 0)) + b"\0"
    packed = zipped(block) if compress else block
    return header + bytes(8) + struct.pack("<iI", 0, len(packed)) + packed


# What every program below does unless it misbehaves: it renders all, into an image that is right.
WELL = f"""#!{sys.executable} -ES
import os, pathlib, signal, sys, time
command, scene = sys.argv[1], pathlib.Path(sys.argv[2])
out = pathlib.Path(sys.argv[4]) if command == "render" else None
image = {exr([0.5, 1.0])!r}
{{}}
if out:
    out.write_bytes(image)
"""
REFUSES = "print('error: no good', file=sys.stderr); sys.exit(3)"


class Images(unittest.TestCase):
    def count(self, data):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "image.exr"
            path.write_bytes(data)
            return nonfinite_colors(path)

    def test_colours_that_are_not_finite_are_counted_and_depths_are_not(self):
        for code in "fe":
            for compress in (False, True):
                with self.subTest(code=code, compress=compress):
                    self.assertEqual(self.count(exr([0.5, 2.0] * 40, code, compress)), 0)
                    self.assertEqual(self.count(exr([0.5, math.nan, math.inf, -math.inf] * 40, code, compress)), 120)

    def test_files_without_their_end_are_errors(self):
        whole = exr([1.0] * 40, compress=True)
        for size in range(8, len(whole)):
            with self.assertRaises(ValueError):
                self.count(whole[:size])


class Mutants(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bases = seeds_of_fuzzing()

    def written(self, model):
        with tempfile.TemporaryDirectory() as folder:
            model.write(Path(folder))
            return {path.name: path.read_bytes() for path in Path(folder).iterdir()}

    def test_a_mutant_can_be_made_again(self):
        first, again, other, seeded = (make_mutant(number, seed, self.bases, SIZE)
                                       for number, seed in ((7, 1), (7, 1), (8, 1), (7, 2)))
        self.assertEqual(first.changes, again.changes)
        self.assertEqual(self.written(first.model), self.written(again.model))
        self.assertNotEqual(first.changes, other.changes)
        self.assertNotEqual(first.changes, seeded.changes)

    def unchanged(self, number):
        """The files that a mutant of this number would have without its changes."""
        random = Random(f"1 {number}")
        model = random.choice(self.bases).copy()
        prepare(model, number, random)
        make_small(model.settings, SIZE)
        return self.written(model)

    def test_every_kind_changes_a_model_and_leaves_the_base(self):
        before = [self.written(base) for base in self.bases]
        unchanged = [self.unchanged(number) for number in range(8)]
        for kind in MUTATIONS:
            with self.subTest(kind):
                mutants = (make_mutant(number, 1, self.bases, SIZE, [kind]) for number in range(len(unchanged)))
                changed = next((mutant for mutant in mutants if mutant.changes), None)
                self.assertIsNotNone(changed)
                self.assertNotEqual(self.written(changed.model), unchanged[changed.number])
        self.assertEqual([self.written(base) for base in self.bases], before)

    def test_no_kind_fails_on_what_others_left(self):
        for number in range(60):
            self.written(make_mutant(number, 3, self.bases, SIZE).model)

    def test_large_images_become_small_and_wrong_sizes_stay(self):
        for settings, expected in (({}, {"spp": 1, "size": [8, 8]}),
                                   ({"spp": 64, "size": [1, 65536]}, {"spp": 1, "size": [8, 8]}),
                                   ({"spp": "64", "size": [0, 9]}, {"spp": "64", "size": [0, 9]}),
                                   ({"spp": True, "size": [9]}, {"spp": True, "size": [9]})):
            make_small(settings, SIZE)
            self.assertEqual(settings, expected)
        settings = {"integrator": {"max_depth": 1 << 30, "roulette_depth": -1, "min_depth": 3}}
        make_small(settings, SIZE)
        self.assertEqual(settings["integrator"], {"max_depth": 64, "roulette_depth": -1, "min_depth": 3})

    def test_glb_is_written_whole(self):
        base = next(base for base in self.bases if base.main == "scene.glb")
        document, binary = read_glb(self.written(base)["scene.glb"])
        self.assertEqual(document, base.document)
        self.assertEqual(binary[:len(base.binary)], base.binary)

    def test_faults_that_look_alike(self):
        self.assertEqual(signature("inspect: /tmp/x/in/a/scene/scene.gltf#/nodes/3: has 12 parts of 'a'"),
                         signature("inspect: /tmp/y/in/a/scene/scene.gltf#/nodes/12/mesh: has 1e9 parts of 'b'"))
        self.assertNotEqual(signature("inspect: SIGSEGV"), signature("render: SIGSEGV"))


class Judgement(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        bases = self.folder / "bases"
        bases.mkdir()
        (bases / "one.gltf").write_text(json.dumps({"asset": {"version": "2.0"}, "nodes": [{"name": "a", "mesh": 0}]}))
        self.bases = models_below(bases, "bases")

    def program(self, body):
        path = self.folder / "program"
        path.write_text(WELL.format(body))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return path

    def mutant(self):
        return make_mutant(1, 1, self.bases, SIZE)

    def faults(self, body):
        return Laboratory(Program(self.program(body), 20), self.folder / "scratch").attempt(self.mutant()).faults

    def test_well_behaved_programs_have_no_faults(self):
        for body in ("", REFUSES):
            self.assertEqual(self.faults(body), [])

    def test_each_fault_is_seen(self):
        only_render = "if out: "
        for body, expected in (
                (only_render + "os.kill(os.getpid(), signal.SIGSEGV)", "render: SIGSEGV"),
                (only_render + "print('what is this', file=sys.stderr); sys.exit(1)", "render: exit code 1: what is this"),
                ("sys.exit(2)", "inspect: exit code 2"),
                ("if out:\n    " + REFUSES, "only render refuses it: error: no good"),
                ("if not out:\n    " + REFUSES, "only inspect refuses it"),
                (only_render + f"image = {exr([math.nan, 1.0])!r}", "render: 1 values of the image are not finite"),
                (only_render + "image = image[:-1]", "render: no image that can be read"),
                (only_render + "out = None", "render: no image that can be read"),
                (only_render + "(scene / 'scene.gltf').write_text('')", "a/scene/scene.gltf was written"),
                (only_render + "(scene / '../../stray').write_text('')", "stray was written"),
                (only_render + "(scene / 'render.json').unlink()", "a/scene/render.json is gone"),
                ("if out: out.write_bytes(b'')\n" + REFUSES, "render: refuses it and writes 1 files"),
                ("sys.exit(3)", "render: does not say why")):
            with self.subTest(expected):
                self.assertIn(expected, " and ".join(self.faults(body)))

    def test_programs_that_do_not_end_are_stopped(self):
        for body in ("exec sleep 9", "while :; do :; done"):
            path = self.folder / "program"
            path.write_text(f"#!/bin/sh\ntest $1 = inspect || {body}\n")
            path.chmod(path.stat().st_mode | stat.S_IXUSR)
            faults = Laboratory(Program(path, 0.1), self.folder / "scratch").attempt(self.mutant()).faults
            self.assertIn("render: runs for more than 0.1 s", faults)

    def run_tool(self, *words):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = tool.main([*words, "--bases", str(self.folder / "bases")])
        return status, out.getvalue()

    def test_memory_is_limited_and_faults_are_counted_and_kept(self):
        program, kept, outcomes = self.program("import mmap; out and mmap.mmap(-1, 1 << 30)"), self.folder / "kept", self.folder / "o.json"
        status, out = self.run_tool("--program", str(program), "--memory", "600", "--count", "3", "-j", "2", "--keep", str(kept),
                                    "--json", str(outcomes))
        self.assertEqual(status, 1)
        self.assertIn("Cannot allocate memory", out)
        self.assertIn("mutants 0, 1, 2", out)
        self.assertIn("| all mutants | 3 | 0 | 0 | 3 |", out)
        self.assertEqual([one["number"] for one in json.loads(outcomes.read_text())], [0, 1, 2])
        status, out = self.run_tool("--program", str(program), "--only", "2", "--keep", str(self.folder / "again"))
        self.assertEqual(status, 0)
        self.assertIn('"result": "rendered"', out)
        for file in (kept / "2").iterdir():
            self.assertEqual(file.read_bytes(), (self.folder / "again/2" / file.name).read_bytes())

    def test_served_programs_withstand_it(self):
        if PROGRAM is None:
            self.skipTest("no program was named")
        status, out = self.run_tool("--program", str(PROGRAM), "--served", "--count", "6")
        self.assertEqual(status, 0, out)
        self.assertIn("| all mutants | 6 |", out)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        PROGRAM = Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
