"""Runs the tests of the program that imports it, and says which were skipped so that CTest and tools/test see it."""

import sys
import unittest


def main(name):
    result = unittest.main(exit=False).result
    if not result.wasSuccessful():
        sys.exit(1)
    if result.skipped:
        # As GTEST_SKIP() says it. CTest takes no notice of failures beside it.
        print(f"{name}: Skipped", *sorted({reason for _, reason in result.skipped}), sep="\n")
