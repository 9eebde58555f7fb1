# SPDX-License-Identifier: MIT OR Apache-2.0
"""Meshes of known topology, built in code."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

ROOT = Path(__file__).resolve().parents[2]


class Mesh(NamedTuple):
    """Vertices (n, 3) float64 and faces (m, 3) int64."""

    vertices: np.ndarray
    faces: np.ndarray


def single_triangle():
    return Mesh(np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 1]]), np.array([[0, 1, 2]]))


def single_quad():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])
    return Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]))


def fan(sides=6):
    """A pyramid over a regular polygon, its apex the vertex 0."""
    angle = 2 * np.pi * np.arange(sides) / sides
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], axis=1)
    around = 1 + np.arange(sides)
    faces = np.stack([np.zeros(sides, int), around, np.roll(around, -1)], axis=1)
    return Mesh(np.vstack([[0, 0, 0.7], rim]), faces)


def quads(rows, columns, wrap=False):
    """Triangles of a grid of vertices numbered row by row; the last column meets the first with `wrap`."""
    index = np.arange(rows * columns).reshape(rows, columns)
    if wrap:
        index = np.hstack([index, index[:, :1]])
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)


def grid(rows=9, columns=13, aspect=1.5):
    """A flat rectangle."""
    y, x = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, aspect, columns), indexing="ij")
    return Mesh(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), quads(rows, columns))


def with_pole(rows_of_points, pole):
    """A tube of rings (r, k, 3) whose first ring is closed by a fan to one more vertex, the last one."""
    rings, around = rows_of_points.shape[:2]
    first = np.arange(around)
    cap = np.stack([np.full(around, rings * around), first, np.roll(first, -1)], axis=1)
    faces = np.vstack([quads(rings, around, wrap=True)[:, ::-1], cap])
    return Mesh(np.vstack([rows_of_points.reshape(-1, 3), pole]), faces)


def bumpy_cap(rings=14, around=30, noise=0.04, seed=1):
    """A round cap with bumps and a rough surface."""
    radius = np.linspace(0, 1, rings + 1)[1:, None]
    angle = 2 * np.pi * np.arange(around) / around
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    z = 0.8 * np.exp(-6 * ((x - 0.4) ** 2 + y**2)) + 0.5 * np.exp(-9 * ((x + 0.4) ** 2 + (y - 0.3) ** 2))
    z = z + noise * np.random.default_rng(seed).standard_normal(z.shape)
    return with_pole(np.stack([x, y, z], axis=-1), [0, 0, 0.4])


def tube_disk(around=12, along=50, radius=0.35):
    """A long thin finger closed at its tip: a disk whose boundary is a small circle far away."""
    angle = 2 * np.pi * np.arange(around) / around
    height = np.linspace(6, 0, along)[:, None] + 0 * angle
    x, y = (radius * trig(angle) + 0 * height for trig in (np.cos, np.sin))
    return with_pole(np.stack([x, y, height], axis=-1), [0, 0, 6.2])


def slit_sphere(stacks=16, slices=24):
    """A sphere slit open along a meridian: both poles lie on the boundary."""
    polar = np.linspace(0, np.pi, stacks + 1)[1:-1, None]
    angle = np.linspace(0, 2 * np.pi, slices + 1)
    x, y, z = np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar) + 0 * angle
    rows = np.stack([x, y, z], axis=-1)
    n, left = rows[..., 0].size, np.arange(slices)
    north = np.stack([np.full(slices, n), left, left + 1], axis=1)
    south = np.stack([np.full(slices, n + 1), n - slices + left, n - slices - 1 + left], axis=1)
    faces = np.vstack([quads(stacks - 1, slices + 1)[:, ::-1], north, south])
    return Mesh(np.vstack([rows.reshape(-1, 3), [0, 0, 1], [0, 0, -1]]), faces)


def sphere(stacks=10, slices=14):
    """A closed sphere and a meridian of it, from pole to pole, as seams."""
    slit = slit_sphere(stacks, slices)
    column = np.arange((stacks - 1) * (slices + 1)) % (slices + 1)
    twin = np.arange(len(slit.vertices))
    twin[:-2][column == slices] -= slices
    used, faces = np.unique(twin[slit.faces], return_inverse=True)
    closed = Mesh(slit.vertices[used], faces.reshape(-1, 3))
    poles, meridian = [len(used) - 2, len(used) - 1], np.arange(stacks - 1) * slices
    path = np.concatenate([poles[:1], meridian, poles[1:]])
    return closed, np.stack([path[:-1], path[1:]], axis=1)


def annulus(around=40, rings=5, inner=0.4):
    """A flat ring of two boundary loops."""
    radius = np.linspace(1, inner, rings)[:, None]
    angle = 2 * np.pi * np.arange(around) / around
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * radius + 0 * angle], axis=-1)
    return Mesh(points.reshape(-1, 3), quads(rings, around, wrap=True))


def plate_with_holes(side=25):
    """A square plate with three square holes of different sizes."""
    mesh = grid(side, side, aspect=1.0)
    center = mesh.vertices[mesh.faces].mean(axis=1)[:, :2]
    solid = np.ones(len(mesh.faces), bool)
    for hole, half in (((0.25, 0.25), 0.09), ((0.7, 0.3), 0.13), ((0.5, 0.75), 0.05)):
        solid &= np.abs(center - hole).max(axis=1) > half
    return compact(Mesh(mesh.vertices, mesh.faces[solid]))


def torus(around=18, along=10):
    """A closed torus, genus 1."""
    u, v = (2 * np.pi * np.arange(k) / k for k in (along, around))
    ring = (2 + np.cos(u))[:, None]
    points = np.stack([ring * np.cos(v), ring * np.sin(v), np.sin(u)[:, None] + 0 * v], axis=-1)
    index = np.arange(along * around).reshape(along, around)
    right, down = np.roll(index, -1, 1), np.roll(index, -1, 0)
    corner = np.roll(right, -1, 0)
    faces = np.stack([index, right, corner, index, corner, down], axis=-1).reshape(-1, 3)
    return Mesh(points.reshape(-1, 3), faces)


def moebius(around=20):
    """A strip with half a turn: one boundary loop, but only one side."""
    angle = 2 * np.pi * np.arange(around) / around
    across = np.array([-0.3, 0.0, 0.3])[:, None]
    ring = 1 + across * np.cos(angle / 2)
    points = np.stack([ring * np.cos(angle), ring * np.sin(angle), across * np.sin(angle / 2)], axis=-1)
    index = np.arange(3 * around).reshape(3, around)
    index = np.hstack([index, index[::-1, :1]])
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return Mesh(points.reshape(-1, 3), np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3))


def compact(mesh):
    """The mesh without vertices that no face uses."""
    used, faces = np.unique(mesh.faces, return_inverse=True)
    return Mesh(mesh.vertices[used], faces.reshape(-1, 3))


def tetrahedron():
    corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    return Mesh(corners, np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]))


def octahedron(radii=(1.0, 1.0, 1.0)):
    corners = np.vstack([np.eye(3), -np.eye(3)]) * radii
    upper = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]])
    lower = np.array([[1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])
    return Mesh(corners, np.vstack([upper, lower]))


def ball(level=3):
    """An octahedron with every face split in four `level` times, its vertices on the unit sphere."""
    mesh = octahedron()
    for _ in range(level):
        mesh = split_in_four(mesh)
    return on_the_sphere(mesh)


def icosphere(level=3, turned=None):
    """An icosahedron with every face split in four `level` times on the unit sphere, turned by a seed."""
    golden = (1 + 5**0.5) / 2
    corners = np.array([(0, a, b * golden) for a in (-1, 1) for b in (-1, 1)])
    vertices = np.concatenate([np.roll(corners, k, axis=1) for k in range(3)])
    near = np.linalg.norm(vertices[:, None] - vertices, axis=2) < 2.1
    faces = [(i, j, k) for i in range(12) for j in range(i + 1, 12) for k in range(i + 1, 12) if j != k]
    faces = np.array([(i, j, k) for i, j, k in faces if near[i, j] and near[j, k] and near[i, k]])
    mesh = on_the_sphere(Mesh(vertices, faces[np.linalg.det(vertices[faces]) > 0]))
    for _ in range(level):
        mesh = on_the_sphere(split_in_four(mesh))
    return mesh if turned is None else Mesh(mesh.vertices @ rotation(turned).T, mesh.faces)


def rotation(seed):
    """Some rotation (3, 3)."""
    matrix = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return matrix * np.linalg.det(matrix)


def split_in_four(mesh):
    """Every face split in four at the midpoints of its edges; the vertices of the mesh come first."""
    vertices, faces = mesh
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    ends, middle = np.unique(edges, axis=0, return_inverse=True)
    (a, b, c), (ab, bc, ca) = faces.T, (len(vertices) + middle.reshape(-1, 3)).T
    split = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    faces = np.concatenate([np.stack(corners, axis=1) for corners in split])
    return Mesh(np.vstack([vertices, vertices[ends].mean(axis=1)]), faces)


def on_the_sphere(mesh):
    return Mesh(mesh.vertices / np.linalg.norm(mesh.vertices, axis=1)[:, None], mesh.faces)


def radial(radius, level=3):
    """A ball whose vertices are moved along their rays to `radius(x, y, z)`."""
    mesh = ball(level)
    return Mesh(mesh.vertices * radius(*mesh.vertices.T)[:, None], mesh.faces)


def bumpy_ball(level=3):
    return radial(lambda x, y, z: 1 + 0.4 * np.sin(3 * x + 1) * np.cos(2 * y + 0.5) + 0.2 * z, level)


def rough_ball(level=3, noise=0.15, seed=3):
    return radial(lambda x, y, z: np.exp(noise * np.random.default_rng(seed).standard_normal(len(x))), level)


def spiky_ball(level=3, length=5.0):
    """Two long spikes, on which the papers' methods fold faces."""
    spike = lambda cosine, width: length * np.exp(-width * (1 - cosine))  # noqa: E731
    return radial(lambda x, y, z: 1 + spike(z, 40) + spike(0.6 * x + 0.8 * y, 60), level)


