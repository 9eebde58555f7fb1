# SPDX-License-Identifier: GPL-3.0-or-later
"""The colors of a heat map, and the colored triangles that it consists of. Plain numpy, no bpy."""

from dataclasses import dataclass

import numpy as np

from .arrays import Booleans, Floats, Integers, Reals, Singles
from .polygons import Polygons
from .surface import Surface

AREA, SHEAR = "AREA", "SHEAR"
Color = tuple[float, float, float]

# The stripes of a flipped triangle, and those of each where there are very many.
_STRIPES, _FEW_STRIPES, _VERY_MANY = 8, 2, 20_000


@dataclass(frozen=True)
class Colors:
    """The colors of what is too small, as it should be and too large, and of the stripes on flipped faces."""

    small: Color = (0.1, 0.35, 1.0)
    fair: Color = (0.55, 0.55, 0.55)
    large: Color = (0.95, 0.25, 0.1)
    flipped: Color = (1.0, 0.85, 0.0)
    between_stripes: Color = (0.1, 0.1, 0.1)


@dataclass(frozen=True)
class Scale:
    """The quantity, `AREA` or `SHEAR`, and its value at the end of the scale: a factor above 1.

    Areas run from one over this factor through 1 to the factor, by their logarithm; shear from 1 to it.
    """

    quantity: str
    end: float

    def place(self, values: Reals) -> Floats:
        """Where values lie, from -1 (too small) through 0 (as it should be) to 1 (too large)."""
        with np.errstate(divide="ignore"):
            places = np.log2(np.maximum(values, 0)) / np.log2(self.end)
        if self.quantity == SHEAR:
            places = (values - 1) / (self.end - 1)
        clipped: Floats = np.clip(places, self.lowest, 1)
        return clipped

    def ticks(self) -> list[tuple[float, str]]:
        """The places, from the lower end 0 to the upper end 1, and the texts of the numbers of a legend."""
        if self.quantity == AREA:
            values = [self.end**power for power in (-1, -0.5, 0, 0.5, 1)]
        else:
            values = [1 + part * (self.end - 1) for part in (0, 0.5, 1)]
        places = np.linspace(0, 1, len(values)).tolist()
        return [(place, f"{value:.3g}") for place, value in zip(places, values, strict=True)]

    @property
    def lowest(self) -> float:
        """The place of the lower end."""
        return -1.0 if self.quantity == AREA else 0.0


def steps(scale: Scale, count: int) -> Floats:
    """Places (count,) along a legend, from the lower end to the upper one."""
    return np.linspace(scale.lowest, 1, count)


def ramp(places: Reals, colors: Colors) -> Singles:
    """The colors (n, 3) at places (n,) from -1 to 1."""
    amount, fair = np.abs(places)[:, None], np.array(colors.fair)
    end = np.where(places[:, None] > 0, colors.large, colors.small)
    mixed: Singles = (fair + (end - fair) * amount).astype(np.float32)
    return mixed


def polygon_colors(polygons: Polygons, scale: Scale, colors: Colors) -> Singles:
    """The colors (p, 3) of polygons that are not flipped."""
    values = polygons.ratios if scale.quantity == AREA else polygons.shears
    return ramp(scale.place(values), colors)


@dataclass
class Painted:
    """Triangles to be drawn in this order: the corners `points` (3k, 3) with `colors` (3k, 4)."""

    points: Singles
    colors: Singles


def painted(
    points: Singles, triangles: Integers, colors: Singles, folded: Booleans, look: Colors, alpha: float
) -> Painted:
    """Triangles (t, 3) between points (n, 3) with colors (t, 3); those that are `folded` (t,) get stripes.

    These come last, over all others.
    """
    plain = points[triangles[~folded]].reshape(-1, 3)
    striped, kinds = _stripes(points[triangles[folded]])
    of_stripes = np.array([look.flipped, look.between_stripes], np.float32)[kinds]
    return Painted(
        np.concatenate([plain, striped.reshape(-1, 3)]),
        _at_corners(np.concatenate([colors[~folded], of_stripes]), alpha),
    )


def _at_corners(colors: Singles, alpha: float) -> Singles:
    """The color (3k, 4) of each corner of triangles with colors (k, 3)."""
    values = np.full((len(colors), 3, 4), alpha, np.float32)
    values[:, :, :3] = colors[:, None]
    return values.reshape(-1, 4)


def _stripes(triangles: Singles) -> tuple[Singles, Integers]:
    """Triangles (t, 3, 3) cut into stripes: triangles (s, 3, 3), and which of two colors each has (s,)."""
    count = _STRIPES if len(triangles) <= _VERY_MANY else _FEW_STRIPES
    apex, *ends = (triangles[:, None, corner] for corner in range(3))
    levels = np.linspace(0, 1, count + 1, dtype=np.float32)[None, :, None]
    left, right = (apex + levels * (end - apex) for end in ends)
    halves = [(left[:, :-1], left[:, 1:], right[:, 1:]), (left[:, :-1], right[:, 1:], right[:, :-1])]
    cut = np.stack([np.stack(half, axis=2) for half in halves], axis=2)
    kinds = np.broadcast_to(np.arange(count)[None, :, None] % 2, cut.shape[:3])
    return cut.reshape(-1, 3, 3), kinds.reshape(-1)


@dataclass
class Values:
    """The figures of the polygons (p,) of a mesh whose triangles (t, 3), of `polygons` (t,), are to be drawn.

    Their points are `points` (n, 3).
    """

    points: Singles
    triangles: Integers
    polygons: Integers
    figures: Polygons

    def painted(self, scale: Scale, look: Colors, alpha: float) -> Painted:
        """The triangles in the colors of a scale."""
        colors = polygon_colors(self.figures, scale, look)[self.polygons]
        return painted(self.points, self.triangles, colors, self.figures.folded[self.polygons], look, alpha)


def in_space(surface: Surface, points: Singles, figures: Polygons, hidden: Booleans | None) -> Values:
    """The figures of a surface where its vertices are at points (n, 3), without polygons that are hidden."""
    return _finite(points, surface.triangles, surface, figures, hidden)


def in_plane(surface: Surface, figures: Polygons, hidden: Booleans | None) -> Values:
    """The figures of a surface in its UV map, without polygons that are hidden."""
    points = np.zeros((len(surface.uvs), 3), np.float32)
    points[:, :2] = surface.uvs
    return _finite(points, surface.corners, surface, figures, hidden)


def _finite(
    points: Singles,
    triangles: Integers,
    surface: Surface,
    figures: Polygons,
    hidden: Booleans | None,
) -> Values:
    """`Values` of the visible triangles between points that are numbers."""
    keep = np.isfinite(points).all(axis=1)[triangles].all(axis=1)
    if hidden is not None:
        keep &= ~hidden[surface.polygons]
    return Values(points, triangles[keep], surface.polygons[keep], figures)
