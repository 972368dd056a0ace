"""The pages of what is rendered, in a browser: tools/ci/check_live_page on a scene of this project.

Usage: check_live_page_test.py PROGRAM"""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NO_BROWSER = 77


def main():
    check = [sys.executable, "-B", ROOT / "tools/ci/check_live_page", sys.argv[1], ROOT / "scenes/cornell-box"]
    status = subprocess.run(check, check=False).returncode
    if status == NO_BROWSER:
        # tools/test lists skips that are worded as GTEST_SKIP() words them.
        print("check_live_page_test: Skipped\nthere is no browser")
        return 0
    return status


if __name__ == "__main__":
    sys.exit(main())
