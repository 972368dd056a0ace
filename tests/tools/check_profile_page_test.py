"""The page of a profile, in a browser: tools/ci/check_profile_page on ones that were made up by the program sample_profile.

Usage: check_profile_page_test.py SAMPLE_PROFILE"""

import subprocess
import sys
import tempfile
from pathlib import Path

CHECK = Path(__file__).resolve().parents[2] / "tools/ci/check_profile_page"
NO_BROWSER = 77


def main():
    sample_profile = sys.argv[1]
    for what in (["4"], ["1"], ["1", "empty"]):
        with tempfile.TemporaryDirectory() as directory:
            subprocess.run([sample_profile, directory, *what], check=True, stdout=subprocess.DEVNULL)
            status = subprocess.run([sys.executable, "-B", CHECK, directory, "--no-screenshots"], check=False).returncode
        if status == NO_BROWSER:
            # tools/test lists skips that are worded as GTEST_SKIP() words them.
            print("check_profile_page_test: Skipped\nthere is no browser")
            return 0
        if status != 0:
            return status
    return 0


if __name__ == "__main__":
    sys.exit(main())
