"""Tests of tools/course: what it reads from the page, its figures, and that it fails where the page is wrong."""

import contextlib
import io
import json
import stat
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from tool_module import load_tool

tool = load_tool("course")


class CourseTest(unittest.TestCase):
    def test_each_step_of_the_page_has_commands_and_figures(self):
        steps = tool.steps_of(tool.PAGE.read_text(encoding="utf-8"))
        self.assertEqual([number for number, _, _ in steps], list(range(1, len(steps) + 1)))
        for number, title, text in steps:
            with self.subTest(step=f"{number}. {title}"):
                self.assertTrue(tool.COMMAND.findall(text))
                self.assertEqual(len(tool.ROW.findall(text)), text.count("\n| `"), "each row of figures is read")
                self.assertTrue(tool.ROW.findall(text))

    def test_pictures_need_oiiotool_before_anything_is_rendered(self):
        said = io.StringIO()
        with tempfile.TemporaryDirectory() as name, mock.patch.object(tool.shutil, "which", return_value=None), \
                mock.patch.object(tool.sys, "argv", ["course", "--pictures", "--program", __file__, "-o", f"{name}/out"]), \
                contextlib.redirect_stderr(said):
            self.assertEqual(tool.main(), 2)
            self.assertFalse(Path(name, "out").exists())
        self.assertIn("openimageio-tools", said.getvalue())

    def test_sizes_are_scaled(self):
        self.assertEqual(tool.scaled("etendue render a --size 640x360 -o b", 4), "etendue render a --size 160x90 -o b")

    def run_step(self, text, script="#!/bin/sh\n"):
        """What is wrong with a step, whose program is `script`, in a folder with a profile."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            program = folder / "etendue"
            program.write_text(script, encoding="utf-8")
            program.chmod(program.stat().st_mode | stat.S_IXUSR)
            kinds = [{"kind": "camera", "nodes_per_ray": 11.5, "triangles_per_ray": 3.0}]
            (folder / "p").mkdir()
            report = {"accelerators": {"measures": [{"name": "bvh", "kinds": kinds}]}}
            (folder / "p/profile.json").write_text(json.dumps(report), encoding="utf-8")
            with contextlib.redirect_stdout(io.StringIO()):
                return list(tool.run_step(text, folder, program, 1))

    def test_figures_hold_or_not(self):
        figure = 'visits("p", "bvh", "camera") - tests("p", "bvh", "camera") * 2'
        step = f"    etendue profile x\n\n| `{figure}` | {{}} | 0.1 |\n"
        self.assertEqual(self.run_step(step.format("5.55")), [])
        self.assertIn("is 5.5, but the page says 5.7", self.run_step(step.format("5.7"))[0])

    def test_places_are_shares_of_the_image(self):
        figures = tool.Figures(Path("."))
        figures.read_channels = lambda path: (160, 80, None, None)
        # Red is the column, green the row, blue nothing.
        red = [column for _ in range(80) for column in range(160)]
        green = [row for row in range(80) for _ in range(160)]
        figures.images["a.exr", ""] = red + green + [0] * (160 * 80)
        self.assertAlmostEqual(figures.at("a.exr", 0.25, 0.5), (39.5 + 39.5) / 3)
        self.assertAlmostEqual(figures.at("a.exr", 0.75, 0.25), (119.5 + 19.5) / 3)

    def test_rays_are_those_of_the_render(self):
        with tempfile.TemporaryDirectory() as name:
            (Path(name) / "a.json").write_text('{"rays": {"camera": 3, "total": 7}}', encoding="utf-8")
            self.assertEqual(tool.Figures(Path(name)).value('rays("a.exr") / 2'), 3.5)

    def test_slopes_are_those_of_the_comparison(self):
        with tempfile.TemporaryDirectory() as name:
            (Path(name) / "c").mkdir()
            variants = [{"name": "even", "slopes": {"relmse": {"spp": -1.5}}}, {"name": "random", "slopes": {"relmse": {"spp": -1}}}]
            (Path(name) / "c/report.json").write_text(json.dumps({"variants": variants}), encoding="utf-8")
            self.assertEqual(tool.Figures(Path(name)).value('slope("c", "even") - slope("c", "random")'), -0.5)

    def test_a_command_that_fails_is_told(self):
        self.assertIn("ended with 3", self.run_step("    etendue render x\n", "#!/bin/sh\nexit 3\n")[0])


if __name__ == "__main__":
    unittest.main()
