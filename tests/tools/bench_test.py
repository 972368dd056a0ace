"""Tests of what tools/lab/bench does with its measurements: laws through them, tables, plots, the page, the aims; and of the
scenes that it has generated."""

import io
import json
import math
import os
import re
import struct
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree as xml
from contextlib import redirect_stderr
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tools/lab"), str(ROOT / "tests/bench")]

from benchmark import aims, curves, layers, machine, standard, threads  # noqa: E402
from benchmark.fit import last_exponent, power_law, straight_line  # noqa: E402
from benchmark.plots import (DotRow, Panel, Series, curve_plot, dot_plot, linear_ticks, log_ticks,  # noqa: E402
                             tick_text)
from benchmark.tables import count_text, exponent_text, figure, markers, table  # noqa: E402
from lib.page_blocks import with_block  # noqa: E402
from make_large_glb import write_glb  # noqa: E402
from tool_module import load_tool  # noqa: E402

tool = load_tool("lab/bench")

SVG = "{http://www.w3.org/2000/svg}"


def render(cpu, samples=100, rays=300):
    return {"load": 0.5, "build": 0.25, "bvh": 0.125, "cpu": cpu, "samples": samples, "rays": rays, "peak": 2_000_000,
            "triangles": 8}


def run(integrator, thread_count, seconds, efficiency):
    return {"integrator": integrator, "threads": thread_count, "spp": 1, "samples": 1_000_000, "seconds": seconds,
            "cpu_seconds": [thread_count * each for each in seconds], "samples_per_second": 1e6 / seconds[0],
            "rays_per_second": 3e6 / seconds[0], "efficiency_single": efficiency, "efficiency_best": efficiency / 2,
            "parallel_efficiency": 0.97, "tracing_share": 0.5, "peak": 2_000_000}


def profile(efficiency):
    runs = [run(integrator, count, [2.0 / count, 2.2 / count, 2.4 / count], efficiency)
            for integrator in standard.INTEGRATORS for count in (1, 2)]
    return {"program": "Etendue", "scene": {"width": 16, "height": 8}, "machine": {"processors": 2},
            "bvh": {"triangles": 1234, "instances": 3, "build_seconds": 0.002, "triangles_per_second": 617_000},
            "first_pixel": 0.125, "peak": 3_000_000, "notes": [], "runs": runs, "materials": 13, "textures": 6}


class Fit(unittest.TestCase):
    def test_a_line_is_found_again(self):
        slope, height = straight_line([0, 1, 4], [3.0, 5.0, 11.0])
        self.assertAlmostEqual(slope, 2.0)
        self.assertAlmostEqual(height, 3.0)

    def test_a_line_has_the_least_squares(self):
        # By the normal equations: slope 0.5, height 1/6.
        slope, height = straight_line([0, 1, 2], [0.0, 1.0, 1.0])
        self.assertAlmostEqual(slope, 0.5)
        self.assertAlmostEqual(height, 1.0 / 6.0)

    def test_a_power_law_is_found_again(self):
        xs = [10, 100, 1000]
        exponent, factor = power_law(xs, [7.0 * x ** 1.5 for x in xs])
        self.assertAlmostEqual(exponent, 1.5)
        self.assertAlmostEqual(factor, 7.0)

    def test_no_law_goes_through_zeros_or_through_one_place(self):
        self.assertIsNone(power_law([1, 2], [0.0, 1.0]))
        self.assertIsNone(power_law([0, 2], [1.0, 1.0]))
        self.assertIsNone(power_law([2, 2], [1.0, 3.0]))
        self.assertIsNone(power_law([2], [1.0]))

    def test_the_exponent_is_that_of_the_largest(self):
        points = [(1000, 1000.0), (1, 40.0), (100, 100.0), (10, 40.0), (10_000, 10_000.0)]
        self.assertAlmostEqual(last_exponent(points), 1.0)

    def test_three_points_have_to_be_known(self):
        self.assertIsNone(last_exponent([(1, 1.0), (2, 2.0), (4, None)]))
        self.assertAlmostEqual(last_exponent([(1, 1.0), (2, 2.0), (4, 4.0), (8, None)]), 1.0)


