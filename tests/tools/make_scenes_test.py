"""Tests of tools/gen/make_scenes.py: the scenes are right, and each check sees what it is for."""

import math
import struct
import sys
import unittest
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / folder) for folder in ("", "lab", "gen")]

from scenegen import check, images, mesh, noise, patterns, sky, spectra, vector  # noqa: E402
from scenegen.gltf import GltfWriter  # noqa: E402
from scenegen.scenes import SCENES, caustic_mirror, caustic_prism, cornell_box, veach_mis  # noqa: E402


def rotate(quaternion, v):
    x, y, z, w = quaternion
    twice = vector.scale(vector.cross((x, y, z), v), 2.0)
    return vector.add(vector.add(v, vector.scale(twice, w)), vector.cross((x, y, z), twice))


class Scenes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scenes = {name: build() for name, build in SCENES.items()}

    def document(self, name):
        return self.scenes[name].gltf.finish()[0]

    def test_every_scene_passes_its_checks(self):
        for name, scene in self.scenes.items():
            with self.subTest(name):
                settings = (ROOT / "scenes" / name / "render.json").read_text()
                self.assertEqual(check.check_scene(scene, settings), [])

    def test_every_scene_is_documented_and_built_by_cmake(self):
        cmake = (ROOT / "scenes" / "CMakeLists.txt").read_text()
        for name, scene in self.scenes.items():
            with self.subTest(name):
                self.assertTrue((ROOT / "scenes" / name / "README.md").is_file())
                extra = [f for f in scene.contents() if f not in ("scene.gltf", "scene.bin")]
                self.assertIn(f"etendue_scene({' '.join([name, *extra])})", cmake)

    def test_generating_twice_gives_the_same_bytes(self):
        for name in ("cornell-glass", "sun-and-sky", "ajar-door", "many-lights"):
            self.assertEqual(self.scenes[name].contents(), SCENES[name]().contents())

    def test_objects_have_names_of_their_own(self):
        for name in self.scenes:
            names = [mesh["name"] for mesh in self.document(name)["meshes"]]
            self.assertEqual(len(names), len(set(names)), name)

    def test_cornell_box_has_red_left_and_green_right(self):
        document = self.document("cornell-box")
        camera = next(node for node in document["nodes"] if "camera" in node)
        right = rotate(camera["rotation"], (1.0, 0.0, 0.0))
        red, green = (document["accessors"][document["meshes"][document_mesh(document, name)]["primitives"][0]
                      ["attributes"]["POSITION"]]["min"] for name in ("red wall", "green wall"))
        side = [vector.dot(vector.sub(p, camera["translation"]), right) for p in (red, green)]
        self.assertLess(side[0], 0.0)
        self.assertGreater(side[1], 0.0)

    def test_veach_plates_mirror_the_lights_into_the_camera(self):
        for _, center, _ in veach_mis.PLATES:
            plate = veach_mis._plate((0.0, *center))
            normal = tuple(plate.normals[:3])
            incoming = vector.normalize((0.0, *center))
            mirrored = vector.sub(incoming, vector.scale(normal, 2.0 * vector.dot(incoming, normal)))
            to_camera = vector.normalize(vector.sub(veach_mis.CAMERA_POSITION, (0.0, *center)))
            for a, b in zip(mirrored, to_camera):
                self.assertAlmostEqual(a, b, places=5)

    def test_instances_are_ten_thousand_of_fifty_thousand_triangles(self):
        document = self.document("instances")
        knot = document_mesh(document, "knot")
        self.assertEqual(sum(node.get("mesh") == knot for node in document["nodes"]), 10_000)
        indices = document["meshes"][knot]["primitives"][0]["indices"]
        self.assertEqual(document["accessors"][indices]["count"], 3 * 50_000)

    def test_many_lights_are_ten_thousand(self):
        document = self.document("many-lights")
        translations = [node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"]
                        for node in document["nodes"] if "extensions" in node]
        self.assertEqual(sum(document["accessors"][i]["count"] for i in translations), 10_000)

    def test_all_light_of_the_reflector_meets_its_dish(self):
        rim = caustic_mirror._dish(1.0)[1]
        self.assertGreater(rim, caustic_mirror.LAMP_HEIGHT + 0.01)

    def test_light_passes_the_prism_parallel_to_its_base(self):
        # Snell's law at the face by which it enters: the normal is 30 degrees off the base's direction, and so is the
        # refracted ray, on its other side.
        normal = vector.normalize((-math.cos(math.radians(30.0)), 0.0, math.sin(math.radians(30.0))))
        sine = math.sin(math.acos(-vector.dot(caustic_prism.TO_PRISM, normal)))
        self.assertAlmostEqual(sine, caustic_prism.INDEX * math.sin(math.radians(30.0)))


