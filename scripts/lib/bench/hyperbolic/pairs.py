# SPDX-License-Identifier: MIT OR Apache-2.0
"""Pairs of cortices with partner curves: hemispheres of fsaverage5 and the HCP average, right mirrored."""

import json
from dataclasses import dataclass

import numpy as np

from bench import meshes

MIRROR = np.array([-1.0, 1.0, 1.0])
CURVES = "fsaverage5_curves.json"
HCP = ("hcp_s1200_L_32492", "hcp_s1200_R_32492")
BACKWARD = ("lm_central_sulcus_4|3a", "lm_insula_Ig+PoI1..|OP")
"""Curves of the HCP average that run the other way on the right hemisphere."""


@dataclass(frozen=True)
class Surface:
    """A hemisphere; a closed curve ends with its first vertex."""

    vertices: np.ndarray
    faces: np.ndarray
    curves: list
    sphere: np.ndarray
    """The sphere that comes with the surface, (n, 3), only for seeing folds."""
    inflated: np.ndarray
    """The inflated vertices for pictures, (n, 3)."""
    fields: dict
    """{name: one value per vertex}."""

    @property
    def mesh(self):
        return self.vertices, self.faces


@dataclass(frozen=True)
class Pair:
    """A source to be mapped onto a target, curve k onto curve k."""

    name: str
    source: Surface
    target: Surface


def available():
    """Whether the data folder has the hemispheres and the curves of fsaverage5."""
    folder = meshes.data_folder("brain")
    return len(meshes.brains()) == 2 and (folder / CURVES).exists()


def standard():
    """The pairs of the main table, fsaverage5 with ten curves."""
    pairs = [across("white", 10), across("pial", 10), white_to_pial(10)]
    folder = meshes.data_folder("brain")
    return [*pairs, hcp()] if all((folder / f"{name}.npz").exists() for name in HCP) else pairs


def across(kind, count):
    """The left hemisphere of fsaverage5 onto the mirrored right one."""
    name = f"fsaverage5 left → right, {kind}, {count} curves"
    return Pair(name, fsaverage5("left", kind, count), fsaverage5("right", kind, count))


def white_to_pial(count):
    """The white surface of the left hemisphere onto the pial one, with the same curves."""
    name = f"fsaverage5 left, white → pial, {count} curves"
    return Pair(name, fsaverage5("left", "white", count), fsaverage5("left", "pial", count))


def fsaverage5(side, kind, count):
    """A hemisphere with the first `count` curves; the right one is mirrored."""
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
    partners = [
        turned_to(curve, goal, right.sphere, left.sphere)
        for goal, curve in zip(left.curves, right.curves, strict=True)
    ]
    return Pair("HCP left → right, midthickness, 5 curves", left, replaced(right, partners))


def begun_with(pair, first):
    """The pair with curve `first` before the others."""

    def moved(surface):
        curves = surface.curves
        return replaced(surface, [curves[first], *curves[:first], *curves[first + 1 :]])

    return Pair(pair.name, moved(pair.source), moved(pair.target))


def open_curves(pair):
    """The numbers of the open curves."""
    return [k for k, curve in enumerate(pair.source.curves) if curve[0] != curve[-1]]


def subdivided(pair, times):
    """The pair with every face split into four, `times` times."""
    source, target = pair.source, pair.target
    for _ in range(times):
        source, target = split(source), split(target)
    return Pair(f"{pair.name}, {len(source.vertices):,} vertices", source, target)


def mirrored(surface):
    """The mirror image, with faces turned outward again."""
    return Surface(
        surface.vertices * MIRROR, np.ascontiguousarray(surface.faces[:, ::-1]), surface.curves,
        surface.sphere * MIRROR, surface.inflated * MIRROR, surface.fields,
    )  # fmt: skip


def replaced(surface, curves):
    """The surface with other curves."""
    return Surface(surface.vertices, surface.faces, curves, surface.sphere, surface.inflated, surface.fields)


def turned_to(curve, partner, sphere, partner_sphere):
    """A curve; if closed, with the start and direction that fit its partner best on the spheres."""
    if curve[0] != curve[-1]:
        return curve
    ring, stations = curve[:-1], np.linspace(0, 1, 64)
    goal = at_shares(partner_sphere[partner], shares(partner_sphere[partner]), stations)
    begun = [
        np.append(np.roll(way, -start), way[start])
        for way in (ring, ring[::-1])
        for start in range(len(ring))
    ]
    gaps = []
    for candidate in begun:
        path = sphere[candidate]
        gaps.append(((at_shares(path, shares(path), stations) - goal) ** 2).sum())
    return begun[int(np.argmin(gaps))]


def shares(path):
    """The share of a polyline's length before each of its points, from 0 to 1."""
    lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return np.append(0, np.cumsum(lengths)) / lengths.sum()


def at_shares(path, where, wanted):
    """The points at the shares `wanted` of a polyline whose points have the shares `where`."""
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
    with np.load(meshes.data_folder("brain") / f"{name}.npz") as file:
        arrays = dict(file)
    curves = []
    for key in (key for key in arrays if key.startswith("lm_")):
        curve = arrays[key]
        if key.endswith("_loop"):
            curve = np.append(curve, curve[0])
        turned = key in BACKWARD and name == HCP[1]
        curves.append(curve[::-1].copy() if turned else curve)
    return Surface(
        arrays["V_midthickness"], arrays["F"].astype(np.int64), curves, arrays["V_sphere"],
        arrays["V_inflated"], {"sulc": arrays["sulc_S1200"]},
    )  # fmt: skip
