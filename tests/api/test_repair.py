# SPDX-License-Identifier: MIT OR Apache-2.0
"""Repairs of meshes as scans, volumes and files have them; every result is checked by formulas of its own."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import authalic

from . import meshes, oracle, real_meshes, volumes


def half_edges(faces):
    """The (from, to) of every side of every face, (3 m, 2)."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)


def edge_counts(faces):
    return np.unique(np.sort(half_edges(faces), axis=1), axis=0, return_counts=True)[1]


def n_pieces(faces):
    """The number of pieces, by vertices that edges join."""
    a, b = half_edges(faces).T
    n = faces.max() + 1
    return connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(n, n)))[0]


def genus(faces):
    """The sum of the genera of a closed surface, by Euler's formula."""
    euler = len(np.unique(faces)) - len(edge_counts(faces)) + len(faces)
    return n_pieces(faces) - euler // 2


def volume(mesh):
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def assert_oriented_manifold(mesh, closed=True):
    """Every edge has two faces that run along it in opposite directions, every vertex one fan."""
    vertices, faces = mesh.vertices, mesh.faces
    assert np.array_equal(np.unique(faces), np.arange(len(vertices))), "a loose vertex"
    sides = half_edges(faces)
    assert len(np.unique(sides, axis=0)) == len(sides), "two faces run along an edge in the same direction"
    if closed:
        assert (edge_counts(faces) == 2).all()
    # corners of one vertex whose faces have an edge there in common are one fan
    corner = np.arange(3 * len(faces)).reshape(-1, 3)
    ends = np.stack([corner, np.roll(corner, -1, axis=1)], axis=2).reshape(-1, 2)
    position = {tuple(side): k for k, side in enumerate(sides.tolist())}
    across = [(k, position[b, a]) for k, (a, b) in enumerate(sides.tolist()) if (b, a) in position]
    if across:
        here, there = np.array(across).T
        joined = np.concatenate([[ends[here, 0], ends[there, 1]], [ends[here, 1], ends[there, 0]]], axis=1)
        n = corner.size
        fans = connected_components(coo_array((np.ones(joined.shape[1]), joined), shape=(n, n)))[0]
        assert fans == len(vertices), "a vertex has several fans"
    assert (oracle.face_areas(vertices, faces) > 0).all()


def assert_maps_back(mesh, repaired):
    """Copies lie where their originals lie, and the maps to and fro agree."""
    given, made = np.asarray(mesh.vertices, float), repaired.vertices
    kept = repaired.vertex_of >= 0
    assert np.array_equal(made[kept], given[repaired.vertex_of[kept]])
    assert repaired.vertex_to.shape == (len(given),)
    assert repaired.face_to.shape == (len(mesh.faces),)
    stays = repaired.face_to >= 0
    assert np.array_equal(repaired.face_of[repaired.face_to[stays]], np.flatnonzero(stays))
    to = repaired.vertex_to[repaired.vertex_to >= 0]
    assert to.max(initial=0) < len(made)
    # a vertex kept as it was is the image of its original, or a further copy of it
    first = repaired.vertex_to[repaired.vertex_of[kept]]
    assert np.array_equal(made[first], made[kept])


def soup(mesh):
    """Every face with corners of its own, as an STL file has it."""
    return meshes.Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(mesh.faces.size).reshape(-1, 3))


@pytest.mark.parametrize(
    "mesh",
    [meshes.bumpy_cap(), meshes.bumpy_ball(2), meshes.torus(), meshes.annulus()],
    ids=["disk", "ball", "torus", "annulus"],
)
def test_a_sound_mesh_stays_as_it_is(mesh):
    repaired = authalic.repair(*mesh)
    assert not repaired.is_changed
    assert set(repaired.counts.values()) == {0}
    assert np.array_equal(repaired.vertices, mesh.vertices)
    assert np.array_equal(repaired.faces, mesh.faces)
    for numbers, count in ((repaired.vertex_of, len(mesh.vertices)), (repaired.face_to, len(mesh.faces))):
        assert np.array_equal(numbers, np.arange(count))
    assert repaired.report.startswith("nothing to repair\nresult: ")


def test_an_unmerged_file_becomes_the_surface_that_it_was():
    mesh = meshes.rough_ball(4)
    given = soup(mesh)
    assert len(given.faces) == 2048
    repaired = authalic.repair(*given)
    assert repaired.counts["merged_points"] == len(given.vertices) - len(mesh.vertices)
    assert_oriented_manifold(repaired)
    assert_maps_back(given, repaired)
    assert len(repaired.vertices) == len(mesh.vertices)
    assert genus(repaired.faces) == 0
    assert np.array_equal(repaired.vertices[repaired.faces], given.vertices[given.faces])


def test_an_unmerged_file_is_told_to_merge():
    mesh = meshes.ball(3)
    with pytest.raises(authalic.MeshError, match="512 separate pieces") as caught:
        authalic.sphere_map(*soup(mesh))
    assert caught.value.kind == "several_components"
    assert "merge equal points (repair=True merges them)" in str(caught.value)
    assert "map each piece" not in str(caught.value)
    mapped = authalic.sphere_map(*soup(mesh), repair=True)
    assert mapped.positions.shape == mesh.vertices.shape
    oracle.assert_sphere_embedding(mapped)


def test_pieces_apart_from_each_other_are_told_to_be_mapped_one_by_one():
    ball = meshes.ball(2)
    faces = np.vstack([ball.faces, ball.faces + len(ball.vertices)])
    two = meshes.Mesh(np.vstack([ball.vertices, ball.vertices + 5]), faces)
    with pytest.raises(authalic.MeshError, match="map each piece by itself"):
        authalic.sphere_map(*two)