def limbed_ball(level=4, length=8.0):
    """A bumpy ball with five limbs, whose faces a conformal map makes a thousand times too small."""
    tips = np.array([[1, 0, 0.2], [-0.7, 0.6, 0.1], [-0.3, -0.8, 0.5], [0.2, 0.3, -0.9], [0.1, 0.2, 1]])
    tips /= np.linalg.norm(tips, axis=1, keepdims=True)
    vertices, faces = bumpy_ball(level)
    cosines = vertices / np.linalg.norm(vertices, axis=1, keepdims=True) @ tips.T
    return Mesh(vertices * (1 + length * np.exp(-30 * (1 - cosines)).sum(axis=1, keepdims=True)), faces)


def capsule(stacks=24, slices=12):
    """A long thin tube with round ends."""
    mesh, _ = sphere(stacks, slices)
    x, y, z = mesh.vertices.T
    ring = np.maximum(np.hypot(x, y), 1e-300)
    return Mesh(np.stack([0.5 * x * ring**-0.6, 0.5 * y * ring**-0.6, 5 * z], axis=1), mesh.faces)


DISKS = {
    "single_triangle": single_triangle(),
    "single_quad": single_quad(),
    "fan": fan(),
    "grid": grid(),
    "strip": grid(2, 30, aspect=12.0),
    "bumpy_cap": bumpy_cap(),
    "rough_cap": bumpy_cap(noise=0.15, seed=7),
    "slit_sphere": slit_sphere(),
    "tube_disk": tube_disk(),
}

SPHERES = {
    "tetrahedron": tetrahedron(),
    "octahedron": octahedron((1.0, 2.0, 3.0)),
    "ball": ball(),
    "ellipsoid": Mesh(ball().vertices * [1, 2, 4], ball().faces),
    "parallels": sphere()[0],
    "bumpy_ball": bumpy_ball(),
    "rough_ball": rough_ball(),
    "spiky_ball": spiky_ball(),
    "hedgehog": rough_ball(noise=0.8),
    "capsule": capsule(),
}
