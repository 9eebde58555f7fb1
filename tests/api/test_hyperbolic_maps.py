# SPDX-License-Identifier: MIT OR Apache-2.0
"""Registrations by curves are homeomorphisms with the curves in place, for all surfaces and curves."""

import numpy as np
import pytest

import authalic

from . import curves, meshes, oracle, pairs

COUNTS = (1, 2, 3, 4, 6, 12, 20)
FINE = meshes.bumpy_ball(5)
COARSE = meshes.bumpy_ball(4)
EGG = meshes.radial(lambda x, y, z: 1 + 0.3 * z + 0.1 * np.cos(3 * x), 4)


@pytest.fixture(scope="module")
def registration_of():
    """A function from the number of curves to a pair and its registration, each computed once."""
    made = {}

    def get(count):
        if count not in made:
            pair = curves.balls(count)
            made[count] = pair, curves.register(pair)
        return made[count]

    return get


# Curves and faces


@pytest.mark.parametrize("count", COUNTS)
def test_spheres_with_open_curves(registration_of, count):
    pair, result = registration_of(count)
    curves.assert_registration(result, pair)
    curves.assert_unfolded_on_sphere(result, pair)
    assert result.warnings == []
    assert len(result.energies) == (count > 2)
    if count > 2:
        assert result.certificates.energy_ratio < 1.2


@pytest.mark.parametrize("count", [1, 2, 4, 12])
def test_a_fine_surface_onto_a_coarse_one_and_back(count):
    pair = curves.balls(count, source=FINE, target=EGG)
    for way in (pair, curves.inverted(pair)):
        result = curves.register(way)
        curves.assert_registration(result, way)
        curves.assert_unfolded_on_sphere(result, way)


@pytest.mark.parametrize("name", ["rough_ball", "hedgehog", "spiky_ball", "capsule"])
def test_rough_surfaces(name):
    target = meshes.Mesh(*meshes.SPHERES[name])
    pair = curves.balls(3, source=COARSE, target=target, angle=0.0)
    for way in (pair, curves.inverted(pair)):
        result = curves.register(way)
        curves.assert_registration(result, way)


def test_a_vertex_in_two_faces_is_at_one_place(registration_of):
    """Every vertex of the target has one preimage, so the images of all source vertices keep apart."""
    _, result = registration_of(6)
    apart = np.unique(result.positions.round(12), axis=0)
    assert len(apart) == len(result.positions)


# The same map whatever the input looks like


