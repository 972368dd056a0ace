"""Tests that the pages of the repository lead somewhere: their links, their anchors and the files that they name; and that
they keep to their length, and the gallery to its size."""

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
# How long pages may be, and what the pictures of the gallery are.
MOST_LINES_OF_README = 150
MOST_WORDS_OF_DOCS = 40_000
PICTURES_OF_GALLERY = range(8, 13)
PICTURE_SIZE = (1920, 1080)
MOST_BYTES_OF_GALLERY = 12_000_000

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


def count_words(text):
    """Words are what lies between white space and holds a letter, in code and tables as elsewhere."""
    return sum(any(character.isalpha() for character in token) for token in text.split())


def words_of_docs(root):
    return sum(count_words(page.read_text(encoding="utf-8")) for page in pages(root / "docs"))


def jpeg_size(data):
    """Width and height by the header of a JPEG's frame; none if there is no such header."""
    position = 2
    while data[:2] == b"\xff\xd8" and data[position:position + 1] == b"\xff" and position + 9 <= len(data):
        marker = data[position + 1]
        # C4, C8 and CC among the frames' markers are tables, not frames.
        if 0xc0 <= marker <= 0xcf and marker not in (0xc4, 0xc8, 0xcc):
            return (int.from_bytes(data[position + 7:position + 9], "big"),
                    int.from_bytes(data[position + 5:position + 7], "big"))
        position += 2 + int.from_bytes(data[position + 2:position + 4], "big")
    return None


def pictures_of_gallery(root):
    """The JPEGs that docs/gallery.md shows."""
    text = (root / "docs/gallery.md").read_text(encoding="utf-8")
    return [root / "docs" / name for name in re.findall(r"!\[[^\]]*\]\(([^)]+\.jpg)\)", text)]


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


    def test_words(self):
        self.assertEqual(count_words("| a | 3.5 | x2 |\n```\nrun --all\n```\n- naïve"), 5)
        self.write("docs/a.md", "one 2 three\n")
        self.write("docs/b/c.md", "four\n")
        self.write("README.md", "not counted\n")
        self.assertEqual(words_of_docs(self.root), 3)

    def test_sizes_of_pictures(self):
        # A comment of 3 bytes, a table (C4), and a frame that is 0x102 pixels high and 0x304 wide.
        picture = (b"\xff\xd8\xff\xfe\0\5abc" b"\xff\xc4\0\3x" b"\xff\xc2\0\x0b\x08\x01\x02\x03\x04\1\1\x11\0")
        self.assertEqual(jpeg_size(picture), (0x304, 0x102))
        self.assertIsNone(jpeg_size(picture[:14]))
        self.assertIsNone(jpeg_size(b"\x89PNG" + picture))


class Repository(unittest.TestCase):
    maxDiff = None

    def test_every_link_leads_somewhere(self):
        self.assertGreater(len(pages(ROOT)), 30)
        self.assertEqual(dead_links(ROOT), [])

    def test_every_path_that_is_named_exists(self):
        self.assertEqual(missing_paths(ROOT, PAGES_OF_PATHS), [])

    def test_the_front_page_is_short(self):
        lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
        self.assertLessEqual(len(lines), MOST_LINES_OF_README)

    def test_the_docs_have_no_more_words_than_somebody_reads(self):
        self.assertLessEqual(words_of_docs(ROOT), MOST_WORDS_OF_DOCS)

    def test_the_gallery_is_large_and_its_files_are_small(self):
        pictures = pictures_of_gallery(ROOT)
        self.assertIn(len(pictures), PICTURES_OF_GALLERY)
        for picture in pictures:
            self.assertEqual(jpeg_size(picture.read_bytes()), PICTURE_SIZE, picture.name)
        files = [file for file in (ROOT / "docs/gallery").rglob("*") if file.is_file()]
        self.assertLess(sum(file.stat().st_size for file in files), MOST_BYTES_OF_GALLERY)


if __name__ == "__main__":
    unittest.main()
