"""Tests of examples/glass_of_water.py, the program of docs/tutorial.md: forty lines, closed bodies, a picture without a warning.

The argument is the program that renders.
"""

import base64
import collections
import json
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/glass_of_water.py"
PROGRAM = sys.argv.pop(1)


class TutorialTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.scene = Path(folder.name) / "glass"
        subprocess.run([sys.executable, "-B", EXAMPLE, self.scene], check=True)

    def triangles(self, mesh):
        """Corners of the triangles of a mesh, as places."""
        document = json.loads((self.scene / "scene.gltf").read_text(encoding="utf-8"))
        data = base64.b64decode(document["buffers"][0]["uri"].split(",", 1)[1])
        primitive = document["meshes"][mesh]["primitives"][0]

        def values(accessor, kind):
            view = document["bufferViews"][document["accessors"][accessor]["bufferView"]]
            return struct.unpack_from(f"<{view['byteLength'] // 4}{kind}", data, view["byteOffset"])

        numbers, indices = values(primitive["attributes"]["POSITION"], "f"), values(primitive["indices"], "I")
        corners = [numbers[3 * i:3 * i + 3] for i in indices]
        return [corners[i:i + 3] for i in range(0, len(corners), 3)]

    def test_it_has_forty_lines(self):
        self.assertLessEqual(len(EXAMPLE.read_text(encoding="utf-8").splitlines()), 40)

    def test_glass_and_water_are_closed_and_face_outwards(self):
        for mesh in (0, 1):
            edges, volume = collections.Counter(), 0.0
            for a, b, c in self.triangles(mesh):
                for start, end in ((a, b), (b, c), (c, a)):
                    edges[start, end] += 1
                    edges[end, start] -= 1
                volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                           + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
            self.assertFalse([edge for edge, count in edges.items() if count])
            self.assertGreater(volume, 5e-5)

    def test_it_renders_without_a_warning(self):
        image = self.scene.parent / "glass.exr"
        result = subprocess.run([PROGRAM, "render", self.scene, "-o", image, "--size", "32x24", "--spp", "2"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("warning", result.stderr)
        self.assertTrue(image.is_file())


if __name__ == "__main__":
    unittest.main()