class Tables(unittest.TestCase):
    def test_figures_have_so_many_digits(self):
        for value, text in ((0.012345, "0.0123"), (1.5, "1.50"), (9.996, "10.0"), (123.4, "123"), (1234.5, "1,230"),
                            (0, "0"), (None, "–"), (-0.5, "-0.500")):
            self.assertEqual(figure(value), text)
        self.assertEqual(figure(0.666, 2), "0.67")

    def test_large_powers_of_ten_are_written_as_such(self):
        self.assertEqual([count_text(n) for n in (1, 1000, 10_000, 10 ** 7, 20_000, 10_100)],
                         ["1", "1,000", "10⁴", "10⁷", "20,000", "10,100"])

    def test_exponents_have_no_minus_before_zero(self):
        self.assertEqual([exponent_text(k) for k in (-0.001, -0.25, 1.0, None)], ["0.00", "−0.25", "1.00", "–"])

    def test_a_table_says_which_columns_are_words(self):
        self.assertEqual(table(["a", "b", "c"], [["x", "1", "y"]], words=(0, 2)),
                         "| a | b | c |\n|---|---:|---|\n| x | 1 | y |")

    def test_the_page_has_every_block(self):
        page = (ROOT / "docs/performance.md").read_text(encoding="utf-8")
        for block in ("aims", "standard", "growth"):
            with_block(page, *markers(block), "")


class Drawn(unittest.TestCase):
    def drawn(self, svg):
        """The document, which has a title, a description, and nothing outside of its page."""
        root = xml.fromstring(svg)
        self.assertEqual(root.tag, SVG + "svg")
        self.assertTrue(root.find(SVG + "title").text and root.find(SVG + "desc").text)
        width, height = float(root.get("width")), float(root.get("height"))
        for at in root.iter(SVG + "text"):
            # Half of a text in the middle of its place; figures are about 7 wide.
            half = 3.5 * len(at.text or "") if at.get("text-anchor") == "middle" else 0.0
            self.assertTrue(half <= float(at.get("x")) <= width - half and 0 <= float(at.get("y")) <= height, at.text)
        return root


class Plots(Drawn):
    def test_ticks_hold_all_values(self):
        for low, high in ((1.0, 1.0), (0.3, 0.31), (2e-5, 7.0), (150.0, 1400.0), (10.0, 1e7), (0.9, 1.1), (1e-9, 1e9)):
            ticks = log_ticks(low, high)
            self.assertTrue(ticks[0] <= low * (1 + 1e-9) and high * (1 - 1e-9) <= ticks[-1], (low, high, ticks))
            self.assertTrue(2 <= len(ticks) <= 9, ticks)
            self.assertEqual(ticks, sorted(set(ticks)))
        for high in (0.0, 0.07, 1.0, 1.01, 40, 363.0):
            ticks = linear_ticks(high)
            self.assertTrue(ticks[0] == 0.0 and ticks[-1] >= high and 2 <= len(ticks) <= 6, ticks)

    def test_ticks_are_short(self):
        self.assertEqual([tick_text(v) for v in (0, 0.001, 0.0001, 0.5, 2, 1000, 1e5, 2e5, 2e-5)],
                         ["0", "0.001", "10⁻⁴", "0.5", "2", "1,000", "10⁵", "2·10⁵", "2·10⁻⁵"])

    def test_curves_are_well_formed(self):
        series = [Series(f"a < b & {i}", [(10, 1.0), (100, 2.0 + i), (1000, 4.0)], 0.3) for i in range(4)]
        for panels in ([Panel("s", "N", series)], [Panel("s", "N", series), Panel("s & t", "N", series, False, False)]):
            root = self.drawn(curve_plot("1 < 2", panels))
            self.assertEqual(len(root.findall(SVG + "polyline")), 4 * len(panels))

    def test_points_of_a_logarithmic_line_are_evenly_spaced(self):
        line = self.drawn(curve_plot("t", [Panel("s", "N", [Series("a", [(1, 1.0), (10, 10.0), (100, 100.0)])])]))
        places = [tuple(map(float, point.split(","))) for point in line.find(SVG + "polyline").get("points").split()]
        self.assertAlmostEqual(places[1][0] - places[0][0], places[2][0] - places[1][0], delta=0.11)
        self.assertAlmostEqual(places[0][1] - places[1][1], places[1][1] - places[2][1], delta=0.11)
        self.assertGreater(places[0][1], places[2][1])

    def test_dots_are_well_formed_and_what_is_not_known_is_left_out(self):
        rows = [DotRow("a&b", [0.5, 0.25]), DotRow("c", [None, 1.0])]
        root = self.drawn(dot_plot("dots", [("left", rows, False), ("right", rows, True)], ("path", "bdpt")))
        self.assertEqual(len(root.findall(SVG + "circle")), 1 + 2)  # the legend, and one in each panel

    def test_light_and_dark_have_the_same_classes(self):
        svg = curve_plot("t", [Panel("s", "N", [Series("a", [(1, 1.0), (2, 2.0)])])])
        light, dark = re.search(r"<style>(.*?)@media \(prefers-color-scheme: dark\) \{(.*?)</style>", svg, re.S).groups()
        colored = {line.split("{")[0].strip() for line in light.splitlines() if "#" in line and ".m" not in line}
        self.assertTrue(colored <= {line.split("{")[0].strip() for line in dark.splitlines() if "#" in line}, colored)


