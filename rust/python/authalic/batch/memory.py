# SPDX-License-Identifier: MIT OR Apache-2.0
"""How much memory a subject needs, guessed from the size of its file."""

from pathlib import Path

from ..io import FileError, mesh_format

PROCESS = 200_000_000
"""Bytes of a worker without a surface."""
PER_VERTEX = 12_000
"""Bytes for each vertex of a map: 9,500 were measured at 10,000 vertices, 11,900 at 164,000."""


def estimate(surface: Path, format: str | None) -> int:
    """Bytes that the run of a surface takes; the least possible if the file cannot be looked at."""
    try:
        size, per_vertex = surface.stat().st_size, mesh_format(surface, format).bytes_per_vertex
    except (OSError, FileError):
        return PROCESS
    return PROCESS + size // per_vertex * PER_VERTEX


def in_words(size: float) -> str:
    return f"{size / 1e9:.1f} GB"
