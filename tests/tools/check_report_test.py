"""The report of a comparison, in a browser: tools/ci/check_report on one that `etendue compare` makes.

Usage: check_report_test.py ETENDUE"""

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CHECK = ROOT / "tools/ci/check_report"
NO_BROWSER = 77


def main():
    etendue = sys.argv[1]
    with tempfile.TemporaryDirectory() as directory:
        report = Path(directory) / "report"
        subprocess.run([etendue, "compare", ROOT / "scenes/cornell-box", "--size", "64x48", "--spp", "16", "--seeds", "4",
                        "--quiet", "-o", report], check=True)
        status = subprocess.run([sys.executable, "-B", CHECK, report, "--no-screenshots"], check=False).returncode
    if status == NO_BROWSER:
        # tools/test lists skips that are worded as GTEST_SKIP() words them.
        print("check_report_test: Skipped\nthere is no browser")
        return 0
    return status


if __name__ == "__main__":
    sys.exit(main())
