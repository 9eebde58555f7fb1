# SPDX-License-Identifier: MIT OR Apache-2.0
"""Triangles on a grid of points: the one rasterizer of the overlap and of the pictures.

A triangle covers the points (i + 1/2, j + 1/2) inside it. A point on an edge between two triangles belongs
to exactly one of them: both compute the place where a row of points meets the edge from the same numbers.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Spans:
    """The runs of points in the rows of triangles: the points start ≤ i < stop of row j."""

    triangle: np.ndarray
    row: np.ndarray
    start: np.ndarray
    stop: np.ndarray

    def points(self):
        """The triangle, the column and the row of every point."""
        lengths = self.stop - self.start
        first = np.cumsum(lengths) - lengths
        column = np.arange(lengths.sum()) - np.repeat(first - self.start, lengths)
        return np.repeat(self.triangle, lengths), column, np.repeat(self.row, lengths)


def spans(triangles):
    """The spans of triangles (t, 3, 2)."""
    low, middle, high = upward(triangles)
    first = np.ceil(low[:, 1] - 0.5).astype(int)
    rows = np.ceil(high[:, 1] - 0.5).astype(int) - first
    triangle = np.repeat(np.arange(len(triangles)), rows)
    row = np.arange(rows.sum()) - np.repeat(np.cumsum(rows) - rows - first, rows)
    height = row + 0.5
    below = height < middle[triangle, 1]
    start = np.where(below[:, None], low[triangle], middle[triangle])
    end = np.where(below[:, None], middle[triangle], high[triangle])
    sides = np.stack([crossing(low[triangle], high[triangle], height), crossing(start, end, height)])
    left, right = np.ceil(np.sort(sides, axis=0) - 0.5).astype(int)
    return Spans(triangle, row, left, right)


def upward(triangles):
    """The lowest, the middle and the highest corner of each triangle; of equally high ones the left first."""
    order = np.lexsort((triangles[:, :, 0], triangles[:, :, 1]), axis=1)
    return np.take_along_axis(triangles, order[:, :, None], axis=1).transpose(1, 0, 2)


def crossing(start, end, height):
    """Where lines from `start` up to `end` are at a height."""
    rise = end[:, 1] - start[:, 1]
    share = (height - start[:, 1]) / np.where(rise > 0, rise, 1)
    return start[:, 0] + share * (end[:, 0] - start[:, 0])


def barycentric(triangles, points):
    """The barycentric coordinates (p, 3) of points (p, 2), each in its own triangle (p, 3, 2)."""
    a, b, c = triangles.transpose(1, 0, 2)
    whole = cross(b - a, c - a)
    whole = np.where(whole == 0, 1, whole)
    second, third = cross(points - a, c - a) / whole, cross(b - a, points - a) / whole
    return np.stack([1 - second - third, second, third], axis=1)


def cross(a, b):
    """The cross products of vectors in the plane."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
