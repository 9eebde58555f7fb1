# SPDX-License-Identifier: MIT OR Apache-2.0
"""The folders of a release, and its files by their names."""

from __future__ import annotations

from pathlib import Path

from shell import DIST, OUT, Unavailable, version

FILES = DIST / "release"
"""What goes to the Python registry: the sdist and the wheels."""
REPOSITORY = FILES / "extensions"
"""What Blender reads: the zips and the index of them."""
WORK = OUT / "release"
"""What is needed on the way."""


def sdist() -> Path:
    """The sdist of this version."""
    return _existing([FILES / f"authalic-{version()}.tar.gz"], "scripts/release sdist")[0]


def wheels() -> list[Path]:
    """All wheels of this version, sorted."""
    return _existing(sorted(FILES.glob(f"authalic-{version()}-*.whl")), "scripts/release wheel")


def zips() -> list[Path]:
    """All extension zips of this version, sorted."""
    return _existing(sorted(REPOSITORY.glob(f"authalic-{version()}-*.zip")), "scripts/release zips")


def _existing(paths: list[Path], maker: str) -> list[Path]:
    if not paths or not all(path.exists() for path in paths):
        raise Unavailable(f"what `{maker}` makes is missing: run it before")
    return paths