class Curves(Drawn):
    def data(self, *costs):
        return {"turns": 2, "points": {str(10 ** (3 + i)): {"path": [render(2.0 * cost), render(cost)]}
                                       for i, cost in enumerate(costs)}}

    def test_the_least_time_of_the_turns_counts(self):
        self.assertEqual(curves.fastest(self.data(0.5))[1000]["path"]["cpu"], 0.5)

    def test_the_table_has_the_ends_of_each_curve_and_the_exponents(self):
        lines = curves.growth_table({"triangles": self.data(0.001, 0.002, 0.02, 0.2)}).splitlines()
        self.assertEqual(lines[2:], ["| triangles | `path` | 1,000 to 10⁶ | 10.0 to 2,000 | 1.00 | 2.00 to 2.00 | 0.00 |"])

    def test_layers_have_the_slope_over_the_value_without(self):
        points = {n: {name: [render(1.0 + 0.02 * n)] for name in standard.INTEGRATORS} for n in layers.SETS}
        lines = curves.growth_table({"aovs": {"turns": 1, "points": points}}).splitlines()
        self.assertEqual([line.split(" | ")[4] for line in lines[2:]], ["+2.0% each", "+2.0% each"])

    def test_every_curve_can_be_drawn(self):
        for curve in curves.CURVES:
            points = {x: {variant: [render(1.0 + x)] for variant in curve.variants} for x in curve.points}
            root = self.drawn(curves.plot(curve, {"turns": 1, "points": points}))
            self.assertEqual(len(root.findall(SVG + "polyline")), len(curve.columns))

    def test_sets_of_layers_are_as_large_as_they_say(self):
        self.assertEqual({count: sum(10 if name == "passes" else 1 for name in names)
                          for count, names in layers.SETS.items()}, {count: count for count in layers.SETS})


class Standard(unittest.TestCase):
    def test_tables(self):
        scenes = {"room": profile(0.7)}
        self.assertEqual(standard.standard_table(scenes, [1, 2]).splitlines()[-1],
                         "| room | 1,234 | 0.125 | 3.00 | 1.00 | 0.70 | 1.00 | 0.70 |")
        self.assertEqual(standard.standard_table(scenes, [1]).splitlines()[-1],
                         "| room | 1,234 | 0.125 | 3.00 | 0.500 | 0.70 | 0.500 | 0.70 |")
        xml.fromstring(standard.plot(scenes, [1, 2]))

    def test_the_table_is_narrow(self):
        head = standard.standard_table({"caustic-mirror": profile(0.7)}, [1, 2]).splitlines()
        self.assertTrue(all(len(line) <= 100 for line in head), head)

    def test_thread_counts(self):
        self.assertEqual([threads.thread_counts(n) for n in (1, 2, 6, 8)], [[1], [1, 2], [1, 2, 4, 6], [1, 2, 4, 8]])
        self.assertEqual([standard.thread_counts(n) for n in (1, 6)], [[1], [1, 6]])

    def test_speed_ups_are_of_pairs(self):
        data = profile(0.7)
        data["runs"][1]["seconds"] = [1.0, 2.0, 1.2]
        self.assertEqual([round(value, 3) for value in threads.speed_ups(data, "path", 2)], [1.1, 2.0, 2.0])
        self.assertEqual(threads.speed_ups(data, "path", 4), [])
        self.assertEqual(threads.speed_up_text([1.1, 2.0, 2.0]), "2.00, 1.10 to 2.00")


