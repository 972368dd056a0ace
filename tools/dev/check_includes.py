#!/usr/bin/env python3
"""Checks which rooms of src/ include which, and where third-party headers are included.

The tables below are the architecture of src/README.md; whoever changes one changes both. Checked are
  - every #include of src/: form ("room/file.h" for our own, <...> for the rest), existence, direction, owning room;
    a file that does not exist counts as generated if the CMakeLists.txt of the room that includes it names it;
  - that a header which includes a wrapped third-party header, directly or not, stays inside its room;
  - that every header has #pragma once;
  - that DEPENDS in each src/ROOM/CMakeLists.txt lists only rooms of the table, and all that are included;
  - in src/ and tests/, that no functions in unnamed namespaces of two files of a room have one name and may have as many
    arguments: in unity builds these are overloads, and a call may silently change to the other one.
"""

import argparse
import re
import sys
import tempfile
from pathlib import Path

# room: the rooms that it may include besides itself.
ROOMS = {
    "core": "",
    "lightpath": "core",
    "sampling": "core",
    "shape": "sampling core",
    "image": "core",
    "color": "core",
    "scene": "shape core",
    "accelerator": "scene core",
    "loader": "scene shape image core",
    "bsdf": "sampling core",
    "medium": "sampling core",
    "texture": "image core",
    "oiio": "texture image core",
    "light": "texture shape sampling core",
    "camera": "sampling core",
    "world": "accelerator scene bsdf medium light camera texture image color shape sampling core",
    "film": "sampling core",
    "transport": "world scene bsdf medium light camera sampling core",
    "wave": "transport world scene lightpath film bsdf medium light camera sampling core",
    "integrator": "wave transport world scene lightpath film bsdf medium light camera sampling core",
    "processor": "integrator world core",
    "render": "processor integrator wave world film image core",
    "output": "film color image core",
    "metrics": "image core",
    "report": "metrics image core",
    "denoise": "image core",
    "picture": "core lightpath image color scene world film wave integrator processor render output",
    "api": "core color loader scene world integrator processor render output picture",
    "process": "core",
    "session": "process picture output render processor integrator world color image loader scene core",
    "batch": "session process picture report output render color image loader core",
    "farm": "batch session process picture render processor film scene color core",
    "compare": "session process picture report metrics output render processor integrator film world texture color image "
    "loader core",
    "profile": "session process picture report render integrator wave world accelerator scene core",
    "live": "batch session process picture report output render processor integrator film world loader scene color image core",
    "cli": "live profile compare farm batch session process picture denoise report metrics output render processor film world "
    "color image loader core",
}

# Those whose tests are one program, tests/cli/CMakeLists.txt.
PROGRAM_ROOMS = ("process", "session", "batch", "farm", "compare", "profile", "live", "cli", "program")

# Pattern of a third-party header, the rooms that may include it, and whether their headers may show it to other rooms.
ANY_ROOM = " ".join(ROOMS)
SHOWN, WRAPPED = True, False
THIRD_PARTY = [
    (r"etendue/", "api", SHOWN),  # the library's own
    (r"Imath/", "core", SHOWN),
    (r"fmt/", ANY_ROOM, SHOWN),
    (r"spdlog/", "core", WRAPPED),
    (r"xxhash\.h", "core", WRAPPED),
    (r"OpenImageDenoise/", "denoise", WRAPPED),
    (r"(tbb|oneapi)/", "core render", WRAPPED),
    (r"OpenImageIO/oiioversion\.h", "image", WRAPPED),
    (r"OpenImageIO/", "oiio", WRAPPED),
    (r"OpenColorIO/", "color", WRAPPED),
    (r"(tiny_gltf\.h|draco/|meshoptimizer\.h)", "loader", WRAPPED),
    (r"nlohmann/", "loader output report picture api session batch farm live cli", WRAPPED),
    (r"httplib\.h", "live", WRAPPED),
    (r"(openvdb|nanovdb)/", "medium", WRAPPED),
    (r"embree[34]/", "world", WRAPPED),
    (r"CLI/Version\.hpp", "session", WRAPPED),
    (r"CLI/", "cli", WRAPPED),
    (r"hwy/", "core", SHOWN),
    # The processor and the operating system.
    (r"[a-z]+mmintrin\.h|immintrin\.h", ANY_ROOM, SHOWN),
    (r"sys/types\.h", ANY_ROOM, SHOWN),
    (r"(unistd|dlfcn|elf|fcntl|fnmatch|link|poll|pthread|pwd|sched|spawn)\.h|linux/|sys/", ANY_ROOM, WRAPPED),
    (r"(netdb|netinet/in)\.h", "live", WRAPPED),
]
STANDARD = re.compile(r"[a-z][a-z0-9_]*$")  # <vector>, <cstdint>: no slash, no suffix

