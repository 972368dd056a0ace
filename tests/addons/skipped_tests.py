"""Runs the tests of the program that imports it, and says which were skipped so that CTest and tools/test see it."""

import sys
import unittest


def main(name):
    result = unittest.main(exit=False).result
    if not result.wasSuccessful():
        sys.exit(1)
    if result.skipped:
        # CTest counts this wording of GTEST_SKIP() as a skip even beside failures, so failures exit first.
        print(f"{name}: Skipped", *sorted({reason for _, reason in result.skipped}), sep="\n")
