"""Tests of tools/gen/make_material_rows.py: the rows are right, and their spheres and images are what they say."""

import json
import math
import sys
import unittest
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / folder) for folder in ("", "lab", "gen")]

from scenegen import check, mesh, vector  # noqa: E402
from scenegen.rows import ROWS, textures  # noqa: E402

# All of materials that are read.
MATERIAL_EXTENSIONS = {
    "anisotropy", "clearcoat", "diffuse_transmission", "dispersion", "emissive_strength", "ior", "iridescence",
    "sheen", "specular", "transmission", "unlit", "variants", "volume", "volume_scatter"}
OTHER_EXTENSIONS = {
    "EXT_lights_ies", "EXT_lights_image_based", "EXT_mesh_gpu_instancing", "EXT_meshopt_compression",
    "EXT_texture_webp", "KHR_animation_pointer", "KHR_draco_mesh_compression", "KHR_lights_punctual",
    "KHR_mesh_quantization", "KHR_node_visibility", "KHR_texture_transform"}


class Rows(unittest.TestCase):
    def test_every_row_passes_the_checks_of_scenes(self):
        for name, build in ROWS.items():
            with self.subTest(name):
                scene = build()
                self.assertEqual(check.check_scene(scene, scene.files["render.json"].decode()), [])

    def test_generating_twice_gives_the_same_bytes(self):
        for name, build in ROWS.items():
            with self.subTest(name):
                self.assertEqual(build().contents(), build().contents())

    def test_every_material_extension_has_a_row(self):
        used = set()
        for build in ROWS.values():
            used.update(json.loads(build().contents()["scene.gltf"]).get("extensionsUsed", []))
        self.assertEqual(used, {f"KHR_materials_{name}" for name in MATERIAL_EXTENSIONS} | OTHER_EXTENSIONS)


class MappedSphere(unittest.TestCase):
    def setUp(self):
        self.ball = mesh.mapped_sphere(2.0, columns=16, rows=8)

    def vertices(self):
        for i in range(self.ball.vertex_count):
            yield (self.ball.position(i), tuple(self.ball.normals[3 * i:3 * i + 3]),
                   tuple(self.ball.tangents[4 * i:4 * i + 4]), tuple(self.ball.uvs[2 * i:2 * i + 2]))

    def test_middle_of_the_image_is_in_front_and_its_top_above(self):
        for position, _, _, (u, v) in self.vertices():
            self.assertAlmostEqual(position[1], 2.0 * math.cos(math.pi * v), places=5)
            if (u, v) == (0.5, 0.5):
                self.assertAlmostEqual(position[2], 2.0, places=5)
            if (u, v) == (0.75, 0.5):
                self.assertAlmostEqual(position[0], 2.0, places=5)

    def test_tangents_lie_along_u_and_bitangents_towards_the_top(self):
        for position, normal, (*tangent, handedness), _ in self.vertices():
            self.assertAlmostEqual(vector.dot(tangent, normal), 0.0, places=6)
            self.assertAlmostEqual(vector.length(tangent), 1.0, places=6)
            around = vector.cross((0.0, 1.0, 0.0), position)
            self.assertGreaterEqual(vector.dot(tangent, around), 0.0)
            self.assertGreaterEqual(handedness * vector.cross(normal, tangent)[1], 0.0)

    def test_poles_have_no_triangles_without_area(self):
        self.assertEqual(self.ball.triangle_count, 2 * 16 * (8 - 1))


class Textures(unittest.TestCase):
    def test_ramp_rises_over_the_front_in_the_named_channel_alone(self):
        for channel in "RGBA":
            texels = pixels_of_png(textures.channel(channel), 4 if channel == "A" else 3)
            left, right = texels[textures.WIDTH // 4], texels[3 * textures.WIDTH // 4]
            for i, (a, b) in enumerate(zip(left, right)):
                if i == "RGBA".index(channel):
                    self.assertTrue(a < 5 and b > 250, channel)
                else:
                    self.assertTrue(a > 250 and b < 5, channel)

    def test_waves_are_unit_normals(self):
        for texel in pixels_of_png(textures.waves(), 3):
            self.assertAlmostEqual(vector.length([c / 127.5 - 1.0 for c in texel]), 1.0, delta=0.02)


def pixels_of_png(data, channels):
    """The pixels row by row, of an image without filters."""
    start = data.index(b"IDAT") + 4
    rows = zlib.decompress(data[start:data.index(b"IEND") - 8])
    stride = channels * textures.WIDTH + 1
    values = b"".join(rows[stride * y + 1:stride * (y + 1)] for y in range(textures.HEIGHT))
    return [values[i:i + channels] for i in range(0, len(values), channels)]


if __name__ == "__main__":
    unittest.main()
