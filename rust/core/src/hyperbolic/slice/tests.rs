// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slicing of spheres with all kinds of slits and holes.

use crate::vector::Vector3;
use std::f64::consts::PI;

use super::polyline::Polyline;
use super::*;
use crate::control::Silent;
use crate::hyperbolic::features::piece::Bank;
use crate::mesh::geometry::{area, triangle};
use crate::mesh::{Corner, EdgeTable, Face, Vertex, VertexCorners, faces_of_indices};

/// The icosahedron, each face divided into 4^level.
fn icosphere(level: usize) -> (Vec<Vector3>, Vec<[Vertex; 3]>) {
    let g = f64::midpoint(1.0, 5f64.sqrt());
    let signs = [[-1.0, g], [1.0, g], [-1.0, -g], [1.0, -g]];
    let turned =
        [|[a, b]: [f64; 2]| [a, b, 0.0], |[a, b]: [f64; 2]| [0.0, a, b], |[a, b]: [f64; 2]| [b, 0.0, a]];
    let mut points: Vec<Vector3> =
        turned.iter().flat_map(|turn| signs.map(turn)).map(Vector3).map(unit).collect();
    let mut faces = faces_of_indices(&[
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ]);
    for _ in 0..level {
        faces = divided(&mut points, &faces);
    }
    (points, faces)
}

fn unit(x: Vector3) -> Vector3 {
    x.normalized()
}

/// Each face divided into four.
fn divided(points: &mut Vec<Vector3>, faces: &[[Vertex; 3]]) -> Vec<[Vertex; 3]> {
    let table = EdgeTable::new(points.len(), faces);
    let mut middles = vec![Vertex::default(); 3 * faces.len()];
    for ([a, b], _) in table.edges() {
        table.corners([a, b]).for_each(|corner| middles[corner] = Vertex::new(points.len()));
        points.push(unit(points[a] + points[b]));
    }
    let four = |(face, &[a, b, c]): (usize, &[Vertex; 3])| {
        let [x, y, z] = [0, 1, 2].map(|k| middles[3 * face + k]);
        [[a, z, y], [b, x, z], [c, y, x], [x, y, z]]
    };
    faces.iter().enumerate().flat_map(four).collect()
}

/// A sphere without features.
fn sphere(level: usize) -> Piece {
    let (points, faces) = icosphere(level);
    piece(points, faces)
}

fn piece(points: Vec<Vector3>, faces: Vec<[Vertex; 3]>) -> Piece {
    Piece {
        on_sphere: points.clone(),
        vertex_of: Vertex::all(points.len()).collect(),
        face_of: Face::all(faces.len()).collect(),
        points,
        faces,
        features: Vec::new(),
    }
}

fn with_slits(mut piece: Piece, paths: &[Vec<Vertex>]) -> Piece {
    for path in paths {
        let curve = Some(piece.features.len());
        piece.features.push(Feature { curve, ..slit(&piece.points, path) });
    }
    piece
}

fn slit(points: &[Vector3], path: &[Vertex]) -> Feature {
    let bank = bank(points, path.to_vec());
    Feature { left: bank.clone(), right: bank, is_loop: false, curve: None }
}

fn bank(points: &[Vector3], vertices: Vec<Vertex>) -> Bank {
    let mut parameters = vec![0.0];
    for ends in vertices.windows(2) {
        let [a, b] = [points[ends[0]], points[ends[1]]];
        parameters.push(parameters[parameters.len() - 1] + a.distance(b));
    }
    let whole = parameters[parameters.len() - 1];
    Bank { vertices, parameters: parameters.into_iter().map(|length| length / whole).collect() }
}