HEADER_SUFFIXES = {".h"}
SOURCE_SUFFIXES = {".h", ".cpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]*)"|<([^>]*)>|(\S+))')


def third_party_rule(name):
    """The row of THIRD_PARTY that a header name belongs to, or None."""
    return next((row for row in THIRD_PARTY if re.match(row[0], name)), None)


UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
# At the beginning of a line, with a type before its name.
FUNCTION = re.compile(r"^(?!using|namespace|template|static_assert|class|struct|enum|return|[#/])\w[^\n;={}]*?"
                      r"\b([a-z]\w*)\(", re.MULTILINE)
OVERLOADED = ("to_json",)  # found by the type that is written


def unnamed_functions(text):
    """Name, line, fewest and most arguments of each function in unnamed namespaces."""
    for namespace in UNNAMED.finditer(text):
        for function in FUNCTION.finditer(text, namespace.start(1), namespace.end(1)):
            if function.group(1) not in OVERLOADED:
                line = text.count("\n", 0, function.start()) + 1
                yield function.group(1), line, *argument_counts(text, function.end() - 1)


def argument_counts(text, start):
    """How many arguments a function takes at least and at most, whose parenthesis opens at `start`."""
    brackets = angles = commas = defaults = 0
    is_empty = True
    for before, character in zip(text[start - 1:], text[start:]):
        if character in "([{":
            brackets += 1
        elif character in ")]}":
            brackets -= 1
            if brackets == 0:
                break
        elif character == "<":
            angles += 1
        elif character == ">" and before != "-":
            angles -= 1
        elif brackets == 1:
            commas += character == "," and angles == 0
            defaults += character == "="
            is_empty = is_empty and character.isspace()
    most = 0 if is_empty else commas + 1
    return most - defaults, most


