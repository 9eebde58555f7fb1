# SPDX-License-Identifier: MIT OR Apache-2.0
"""A wheel that lists the crates of its own platform alone: their licenses, and the SBOM.

The build gives every wheel the lists of all platforms, and those of what only builds need.
"""

from __future__ import annotations

import base64
import hashlib
import json
import zipfile
from pathlib import Path
from typing import Any, Set, Tuple

from release import notices

Crates = Set[Tuple[str, str]]
"""Names and versions."""
_SBOM = ".dist-info/sboms/"
_RECORD = ".dist-info/RECORD"


def narrow(wheel: Path, crates: Crates, target: Path) -> Path:
    """Writes a wheel anew whose lists name these crates and our own; returns it. All else stays as it is."""
    with zipfile.ZipFile(wheel) as archive:
        infos = archive.infolist()
        files = {info.filename: archive.read(info) for info in infos}
    for name, data in files.items():
        if name.endswith(f"/licenses/{notices.NAME}"):
            files[name] = notices.of(crates, data.decode()).encode()
        elif _SBOM in name:
            files[name] = json.dumps(narrowed(json.loads(data), crates), separators=(",", ":")).encode()
    [record] = [name for name in files if name.endswith(_RECORD)]
    files[record] = "".join(f"{_line(name, files[name], record)}\n" for name in files).encode()
    with zipfile.ZipFile(target, "w") as archive:
        for info in infos:
            archive.writestr(info, files[info.filename], zipfile.ZIP_DEFLATED, 9)
    return target


def narrowed(bill: dict[str, Any], crates: Crates) -> dict[str, Any]:
    """An SBOM with the components among the crates, our own, and what these depend on of each other."""
    components = [
        component
        for component in bill["components"]
        if component["name"] == "authalic" or (component["name"], component["version"]) in crates
    ]
    kept = {component["bom-ref"] for component in components} | {bill["metadata"]["component"]["bom-ref"]}
    dependencies = [
        {**row, "dependsOn": [other for other in row.get("dependsOn", ()) if other in kept]}
        for row in bill.get("dependencies", ())
        if row["ref"] in kept
    ]
    return {**bill, "components": components, "dependencies": dependencies}


def _line(name: str, data: bytes, record: str) -> str:
    """A line of RECORD, which has neither a hash nor a size of itself."""
    if name == record:
        return f"{name},,"
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}"
