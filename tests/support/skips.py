"""How a run of unittest ends: one rule for the tests of Python and of releases.

skips.py LOG LASTTEST: the same for tests that ctest skipped. LOG: what it printed; LASTTEST: its Testing/Temporary/LastTest.log.
"""
import os
import re
import sys

ALLOWED = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "allowed_skips.txt")


def not_allowed(skipped):
    """Prints and returns those of [(test, reason)] whose reason tests/allowed_skips.txt does not name."""
    with open(ALLOWED, encoding="utf-8") as file:
        parts = [line.split("|")[0].strip() for line in file if "|" in line and not line.startswith("#")]
    wrong = [f"{test}: {reason}" for test, reason in skipped if not any(part in reason for part in parts)]
    for line in wrong:
        print("skipped, and tests/allowed_skips.txt does not say that it may be:", line)
    return wrong


def exit_code(result):
    """0, 1, or 77 where every test was skipped. Where CI is set, a skip that is not allowed is a failure."""
    wrong = not_allowed(result.skipped)
    if not result.wasSuccessful() or not result.testsRun or (wrong and os.environ.get("CI")):
        return 1
    return 77 if len(result.skipped) >= result.testsRun else 0


def text_of(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


if __name__ == "__main__":
    names = re.findall(r"^\s*[0-9]+ - (.*) \(Skipped\)", text_of(sys.argv[1]), re.M)
    said = dict(re.findall(r"^[0-9]+/[0-9]+ Test: ([^\n]*)\n(.*?)^<end of output>$", text_of(sys.argv[2]), re.M | re.S))
    reasons = [(name, " ".join([name] + re.findall("^skipped.*", said.get(name, ""), re.M))) for name in names]
    sys.exit(1 if not_allowed(reasons) else 0)