/// Removes the faces around some vertices; the boundary loops become features.
fn with_holes(whole: &Piece, centers: &[Vertex]) -> Piece {
    let kept = |face: &&[Vertex; 3]| face.iter().all(|vertex| !centers.contains(vertex));
    let faces: Vec<[Vertex; 3]> = whole.faces.iter().filter(kept).copied().collect();
    let new_number = |vertex: Vertex| {
        Vertex::new(vertex.index() - centers.iter().filter(|&&center| center < vertex).count())
    };
    let mut rest = piece(
        whole
            .points
            .iter()
            .zip(Vertex::all(whole.points.len()))
            .filter(|(_, vertex)| !centers.contains(vertex))
            .map(|(&x, _)| x)
            .collect(),
        faces.into_iter().map(|face| face.map(new_number)).collect(),
    );
    let surface = Cutting::new(whole);
    for &center in centers {
        // seen from outside, the rim of the hole has the surface on its right
        let mut rim: Vec<Vertex> = surface.neighbors(center).map(new_number).collect();
        if rest.faces.iter().all(|face| !is_half_edge(face, rim[0], rim[1])) {
            rim.reverse();
        }
        let middle = rim.len() / 2;
        let mut rest_of_rim = rim[middle..].to_vec();
        rest_of_rim.push(rim[0]);
        rest_of_rim.reverse();
        let [left, right] =
            [rim[..=middle].to_vec(), rest_of_rim].map(|vertices| bank(&rest.points, vertices));
        rest.features.push(Feature { left, right, is_loop: true, curve: None });
    }
    rest
}

fn is_half_edge(face: &[Vertex; 3], a: Vertex, b: Vertex) -> bool {
    (0..3).any(|k| [face[k], face[(k + 1) % 3]] == [a, b])
}

/// The path straight on from the edge (a, b), from b, through vertices with six neighbors.
fn straight(surface: &Cutting, a: Vertex, b: Vertex, n_edges: usize) -> Vec<Vertex> {
    let mut path = vec![a, b];
    for _ in 0..n_edges {
        let [before, last] = [path[path.len() - 2], path[path.len() - 1]];
        let around: Vec<Vertex> = surface.neighbors(last).collect();
        let from = around.iter().position(|&v| v == before).unwrap();
        path.push(around[(from + around.len() / 2) % around.len()]);
    }
    path[1..].to_vec()
}

/// Slits of `n_edges` at scattered places, disjoint.
fn scattered(piece: &Piece, n_slits: usize, n_edges: usize, mut seed: u64) -> Vec<Vec<Vertex>> {
    let surface = Cutting::new(piece);
    let mut random = move |n: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % n
    };
    let mut paths: Vec<Vec<Vertex>> = Vec::new();
    while paths.len() < n_slits {
        let a = Vertex::new(random(piece.points.len()));
        let around: Vec<Vertex> = surface.neighbors(a).collect();
        let path = straight(&surface, a, around[random(around.len())], n_edges);
        if path.iter().all(|vertex| paths.iter().all(|other| !other.contains(vertex))) {
            paths.push(path);
        }
    }
    paths
}

/// A vertex that has six neighbors, as have those near it, at the middle of the first face of the
/// icosahedron.
fn middle_vertex(piece: &Piece) -> Vertex {
    let [a, b, c] = triangle(&piece.points, [0, 11, 5].map(Vertex));
    nearest(piece, unit(a + (b + c)))
}

fn nearest(piece: &Piece, x: Vector3) -> Vertex {
    let gap = |&vertex: &Vertex| piece.points[vertex].distance(x);
    Vertex::all(piece.points.len()).min_by(|a, b| gap(a).total_cmp(&gap(b))).unwrap()
}

fn identity(line: &[Vector3]) -> Option<Vec<Vector3>> {
    Some(line.to_vec())
}

fn slice(source: &Piece, target: &Piece) -> SlicedPair {
    let mut silent = Silent;
    slice_pair(source, target, &identity, &Watch::new(&mut silent, 0.0, "")).unwrap()
}

/// Slices a piece against an ellipsoid with the same features and checks both.
fn check(source: &Piece) -> SlicedPair {
    let mut target = source.clone();
    target.points.iter_mut().for_each(|x| (x[1], x[2]) = (1.5 * x[1], 0.7 * x[2]));
    let pair = slice(source, &target);
    let chain = chain::order(source, &target);
    check_sliced(source, &chain, &pair.source);
    check_sliced(&target, &chain, &pair.target);
    let outline = |sliced: &Sliced| -> Vec<_> { sliced.sides.iter().map(|s| (s.is_arc, s.index)).collect() };
    assert_eq!(outline(&pair.source), outline(&pair.target));
    pair
}

fn check_sliced(piece: &Piece, chain: &[(usize, bool)], sliced: &Sliced) {
    check_places(piece, sliced);
    let n_features = piece.features.len() as i64;
    check_opened(sliced, &sliced.surface, 2 - n_features, n_features);
    check_opened(sliced, &sliced.disk, 1, 1);
    check_no_chords(&sliced.disk);
    check_sides(piece, chain, sliced);
}

