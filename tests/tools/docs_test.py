"""Tests that the pages of the repository lead somewhere: their links, their anchors and the files that they name."""

import os
import re
import tempfile
import unittest
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[2]
# What git ignores at the top of the tree, and git itself.
NOT_OURS = {"build", "out", ".git"}
# Pages whose backticks name files of the tree, and where their paths may begin.
PAGES_OF_PATHS = ("CONTRIBUTING.md", "SECURITY.md", "src/README.md")
STARTS_OF_PATHS = ("", "src")

FENCE = re.compile(r"^(```|~~~).*?^\1[^\n]*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(?<!`)(`+)(?!`)((?:(?!\n\n).)+?)(?<!`)\1(?!`)", re.DOTALL)
LINK = re.compile(r"\]\(\s*<?([^()\s<>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
REFERENCE = re.compile(r"^ {0,3}\[[^\]]+\]:\s*<?(\S+?)>?(?:\s|$)", re.MULTILINE)
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)(?:\s+#+)?\s*$", re.MULTILINE)
SCHEME = re.compile(r"^[A-Za-z][A-Za-z0-9+.-]*:")
PATH = re.compile(r"^(?:\./)?[\w.*{},-]+(?:/[\w.*{},-]+)*/?$")
BRACES = re.compile(r"\{([^{}]*)\}")


def blank(match):
    """As many lines as before, so that what follows keeps its number."""
    return "\n" * match.group().count("\n")


def pages(root):
    found = []
    for folder, folders, files in os.walk(root):
        if Path(folder) == root:
            folders[:] = [name for name in folders if name not in NOT_OURS]
        found += [Path(folder) / name for name in files if name.endswith(".md")]
    return sorted(found)


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def anchors(text):
    """The anchors that GitHub gives the headings of a page."""
    found = set()
    for heading in HEADING.findall(FENCE.sub(blank, text)):
        words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        slug = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        anchor, count = slug, 0
        while anchor in found:
            count += 1
            anchor = f"{slug}-{count}"
        found.add(anchor)
    return found


def dead_links(root):
    """One line for each relative link of the pages below `root` that leads nowhere."""
    texts = {page: page.read_text(encoding="utf-8") for page in pages(root)}
    dead = []
    for page, text in texts.items():
        plain = CODE.sub(blank, FENCE.sub(blank, text))
        for match in sorted([*LINK.finditer(plain), *REFERENCE.finditer(plain)], key=lambda match: match.start()):
            target = match.group(1)
            if SCHEME.match(target):
                continue
            place = f"{page.relative_to(root)}:{line_of(plain, match.start())}: {target}: "
            name, _, anchor = target.partition("#")
            file = (page.parent / unquote(name)).resolve() if name else page
            if not file.is_relative_to(root):
                dead.append(place + "this leads out of the repository")
            elif not file.exists():
                dead.append(place + "there is no such file")
            elif anchor and file.suffix == ".md" and unquote(anchor) not in anchors(texts[file]):
                dead.append(place + "the page has no such heading")
    return dead


def alternatives(path):
    """`a.{h,cpp}` is `a.h` and `a.cpp`."""
    match = BRACES.search(path)
    if not match:
        return [path]
    return [one for choice in match.group(1).split(",")
            for one in alternatives(path[:match.start()] + choice + path[match.end():])]


def is_there(root, path):
    """Whether files match `path` below the root or src/; where it has no ending, any will do."""
    for start in STARTS_OF_PATHS:
        folder = root / start
        if any(folder.glob(path.rstrip("/"))) or any(folder.glob(path.rstrip("/") + ".*")):
            return True
    return False


def missing_paths(root, names):
    """One line for each path that a page names in backticks and that is not there: words with a slash in them, which
    do not begin with what git ignores. Capitals alone, as in NAME/, stand for something else."""
    missing = []
    for name in names:
        text = FENCE.sub(blank, (root / name).read_text(encoding="utf-8"))
        for match in CODE.finditer(text):
            for word in match.group(2).split():
                parts = word.strip("/").split("/")
                if "/" not in word or not PATH.match(word) or parts[0] in NOT_OURS:
                    continue
                if any(re.fullmatch(r"[A-Z]+", part.split(".")[0]) and not is_there(root, part) for part in parts):
                    continue
                missing += [f"{name}:{line_of(text, match.start())}: {path} is not there"
                            for path in alternatives(word) if not is_there(root, path)]
    return missing


class Checker(unittest.TestCase):
    """That it finds what it is for, in a tree of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name).resolve()
        self.write("src/core/vec.h", "")

    def write(self, name, text):
        file = self.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def test_links_that_lead_somewhere(self):
        self.write("docs/b.md", "# The `code` of [a link](a.md), 2!\n## Twice\n## Twice\n[up](../README.md)\n")
        self.write("docs/a.md", "[b](b.md#the-code-of-a-link-2) [again](b.md#twice-1)\n\n[c]: b.md#twice\n")
        self.write("README.md", "# Top\n[top](#top) [folder](docs) [web](https://example.org/x#y) ![](docs/a.md)\n"
                                "`[no](link)`\n```\n[nor](this)\n# nor this\n```\n")
        self.write("build/_deps/other.md", "[theirs](nowhere.md)\n")
        self.assertEqual(dead_links(self.root), [])

    def test_links_that_lead_nowhere(self):
        self.write("docs/a.md", "# A\n\n[two\nlines](gone.md)\n[x](#b) ![picture](a.png)\n[out](../../etc/passwd)\n"
                                "```\n# b\n```\n[page](../README.md#b)\n\n[ref]: gone\n")
        self.write("README.md", "# Top\n")
        self.assertEqual([line.split(":")[1] + line.rsplit(":", 1)[1] for line in dead_links(self.root)],
                         ["4 there is no such file", "5 the page has no such heading", "5 there is no such file",
                          "6 this leads out of the repository", "10 the page has no such heading",
                          "12 there is no such file"])

    def test_paths(self):
        self.write("page.md", "`core/vec.h` `src/core/` `core/vec` `core/*.h` `core/{vec,ray}.h` `a / b` `core::x`\n"
                              "`tools/x --all` `bsdf/NAME.h` `build/bin/x` `./page.md` `vec.h`\n")
        self.assertEqual(missing_paths(self.root, ["page.md"]),
                         ["page.md:1: core/ray.h is not there", "page.md:2: tools/x is not there"])


class Repository(unittest.TestCase):
    maxDiff = None

    def test_every_link_leads_somewhere(self):
        self.assertGreater(len(pages(ROOT)), 30)
        self.assertEqual(dead_links(ROOT), [])

    def test_every_path_that_is_named_exists(self):
        self.assertEqual(missing_paths(ROOT, PAGES_OF_PATHS), [])


if __name__ == "__main__":
    unittest.main()