def test_a_sphere_open_along_a_doubled_meridian_is_told_to_merge():
    mesh, _ = meshes.sphere()
    opened = authalic.cut(*mesh, seams=meridian(mesh))[0]
    words = r"a sphere has none: \d+ points there .* merge equal points"
    with pytest.raises(authalic.MeshError, match=words):
        authalic.sphere_map(opened)
    assert authalic.repair(opened).surface.is_closed


def meridian(mesh):
    """A path of edges from the lowest vertex to the highest, always up."""
    neighbors = {}
    for a, b in half_edges(mesh.faces).tolist():
        neighbors.setdefault(a, []).append(b)
    height = mesh.vertices[:, 2]
    path = [int(height.argmin())]
    while path[-1] != height.argmax():
        path.append(max(neighbors[path[-1]], key=lambda vertex: height[vertex]))
    return np.stack([path[:-1], path[1:]], axis=1)


def test_points_within_a_distance_are_merged():
    mesh = meshes.rough_ball(3)
    given = soup(mesh)
    noise = np.random.default_rng(4).uniform(-1e-5, 1e-5, given.vertices.shape)
    near = meshes.Mesh(given.vertices + noise, given.faces)
    assert authalic.repair(*near).counts["merged_points"] == 0
    repaired = authalic.repair(*near, merge=1e-4)
    assert len(repaired.vertices) == len(mesh.vertices)
    assert_oriented_manifold(repaired)
    # every merged point lies within the distance of the one that stays
    to = repaired.vertices[repaired.vertex_to]
    assert np.linalg.norm(to - near.vertices, axis=1).max() <= 1e-4
    assert authalic.repair(*given, merge=None).counts["merged_points"] == 0


def test_points_inside_a_closed_surface_are_not_merged_with_others():
    """Two balls that touch in a point stay two balls."""
    ball = meshes.ball(2)
    shifted = ball.vertices + np.array([2, 0, 0])
    two = meshes.Mesh(np.vstack([ball.vertices, shifted]), np.vstack([ball.faces, ball.faces + len(shifted)]))
    assert (np.linalg.norm(ball.vertices[:, None] - shifted, axis=2) == 0).sum() == 1
    assert not authalic.repair(*two).is_changed


def test_points_that_touch_without_an_edge_in_common_are_not_merged():
    """Two squares with one corner at the same place, and a square beside the first that shares a side."""
    square = meshes.single_quad()
    moved = [square.vertices * [1, 1, 0] + shift for shift in ([0, 0, 0], [1, 1, 0], [-1, 0, 0])]
    given = meshes.Mesh(np.vstack(moved), np.vstack([square.faces + 4 * k for k in range(3)]))
    repaired = authalic.repair(*given)
    assert repaired.counts["merged_points"] == 2
    assert repaired.counts["split_vertices"] == 0
    assert n_pieces(repaired.faces) == 2
    assert np.array_equal(repaired.vertices, np.delete(given.vertices, [9, 10], axis=0))
    assert not authalic.repair(repaired).is_changed


def test_vertices_that_are_no_numbers_go_and_the_hole_is_closed():
    mesh = meshes.bumpy_ball(3)
    vertices = mesh.vertices.copy()
    vertices[[40, 200]] = [[np.nan], [np.inf]]
    lost = np.isin(mesh.faces, [40, 200]).any(axis=1)
    repaired = authalic.repair(vertices, mesh.faces)
    assert repaired.counts["vertices_not_finite"] == 2
    assert repaired.counts["faces_not_finite"] == lost.sum()
    assert repaired.counts["closed_holes"] == 2
    assert_oriented_manifold(repaired)
    assert (repaired.vertex_to[[40, 200]] == -1).all()
    assert np.array_equal(np.flatnonzero(repaired.face_to == -1), np.flatnonzero(lost))
    assert (repaired.vertex_of == -1).sum() == 2
    assert genus(repaired.faces) == 0
    oracle.assert_sphere_embedding(authalic.sphere_map(vertices, mesh.faces, repair=True))


def test_loose_vertices_go_also_those_that_are_far_away():
    mesh = meshes.bumpy_cap()
    vertices = np.vstack([[[1e30, 0, 0]], mesh.vertices, [[np.nan] * 3]])
    repaired = authalic.repair(vertices, mesh.faces + 1)
    assert (repaired.counts["loose_vertices"], repaired.counts["vertices_not_finite"]) == (1, 1)
    assert np.array_equal(repaired.vertices, mesh.vertices)
    assert np.array_equal(repaired.faces, mesh.faces)
    assert repaired.vertex_to[[0, -1]].tolist() == [-1, -1]


def slivers_inserted(mesh, edges):
    """The mesh with points in the middle of some edges, which one of the two faces there has, and slivers."""
    vertices, faces = list(mesh.vertices), mesh.faces.tolist()
    for a, b in edges:
        face = next(k for k, f in enumerate(faces) if (a, b) in zip(f, f[1:] + f[:1], strict=True))
        c = next(v for v in faces[face] if v not in (a, b))
        middle = len(vertices)
        vertices.append((vertices[a] + vertices[b]) / 2)
        faces[face] = [a, middle, c]
        faces += [[middle, b, c], [a, b, middle]]
    return meshes.Mesh(np.array(vertices), np.array(faces))


