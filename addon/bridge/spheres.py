# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed meshes on the sphere."""

import numpy as np

import authalic

from .. import messages
from ..messages import problems
from ..surfaces import spherical, suitability, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from .progress import Progress, keep_going
from .results import SphereShape
from .shortfall import UNEVEN_SPHERE, shortfall
from .solver import Solver

_OF_A_KEY = "its limbs may be too long or too thin, or its n-gons too large (poke them)"


def sphere_shape(
    surface: Surface, solver: Solver | None = None, progress: Progress = keep_going
) -> SphereShape:
    """The vertices of a closed mesh (`Surface`) on the sphere of its area, about its area's centre.

    When `progress` returns False, as they are by then. Raises `Unsuitable`, in the words of an artist, where
    there is no such map.
    """
    solver = solver or Solver()
    mesh = triangulation.sound(surface)
    vertices = np.append(np.arange(len(surface.positions)), np.full(len(mesh.positions), -1))
    try:
        used, patches = _whole(mesh)
        suitability.check_closed_mesh(used, len(surface.positions), patches)
        found, positions, turned = sphere_map(mesh.positions, mesh.triangles, solver, progress)
    except (authalic.MeshError, authalic.SolverError) as error:
        raise Unsuitable(problems.in_words(error, mesh.polygons, vertices)) from error
    centre = spherical.centroid(mesh.positions, mesh.triangles)
    radius = spherical.radius(mesh.positions, mesh.triangles)
    written = (centre + radius * positions).astype(np.float32)
    faces = np.where(turned[:, None], mesh.triangles[:, ::-1], mesh.triangles)
    if spherical.volume(mesh.positions, faces) < 0:
        faces = faces[:, ::-1]
    figures = authalic.distortion(mesh.positions, faces, written - centre)
    if len(figures.folded):
        raise Unsuitable(
            f"{messages.count(len(figures.folded), 'triangle')} would fold over in the precision of "
            "coordinates; remesh its thin parts"
        )
    return SphereShape(
        positions=written[: len(surface.positions)],
        radius=float(radius),
        deviation=float(figures.area_ratio_std),
        flips=len(figures.folded),
        angle=float(figures.angle_distortion_mean),
        shortfall=shortfall(found.status, figures, solver, UNEVEN_SPHERE, _OF_A_KEY),
        ended_early=found.status == "cancelled",
    )


def _whole(mesh: triangulation.Triangles) -> tuple[Integers, list[authalic.Patch]]:
    """The vertices (u,) that have triangles, and the pieces that these make up."""
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    # A bad coordinate is for the solver to name.
    points = np.nan_to_num(mesh.positions[used], posinf=0, neginf=0)
    return used, authalic.cut(points, faces.reshape(-1, 3))


def sphere_map(
    points: Floats, faces: Integers, solver: Solver, progress: Progress
) -> tuple[authalic.SphereMap, Floats, Booleans]:
    """A sphere map, its positions laid over the surface, and which faces (m,) it has turned over."""
    found = authalic.sphere_map(points, faces, progress=progress, **solver.sphere_options())
    is_poor = found.status == "stalled" and solver.puts_areas_first
    if is_poor or _is_thin(found):  # coarse meshes may come out worse than the start
        start = authalic.sphere_map(points, faces, method="fixed_point", max_iterations=0)
        found = min(found, start, key=lambda map_: (_is_thin(map_), map_.distortion.authalic_energy))
    oriented = np.asarray(found.faces)
    over = spherical.over_surface(points, oriented, np.array(found.positions))
    return found, over, spherical.turned(faces, oriented)


def _is_thin(found: authalic.SphereMap) -> bool:
    return spherical.is_thin(np.asarray(found.positions), np.asarray(found.faces))