class Checker:
    """Collects the problems of one source tree as lines `FILE:LINE: what is wrong`."""

    def __init__(self, src):
        self.src = Path(src)
        self.problems = []
        self.includes = {}  # "room/file.h": [(line, included name, whether quoted)]
        self.rooms_used = {}  # room: {included room: "file:line"}

    def report(self, file, line, message):
        self.problems.append(f"{self.src.name}/{file}:{line}: {message}")

    def run(self):
        for path in sorted(self.src.rglob("*")):
            if path.is_file() and path.suffix in SOURCE_SUFFIXES:
                self.read(path)
        for file in self.includes:
            self.check_file(file)
        self.check_wrapped_headers()
        for path in sorted(self.src.glob("*/CMakeLists.txt")):
            self.check_depends(path)
        self.check_overloads()
        return self.problems

    def check_overloads(self, together=()):
        """`together`: rooms that are compiled as one."""
        rooms = [[path] for path in sorted(self.src.iterdir()) if path.is_dir() and path.name not in together]
        for folders in [*rooms, [self.src / room for room in together]]:
            found = {}  # name: [(file, line, fewest arguments, most arguments)]
            for path in sorted(path for folder in folders for path in folder.rglob("*.cpp")):
                file = path.relative_to(self.src).as_posix()
                for name, line, fewest, most in unnamed_functions(path.read_text(encoding="utf-8")):
                    for other, other_line, others_fewest, others_most in found.get(name, []):
                        if other != file and fewest <= others_most and others_fewest <= most:
                            self.report(file, line, f"{name} overloads that of {other}:{other_line} in unity builds: "
                                                    "give one of them another name")
                            break
                    found.setdefault(name, []).append((file, line, fewest, most))

    def read(self, path):
        file = path.relative_to(self.src).as_posix()
        text = path.read_text(encoding="utf-8")
        if path.suffix in HEADER_SUFFIXES and not re.search(r"^#pragma once$", text, re.MULTILINE):
            self.report(file, 1, "header without #pragma once")
        found = self.includes[file] = []
        for number, line in enumerate(text.splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            quoted, angled, macro = match.groups()
            if macro is not None:
                self.report(file, number, f"#include {macro}: write the header's name, not a macro")
            else:
                found.append((number, quoted if quoted is not None else angled, quoted is not None))

    def check_file(self, file):
        room = file.split("/")[0]
        if room not in ROOMS or "/" not in file:
            self.report(file, 1, "is in no room; rooms are listed in tools/dev/check_includes.py and src/README.md")
            return
        for line, name, quoted in self.includes[file]:
            if quoted:
                self.check_own(file, line, room, name)
            else:
                self.check_third_party(file, line, room, name)

    def check_own(self, file, line, room, name):
        target = name.split("/")[0]
        if name not in self.includes and not (target == room and self.is_generated(room, name)):
            hint = "third-party headers are included with <>" if third_party_rule(name) else "write \"room/file.h\""
            self.report(file, line, f'"{name}" is no file of src/; {hint}')
        elif target != room and target not in ROOMS[room].split():
            self.report(file, line, f'room {room} may not include room {target} ("{name}"); '
                                    f"it may include: {ROOMS[room] or 'nothing'}")
        elif target != room:
            self.rooms_used.setdefault(room, {}).setdefault(target, f"{file}:{line}")

    def is_generated(self, room, name):
        cmake = self.src / room / "CMakeLists.txt"
        return cmake.is_file() and name in cmake.read_text(encoding="utf-8")

    def check_third_party(self, file, line, room, name):
        if name in self.includes:
            self.report(file, line, f'<{name}> is our own; write "{name}"')
        elif not STANDARD.match(name):
            rule = third_party_rule(name)
            if rule is None:
                self.report(file, line, f"<{name}> is not known; add it to THIRD_PARTY in tools/dev/check_includes.py")
            elif room not in rule[1].split():
                self.report(file, line, f"<{name}> may be included only in: {rule[1]}")

    def check_wrapped_headers(self):
        """Reports includes of another room's header that brings a wrapped third-party header along."""
        brings = {}

        def wrapped_header_of(file):
            if file not in brings:
                brings[file] = None  # ends a cycle of includes
                for _, name, quoted in self.includes[file]:
                    rule = None if quoted else third_party_rule(name)
                    if rule and rule[2] is WRAPPED:
                        brings[file] = name
                    elif quoted and name in self.includes and wrapped_header_of(name):
                        brings[file] = wrapped_header_of(name)
            return brings[file]

        for file, includes in self.includes.items():
            for line, name, quoted in includes:
                if quoted and name in self.includes and name.split("/")[0] != file.split("/")[0]:
                    wrapped = wrapped_header_of(name)
                    if wrapped:
                        self.report(file, line, f'"{name}" brings <{wrapped}> along, which its room should hide')

    def check_depends(self, path):
        room = path.parent.name
        file = path.relative_to(self.src).as_posix()
        text = re.sub(r"#.*", "", path.read_text(encoding="utf-8"))
        calls = re.findall(r"\betendue_room\(\s*(\S+)([^)]*)\)", text)
        listed = set()
        for name, arguments in calls:
            if name != room:
                self.report(file, 1, f"etendue_room({name}) stands in the folder {room}")
            match = re.search(r"\bDEPENDS\b([^A-Z)]*)", arguments)
            listed |= set(match.group(1).split()) if match else set()
        for target in sorted(listed - set(ROOMS.get(room, "").split())):
            self.report(file, 1, f"DEPENDS lists {target}, which room {room} may not include")
        if calls:
            for target, place in sorted(self.rooms_used.get(room, {}).items()):
                if target not in listed:
                    self.report(file, 1, f"DEPENDS lacks {target}, which {place} includes")


# The self-test: each case is a made-up tree and a part of the only problem that it must show (None: it must pass).
GOOD = {
    "core/vec.h": "#pragma once\n#include <Imath/ImathVec.h>\n#include <vector>\n",
    "core/log.cpp": '#include "core/vec.h"\n#include <spdlog/spdlog.h>\n',
    "sampling/warp.h": '#pragma once\n#include "core/vec.h"\n',
    "core/CMakeLists.txt": "etendue_room(core\n  SOURCES log.cpp\n  PUBLIC PkgConfig::Imath)\n",
    "sampling/CMakeLists.txt": "etendue_room(sampling\n  SOURCES warp.cpp\n  DEPENDS core\n  PRIVATE fmt::fmt)\n",
}
SELF_TESTS = [
    ("a good tree", {}, None),
    ("subfolders and one's own room", {"integrator/path/a.h": "#pragma once\n",
                                       "integrator/path/a.cpp": '#include "integrator/path/a.h"\n'}, None),
    ("a wrapped header inside its room", {"world/embree.h": "#pragma once\n#include <embree4/rtcore.h>\n",
                                          "world/bvh.cpp": '#include "world/embree.h"\n'}, None),
    ("an include in a comment", {"core/a.cpp": '// #include "cli/main.h"\n'}, None),
    ("a generated file", {"bsdf/a.cpp": '#include "bsdf/tables.inc"\n',
                          "bsdf/CMakeLists.txt": 'set(tables "generated/bsdf/tables.inc")\n'}, None),
    ("wrong direction in a source", {"core/a.cpp": '#include "sampling/warp.h"\n'},
     "core may not include room sampling"),
    ("wrong direction in a header", {"bsdf/a.h": '#pragma once\n#include "light/l.h"\n', "light/l.h": "#pragma once\n"},
     "src/bsdf/a.h:2: room bsdf may not include room light"),
    ("nobody includes cli", {"render/a.cpp": '#include "cli/a.h"\n', "cli/a.h": "#pragma once\n"},
     "may not include room cli"),
    ("third-party in the wrong room", {"film/a.cpp": "#include <embree3/rtcore.h>\n"}, "only in: world"),
    ("unknown third-party", {"film/a.cpp": "#include <glm/glm.hpp>\n"}, "is not known"),
    ("third-party in quotes", {"loader/a.cpp": '#include "tiny_gltf.h"\n'}, "included with <>"),
    ("own header without its room", {"core/a.cpp": '#include "vec.h"\n'}, 'write "room/file.h"'),
    ("own header in angle brackets", {"core/a.cpp": "#include <core/vec.h>\n"}, "is our own"),
    ("a header that does not exist", {"core/a.cpp": '#include "core/nothing.h"\n'}, "no file of src/"),
    ("a macro as name", {"core/a.cpp": "#include HEADER\n"}, "not a macro"),
    ("no #pragma once", {"core/a.h": "#ifndef A\n#endif\n"}, "without #pragma once"),
    ("a file in no room", {"misc/a.cpp": "\n"}, "is in no room"),
    ("a wrapped header that leaks", {"world/e.h": "#pragma once\n#include <embree4/rtcore.h>\n",
                                     "world/w.h": '#pragma once\n#include "world/e.h"\n',
                                     "integrator/a.cpp": '#include "world/w.h"\n'},
     'src/integrator/a.cpp:1: "world/w.h" brings <embree4/rtcore.h>'),
    ("DEPENDS against the table", {"sampling/CMakeLists.txt": "etendue_room(sampling DEPENDS core film)\n"},
     "DEPENDS lists film"),
    ("DEPENDS too short", {"sampling/CMakeLists.txt": "etendue_room(sampling SOURCES a.cpp)\n"}, "DEPENDS lacks core"),
    ("two functions of one name in a room", {
        "film/a.cpp": "namespace {\n\nint f(int a, std::pair<int, int> b = {1, 2}) {\n}\n\n}  // namespace\n",
        "film/b.cpp": "namespace {\n\nint f(long a) {\n}\n\n}  // namespace\n"}, "f overloads that of film/a.cpp:3"),
    ("two functions that cannot be confused", {
        "film/a.cpp": "namespace {\n\nint f(int a, int b) {\n}\n\n}  // namespace\n",
        "film/b.cpp": "namespace {\n\nint f(long a) {\n}\n\n}  // namespace\n"}, None),
    ("a room under another name", {"sampling/CMakeLists.txt": "etendue_room(warps SOURCES a.cpp DEPENDS core)\n"},
     "stands in the folder sampling"),
]


def check_table():
    """Problems of ROOMS and THIRD_PARTY themselves: unknown names, and rooms that include each other in a circle."""
    problems = [f"ROOMS: {room} may include {target}, which is no room"
                for room, targets in ROOMS.items() for target in targets.split() if target not in ROOMS]
    problems += [f"THIRD_PARTY: {pattern} belongs to {room}, which is no room"
                 for pattern, rooms, _ in THIRD_PARTY for room in rooms.split() if room not in ROOMS]
    if not problems:
        remaining = {room: set(targets.split()) for room, targets in ROOMS.items()}
        while remaining:
            leaves = [room for room, targets in remaining.items() if not targets & set(remaining)]
            if not leaves:
                return [f"ROOMS: {', '.join(remaining)} include each other in a circle"]
            for room in leaves:
                del remaining[room]
    return problems


def self_test():
    failures = check_table()
    for title, files, expected in SELF_TESTS:
        with tempfile.TemporaryDirectory() as folder:
            src = Path(folder) / "src"
            for name, text in {**GOOD, **files}.items():
                (src / name).parent.mkdir(parents=True, exist_ok=True)
                (src / name).write_text(text, encoding="utf-8")
            problems = Checker(src).run()
        if expected is None and problems:
            failures.append(f"{title}: should pass, but: {problems}")
        elif expected is not None and not (len(problems) == 1 and expected in problems[0]):
            failures.append(f"{title}: should show one problem, '{expected}', but: {problems}")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("src", nargs="?", default=Path(__file__).resolve().parents[2] / "src",
                        help="the tree to check; default: src/ of this checkout")
    parser.add_argument("--self-test", action="store_true", help="check this program with small made-up trees")
    arguments = parser.parse_args()
    if arguments.self_test:
        problems = self_test()
    else:
        problems = check_table() + Checker(arguments.src).run()
        tests = Checker(Path(arguments.src).parent / "tests")
        tests.check_overloads(PROGRAM_ROOMS)
        problems += tests.problems
    for problem in problems:
        print(problem)
    if problems:
        sys.exit(f"check_includes: {len(problems)} problem(s)")
    print(f"check_includes: {len(SELF_TESTS)} made-up trees judged rightly" if arguments.self_test
          else "check_includes: nothing to complain about")


if __name__ == "__main__":
    main()
