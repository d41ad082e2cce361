#!/usr/bin/env python3
"""Links between pages lead to files and headings that are there; every page of docs/ is in the site's navigation."""
import re
import sys

import pages

faults, count = [], 0
for page in pages.all_pages():
    for link in pages.links(page.read_text(encoding="utf-8")):
        if re.match(r"[a-z]+:", link):
            continue
        count += 1
        name, _, anchor = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        where = f"{page.relative_to(pages.ROOT)}: {link}"
        if not target.exists():
            faults.append(f"{where}: is not there")
        elif anchor and target.suffix == ".md" and anchor not in pages.anchors(target.read_text(encoding="utf-8")):
            faults.append(f"{where}: no such heading")
navigation = (pages.ROOT / "docs/site/mkdocs.yml").read_text(encoding="utf-8")
for page in (pages.ROOT / "docs").glob("*.md"):
    if f" docs/{page.name}\n" not in navigation:
        faults.append(f"docs/{page.name}: is not in the navigation of docs/site/mkdocs.yml")
print("\n".join(faults) if faults else f"{count} links")
sys.exit(1 if faults or count < 100 else 0)
