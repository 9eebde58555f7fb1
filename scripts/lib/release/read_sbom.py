# SPDX-License-Identifier: MIT OR Apache-2.0
"""Prints the names and versions of the crates in a wheel's SBOM, if it is valid. It runs in .venv/release."""

import json
import sys
import zipfile

from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator


def main(wheel: str) -> None:
    with zipfile.ZipFile(wheel) as archive:
        [name] = [name for name in archive.namelist() if ".dist-info/sboms/" in name]
        text = archive.read(name).decode()
    bill = json.loads(text)
    problem = JsonStrictValidator(SchemaVersion.from_version(bill["specVersion"])).validate_str(text)
    if problem is not None:
        sys.exit(f"{name} is not valid CycloneDX {bill['specVersion']}: {problem}")
    print("\n".join(f"{component['name']} {component['version']}" for component in bill["components"]))


main(sys.argv[1])
