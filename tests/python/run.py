"""Runs one test file with the package of this tree.   run.py NAME_test.py

Exits with 77, skipped, where numpy is absent or all its tests were skipped.
"""
import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path[:0] = [HERE, os.path.join(ROOT, "apps", "python"), os.path.join(ROOT, "tests", "support")]

try:
    import numpy  # noqa: F401
except ImportError:
    print("skipped: this Python has no numpy")
    sys.exit(77)

if __name__ == "__main__":  # which a process that a test starts is not
    suite = unittest.defaultTestLoader.discover(HERE, pattern=sys.argv[1], top_level_dir=HERE)
    import skips
    sys.exit(skips.exit_code(unittest.TextTestRunner(verbosity=2).run(suite)))
