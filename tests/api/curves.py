# SPDX-License-Identifier: MIT OR Apache-2.0
"""Pairs of surfaces with landmark curves, and checks of their registrations by independent formulas."""

import heapq
from typing import NamedTuple

import numpy as np

import authalic

from . import meshes, oracle, pairs

EXACT = 1e-12
"""The tolerance for the place of a curve's vertex, as a fraction of the target's size."""


class CurvePair(NamedTuple):
    """Two surfaces and their landmark curves, lists of (k,) vertices."""

    source: meshes.Mesh
    target: meshes.Mesh
    source_curves: list
    target_curves: list


def register(pair, *, energy="harmonic", **options):
    """Registers a pair, by default as the paper does."""
    return authalic.register_hyperbolic(
        pair.source,
        pair.target,
        source_curves=pair.source_curves,
        target_curves=pair.target_curves,
        energy=energy,
        **options,
    )


def inverted(pair):
    return CurvePair(pair.target, pair.source, pair.target_curves, pair.source_curves)


# Curves along edges


def directions(mesh):
    """The vertices seen from the origin, (n, 3)."""
    return mesh.vertices / np.linalg.norm(mesh.vertices, axis=1)[:, None]


def neighbors(faces):
    """The neighbors of each vertex, as a list of ascending lists."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    around = [set() for _ in range(faces.max() + 1)]
    for a, b in edges.tolist():
        around[a].add(b)
        around[b].add(a)
    return [sorted(others) for others in around]


def along(mesh, stations, taken=()):
    """The edge path (k,) through the vertices nearest to directions, close to the line through them."""
    places, around = directions(mesh), neighbors(mesh.faces)
    stations = np.asarray(stations, float)
    stations /= np.linalg.norm(stations, axis=1)[:, None]
    free = np.ones(len(places), bool)
    free[list(taken)] = False
    path = [int(v) for v in ends_of(places, free, stations[:1])]
    for k in range(1, len(stations)):
        goal = int(ends_of(places, free, stations[k : k + 1])[0])
        used = {*path[:-1], *np.flatnonzero(~free).tolist()}
        path += shortest(places, around, path[-1], goal, used, stations[k - 1 : k + 1])[1:]
    return np.array(path)


def ends_of(places, free, wanted):
    """The free vertex nearest to each direction."""
    gaps = np.linalg.norm(places[None] - wanted[:, None], axis=2)
    return np.where(free, gaps, np.inf).argmin(axis=1)


def shortest(places, around, start, goal, used, arc):
    """Dijkstra's path; edges cost more the farther they are from the arc between two directions."""
    normal = np.cross(*arc)
    normal /= np.linalg.norm(normal) or 1
    off, open_ends = np.abs(places @ normal), [(0.0, start, start)]
    before = {}
    while open_ends:
        far, vertex, previous = heapq.heappop(open_ends)
        if vertex in before:
            continue
        before[vertex] = previous
        if vertex == goal:
            break
        for neighbor in around[vertex]:
            if neighbor not in before and neighbor not in used:
                length = np.linalg.norm(places[neighbor] - places[vertex])
                heapq.heappush(open_ends, (far + length * (1 + 10 * off[neighbor]), neighbor, vertex))
    path = [goal]
    while path[-1] != start:
        path.append(before[path[-1]])
    return path[::-1]


def ring(mesh, center, cosine):
    """The closed curve around the faces near a direction, its first vertex not repeated."""
    middles = directions(mesh)[mesh.faces].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1)[:, None]
    inside = middles @ (np.asarray(center, float) / np.linalg.norm(center)) > cosine
    return oracle.boundary_loop(mesh.faces[inside])


def fibonacci(count):
    """Directions spread over the sphere, (count, 3)."""
    height = 1 - (2 * np.arange(count) + 1) / count
    angle = np.pi * (3 - 5**0.5) * np.arange(count)
    radius = np.sqrt(1 - height**2)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)


def arcs(count, length=0.55, seed=2):
    """The ends of `count` arcs of great circles that stay apart from each other, (count, 2, 3)."""
    middle = fibonacci(count)
    tangent = np.cross(middle, np.random.default_rng(seed).standard_normal((count, 3)))
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    half = length * np.sqrt(4 * np.pi / count) / 2
    return np.stack([middle - np.tan(half) * tangent, middle + np.tan(half) * tangent], axis=1)


def drawn(mesh, lines):
    """Disjoint edge paths along lines of directions."""
    curves = []
    for line in lines:
        curves.append(along(mesh, line, np.concatenate([[], *curves]).astype(int).tolist()))
    return curves


