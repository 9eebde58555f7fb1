# SPDX-License-Identifier: MIT OR Apache-2.0
"""Random meshes of known topology, and random ways to spoil them; everything follows from a seed.

The tests and the search for failures (`scripts/bench fuzz`) share them.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, Delaunay

from . import meshes
from .meshes import Mesh


class Case(NamedTuple):
    """A mesh, what it is ("disk", "sphere", or "hostile": anything at all) and how it was made."""

    mesh: Mesh
    kind: str
    name: str


# Closed surfaces


def hull(points):
    """The triangles of the convex hull of points, all of which lie on it, counter-clockwise from outside."""
    convex = ConvexHull(points)
    corners = points[convex.simplices]
    inward = np.einsum("ij,ij->i", np.cross(corners[:, 1], corners[:, 2]), corners[:, 0]) < 0
    faces = convex.simplices.astype(np.int64)
    faces[inward] = faces[inward][:, ::-1]
    return Mesh(points, faces)


def icosphere(level):
    """An icosahedron whose faces are split in four `level` times, on the unit sphere."""
    golden = (1 + 5**0.5) / 2
    corners = [[0, a, b * golden] for a in (-1, 1) for b in (-1, 1)]
    points = np.concatenate([np.roll(corners, turn, axis=1) for turn in range(3)])
    mesh = hull(points / np.hypot(1, golden))
    for _ in range(level):
        edges = np.sort(mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        middle = mesh.vertices[np.unique(edges, axis=0)].mean(axis=1)
        mesh = hull(np.vstack([mesh.vertices, middle / np.linalg.norm(middle, axis=1)[:, None]]))
    return mesh


def ball_of(rng, size):
    """An icosphere, or the hull of random points on the sphere, of at most `size` vertices."""
    if rng.random() < 0.5:
        deepest = int(np.log(max(size - 2, 10) / 10) / np.log(4))
        return icosphere(int(rng.integers(0, deepest + 1)))
    points = rng.standard_normal((int(rng.integers(4, size + 1)), 3))
    return hull(points / np.linalg.norm(points, axis=1)[:, None])


def noisy_icosphere(rng, size):
    """Vertices moved along their rays, by up to a factor of three or so either way."""
    mesh = ball_of(rng, size)
    noise = rng.choice([0.01, 0.1, 0.3]) * rng.standard_normal(len(mesh.vertices))
    return Mesh(mesh.vertices * np.exp(noise)[:, None], mesh.faces)


def horned_ball(rng, size):
    """One to four thin horns; on a coarse ball they are single spikes."""
    mesh = ball_of(rng, size)
    radius = np.ones(len(mesh.vertices))
    for _ in range(rng.integers(1, 5)):
        direction = mesh.vertices[rng.integers(len(mesh.vertices))]
        length, sharpness = 10 ** rng.uniform(0, 1.2), 10 ** rng.uniform(1, 2.5)
        radius += length * np.exp(-sharpness * (1 - mesh.vertices @ direction))
    return Mesh(mesh.vertices * radius[:, None], mesh.faces)


def ellipsoid(rng, size):
    """Half-axes that differ by up to a factor of a thousand."""
    mesh = ball_of(rng, size)
    return Mesh(mesh.vertices * 10 ** rng.uniform(-1.5, 1.5, 3), mesh.faces)


def capsule(rng, size):
    """A tube with round ends, 2 to 100 times longer than wide."""
    aspect, around = 10 ** rng.uniform(np.log10(2), 2), int(rng.integers(3, 25))
    around = min(around, max(3, size // 12))
    step = max(2 * np.pi / around, (2 * aspect + np.pi) * around / size) * rng.uniform(1, 1.5)
    polar = np.linspace(0, np.pi / 2, 2 + int(np.pi / 2 / step))[1:]
    along = np.linspace(0, 2 * (aspect - 1), 2 + int(2 * aspect / step))[1:-1]
    height = np.concatenate([1 - np.cos(polar), 1 + along, 2 * aspect - 1 + np.cos(polar[::-1])])
    radius = np.concatenate([np.sin(polar), np.ones(len(along)), np.sin(polar[::-1])])
    radius = radius * np.exp(rng.choice([0, 0.1]) * rng.standard_normal(len(radius)))
    return closed_tube(height, radius, around, 2 * aspect)


def closed_tube(height, radius, around, top):
    """Rings of the given heights and radii, closed by a vertex at 0 and one at `top`."""
    angle, rings = 2 * np.pi * np.arange(around) / around, len(height)
    x, y, z = radius[:, None] * np.cos(angle), radius[:, None] * np.sin(angle), height[:, None] + 0 * angle
    first = np.arange(around)
    below, above = np.full(around, rings * around), np.full(around, rings * around + 1)
    last = first + (rings - 1) * around
    ends = [[below, np.roll(first, -1), first], [above, last, np.roll(last, -1)]]
    caps = np.concatenate([np.stack(end, axis=1) for end in ends])
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    return Mesh(
        np.vstack([points, [[0, 0, 0], [0, 0, top]]]),
        np.vstack([meshes.quads(rings, around, wrap=True), caps]),
    )


# Disks


def bumpy_disk(rng, size):
    """A round cap with two bumps and a rough surface."""
    around = int(rng.integers(3, max(4, int(size**0.5) * 2)))
    rings = int(rng.integers(1, max(2, size // around)))
    return meshes.bumpy_cap(rings, around, rng.choice([0, 0.05, 0.3]), int(rng.integers(2**31)))


def delaunay_cap(rng, size):
    """Random points of a disk, triangulated, laid onto a cap of a sphere and roughened."""
    rim = int(rng.integers(3, max(4, size // 4)))
    inside = int(rng.integers(0, size - rim + 1))
    radius = rng.random(inside) ** rng.choice([0.5, 1.0, 2.0])
    angle = 2 * np.pi * np.concatenate([rng.random(inside), (np.arange(rim) + 0.9 * rng.random(rim)) / rim])
    polar = np.concatenate([0.97 * radius, np.ones(rim)])
    flat = np.stack([polar * np.cos(angle), polar * np.sin(angle)], axis=1)
    faces = Delaunay(flat).simplices.astype(np.int64)
    a, b, c = (flat[faces[:, k]] for k in range(3))
    turned = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
    faces[turned] = faces[turned][:, ::-1]
    polar = polar * rng.uniform(0.2, 3.0)
    point = np.stack([np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar)], axis=1)
    rough = np.exp(rng.choice([0, 0.02, 0.1]) * rng.standard_normal(len(point)))
    return meshes.compact(Mesh(point * rough[:, None], faces))


def tube(rng, size):
    """A finger that is closed at its tip, up to 20 times longer than wide."""
    around = int(rng.integers(3, 20))
    along = int(rng.integers(2, max(3, size // around)))
    return meshes.tube_disk(around, along, 10 ** rng.uniform(-0.8, 0.5))


def punctured(rng, size):
    """A closed surface without the faces around one of its vertices."""
    mesh = CLOSED[rng.choice(list(CLOSED))](rng, size)
    for vertex in rng.permutation(len(mesh.vertices)):
        rest = mesh.faces[~(mesh.faces == vertex).any(axis=1)]
        if len(rest) and len(np.unique(rest)) == len(mesh.vertices) - 1:
            break
    return meshes.compact(Mesh(mesh.vertices, rest))


def strip(rng, size):
    """A flat strip, a few faces wide and up to a hundred times as long."""
    rows = int(rng.integers(2, 5))
    columns = int(rng.integers(2, max(3, size // rows)))
    return meshes.grid(rows, columns, aspect=10 ** rng.uniform(0, 2))


CLOSED = {
    "noisy icosphere": noisy_icosphere,
    "horned ball": horned_ball,
    "ellipsoid": ellipsoid,
    "capsule": capsule,
}
OPEN = {
    "bumpy disk": bumpy_disk,
    "delaunay cap": delaunay_cap,
    "tube": tube,
    "punctured": punctured,
    "strip": strip,
}


# Changes that keep a mesh sound


def disguised(rng, mesh):
    """The mesh with another place, size and orientation, and with its vertices and faces in another order."""
    order, rows = rng.permutation(len(mesh.vertices)), rng.permutation(len(mesh.faces))
    rank = np.argsort(order)
    faces = np.roll(rank[mesh.faces[rows]], int(rng.integers(3)), axis=1)
    turn = np.linalg.qr(rng.standard_normal((3, 3))).Q
    turn[:, 0] *= np.linalg.det(turn)
    scale = 10 ** rng.uniform(-6, 6)
    points = scale * (mesh.vertices[order] @ turn + rng.uniform(-10, 10, 3))
    return Mesh(np.ascontiguousarray(points), np.ascontiguousarray(faces))


# Changes that may spoil a mesh


def some(rng, count, most=6):
    """A few different numbers below `count`."""
    return rng.choice(count, min(count, int(rng.integers(1, most + 1))), replace=False)


def not_finite(rng, mesh):
    points = mesh.vertices.copy()
    points[some(rng, len(points)), rng.integers(3)] = rng.choice([np.nan, np.inf, -np.inf])
    return Mesh(points, mesh.faces)


def out_of_range(rng, mesh):
    faces = mesh.faces.copy()
    faces[some(rng, len(faces)), rng.integers(3)] = rng.choice([-1, len(mesh.vertices), 2**40, -(2**40)])
    return Mesh(mesh.vertices, faces)


def repeated_corner(rng, mesh):
    faces, rows = mesh.faces.copy(), some(rng, len(mesh.faces))
    faces[rows, 0] = faces[rows, 1]
    return Mesh(mesh.vertices, faces)


def repeated_faces(rng, mesh):
    again = mesh.faces[some(rng, len(mesh.faces))][:, rng.permutation(3)]
    return Mesh(mesh.vertices, np.vstack([mesh.faces, again]))


def turned_faces(rng, mesh):
    faces, rows = mesh.faces.copy(), rng.random(len(mesh.faces)) < rng.random()
    faces[rows] = faces[rows][:, ::-1]
    return Mesh(mesh.vertices, faces)


def fin(rng, mesh):
    """One more face at an edge, which may be the third there."""
    a, b, _ = mesh.faces[rng.integers(len(mesh.faces))]
    c = rng.integers(len(mesh.vertices))
    return Mesh(mesh.vertices, np.vstack([mesh.faces, [[b, a, c]]]))


def pinched(rng, mesh):
    """Pairs of vertices become one."""
    faces, n = mesh.faces.copy(), len(mesh.vertices)
    for vertex in some(rng, n, 3):
        faces[faces == vertex] = rng.integers(n)
    return Mesh(mesh.vertices, faces)


def missing_faces(rng, mesh):
    gone = some(rng, len(mesh.faces), int(rng.choice([1, 3, 30])))
    return Mesh(mesh.vertices, np.delete(mesh.faces, gone, axis=0))


def compact_missing_faces(rng, mesh):
    """Without the vertices that lose all their faces."""
    rest = missing_faces(rng, mesh)
    sound = rest.faces.size and rest.faces.min() >= 0 and rest.faces.max() < len(rest.vertices)
    return meshes.compact(rest) if sound else rest


def coincident(rng, mesh):
    """Vertices in the place of others."""
    points, rows = mesh.vertices.copy(), some(rng, len(mesh.vertices))
    points[rows] = points[rng.integers(len(points), size=len(rows))]
    return Mesh(points, mesh.faces)


def flattened(rng, mesh):
    """Squeezed into a plane, a line or a point, or almost."""
    factors = np.ones(3)
    factors[: rng.integers(1, 4)] = rng.choice([0.0, 1e-300, 1e-20, 1e-12, 1e-6])
    return Mesh(mesh.vertices * factors, mesh.faces)


def loose_vertices(rng, mesh):
    return Mesh(np.vstack([mesh.vertices, rng.standard_normal((int(rng.integers(1, 4)), 3))]), mesh.faces)


def two_pieces(rng, mesh):
    second = random_mesh(rng, 60)[0]
    points = np.vstack([mesh.vertices, second.vertices])
    return Mesh(points, np.vstack([mesh.faces, second.faces + len(mesh.vertices)]))


def extreme_size(rng, mesh):
    return Mesh(mesh.vertices * rng.choice([1e-320, 1e-300, 1e-160, 1e150, 1e290]), mesh.faces)


def far_away(rng, mesh):
    return Mesh(mesh.vertices + rng.choice([1e8, 1e14, 1e18, 1e300]), mesh.faces)


def single_precision(rng, mesh):
    with np.errstate(over="ignore"):
        return Mesh(mesh.vertices.astype(np.float32).astype(float), mesh.faces)


def crumpled(rng, mesh):
    """The vertices at random places."""
    return Mesh(rng.standard_normal(mesh.vertices.shape), mesh.faces)


def collapsing(rng, mesh):
    """Areas that differ by twenty orders of magnitude and more."""
    return Mesh(mesh.vertices * 10 ** rng.uniform(-12, 0, (len(mesh.vertices), 1)), mesh.faces)


def soup(rng, mesh):
    """Any faces at all."""
    n = min(len(mesh.vertices), 12)
    return Mesh(mesh.vertices[:n], rng.integers(0, n, (int(rng.integers(1, 40)), 3)))


def emptied(rng, mesh):
    return Mesh(mesh.vertices[: rng.integers(4)], mesh.faces[:0])


SPOILERS = [
    not_finite, out_of_range, repeated_corner, repeated_faces, turned_faces, fin, pinched, missing_faces,
    compact_missing_faces, coincident, flattened, loose_vertices, two_pieces, extreme_size, far_away,
    single_precision, crumpled, collapsing, soup, emptied,
]  # fmt: skip


# Cases


def random_mesh(rng, size, names=(*CLOSED, *OPEN)):
    """A sound mesh with at most about `size` vertices, its kind and its name."""
    name = str(rng.choice(names))
    kind, make = ("sphere", CLOSED[name]) if name in CLOSED else ("disk", OPEN[name])
    return make(rng, size), kind, name


def sound_case(seed, size=300, names=(*CLOSED, *OPEN)):
    """A mesh that must be mapped, of one of the given names."""
    rng = np.random.default_rng(seed)
    mesh, kind, name = random_mesh(rng, size, names)
    return Case(disguised(rng, mesh), kind, name)


def hostile_case(seed, size=300, spoilers=tuple(SPOILERS)):
    """A mesh with one or two changes that may have spoiled it."""
    rng = np.random.default_rng(seed)
    mesh, _, name = random_mesh(rng, size)
    for spoil in rng.choice(len(spoilers), min(len(spoilers), int(rng.integers(1, 3))), replace=False):
        mesh, name = spoilers[spoil](rng, mesh), f"{name}, {spoilers[spoil].__name__}"
        if not len(mesh.faces) or not len(mesh.vertices):
            break
    return Case(mesh, "hostile", name)