/// Checks that every corner lies at its place, and that the parts of a face have its area.
fn check_places(piece: &Piece, sliced: &Sliced) {
    let mut left: Vec<f64> = piece.faces.iter().map(|&face| area(triangle(&piece.points, face))).collect();
    for (&face, place) in sliced.faces.iter().zip(&sliced.places) {
        let whole = triangle(&piece.points, piece.faces[place.face]);
        for (corner, weights) in face.iter().zip(place.corners) {
            assert_eq!(weights.iter().sum::<f64>(), 1.0);
            let place = whole.iter().zip(weights).map(|(&x, weight)| x * weight).sum::<Vector3>();
            assert!(place.distance(sliced.points[*corner]) < 1e-15);
        }
        left[place.face] -= area(triangle(&sliced.points, face));
    }
    assert!(left.iter().all(|area| area.abs() < 1e-15));
}

/// Adjacency, manifold fans, Euler number, number of boundary loops.
fn check_opened(sliced: &Sliced, opened: &Opened, euler: i64, n_loops: i64) {
    let before = |face: &[Vertex; 3]| face.map(|vertex| opened.vertex_of[vertex]);
    assert!(sliced.faces.iter().eq(opened.faces.iter().map(before).collect::<Vec<_>>().iter()));
    let n_vertices = opened.vertex_of.len();
    assert_eq!(EdgeTable::new(n_vertices, &opened.faces).opposites(), opened.opposite);
    let corners = VertexCorners::new(n_vertices, &opened.faces);
    assert!((0..n_vertices).all(|vertex| corners.is_one_fan(Vertex::new(vertex), &opened.opposite)));
    let boundary = boundary_corners(opened);
    let n_edges = (opened.opposite.len() + boundary.len()) / 2;
    assert_eq!(n_vertices as i64 - n_edges as i64 + opened.faces.len() as i64, euler);
    assert_eq!(count_loops(opened, boundary), n_loops);
}

fn boundary_corners(opened: &Opened) -> Vec<Corner> {
    Corner::all(opened.faces.len()).filter(|&corner| opened.opposite[corner].is_none()).collect()
}

fn count_loops(opened: &Opened, mut boundary: Vec<Corner>) -> i64 {
    let mut count = 0;
    while let Some(&first) = boundary.first() {
        let vertices = opened.boundary_from(first);
        boundary.retain(|&corner| !vertices.contains(&corner.next().vertex(&opened.faces)));
        count += 1;
    }
    count
}

fn check_no_chords(disk: &Opened) {
    let mut on_boundary = vec![false; disk.vertex_of.len()];
    let boundary = boundary_corners(disk);
    boundary.iter().for_each(|&corner| on_boundary[corner.half_edge(&disk.faces)[0]] = true);
    for corner in Corner::all(disk.faces.len()).filter(|&corner| disk.opposite[corner].is_some()) {
        assert!(corner.half_edge(&disk.faces).iter().any(|&end| !on_boundary[end]));
    }
}

/// The sides follow each other, are those of the features and arcs, and go once around the disk.
fn check_sides(piece: &Piece, chain: &[(usize, bool)], sliced: &Sliced) {
    let sides = &sliced.sides;
    let n_features = chain.len();
    assert_eq!(sides.len(), 2 * (2 * n_features - 1));
    let features = chain::features(piece, chain);
    let vertex_of = &sliced.disk.vertex_of;
    let before = |side: &Side| -> Vec<Vertex> { side.vertices.iter().map(|&v| vertex_of[v]).collect() };
    for (place, side) in sides.iter().enumerate() {
        let following = &sides[(place + 1) % sides.len()];
        assert_eq!(side.vertices.last(), following.vertices.first());
        let is_out = place < sides.len() / 2;
        let mirrored = if is_out { place } else { sides.len() - 1 - place };
        assert_eq!((side.is_arc, side.index), (mirrored % 2 == 1, mirrored / 2));
        let (mut vertices, mut parameters) = (before(side), side.parameters.clone());
        if !is_out {
            vertices.reverse();
            parameters.reverse();
        }
        assert_eq!((parameters[0], parameters[parameters.len() - 1]), (0.0, 1.0));
        assert!(parameters.windows(2).all(|pair| pair[0] < pair[1]));
        if side.is_arc {
            assert_eq!(before(&sides[mirrored]), vertices);
            assert_eq!(sides[mirrored].parameters, parameters);
            assert_eq!(
                [vertices[0], *vertices.last().unwrap()],
                [features[side.index].end(), features[side.index + 1].start()]
            );
        } else {
            let feature = &features[side.index];
            assert_eq!(
                Bank { vertices, parameters },
                if is_out { feature.left.clone() } else { feature.right.clone() }
            );
        }
    }
    let around: Vec<Vertex> = sides.iter().flat_map(|side| side.vertices[1..].iter().copied()).collect();
    let mut different = around.clone();
    different.sort_unstable();
    different.dedup();
    assert_eq!(different.len(), around.len());
    assert_eq!(around.len(), boundary_corners(&sliced.disk).len());
}

