"""Tests of what tools/compare-cycles does outside of Blender: what it carries over and refuses, its images, its lobes."""

import json
import math
import struct
import sys
import tempfile
import unittest
import zlib
from array import array
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from cycles import lobes  # noqa: E402
from cycles.images import average, mean_colors, read_rgb, relative_difference  # noqa: E402
from cycles.instancing import without_instancing  # noqa: E402
from cycles.plan import NotComparable, make_plan  # noqa: E402

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
        self.assertEqual((plan["max_bounces"], plan["roulette_bounces"]), (14, 3))
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