def document_mesh(document, name):
    return next(i for i, m in enumerate(document["meshes"]) if m["name"] == name)


class Checks(unittest.TestCase):
    """Each breaks one thing in a good scene."""

    def setUp(self):
        writer = GltfWriter()
        self.ball = mesh.sphere(1.0, 3)
        writer.add_node("ball", mesh=writer.add_mesh("ball", self.ball, writer.add_material("clay")))
        writer.add_camera("camera", (0.0, 0.0, 3.0), [0.0, 0.0, 0.0, 1.0], 0.5, 1.0)
        self.document, self.binary = writer.finish()

    def mesh_problems(self):
        return check.check_meshes(self.document, self.binary, {"ball"})

    def test_good(self):
        self.assertEqual(check.check_buffers(self.document, self.binary), [])
        self.assertEqual(check.check_nodes(self.document), [])
        self.assertEqual(self.mesh_problems(), [])

    def test_wrong_bounds(self):
        self.document["accessors"][0]["min"][1] -= 1e-3
        self.assertRegex(str(check.check_buffers(self.document, self.binary)), "accessor 0 states wrong bounds")

    def test_short_buffer(self):
        self.assertRegex(str(check.check_buffers(self.document, self.binary[:-4])), "leaves the buffer")

    def test_flipped_triangle(self):
        self.swap_indices(0, 1)
        self.assertRegex(str(self.mesh_problems()), "1 triangles wind against")

    def test_missing_triangle(self):
        self.document["accessors"][2]["count"] -= 3
        self.document["bufferViews"][2]["byteLength"] -= 6
        self.assertEqual(check.check_buffers(self.document, self.binary), [])
        self.assertRegex(str(self.mesh_problems()), "edges are not watertight")

    def test_degenerate_triangle(self):
        view = self.document["bufferViews"][2]
        start = view["byteOffset"]
        self.binary = self.binary[:start] + 2 * self.binary[start:start + 2] + self.binary[start + 4:]
        self.assertRegex(str(self.mesh_problems()), "1 triangles have no area")

    def test_long_normal(self):
        start = self.document["bufferViews"][1]["byteOffset"]
        self.binary = self.binary[:start] + struct.pack("<3f", 0.0, 2.0, 0.0) + self.binary[start + 12:]
        self.assertRegex(str(self.mesh_problems()), "1 normals are not of unit length")

    def test_rotation_that_is_no_rotation(self):
        self.document["nodes"][1]["rotation"] = [0.0, 0.0, 0.0, 1.1]
        self.assertRegex(str(check.check_nodes(self.document)), "no unit quaternion")

    def test_render_json(self):
        expected = {"/materials/clay/diffuse/albedo": [0.25, 0.5, 0.75]}

        def problems(text):
            return str(check.check_render_json(self.document, expected, text))

        def with_green(value):
            return '{"materials": {"clay": {"diffuse": {"albedo": [0.25, %s, 0.75]}}}}' % value

        self.assertEqual(problems(with_green("0.50003")), "[]")
        self.assertRegex(problems(with_green("0.501")), "not \\[0.25")
        self.assertRegex(problems('{}'), "has null at /materials/clay")
        self.assertRegex(problems('{"materials": {"caly": {}}}'), "'caly', which is no material")
        self.assertRegex(problems('{'), "no JSON")

    def swap_indices(self, a, b):
        start = self.document["bufferViews"][2]["byteOffset"]
        data = bytearray(self.binary)
        for k in range(2):
            i, j = start + 2 * a + k, start + 2 * b + k
            data[i], data[j] = data[j], data[i]
        self.binary = bytes(data)


