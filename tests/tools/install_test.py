"""install_test.py BUILD SOURCE CXX: installs BUILD, uses what is installed as others do, and removes it again."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from docs_test import dead_links

BUILD, SOURCE, CXX = (Path(argument) for argument in sys.argv[1:4])
PUBLIC = re.compile(r"(\w+ for )?etendue::(Scene|Picture|Error|render|version)\b")


def run(*command, **options):
    """What the command prints; fails with that if it fails."""
    result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True, check=False, **options)
    if result.returncode != 0:
        raise AssertionError(f"{command} ended with {result.returncode}:\n{result.stdout}")
    return result.stdout


def files_below(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_symlink() or path.is_file()}


class InstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="etendue-install-"))
        # What somebody has installed from this build folder can be uninstalled after the test, too.
        cls.kept = {path: path.read_bytes() for path in BUILD.glob("install_manifest*.txt")}
        cls.prefix = cls.folder / "prefix"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)

    @classmethod
    def tearDownClass(cls):
        for path in BUILD.glob("install_manifest*.txt"):
            path.unlink()
        for path, content in cls.kept.items():
            path.write_bytes(content)
        shutil.rmtree(cls.folder)

    def test_everything_is_in_its_place(self):
        files = files_below(self.prefix)
        for file in ("bin/etendue", "include/etendue/etendue.h", "share/man/man1/etendue.1",
                     "share/man/man1/etendue-render.1", "share/bash-completion/completions/etendue",
                     "share/zsh/site-functions/_etendue", "share/fish/vendor_completions.d/etendue.fish",
                     "share/etendue/config.ocio", "share/etendue/blender/etendue/__init__.py",
                     "share/etendue/blender/etendue/blender_manifest.toml", "share/etendue/scenes/render.schema.json",
                     "share/etendue/scenes/cornell-box/scene.gltf", "share/etendue/scenes/cornell-box/scene.bin",
                     "share/doc/etendue/README.md", "share/doc/etendue/docs/render-json.md",
                     "share/doc/etendue/examples/render_scene.cpp", "share/doc/etendue/examples/glass_of_water.py"):
            self.assertIn(file, files)
        for pattern in (r"lib(/[\w-]+)?/libetendue\.so\.\d+\.\d+\.\d+", r"lib(/[\w-]+)?/libetendue\.so",
                        r"lib(/[\w-]+)?/cmake/Etendue/EtendueConfig(Version)?\.cmake",
                        r"share/etendue/blender/etendue-blender-\d+\.\d+\.\d+\.zip"):
            self.assertTrue(any(re.fullmatch(pattern, file) for file in files), pattern)
        self.assertFalse([file for file in files if file.endswith((".a", "CMakeLists.txt")) and "examples" not in file])

    def test_links_of_installed_pages_lead_somewhere(self):
        dead = dead_links((self.prefix / "share/doc/etendue").resolve())
        # Sources are not installed.
        self.assertEqual([line for line in dead if not re.search(r": (\.\./)?src/", line)], [])

    def test_the_installed_program_renders_an_installed_scene(self):
        scene = self.prefix / "share/etendue/scenes/cornell-box"
        run(self.prefix / "bin/etendue", "render", scene, "--size", "8x6", "--spp", "1", "-o", self.folder / "box.exr")
        self.assertTrue((self.folder / "box.exr").is_file())

    def test_headers_stand_alone_and_bring_nothing_along(self):
        include = self.prefix / "include"
        headers = sorted((include / "etendue").glob("*.h"))
        self.assertEqual(len(headers), 6)
        for header in headers:
            alone = self.folder / "alone.cpp"
            alone.write_text(f"#include <etendue/{header.name}>\n")
            run(CXX, "-std=c++20", "-Wall", "-Wextra", "-Werror", "-I", include, "-fsyntax-only", alone)
            # What the standard library's headers include is theirs.
            for included in re.findall(r"^\s*#\s*include\s*(\S+)", header.read_text(), re.MULTILINE):
                self.assertRegex(included, r'^("etendue/\w+\.h"|<etendue/\w+\.h>|<[a-z_]+>)$', header)
        source = self.folder / "all.cpp"
        source.write_text("".join(f"#include <etendue/{header.name}>\n" for header in reversed(headers)))
        run(CXX, "-std=c++20", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-I", include, "-fsyntax-only", source)

    def test_the_library_shows_its_interface_only(self):
        library = next(self.prefix.glob("lib/**/libetendue.so"))
        symbols = run("nm", "--dynamic", "--demangle", "--defined-only", library).splitlines()
        strong = [line.split(maxsplit=2)[2] for line in symbols if line.split()[1] in "TDBR"]
        self.assertTrue(any("etendue::render(" in name for name in strong))
        self.assertEqual([name for name in strong if not PUBLIC.match(name)], [])

    def test_the_example_renders_what_the_program_renders(self):
        build = self.folder / "example"
        run("cmake", "-G", "Ninja", "-S", self.prefix / "share/doc/etendue/examples", "-B", build,
            f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={CXX}")
        run("cmake", "--build", build)
        scene = self.folder / "box"
        shutil.copytree(self.prefix / "share/etendue/scenes/cornell-box", scene)
        (scene / "render.json").write_text('{"size": [16, 12]}')
        output = run(build / "render_scene", scene, self.folder / "library.exr")
        self.assertIn("100%", output)
        self.assertIn("layer depth", output)
        self.assertRegex(output, r"16 x 12 pixels, brightness 0\.\d*[1-9]")
        program = self.prefix / "bin/etendue"
        run(program, "render", scene, "--spp", "16", "--aov", "depth", "-o", self.folder / "program.exr")
        run(program, "diff", self.folder / "library.exr", self.folder / "program.exr", "--metric", "mse", "--fail-above", "mse=0")
        failed = subprocess.run([build / "render_scene", self.folder / "nowhere", "a.exr"], capture_output=True,
                                text=True, check=False)
        self.assertEqual(failed.returncode, 3)
        self.assertIn("nowhere", failed.stderr)

    def test_uninstalling_leaves_nothing(self):
        root = self.folder / "root"
        environment = {**os.environ, "DESTDIR": str(root)}
        run("cmake", "--install", BUILD, "--prefix", "/usr", env=environment)
        (root / "usr/share/etendue/mine").mkdir()
        self.assertGreater(len(files_below(root)), 100)
        run("cmake", "-D", f"build={BUILD}", "-P", SOURCE / "cmake/uninstall.cmake", env=environment)
        self.assertEqual(files_below(root), set())
        ours = [path for path in root.rglob("*") if "tendue" in path.name]
        self.assertEqual(ours, [root / "usr/share/etendue"], "which somebody else's folder is in")
        self.assertTrue((root / "usr/share/etendue/mine").is_dir())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
