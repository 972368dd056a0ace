"""Writes compile_commands.json anew without headers compiled ahead, which clang cannot read where g++ wrote them.

Builds compile sources together, so that CMake's file has entries for those groups only. By default each source gets an
entry of its own: clang then says where one does not include what it uses. With --together groups stay, which are read in
an eighth of the time.

Usage: single_sources.py COMPILE_COMMANDS OUTPUT [--together]
"""

import json
import re
import sys
from pathlib import Path


def commands(entry, together):
    """The entries of the sources that the one of CMake compiles."""
    command = re.sub(r" -Winvalid-pch -include \S+", "", entry["command"])
    # g++'s own warning; in sources together, the strict one would find what their neighbours declare.
    command = command.replace(" -Wshadow=local", "" if together else " -Wshadow")
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
