"""Tests of what tools/lab/compare-cycles does outside of Blender: what it carries over and refuses, its images, its lobes."""

import io
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import types
import unittest
import zlib
from array import array
from contextlib import redirect_stdout
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / folder) for folder in ("", "lab", "gen")]

from cycles import lobes  # noqa: E402
from cycles.height_field import make_height_field  # noqa: E402
from cycles.images import average, mean_colors, read_rgb, relative_difference  # noqa: E402
from cycles.instancing import without_instancing  # noqa: E402
from cycles.plan import NotComparable, make_plan  # noqa: E402
from tool_module import load_tool  # noqa: E402

tool = load_tool("lab/compare-cycles")

METALS = (ROOT / "src/bsdf/measured_metals.cpp").read_text()
WHITE = {"name": "white", "pbrMetallicRoughness": {"metallicFactor": 0.0}}
CAMERA = {"name": "camera", "type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}


def zip_exr(width, height, channels):
    """An EXR as Etendue and Blender write them; `channels` has rows of floats by name."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    names = sorted(channels)
    header = bytes((0x76, 0x2F, 0x31, 0x01, 2, 0, 0, 0)) + b"".join((
        attribute("channels", "chlist",
                  b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in names) + b"\0"),
        attribute("compression", "compression", b"\3"),
        attribute("dataWindow", "box2i", struct.pack("<4i", 0, 0, width - 1, height - 1)))) + b"\0"
    blocks = []
    for first in range(0, height, 16):
        raw = b"".join(struct.pack(f"<{width}f", *channels[name][width * y:width * (y + 1)])
                       for y in range(first, min(height, first + 16)) for name in names)
        halves = raw[0::2] + raw[1::2]
        coded = halves[:1] + bytes((b - a + 128) & 255 for a, b in zip(halves, halves[1:]))
        coded = zlib.compress(coded)
        block = coded if len(coded) < len(raw) else raw
        blocks.append(struct.pack("<iI", first, len(block)) + block)
    return header + bytes(8 * len(blocks)) + b"".join(blocks)


class Scene(unittest.TestCase):
    def plan(self, settings, document=None):
        document = document or {}
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            (folder / "render.json").write_text(json.dumps(settings))
            (folder / "scene.gltf").write_text(json.dumps({"materials": [WHITE], "cameras": [CAMERA], **document}))
            return make_plan(folder, [8, 8], METALS)

    def refused(self, settings, document, reason):
        with self.assertRaisesRegex(NotComparable, reason):
            self.plan({"environment": {}, **settings}, document)


class CarriedOver(Scene):
    def test_edges_of_a_path_are_two_more_than_bounces(self):
        plan = self.plan({"integrator": {"max_depth": 16}, "environment": {}})
        self.assertEqual((plan["max_bounces"], plan["roulette_bounces"]), (14, 1))
        self.assertEqual(self.plan({"environment": {}})["max_bounces"], 30)

    def test_environment_and_camera(self):
        plan = self.plan({"environment": {"color": [1, 2, 3], "scale": 4, "rotation": 0.5},
                          "camera": {"position": [1, 2, 3], "look_at": [0, 0, 0]}})
        self.assertEqual(plan["environment"], {"image": None, "color": [1, 2, 3], "scale": 4, "rotation": 0.5,
                                               "visible": True})
        self.assertEqual((plan["camera"]["position"], plan["camera"]["yfov"]), ([1, 2, 3], 0.8))

    def test_overrides_of_materials_win(self):
        plan = self.plan({"materials": {"white": {"diffuse": {"albedo": [0.1, 0.2, 0.3]},
                                                  "emission": {"color": [1, 2, 3], "strength": 2}}}})
        self.assertEqual(plan["materials"]["white"], {"kind": "diffuse", "color": [0.1, 0.2, 0.3],
                                                      "emission": [2, 4, 6], "double_sided": False})

    def test_attenuation_becomes_coefficients(self):
        body = {**WHITE, "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.0},
                "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_volume": {
                    "thicknessFactor": 1.0, "attenuationColor": [0.5, 1.0, 0.25], "attenuationDistance": 2.0}}}
        coefficients = self.plan({"environment": {}}, {"materials": [body]})["materials"]["white"]["absorption"]
        for value, expected in zip(coefficients, (0.5 * math.log(2), 0.0, math.log(2))):
            self.assertAlmostEqual(value, expected)

    def test_lights_enter_one_to_one(self):
        lamps = {"extensions": {"KHR_lights_punctual": {"lights": [
            {"name": "a", "type": "point", "intensity": 3}, {"name": "b", "type": "directional"}]}}}
        plan = self.plan({"lights": {"a": {"scale": 2}, "b": {"enabled": False}}}, lamps)
        self.assertEqual([plan["lights"][name]["intensity"] for name in "ab"], [6, 0])


    def test_the_height_field_is_a_scene_that_can_be_compared(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder) / "field"
            make_height_field(folder, 100)
            plan = make_plan(folder, [8, 8], METALS)
            document = json.loads((folder / "scene.gltf").read_text())
            triangles = document["accessors"][document["meshes"][0]["primitives"][0]["indices"]]["count"] // 3
            self.assertEqual(triangles, 98, "two of each of 49 cells")
            self.assertEqual((folder / "scene.bin").stat().st_size, document["buffers"][0]["byteLength"])
            self.assertEqual(sorted(file.name for file in folder.iterdir()), ["render.json", "scene.bin", "scene.gltf"])
        self.assertEqual((plan["materials"]["ground"]["kind"], plan["camera"]["name"], plan["max_bounces"]),
                         ("diffuse", "camera", 14))


class Refused(Scene):
    def test_settings(self):
        for settings, reason in (({"clamp_indirect": 1}, "clamp_indirect"), ({"lens_radius": 0.1}, "lens_radius"),
                                 ({"light_units": "radiometric"}, "light_units"), ({"shutter": [0, 1]}, "shutter"),
                                 ({"integrator": {"min_depth": 3}}, "min_depth"), ({"integrator": {"max_depth": 1}}, "emission"),
                                 ({"camera": {"position": [0] * 3, "look_at": [1] * 3, "type": "orthographic"}}, "orthog"),
                                 ({"camera": "other"}, "no such camera"),
                                 ({"materials": {"white": {"diffuse": {"roughness": 0.5}}}}, "rough facets"),
                                 ({"materials": {"white": {"dielectric": {"roughness": 0.5}}}}, "rough glass"),
                                 ({"materials": {"white": {"dielectric": {"dispersion": 1}}}}, "dispersion"),
                                 ({"materials": {"white": {"subsurface": {}}}}, "walks at random")):
            with self.subTest(settings=settings):
                self.refused(settings, {}, reason)

    def test_files(self):
        thin = {"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1.0}}}
        for change, reason in (({"alphaMode": "BLEND"}, "transparent"), ({"normalTexture": {}}, "normals"),
                               ({"extensions": {"KHR_materials_sheen": {}}}, "KHR_materials_sheen"), (thin, "thin"),
                               ({"pbrMetallicRoughness": {"metallicFactor": 0.5}}, "half a metal")):
            with self.subTest(change=change):
                self.refused({}, {"materials": [{**WHITE, **change}]}, reason)
        self.refused({}, {"animations": [{}]}, "animated")
        self.refused({}, {"extensionsRequired": ["EXT_meshopt_compression"]}, "EXT_meshopt_compression")
        self.refused({}, {"cameras": []}, "camera")

    def test_the_light_that_etendue_adds(self):
        with self.assertRaisesRegex(NotComparable, "no light"):
            self.plan({})


class Images(unittest.TestCase):
    def test_reads_and_averages(self):
        width, height = 5, 19  # two blocks, the second not full
        rows = {name: [place + x * factor for x in range(width * height)]
                for place, (name, factor) in enumerate((("R", 0.5), ("G", 0.25), ("B", 2.0), ("A", 0.0)))}
        flat = {name: [float(place)] * (width * height) for place, name in enumerate("RGB")}
        with tempfile.TemporaryDirectory() as folder:
            files = [Path(folder) / name for name in ("a.exr", "b.exr")]
            for file, channels in zip(files, (rows, flat)):
                file.write_bytes(zip_exr(width, height, channels))
            self.assertEqual(read_rgb(files[0]), (width, height, array(
                "f", (value for pixel in zip(rows["R"], rows["G"], rows["B"]) for value in pixel))))
            self.assertEqual(mean_colors(files[1]), [0.0, 1.0, 2.0])
            _, _, mean = average(files)
            self.assertEqual(list(mean[3:6]), [0.25, 1.125, 3.0])

    def test_difference_is_relative_to_the_reference(self):
        with tempfile.TemporaryDirectory() as folder:
            files = [Path(folder) / f"{value}.exr" for value in (3.0, 1.0)]
            for file in files:
                file.write_bytes(zip_exr(2, 2, {name: [float(file.stem)] * 4 for name in "RGB"}))
            # r is 2: 4 / 4.01.
            self.assertAlmostEqual(relative_difference(*files[:2], files[:2]), 4.0 / 4.01, delta=1e-5)

    def test_refuses_other_files(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "a.exr"
            file.write_bytes(zip_exr(2, 2, {name: [0.0] * 4 for name in "RGB"}).replace(
                b"compression\0compression\0\1\0\0\0\3", b"compression\0compression\0\1\0\0\0\2"))
            with self.assertRaisesRegex(ValueError, "compressed by ZIP"):
                read_rgb(file)


class Instances(unittest.TestCase):
    def test_become_nodes(self):
        extension = "EXT_mesh_gpu_instancing"
        document = {"extensionsUsed": [extension], "nodes": [{"mesh": 0, "name": "all", "extensions": {
            extension: {"attributes": {"TRANSLATION": 0, "SCALE": 1}}}}], "buffers": [{"uri": "scene.bin"}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0}, {"buffer": 0, "byteOffset": 24}],
            "accessors": [{"bufferView": view, "componentType": 5126, "count": 2} for view in (0, 1)]}
        with tempfile.TemporaryDirectory() as folder:
            gltf, output = Path(folder) / "scene.gltf", Path(folder) / "out.gltf"
            gltf.write_text(json.dumps(document))
            (Path(folder) / "scene.bin").write_bytes(struct.pack("<12f", 1, 2, 3, 4, 5, 6, *(1,) * 3, *(2,) * 3))
            self.assertEqual(without_instancing(gltf, output), output)
            nodes = json.loads(output.read_text())["nodes"]
        self.assertEqual(nodes[0], {"name": "all", "extensions": {}, "children": [1, 2]})
        self.assertEqual(nodes[1:], [{"mesh": 0, "translation": [1, 2, 3], "scale": [1, 1, 1]},
                                     {"mesh": 0, "translation": [4, 5, 6], "scale": [2, 2, 2]}])


class Comparisons(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.directory = self.folder / "scenes/box"
        self.directory.mkdir(parents=True)
        (self.directory / "render.json").write_text('{"environment": {}}')
        (self.directory / "scene.gltf").write_text(json.dumps({"materials": [WHITE], "cameras": [CAMERA]}))
        self.program = self.folder / "etendue"
        self.program.write_text("one")
        self.arguments = types.SimpleNamespace(
            scenes_folder=self.folder / "scenes", shrink=1.0, threads=1, roulette="same", work=self.folder / "work",
            program=self.program, blender="Blender 3.4", timeout=5.0, effort=1.0, length=4, seeds=2, scenes=["box"])

    def keys(self):
        comparison = tool.Comparison(self.arguments, "box")
        return comparison.cycles.key, comparison.ours[0].key

    def test_renders_are_known_again_only_of_the_same_program_plan_and_scene(self):
        cycles, ours = self.keys()
        self.assertEqual(self.keys(), (cycles, ours))
        self.program.write_text("two")
        self.assertEqual(self.keys()[0], cycles, "it takes no part in that")
        self.assertNotEqual(self.keys()[1], ours)
        self.program.write_text("one")
        (self.directory / "texture.png").write_text("red")
        changed = self.keys()
        self.assertTrue(changed[0] != cycles and changed[1] != ours)
        (self.directory / "texture.png").write_text("blue")
        self.assertTrue(self.keys()[0] != changed[0] and self.keys()[1] != changed[1])
        cycles = self.keys()[0]
        self.arguments.blender = "Blender 4.0"
        self.assertNotEqual(self.keys()[0], cycles)
        self.arguments.blender = "Blender 3.4"
        (self.directory / "render.json").write_text('{"environment": {"scale": 2}}')
        self.assertNotEqual(self.keys()[0], cycles)

    def renders_of(self, spp_of, renderer_keys, programs):
        """Of which numbers of samples an image had to be rendered, for one key of its renderer and program after the other."""
        renders = []

        def render(image, spp, seed):
            renders.append((spp, seed))
            image.touch()
            return 0.5
        for key, program in zip(renderer_keys, programs):
            self.program.write_text(program)
            comparison = tool.Comparison(self.arguments, "box")
            renderer = types.SimpleNamespace(name="cycles", key=key, render=render)
            self.assertEqual(comparison.image(renderer, spp_of(comparison), 1)[1], 0.5)
        return [spp for spp, _ in renders]

    def test_a_long_image_is_rendered_once_for_each_key_of_its_renderer(self):
        many = tool.Comparison(self.arguments, "box").many
        self.assertEqual(self.renders_of(lambda c: c.many, "aaba", ["one", "two", "two", "one"]), [many] * 2)

    def test_times_are_of_one_run_of_both_programs(self):
        spp = tool.Comparison(self.arguments, "box").spp
        self.assertEqual(self.renders_of(lambda c: c.spp, "aaaa", ["one", "one", "two", "one"]), [spp] * 2)

    def test_a_scene_that_is_missing_leaves_the_others(self):
        self.arguments.scenes = ["missing", "box"]
        said = []
        with mock.patch.object(tool.Comparison, "measure", lambda _: {"cycles": self.result(), "path": self.result()}), \
                mock.patch.object(tool.Row, "cells", lambda row: [row.comparison.name]), \
                mock.patch.object(tool.Row, "objection", lambda _: ""):
            rows, not_comparable, failed = tool.compare_all(self.arguments, said.append)
        self.assertEqual([row.comparison.name for row in rows], ["box"])
        self.assertEqual((not_comparable, list(failed)), ({}, ["missing"]))
        self.assertIn("scene.gltf is missing", failed["missing"])

    def result(self, seconds=0.1):
        return tool.Result(seconds, [[0.4, 0.2], [0.1, 0.05]], math.log(4), tool.StartUp(1.5, 0.25))

    def row(self, **seconds):
        comparison = types.SimpleNamespace(name="box", size=[8, 4], means=[[1.0] * 3, [1.01, 1.0, 1.0]], deviation=0.001,
                                           apart=[0.1, 0.01], spp=64, scene=tool.Scene((8, 4), "bdpt" in seconds))
        return tool.Row(comparison, {name: self.result(value) for name, value in seconds.items()})

    def test_a_time_that_is_lost_in_noise_is_a_dash(self):
        for seconds in (0.0, -0.1):
            cells = self.row(cycles=0.1, path=seconds, bdpt=seconds).path_row()
            self.assertEqual(cells[2:4], ["–", "–"])
            self.assertEqual(cells[4:6], ["–", "–"])
            self.assertEqual(self.row(cycles=0.1, path=0.1, bdpt=seconds).caustic_row("bdpt")[1::2], ["–", "–"])
            self.assertEqual(self.row(cycles=seconds, path=0.1).path_row()[3], "–")

    def test_the_document_has_what_the_tables_have(self):
        document = json.loads(json.dumps(self.row(cycles=0.1, path=0.05, bdpt=-1.0).document(), allow_nan=False))
        self.assertAlmostEqual(document["renderers"]["path"]["samples_per_second"], 640.0)
        self.assertAlmostEqual(document["renderers"]["path"]["relmse"]["time_to_equal_error"], 0.5)
        self.assertAlmostEqual(document["renderers"]["path"]["relmse"]["exponent"], 1.0)
        self.assertAlmostEqual(document["difference_of_means"], 0.01)
        self.assertIsNone(document["objection"])
        self.assertEqual(document["renderers"]["path"]["start_up_seconds"], {"load": 1.5, "rest": 0.25})
        self.assertIsNone(document["renderers"]["bdpt"]["samples_per_second"])
        self.assertIsNone(document["renderers"]["bdpt"]["relmse"]["time_to_equal_error"])

    def test_images_are_compared_only_where_their_means_agree(self):
        for mean, deviation, objection in ((1.0199, 0.001, ""), (1.03, 0.001, "not comparable"), (0.97, 0.001, "not comparable"),
                                           (1.03, 0.02, "too noisy to say"), (1.05, 0.02, "not comparable")):
            with self.subTest(mean=mean, deviation=deviation):
                row = self.row(cycles=0.1, path=0.05)
                row.comparison.means[1], row.comparison.deviation = [1.0, mean, 1.0], deviation
                self.assertEqual(row.objection(), objection)
                self.assertEqual(row.verdict("path", 0), objection or "0.50")

    def test_scenes_that_are_not_comparable_make_it_fail_and_noise_does_not(self):
        for mean, deviation, code in ((1.01, 0.001, 0), (1.03, 0.02, 0), (1.03, 0.001, 1)):
            row = self.row(cycles=0.1, path=0.05)
            row.comparison.means[1], row.comparison.deviation = [mean] * 3, deviation
            with mock.patch.object(sys, "argv", ["compare-cycles", "--bin", str(self.folder), "box"]), \
                    mock.patch.object(tool, "install_blender"), mock.patch.object(tool, "run", lambda _: "Blender"), \
                    mock.patch.object(tool, "compare_all", lambda *_: ([row], {}, {})), \
                    mock.patch.object(tool, "tables", lambda _: ""), redirect_stdout(io.StringIO()):
                self.assertEqual(tool.main(), code, f"{mean} ± {deviation}")

    def test_start_up_is_measured_once_for_each_pair_of_programs(self):
        starts = []

        def start(image):
            starts.append(image)
            return tool.StartUp(2.0, 1.0)
        for program in ("one", "one", "two"):
            self.program.write_text(program)
            comparison = tool.Comparison(self.arguments, "box")
            self.assertEqual(comparison.start_up(types.SimpleNamespace(name="cycles", start=start)).total(), 3.0)
        self.assertEqual(len(starts), 2)

    def test_an_aim_is_that_of_the_worst_scene(self):
        rows = [self.row(cycles=0.1, path=0.03), self.row(cycles=0.1, path=0.08), self.row(cycles=0.1, path=-1.0)]
        for row, name in zip(rows, ("box", "ring", "lost in noise")):
            row.comparison.name = name
        path, bdpt, vcm = tool.aims_table(rows).splitlines()[2:]
        self.assertIn("| 0.800 | **not met** | 1 of 2 scenes; not ring 0.80 |", path)
        self.assertIn("not measured", bdpt)
        self.assertIn("not measured", vcm)
        self.assertIn("| 0.300 | met | 1 of 1 scenes |", tool.aims_table(rows[:1]))

    def test_json_is_all_that_stands_on_stdout(self):
        output = io.StringIO()
        with mock.patch.object(sys, "argv", ["compare-cycles", "--json", "--bin", str(self.folder), "missing"]), \
                mock.patch.object(tool, "install_blender"), mock.patch.object(tool, "run", lambda _: "Blender"), \
                redirect_stdout(output):
            self.assertEqual(tool.main(), 1)
        document = json.loads(output.getvalue())
        self.assertEqual((document["scenes"], list(document["failed"])), ([], ["missing"]))

    def blender(self, script, timeout=0.2):
        """One that has been started and does as a shell is told; its answers go to the descriptor 3."""
        log = self.folder / "blender.log"
        log.write_text("the last words\n")
        cycles = tool.Cycles(self.folder / "plan.json", log, timeout)
        read, write = os.pipe()
        cycles.process = subprocess.Popen(["bash", "-c", f"exec 3>&{write}; {script}"], stdin=subprocess.PIPE, text=True,
                                          pass_fds=[write])
        os.close(write)
        cycles.answers = os.fdopen(read)
        self.addCleanup(cycles.answers.close)
        return cycles

    def test_a_blender_that_hangs_is_ended(self):
        cycles = self.blender("exec sleep 60")
        with self.assertRaisesRegex(tool.Failed, "longer than 0.2 seconds .*\n?the last words"):
            cycles.order(self.folder / "a.exr", 1, 1)
        cycles.stop()
        self.assertEqual(cycles.process.returncode, -9)
        cycles = self.blender("exec sleep 60")
        cycles.stop()
        self.assertEqual(cycles.process.returncode, -9)

    def test_a_blender_that_ends_is_told_of(self):
        cycles = self.blender("exit 3", 5.0)
        cycles.process.wait()
        with self.assertRaisesRegex(tool.Failed, "Blender ended; .*\n?the last words"):
            cycles.order(self.folder / "a.exr", 1, 1)
        cycles.stop()

    def test_answers_are_read(self):
        cycles = self.blender("""read order; echo '{"cpu": 1.5}' >&3""", 5.0)
        self.assertEqual(cycles.order(self.folder / "a.exr", 1, 1), 1.5)
        cycles.stop()


class Lobes(unittest.TestCase):
    def test_white_metal_reflects_everything(self):
        for alpha in (0.0, 0.1, 1.0):
            for _, *color in lobes.reflected(lobes.schlick([1.0] * 3), alpha):
                for channel in color:
                    self.assertAlmostEqual(channel, 1.0, delta=1e-6)

    def test_smooth_surface_reflects_its_fresnel_term(self):
        rows = lobes.reflected(lobes.schlick([0.04] * 3), 0.0)
        self.assertAlmostEqual(rows[0][1], 0.04)
        self.assertAlmostEqual(rows[-1][1], 1.0)

    def test_gold_is_gold(self):
        gold = lobes.metal(lobes.optical_constants(METALS, "Au"))
        # S. Lagarde's published colour, with the tolerance of tests/bsdf/measured_metals_test.cpp.
        for channel, expected in zip(gold(1.0), (1.0, 0.766, 0.336)):
            self.assertAlmostEqual(channel, expected, delta=0.04)
        self.assertAlmostEqual(gold(0.0)[2], 1.0, delta=1e-6)

    def test_brewster_angle(self):
        # Glass of index n: one half of the light is not reflected, the amplitude of the other by (n² - 1) / (n² + 1).
        reflected = lobes.fresnel_conductor(1.0 / math.sqrt(1.0 + 1.5 ** 2), complex(1.5, 0.0))
        self.assertAlmostEqual(reflected, 0.5 * ((1.5 ** 2 - 1.0) / (1.5 ** 2 + 1.0)) ** 2)

    def test_all_metals_are_found(self):
        for symbol in ("Ag", "Al", "Au", "Cr", "Cu", "Fe", "Ti", "W"):
            self.assertGreater(len(lobes.optical_constants(METALS, symbol)), 10)


if __name__ == "__main__":
    unittest.main()
