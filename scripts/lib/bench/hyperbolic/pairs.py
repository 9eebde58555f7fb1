# SPDX-License-Identifier: MIT OR Apache-2.0
"""Pairs of cortices with partner curves: hemispheres of fsaverage5 and the HCP average, right mirrored."""

import json
from dataclasses import dataclass

import numpy as np

from bench import meshes

MIRROR = np.array([-1.0, 1.0, 1.0])
CURVES = "fsaverage5_curves.json"
HCP = ("hcp_s1200_L_32492", "hcp_s1200_R_32492")
BACKWARDS = ("lm_central_sulcus_4|3a", "lm_insula_Ig+PoI1..|OP")
"""Curves of the HCP average that run the other way on the right hemisphere."""


@dataclass(frozen=True)
class Surface:
    """A hemisphere; a closed curve ends with its first vertex."""

    vertices: np.ndarray
    faces: np.ndarray
    curves: list
    sphere: np.ndarray
    """The sphere that comes with the surface, (n, 3); only to see folds on."""
    inflated: np.ndarray
    """For pictures, (n, 3)."""
    fields: dict
    """{name: one value per vertex}."""

    @property
    def mesh(self):
        return self.vertices, self.faces


@dataclass(frozen=True)
class Pair:
    """The source is mapped onto the target, curve k onto curve k."""

    name: str
    source: Surface
    target: Surface


def available():
    """Whether the data folder has the hemispheres and the curves of fsaverage5."""
    folder = meshes.data_folder("brain")
    return len(meshes.brains()) == 2 and (folder / CURVES).exists()


def standard():
    """The pairs of the main table, fsaverage5 with ten curves."""
    found = [across("white", 10), across("pial", 10), white_to_pial(10)]
    folder = meshes.data_folder("brain")
    return [*found, hcp()] if all((folder / f"{name}.npz").exists() for name in HCP) else found


def across(kind, count):
    """The left hemisphere of fsaverage5 onto the mirrored right one."""
    name = f"fsaverage5 left → right, {kind}, {count} curves"
    return Pair(name, fsaverage5("left", kind, count), fsaverage5("right", kind, count))


def white_to_pial(count):
    """Two surfaces of the same hemisphere, with the same curves."""
    name = f"fsaverage5 left, white → pial, {count} curves"
    return Pair(name, fsaverage5("left", "white", count), fsaverage5("left", "pial", count))


def fsaverage5(side, kind, count):
    """A hemisphere with the first so many curves; the right one mirrored."""
    arrays = meshes.brains()[f"fsaverage5_{side}_10242"]
    stored = json.loads((meshes.data_folder("brain") / CURVES).read_text(encoding="utf-8"))
    curves = stored["left" if side == "left" else "mirrored_right"][:count]
    surface = Surface(
        arrays[f"V_{kind}"], arrays["F"], [np.array(curve) for curve in curves], arrays["V_sphere"],
        arrays["V_infl"], {"sulc": arrays["sulc"], "curv": arrays["curv"]},
    )  # fmt: skip
    return surface if side == "left" else mirrored(surface)


def hcp():
    """The left hemisphere of the HCP average onto the mirrored right one: three open curves, two closed."""
    left, right = (_hcp_surface(name) for name in HCP)
    right = mirrored(right)
    theirs = [
        partner(ours, theirs, left.sphere, right.sphere)
        for ours, theirs in zip(left.curves, right.curves, strict=True)
    ]
    return Pair("HCP left → right, midthickness, 5 curves", left, replaced(right, theirs))


def begun_with(pair, first):
    """The pair with another curve as its first."""

    def moved(surface):
        curves = surface.curves
        return replaced(surface, [curves[first], *curves[:first], *curves[first + 1 :]])

    return Pair(pair.name, moved(pair.source), moved(pair.target))


def open_curves(pair):
    """The numbers of the curves that are not closed."""
    return [k for k, curve in enumerate(pair.source.curves) if curve[0] != curve[-1]]


def subdivided(pair, times):
    """The pair with every face split into four, so many times."""
    source, target = pair.source, pair.target
    for _ in range(times):
        source, target = split(source), split(target)
    return Pair(f"{pair.name}, {len(source.vertices):,} vertices", source, target)


def mirrored(surface):
    """The mirror image, faces turned so that they are seen from outside again."""
    return Surface(
        surface.vertices * MIRROR, np.ascontiguousarray(surface.faces[:, ::-1]), surface.curves,
        surface.sphere * MIRROR, surface.inflated * MIRROR, surface.fields,
    )  # fmt: skip


def replaced(surface, curves):
    """The surface with other curves."""
    return Surface(surface.vertices, surface.faces, curves, surface.sphere, surface.inflated, surface.fields)


def partner(ours, theirs, sphere, their_sphere):
    """A closed curve begun and turned to lie nearest to its partner on the spheres; open ones as they are."""
    if theirs[0] != theirs[-1]:
        return theirs
    ring, stations = theirs[:-1], np.linspace(0, 1, 64)
    goal = at_shares(sphere[ours], shares(sphere[ours]), stations)
    begun = [
        np.append(np.roll(way, -start), way[start])
        for way in (ring, ring[::-1])
        for start in range(len(ring))
    ]
    gaps = []
    for curve in begun:
        path = their_sphere[curve]
        gaps.append(((at_shares(path, shares(path), stations) - goal) ** 2).sum())
    return begun[int(np.argmin(gaps))]


def shares(path):
    """How much of a polyline lies before each of its points, from 0 to 1."""
    lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return np.append(0, np.cumsum(lengths)) / lengths.sum()


def at_shares(path, where, wanted):
    """The points at some shares of a polyline whose points lie at the shares `where`."""
    return np.stack([np.interp(wanted, where, column) for column in path.T], axis=1)


def split(surface):
    """Every face into four at the middles of its edges."""
    faces, count = surface.faces, len(surface.vertices)
    sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, edge_of = np.unique(sides, axis=0, return_inverse=True)
    (a, b, c), (ab, bc, ca) = faces.T, count + edge_of.reshape(-1, 3).T
    corners = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    middle = {(int(i), int(j)): count + k for k, (i, j) in enumerate(edges)}

    def extended(values):
        return np.concatenate([values, values[edges].mean(axis=1)])

    return Surface(
        extended(surface.vertices),
        np.concatenate([np.stack(corner, axis=1) for corner in corners]),
        [_with_middles(curve, middle) for curve in surface.curves],
        extended(surface.sphere),
        extended(surface.inflated),
        {name: extended(values) for name, values in surface.fields.items()},
    )


def _with_middles(curve, middle):
    fine = [int(curve[0])]
    for i, j in zip(curve[:-1].tolist(), curve[1:].tolist()):
        fine += [middle[min(i, j), max(i, j)], j]
    return np.array(fine)


def _hcp_surface(name):
    with np.load(meshes.data_folder("brain") / f"{name}.npz") as found:
        arrays = dict(found)
    curves = []
    for key in (key for key in arrays if key.startswith("lm_")):
        curve = arrays[key]
        if key.endswith("_loop"):
            curve = np.append(curve, curve[0])
        turned = key in BACKWARDS and name == HCP[1]
        curves.append(curve[::-1].copy() if turned else curve)
    return Surface(
        arrays["V_midthickness"], arrays["F"].astype(np.int64), curves, arrays["V_sphere"],
        arrays["V_inflated"], {"sulc": arrays["sulc_S1200"]},
    )  # fmt: skip
