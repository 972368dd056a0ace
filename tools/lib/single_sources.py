"""Writes compile_commands.json anew without headers compiled ahead, which clang cannot read where g++ wrote them.

Builds compile sources together, so that CMake's file has entries for those groups only. By default, each source gets
an entry of its own, so that clang says where a source does not include what it uses. With --together, groups stay
together, and clang reads them in an eighth of the time.

Usage: single_sources.py COMPILE_COMMANDS OUTPUT [--together]
"""

import json
import re
import sys
from pathlib import Path


def commands(entry, together):
    """Returns the entries for the sources that CMake's `entry` compiles: one each, or itself if `together`."""
    command = re.sub(r" -Winvalid-pch -include \S+", "", entry["command"])
    # Only g++ knows these. In a group, the strict -Wshadow would find what other sources of it declare.
    command = command.replace(" -Wshadow=local", "" if together else " -Wshadow")
    command = command.replace(" -Wno-maybe-uninitialized", "")
    file = entry["file"]
    if together or not Path(file).name.startswith("unity_"):
        return [{**entry, "command": command}]
    sources = re.findall(r'^#include "(.+)"$', Path(file).read_text(encoding="utf-8"), re.MULTILINE)
    return [{**entry, "file": source, "command": command.replace(file, source)} for source in sources]


def main():
    together = sys.argv[3:] == ["--together"]
    if len(sys.argv) != 3 and not together:
        sys.exit(__doc__)
    entries = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    written = [command for entry in entries for command in commands(entry, together)]
    output = Path(sys.argv[2])
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(written, indent=1), encoding="utf-8")


main()