#[test]
fn scattered_slits() {
    for n_slits in [1, 2, 3, 6, 12, 26] {
        for seed in 0..4 {
            let sphere = sphere(3);
            let paths = scattered(&sphere, n_slits, 5, seed);
            assert!(check(&with_slits(sphere, &paths)).followed);
        }
    }
}

#[test]
fn slits_of_two_edges() {
    for seed in 0..5 {
        let sphere = sphere(2);
        let paths = scattered(&sphere, 15, 2, seed);
        check(&with_slits(sphere, &paths));
    }
}

#[test]
fn holes_and_slits() {
    for n_slits in [0, 1, 4] {
        let whole = sphere(3);
        let centers =
            [nearest(&whole, Vector3([0.0, 0.0, 1.0])), nearest(&whole, Vector3([0.0, 1.0, 0.0])), Vertex(0)];
        let open = with_holes(&whole, &centers);
        let rims: Vec<Vertex> = open.features.iter().flat_map(outline).collect();
        let is_free = |path: &Vec<Vertex>| path.iter().all(|vertex| !rims.contains(vertex));
        let is_inner =
            |path: &Vec<Vertex>| path.iter().all(|&v| v.index() + 10 < open.points.len()) && is_free(path);
        let paths = scattered_where(&open, n_slits, is_inner);
        let pair = check(&with_slits(open, &paths));
        assert_eq!(pair.source.sides.len(), 2 * (2 * (3 + n_slits) - 1));
    }
    check(&with_holes(&sphere(1), &[Vertex(3)]));
    check(&with_holes(&sphere(1), &[3, 0].map(Vertex)));
}

/// Slits of three edges, each at the first place of its own part of the sphere at which `is_allowed`.
fn scattered_where(
    piece: &Piece,
    n_slits: usize,
    is_allowed: impl Fn(&Vec<Vertex>) -> bool,
) -> Vec<Vec<Vertex>> {
    let surface = Cutting::new(piece);
    let slit_near = |x: Vector3| {
        let start = nearest(piece, x);
        surface.neighbors(start).map(|next| straight(&surface, start, next, 3)).find(&is_allowed).unwrap()
    };
    let places = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    places[..n_slits].iter().map(|&x| slit_near(unit(Vector3(x)))).collect()
}

#[test]
fn slits_one_edge_apart() {
    let sphere = sphere(4);
    let surface = Cutting::new(&sphere);
    let a = middle_vertex(&sphere);
    let around: Vec<Vertex> = surface.neighbors(a).collect();
    let [b, c] = [around[0], around[1]];
    let first = straight(&surface, a, b, 4);
    // beside the first, on the line through c that is parallel
    let next: Vec<Vertex> = surface.neighbors(c).collect();
    let beside = next.iter().position(|&v| v == b).unwrap();
    let second = straight(&surface, c, next[(beside + next.len() - 1) % next.len()], 4);
    let second = if second.iter().any(|v| first.contains(v)) {
        straight(&surface, c, next[(beside + 1) % next.len()], 4)
    } else {
        second
    };
    let adjacent = first.iter().any(|&v| surface.neighbors(v).any(|w| second.contains(&w)));
    assert!(adjacent);
    check(&with_slits(sphere, &[first, second]));
}

#[test]
fn tips_one_edge_apart() {
    let sphere = sphere(4);
    let surface = Cutting::new(&sphere);
    let a = middle_vertex(&sphere);
    let b = surface.neighbors(a).next().unwrap();
    let line = straight(&surface, a, b, 9);
    check(&with_slits(sphere, &[line[..3].to_vec(), line[3..6].to_vec(), line[6..].to_vec()]));
}

