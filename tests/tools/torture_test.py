"""Tests of tools/lab/torture: that it sees what it is for. With a program it also tortures that, in the quick way.

Usage: torture_test.py [PROGRAM]"""

import contextlib
import io
import json
import os
import random
import shutil
import stat
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / folder) for folder in ("", "lab", "gen")]

from faults.batches import Batches, check_output  # noqa: E402
from faults.corruption import Corruption, damage, torture_checkpoints  # noqa: E402
from faults.kills import torture_case  # noqa: E402
from faults.pixels import EXR_OF_ONE_PART, exr_pixels, png_pixels  # noqa: E402
from faults.render import Case, Reference, make_scenes  # noqa: E402
from tool_module import load_tool  # noqa: E402

PROGRAM = None
NOTHING_FILLED = 77

# Runs the program, then does with the image what a faulty one might have done.
FAULTY = """#!{python}
import os, pathlib, subprocess, sys
if "--resume" not in sys.argv:
    # In place of this process: whoever kills it kills the render.
    os.execv("{program}", ["{program}", *sys.argv[1:]])
image = pathlib.Path(sys.argv[sys.argv.index("-o") + 1])
{before}
status = subprocess.run(["{program}", *sys.argv[1:]]).returncode
{after}
sys.exit(status)
"""
FLIP_BYTE = """
path = image.with_suffix("{}")
data = bytearray(path.read_bytes())
data[{}] ^= 1
path.write_bytes(data)
"""


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def exr(width=2, height=20, when="today", pixels=b"abc"):
    """A file of two blocks, as far as its structure goes."""
    header = EXR_OF_ONE_PART + attribute("channels", "chlist", b"R\0....") + attribute("compression", "compression", b"\3")
    header += attribute("dataWindow", "box2i", struct.pack("<4i", 0, 0, width - 1, height - 1))
    header += attribute("capDate", "string", when.encode()) + b"\0"
    blocks = [struct.pack("<iI", y, len(pixels)) + pixels for y in (0, 16)]
    return header + bytes(8 * len(blocks)) + b"".join(blocks)


def png(pixels=b"abc", text=b"today"):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", bytes(13)) + chunk(b"tEXt", text) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")


class Pixels(unittest.TestCase):
    def test_what_is_no_pixel_does_not_count(self):
        self.assertEqual(exr_pixels(exr(when="today")), exr_pixels(exr(when="in a year")))
        self.assertEqual(png_pixels(png(text=b"today")), png_pixels(png(text=b"in a year")))

    def test_pixels_and_sizes_count(self):
        self.assertNotEqual(exr_pixels(exr()), exr_pixels(exr(pixels=b"abd")))
        self.assertNotEqual(exr_pixels(exr()), exr_pixels(exr(width=3)))
        self.assertNotEqual(png_pixels(png()), png_pixels(png(pixels=b"abd")))

    def test_a_file_without_its_end_is_no_image(self):
        for read, data in ((exr_pixels, exr()), (png_pixels, png())):
            for size in range(len(data)):
                with self.assertRaises((ValueError, KeyError, IndexError, struct.error)):
                    read(data[:size])


class Damage(unittest.TestCase):
    def test_every_damaged_file_differs(self):
        whole, chance, result = bytes(range(256)), random.Random(1), Corruption()
        damaged = [damage(whole, index, chance, result) for index in range(500)]
        self.assertTrue(all(data != whole for data in damaged))
        self.assertEqual((result.flipped, result.cut_off), (450, 50))


