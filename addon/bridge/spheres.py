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
from . import known, remedies
from .patches import checked, cut
from .progress import Progress, keep_going
from .results import SphereShape
from .shortfall import UNEVEN_SPHERE, shortfall
from .solver import Solver


def sphere_shape(
    surface: Surface, solver: Solver | None = None, progress: Progress = keep_going
) -> SphereShape:
    """The vertices of a closed mesh (`Surface`) on the sphere of its area, about the center of its area.

    When `progress` returns False, the map is the best so far. Raises `Unsuitable`, in the words of an artist,
    if there is no such map.
    """
    solver = solver or Solver()
    mesh = triangulation.sound(surface)
    vertices = np.append(np.arange(len(surface.positions)), np.full(len(mesh.positions), -1))
    try:
        used, patches = _whole(mesh)
        suitability.check_closed_mesh(used, mesh.positions, len(surface.positions), patches)
        # one piece of all vertices has the numbers of the mesh
        native = checked(patches[0], mesh.positions)
        sphere, over, turned = sphere_map(native, solver, progress)
    except (authalic.MeshError, authalic.SolverError) as error:
        raise Unsuitable(problems.in_words(error, mesh.polygons, vertices)) from error
    center = spherical.centroid(mesh.positions, mesh.triangles)
    radius = spherical.radius(mesh.positions, mesh.triangles)
    written = (center + radius * (np.asarray(sphere.positions) @ over)).astype(np.float32)
    faces = np.where(turned[:, None], mesh.triangles[:, ::-1], mesh.triangles)
    # a mesh whose faces look inward lies mirrored on the sphere
    outward = -1 if spherical.volume(mesh.positions, faces) < 0 else 1
    figures = authalic.distortion(native, outward * (written - center))
    if len(figures.folded):
        raise Unsuitable(
            f"{messages.count(len(figures.folded), 'triangle')} would fold over in the precision of "
            "coordinates; remesh its thin parts"
        )
    deviation, angle = float(figures.area_ratio_std), float(figures.angle_distortion_mean)
    remedy = remedies.of_sphere(mesh.polygons)
    return SphereShape(
        positions=written[: len(surface.positions)],
        radius=float(radius),
        deviation=deviation,
        flips=len(figures.folded),
        angle=angle,
        shortfall=shortfall(sphere.status, (deviation, angle), solver, UNEVEN_SPHERE, remedy),
        ended_early=sphere.status == "cancelled",
    )


def _whole(mesh: triangulation.Triangles) -> tuple[Integers, list[authalic.Patch]]:
    """The vertices (u,) that have triangles, and the pieces of the mesh."""
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    return used, cut(mesh.positions[used], faces.reshape(-1, 3))


def sphere_map(
    surface: authalic.Surface, solver: Solver, progress: Progress, density: Floats | None = None
) -> tuple[authalic.SphereMap, Floats, Booleans]:
    """A sphere map, the matrix that lays it over the surface, and a mask (m,) of the faces it has turned.

    `density` (m,), if there is one, are the areas that faces are to get, on any scale.
    """
    options = {"density": density, **solver.sphere_options()}
    sphere = known.result(authalic.sphere_map, surface, options, progress)
    is_poor = sphere.status == "stalled" and solver.puts_areas_first
    if is_poor or _is_thin(sphere):  # coarse meshes may come out worse than the start
        options = {"method": "fixed_point", "max_iterations": 0, "density": density}
        start = known.result(authalic.sphere_map, surface, options, keep_going)
        sphere = min(sphere, start, key=lambda each: (_is_thin(each), each.distortion.authalic_energy))
    oriented = np.asarray(sphere.faces)
    over = spherical.over_surface(np.asarray(surface.vertices), oriented, np.asarray(sphere.positions))
    return sphere, over, spherical.turned(np.asarray(surface.faces), oriented)


def _is_thin(sphere: authalic.SphereMap) -> bool:
    return spherical.is_thin(np.asarray(sphere.positions), np.asarray(sphere.faces))
