# SPDX-License-Identifier: MIT OR Apache-2.0
"""The methods of the bench: each takes a pair to the places of the source's vertices on the target."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial

import numpy as np

import authalic

SURFACE, AREA, ZOOMOUT = "authalic, surface", "authalic, area", "ZoomOut"
PACKAGE = "pyfmaps"
"""The distribution of pyFM; another project has that name in the registry."""
SIZE, STEP, FINAL = 30, 10, 200
"""The eigenfunctions of ZoomOut's first map, of each step and of its last map."""
ORIENTED = 0.1
"""pyFM's own advice: without it the map is often mirrored."""
DESCRIPTORS, KEPT = 100, 180
"""Descriptors of the surface and of each landmark, and about how many of all are kept, evenly."""


@dataclass(frozen=True)
class Placed:
    """The places of the source's vertices on the target."""

    triangles: np.ndarray
    barycentric: np.ndarray
    folded: int | None
    """The folded faces in the domain; None for a map that is not one-to-one."""
    seconds: float
    remark: str = ""


def registered(energy, pair):
    """`authalic.register_spheres`; a vertex in a hole of the target counts at the nearest place beside it."""
    options = {"energy": energy, "fill_holes": True}
    if len(pair.landmarks):
        options |= {"source_landmarks": pair.landmarks[:, 0], "target_landmarks": pair.landmarks[:, 1]}
    if pair.features:
        options |= {"features": tuple(signals(side) for side in (pair.source, pair.target))}
    began = time.perf_counter()
    result = authalic.register_spheres(pair.source.mesh, pair.target.mesh, **options)
    seconds = time.perf_counter() - began
    folded, filled = len(result.distortion.folded), len(result.in_holes)
    remark = result.status + (f", {filled} vertices in holes" if filled else "")
    return Placed(result.triangles, result.barycentric, folded, seconds, remark)


def signals(surface):
    """The signals as columns, (n, k)."""
    return np.stack(list(surface.signals.values()), axis=1)


def zoomout(pair):
    """pyFM's: a functional map from wave kernels and landmarks, refined to a map of vertices to vertices."""
    from pyFM.functional import FunctionalMapping
    from pyFM.mesh import TriMesh
    from pyFM.spectral import mesh_FM_to_p2p

    began = time.perf_counter()
    sides = (TriMesh(*side.mesh, area_normalize=True, center=True) for side in (pair.target, pair.source))
    model = FunctionalMapping(*sides)
    marks = pair.landmarks[:, ::-1] if len(pair.landmarks) else None
    step = max(DESCRIPTORS * (1 + len(pair.landmarks)) // KEPT, 1)
    model.preprocess(n_descr=DESCRIPTORS, landmarks=marks, subsample_step=step, k_process=FINAL)
    if pair.features:
        model.add_descriptors(signals(pair.target), signals(pair.source))
    model.fit(K=(SIZE, SIZE), w_orient=ORIENTED)
    refined = model.zoomout_refine(nit=(FINAL - SIZE) // STEP, step=STEP)
    images = mesh_FM_to_p2p(refined, model.mesh1, model.mesh2)
    seconds = time.perf_counter() - began
    remark = f"reaches {len(np.unique(images)) / len(pair.target.vertices):.0%} of the vertices"
    return Placed(*at_vertices(images, pair.target.faces), None, seconds, remark)


def at_vertices(vertices, faces):
    """Vertices as points of faces: (triangles, barycentric)."""
    corner_of = np.zeros(faces.max() + 1, int)
    corner_of[faces.ravel()] = np.arange(faces.size)
    triangles, corners = np.divmod(corner_of[vertices], 3)
    return triangles, np.eye(3)[corners]


METHODS = {SURFACE: partial(registered, "surface"), AREA: partial(registered, "area"), ZOOMOUT: zoomout}


def suits(method, pair):
    """Whether the method takes the pair: the papers' energy needs landmarks."""
    return method != AREA or len(pair.landmarks) > 0
