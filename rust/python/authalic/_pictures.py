# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results in notebooks: a small picture, and what `repr` says.

Maps are drawn by what they do to areas: white where a face has its share, blue where less, red where more,
as the logarithm to base 2 from -1 to 1. The disk is seen from above, and the sphere from two sides.
"""

import base64
import html as markup
import struct
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native

_SIDE = 128
"""Pixels of a side of a picture."""

_BLUE, _WHITE, _RED = (np.array(color, float) for color in ((59, 76, 192), (245, 245, 245), (180, 4, 38)))


def html(result: _native.Result) -> str:
    """The result as HTML."""
    text = f"<code>{markup.escape(repr(result))}</code>"
    values = _area_values(result)
    if values is None:
        return text
    data = base64.b64encode(_png(_colors(values))).decode()
    title = "log2 of the area ratio: blue -1, white 0, red 1"
    return f'<div><img src="data:image/png;base64,{data}" alt="{title}" title="{title}"><br>{text}</div>'


def _area_values(result: _native.Result) -> NDArray[np.float64] | None:
    """log2 of the area ratio at the pixels of a map's picture, NaN outside; None for other results."""
    if isinstance(result, _native.DiskMap):
        return _at(result, _plane(result.uv))
    if isinstance(result, _native.SphereMap):
        x, z = np.meshgrid(*2 * [_steps()])
        y = np.sqrt(np.maximum(1 - x * x - z * z, 0))
        front = np.stack([x, -y, -z], axis=-1)
        back = front * [-1, -1, 1]
        inside = x * x + z * z < 1
        views = [np.where(inside, _at(result, points), np.nan) for points in (front, back)]
        return np.hstack(views).astype(np.float64)
    return None


def _plane(uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """The pixels of a square around the image of a disk or rectangle, (side, side, 2)."""
    low, high = uv.min(axis=0), uv.max(axis=0)
    half = 0.5 * (high - low).max()
    u, v = np.meshgrid(*2 * [half * _steps()])
    return np.stack([u, -v], axis=-1) + 0.5 * (low + high)


def _steps() -> NDArray[np.float64]:
    """The centers of a row of pixels from -1 to 1."""
    return np.asarray((np.arange(_SIDE) + 0.5) * (2 / _SIDE) - 1, np.float64)


def _at(result: Any, points: NDArray[np.float64]) -> NDArray[np.float64]:
    flat = result.sample(result.distortion.log2_area_ratio, points.reshape(-1, points.shape[-1]), per="face")
    return np.asarray(flat).reshape(points.shape[:-1])


def _colors(values: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Red, green, blue and opacity of each pixel, (rows, columns, 4)."""
    outside = np.isnan(values)
    shade = np.clip(np.where(outside, 0, values), -1, 1)[..., None]
    color = _WHITE + np.abs(shade) * (np.where(shade < 0, _BLUE, _RED) - _WHITE)
    return np.concatenate([color, np.where(outside, 0, 255)[..., None]], axis=-1).astype(np.uint8)


def _png(pixels: NDArray[np.uint8]) -> bytes:
    """The bytes of a PNG file (RFC 2083) of pixels (rows, columns, 4)."""
    rows, columns, _ = pixels.shape
    header = struct.pack(">IIBBBBB", columns, rows, 8, 6, 0, 0, 0)
    # each row begins with the number of its filter: none
    lines = np.pad(pixels.reshape(rows, -1), ((0, 0), (1, 0))).tobytes()
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(lines)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )
