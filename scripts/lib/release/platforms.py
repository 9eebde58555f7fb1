# SPDX-License-Identifier: MIT OR Apache-2.0
"""The platforms that have wheels, and how each is built on a machine of its own."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Mapping

import distribution
from shell import Unavailable


@dataclass(frozen=True)
class Platform:
    """The target of the compiler, and how maturin builds the wheel of a platform."""

    target: str
    options: tuple[str, ...]
    variables: Mapping[str, str] = field(default_factory=dict)

    @property
    def needs_zig(self) -> bool:
        return "--zig" in self.options


_OLDEST_MACOS = {"MACOSX_DEPLOYMENT_TARGET": "11.0"}
PLATFORMS = {
    "linux-x64": Platform("x86_64-unknown-linux-gnu", distribution.PORTABLE),
    "linux-arm64": Platform("aarch64-unknown-linux-gnu", distribution.PORTABLE),
    "musl-x64": Platform(
        "x86_64-unknown-linux-musl",
        ("--zig", "--compatibility", "musllinux_1_2", "--target", "x86_64-unknown-linux-musl"),
    ),
    "macos-arm64": Platform("aarch64-apple-darwin", ("--target", "aarch64-apple-darwin"), _OLDEST_MACOS),
    "macos-x64": Platform("x86_64-apple-darwin", ("--target", "x86_64-apple-darwin"), _OLDEST_MACOS),
    "windows-x64": Platform("x86_64-pc-windows-msvc", ("--target", "x86_64-pc-windows-msvc")),
    "windows-arm64": Platform("aarch64-pc-windows-msvc", ("--target", "aarch64-pc-windows-msvc")),
}
"""By Blender's names, except for the Linux without glibc, where there is no Blender."""
FREE_THREADED = "3.14t"
"""The Python without a global lock that has wheels of its own: the stable interface leaves it out."""


def of_wheel(wheel: Path) -> Platform:
    """The platform of a wheel, by its name."""
    return named("musl-x64" if "-musllinux_" in wheel.name else distribution.platform_of(wheel))


def named(name: str | None) -> Platform:
    """A platform by its name; this machine's by default."""
    name = name or distribution.platform()
    if name not in PLATFORMS:
        raise Unavailable(f"there are no wheels for {name}, only for {', '.join(PLATFORMS)}")
    return PLATFORMS[name]
