"""How a run of unittest ends: one rule for the tests of Python and of releases."""
import os

ALLOWED = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "allowed_skips.txt")


def not_allowed(skipped):
    """The reasons among [(test, reason)] that tests/allowed_skips.txt does not name."""
    with open(ALLOWED, encoding="utf-8") as file:
        parts = [line.split("|")[0].strip() for line in file if "|" in line and not line.startswith("#")]
    return [f"{test}: {reason}" for test, reason in skipped if not any(part in reason for part in parts)]


def exit_code(result):
    """0, 1, or 77 where every test was skipped. Where CI is set, a skip that is not allowed is a failure."""
    wrong = not_allowed(result.skipped)
    for line in wrong:
        print("skipped, and tests/allowed_skips.txt does not say that it may be:", line)
    if not result.wasSuccessful() or not result.testsRun or (wrong and os.environ.get("CI")):
        return 1
    return 77 if len(result.skipped) >= result.testsRun else 0
