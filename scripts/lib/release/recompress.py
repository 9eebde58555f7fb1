# SPDX-License-Identifier: MIT OR Apache-2.0
"""Writes an archive anew with Zopfli, which packs more tightly. It runs in .venv/release.

Usage: python recompress.py OLD.zip NEW.zip
"""

import sys
import zipfile

import zopfli

_ITERATIONS = 5  # more take minutes and win nothing


def main(old: str, new: str) -> None:
    with zipfile.ZipFile(old) as source, zopfli.ZipFile(new, "w", iterations=_ITERATIONS) as target:
        for info in source.infolist():
            target.writestr(info, source.read(info))


main(*sys.argv[1:])
