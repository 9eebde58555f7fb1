# SPDX-License-Identifier: MIT OR Apache-2.0
"""The extension zips, one for each platform with a wheel, and the index from which Blender updates them."""

from __future__ import annotations

import hashlib
import io
import json
import shutil
import zipfile
from pathlib import Path

import distribution
import environment
from release import places
from release.problems import refuse_any
from shell import ROOT, run, version

LIMIT = 4_000_000
"""Bytes of a zip, at most."""
_RECOMPRESSED = "recompressed"
_NEEDED = ("__init__.py", "LICENSE", "blender_manifest.toml", "manual.html", distribution.THIRD_PARTY)


def pack(log: Path | None = None) -> list[Path]:
    """The zips in dist/release/extensions/, of all wheels for which there is a Blender."""
    blender = environment.any_blender()
    places.REPOSITORY.mkdir(parents=True, exist_ok=True)
    places.WORK.mkdir(parents=True, exist_ok=True)
    for old in places.REPOSITORY.iterdir():
        old.unlink()
    for wheel in places.wheels():
        name = distribution.platform_of(wheel)
        if name is not None and "-abi3-" in wheel.name:
            target = places.REPOSITORY / f"authalic-{version()}-{name}.zip"
            packed = places.WORK / target.name
            distribution.pack_extension(packed, recompressed(wheel, wheel.name, log), blender, log)
            recompressed(packed, target.name, log).replace(target)
            distribution.blender_ext(blender, "validate", target, log=log)
    refuse_any([problem for path in places.zips() for problem in problems_of_zip(path)])
    return places.zips()


def recompressed(archive: Path, name: str, log: Path | None = None) -> Path:
    """A smaller archive of the same files, in a folder of its own; one that is there already is kept."""
    folder = places.WORK / _RECOMPRESSED / hashlib.sha256(archive.read_bytes()).hexdigest()[:16]
    if not (folder / name).exists():
        folder.mkdir(parents=True, exist_ok=True)
        program = ROOT / "scripts/lib/release/recompress.py"
        run([environment.release().python, program, archive, folder / "unfinished"], log=log)
        (folder / "unfinished").rename(folder / name)
    return folder / name


def pack_again(log: Path | None = None) -> None:
    """Packs the zips a second time, from nothing, and compares the bytes."""
    shutil.rmtree(places.WORK / _RECOMPRESSED, ignore_errors=True)
    first = {path.name: path.read_bytes() for path in places.zips()}
    second = {path.name: path.read_bytes() for path in pack(log)}
    refuse_any([f"two builds of {name} differ" for name in first if second.get(name) != first[name]])


def problems_of_zip(path: Path) -> list[str]:
    """What a zip lacks or has too much of, a sentence each. Blender's tool has validated the manifest."""
    with zipfile.ZipFile(str(path)) as archive:
        names = archive.namelist()
        packed = {name: _contents(io.BytesIO(archive.read(name))) for name in names if name.endswith(".whl")}
    problems = [f"{path.name} lacks {name}" for name in _NEEDED if name not in names]
    problems += [f"{path.name} has {name}" for name in names if "__pycache__" in name or name.endswith(".in")]
    wheels = {f"wheels/{wheel.name}": wheel for wheel in places.wheels()}
    if len(packed) != 1 or not packed.keys() <= wheels.keys():
        problems.append(f"{path.name} must have one wheel of this release, and has {sorted(packed)}")
    elif any(contents != _contents(wheels[name]) for name, contents in packed.items()):
        problems.append(f"the wheel in {path.name} has other files than the one in {places.FILES.name}/")
    size = path.stat().st_size
    return problems + ([f"{path.name} has {size:,} bytes, more than {LIMIT:,}"] if size > LIMIT else [])


def _contents(archive: Path | io.BytesIO) -> dict[str, bytes]:
    with zipfile.ZipFile(archive) as opened:
        return {name: opened.read(name) for name in opened.namelist()}


def index(log: Path | None = None) -> Path:
    """The index of the zips, index.json for Blender and index.html for people, made by Blender's own tool.

    It is read again, by itself and as Blender reads it: Blender's tool finds the extension there, and
    installs the zip of this platform.
    """
    blender = environment.any_blender()
    repository = places.zips()[0].parent
    distribution.blender_ext(blender, "server-generate", "--repo-dir", repository, "--html", log=log)
    path = repository / "index.json"
    refuse_any(problems_of_index(path))
    local = places.WORK / "installed"
    shutil.rmtree(local, ignore_errors=True)
    local.mkdir(parents=True)
    place = ("--remote-url", path.as_uri(), "--local-dir", local)
    distribution.blender_ext(blender, "sync", *place, log=log)
    versions = ("--blender-version", "5.2.0", "--python-version", "3.13.0")
    distribution.blender_ext(blender, "install", *place, *versions, "authalic", log=log)
    refuse_any([] if (local / "authalic" / "__init__.py").is_file() else ["the index installs nothing"])
    return path


def problems_of_index(path: Path) -> list[str]:
    """What of an index does not agree with the zips beside it, a sentence each."""
    listing = json.loads(path.read_text(encoding="utf-8"))
    zips = {zipped.name: zipped for zipped in sorted(path.parent.glob("*.zip"))}
    rows = {Path(row["archive_url"]).name: row for row in listing["data"]}
    problems = (
        [] if listing["version"] == "v1" else [f"the index has the version {listing['version']}, not v1"]
    )
    problems += [f"the index lacks {name}" for name in sorted(zips.keys() - rows.keys())]
    problems += [f"the index names {name}, which is not there" for name in sorted(rows.keys() - zips.keys())]
    for name in sorted(zips.keys() & rows.keys()):
        data = zips[name].read_bytes()
        wanted = {
            "id": "authalic",
            "version": version(),
            "archive_url": f"./{name}",
            "archive_size": len(data),
            "archive_hash": f"sha256:{hashlib.sha256(data).hexdigest()}",
            "platforms": [name.partition(f"-{version()}-")[2].partition(".")[0]],
        }
        differing = [key for key, value in wanted.items() if rows[name].get(key) != value]
        problems += [f"{key} of {name} is {rows[name].get(key)!r} in the index" for key in differing]
    return problems
