# SPDX-License-Identifier: MIT OR Apache-2.0
"""Free outlines: flat surfaces keep their shape, nothing crosses itself, and "converged" means stationary."""

import itertools
from fractions import Fraction

import numpy as np
import pytest

import authalic

from . import meshes, oracle, real_meshes

SLITS = {
    "max_planck": (1.27, 1.27),
    "hand_1": (1.30, 1.23),
    "suzanne": (1.30, 1.286),
    "spot": (1.49, 1.266),
    "torus": (1.28, 1.277),
}
"""Bounds of the mean σ1/σ2 of slit surfaces at a weight of 1e-3: one-to-one, and with overlaps."""


def squares(columns, rows, is_kept=lambda i, j: True):
    """The squares of a flat grid that are kept, each as two triangles."""
    kept = [(i, j) for j in range(rows) for i in range(columns) if is_kept(i, j)]
    corners = [((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)) for i, j in kept]
    places = sorted({corner for square in corners for corner in square})
    number = {place: k for k, place in enumerate(places)}
    faces = [[number[s[k]] for k in face] for s in corners for face in ((0, 1, 2), (0, 2, 3))]
    vertices = np.array([(x, y, 0) for x, y in places], float)
    return vertices, np.array(faces)


def crenels(columns, rows, depth):
    """A strip with deep battlements on one side."""
    return squares(columns, rows, lambda i, j: j < rows - depth or i % 2 == 0)


def ragged(seed):
    """A region with a ragged outline and holes: connected squares, no two of which touch in a corner only."""
    random = np.random.default_rng(seed)
    size = 8 + seed % 9
    noise = random.random((size, size))
    kept = noise > 0.3
    # squares that touch in a corner only are joined
    for _ in range(size):
        a, b, c, d = kept[:-1, :-1], kept[1:, :-1], kept[:-1, 1:], kept[1:, 1:]
        touches = ((a == d) & (b == c) & (a != b)).nonzero()
        for i, j in zip(*touches, strict=False):
            kept[i : i + 2, j : j + 2] = True
    return squares(size, size, largest(kept))


def largest(kept):
    """Whether each square is in the largest component."""
    left, parts = set(zip(*np.nonzero(kept), strict=False)), []
    while left:
        open_squares = {left.pop()}
        component = set(open_squares)
        while open_squares:
            beside = {(i + a, j + b) for i, j in open_squares for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1))}
            open_squares = beside & left
            left -= open_squares
            component |= open_squares
        parts.append(component)
    most = max(parts, key=len)
    return lambda i, j: (i, j) in most


def outline_edges(faces):
    """The directed edges that have one face only."""
    edges = {(int(f[k]), int(f[(k + 1) % 3])) for f in faces for k in range(3)}
    return np.array([edge for edge in edges if edge[::-1] not in edges])


def side(a, b, c):
    """The sign of the area of a triangle, by floats where these decide and by fractions elsewhere."""
    left, right = (b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0])
    if abs(left - right) > 1e-14 * (abs(left) + abs(right)):
        return np.sign(left - right)
    a, b, c = ([Fraction(float(x)) for x in point] for point in (a, b, c))
    exact = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (exact > 0) - (exact < 0)


def crossings(uv, faces):
    """Pairs of edges of the outline that meet at more than a common corner."""
    edges = outline_edges(faces)
    low, high = uv[edges].min(1), uv[edges].max(1)
    crossing = []
    for k, (a, b) in enumerate(edges):
        near = np.all((low[k + 1 :] <= high[k]) & (high[k + 1 :] >= low[k]), axis=1)
        for c, d in edges[k + 1 :][near]:
            if {a, b} & {c, d}:
                continue
            p, q, r, s = uv[[a, b, c, d]]
            if side(p, q, r) * side(p, q, s) <= 0 and side(r, s, p) * side(r, s, q) <= 0:
                crossing.append((a, b, c, d))
    return crossing