#[test]
fn three_slits_that_meet_in_one_triangle() {
    let sphere = sphere(4);
    let surface = Cutting::new(&sphere);
    let a = middle_vertex(&sphere);
    let [a, b, c] = sphere.faces[surface.corners(a).next().unwrap().index() / 3];
    let paths = [[b, a], [c, b], [a, c]].map(|[from, to]| straight(&surface, from, to, 3));
    check(&with_slits(sphere, &paths));
}

#[test]
fn a_spiral_around_another_slit() {
    let sphere = sphere(4);
    let point = |t: f64| {
        let (colatitude, longitude) = (0.35 + 1.2 * t, 5.0 * PI * t);
        Vector3([colatitude.sin() * longitude.cos(), colatitude.sin() * longitude.sin(), colatitude.cos()])
    };
    let mut spiral: Vec<Vertex> =
        (0..=2000).map(|i| nearest(&sphere, point(f64::from(i) / 2000.0))).collect();
    spiral.dedup();
    let surface = Cutting::new(&sphere);
    assert!(spiral.windows(2).all(|ends| surface.neighbors(ends[0]).any(|v| v == ends[1])));
    let pole = nearest(&sphere, Vector3([0.0, 0.0, 1.0]));
    let inner = straight(&surface, surface.neighbors(pole).next().unwrap(), pole, 2);
    let south = nearest(&sphere, Vector3([0.0, 0.0, -1.0]));
    let outer = straight(&surface, surface.neighbors(south).next().unwrap(), south, 4);
    assert!(check(&with_slits(sphere, &[spiral, inner, outer])).followed);
}

#[test]
fn source_and_target_of_different_resolution() {
    let source = sphere(3);
    let paths = scattered(&source, 6, 4, 3);
    let (mut points, mut faces) = (source.points.clone(), source.faces.clone());
    faces = divided(&mut points, &faces);
    let target = piece(points, faces);
    let surface = Cutting::new(&target);
    let middle =
        |a: Vertex, b: Vertex| surface.neighbors(a).find(|&v| surface.neighbors(b).any(|w| w == v)).unwrap();
    let finer = |path: &Vec<Vertex>| {
        let halves = path.windows(2).flat_map(|ends| [ends[0], middle(ends[0], ends[1])]);
        halves.chain(path.last().copied()).collect::<Vec<Vertex>>()
    };
    let finer: Vec<Vec<Vertex>> = paths.iter().map(finer).collect();
    let [source, target] = [with_slits(source, &paths), with_slits(target, &finer)];
    let pair = slice(&source, &target);
    let chain = chain::order(&source, &target);
    check_sliced(&source, &chain, &pair.source);
    check_sliced(&target, &chain, &pair.target);
    assert!(pair.followed);
    // the arcs of the target stay near those of the source
    for (ours, theirs) in pair.source.sides.iter().zip(&pair.target.sides).filter(|(side, _)| side.is_arc) {
        let line = |side: &Side, sliced: &Sliced| -> Vec<Vector3> {
            side.vertices.iter().map(|&v| sliced.points[sliced.disk.vertex_of[v]]).collect()
        };
        let along = Polyline::new(line(ours, &pair.source));
        assert!(line(theirs, &pair.target).into_iter().all(|x| along.distance(x) < 0.1));
    }
}

#[test]
fn arcs_on_the_target_wind_as_they_are_carried() {
    let sphere = sphere(4);
    let surface = Cutting::new(&sphere);
    let near = |x: Vector3| {
        straight(
            &surface,
            nearest(&sphere, unit(x)),
            surface.neighbors(nearest(&sphere, unit(x))).next().unwrap(),
            3,
        )
    };
    let paths =
        [near(Vector3([1.0, 0.0, 0.3])), near(Vector3([0.0, 1.0, 0.3])), near(Vector3([-1.0, 0.0, 0.3]))];
    let piece = with_slits(sphere.clone(), &paths);
    // the long way around each time: through the south pole
    let detour = |line: &[Vector3]| {
        let [from, to] = [line[0], line[line.len() - 1]];
        let ends = [
            from,
            Vector3([from[0], from[1], -0.3]),
            Vector3([0.0, 0.0, -1.0]),
            Vector3([to[0], to[1], -0.3]),
            to,
        ]
        .map(unit);
        Some(super::polyline::resampled(&ends, 0.01))
    };
    let mut silent = Silent;
    let watch = Watch::new(&mut silent, 0.0, "");
    let pair = slice_pair(&piece, &piece, &detour, &watch).unwrap();
    let chain = chain::order(&piece, &piece);
    check_sliced(&piece, &chain, &pair.source);
    check_sliced(&piece, &chain, &pair.target);
    assert!(pair.followed);
    let lowest = |sliced: &Sliced| {
        let arc = &sliced.sides[1].vertices;
        arc.iter().map(|&v| sliced.points[sliced.disk.vertex_of[v]][2]).fold(1.0, f64::min)
    };
    assert!(lowest(&pair.source) > -0.3 && lowest(&pair.target) < -0.95);
}