def test_slivers_are_removed_and_nothing_moves():
    mesh = meshes.octahedron()
    for _ in range(3):
        mesh = meshes.split_in_four(mesh)
    mesh = meshes.Mesh(np.round(mesh.vertices * 64), mesh.faces)  # the middles of edges are exact
    edges = half_edges(mesh.faces[::7])[::3][:81]
    given = slivers_inserted(mesh, edges)
    assert (oracle.face_areas(*given) == 0).sum() == len(edges)
    repaired = authalic.repair(*given)
    assert repaired.counts["faces_without_area"] == len(edges)
    assert_oriented_manifold(repaired)
    assert_maps_back(given, repaired)
    assert len(repaired.vertices) == len(given.vertices)
    area = oracle.face_areas(*given).sum()
    assert oracle.face_areas(repaired.vertices, repaired.faces).sum() == pytest.approx(area, rel=1e-12)
    oracle.assert_sphere_embedding(authalic.sphere_map(*given, repair=True))


def test_a_sliver_on_an_open_edge_goes_without_a_trace():
    mesh = meshes.grid(4, 4, aspect=1.0)
    given = slivers_inserted(mesh, [(0, 1)])
    repaired = authalic.repair(*given)
    assert repaired.counts["faces_without_area"] == 1
    assert repaired.surface.is_disk
    assert len(repaired.faces) == len(mesh.faces) + 1


def distances(size, centers):
    """The distance of every point of a grid from the nearest center."""
    grid = np.moveaxis(np.mgrid[:size, :size, :size], 0, -1)
    return np.min([np.linalg.norm(grid - center, axis=-1) for center in centers], axis=0)


def test_marching_at_a_level_of_voxel_values_leaves_thousands_of_faces_without_area():
    values = np.round(11.0 - distances(28, [(13.3, 13.5, 13.1)]))
    mesh = volumes.level_set(values, 1.0)
    flat = oracle.face_areas(*mesh) == 0
    assert flat.sum() > 6000
    repaired = authalic.repair(*mesh)
    assert_oriented_manifold(repaired)
    assert_maps_back(mesh, repaired)
    assert genus(repaired.faces) == 0
    assert repaired.counts["closed_holes"] == 0
    assert volume(repaired) == pytest.approx(volume(mesh), rel=1e-12)
    oracle.assert_sphere_embedding(authalic.sphere_map(repaired, max_iterations=3))


def test_a_voxel_staircase_comes_apart_where_it_touches_in_edges_and_corners():
    rng = np.random.default_rng(0)
    mask = (distances(14, [(6.5, 6.5, 6.5)]) < 6) & (rng.random((14, 14, 14)) > 0.15)
    mesh = volumes.voxel_sides(mask)
    counts = edge_counts(mesh.faces)
    assert (counts == 4).sum() > 50
    repaired = authalic.repair(*mesh)
    assert repaired.counts["split_edges"] == (counts > 2).sum()
    assert_oriented_manifold(repaired)
    assert_maps_back(mesh, repaired)
    assert volume(repaired) == pytest.approx(mask.sum(), rel=1e-12)
    assert oracle.face_areas(repaired.vertices, repaired.faces).sum() == pytest.approx(len(mesh.faces) / 2)
    # parts that touch only in an edge or a corner are pieces: voxels hang together by their sides
    assert n_pieces(repaired.faces) == bodies(mask) + cavities(mask)


def bodies(mask):
    """The number of parts of a mask that hang together by sides of voxels."""
    index = np.arange(mask.size).reshape(mask.shape)
    pairs = []
    for axis in range(3):
        here, there = np.moveaxis(index, axis, 0)[:-1], np.moveaxis(index, axis, 0)[1:]
        both = mask.ravel()[here] & mask.ravel()[there]
        pairs.append(np.stack([here[both], there[both]]))
    pairs = np.concatenate(pairs, axis=1)
    labels = connected_components(coo_array((np.ones(pairs.shape[1]), pairs), shape=(mask.size,) * 2))[1]
    return len(np.unique(labels[mask.ravel()]))


def cavities(mask):
    """The number of parts of the outside that no path through sides or edges of voxels leads out of."""
    outside = np.pad(~mask, 1, constant_values=True)
    reached = np.zeros_like(outside)
    count = -1
    for start in map(tuple, np.argwhere(outside)):
        if reached[start]:
            continue
        count += 1
        front = [start]
        reached[start] = True
        while front:
            place = np.array(front.pop())
            for step in np.ndindex(3, 3, 3):
                near = tuple(place + step - 1)
                if np.abs(np.subtract(step, 1)).sum() == 3:
                    continue
                inside_grid = min(near) >= 0 and all(np.less(near, outside.shape))
                if inside_grid and outside[near] and not reached[near]:
                    reached[near] = True
                    front.append(near)
    return count


def test_two_pairs_of_faces_with_both_ends_of_an_edge_in_common_get_points_in_its_middle():
    """Two voxels that touch in an edge, between two layers that join them."""
    mask = np.zeros((2, 2, 3), bool)
    mask[:, :, [0, 2]] = True
    mask[0, 0, 1] = mask[1, 1, 1] = True
    mesh = volumes.voxel_sides(mask)
    assert (edge_counts(mesh.faces) == 4).sum() == 1
    repaired = authalic.repair(*mesh)
    assert_oriented_manifold(repaired)
    assert volume(repaired) == pytest.approx(mask.sum())
    assert genus(repaired.faces) == 1
    added = repaired.vertices[repaired.vertex_of == -1]
    assert np.array_equal(added, [[2, 2, 2.5]] * 2)
    parents = np.unique(repaired.face_of, return_counts=True)
    assert (parents[1] == 2).sum() == 4


