# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a native module for macOS or Windows needs of the system. Of those for Linux auditwheel says it."""

from __future__ import annotations

import re
import struct
from typing import Iterator, Sequence

# The header and the commands of a 64-bit Mach-O file, in the order of the bytes of all Macs that there are.
_MACH_O = b"\xcf\xfa\xed\xfe"
_LOAD_DYLIB, _LOAD_WEAK_DYLIB = 0xC, 0x80000018
_VERSION_MIN_MACOSX, _BUILD_VERSION = 0x24, 0x32
_OF_MACOS = ("/usr/lib/", "/System/Library/")
# What every Windows has, and the library of the compiler, which Python and Blender bring.
_OF_WINDOWS = (
    r"(kernel32|ntdll|advapi32|bcrypt|bcryptprimitives|userenv|ws2_32|ucrtbase|api-ms-win-[\w-]+"
    r"|vcruntime140|vcruntime140_1)\.dll"
)


def problems_on_macos(code: bytes, name: str) -> list[str]:
    """Why the native module of a wheel needs more than the macOS that the wheel's name says, if it does."""
    promised = re.search(r"-macosx_(\d+)_(\d+)_", name)
    commands = list(_commands(code))
    versions = [_oldest_macos(kind, command) for kind, command in commands]
    needed = [version for version in versions if version is not None]
    if not needed or promised is None:
        return [f"{name} does not say which macOS it needs"]
    libraries = [_library(command) for kind, command in commands if kind in (_LOAD_DYLIB, _LOAD_WEAK_DYLIB)]
    problems = [
        f"{name} needs macOS {major}.{minor}"
        for major, minor in needed
        if (major, minor) > (int(promised[1]), int(promised[2]))
    ]
    return problems + [
        f"{name} loads {library}" for library in libraries if not library.startswith(_OF_MACOS)
    ]


def problems_on_windows(libraries: Sequence[str], name: str) -> list[str]:
    """The libraries that a wheel must not load, a sentence each."""
    python = r"python3\.dll" if "-abi3-" in name else r"python3\d+t\.dll"
    allowed = rf"{_OF_WINDOWS}|{python}"
    return [
        f"{name} loads {library}"
        for library in libraries
        if not re.fullmatch(allowed, library, re.IGNORECASE)
    ]


def _commands(code: bytes) -> Iterator[tuple[int, bytes]]:
    """The load commands of a Mach-O file: what each is, and its bytes."""
    if code[:4] != _MACH_O or len(code) < 32:
        return
    place, [count] = 32, struct.unpack_from("<I", code, 16)
    for _ in range(count):
        kind, size = struct.unpack_from("<2I", code, place)
        yield kind, code[place : place + size]
        place += size


def _oldest_macos(kind: int, command: bytes) -> tuple[int, int] | None:
    """The oldest macOS that a command allows; None for other commands."""
    if kind not in (_VERSION_MIN_MACOSX, _BUILD_VERSION):
        return None
    [version] = struct.unpack_from("<I", command, 12 if kind == _BUILD_VERSION else 8)
    return version >> 16, version >> 8 & 0xFF


def _library(command: bytes) -> str:
    """The path of the library that a command loads."""
    [offset] = struct.unpack_from("<I", command, 8)
    return command[offset:].split(b"\0")[0].decode()