class Aims(unittest.TestCase):
    def rows(self, results):
        return [[cell.strip() for cell in line.strip("|").split("|")] for line in aims.aims_table(results).splitlines()[2:]]

    def test_what_was_not_measured_is_not_met(self):
        self.assertEqual({row[3] for row in self.rows({})}, {"not measured"})

    def test_bounds(self):
        cost = {10 ** 5: 1.0, 10 ** 7: 3.1}
        results = {"standard/cornell-box": profile(0.6), "standard/glossy-interior": profile(0.44),
                   "standard/caustic-glass": profile(0.61), "threads": profile(0.6),
                   "start": {"first_pixel": [0.1, 0.5, 0.15], "width": 8, "height": 8},
                   "triangles": {"turns": 1, "points": {n: {"path": [render(c)]} for n, c in cost.items()}}}
        rows = self.rows(results)
        self.assertEqual([row[3] for row in rows],
                         ["met", "**not met**", "**not met**", "met", "met", "**not met**", "met"])
        self.assertEqual([row[2] for row in rows], ["0.600", "0.600", "0.440", "0.610", "2.00", "3.10", "0.150"])
        self.assertIn("13 materials, 6 textures", rows[2][4])


class Known(unittest.TestCase):
    def test_results_are_known_again_only_of_the_same_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            for name in ("cornell-box", "room"):
                (folder / name).mkdir()
                (folder / name / "scene.gltf").write_text(name)
            (folder / "etendue").write_text("one")
            arguments = types.SimpleNamespace(program=folder / "etendue", mode=tool.QUICK)

            def known():
                return set(tool.Results(folder / "results.json", tool.identities(arguments, folder)).known())
            results = tool.Results(folder / "results.json", tool.identities(arguments, folder))
            names = {"start", "threads", "standard/room", "standard/cornell-box", "triangles", "depth"}
            for name in names:
                results.add(name, {}, {})
            self.assertEqual(known(), names)
            (folder / "room/scene.gltf").write_text("changed")
            self.assertEqual(known(), names - {"standard/room"})
            (folder / "cornell-box/texture.png").write_text("new")
            self.assertEqual(known(), {"triangles"}, "its scenes are generated")
            (folder / "etendue").write_text("two")
            self.assertEqual(known(), set())

    def test_a_quick_run_is_not_written(self):
        output = io.StringIO()
        with mock.patch.object(sys, "argv", ["bench", "--quick", "--write"]), redirect_stderr(output), \
                self.assertRaises(SystemExit) as end:
            tool.parsed_arguments()
        self.assertEqual(end.exception.code, 2)
        self.assertIn("does not go with --quick", output.getvalue())


class Machine(unittest.TestCase):
    def test_a_watch_counts_what_others_do_and_not_what_it_does_itself(self):
        watch = machine.Watch()
        # Processor time of its own: half a second of it would otherwise look like a processor that others use.
        begin = machine.own_seconds()
        while machine.own_seconds() < begin + 0.5:
            math.sqrt(2.0)
        conditions = watch.conditions()
        self.assertGreaterEqual(conditions["seconds"], 0.49)
        busy = (machine.ticks()[0] - watch.ticks[0]) / os.sysconf("SC_CLK_TCK")
        self.assertLess(conditions["others"] * conditions["seconds"], max(0.05, busy - 0.4))

    def test_conditions_are_weighed_by_time(self):
        text = machine.conditions_text([{"seconds": 1, "load_before": 0.5, "others": 1.0, "withheld": 0.0},
                                        {"seconds": 3, "load_before": 2.0, "others": 0.0, "withheld": 0.4}])
        self.assertIn("before: 0.5 to 2.0.", text)
        self.assertIn("used 0.25 of", text)
        self.assertIn("withheld 0.30.", text)


class LargeGlb(unittest.TestCase):
    def document(self, **what):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.glb"
            write_glb(file, **what)
            data = file.read_bytes()
        self.assertEqual(struct.unpack_from("<I", data, 8)[0], len(data))
        return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])

    def test_instances_fill_a_square_that_the_camera_sees_from_the_same_side(self):
        few, many = self.document(triangles=8, instances=4)["nodes"], self.document(triangles=8, instances=16)["nodes"]
        self.assertEqual([node["translation"] for node in few[:-1]], [[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]])
        self.assertEqual(len(many), 16 + 1)
        self.assertEqual([2 * x for x in few[-1]["translation"]], many[-1]["translation"])

    def test_all_lights_together_are_as_bright_as_one(self):
        for lights in (1, 10, 100):
            document = self.document(triangles=8, lights=lights)
            lamps = [node for node in document["nodes"] if "extensions" in node]
            self.assertEqual(len(lamps), lights)
            intensity = document["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"]
            self.assertAlmostEqual(intensity * lights, 100.0)
            self.assertTrue(all(0 < at < 1 for node in lamps for at in (node["translation"][0], node["translation"][2])))

    def test_without_lights_no_extension_is_used(self):
        self.assertNotIn("extensionsUsed", self.document(triangles=8))


if __name__ == "__main__":
    unittest.main()