def test_cones_that_touch_in_their_tips_come_apart():
    fan = meshes.fan()
    below = meshes.Mesh(fan.vertices * [1, 1, -1] + [0, 0, 1.4], fan.faces[:, ::-1])
    joined = np.where(below.faces == 0, 0, below.faces + len(fan.vertices) - 1)
    mesh = meshes.Mesh(np.vstack([fan.vertices, below.vertices[1:]]), np.vstack([fan.faces, joined]))
    with pytest.raises(authalic.MeshError, match=r"touch only in a point.*authalic\.repair mends this"):
        authalic.disk_map(*mesh)
    repaired = authalic.repair(*mesh)
    assert repaired.counts["split_vertices"] == 1
    assert n_pieces(repaired.faces) == 2
    assert repaired.vertex_of[-1] == 0


def test_an_inner_wall_becomes_a_piece_of_its_own():
    mesh = meshes.ball(2)
    wall = meshes.compact(meshes.Mesh(mesh.vertices, mesh.faces))
    rim = np.flatnonzero(wall.vertices[:, 2] == 0)
    rim = rim[np.argsort(np.arctan2(*wall.vertices[rim, :2].T))]
    middle = len(wall.vertices)
    fan = np.stack([np.full(len(rim), middle), rim, np.roll(rim, -1)], axis=1)
    given = meshes.Mesh(np.vstack([wall.vertices, [[0, 0, 0]]]), np.vstack([wall.faces, fan]))
    assert (edge_counts(given.faces) == 3).sum() == len(rim)
    repaired = authalic.repair(*given, keep="largest")
    assert_oriented_manifold(repaired)
    assert len(repaired.faces) == len(mesh.faces)
    assert (repaired.face_to[len(mesh.faces) :] == -1).all()
    assert repaired.counts["dropped_pieces"] == 1


def test_repeated_faces_go_whichever_way_they_run():
    mesh = meshes.bumpy_ball(2)
    again = np.vstack([mesh.faces, mesh.faces[[3, 7]], mesh.faces[[20]][:, ::-1]])
    repaired = authalic.repair(mesh.vertices, again)
    assert repaired.counts["repeated_faces"] == 3
    assert np.array_equal(repaired.faces, mesh.faces)


def test_a_mesh_with_both_sides_of_every_face_keeps_one():
    mesh = meshes.bumpy_cap()
    repaired = authalic.repair(mesh.vertices, np.vstack([mesh.faces, mesh.faces[:, ::-1]]))
    assert len(repaired.faces) == len(mesh.faces)
    assert repaired.surface.is_disk


def test_a_fold_of_no_thickness_vanishes():
    mesh = meshes.ball(2)
    a, b = mesh.faces[0, :2]
    tip = len(mesh.vertices)
    fold = [[a, b, tip], [b, a, tip]]
    given = meshes.Mesh(np.vstack([mesh.vertices, [[2, 2, 2]]]), np.vstack([mesh.faces, fold]))
    repaired = authalic.repair(*given)
    assert repaired.counts["repeated_faces"] == 2
    assert_oriented_manifold(repaired)
    assert np.array_equal(repaired.faces, mesh.faces)


def test_faces_are_turned_like_most_of_their_piece():
    mesh = meshes.bumpy_ball(2)
    turned = np.random.default_rng(1).random(len(mesh.faces)) < 0.3
    faces = np.where(turned[:, None], mesh.faces[:, [0, 2, 1]], mesh.faces)
    repaired = authalic.repair(mesh.vertices, faces)
    assert repaired.counts["turned_faces"] == turned.sum()
    assert np.array_equal(repaired.faces, mesh.faces)


def test_a_sphere_lacking_a_triangle_is_closed():
    mesh = meshes.bumpy_ball(2)
    repaired = authalic.repair(mesh.vertices, mesh.faces[1:])
    assert repaired.counts["closed_holes"] == 1
    assert sorted(repaired.faces[-1]) == sorted(mesh.faces[0])
    assert repaired.face_of[-1] == -1
    assert_oriented_manifold(repaired)
    with pytest.raises(authalic.MeshError, match="fill_holes=True fills them"):
        authalic.sphere_map(mesh.vertices, mesh.faces[1:])
    oracle.assert_sphere_embedding(authalic.sphere_map(mesh.vertices, mesh.faces[1:], repair=True))


@pytest.mark.parametrize(
    ("close_holes", "left"),
    [
        ("pinholes", [96, 24, 16]),
        (False, [96, 24, 16, 8]),
        (8, [96, 24, 16]),
        (16, [96, 24]),
        (24, [96]),
        (True, []),
    ],
)
def test_the_holes_that_are_asked_for_are_closed(close_holes, left):
    repaired = authalic.repair(*meshes.plate_with_holes(), close_holes=close_holes)
    assert [len(loop) for loop in repaired.surface.boundary_loops] == left
    assert_oriented_manifold(repaired, closed=not left)


def test_the_outline_of_a_disk_stays_open():
    repaired = authalic.repair(*meshes.plate_with_holes(), close_holes=True, keep_outline=True)
    assert repaired.surface.is_disk
    pyramid = meshes.fan(4)
    assert not authalic.repair(*pyramid).is_changed
    finger = meshes.tube_disk(around=8)
    assert authalic.repair(*finger).surface.is_closed
    assert authalic.disk_map(*finger, repair=True).uv.shape == (len(finger.vertices), 2)


