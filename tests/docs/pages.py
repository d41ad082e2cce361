"""The pages of the documentation as tests read them: their links, their headings, and the command lines in their code."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMANDS = ("halflit ", "$ halflit ", "./dev", "curl ", "find ", "npx ", "npm ", "sh ", "sbatch ", "job=")
GENERATED = ("SKILL.md", "flags.md")  # what the program prints: tests/cli has their tests


def pages():
    """README.md and the pages of docs/."""
    return [ROOT / "README.md", *sorted(path for path in (ROOT / "docs").glob("*.md") if path.name not in GENERATED)]


def all_pages():
    """All pages in Markdown of the repository, without those of build folders."""
    own = ("apps", "bench", "docs", "raster", "sh", "shading")
    return sorted([*ROOT.glob("*.md"), *(path for name in own for path in (ROOT / name).rglob("*.md") if "node_modules" not in path.parts)])


def code_lines(text):
    """(number, line) of each line of code, without its indentation: indented by four spaces or more, or fenced as sh or without a name."""
    fence = None
    for number, line in enumerate(text.split("\n"), 1):
        if line.startswith("```"):
            fence = None if fence is not None else line[3:].strip()
        elif fence in ("", "sh") or (fence is None and line.startswith("    ")):
            yield number, line.strip()


def commands(path):
    """(number, command, lines below it that it prints) of each command line of a page."""
    lines = list(code_lines(path.read_text(encoding="utf-8")))
    for k, (number, line) in enumerate(lines):
        if line.startswith(COMMANDS):
            printed = []
            if line.startswith("$ "):
                while k + 1 + len(printed) < len(lines) and lines[k + 1 + len(printed)][0] == number + 1 + len(printed):
                    printed.append(lines[k + 1 + len(printed)][1])
            yield number, line, printed


def anchors(text):
    """The names that GitHub gives to the headings."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text, flags=re.S), re.M):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
        name = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        found.add(name if name not in found else f"{name}-{sum(other.startswith(name) for other in found)}")
    return found


def links(text):
    """Targets of links and pictures, those in code left out."""
    return re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.S))
