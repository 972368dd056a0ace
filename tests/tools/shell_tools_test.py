"""Tests of .ci/run, tools/dev/check and tools/lib/setup.sh with made-up programs in the place of those that they call."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class ShellTools(unittest.TestCase):
    """A checkout of the scripts alone, without packages to install."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name).resolve() / "checkout"
        self.bin = self.root / "bin"
        for script in (".ci/run", "tools/dev/check", "tools/lib/setup.sh", "tools/lib/single_sources.py"):
            (self.root / script).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / script, self.root / script)
        self.file("third_party_config/apt-packages.txt", "[build]\n")

    def file(self, name, text=""):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def program(self, name, body):
        self.file(name, f"#!/bin/sh\n{body}\n").chmod(0o755)

    def run_in_checkout(self, *command):
        """The exit status, and all that was printed."""
        environment = {**os.environ, "PATH": f"{self.bin}:{os.environ['PATH']}", "HOME": str(self.root)}
        result = subprocess.run(command, cwd=self.root, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                text=True, check=False)
        return result.returncode, result.stdout


class ContinuousIntegration(ShellTools):
    def setUp(self):
        super().setUp()
        for name in ("bin/cmake", "tools/dev/check", "tools/test", "tools/ci/test-slurm"):
            self.program(name, "exit 0")
        # git refuses a checkout that belongs to another user in this way.
        self.program("bin/git", "case \"$*\" in *safe.directory=\\**) exit 0 ;; esac\nexit 128")

    def test_steps_go_on_behind_a_build_that_fails(self):
        self.program("bin/cmake", "exit 1")
        status, said = self.run_in_checkout("bash", ".ci/run")
        self.assertEqual(status, 1, said)
        self.assertRegex(said, r"\n    build_tests +FAILED")
        self.assertRegex(said, r"\n    run_tests +passed")
        self.assertRegex(said, r"\n    total ")

    def test_a_cluster_that_cannot_be_installed_is_skipped(self):
        self.program("tools/ci/test-slurm", "exit 77")
        status, said = self.run_in_checkout("bash", ".ci/run")
        self.assertEqual(status, 0, said)
        self.assertRegex(said, r"\n    test_slurm .*skipped")

    def test_the_checkout_may_belong_to_somebody_else(self):
        status, said = self.run_in_checkout("bash", ".ci/run")
        self.assertEqual(status, 0, said)
        self.assertRegex(said, r"\n    tools/dev/check tidy .*passed")


class Check(ShellTools):
    def setUp(self):
        super().setUp()
        for folder in ("src/api", "include/etendue", "examples", "tests/api", "tools"):
            (self.root / folder).mkdir(parents=True, exist_ok=True)
        self.file("src/api/scene.cpp", "#include <etendue/scene.h>\n")
        self.program("bin/cmake", "exit 0")

    def check_format(self, body):
        self.program("bin/clang-format-14", f"[ \"$1\" != --version ] || {{ echo 'clang-format version 14.0.6'; exit; }}\n{body}")
        return self.run_in_checkout("tools/dev/check", "format")

    def test_layout_is_checked(self):
        self.assertEqual(self.check_format("exit 0")[0], 0)
        status, said = self.check_format("echo 'src/api/scene.cpp:3:1: warning: code should be clang-formatted'")
        self.assertEqual(status, 1)
        self.assertIn("1 of 1 files", said)

    def test_a_clang_format_that_fails_is_no_success(self):
        status, said = self.check_format("echo 'Error reading .clang-format'; exit 1")
        self.assertEqual(status, 1)
        self.assertIn("Error reading .clang-format", said)

    def test_tidy_looks_at_public_headers_and_examples(self):
        git = ("git", "-c", "user.name=a", "-c", "user.email=a@b")
        for command in (("init", "--quiet"), ("add", "src"), ("commit", "--quiet", "--message=a")):
            self.assertEqual(self.run_in_checkout(*git, *command)[0], 0)
        sources = ("src/api/scene.cpp", "examples/render_scene.cpp")
        self.file("include/etendue/scene.h")
        self.file("examples/render_scene.cpp")
        self.file("build/ci/compile_commands.json",
                  json.dumps([{"command": f"c++ {name}", "file": str(self.root / name)} for name in sources]))
        self.program("bin/clang-tidy", f"echo \"$*\" >>{self.root}/looked-at")
        status, said = self.run_in_checkout("tools/dev/check", "tidy", "--base", "HEAD")
        self.assertEqual(status, 0, said)
        looked_at = (self.root / "looked-at").read_text()
        for name in sources:
            self.assertIn(name, looked_at)

        status, said = self.run_in_checkout("tools/dev/check", "tidy", "--base", "HEAD", "--seconds", "0")
        self.assertEqual(status, 0, said)
        self.assertIn("2 of them are left unchecked after 0 s", said)
        self.assertEqual((self.root / "looked-at").read_text(), looked_at)


class Packages(ShellTools):
    def test_those_that_are_held_are_not_missing(self):
        self.program("bin/dpkg-query", "for package; do :; done\ncase $package in installed) echo 'ii ' ;; held) echo 'hi ' ;; "
                     "removed) echo 'rc ' ;; half) echo 'iU ' ;; *) exit 1 ;; esac")
        status, said = self.run_in_checkout("bash", "-c", "source tools/lib/setup.sh\n"
                                            "printf '%s\\n' installed held removed half unknown | missing_packages")
        self.assertEqual((status, said.split()), (0, ["removed", "half", "unknown"]))


if __name__ == "__main__":
    unittest.main()