def capsule_field(points, ends, radius):
    """The radius minus the distance of points from the nearest of some segments."""
    nearest = np.inf
    for a, b in ends:
        a, b = np.array(a, float), np.array(b, float)
        along = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)[..., None]
        nearest = np.minimum(nearest, np.linalg.norm(points - a - along * (b - a), axis=-1))
    return radius - nearest


def neuron():
    """A soma with dendrites, three of which touch a neighbor: a surface of genus 3."""
    grid = np.moveaxis(np.mgrid[:46, :46, :20], 0, -1).astype(float)
    ends = [((22, 22, 10), (22 + 18 * np.cos(a), 22 + 18 * np.sin(a), 10)) for a in np.arange(6) * np.pi / 3]
    along = [0.25 * np.array(soma) + 0.75 * np.array(tip) for soma, tip in ends]
    bridges = [(along[k], along[k + 1]) for k in (0, 2, 4)]
    soma = capsule_field(grid, [((22, 22, 9), (22, 22, 11))], 6)
    return volumes.level_set(np.maximum(capsule_field(grid, ends + bridges, 1.7), soma), 0.01)


def test_the_handles_of_a_neuron_are_closed():
    mesh = neuron()
    assert genus(mesh.faces) == 3
    assert authalic.repair(*mesh).surface.genus == 3
    repaired = authalic.repair(*mesh, close_handles=True)
    assert repaired.counts["closed_handles"] == 3
    assert_oriented_manifold(repaired)
    assert_maps_back(mesh, repaired)
    assert (n_pieces(repaired.faces), genus(repaired.faces)) == (1, 0)
    # the bridges are cut where they are thin: a loop around a tube of radius 1.7
    added = oracle.face_areas(repaired.vertices, repaired.faces)[repaired.face_of == -1].sum()
    assert added < 3 * 2 * 1.3 * np.pi * 1.7**2
    # its bridges are a tenth of it thick, which may be its shape: no map takes them for noise by itself
    for options in ({}, {"repair": True}):
        with pytest.raises(
            authalic.MeshError, match=r"genus 3 .* repair with close_handles=True closes handles"
        ):
            authalic.sphere_map(*mesh, **options)
    oracle.assert_sphere_embedding(authalic.sphere_map(repaired))


def noisy_ball():
    """A ball of voxels with a tunnel and a bridge of one voxel, and a hole that is its shape."""
    grid = np.moveaxis(np.mgrid[:44, :44, :44], 0, -1) - 21.5
    mask = np.linalg.norm(grid, axis=-1) < 20
    mask[:, 20:24, 36:] = False  # the ditch, and the bridge over it
    mask[21, 20:24, 38] = True
    mask[21, :8, 21] = False  # the tunnel, in and out again
    mask[21, 7, 21:24] = False
    mask[21, :8, 23] = False
    mask[16:28, :, 14:20] = False  # a hole through the whole body
    return mask


def test_noise_is_closed_and_handles_of_the_shape_are_not():
    mesh = volumes.voxel_sides(noisy_ball())
    assert authalic.repair(*mesh, keep="largest").surface.genus == 3
    repaired = authalic.repair(*mesh, close_handles="noise", keep="largest")
    assert repaired.counts["closed_handles"] == 2
    assert repaired.surface.genus == 1
    assert authalic.repair(*mesh, close_handles=True, keep="largest").surface.genus == 0


@pytest.mark.parametrize("tube", [0.06, 0.1, 0.3])
@pytest.mark.parametrize("fineness", [1, 4])
def test_a_ring_is_no_noise_however_thin_or_coarse_it_is(tube, fineness):
    around, across = 16 * fineness, 6 * fineness
    a, b = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in (around, across)), indexing="ij")
    radius = 1 + tube * np.cos(b)
    points = np.stack([radius * np.cos(a), radius * np.sin(a), tube * np.sin(b)], axis=-1).reshape(-1, 3)
    index = np.arange(around * across).reshape(around, across)
    corners = index, np.roll(index, -1, 0), np.roll(index, (-1, -1), (0, 1)), np.roll(index, -1, 1)
    quads = np.stack([corner.ravel() for corner in corners], axis=1)
    ring = points, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    assert not authalic.repair(*ring, close_handles="noise").is_changed
    assert authalic.repair(*ring, close_handles=True).surface.genus == 0


def test_the_handles_of_a_statue_are_its_shape():
    statue = real_meshes.load(real_meshes.file("seams/fertility.npz"))
    assert not authalic.repair(*statue).is_changed
    assert not authalic.repair(*statue, close_handles="noise").is_changed
    with pytest.raises(authalic.MeshError, match="genus 4"):
        authalic.sphere_map(*statue, repair=True)
    size = np.sqrt(oracle.face_areas(*statue).sum())
    for length in (True, 2 * size):
        assert authalic.repair(*statue, close_handles=length).surface.genus == 0


def test_handles_up_to_a_length_are_closed():
    mesh = meshes.torus()  # tubes of circumference 6 around a hole of circumference 6
    repaired = [authalic.repair(*mesh, close_handles=length) for length in (5.0, 7.0)]
    assert [each.surface.genus for each in repaired] == [1, 0]
    with pytest.raises(authalic.MeshError, match="genus 1"):  # its handle is the shape, no noise
        authalic.sphere_map(*mesh, repair=True)
    assert_oriented_manifold(repaired[1])


