"""Tests of the blocks of pages that tools write."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / folder) for folder in ("", "lab", "gen")]

from lib.page_blocks import MarkerMissing, with_block, write_blocks  # noqa: E402
from tool_module import load_tool  # noqa: E402

BEGIN, END = "<!-- made by a (tool): x -->", "<!-- end -->"


class Blocks(unittest.TestCase):
    def test_only_what_is_between_the_markers_is_replaced(self):
        page = f"before {BEGIN} old {END} after <!-- other --> kept {END}"
        self.assertEqual(with_block(page, BEGIN, END, "new \\1\n"), page.replace(" old ", "\n\nnew \\1\n\n", 1))

    def test_there_must_be_one_block(self):
        for page in ("", BEGIN, END + BEGIN, 2 * (BEGIN + END)):
            with self.assertRaises(MarkerMissing):
                with_block(page, BEGIN, END, "text")

    def test_a_page_is_written_whole_or_not_at_all(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "page.md"
            file.write_text(f"– {BEGIN} old {END}", encoding="utf-8")
            with self.assertRaisesRegex(MarkerMissing, "page.md: not exactly one pair of markers 'other'"):
                write_blocks(file, [(BEGIN, END, "new"), ("other", END, "new")])
            self.assertEqual(file.read_text(encoding="utf-8"), f"– {BEGIN} old {END}")
            write_blocks(file, [(BEGIN, END, "new")])
            self.assertEqual(file.read_text(encoding="utf-8"), f"– {BEGIN}\n\nnew\n\n{END}")

    def test_every_page_has_the_blocks_of_its_tool(self):
        pages = {"lab/torture": "docs/reliability.md"}
        usual = ("compare-cycles", "measure-lights", "measure-denoising", "measure-fireflies", "measure-bdpt",
                 "measure-adaptive", "torture")
        for name, blocks in {**{f"lab/{name}": [""] for name in usual},
                             "lab/caustics": ["regions", "energy", "images", "pictures"],
                             "lab/farm-model": ["coefficients", "farm"]}.items():
            tool = load_tool(name)
            page = (ROOT / pages[name] if name in pages else tool.PAGE).read_text(encoding="utf-8")
            for block in blocks:
                with self.subTest(tool=name, block=block):
                    with_block(page, tool.BEGIN.format(block), tool.END, "")

    def test_a_tool_ends_with_the_message(self):
        script = "from lib.page_blocks import with_block; with_block('', 'a', 'b', '')"
        done = subprocess.run([sys.executable, "-B", "-c", script], cwd=ROOT / "tools", capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (1, "not exactly one pair of markers 'a' and 'b'\n"))


if __name__ == "__main__":
    unittest.main()
