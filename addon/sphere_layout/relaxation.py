# SPDX-License-Identifier: GPL-3.0-or-later
"""Evens out what straight edges do to areas, near poles and across creases. Plain numpy, no bpy.

Levenberg-Marquardt steps on the authalic energy, sum of (area - wanted)^2 / wanted over the faces, in the
places of the vertices. Each step is solved roughly by conjugate gradients with a diagonal preconditioner:
what straight edges do is local. Where a step would fold a face over, or nearly, it is shortened.
"""

import numpy as np

from ..surfaces import triangulation
from .untangle import folded

_STEPS = 3
# Steps where areas are off by more than this even then, as where limbs are a face wide, and their damping.
_MORE_STEPS = 30
_EVEN = 0.03
_STIFFEST = 100.0
_COARSE = 2000
_ITERATIONS = 20
_DAMPING = 1e-2
_HALVINGS = 20
# Faces must not shrink below this part of the area wanted or, smaller ones, below this part of their own.
_LEAST, _SHRINK = 0.4, 0.9


def relax(chart, areas, movable):
    """Moves places of a `charts.Chart` so that its faces' areas come closer to `areas` (m,).

    Vertices that are not in the mask `movable` (n,) stay. Folded faces may unfold; no other one folds over.
    """
    for _ in range(_STEPS):
        if not _descend(chart, areas, movable, _DAMPING):
            return


def even_out(chart, polygons, areas, movable):
    """Goes on where `relax` has left areas far from proportional to `areas` (m,), with damping that adapts.

    Not in coarse meshes with polygons (m,) of several faces, such as UV spheres, whose rows are to stay rows.
    """
    if len(chart.faces) < _COARSE and len(np.unique(polygons)) < len(chart.faces):
        return
    areas = areas * (triangulation.signed_areas(chart.uv()).sum() / areas.sum())
    damping = _DAMPING
    for _ in range(_MORE_STEPS):
        if damping > _STIFFEST or _energy(chart, areas) < _EVEN**2 * areas.sum():
            return
        lower = _descend(chart, areas, movable, damping)
        damping = max(damping / 3, _DAMPING) if lower else 10 * damping


def _descend(chart, areas, movable, damping):
    """One step, unless it does not lower the energy; returns whether it does."""
    before, energy = chart.places, _energy(chart, areas)
    _move(chart, _step(chart, areas, movable, damping), areas, movable)
    if _energy(chart, areas) < energy:
        return True
    chart.places = before
    return False


def _energy(chart, areas):
    return ((triangulation.signed_areas(chart.uv()) - areas) ** 2 / areas).sum()


def _move(chart, step, areas, movable):
    """Moves the places by a step (n, 2), less far where faces would fold over that do not."""
    start, uv = chart.places, chart.uv()
    least = np.minimum(_LEAST * areas, _SHRINK * triangulation.signed_areas(uv))
    least[folded(uv)] = -np.inf
    length = np.ones((len(start), 1))
    for halving in range(_HALVINGS):
        chart.places = start + length * step
        uv = chart.uv()
        bad = triangulation.signed_areas(uv) < least
        new = folded(uv)
        bad[new] |= np.isfinite(least[new])
        outside = ~chart.layout.within(chart.places) & movable & (length[:, 0] > 0)
        if not (bad.any() or outside.any()):
            return
        length[np.unique(chart.faces[bad])] *= 0.5 if halving < _HALVINGS // 2 else 0.0
        length[outside] = 0
    chart.places = start


def _step(chart, areas, movable, damping):
    """The movement (n, 2) of the places by one damped Gauss-Newton step."""
    uv, faces, count = chart.uv(), chart.faces, len(chart.places)
    gradient = _area_gradients(uv)
    at_pole = chart.polar[:2]
    gradient[at_pole[0], :, 0] += (
        gradient[at_pole][:, None, 0] / 2
    )  # that corner is in the middle of the others
    gradient *= (chart.moves.signs * movable[faces])[..., None]
    flat = faces.ravel()

    def gathered(values):
        """Values (m, 3, 2) at corners, summed up at the vertices."""
        return np.stack([np.bincount(flat, values[..., axis].ravel(), count) for axis in (0, 1)], axis=1)

    diagonal = gathered(gradient**2 / areas[:, None, None]).sum(axis=1, keepdims=True) / 2
    diagonal[diagonal <= 0] = 1

    def product(step):
        change = (gradient * step[faces]).sum(axis=(1, 2))
        return gathered(gradient * (change / areas)[:, None, None]) + damping * diagonal * step

    residual = (areas - triangulation.signed_areas(uv)) / areas
    return _conjugate_gradients(product, gathered(gradient * residual[:, None, None]), diagonal)


def _area_gradients(uv):
    """How the areas of triangles (m, 3, 2) change with their corners, (m, 3, 2)."""
    across = np.roll(uv, -1, axis=1) - np.roll(uv, -2, axis=1)
    return np.stack([across[..., 1], -across[..., 0]], axis=-1) / 2


def _conjugate_gradients(product, right, diagonal):
    """Some iterations towards the solution x of product(x) = right."""
    solution, residual = np.zeros_like(right), right
    towards = residual / diagonal
    direction, norm = towards, (residual * towards).sum()
    for _ in range(_ITERATIONS):
        if norm <= 0:
            break
        image = product(direction)
        length = norm / (direction * image).sum()
        solution, residual = solution + length * direction, residual - length * image
        towards = residual / diagonal
        previous, norm = norm, (residual * towards).sum()
        direction = towards + norm / previous * direction
    return solution