def test_a_repaired_handle_stays_closed_when_it_is_repaired_again():
    repaired = authalic.repair(*neuron(), close_handles=True)
    again = authalic.repair(repaired.vertices, repaired.faces, close_handles=True)
    assert not again.is_changed
    assert np.array_equal(again.faces, repaired.faces)


def test_an_open_surface_keeps_its_boundary_when_a_handle_is_closed():
    mesh = meshes.torus(30, 20)
    opened = meshes.compact(meshes.Mesh(mesh.vertices, mesh.faces[60:]))
    loops = [len(loop) for loop in authalic.Surface(*opened).boundary_loops]
    repaired = authalic.repair(*opened, close_handles=True)
    assert repaired.surface.genus == 0
    assert [len(loop) for loop in repaired.surface.boundary_loops] == loops
    assert_oriented_manifold(repaired, closed=False)


def mask_with_tunnels():
    """12 parts, the largest of them with 7 tunnels."""
    mask = np.zeros((30, 26, 12), bool)
    mask[2:24, 2:24, 2:8] = True
    for k in range(7):
        row, column = divmod(k, 3)
        mask[4 + 6 * row : 6 + 6 * row, 4 + 6 * column : 6 + 6 * column] = False
    for k in range(11):
        mask[26 + k % 2, 2 * k + 1, 9] = True
    return mask


def test_a_mask_of_12_pieces_and_genus_7_becomes_a_sphere():
    mesh = volumes.voxel_sides(mask_with_tunnels())
    assert (n_pieces(mesh.faces), genus(mesh.faces)) == (12, 7)
    with pytest.raises(authalic.MeshError, match="12 separate pieces"):
        authalic.sphere_map(*mesh)
    # loops of 8 voxels go around the tunnels, which are a fifth of the root of the area: no noise
    with pytest.raises(authalic.MeshError, match="genus 7"):
        authalic.sphere_map(*mesh, repair=True)
    repaired = authalic.repair(*mesh, close_handles=8.5, keep="largest")
    assert repaired.counts["dropped_pieces"] == 11
    assert repaired.counts["closed_handles"] == 7
    assert_oriented_manifold(repaired)
    assert (n_pieces(repaired.faces), genus(repaired.faces)) == (1, 0)
    oracle.assert_sphere_embedding(authalic.sphere_map(repaired, max_iterations=5))
    assert n_pieces(authalic.repair(*mesh).faces) == 12


def sponge(cells):
    """A lattice of bars: genus grows with the cube of the number of cells."""
    mask = np.zeros((3 * cells + 1,) * 3, bool)
    on_bar = np.arange(3 * cells + 1) % 3 == 0
    for axis in range(3):
        bars = np.expand_dims(on_bar, tuple(k for k in range(3) if k != (axis + 1) % 3))
        others = np.expand_dims(on_bar, tuple(k for k in range(3) if k != (axis + 2) % 3))
        mask |= bars & others
    return mask


def test_all_of_95_handles_and_more_are_closed():
    mesh = volumes.voxel_sides(sponge(3))
    assert genus(mesh.faces) == 81
    repaired = authalic.repair(*mesh, close_handles=True)
    assert repaired.counts["closed_handles"] == 81
    assert_oriented_manifold(repaired)
    assert (n_pieces(repaired.faces), genus(repaired.faces)) == (1, 0)


def test_loops_as_long_as_what_is_asked_for_are_closed():
    mesh = volumes.voxel_sides(sponge(3))  # of bars of a voxel, four long edges around
    assert authalic.repair(*mesh, close_handles=3.99).surface.genus == 81
    assert authalic.repair(*mesh, close_handles=4).surface.genus == 0


@pytest.mark.parametrize("distance", [1e-300, 1e-25, 1e-12, 1e-3, 0.3])
def test_merging_many_points_takes_no_longer_for_any_distance(distance):
    """What compares all points with all takes minutes for these."""
    given = soup(meshes.ball(6))
    assert len(given.vertices) > 90_000
    if distance == 0.3:
        with pytest.raises(authalic.MeshError, match="no faces that a repair can keep"):
            authalic.repair(*given, merge=distance)
    else:
        assert authalic.repair(*given, merge=distance).surface.is_closed


def test_a_one_sided_surface_is_reported():
    repaired = authalic.repair(*meshes.moebius())
    assert "not orientable" in repaired.report


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e12])
@pytest.mark.parametrize("offset", [(0, 0, 0), (431_000.0, 5_412_000.0, 230.0)], ids=["here", "utm"])
def test_repairs_depend_neither_on_the_unit_nor_on_the_place(scale, offset):
    mesh = meshes.bumpy_ball(3)
    vertices = (np.round(mesh.vertices * 2**12) / 2**12 * 100 + offset) * scale
    given = soup(meshes.Mesh(vertices, np.delete(mesh.faces, 5, axis=0)))
    repaired = authalic.repair(*given)
    assert len(repaired.vertices) == len(mesh.vertices)
    assert repaired.counts["closed_holes"] == 1
    assert_oriented_manifold(repaired)