#[test]
fn arcs_that_cannot_be_carried_are_laid_all_the_same() {
    let sphere = sphere(3);
    let paths = scattered(&sphere, 5, 4, 1);
    let piece = with_slits(sphere, &paths);
    let mut silent = Silent;
    let watch = Watch::new(&mut silent, 0.0, "");
    let pair = slice_pair(&piece, &piece, &|_| None, &watch).unwrap();
    check_sliced(&piece, &chain::order(&piece, &piece), &pair.target);
    assert!(!pair.followed);
}

#[test]
fn the_same_input_gives_the_same_cuts() {
    let sphere = sphere(3);
    let paths = scattered(&sphere, 8, 4, 2);
    let piece = with_slits(sphere, &paths);
    let [first, second] = [check(&piece), check(&piece)];
    assert_eq!(first.source.sides, second.source.sides);
    assert_eq!(first.target.faces, second.target.faces);
}

#[test]
fn features_that_touch_or_are_no_paths_are_refused() {
    let sphere = sphere(3);
    let surface = Cutting::new(&sphere);
    let a = middle_vertex(&sphere);
    let around: Vec<Vertex> = surface.neighbors(a).collect();
    let first = straight(&surface, around[0], a, 3);
    let touching = straight(&surface, around[2], around[1], 2);
    let crossing = vec![around[0], a, around[3]];
    let jump = vec![around[1], nearest(&sphere, sphere.points[a] * -1.0)];
    for (second, is_fine) in [(touching, true), (crossing, false), (jump, false)] {
        let piece = with_slits(sphere.clone(), &[first.clone(), second]);
        let mut silent = Silent;
        let watch = Watch::new(&mut silent, 0.0, "");
        let result = slice_pair(&piece, &piece, &identity, &watch);
        if is_fine {
            assert!(result.is_ok())
        } else {
            let error = Error::from(CurveError::Uncuttable { curve: Some(1) });
            assert_eq!(result.unwrap_err(), error.of_surface(crate::Side::Source))
        }
    }
}

#[test]
fn slits_that_touch_themselves_are_refused() {
    let sphere = sphere(3);
    let surface = Cutting::new(&sphere);
    let a = middle_vertex(&sphere);
    let around: Vec<Vertex> = surface.neighbors(a).collect();
    let far = nearest(&sphere, sphere.points[a] * -1.0);
    let other = straight(&surface, surface.neighbors(far).next().unwrap(), far, 3);
    let noose = vec![around[3], a, around[0], around[1], a];
    let there_and_back = vec![around[0], a, around[3], a, around[0]];
    for touching in [noose, there_and_back] {
        let piece = with_slits(sphere.clone(), &[touching, other.clone()]);
        let mut silent = Silent;
        let watch = Watch::new(&mut silent, 0.0, "");
        assert!(slice_pair(&piece, &piece, &identity, &watch).is_err());
    }
}

#[test]
fn a_cancelled_run_ends() {
    let sphere = sphere(3);
    let paths = scattered(&sphere, 3, 4, 1);
    let piece = with_slits(sphere, &paths);
    let mut no = |_: f64, _: &str| false;
    let watch = Watch::new(&mut no, 0.0, "");
    std::thread::sleep(std::time::Duration::from_millis(100));
    assert_eq!(slice_pair(&piece, &piece, &identity, &watch).unwrap_err(), Error::CancelledEarly);
}

#[test]
#[ignore = "a measurement"]
fn time_of_ten_slits_on_a_large_sphere() {
    let sphere = sphere(7);
    let paths = scattered(&sphere, 10, 60, 5);
    let piece = with_slits(sphere, &paths);
    let began = std::time::Instant::now();
    let pair = slice(&piece, &piece);
    println!("{} vertices: {:?}", piece.points.len(), began.elapsed());
    assert!(pair.source.points[0].dot(pair.source.points[0]) > 0.0);
}
