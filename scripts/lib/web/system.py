# SPDX-License-Identifier: MIT OR Apache-2.0
"""The Debian system with a compiler for WebAssembly and a browser, for machines that have neither."""

from __future__ import annotations

from pathlib import Path
from typing import Mapping, Sequence

import debian

SUITE = "sid"
_PACKAGES = (
    *("rustc", "cargo", "libstd-rust-dev-wasm32", "lld", "gcc", "libc6-dev", "ca-certificates"),
    *("chromium", "chromium-driver", "fonts-dejavu-core"),
)


def command(
    words: Sequence[object], log: Path, bind: Sequence[Path] = (), variables: Mapping[str, str] | None = None
) -> list[str]:
    """The command that runs a command in the system, which is made on first use."""
    return debian.command(debian.system("site", SUITE, _PACKAGES, log), words, bind, variables)