class BatchOutput(unittest.TestCase):
    """What batches leave, made up."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name)
        for name in ("a", "b"):
            self.write(name, exr())
        self.references = {name: Reference(self.out / f"{name}.exr") for name in ("a", "b")}
        (self.out / "index.html").write_text("")
        (self.out / "report.json").write_text(json.dumps({"totals": {"rendered": 1, "up_to_date": 1}}))
        self.finish(["a", "b"])

    def write(self, name, data):
        (self.out / f"{name}.exr").write_bytes(data)
        (self.out / f"{name}.png").write_bytes(png())
        (self.out / f"{name}.json").write_text('{"complete": true}')

    def finish(self, units):
        lines = [json.dumps({"event": "unit finished", "unit": unit}) for unit in units]
        (self.out / "ledger.jsonl").write_text("\n".join([*lines, '{"event": "unit fini']))

    def check(self):
        result = Batches(2)
        check_output(self.out, self.references, result)
        return result

    def test_what_is_right_has_no_faults(self):
        result = self.check()
        self.assertEqual((result.faults, result.identical, result.rendered_twice, result.stray), ([], 2, 0, 0))

    def test_each_fault_is_seen(self):
        self.finish(["a", "b", "a"])
        (self.out / ".etendue").mkdir()
        (self.out / ".etendue" / "mutex").write_text("")
        self.write("b", exr(pixels=b"abd"))
        (self.out / "report.json").write_text(json.dumps({"totals": {"rendered": 1, "up_to_date": 0}}))
        result = self.check()
        self.assertEqual((result.identical, result.rendered_twice, result.stray), (1, 1, 1))
        self.assertEqual(len(result.faults), 4)


class ExitStatus(unittest.TestCase):
    def test_a_skipped_part_is_told_from_success(self):
        torture = load_tool("lab/torture")
        for faults, skipped, expected in (([], "", 0), ([], "no tmpfs", NOTHING_FILLED), (["other pixels"], "no tmpfs", 1)):
            folder = tempfile.mkdtemp()
            self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
            output = io.StringIO()
            with mock.patch.object(torture, "torture", return_value=("", faults, skipped)), \
                    mock.patch.object(torture.tempfile, "mkdtemp", return_value=folder), \
                    mock.patch.object(sys, "argv", ["torture", "--program", __file__]), \
                    contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
                self.assertEqual(torture.main(), expected)


class Torture(unittest.TestCase):
    def setUp(self):
        if PROGRAM is None:
            self.skipTest("no program was named")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def small_case(self):
        make_scenes({"cornell-box"}, self.folder / "scenes")
        return Case(self.folder / "scenes/cornell-box", "bdpt", ("--size", "16x12", "--spp", "1024"))

    def faulty(self, before="", after=""):
        path = self.folder / "program"
        path.write_text(FAULTY.format(python=sys.executable, program=PROGRAM, before=before, after=after))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return path

    def test_the_program_withstands_it(self):
        # What it keeps when it fails goes with this test.
        result = subprocess.run([sys.executable, "-B", ROOT / "tools/lab/torture", "--quick", "--program", PROGRAM],
                                capture_output=True, text=True, check=False,
                                env={**os.environ, "TMPDIR": str(self.folder)})
        self.assertIn(result.returncode, (0, NOTHING_FILLED), result.stdout + result.stderr)
        print(result.stdout)
        if result.returncode == NOTHING_FILLED:
            self.skipTest("full disks were not tried: no tmpfs could be mounted")

    def test_other_pixels_are_seen(self):
        case = self.small_case()
        for suffix, place in ((".exr", -1), (".png", -20)):
            with self.subTest(suffix):
                program = self.faulty(after=FLIP_BYTE.format(suffix, place))
                result = torture_case(program, case, 0, self.folder / suffix, random.Random(1))
                self.assertEqual((result.images, result.identical), (1, 0))
                self.assertIn("has other pixels", "".join(result.faults))

    def test_stray_files_are_seen(self):
        program = self.faulty(after='(image.parent / ".image.exr.host-1.tmp").write_text("")')
        result = torture_case(program, self.small_case(), 0, self.folder / "kills", random.Random(1))
        self.assertEqual((result.identical, result.stray), (1, 1))
        self.assertIn("is left", "".join(result.faults))

    def test_damage_that_is_not_noticed_is_seen(self):
        program = self.faulty(before='[path.unlink() for path in image.parent.glob("*.checkpoint*")]')
        result = torture_checkpoints(program, self.small_case(), 1, self.folder / "checkpoints", random.Random(1))
        self.assertIn("exit status 0 with", "".join(result.faults))


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        PROGRAM = Path(sys.argv.pop(1)).resolve()
    result = unittest.main(verbosity=2, exit=False).result
    if result.wasSuccessful() and result.skipped:
        # tools/test lists skips that are worded as GTEST_SKIP() words them.
        print("torture_test: Skipped", *sorted({reason for _, reason in result.skipped}), sep="\n")
    sys.exit(not result.wasSuccessful())