class Meshes(unittest.TestCase):
    def problems(self, body):
        positions = [body.position(i) for i in range(body.vertex_count)]
        normals, triangles = check._triples(body.normals), check._triples(body.indices)
        return check.check_normals(positions, normals, triangles, 1e-5) + check.check_watertight(positions, triangles)

    def test_bodies_are_closed_and_face_outwards(self):
        bodies = {
            "box": mesh.box((-1.0, 0.0, 2.0), (1.0, 0.5, 3.0)),
            "extrusion": mesh.extrusion(((0.0, 1.0), (1.0, -1.0), (0.0, -1.5), (-1.0, -1.0)), 0.5, 2.0),
            "ring": mesh.ring(1.0, 0.1, 0.5, segments=24, arc_steps=4),
            "wavy block": mesh.wavy_block((-1.0, -1.0, -2.0), (1.0, 2.0), 8, 12, self.wave),
            "ball": mesh.revolved(*mesh.sampled_profile(self.meridian, 12), 24),
        }
        for name, body in bodies.items():
            with self.subTest(name):
                self.assertEqual(self.problems(body), [])
                self.assertGreater(volume(body), 0.0)

    def test_ring_is_as_high_and_as_wide_as_asked(self):
        body = mesh.ring(1.0, 0.1, 0.5, segments=24, arc_steps=4)
        heights = body.positions[1::3]
        radii = [math.hypot(x, z) for x, _, z in check._triples(body.positions)]
        for found, expected in ((min(heights), 0.0), (max(heights), 0.5), (min(radii), 0.9), (max(radii), 1.1)):
            self.assertAlmostEqual(found, expected, places=6)

    def test_wall_is_its_rectangle_without_the_openings(self):
        openings = [((0.5, 0.0), (1.5, 2.0)), ((2.0, 1.0), (2.5, 1.5))]
        piece = mesh.wall((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 3.0, 0.0), openings, uv_per_meter=2.0)
        self.assertAlmostEqual(area(piece), 12.0 - 2.0 - 0.25, places=5)
        # Whole in texture coordinates too.
        for i, (x, y, _) in enumerate(check._triples(piece.positions)):
            self.assertAlmostEqual(piece.uvs[2 * i], 2.0 * x, places=5)
            self.assertAlmostEqual(piece.uvs[2 * i + 1], -2.0 * y, places=5)

    @staticmethod
    def wave(x, z):
        return 0.1 * math.sin(3.0 * x + z), 0.3 * math.cos(3.0 * x + z), 0.1 * math.cos(3.0 * x + z)

    @staticmethod
    def meridian(t):
        angle = math.pi * t
        return max(0.0, math.sin(angle)), -math.cos(angle), math.cos(angle), math.sin(angle)


def corners(body):
    for triangle in check._triples(body.indices):
        yield [body.position(i) for i in triangle]


def area(body):
    return sum(0.5 * vector.length(vector.cross(vector.sub(b, a), vector.sub(c, a))) for a, b, c in corners(body))


def volume(body):
    """Of a closed body, negative if it is inside out."""
    return sum(vector.dot(a, vector.cross(b, c)) / 6.0 for a, b, c in corners(body))


class Colors(unittest.TestCase):
    def test_perfect_and_half_reflector(self):
        for value in (1.0, 0.5):
            for c in spectra.reflectance_to_rec709({400: value, 700: value}):
                self.assertAlmostEqual(c, value, places=12)

    def test_d65_is_white(self):
        # Rec.709's white, to what the fitted matching functions and the range up to 700 nm allow.
        red, green, blue = spectra.to_rec709(spectra.integrate_xyz(spectra.interpolated(spectra.D65)))
        self.assertAlmostEqual(red / green, 1.0, delta=0.02)
        self.assertAlmostEqual(blue / green, 1.0, delta=0.02)

    def test_cornell_walls_have_their_colors(self):
        red, green = (spectra.reflectance_to_rec709(s) for s in (cornell_box.RED, cornell_box.GREEN))
        self.assertGreater(red[0], 5.0 * max(red[1:]))
        self.assertGreater(green[1], 4.0 * max(green[0], green[2]))

    def test_daylight_is_as_bright_as_daylight(self):
        day = sky.Sky(math.radians(60.0), 0.0, 3.0, unit=1.0, ground_albedo=(0.0, 0.0, 0.0))
        sun = spectra.luminance(day.sun_irradiance)
        self.assertTrue(80.0 < sun < 110.0, f"direct normal illuminance of a high sun in clear air: {sun} klx")
        around = spectra.luminance(day._sky_irradiance())
        self.assertTrue(10.0 < around < 40.0, f"illuminance by a clear sky: {around} klx")

    def test_sky_is_bluer_away_from_the_sun(self):
        day = sky.Sky(math.radians(30.0), 0.0, 3.0, unit=1.0, ground_albedo=(0.2, 0.2, 0.2))
        away = day.radiance(vector.direction(math.radians(60.0), math.pi))
        toward = day.radiance(vector.direction(math.radians(35.0), 0.0))
        self.assertGreater(away[2], 1.5 * away[0])
        self.assertGreater(spectra.luminance(toward), 3.0 * spectra.luminance(away))