def turned(lines, angle):
    """The lines turned about the z axis."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(lines) @ [[c, s, 0], [-s, c, 0], [0, 0, 1]]


def balls(count, target=None, source=None, angle=0.1):
    """A bumpy ball and another star-shaped surface with `count` arcs on each, a little turned."""
    source = source or meshes.bumpy_ball(4)
    target = target or ELLIPSOID
    return CurvePair(source, target, drawn(source, arcs(count)), drawn(target, turned(arcs(count), angle)))


def identical(mesh, lines):
    curves = drawn(mesh, lines)
    return CurvePair(mesh, mesh, curves, curves)


def opened(mesh, centers, cosine):
    """The surface without the faces around some directions."""
    middles = directions(mesh)[mesh.faces].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1)[:, None]
    kept = (middles @ np.asarray(centers, float).T < cosine).all(axis=1)
    return meshes.compact(meshes.Mesh(mesh.vertices, mesh.faces[kept]))


PARALLELS = meshes.sphere(32, 44)[0]
ELLIPSOID = meshes.Mesh(PARALLELS.vertices * [1.0, 1.4, 1.9], PARALLELS.faces)


# Checks of registrations by curves


def assert_located(result, pair):
    """The locations in the result agree with its positions."""
    assert (result.barycentric >= 0).all()
    assert np.abs(result.barycentric.sum(axis=1) - 1).max() < 2e-15
    assert np.array_equal(result.target_faces, pair.target.faces)
    gap = interpolated(result, pair.target) - result.positions
    assert np.abs(gap).max() <= 1e-14 * np.abs(pair.target.vertices).max()


def interpolated(result, target):
    """g(v) of every vertex, from the face and the weights, (n, 3)."""
    corners = target.vertices[target.faces[result.triangles]]
    return np.einsum("ik,ikx->ix", result.barycentric, corners)


def assert_certified(result, surfaces):
    """The certificates prove a homeomorphism, for surfaces cut along `surfaces` curves and boundary loops."""
    proof = result.certificates
    assert proof.folded.tolist() == []
    assert result.distortion.folded.tolist() == []
    assert proof.outside == 0
    assert proof.area_error < 1e-9
    assert proof.curve_error <= EXACT
    assert proof.bank_error <= EXACT
    assert proof.cocycle_error < 1e-8
    assert max(proof.curvature) < 1e-9
    assert abs(proof.area - proof.expected_area) <= 1e-9 * proof.expected_area
    if surfaces > 2:
        assert abs(proof.expected_area - 2 * np.pi * (surfaces - 2)) < 1e-9
        assert proof.energy_ratio > 0.3
    assert result.status == "converged"
    assert result.missed.tolist() == []
    assert (result.landmark_error <= EXACT).all()


def shares(path):
    """The share of a polyline's length before each of its vertices, from 0 to 1."""
    lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return np.concatenate([[0], np.cumsum(lengths)]) / lengths.sum()


def at_shares(path, where):
    return np.stack([np.interp(where, shares(path), column) for column in path.T], axis=1)


def assert_curves_meet(result, pair, skip=()):
    """Each vertex of an open curve lies at the same share of its partner's length: on it, in order."""
    there, size = interpolated(result, pair.target), pairs.size(pair.target)
    for k, (curve, partner) in enumerate(zip(pair.source_curves, pair.target_curves, strict=True)):
        if k not in skip:
            place = at_shares(pair.target.vertices[partner], shares(pair.source.vertices[curve]))
            assert np.abs(there[curve] - place).max() <= EXACT * size, f"curve {k}"


def on_polyline(points, path):
    """The distance of each point from a polyline and its place there, counted in segments."""
    start, step = path[:-1], np.diff(path, axis=0)
    share = np.einsum("ijx,jx->ij", points[:, None] - start, step) / (step**2).sum(axis=1)
    share = share.clip(0, 1)
    gap = np.linalg.norm(points[:, None] - start - share[..., None] * step, axis=2)
    segment = gap.argmin(axis=1)
    return gap.min(axis=1), segment + share[np.arange(len(points)), segment]


def assert_closed_curve_meets(result, pair, curve):
    """A closed curve lies on its partner and runs once around it, from any start and in either direction."""
    loop, partner = open_ended(pair.source_curves[curve]), open_ended(pair.target_curves[curve])
    path = pair.target.vertices[np.append(partner, partner[0])]
    gap, place = on_polyline(interpolated(result, pair.target)[loop], path)
    assert gap.max() <= EXACT * pairs.size(pair.target)
    steps = np.diff(np.append(place, place[0]))
    wraps = [(steps < 0).sum(), (steps > 0).sum()]
    assert min(wraps) == 1, "back and forth"


def open_ended(curve):
    """A closed curve with each vertex once."""
    curve = np.asarray(curve)
    return curve[:-1] if curve[0] == curve[-1] else curve


def assert_unfolded_on_sphere(result, pair, rings=1):
    """Seen from the center of a star-shaped target no image is turned over, but a few next to curves:
    their images have the sides of the hyperbolic metric, straight ones may differ where that is steep."""
    image = directions(meshes.Mesh(result.positions, pair.source.faces))
    near = np.zeros(len(image), bool)
    near[np.concatenate(pair.source_curves)] = True
    for _ in range(rings):
        near[pair.source.faces[near[pair.source.faces].any(axis=1)]] = True
    volume = np.linalg.det(image[pair.source.faces])
    assert (volume[~near[pair.source.faces].any(axis=1)] > 0).all()
    assert (volume <= 0).sum() <= 0.02 * len(volume)
    # once around
    assert abs(oracle.solid_angles(image, pair.source.faces).sum() - 4 * np.pi) < 1e-8


def assert_registration(result, pair, surfaces=None):
    """A homeomorphism of source onto target that takes open curve to open curve."""
    assert_located(result, pair)
    assert_certified(result, surfaces or len(pair.source_curves))
    assert_curves_meet(result, pair)


def edge_length(mesh):
    return oracle.edge_lengths(mesh.vertices, mesh.faces).mean()