def figures(vertices, result):
    """The deviation of area ratios and the mean of σ1/σ2, weighted by area, and its maximum."""
    areas, image = oracle.face_areas(vertices, result.faces), oracle.signed_areas(result.uv, result.faces)
    areas, image = areas / areas.sum(), image / image.sum()
    shear = result.distortion.angle_distortion
    return np.sqrt((areas * (image / areas - 1) ** 2).sum()), (areas * shear).sum(), shear.max()


def energy_gradient(vertices, faces, uv, weight):
    """The energy of areas and angles, and its gradient, by products of singular values."""
    corners = vertices[faces]
    e, f = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    base = np.linalg.norm(e, axis=1)
    along, height = (f * e).sum(1) / base, np.linalg.norm(np.cross(e, f), axis=1) / base
    areas = base * height / 2
    scale = 1 / np.sqrt(areas.sum())
    base, along, height, targets = base * scale, along * scale, height * scale, areas * scale**2
    p, q = uv[faces[:, 1]] - uv[faces[:, 0]], uv[faces[:, 2]] - uv[faces[:, 0]]
    first = p / base[:, None]
    second = (q - along[:, None] * first) / height[:, None]
    ratio = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    shear = ((first**2).sum(1) + (second**2).sum(1)) / (2 * ratio) - 1
    energy = targets * ((ratio - 1) ** 2 * (1 + 1 / ratio) / 2 + weight * (shear + 0.05 * shear**2))
    by_ratio = (2 * ratio - 1 - ratio**-2) / 2 - weight * (1 + 0.1 * shear) * (shear + 1) / ratio
    by_square = weight * (1 + 0.1 * shear) / (2 * ratio)
    turned_first, turned_second = (np.c_[x[:, 1], -x[:, 0]] for x in (first, second))
    by_first = targets[:, None] * (by_ratio[:, None] * turned_second + 2 * by_square[:, None] * first)
    by_second = targets[:, None] * (-by_ratio[:, None] * turned_first + 2 * by_square[:, None] * second)
    by_q = by_second / height[:, None]
    by_p = by_first / base[:, None] - by_q * (along / base)[:, None]
    gradient = np.zeros_like(uv)
    for k, slope in enumerate((-by_p - by_q, by_p, by_q)):
        np.add.at(gradient, faces[:, k], slope)
    return energy.sum(), gradient


def at_its_best_size(vertices, faces, uv, weight):
    """The map at the size of least energy: a result is scaled into the unit disk."""
    area = oracle.signed_areas(uv, faces).sum()
    scales = np.geomspace(0.9, 1.1, 2001) / np.sqrt(area)
    energies = [energy_gradient(vertices, faces, s * uv, weight)[0] for s in scales]
    around = scales[np.argmin(energies)] * np.linspace(0.9999, 1.0001, 2001)
    energies = [energy_gradient(vertices, faces, s * uv, weight)[0] for s in around]
    return around[np.argmin(energies)] * uv


@pytest.mark.parametrize("weight", [0.03, 0.1, 0.3])
@pytest.mark.parametrize("size", [(20, 8, 2), (5, 3, 2), (20, 8, 6)])
def test_crenels_keep_their_shape(size, weight):
    mesh = crenels(*size)
    result = authalic.disk_map(*mesh, boundary="free", angle_weight=weight)
    deviation, _, shear = figures(mesh[0], result)
    assert deviation < 1e-6 and shear < 1.00001
    assert result.status == "converged" and crossings(result.uv, result.faces) == []


@pytest.mark.parametrize("size", [(100, 1), (200, 1), (1000, 2)])
def test_strips_keep_their_shape(size):
    mesh = squares(*size)
    result = authalic.disk_map(*mesh, boundary="free", angle_weight=0.1)
    deviation, _, shear = figures(mesh[0], result)
    assert deviation < 1e-6 and shear < 1.00001 and result.status == "converged"


