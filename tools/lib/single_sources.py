"""Writes compile_commands.json anew with one entry per source, for tools that look at sources one by one.

Builds compile sources together, so that CMake's file has entries for those groups only. Headers compiled ahead are left
out: clang cannot read g++'s, and without them it says where a source does not include what it uses.

Usage: single_sources.py COMPILE_COMMANDS OUTPUT
"""

import json
import re
import sys
from pathlib import Path


def single_commands(entry):
    """The entries of the sources that the one of CMake compiles."""
    command = re.sub(r" -Winvalid-pch -include \S+", "", entry["command"])
    command = command.replace("-Wshadow=local", "-Wshadow")  # enough for sources together, and g++'s own
    file = entry["file"]
    if not Path(file).name.startswith("unity_"):
        return [{**entry, "command": command}]
    sources = re.findall(r'^#include "(.+)"$', Path(file).read_text(encoding="utf-8"), re.MULTILINE)
    return [{**entry, "file": source, "command": command.replace(file, source)} for source in sources]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    entries = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    singles = [single for entry in entries for single in single_commands(entry)]
    output = Path(sys.argv[2])
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(singles, indent=1), encoding="utf-8")


main()
