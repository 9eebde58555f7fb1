# SPDX-License-Identifier: MIT OR Apache-2.0
"""Installs the tools of the comparison; a tool that cannot be installed becomes a message."""

from __future__ import annotations

import environment
from environment import Environment
from shell import CommandFailed, Unavailable, say, tail, warn

PACKAGES = ("libigl", "xatlas", "lapy")
WRAPPERS = ("pyfmaps", "pygeodesic")
"""Maps between surfaces, and distances to measure them by."""


def packages(dev: Environment, wanted: tuple[str, ...] = PACKAGES) -> dict[str, str]:
    """Installs each wanted peer into the environment; returns {package: why it is missing}."""
    absent = {}
    for package in wanted:
        try:
            environment.add(dev, f"peer-{package}")
        except CommandFailed as failure:
            absent[package] = tail(failure.output, 1)
            warn(f"{package} is left out: {absent[package]}")
    return absent


def blender() -> tuple[str, str]:
    """(The interpreter that has the newest Blender as a module, ""), or ("", why there is none)."""
    try:
        newest = environment.any_blender()
    except Unavailable as reason:
        warn(f"Blender is left out: {reason}")
        return "", str(reason)
    say(f"{newest.label} is one of the peers")
    return str(newest.python), ""
