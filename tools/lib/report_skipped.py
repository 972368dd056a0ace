"""Lists the tests that were skipped, with the reason that each gave.

Usage: report_skipped.py RESULTS CASES

RESULTS is the JUnit file that CTest wrote, CASES the folder of those that the programs with GoogleTest wrote.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def cases_of(path):
    try:
        return list(ElementTree.parse(path).getroot().iter("testcase"))
    except ElementTree.ParseError:
        return []  # of a program that was killed, which CTest says


def programs(results):
    """Programs other than GoogleTest's, which print `NAME: Skipped` and, on the lines that follow, the reason."""
    for case in cases_of(results):
        if case.find("skipped") is not None or case.get("status") == "disabled":
            lines = (case.findtext("system-out") or "").splitlines()
            start = next((i for i, line in enumerate(lines) if line.endswith(": Skipped")), len(lines))
            yield case.get("name"), " ".join(" ".join(lines[start + 1 :]).split()) or "no reason given"


def cases(folder):
    for path in folder.glob("*.xml"):
        for case in cases_of(path):
            skipped = case.find("skipped")
            if skipped is not None:
                # The first line of the message is the place in the source.
                reason = " ".join((skipped.get("message") or "").split("\n")[1:]).strip()
                yield f"{case.get('classname')}.{case.get('name')}", reason or "no reason given"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    skipped = sorted([*programs(sys.argv[1]), *cases(Path(sys.argv[2]))])
    if not skipped:
        print("No test was skipped.")
        return
    print(f"{len(skipped)} test(s) skipped:")
    for name, reason in skipped:
        print(f"    {name}: {reason}")


if __name__ == "__main__":
    main()
