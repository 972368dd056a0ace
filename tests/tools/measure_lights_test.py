"""Tests of what tools/lab/measure-lights refuses, and of what its figures are made of."""

import contextlib
import io
import json
import tempfile
import unittest
from pathlib import Path

from tool_module import load_tool

tool = load_tool("lab/measure-lights")


class Arguments(unittest.TestCase):
    def refused(self, words, message):
        output = io.StringIO()
        with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(output):
            tool.parsed_arguments(words)
        self.assertEqual(end.exception.code, 2)
        self.assertIn(message, output.getvalue())

    def test_a_program_that_is_missing(self):
        self.refused(["--bin", "/no/such/folder"], "/no/such/folder/etendue is missing")

    def test_numbers_of_lights(self):
        for counts in ("0", "-3", "ten", "10,", "10,10", ""):
            self.refused([f"--counts={counts}"], "is not a list of different numbers from 1 on")

    def test_a_part_of_the_table_is_not_written(self):
        self.refused(["--write", "--counts", "10,100"], "--write is for the whole table")

    def test_numbers_that_no_difference_can_be_taken_of(self):
        for words in (["--spp", "1"], ["--seeds", "0"], ["--threads", "0"]):
            self.refused(words, "have to be positive, --spp 2 or more")

    def test_counts_are_in_their_order(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "etendue").touch()
            self.assertEqual(tool.parsed_arguments(["--bin", folder, "--counts", "100,1"]).counts, [100, 1])
            self.assertEqual(tool.parsed_arguments(["--bin", folder, "--write"]).counts, list(tool.COUNTS))


class Halls(unittest.TestCase):
    def nodes_with(self, kind, key):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "hall.glb"
            tool.write_hall(path, 7, kind)
            data = path.read_bytes()
        length = int.from_bytes(data[12:16], "little")
        document = json.loads(data[20:20 + length])
        light = {"lamps": lambda node: node.get("mesh") == 2, "points": lambda node: "extensions" in node}[kind]
        return [node[key] for node in document["nodes"] if light(node)]

    def test_both_kinds_of_light_are_at_the_same_places(self):
        lamps = self.nodes_with("lamps", "translation")
        self.assertEqual(len(lamps), 7)
        self.assertEqual(lamps, self.nodes_with("points", "translation"))


class Costs(unittest.TestCase):
    def test_what_every_render_costs_once_drops_out(self):
        self.assertAlmostEqual(tool.seconds_of_samples({4: 5.0 + 4 * 0.1, 16: 5.0 + 16 * 0.1}), 1.6)
        self.assertIsNone(tool.seconds_of_samples({4: 1.0, 16: 1.0}))

    def test_there_are_always_fewer_samples(self):
        for spp in range(2, 20):
            self.assertIn(tool.few_samples(spp), range(1, spp))

    def test_costs_are_against_the_first(self):
        rows = {("points", "tree", "path"): [(10, 0.02, 1.0), (100, 0.04, 3.0), (1000, 0.04, None)]}
        self.assertEqual(tool.table(rows).splitlines()[2:], ["| points | tree | `path` | 0.0200 | 1.00 | 6.00 | – |"])


if __name__ == "__main__":
    unittest.main()