class Images(unittest.TestCase):
    def test_png_has_its_pixels(self):
        data = images.png(2, 1, bytes([1, 2, 3, 4, 5, 6]))
        start = data.index(b"IDAT") + 4
        self.assertEqual(zlib.decompress(data[start:data.index(b"IEND") - 8]), bytes([0, 1, 2, 3, 4, 5, 6]))

    def test_linear_png_is_encoded(self):
        data = images.linear_png(2, 1, lambda u, v: (u, 0.0, 1.0))
        start = data.index(b"IDAT") + 4
        expected = [0, images.to_srgb_byte(0.25), 0, 255, images.to_srgb_byte(0.75), 0, 255]
        self.assertEqual(zlib.decompress(data[start:data.index(b"IEND") - 8]), bytes(expected))

    def test_noise_repeats(self):
        for x, y in ((0.3, 1.7), (3.9, 0.0), (2.0, 2.99)):
            self.assertAlmostEqual(noise.periodic(x, y, 4, 3), noise.periodic(x + 4.0, y + 3.0, 4, 3))

    def test_noise_is_spread_evenly(self):
        values = [noise.hashed(i % 50, i // 50) for i in range(2500)]
        self.assertAlmostEqual(sum(values) / 2500, 0.5, delta=0.02)
        self.assertTrue(0.0 <= min(values) < 0.01 and 0.99 < max(values) < 1.0)

    def test_checker_begins_with_its_first_grey(self):
        data = patterns.checker(0.0, 1.0, 2, 2)
        start = data.index(b"IDAT") + 4
        rows = zlib.decompress(data[start:data.index(b"IEND") - 8])
        self.assertEqual(rows, bytes([0, 0, 0, 0, 255, 255, 255, 0, 255, 255, 255, 0, 0, 0]))

    def test_exr_has_its_pixels_as_blue_green_red_rows(self):
        pixels = [float(i) for i in range(2 * 2 * 3)]
        data = images.exr(2, 2, pixels)
        self.assertEqual(data[:4], bytes([0x76, 0x2F, 0x31, 0x01]))
        second_line = struct.unpack("<ii6e", data[-20:])
        self.assertEqual(second_line, (1, 12, 8.0, 11.0, 7.0, 10.0, 6.0, 9.0))
        offset = struct.unpack("<Q", data[-48:-40])[0]
        self.assertEqual(data[offset:offset + 8], struct.pack("<ii", 1, 12))

    def test_middle_of_an_environment_is_towards_minus_z(self):
        pixels = images.latitude_longitude(64, 32, lambda toward: toward)
        right_of_middle = 3 * (64 * 16 + 32)
        x, y, z = pixels[right_of_middle:right_of_middle + 3]
        self.assertLess(z, -0.99)
        self.assertGreater(x, 0.0)
        self.assertLess(y, 0.0)


class Rotations(unittest.TestCase):
    def test_look_at_turns_minus_z(self):
        for target in ((1.0, 2.0, 3.0), (-4.0, 0.5, 0.1), (0.0, -1.0, -9.0), (0.1, 0.0, 5.0)):
            turned = rotate(vector.look_at((0.0, 0.0, 0.0), target), (0.0, 0.0, -1.0))
            for a, b in zip(turned, vector.normalize(target)):
                self.assertAlmostEqual(a, b)

    def test_standing_on_turns_plus_y(self):
        for normal in ((0.0, 1.0, 0.0), (0.6, 0.8, 0.0), (1.0, 0.0, 0.0)):
            for turn in (0.0, 1.0, 4.0):
                turned = rotate(vector.standing_on(normal, turn), (0.0, 1.0, 0.0))
                for a, b in zip(turned, normal):
                    self.assertAlmostEqual(a, b)


if __name__ == "__main__":
    unittest.main()
