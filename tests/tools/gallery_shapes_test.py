"""Tests of the gallery: its bodies are closed, as large as they should be and face outwards; each scene has its place on the page."""

import collections
import contextlib
import io
import math
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools/gen")]

from scenegen.gallery import SCENES  # noqa: E402
from scenegen.gallery.shapes import refined, rounded_box, surface, tube  # noqa: E402
from scenegen.mesh import revolved, smooth_outline  # noqa: E402
from scenegen.scenes.caustic_glasses import GOBLET  # noqa: E402
from scenegen.vector import cross, dot, sub  # noqa: E402
from tool_module import load_tool  # noqa: E402


def triangles(mesh):
    """Corners and their normals of each triangle; places are rounded, since edges have vertices of their own."""
    places = [tuple(round(c, 6) + 0.0 for c in mesh.positions[3 * i:3 * i + 3]) for i in range(mesh.vertex_count)]
    normals = [tuple(mesh.normals[3 * i:3 * i + 3]) for i in range(mesh.vertex_count)]
    for i in range(0, len(mesh.indices), 3):
        corners = mesh.indices[i:i + 3]
        yield [places[k] for k in corners], [normals[k] for k in corners]


class ShapesTest(unittest.TestCase):
    def check(self, mesh, volume, tolerance):
        edges, total = collections.Counter(), 0.0
        for (a, b, c), normals in triangles(mesh):
            for start, end in ((a, b), (b, c), (c, a)):
                edges[start, end] += 1
                edges[end, start] -= 1
            total += dot(a, cross(b, c)) / 6.0
            face = cross(sub(b, a), sub(c, a))
            if dot(face, face) > 1e-14:
                self.assertTrue(all(dot(face, normal) > 0.0 for normal in normals))
        self.assertFalse([edge for edge, count in edges.items() if count and edge[0] != edge[1]])
        self.assertAlmostEqual(total, volume, delta=tolerance * volume)

    def test_a_rounded_box(self):
        r, (x, y, z) = 0.1, (0.8, 1.8, 2.8)
        volume = x * y * z + 2.0 * r * (x * y + y * z + z * x) + math.pi * r * r * (x + y + z) + 4.0 / 3.0 * math.pi * r ** 3
        self.check(rounded_box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0), r, 6), volume, 0.002)

    def test_a_tube(self):
        path = [(math.cos(0.1 * i), 0.02 * i, math.sin(0.1 * i)) for i in range(30)]
        length = sum(math.dist(a, b) for a, b in zip(path, path[1:]))
        self.check(tube(path, 0.1, 32), math.pi * 0.01 * length + 4.0 / 3.0 * math.pi * 0.001, 0.02)

    def test_a_closed_tube(self):
        circle = [(math.cos(2.0 * math.pi * i / 96), 0.0, math.sin(2.0 * math.pi * i / 96)) for i in range(96)]
        self.check(tube(circle, 0.2, 48, closed=True), 2.0 * math.pi ** 2 * 0.04, 0.01)

    def test_a_sphere_as_a_surface(self):
        def place(s, t):
            return (math.sin(math.pi * t) * math.sin(2.0 * math.pi * s), -math.cos(math.pi * t),
                    math.sin(math.pi * t) * math.cos(2.0 * math.pi * s))

        self.check(surface(place, 96, 48, wrap_columns=True), 4.0 / 3.0 * math.pi, 0.01)

    def test_a_refined_path_goes_through_its_points_and_keeps_lines(self):
        points = [(0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (2.0, 4.0, 0.0), (3.0, 6.0, 0.0), (5.0, 1.0, 2.0)]
        path = refined(points, 4)
        self.assertEqual(path[::4], points)
        for x, y, z in path[4:9]:
            self.assertAlmostEqual(y, 2.0 * x)
            self.assertEqual(z, 0.0)

    def test_a_smooth_outline_is_exact_at_its_points(self):
        points, _ = smooth_outline(GOBLET, 4)
        for (radius, height), (r, h) in zip(points[::4], GOBLET):
            self.assertAlmostEqual(radius, r, places=9)
            self.assertAlmostEqual(height, h, places=9)
        self.assertGreater(revolved(*smooth_outline(GOBLET, 4), 16).triangle_count, 0)


class PageTest(unittest.TestCase):
    def test_every_scene_is_a_picture(self):
        self.assertEqual(sorted(load_tool("gallery").GALLERY), sorted(SCENES))

    def test_pictures_need_oiiotool_before_anything_is_rendered(self):
        gallery, said = load_tool("gallery"), io.StringIO()
        with tempfile.TemporaryDirectory() as name, mock.patch.object(gallery.shutil, "which", return_value=None), \
                mock.patch.object(gallery.sys, "argv", ["gallery", "glasses", "-o", f"{name}/out"]), \
                mock.patch.object(gallery, "make", side_effect=AssertionError), contextlib.redirect_stderr(said):
            with self.assertRaises(SystemExit) as end:
                gallery.main()
            self.assertEqual(end.exception.code, 2)
            self.assertFalse(Path(name, "out").exists())
        self.assertIn("openimageio-tools", said.getvalue())


if __name__ == "__main__":
    unittest.main()
