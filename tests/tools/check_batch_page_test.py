"""The page of a batch, in a browser: tools/ci/check_batch_page on one that was made up by the program sample_batch.

Usage: check_batch_page_test.py SAMPLE_BATCH"""

import subprocess
import sys
import tempfile
from pathlib import Path

CHECK = Path(__file__).resolve().parents[2] / "tools/ci/check_batch_page"
NO_BROWSER = 77


def main():
    sample_batch = sys.argv[1]
    for units in (("0",), ("200", "running")):
        with tempfile.TemporaryDirectory() as directory:
            subprocess.run([sample_batch, directory, *units], check=True)
            status = subprocess.run([sys.executable, "-B", CHECK, directory, "--no-screenshots"], check=False).returncode
        if status == NO_BROWSER:
            # tools/test lists skips that are worded as GTEST_SKIP() words them.
            print("check_batch_page_test: Skipped\nthere is no browser")
            return 0
        if status != 0:
            return status
    return 0


if __name__ == "__main__":
    sys.exit(main())
