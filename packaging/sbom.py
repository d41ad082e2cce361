#!/usr/bin/env python3
"""Prints what a program is made of, as SPDX 2.3 in JSON.   sbom.py PROGRAM [CREATED]

The program names its libraries itself (halflit --version --verbose). CREATED: the time of its source, as 2026-01-31T00:00:00Z.
"""
import hashlib
import json
import re
import subprocess
import sys


def package(name, version, **more):
    return {"name": name, "SPDXID": "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name), "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION",
            **({"versionInfo": version} if version else {}), **more}


def main(program, created="1970-01-01T00:00:00Z"):
    first, *rest = subprocess.run([program, "--version", "--verbose"], stdout=subprocess.PIPE, universal_newlines=True,
                                  check=True).stdout.splitlines()
    with open(program, "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()
    own = package("halflit", first.split()[1], licenseDeclared="MIT", primaryPackagePurpose="APPLICATION",
                  checksums=[{"algorithm": "SHA256", "checksumValue": digest}])
    libraries = [package(*(line.split(" ", 1) + [""])[:2], primaryPackagePurpose="LIBRARY") for line in rest]
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", own["SPDXID"])] + [(own["SPDXID"], "DEPENDS_ON", one["SPDXID"]) for one in libraries]
    print(json.dumps({
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"halflit-{own['versionInfo']}",
        "documentNamespace": f"urn:halflit:{own['versionInfo']}:{digest}",
        "creationInfo": {"created": created, "creators": ["Tool: halflit-sbom"]},
        "packages": [own] + libraries,
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b} for a, kind, b in relations],
    }, indent=1))


if __name__ == "__main__":
    main(*sys.argv[1:])
