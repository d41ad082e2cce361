#!/usr/bin/env python3
"""Makes the site of the documentation, by mkdocs.

    site.py PROGRAM OUTPUT [REFERENCE]    OUTPUT/site is the site. REFERENCE: the folder of doxygen's HTML

Exit code 77: there is no mkdocs. The sources of the site, in OUTPUT/source, are a copy of README.md, of docs/*.md and of all files that
they link to, under the same paths: so a link works in the repository and on the site. To these come pictures for each flag
(flag_pictures.py).
"""
import html
import pathlib
import re
import shutil
import subprocess
import sys

import flag_pictures

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
GALLERY = ROOT / "apps/examples/gallery"
LINK = re.compile(r"\]\(([^)\s]+)\)")


def code_removed(text):
    """The text without code, whose brackets are no links."""
    return re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.S)


def linked_files(path, text):
    """Paths, relative to the root, of the files that a page links to."""
    for target in LINK.findall(code_removed(text)):
        if not re.match(r"[a-z]+:|#", target):
            yield (path.parent / target.split("#")[0]).resolve()


def kind_of(line):
    if not line.strip():
        return "empty"
    for kind, start in (("code", "    "), ("more", " "), ("table", "|"), ("item", "- "), ("heading", "#")):
        if line.startswith(start):
            return kind
    return "text"


def for_mkdocs(text):
    """GitHub begins a list, a table or code below a line of text; Python's Markdown needs an empty line between them."""
    out, before, fenced = [], "empty", False
    for line in text.split("\n"):
        fenced ^= line.startswith("```")
        kind = "text" if fenced else kind_of(line)
        if kind == "table":  # code that holds a bar
            line = re.sub(r"`([^`]*\\\|[^`]*)`", lambda m: "<code>" + html.escape(m[1]).replace("\\|", "&#124;") + "</code>", line)
        if kind != "code" and not fenced:
            line = line.replace("\\<", "&lt;")
        if before == "text" and kind in ("item", "table", "code"):
            out.append("")
        out.append(line)
        before = kind
    return "\n".join(out)


def list_of_scripts():
    """The gallery's scripts as links, with their titles."""
    rows = ["", "", "## Scripts", "| script | shows |", "|---|---|"]
    for line in (GALLERY / "table.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            name = line.split()[0]
            title, sentence = [text.lstrip("#/ ") for text in (GALLERY / name).read_text(encoding="utf-8").splitlines()[:2]]
            rows.append(f"| [{name}]({name}) | {title}. {sentence} |")
    return "\n".join(rows) + "\n"


def gather(source):
    """Copies the pages and what they link to. Returns the number of pages."""
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
    seen = set(pages)
    for path in pages:  # grows while it is read
        text = path.read_text(encoding="utf-8")
        if path.parent == GALLERY:
            text += list_of_scripts()
        for target in linked_files(path, text):
            if target in seen or not target.is_file():
                continue
            seen.add(target)
            if target.suffix == ".md":
                pages.append(target)
            else:
                copy = source / target.relative_to(ROOT)
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(target, copy)
        copy = source / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(for_mkdocs(text), encoding="utf-8")
    return len(pages)


def complete_scripts(site):
    """Debian's mkdocs has its theme's scripts under other names than the theme asks for, and lacks one."""
    asked = set(re.findall(r'src="(js/[^"]+)"', (site / "index.html").read_text(encoding="utf-8")))
    for script in (site / name for name in asked):
        if not script.exists():
            like = sorted(script.parent.glob(script.name.split("-")[0] + "-*"))
            script.write_bytes(like[0].read_bytes() if like else b"")


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    if not shutil.which("mkdocs"):
        print("site.py: there is no mkdocs")
        return 77
    program, output = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    source = output / "source"
    shutil.rmtree(source, ignore_errors=True)
    pages = gather(source)
    for name, folder in (("site.css", source), ("mkdocs.yml", output)):
        shutil.copyfile(HERE / name, folder / name)
    pictures = flag_pictures.make(program, source / "docs")
    if len(sys.argv) == 4:
        shutil.copytree(sys.argv[3], source / "reference")
        with open(source / "docs/reference.md", "a", encoding="utf-8") as file:
            file.write("\n[All names, by doxygen](../reference/index.html)\n")
    subprocess.run(["mkdocs", "build", "--strict", "--clean", "--config-file", output / "mkdocs.yml"], check=True)
    complete_scripts(output / "site")
    print(f"{pages + 1} pages, {pictures} pictures of flags", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
