"""Shared by the tests of a release: where things are, and a runner that tells skipped from passed."""
import os
import shutil
import subprocess
import sys
import unittest

ROOT = os.environ["HALFLIT_SOURCE_DIR"]
PROGRAM = os.environ["HALFLIT_PROGRAM"]
PACKAGING = os.path.join(ROOT, "packaging")


def run(*command, **options):
    """The process when it has ended, with its output as text."""
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, check=False, **options)


def output(*command, **options):
    done = run(*command, **options)
    if done.returncode:
        raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def text_of(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


def need(*tools):
    """Skips the test where a tool is not there."""
    for tool in tools:
        if shutil.which(tool) is None:
            raise unittest.SkipTest(f"{tool} is not there")


def main():
    """Exits with 77 where every test was skipped."""
    sys.path.append(os.path.join(ROOT, "tests", "support"))
    import skips
    tests = unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"])
    sys.exit(skips.exit_code(unittest.TextTestRunner(verbosity=2).run(tests)))