@pytest.mark.parametrize("seed", range(12))
def test_ragged_regions_with_holes_keep_their_shape(seed):
    mesh = ragged(seed)
    result = authalic.disk_map(*mesh, boundary="free", angle_weight=0.1, fill_holes=True)
    deviation, _, shear = figures(mesh[0], result)
    assert deviation < 1e-6 and shear < 1.00001
    assert oracle.folded(result.uv, result.faces) == [] and crossings(result.uv, result.faces) == []


def test_banks_of_a_slit_that_touch_stay_apart():
    vertices, faces = squares(8, 6)
    slit = [int(np.flatnonzero((vertices[:, 0] == x) & (vertices[:, 1] == 3))[0]) for x in range(2, 9)]
    edges = np.array(list(itertools.pairwise(slit)))
    patch = authalic.cut(vertices, faces, seams=edges)[0]
    result = authalic.disk_map(patch.vertices, patch.faces, boundary="free", angle_weight=0.1)
    deviation, _, shear = figures(np.asarray(patch.vertices), result)
    assert deviation < 1e-6 and shear < 1.00001 and crossings(result.uv, result.faces) == []


@pytest.mark.parametrize("weight", [0.1, 1e-3])
@pytest.mark.parametrize("make", [meshes.bumpy_cap, meshes.slit_sphere], ids=lambda make: make.__name__)
def test_converged_maps_are_stationary(make, weight):
    mesh = make()
    result = authalic.disk_map(*mesh, boundary="free", angle_weight=weight)
    assert result.status == "converged" and crossings(result.uv, result.faces) == []
    vertices, faces = np.asarray(mesh[0], float), np.asarray(result.faces)
    uv = at_its_best_size(vertices, faces, result.uv, weight)
    energy, gradient = energy_gradient(vertices, faces, uv, weight)
    # no motion by an edge length gains a noticeable part of the energy
    edge = np.sqrt(1 / len(faces))
    assert np.abs(gradient).max() * edge < 1e-4 * energy


def test_any_outline_may_be_given():
    vertices, faces = crenels(9, 4, 2)
    bent = np.c_[vertices[:, 0] + 0.1 * vertices[:, 1] ** 2, vertices[:, 1] + 0.3 * np.sin(vertices[:, 0])]
    result = authalic.disk_map(vertices, faces, boundary="free", angle_weight=0.1, initial=bent)
    deviation, _, shear = figures(vertices, result)
    assert deviation < 1e-6 and shear < 1.00001
    # a folded one is replaced
    result = authalic.disk_map(vertices, faces, boundary="free", angle_weight=0.1, initial=bent[:, ::-1])
    assert figures(vertices, result)[0] < 1e-6


def test_holes_stay_open_and_free():
    mesh = meshes.annulus()
    with pytest.raises(authalic.MeshError):
        authalic.disk_map(*mesh, boundary="free", angle_weight=0.1)
    result = authalic.disk_map(*mesh, boundary="free", angle_weight=0.1, fill_holes=True)
    assert oracle.folded(result.uv, result.faces) == [] and crossings(result.uv, result.faces) == []
    start = authalic.disk_map(
        *mesh, boundary="free", angle_weight=0.1, fill_holes=True, initial=result.uv, max_iterations=0
    )
    assert start.status == "max_iterations"


@pytest.mark.parametrize("rings", [20, 60])
def test_long_tubes_come_to_an_end(rings):
    """Their conformal maps collapse, so the map to the disk has to be the start."""
    angle = np.arange(8) * np.pi / 4
    vertices = [(np.cos(a), np.sin(a), 0.8 * ring) for ring in range(rings) for a in angle]
    faces = []
    for ring in range(rings - 1):
        for k in range(8):
            a, b = 8 * ring + k, 8 * ring + (k + 1) % 8
            faces += [(a, b, b + 8), (a, b + 8, a + 8)]
    result = authalic.disk_map(vertices, np.array(faces), boundary="free", angle_weight=1e-3, fill_holes=True)
    assert result.status == "converged" and len(result.distortion.folded) == 0
    assert result.distortion.area_ratio_std < 0.15 and not crossings(result.uv, np.array(faces))


