"""Lists the skipped tests of a JUnit file that CTest wrote, with the reason that each test gave.

Usage: report_skipped.py FILE
"""

import sys
import xml.etree.ElementTree as ElementTree


def reason_of(output):
    """The text that GTEST_SKIP() printed: what follows the line `FILE:LINE: Skipped`, up to the next marker."""
    lines = output.splitlines()
    for index, line in enumerate(lines):
        if line.endswith(": Skipped"):
            reason = []
            for following in lines[index + 1 :]:
                if following.startswith("["):
                    break
                reason.append(following.strip())
            return " ".join(" ".join(reason).split()) or "no reason given"
    return "no reason given"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    skipped = []
    for case in ElementTree.parse(sys.argv[1]).getroot().iter("testcase"):
        if case.find("skipped") is not None or case.get("status") == "disabled":
            skipped.append((case.get("name"), reason_of(case.findtext("system-out") or "")))
    if not skipped:
        print("No test was skipped.")
        return
    print(f"{len(skipped)} test(s) skipped:")
    for name, reason in sorted(skipped):
        print(f"    {name}: {reason}")


if __name__ == "__main__":
    main()
