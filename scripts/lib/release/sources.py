# SPDX-License-Identifier: MIT OR Apache-2.0
"""The sdist: from a clean copy of the sources, unpacked without git."""

from __future__ import annotations

import shutil
import subprocess
import tarfile
from pathlib import Path

import changelog
import environment
from release import places
from release.problems import refuse_any
from shell import ROOT, run, version

# What commands leave among the sources, where there is no git to ask.
_LEFT_BEHIND = (".git", ".venv", "target", "dist", "out", "__pycache__", ".*_cache", "*.so", "*.pyd")


def build(log: Path | None = None) -> Path:
    """The sdist in dist/release/, from a copy of the sources without anything that commands left in them."""
    _build(places.FILES, log)
    return places.sdist()


def build_again(log: Path | None = None) -> None:
    """Builds the sdist a second time, from a new copy of the sources, and compares the bytes."""
    first, folder = places.sdist(), places.WORK / "again"
    _build(folder, log)
    is_same = (folder / first.name).read_bytes() == first.read_bytes()
    refuse_any([] if is_same else [f"two builds of {first.name} differ; both are kept"])


def unpack(folder: Path) -> Path:
    """Empties a folder and unpacks the sdist into it; returns the top of the sources."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    with tarfile.open(str(places.sdist())) as archive:
        archive.extractall(str(folder))
    return folder / f"authalic-{version()}"


def _build(folder: Path, log: Path | None) -> None:
    copy = places.WORK / "sources"
    _copy_sources(copy)
    folder.mkdir(parents=True, exist_ok=True)
    maturin = [environment.build().python, "-m", "maturin", "sdist", "--manifest-path"]
    variables = {"SOURCE_DATE_EPOCH": changelog.source_date_epoch()}
    run([*maturin, copy / "rust/python/Cargo.toml", "--out", folder], variables, log)


def _copy_sources(target: Path) -> None:
    shutil.rmtree(target, ignore_errors=True)
    known = _known_to_git()
    if known is None:
        shutil.copytree(ROOT, target, ignore=shutil.ignore_patterns(*_LEFT_BEHIND))
        return
    for name in known:
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, target / name)


def _known_to_git() -> list[str] | None:
    """The files that git has or would add; None without git."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    try:
        done = subprocess.run(command, cwd=str(ROOT), capture_output=True, text=True)
    except OSError:
        return None
    names = sorted(set(filter(None, done.stdout.split("\0"))))
    return [name for name in names if (ROOT / name).is_file()] if done.returncode == 0 else None