def test_overlap_is_for_free_outlines():
    mesh = meshes.bumpy_cap()
    for boundary in ("sliding", "arc_length"):
        with pytest.raises(ValueError, match="overlap"):
            authalic.disk_map(*mesh, boundary=boundary, overlap=True)
    result = authalic.disk_map(*mesh, boundary="free", angle_weight=0.1, overlap=True)
    assert oracle.folded(result.uv, result.faces) == []


def test_areas_alone_are_kept_by_a_free_outline_too():
    mesh = meshes.bumpy_cap()
    result = authalic.disk_map(*mesh, boundary="free")
    assert result.status == "converged" and figures(np.asarray(mesh[0], float), result)[0] < 3e-4


@pytest.mark.parametrize(
    "weight", [pytest.param(0, marks=pytest.mark.xfail(reason="known: moves by 1.4e-6", strict=False)), 1e-3]
)
def test_noise_and_rotations_move_nothing(weight):
    vertices, faces = meshes.bumpy_cap()
    vertices, random = np.asarray(vertices, float), np.random.default_rng(1)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    first = authalic.disk_map(vertices, faces, boundary="free", angle_weight=weight).uv
    for moved in (vertices + 1e-12 * random.normal(size=vertices.shape), vertices @ turn.T):
        again = authalic.disk_map(moved, faces, boundary="free", angle_weight=weight).uv
        assert np.abs(again - first).max() < 1e-6


@pytest.mark.parametrize("name", SLITS)
@pytest.mark.parametrize("overlap", [False, True])
def test_slit_surfaces(name, overlap):
    path = real_meshes.file(f"seams/slit/{name}.npz")
    mesh = real_meshes.load(path)
    result = authalic.disk_map(*mesh, boundary="free", angle_weight=1e-3, overlap=overlap)
    deviation, shear, _ = figures(np.asarray(mesh.vertices), result)
    assert result.status == "converged" and oracle.folded(result.uv, result.faces) == []
    assert deviation < 0.005 and shear <= SLITS[name][overlap]
    assert overlap or crossings(result.uv, result.faces) == []


@pytest.mark.parametrize("name", ["grid", "tube_disk"])
def test_progress_rises_through_start_and_descent(name):
    heard = []
    authalic.disk_map(
        *meshes.DISKS[name], boundary="free", progress=lambda *report: heard.append(report) or True
    )
    fractions = [fraction for fraction, _ in heard]
    assert fractions == sorted(fractions) and fractions[0] >= 0 and fractions[-1] <= 1


def test_a_long_start_is_heard_of():
    heard = []

    def listen(fraction, message):
        heard.append((fraction, message))
        return message == "Start map" or fraction < 0.2

    vertices, faces = squares(300, 300)
    vertices[:, 2] = np.sin(vertices[:, 0] / 30) * np.cos(vertices[:, 1] / 40) * 20
    authalic.disk_map(vertices, faces, boundary="free", progress=listen)
    starts = sorted({fraction for fraction, message in heard if message == "Start map"})
    assert starts == pytest.approx([0.0, 0.08, 0.12])


def long_tube(rings=7, around=4, step=-104.40846781929332):
    """A tube hundreds of times as long as it is wide."""
    angles = 2 * np.pi * np.arange(around) / around
    ring = np.stack([np.cos(angles), np.sin(angles), np.zeros(around)], axis=1)
    vertices = np.concatenate([ring + np.array([0, 0, step * number]) for number in range(rings)])
    faces = []
    for row, column in itertools.product(range(rings - 1), range(around)):
        a, b = row * around + column, row * around + (column + 1) % around
        faces += [[a, b, b + around], [a, b + around, a + around]]
    return vertices, np.array(faces)


@pytest.mark.parametrize("reports", range(20, 45, 3))
def test_a_cancelled_map_of_a_long_tube_is_not_folded(reports):
    numbers = itertools.count(1)
    result = authalic.disk_map(
        *long_tube(), boundary="free", fill_holes=True, progress=lambda *_: next(numbers) <= reports
    )
    assert result.status == "cancelled" and len(result.distortion.folded) == 0