@pytest.mark.parametrize("scale", [1.0, 1e8, 1e-8])
@pytest.mark.parametrize("count", [1, 2, 6])
def test_moved_and_scaled_surfaces_have_the_same_map(registration_of, scale, count):
    pair, result = registration_of(count)
    turn, _ = np.linalg.qr(np.random.default_rng(4).standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    place = lambda mesh: meshes.Mesh(scale * (mesh.vertices @ turn + [3.0, -2.0, 5.0]), mesh.faces)  # noqa: E731
    moved = pair._replace(source=place(pair.source))
    assert np.abs(curves.register(moved).positions - result.positions).max() < 1e-6
    moved = pair._replace(target=place(pair.target))
    back = curves.register(moved).positions / scale - [3.0, -2.0, 5.0]
    assert np.abs(back @ turn.T - result.positions).max() < 1e-6


@pytest.mark.parametrize("scale", [2.0**300, 2.0**-300])
def test_a_power_of_two_changes_no_bit(registration_of, scale):
    pair, result = registration_of(4)
    source, target = (meshes.Mesh(scale * mesh.vertices, mesh.faces) for mesh in pair[:2])
    assert np.array_equal(curves.register(pair._replace(source=source)).positions, result.positions)
    assert np.array_equal(curves.register(pair._replace(target=target)).positions, scale * result.positions)


def permuted(mesh, paths, seed):
    """The surface with its vertices and faces in another order, and the new place of each vertex."""
    random = np.random.default_rng(seed)
    order = random.permutation(len(mesh.vertices))
    place = np.argsort(order)
    faces = place[mesh.faces][random.permutation(len(mesh.faces))]
    return meshes.Mesh(mesh.vertices[order], np.roll(faces, 1, axis=1)), [place[p] for p in paths], place


@pytest.mark.parametrize("count", [1, 2, 6])
def test_the_order_of_vertices_and_faces_does_not_matter(registration_of, count):
    pair, result = registration_of(count)
    source, source_curves, place = permuted(pair.source, pair.source_curves, 8)
    target, target_curves, _ = permuted(pair.target, pair.target_curves, 9)
    there = curves.register(curves.CurvePair(source, target, source_curves, target_curves))
    gap = np.linalg.norm(there.positions[place] - result.positions, axis=1)
    if count < 3:
        assert gap.max() < 1e-6
    # where two edges of a face are split, or two arcs are as long, numbers decide: the discretization moves
    assert gap.mean() < 2e-3 * curves.edge_length(pair.target)
    assert gap.max() < 0.1 * curves.edge_length(pair.target)


@pytest.mark.parametrize("count", [4, 6])
def test_the_order_of_the_curves_hardly_matters(registration_of, count):
    """Only the cuts along arcs and the split edges change."""
    pair, result = registration_of(count)
    order = np.random.default_rng(1).permutation(count)
    shuffle = lambda paths: [paths[k] for k in order]  # noqa: E731
    reordered = pair._replace(
        source_curves=shuffle(pair.source_curves), target_curves=shuffle(pair.target_curves)
    )
    gap = np.linalg.norm(curves.register(reordered).positions - result.positions, axis=1)
    assert gap.mean() < 0.02 * curves.edge_length(pair.target)
    assert gap.max() < 0.3 * curves.edge_length(pair.target)


def test_reversed_pairs_have_the_same_map(registration_of):
    pair, result = registration_of(4)
    turned = pair._replace(
        source_curves=[curve[::-1] for curve in pair.source_curves],
        target_curves=[curve[::-1] for curve in pair.target_curves],
    )
    gap = np.linalg.norm(curves.register(turned).positions - result.positions, axis=1)
    assert gap.mean() < 0.02 * curves.edge_length(pair.target)


def test_inside_out_surfaces_have_the_same_map(registration_of):
    pair, result = registration_of(4)
    turned = lambda mesh: meshes.Mesh(mesh.vertices, mesh.faces[:, ::-1])  # noqa: E731
    both = curves.register(pair._replace(source=turned(pair.source), target=turned(pair.target)))
    assert np.linalg.norm(both.positions - result.positions, axis=1).mean() < 0.02
    assert both.certificates.folded.tolist() == []
    half_turned = curves.register(pair._replace(target=turned(pair.target)))
    assert np.linalg.norm(half_turned.positions - result.positions, axis=1).mean() < 0.02
    assert half_turned.certificates.folded.tolist() == []


# Identity, there and back, data


@pytest.mark.parametrize("mesh", [FINE, curves.ELLIPSOID], ids=["bumpy", "ellipsoid"])
@pytest.mark.parametrize("count", [1, 2, 3, 6, 12])
def test_a_surface_onto_itself_is_nearly_the_identity(mesh, count):
    pair = curves.identical(mesh, curves.arcs(count))
    result = curves.register(pair)
    curves.assert_registration(result, pair)
    gap = np.linalg.norm(result.positions - mesh.vertices, axis=1)
    assert gap.mean() < 0.03 * curves.edge_length(mesh)
    assert gap.max() < 0.3 * curves.edge_length(mesh)
    if count > 2:
        assert result.certificates.energy_ratio == pytest.approx(1, abs=0.1)


@pytest.mark.parametrize("count", [1, 2, 6])
def test_the_inverse_leads_back(registration_of, count):
    pair, result = registration_of(count)
    back, inverted = result.inverse(), curves.inverted(pair)
    curves.assert_located(back, inverted)
    curves.assert_curves_meet(back, inverted)
    # g⁻¹ at the three corners around g(v), weighted as g(v) is
    returned = np.einsum(
        "ik,ikx->ix", result.barycentric, back.positions[result.target_faces[result.triangles]]
    )
    gap = np.linalg.norm(returned - pair.source.vertices, axis=1)
    longest = oracle.edge_lengths(*pair.source).max() + oracle.edge_lengths(*pair.target).max()
    assert gap.max() < longest
    assert gap.mean() < 0.3 * curves.edge_length(pair.source)
    again = back.inverse()
    assert np.array_equal(again.positions, result.positions)


def test_the_inverse_is_about_the_map_of_the_exchanged_surfaces(registration_of):
    pair, result = registration_of(6)
    gap = np.linalg.norm(
        curves.register(curves.inverted(pair)).positions - result.inverse().positions, axis=1
    )
    assert gap.mean() < curves.edge_length(pair.source)


def test_data_are_carried_along(registration_of):
    pair, result = registration_of(4)
    assert np.abs(result.pull(pair.target.vertices) - result.positions).max() < 1e-14
    labels = np.arange(len(pair.target.vertices))
    nearest = result.pull(labels, nearest=True)
    best = result.target_faces[result.triangles, result.barycentric.argmax(axis=1)]
    assert (nearest == best).mean() > 0.99
    corners = pair.target.vertices[pair.target.faces]
    assert result.pull(corners).shape == (len(pair.source.faces), 3, 3)
    pulled = result.pull(pair.target.vertices[:, 2])
    correlation, difference = result.compare(pulled, pair.target.vertices[:, 2])
    assert correlation == pytest.approx(1, abs=1e-12)
    assert difference < 1e-14


def test_a_morph_begins_and_ends_at_the_surfaces(registration_of):
    pair, result = registration_of(4)
    start, end = (authalic.homotopy(pair.source.vertices, result, t) for t in (0.0, 1.0))
    assert np.abs(start - pair.source.vertices).max() < 1e-14
    assert np.abs(end - result.positions).max() < 1e-14


def test_the_figures_are_those_of_the_map_in_space(registration_of):
    pair, result = registration_of(6)
    areas = [oracle.face_areas(v, pair.source.faces) for v in (result.positions, pair.source.vertices)]
    ratio = areas[0] / areas[0].sum() * areas[1].sum() / areas[1]
    assert np.allclose(result.area_ratio, ratio, rtol=1e-9)
    assert np.allclose(result.area_distortion, np.maximum(ratio, 1 / ratio), rtol=1e-9)
    for k, curve in enumerate(pair.source_curves):
        loop = pair.target.vertices[pair.target_curves[k]]
        gap, _ = curves.on_polyline(result.positions[curve], loop)
        assert gap.max() <= result.landmark_error[k] * pairs.size(pair.target) * 1.01 + 1e-15


# Boundary loops

SOUTH, EAST, WEST = [0, 0, -1], [0.9, 0.3, -0.3], [-0.9, 0.2, -0.2]
HOLES = {"one": [SOUTH], "two": [SOUTH, EAST], "three": [SOUTH, EAST, WEST]}
NORTH_LINES = [[[0.5, 0.1, 0.8], [0.1, 0.5, 0.9]], [[-0.4, -0.4, 0.8], [0.2, -0.5, 0.9]]]


def open_pair(centers, lines=NORTH_LINES, cosine=0.93):
    source, target = (curves.opened(mesh, centers, cosine) for mesh in (COARSE, EGG))
    return curves.CurvePair(source, target, curves.drawn(source, lines), curves.drawn(target, lines))


def boundary(mesh):
    (patch,) = authalic.cut(*mesh)
    return patch.boundary_loops


def assert_boundary_on_boundary(result, pair):
    """The boundary's vertices lie on the target's boundary, each loop once around one of the other's."""
    partners = boundary(pair.target)
    seen = set()
    for loop in boundary(pair.source):
        gaps = [
            curves.on_polyline(result.positions[loop], pair.target.vertices[np.append(partner, partner[0])])
            for partner in partners
        ]
        which = min(range(len(gaps)), key=lambda k: gaps[k][0].max())
        gap, place = gaps[which]
        assert gap.max() < curves.EXACT * pairs.size(pair.target)
        steps = np.diff(np.append(place, place[0]))
        assert (steps < 0).sum() == 1
        seen.add(which)
    assert len(seen) == len(partners)


@pytest.mark.parametrize("lines", [0, 1, 2])
@pytest.mark.parametrize("centers", HOLES.values(), ids=HOLES)
def test_boundary_loops_are_features(centers, lines):
    pair = open_pair(centers, NORTH_LINES[:lines])
    result = curves.register(pair)
    curves.assert_registration(result, pair, lines + len(centers))
    assert_boundary_on_boundary(result, pair)
    # no hole lands in another's place
    for center in centers:
        rim = np.linalg.norm(
            curves.directions(pair.source) - np.array(center) / np.linalg.norm(center), axis=1
        )
        assert np.dot(result.positions[rim.argmin()], center) > 0


@pytest.mark.parametrize("turn", [0, 7])
@pytest.mark.parametrize("step", [1, -1])
def test_a_boundary_loop_may_be_named(turn, step):
    pair = open_pair(HOLES["two"])
    unnamed = curves.register(pair)
    loops = []
    for mesh in (pair.source, pair.target):
        loops.append(min(boundary(mesh), key=lambda loop: mesh.vertices[loop, 2].mean()))
    loops[1] = np.roll(loops[1], turn)[::step]
    named = curves.CurvePair(
        pair.source,
        pair.target,
        [*pair.source_curves, np.append(loops[0], loops[0][0])],
        [*pair.target_curves, np.append(loops[1], loops[1][0])],
    )
    result = curves.register(named)
    curves.assert_located(result, named)
    curves.assert_certified(result, 4)
    assert_boundary_on_boundary(result, named)
    curves.assert_closed_curve_meets(result, named, 2)
    assert np.linalg.norm(result.positions - unnamed.positions, axis=1).mean() < 0.02


def test_a_disk_onto_a_disk_without_curves():
    pair = curves.CurvePair(
        meshes.bumpy_cap(), meshes.bumpy_cap(rings=17, around=41, noise=0.02, seed=5), [], []
    )
    result = curves.register(pair)
    curves.assert_registration(result, pair, 1)
    assert_boundary_on_boundary(result, pair)


# Closed curves


def ringed(cosine=0.35, lines=NORTH_LINES, source=COARSE, target=EGG):
    """Two surfaces with a closed curve around the south and open curves in the north."""
    rings = [curves.ring(mesh, SOUTH, cosine) for mesh in (source, target)]
    paths = [
        [np.append(ring, ring[0]), *(curves.along(mesh, line) for line in lines)]
        for mesh, ring in zip((source, target), rings, strict=True)
    ]
    return curves.CurvePair(source, target, *paths)


SOUTH_LINES = [[[0.3, 0.1, -1], [-0.2, 0.3, -1]], [[0.1, -0.4, -1], [-0.4, -0.3, -1]]]


@pytest.mark.parametrize(
    "lines",
    [[], NORTH_LINES[:1], NORTH_LINES, SOUTH_LINES, NORTH_LINES + SOUTH_LINES],
    ids=["alone", "one_outside", "two_outside", "two_inside", "both"],
)
def test_a_closed_curve_on_closed_surfaces(lines):
    pair = ringed(lines=lines)
    result = curves.register(pair)
    proof = result.certificates
    assert (proof.folded.tolist(), proof.outside) == ([], 0)
    assert max(proof.curve_error, proof.bank_error) <= curves.EXACT
    assert proof.area_error < 1e-9
    assert result.status == "converged"
    curves.assert_located(result, pair)
    curves.assert_curves_meet(result, pair, skip=[0])
    curves.assert_closed_curve_meets(result, pair, 0)
    curves.assert_unfolded_on_sphere(result, pair)
    # inside to inside
    inside = curves.directions(pair.source) @ SOUTH > 0.35
    assert (result.positions[inside][:, 2] < 0).mean() > 0.99


def test_a_closed_curve_has_neither_start_nor_direction():
    pair = ringed()
    expected = curves.register(pair).positions
    first, *others = pair.source_curves
    loop = first[:-1]
    for step in (1, -1):
        for turn in (0, 5, 11):
            turned = np.roll(loop, turn)[::step]
            given = pair._replace(source_curves=[np.append(turned, turned[0]), *others])
            result = curves.register(given)
            assert result.certificates.folded.tolist() == []
            assert np.linalg.norm(result.positions - expected, axis=1).max() < 1e-6


def test_a_loop_may_be_closed_by_its_last_edge():
    pair = ringed()
    bare = pair._replace(source_curves=[pair.source_curves[0][:-1], *pair.source_curves[1:]])
    expected = curves.register(pair).positions
    assert np.linalg.norm(curves.register(bare).positions - expected, axis=1).max() < 1e-6


def test_nested_closed_curves():
    rings = [[curves.ring(mesh, SOUTH, c) for c in (0.7, 0.2, -0.4)] for mesh in (COARSE, EGG)]
    paths = [[np.append(loop, loop[0]) for loop in loops] for loops in rings]
    pair = curves.CurvePair(COARSE, EGG, *paths)
    result = curves.register(pair)
    assert result.certificates.folded.tolist() == []
    for curve in range(3):
        curves.assert_closed_curve_meets(result, pair, curve)


# Ugly curves


def test_an_open_curve_reversed_on_one_side_is_no_fold_but_a_warning():
    pair = curves.balls(6)
    crossed = pair._replace(target_curves=[pair.target_curves[0][::-1], *pair.target_curves[1:]])
    result = curves.register(crossed)
    curves.assert_registration(result, crossed)
    assert any("curve 0" in warning for warning in result.warnings), result.warnings


def test_curves_that_trade_places_fold_nothing_but_strain_the_map():
    pair = curves.balls(6)
    first, second, *others = pair.target_curves
    swapped = pair._replace(target_curves=[second, first, *others])
    result = curves.register(swapped)
    curves.assert_registration(result, swapped)
    assert any("strained" in warning for warning in result.warnings), result.warnings
    assert result.certificates.energy_ratio > 2


def beside(mesh, curve, used):
    """A path along a curve, one edge apart."""
    around = curves.neighbors(mesh.faces)
    taken, path = {*curve, *used}, []
    for vertex in curve:
        for neighbor in around[vertex]:
            left = np.linalg.det(mesh.vertices[[curve[0], curve[-1], neighbor]]) > 0
            if left and neighbor not in taken and (not path or neighbor in around[path[-1]]):
                path.append(neighbor)
                taken.add(neighbor)
    return path


def test_curves_one_edge_apart():
    line = curves.along(FINE, [[1, -0.3, 0.2], [0.3, 1, 0.4]]).tolist()
    parallel = beside(FINE, line, ())
    around = curves.neighbors(FINE.faces)
    assert len(parallel) > 5
    assert sum(any(v in around[w] for w in line) for v in parallel) == len(parallel)
    third = curves.along(FINE, [[-1, 0.3, -0.2], [-0.3, -1, -0.4]], [*line, *parallel])
    lines = [line, parallel, third]
    for pair in (
        curves.CurvePair(FINE, FINE, lines, lines),
        curves.CurvePair(
            FINE,
            meshes.Mesh(FINE.vertices * [1, 1.5, 2], FINE.faces),
            lines,
            [line[:-1], parallel[1:], third],
        ),
    ):
        result = curves.register(pair)
        curves.assert_registration(result, pair)


def test_tips_one_edge_apart():
    line = curves.along(FINE, [[1, -0.8, 0.2], [0.3, 1, 0.4]]).tolist()
    middle = len(line) // 2
    pieces = [line[: middle - 3], line[middle - 3 : middle + 2], line[middle + 2 :]]
    target = meshes.Mesh(FINE.vertices * [1, 1.5, 2], FINE.faces)
    pair = curves.CurvePair(FINE, target, pieces, pieces)
    curves.assert_registration(curves.register(pair), pair)


@pytest.mark.parametrize("count", [1, 2, 3, 8])
def test_curves_of_two_edges(count):
    pair = curves.balls(count, source=FINE)
    short = [[path[1:4] for path in side] for side in pair[2:]]
    pair = curves.CurvePair(pair.source, pair.target, *short)
    curves.assert_registration(curves.register(pair), pair)


def test_short_curves_onto_long_ones():
    pair = curves.balls(4, source=FINE)
    pair = pair._replace(source_curves=[path[:3] for path in pair.source_curves])
    curves.assert_registration(curves.register(pair), pair)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_three_vertices_of_one_triangle_are_an_open_curve(count):
    """An edge joins the first and the last vertex, but two edges of a triangle are no loop."""
    pair = curves.balls(count)
    corner = pair.source.faces[(pair.source.faces == pair.source_curves[0][3]).any(axis=1)][0].tolist()
    others = [path for path in pair.source_curves[1:] if not set(corner) & set(path.tolist())]
    assert len(others) == count - 1
    bent = pair._replace(source_curves=[corner, *others])
    result = curves.register(bent)
    curves.assert_registration(result, bent)
    both = curves.CurvePair(pair.source, pair.source, bent.source_curves, bent.source_curves)
    result = curves.register(both)
    curves.assert_registration(result, both)
    assert np.linalg.norm(result.positions - pair.source.vertices, axis=1).max() < curves.edge_length(
        pair.source
    )


def test_a_spiral():
    angle = np.linspace(0, 3 * np.pi, 60)
    height = np.linspace(0.55, 0.95, 60)
    radius = np.sqrt(1 - height**2)
    stations = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    lines = [stations, [[0.5, 0, -1], [-0.5, 0.1, -1]], [[1, 0, -0.1], [0.3, 1, -0.2]]]
    mesh = meshes.bumpy_ball(5)
    paths = [simple(curves.along(mesh, lines[0]))]
    for line in lines[1:]:
        paths.append(curves.along(mesh, line, np.concatenate(paths)))
    pair = curves.CurvePair(mesh, meshes.Mesh(mesh.vertices * [1, 1.3, 1.2], mesh.faces), paths, paths)
    result = curves.register(pair)
    curves.assert_registration(result, pair)
    curves.assert_unfolded_on_sphere(result, pair, rings=4)


def simple(path):
    """The path without detours to vertices seen before."""
    kept = []
    for vertex in path.tolist():
        kept = kept[: kept.index(vertex)] if vertex in kept else kept
        kept.append(vertex)
    return np.array(kept)


# Options


def test_given_spheres_say_how_the_surfaces_lie(registration_of):
    pair, result = registration_of(6)
    spheres = {
        "source_sphere": curves.directions(pair.source),
        "target_sphere": 7 * curves.directions(pair.target),
    }
    given = curves.register(pair, **spheres)
    curves.assert_registration(given, pair)
    # the chain of arcs is another, the map is the same
    gap = np.linalg.norm(given.positions - result.positions, axis=1)
    assert gap.mean() < 0.05 * curves.edge_length(pair.target)
    turn, _ = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))
    spheres["source_sphere"] = spheres["source_sphere"] @ (turn * np.sign(np.linalg.det(turn)))
    turned = curves.register(pair, **spheres)
    assert np.linalg.norm(turned.positions - given.positions, axis=1).max() < 1e-6