def masked_terrain():
    """A terrain on a grid of a metre with 18 holes, on UTM coordinates."""
    rows, columns = np.mgrid[:40, :60]
    heights = 300 + 4 * np.sin(rows / 6) * np.cos(columns / 7)
    points = np.stack([431_000.0 + columns, 5_412_000.0 + rows, heights], axis=-1).reshape(-1, 3)
    for k in range(18):
        row, column = 5 + 12 * (k // 6), 5 + 9 * (k % 6)
        points.reshape(40, 60, 3)[row : row + 3 + k % 2, column : column + 2] = np.nan
    return meshes.Mesh(points, meshes.quads(40, 60))


def test_a_masked_terrain_with_18_holes_is_mapped():
    mesh = masked_terrain()
    with pytest.raises(authalic.MeshError, match="NaN"):
        authalic.disk_map(*mesh)
    repaired = authalic.repair(*mesh)
    assert len(repaired.surface.boundary_loops) == 19
    mapped = authalic.disk_map(*mesh, repair=True, fill_holes=True)
    oracle_faces = mapped.repaired.faces
    assert np.array_equal(mapped.faces, oracle_faces)
    assert len(mapped.distortion.folded) == 0
    assert oracle.folded(mapped.uv, mapped.faces) == []
    assert mapped.distortion.area_ratio_std < 0.05


def test_densities_and_corners_are_those_of_the_mesh_given():
    mesh = meshes.grid(7, 9)
    given = soup(mesh)
    density = oracle.face_areas(*mesh) * np.where(np.arange(len(mesh.faces)) < 40, 3.0, 1.0)
    plain = authalic.disk_map(*mesh, density=density)
    mapped = authalic.disk_map(*given, density=density, repair=True)
    numbers = mapped.repaired.vertex_to[np.argsort(mesh.faces.ravel(), kind="stable")]
    assert numbers.min() == 0
    share = oracle.signed_areas(mapped.uv, mapped.faces)
    assert np.allclose(share, oracle.signed_areas(plain.uv, plain.faces), rtol=1e-3)
    corners = [int(np.flatnonzero(given.faces.ravel() == v)[0]) for v in range(4)]
    first = [int(np.flatnonzero(mesh.faces.ravel() == v)[0]) for v in (0, 8, 62, 54)]
    rectangle = authalic.disk_map(*given, boundary="rectangle", corners=first, repair=True)
    assert np.allclose(rectangle.uv[rectangle.repaired.vertex_to[first]][:, 0], [0, 1, 1, 0], atol=1e-9)
    assert corners == [0, 1, 2, 3]
    with pytest.raises(ValueError, match="initial must be left out with repair=True"):
        authalic.disk_map(*given, repair=True, initial=plain.uv)


def test_a_map_is_not_of_one_piece_among_many_alike():
    """Points that are only nearly equal leave a file in pieces, of which no one is the surface."""
    noise = np.random.default_rng(2).normal(scale=1e-7, size=(3 * 512, 3))
    apart = soup(meshes.ball(3))
    near = meshes.Mesh(apart.vertices + noise, apart.faces)
    for call in (authalic.sphere_map, authalic.disk_map):
        with pytest.raises(
            authalic.MeshError, match=r"512 separate pieces.*merge points within a distance"
        ) as caught:
            call(*near, repair=True)
        assert (caught.value.kind, caught.value.count) == ("several_components", 512)
        assert caught.value.indices[:3] == (0, 1, 2)
    assert len(authalic.repair(*near, keep="largest").faces) == 1
    assert authalic.repair(*near, merge=1e-5).surface.is_closed


def test_values_go_to_the_repaired_surface():
    mesh = meshes.bumpy_ball(3)
    vertices = mesh.vertices.copy()
    vertices[40] = np.nan
    repaired = authalic.repair(vertices, mesh.faces)
    height = repaired.carry(vertices)
    kept = repaired.vertex_of >= 0
    assert np.array_equal(height[kept], repaired.vertices[kept])
    added = np.flatnonzero(~kept)
    for vertex in added:
        around = np.unique(repaired.faces[(repaired.faces == vertex).any(axis=1)])
        mean = repaired.vertices[around[around != vertex]].mean(axis=0)
        assert np.allclose(height[vertex], mean, rtol=1e-12)
    labels = np.array([f"v{k}" for k in range(len(vertices))])
    carried = repaired.carry(labels, nearest=True)
    assert np.array_equal(carried[kept], labels[repaired.vertex_of[kept]])
    assert set(carried[~kept]) <= set(carried[kept])
    # per face, and back again
    numbers = np.arange(len(mesh.faces))
    of_faces = repaired.carry(numbers)
    assert np.array_equal(of_faces[repaired.face_of >= 0], repaired.face_of[repaired.face_of >= 0])
    assert np.isfinite(of_faces).all()
    stays = repaired.face_to >= 0
    assert np.array_equal(of_faces[repaired.face_to[stays]], numbers[stays])
    with pytest.raises(
        authalic.MeshError, match=r"values must be of shape \(258, …\) per vertex or \(512, …\)"
    ):
        repaired.carry(np.zeros(7))
    with pytest.raises(authalic.MeshError, match="nearest=True takes labels"):
        repaired.carry(labels)


def test_values_fill_large_holes_from_the_rim_inward():
    plate = meshes.plate_with_holes()
    repaired = authalic.repair(*plate, close_holes=True, keep_outline=True)
    assert (repaired.vertex_of == -1).sum() > 10
    carried = repaired.carry(plate.vertices[:, 0])
    assert np.isfinite(carried).all()
    assert carried.min() >= plate.vertices[:, 0].min() and carried.max() <= plate.vertices[:, 0].max()
    assert np.isfinite(repaired.carry(np.arange(float(len(plate.faces))), per="face")).all()


def test_errors_after_a_repair_number_what_was_given():
    """A loose vertex and a face without area come first, so that all other numbers move."""
    hole = meshes.annulus()
    vertices = np.vstack([[[9.0, 9, 9]], hole.vertices])
    faces = np.vstack([[[1, 1, 2]], hole.faces + 1])
    with pytest.raises(authalic.MeshError) as caught:
        authalic.disk_map(vertices, faces, repair=True)
    with pytest.raises(authalic.MeshError) as expected:
        authalic.disk_map(*hole)
    assert caught.value.kind == expected.value.kind == "several_boundaries"
    assert caught.value.indices == tuple(vertex + 1 for vertex in expected.value.indices)
    assert all(str(vertex) in str(caught.value) for vertex in caught.value.indices)


def test_a_vertex_of_two_parts_is_that_of_the_part_that_stays():
    """The part that is dropped comes first, and with it the first copy of the vertex."""
    ball = meshes.ball(2)
    small = meshes.tetrahedron()
    tip = ball.vertices[5] - 0.1 * small.vertices[0]
    faces = small.faces + len(ball.vertices)
    faces[faces == len(ball.vertices)] = 5
    both = meshes.Mesh(np.vstack([ball.vertices, 0.1 * small.vertices + tip]), np.vstack([faces, ball.faces]))
    repaired = authalic.repair(*both, keep="largest")
    assert repaired.counts["split_vertices"] == 1
    assert np.array_equal(repaired.vertices[repaired.vertex_to[: len(ball.vertices)]], ball.vertices)
    assert (repaired.vertex_to[len(ball.vertices) :] == -1).all()
    assert_maps_back(both, repaired)


def test_many_disks_are_repaired_each():
    plain = meshes.grid(7, 9)
    bad = meshes.Mesh(np.zeros((3, 3)), [[0, 1, 2]])
    density = np.linspace(1, 2, len(plain.faces))
    maps = authalic.disk_maps(
        [soup(plain), bad, plain], densities=[density, None, density], repair=True, boundary="free"
    )
    alone = authalic.disk_map(*soup(plain), density=density, repair=True, boundary="free")
    assert np.array_equal(maps[0].uv, alone.uv)
    assert maps[0].repaired == alone.repaired
    assert maps[0].repaired.counts["merged_points"] > 0
    assert isinstance(maps[1], authalic.MeshError) and maps[1].kind == "no_faces"
    assert not maps[2].repaired.is_changed
    assert np.array_equal(maps[0].uv[maps[0].repaired.vertex_to[soup(plain).faces]], maps[2].uv[plain.faces])
    assert maps[2].provenance["options"]["repair"] is True


def test_a_map_without_repair_carries_none():
    assert authalic.disk_map(*meshes.fan()).repaired is None
    assert authalic.sphere_map(*meshes.octahedron()).repaired is None


def test_repaired_surfaces_are_taken_wherever_surfaces_are():
    repaired = authalic.repair(*soup(meshes.ball(2)))
    mapped = authalic.sphere_map(repaired)
    assert len(authalic.distortion(repaired, mapped.positions).folded) == 0
    assert len(authalic.cut(repaired)) == 1
    merged = "merged 318 points with others at the same place"
    assert repr(repaired) == f"Repaired(66 vertices, 128 faces: {merged})"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"merge": -1.0}, "merge must be a length ≥ 0"),
        ({"merge": np.nan}, "merge must be a length ≥ 0"),
        ({"merge": "near"}, "merge must be a length ≥ 0, a bool or None, but is 'near'"),
        ({"close_holes": "some"}, 'close_holes must be a bool, an integer ≥ 0 or "pinholes", but is some'),
        ({"close_holes": -3}, "close_holes must be"),
        ({"close_handles": -0.5}, "close_handles must be a length ≥ 0"),
        ({"close_handles": "big"}, "close_handles must be a bool"),
        ({"keep": "most"}, 'keep must be "all" or "largest", but is "most"'),
    ],
)
def test_options_out_of_range_are_refused(options, words):
    with pytest.raises(ValueError, match=words):
        authalic.repair(*meshes.octahedron(), **options)


