# SPDX-License-Identifier: MIT OR Apache-2.0
"""Prints the names of the libraries that a library for Windows loads. It runs in .venv/release.

Usage: python read_dll.py FILE
"""

import sys

import pefile

_TABLES = ("IMAGE_DIRECTORY_ENTRY_IMPORT", "IMAGE_DIRECTORY_ENTRY_DELAY_IMPORT")


def main(path: str) -> None:
    with pefile.PE(path, fast_load=True) as library:
        library.parse_data_directories([pefile.DIRECTORY_ENTRY[table] for table in _TABLES])
        loaded = getattr(library, "DIRECTORY_ENTRY_IMPORT", [])
        loaded += getattr(library, "DIRECTORY_ENTRY_DELAY_IMPORT", [])
    print("\n".join(entry.dll.decode() for entry in loaded))


main(*sys.argv[1:])
