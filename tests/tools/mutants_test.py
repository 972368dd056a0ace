"""Tests of tools/lab/mutants, with a builder that reads the code instead of compiling it."""

import contextlib
import io
import json
import subprocess
import tempfile
import unittest
from pathlib import Path

from tool_module import load_tool

tool = load_tool("lab/mutants")

CODE = "float half(float x) {\n    return x * 0.5f;\n}\nfloat twice(float x) {\n    return x + x;\n}\n"
HALF = {"name": "half", "file": "src/code.cpp", "old": "x * 0.5f", "new": "x * 0.4f", "target": "test_code",
        "tests": "Half.*", "why": "a half is less"}
TWICE = {**HALF, "name": "twice", "old": "x + x", "new": "x + 1", "tests": "Twice.*"}


class FakeBuilder:
    """Has the tests of `tests`: each passes while its text is in the code. `broken` does not compile."""

    tests = {"Half.IsHalf": "return x * 0.5f;", "Twice.IsThere": "float twice"}
    broken = "syntax error"

    def __init__(self, tree, preset, jobs):
        self.code = tree / "src/code.cpp"
        self.log = tree.parent / "build.log"

    def configure(self):
        pass

    def build(self, targets):
        return self.broken not in self.code.read_text()

    def count_tests(self, target, tests):
        return sum(name.startswith(tests.removesuffix("*")) for name in self.tests)

    def failure(self, target, tests):
        code = self.code.read_text()
        for name, text in self.tests.items():
            if any(name.startswith(one.removesuffix("*")) for one in tests.split(":")) and text not in code:
                return name
        return ""


class Mutants(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name) / "project"
        (self.root / "src").mkdir(parents=True)
        (self.root / "src/code.cpp").write_text(CODE)
        (self.root / ".gitignore").write_text("/build/\n")
        subprocess.run(["git", "init", "-q", self.root], check=True)
        self.scratch = self.root / "build/mutants"

    def run_tool(self, mutants, *words, builder=FakeBuilder):
        """Exit status, standard output and standard error."""
        listed = self.root / "mutants.toml"
        listed.write_text("".join("[[mutant]]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in m.items())
                                  for m in mutants))
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = tool.main(list(words), self.root, listed, self.scratch, builder)
        return status, out.getvalue(), err.getvalue()

    def test_one_is_caught_and_the_tree_is_left_alone(self):
        status, out, _ = self.run_tool([HALF])
        self.assertEqual(status, 0)
        self.assertRegex(out, r"half +caught .* Half.IsHalf")
        self.assertIn("1 of 1 mutants are caught", out)
        self.assertEqual((self.root / "src/code.cpp").read_text(), CODE)
        self.assertEqual((self.scratch / "tree/src/code.cpp").read_text(), CODE)

    def test_one_survives(self):
        status, out, _ = self.run_tool([HALF, TWICE])
        self.assertEqual(status, 1)
        self.assertRegex(out, r"twice +survived")
        self.assertIn("1 of 2 mutants are caught", out)

    def test_text_that_is_not_there_once_is_an_error_that_keeps_no_other_from_being_tried(self):
        gone = {**HALF, "name": "gone", "old": "x * 0.25f"}
        often = {**HALF, "name": "often", "old": "return"}
        missing = {**HALF, "name": "missing", "file": "src/none.cpp"}
        status, out, _ = self.run_tool([gone, HALF, often, missing])
        self.assertEqual(status, 1)
        self.assertRegex(out, r"gone +not applicable .* is not in src/code.cpp")
        self.assertRegex(out, r"often +not applicable .* is 2 times in src/code.cpp")
        self.assertRegex(out, r"missing +not applicable .* src/none.cpp is missing")
        self.assertRegex(out, r"half +caught")

    def test_what_does_not_compile_is_not_caught(self):
        status, out, _ = self.run_tool([{**HALF, "new": "syntax error"}])
        self.assertEqual(status, 1)
        self.assertRegex(out, r"half +does not compile")

    def test_tests_that_fail_without_a_mutant_are_refused(self):
        class Failing(FakeBuilder):
            tests = {"Half.IsHalf": "return x / 2;"}

        status, out, err = self.run_tool([HALF], builder=Failing)
        self.assertEqual(status, 2)
        self.assertIn("Half.IsHalf fails without any mutant", err)
        self.assertNotIn("caught", out)

    def test_tests_that_are_not_there_are_refused(self):
        status, _, err = self.run_tool([{**HALF, "tests": "Third.*"}])
        self.assertEqual(status, 2)
        self.assertIn("test_code has no test Third.*", err)

    def test_what_an_interrupted_run_left_is_put_right(self):
        self.run_tool([HALF])
        (self.scratch / "tree/src/code.cpp").write_text(CODE.replace("0.5f", "0.4f"))
        (self.scratch / "tree/src/old.cpp").write_text("no longer there")
        self.assertEqual(self.run_tool([HALF])[0], 0)
        self.assertFalse((self.scratch / "tree/src/old.cpp").exists())

    def test_what_is_not_committed_is_tested(self):
        (self.root / "src/code.cpp").write_text(CODE.replace("0.5f", "0.25f"))
        self.assertEqual(self.run_tool([HALF])[0], 1)

    def test_outcomes_for_programs(self):
        file = self.root / "build/outcomes.json"
        file.parent.mkdir()
        self.run_tool([HALF, TWICE], "--json", str(file))
        report = json.loads(file.read_text())
        self.assertEqual(report["results"], {"caught": 1, "survived": 1})
        self.assertEqual(report["outcomes"][0]["name"], "half")
        self.assertEqual(report["outcomes"][0]["detail"], "Half.IsHalf")

    def test_a_part_of_the_list(self):
        status, out, _ = self.run_tool([HALF, TWICE], "--only", "^tw", "--list")
        self.assertEqual(status, 0)
        self.assertIn("x + x  ->  x + 1", out)
        self.assertNotIn("half", out.replace("a half is less", ""))
        self.assertFalse(self.scratch.exists())
        self.assertEqual(self.run_tool([HALF], "--only", "nothing")[0], 2)

    def test_lists_that_are_wrong(self):
        for mutants, message in (([HALF, HALF], "two mutants are called half"),
                                 ([{**HALF, "new": HALF["old"]}], "changes nothing"),
                                 ([{**HALF, "why": ""}], "has an empty text"),
                                 ([{**HALF, "old": "a\nb"}], "more than one line"),
                                 ([{key: HALF[key] for key in HALF if key != "why"}], "needs exactly the texts"),
                                 ([], "there is no mutant")):
            status, _, err = self.run_tool(mutants)
            self.assertEqual(status, 2)
            self.assertIn(message, err)


class TheList(unittest.TestCase):
    def test_every_mutant_applies(self):
        for mutant in tool.read_list(tool.LIST):
            self.assertEqual(tool.why_not_applicable(tool.ROOT, mutant), "", mutant.name)


if __name__ == "__main__":
    unittest.main()
