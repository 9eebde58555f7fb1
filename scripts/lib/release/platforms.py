# SPDX-License-Identifier: MIT OR Apache-2.0
"""The platforms that have wheels, and how each is built on a machine of its own."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Mapping

import distribution
from shell import Unavailable


@dataclass(frozen=True)
class Platform:
    """How maturin builds the wheel of a platform."""

    options: tuple[str, ...]
    variables: Mapping[str, str] = field(default_factory=dict)

    @property
    def needs_zig(self) -> bool:
        return "--zig" in self.options


_OLDEST_MACOS = {"MACOSX_DEPLOYMENT_TARGET": "11.0"}
PLATFORMS = {
    "linux-x64": Platform(distribution.PORTABLE),
    "linux-arm64": Platform(distribution.PORTABLE),
    "musl-x64": Platform(
        ("--zig", "--compatibility", "musllinux_1_2", "--target", "x86_64-unknown-linux-musl")
    ),
    "macos-arm64": Platform(("--target", "aarch64-apple-darwin"), _OLDEST_MACOS),
    "macos-x64": Platform(("--target", "x86_64-apple-darwin"), _OLDEST_MACOS),
    "windows-x64": Platform(()),
    "windows-arm64": Platform(()),
}
"""By Blender's names, except for the Linux without glibc, where there is no Blender."""
FREE_THREADED = "3.14t"
"""The Python without a global lock that has wheels of its own: the stable interface leaves it out."""


def named(name: str | None) -> Platform:
    """A platform by its name; this machine's by default."""
    name = name or distribution.platform()
    if name not in PLATFORMS:
        raise Unavailable(f"there are no wheels for {name}, only for {', '.join(PLATFORMS)}")
    return PLATFORMS[name]