def test_truth_values_are_no_lengths():
    """True is 1 to Python, which would be a distance."""
    mesh = meshes.rough_ball(3)
    given = soup(mesh)
    for merge, merged in ((True, True), (np.True_, True), (False, False), (None, False), (0, True)):
        assert (authalic.repair(*given, merge=merge).counts["merged_points"] > 0) == merged
    torus = meshes.torus()
    for close in (True, np.True_):
        assert authalic.repair(*torus, close_handles=close).surface.genus == 0
    for close in (False, np.False_):
        assert authalic.repair(*torus, close_handles=close).surface.genus == 1
    assert authalic.repair(*opened(mesh), close_holes=np.False_).counts["closed_holes"] == 0
    assert authalic.repair(*opened(mesh), close_holes=np.True_).counts["closed_holes"] == 1


def opened(mesh):
    return meshes.Mesh(mesh.vertices, mesh.faces[1:])


def test_what_no_repair_mends_is_refused():
    with pytest.raises(authalic.MeshError, match="faces must be indices of the 4 vertices"):
        authalic.repair(meshes.tetrahedron().vertices, [[0, 1, 4]])
    with pytest.raises(
        authalic.MeshError, match="no faces that a repair can keep: each is without area"
    ) as caught:
        authalic.repair([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    assert caught.value.kind == "no_faces"
    with pytest.raises(authalic.MeshError, match="NaN or infinite; check the vertices"):
        authalic.repair(meshes.tetrahedron().vertices * np.nan, meshes.tetrahedron().faces)
    with pytest.raises(authalic.MeshError, match="no faces"):
        authalic.repair(np.full((3, 3), np.nan), [[0, 1, 2]])
