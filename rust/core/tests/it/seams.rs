// SPDX-License-Identifier: MIT OR Apache-2.0
//! Automatic seams and unwraps by their promises: disks, no folds, no overlap, wishes that are kept, determinism, cancel.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use authalic::testing::rows;
use authalic::{
    Error, ErrorKind, SeamMethod, SeamOptions, Seams, Silent, Status, Surface, Unwrap, UnwrapOptions,
    UnwrapSeams,
};
use ndarray::{Array1, Array2, array, aview2};

use super::common::closed::{capsule, cube, flat_tube, octahedron, plate_with_holes, radial, tetrahedron};
use super::common::planar::{crossing, shared_area, side, signed_area};
use super::common::random::Random;
use super::common::{
    self, TestMesh, annulus, cap, ellipsoid, grid, holed_grid, icosphere, torus, two_pieces,
};

type Edges = BTreeSet<[u32; 2]>;

fn surface(test: &TestMesh) -> Surface {
    Surface::new(aview2(&test.vertices), aview2(&test.faces)).expect("arrays of a surface")
}

fn found(test: &TestMesh, options: &SeamOptions<'_>) -> Seams {
    authalic::seams(&surface(test), options, &mut Silent)
        .unwrap_or_else(|error| panic!("{}: {error}", test.name))
}

fn unwrapped(test: &TestMesh, options: SeamOptions<'_>) -> Unwrap {
    let options = UnwrapOptions { seams: UnwrapSeams::Automatic(options), ..Default::default() };
    authalic::unwrap(&surface(test), &options, &mut Silent)
        .unwrap_or_else(|error| panic!("{}: {error}", test.name))
}

fn for_target(target: f64) -> SeamOptions<'static> {
    SeamOptions { target, ..Default::default() }
}

fn edges_of(edges: &Array2<u32>) -> Edges {
    rows::<2, u32>(edges.view()).iter().copied().collect()
}

/// All edges of a mesh, ascending.
fn all_edges(test: &TestMesh) -> Edges {
    let half_edges = test.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    half_edges.map(|[a, b]| [a.min(b), a.max(b)]).collect()
}

/// A mesh moved and scaled along the axes.
fn placed(name: &'static str, mesh: TestMesh, place: impl Fn([f64; 3]) -> [f64; 3]) -> TestMesh {
    TestMesh { name, vertices: mesh.vertices.iter().map(|&x| place(x)).collect(), ..mesh }
}

/// A round body without any symmetry.
fn bumpy(level: u32) -> TestMesh {
    radial("bumpy sphere", level, |[x, y, z]| {
        1.0 + 0.35 * (3.0 * x + 1.0).sin() * (2.0 * y + 0.4).cos()
            + 0.25 * z
            + 0.1 * (5.0 * z * x + 0.3 * y).sin()
    })
}

/// A sphere whose octants mirror each other: every face of an octahedron has `n`² parts.
fn octants(n: i32) -> TestMesh {
    let mut numbers = std::collections::BTreeMap::new();
    let mut vertices = Vec::new();
    let mut number = |place: [i32; 3]| {
        *numbers.entry(place).or_insert_with(|| {
            let radius = place.map(|k| f64::from(k * k)).iter().sum::<f64>().sqrt();
            vertices.push(place.map(|k| f64::from(k) / radius));
            vertices.len() as u32 - 1
        })
    };
    let mut faces = Vec::new();
    for signs in (0..8).map(|k| [0, 1, 2].map(|bit| 1 - 2 * (k >> bit & 1))) {
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j))) {
            let mut at = |i: i32, j: i32| number([signs[0] * i, signs[1] * j, signs[2] * (n - i - j)]);
            let [a, b, c] = [at(i, j), at(i + 1, j), at(i, j + 1)];
            let mut parts = vec![[a, b, c]];
            if i + j + 1 < n {
                parts.push([b, at(i + 1, j + 1), c]);
            }
            let is_turned = signs.iter().product::<i32>() < 0;
            faces.extend(parts.into_iter().map(|[a, b, c]| if is_turned { [a, c, b] } else { [a, b, c] }));
        }
    }
    TestMesh { name: "octants", vertices, faces, ..icosphere(0) }
}

fn plank(cells: u32) -> TestMesh {
    let size = f64::from(cells);
    placed("plank", cube(cells), |[x, y, z]| [10.0 * x / size, y / size, 0.1 * z / size])
}

fn cylinder() -> TestMesh {
    placed("cylinder", annulus(24, 10), |[x, y, _]| {
        let radius = x.hypot(y);
        [x / radius, y / radius, 3.0 * radius]
    })
}

/// Surfaces of every topology, and the roughest meshes.
fn surfaces() -> Vec<TestMesh> {
    vec![
        bumpy(4),
        torus(24, 12),
        plate_with_holes(3),
        holed_grid(),
        two_pieces(),
        tetrahedron(),
        cube(1),
        cube(7),
        octahedron(),
        flat_tube(2.0, 6),
        plank(1),
        plank(4),
        grid(7, 5),
        cylinder(),
        cap(10, 2.4),
        capsule(24, 12),
    ]
}

/// Every island is a disk, and all that the seams say of themselves is true.
fn assert_sound_seams(test: &TestMesh, seams: &Seams) {
    let edges = rows::<2, u32>(seams.edges.view());
    assert!(edges.is_sorted() && edges.iter().all(|[a, b]| a < b), "{}", test.name);
    let patches = surface(test).cut(&seams.edges).unwrap();
    assert_eq!(patches.len(), seams.islands, "{}", test.name);
    for (island, patch) in patches.iter().enumerate() {
        assert!(patch.is_disk(), "{}: island {island} is no disk", test.name);
        let mut faces = patch.corner_of.rows().into_iter().map(|row| row[0] as usize / 3);
        assert!(faces.all(|face| seams.island_of[face] as usize == island), "{}", test.name);
    }
    let length = |[a, b]: &[u32; 2]| common::distance(test.vertices[*a as usize], test.vertices[*b as usize]);
    let length = edges.iter().map(length).sum::<f64>() / rest_areas(test).iter().sum::<f64>().sqrt();
    assert!((seams.length - length).abs() < 1e-9, "{}: {} is not {length}", test.name, seams.length);
    assert!(seams.predicted > 1.0 - 1e-9 && seams.predicted.is_finite(), "{}", test.name);
}

fn rest_areas(test: &TestMesh) -> Vec<f64> {
    let area = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| test.vertices[v as usize]);
        let [p, q, r] = [common::distance(b, c), common::distance(c, a), common::distance(a, b)];
        0.25 * ((p + q + r) * (-p + q + r) * (p - q + r) * (p + q - r)).max(0.0).sqrt()
    };
    test.faces.iter().map(area).collect()
}

/// No folds, no island over itself, all in the unit square; the figures are those of the points.
fn assert_sound_map(test: &TestMesh, map: &Unwrap) {
    let uv = rows::<2, f64>(map.uv.view());
    let faces = rows::<3, u32>(map.faces.view());
    assert!(uv.iter().flatten().all(|x| (0.0..=1.0).contains(x)), "{}: outside of the square", test.name);
    for (face, corners) in test.faces.iter().zip(faces) {
        assert_eq!(corners.map(|point| map.vertex_of[point as usize].0), *face, "{}", test.name);
        assert!(side(corners.map(|point| uv[point as usize])) > 0, "{}: a folded face", test.name);
    }
    for island in 0..map.islands as u32 {
        let own: Vec<_> = faces
            .iter()
            .zip(&map.island_of)
            .filter(|(_, label)| **label == island)
            .map(|(face, _)| *face)
            .collect();
        let outline: Vec<_> = outline(&own).iter().map(|&point| uv[point as usize]).collect();
        // banks of a seam through a flat place touch
        if crossing(&outline).is_some() {
            let images: Vec<_> = own.iter().map(|face| face.map(|point| uv[point as usize])).collect();
            let shared = shared_area(&images);
            assert!(shared < 1e-9, "{}: island {island} overlaps itself by {shared}", test.name);
        }
    }
    let [deviation, shear] = measured(test, map);
    assert!(
        (map.area_ratio_std - deviation).abs() < 1e-6,
        "{}: {} {deviation}",
        test.name,
        map.area_ratio_std
    );
    assert!((map.shear - shear).abs() < 1e-6, "{}: {} {shear}", test.name, map.shear);
    let covered: f64 = faces.iter().map(|face| signed_area(&face.map(|point| uv[point as usize]))).sum();
    assert!((map.packed - covered).abs() < 1e-9, "{}", test.name);
}

/// The one boundary loop of an island.
fn outline(faces: &[[u32; 3]]) -> Vec<u32> {
    let half_edges: BTreeSet<[u32; 2]> =
        faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let outer = half_edges.iter().filter(|&&[a, b]| !half_edges.contains(&[b, a]));
    let next: std::collections::BTreeMap<u32, u32> = outer.map(|&[a, b]| (a, b)).collect();
    let mut outline: Vec<u32> = next.keys().take(1).copied().collect();
    while next[&outline[outline.len() - 1]] != outline[0] {
        outline.push(next[&outline[outline.len() - 1]]);
    }
    assert_eq!(outline.len(), next.len(), "several loops");
    outline
}

/// The deviation of the area ratio and the mean of σ₁/σ₂, by area: from σ₁² + σ₂² = Σ cot α l² / 2A and σ₁ σ₂ = a / A.
fn measured(test: &TestMesh, map: &Unwrap) -> [f64; 2] {
    let (uv, areas) = (rows::<2, f64>(map.uv.view()), rest_areas(test));
    let total: f64 = areas.iter().sum();
    let figures =
        rows::<3, u32>(map.faces.view()).iter().zip(&test.faces).zip(&areas).map(|((face, rest), area)| {
            let image = face.map(|point| uv[point as usize]);
            let squares: f64 = (0..3)
                .map(|k| {
                    let [a, b, c] = [0, 1, 2].map(|i| test.vertices[rest[(k + i) % 3] as usize]);
                    let [ab, bc, ca] =
                        [common::distance(a, b), common::distance(b, c), common::distance(c, a)];
                    let cotangent = (ab * ab + ca * ca - bc * bc) / (4.0 * area);
                    let [p, q] = [image[(k + 1) % 3], image[(k + 2) % 3]];
                    0.5 * cotangent * ((p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)) / area
                })
                .sum();
            let ratio = signed_area(&image) / area;
            let root = (squares * squares - 4.0 * ratio * ratio).max(0.0).sqrt();
            [ratio * total / map.packed, (squares + root) / (2.0 * ratio), area / total]
        });
    let figures: Vec<_> = figures.collect();
    let deviation = figures.iter().map(|[ratio, _, share]| (ratio - 1.0).powi(2) * share).sum::<f64>().sqrt();
    [deviation, figures.iter().map(|[_, shear, share]| shear * share).sum()]
}

#[test]
fn islands_of_any_surface_are_disks() {
    for test in surfaces() {
        for target in [1.25, 1.4] {
            assert_sound_seams(&test, &found(&test, &for_target(target)));
        }
        let preview = SeamOptions { method: SeamMethod::Cones, ..Default::default() };
        assert_sound_seams(&test, &found(&test, &preview));
    }
}

#[test]
fn maps_of_any_surface_are_even_hardly_sheared_and_one_to_one() {
    for test in surfaces() {
        for target in [1.25, 1.4] {
            let map = unwrapped(&test, for_target(target));
            assert_sound_map(&test, &map);
            assert!(map.area_ratio_std <= 0.005, "{}: {}", test.name, map.area_ratio_std);
            assert!(map.shear <= 1.012 * target, "{}: {} above {target}", test.name, map.shear);
            assert_eq!(map.status, Status::Converged, "{}", test.name);
        }
    }
}

#[test]
fn an_unwrap_along_previewed_seams_has_maps_without_folds() {
    for test in [bumpy(4), torus(24, 12)] {
        let options = SeamOptions { method: SeamMethod::Cones, ..Default::default() };
        let seams = found(&test, &options);
        let unwrap = unwrapped(&test, options);
        assert_eq!(edges_of(&unwrap.edges), edges_of(&seams.edges), "{}", test.name);
        let uv = rows::<2, f64>(unwrap.uv.view());
        for face in rows::<3, u32>(unwrap.faces.view()) {
            assert!(signed_area(&face.map(|corner| uv[corner as usize])) > 0.0, "{}", test.name);
        }
    }
}

#[test]
fn seams_and_unwraps_agree() {
    for test in [bumpy(4), torus(24, 12), two_pieces()] {
        let (seams, map) = (found(&test, &for_target(1.3)), unwrapped(&test, for_target(1.3)));
        assert_eq!(seams.edges, map.edges);
        assert_eq!((seams.islands, &seams.island_of), (map.islands, &map.island_of));
        assert_eq!((seams.length, seams.status), (map.length, map.status));
    }
}

#[test]
fn flat_surfaces_need_no_seams() {
    let seams = found(&grid(7, 5), &SeamOptions::default());
    assert_eq!((seams.edges.nrows(), seams.islands, seams.length), (0, 1, 0.0));
    assert!(seams.predicted < 1.0 + 1e-6);
    // a seam from one end to the other, 3 long on an area of 6 π
    let seams = found(&cylinder(), &SeamOptions::default());
    assert!((seams.length - 3.0 / (3.0 * TAU).sqrt()).abs() < 0.02, "{}", seams.length);
}

#[test]
fn given_seams_stay() {
    for test in [bumpy(4), torus(24, 12), holed_grid()] {
        let ring: Vec<u32> = all_edges(&test).into_iter().step_by(97).flatten().collect();
        let fixed = Array2::from_shape_vec((ring.len() / 2, 2), ring).unwrap();
        let options = SeamOptions { fixed: Some(fixed.view()), ..Default::default() };
        let seams = found(&test, &options);
        assert!(edges_of(&fixed).is_subset(&edges_of(&seams.edges)), "{}", test.name);
        assert_sound_seams(&test, &seams);
    }
}

#[test]
fn forbidden_edges_are_no_seams() {
    for test in [bumpy(4), torus(24, 12)] {
        // a cell, so that cuts into disks lead around it
        let is_kept_off = |vertex: u32| {
            let [x, y, z] = test.vertices[vertex as usize];
            x > 0.3 && y > 0.0 && z > -0.1
        };
        let edges = all_edges(&test);
        let forbid = |is_forbidden: bool| if is_forbidden { f64::INFINITY } else { 1.0 };
        let at_edges: Array1<f64> =
            edges.iter().map(|edge| forbid(edge.iter().any(|&vertex| is_kept_off(vertex)))).collect();
        let at_vertices: Array1<f64> =
            (0..test.vertices.len() as u32).map(|v| forbid(is_kept_off(v))).collect();
        for weights in [at_edges, at_vertices] {
            let options = SeamOptions { weights: Some(weights.view()), ..Default::default() };
            let seams = found(&test, &options);
            assert_sound_seams(&test, &seams);
            let kept_off =
                edges_of(&seams.edges).into_iter().filter(|edge| edge.iter().any(|&v| is_kept_off(v)));
            assert_eq!(kept_off.count(), 0, "{}", test.name);
        }
    }
}

#[test]
fn seams_keep_off_half_of_a_surface_without_detours() {
    // no cut of the rest is enough, and no long one is worth its length
    let test = bumpy(4);
    let forbid = |&[x, _, _]: &[f64; 3]| if x > 0.0 { f64::INFINITY } else { 1.0 };
    let weights: Array1<f64> = test.vertices.iter().map(forbid).collect();
    let seams = found(&test, &SeamOptions { weights: Some(weights.view()), ..for_target(1.25) });
    assert_sound_seams(&test, &seams);
    let free = found(&test, &for_target(1.25));
    assert!(seams.length < 1.5 * free.length, "{} {}", seams.length, free.length);
}

#[test]
fn weights_that_forbid_every_cut_into_disks_are_refused() {
    // a piece of the tube
    let test = torus(24, 12);
    let forbid = |&[x, y, _]: &[f64; 3]| if x > 0.3 && y > 0.0 { f64::INFINITY } else { 1.0 };
    let weights: Array1<f64> = test.vertices.iter().map(forbid).collect();
    let options = SeamOptions { weights: Some(weights.view()), ..Default::default() };
    let error = authalic::seams(&surface(&test), &options, &mut Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidArray);
}

#[test]
fn no_more_islands_than_are_wanted() {
    for test in [bumpy(4), plate_with_holes(3), capsule(24, 12), cube(7), torus(24, 12)] {
        for most in [1, 3] {
            let options = SeamOptions { target: 1.2, max_islands: Some(most), ..Default::default() };
            let seams = found(&test, &options);
            assert!(seams.islands <= most, "{}: {} islands of {most}", test.name, seams.islands);
            assert_sound_seams(&test, &seams);
        }
    }
}

#[test]
fn a_mirrored_surface_has_mirrored_seams() {
    let test = bumpy(4);
    let mirrored = TestMesh {
        vertices: test.vertices.iter().map(|&[x, y, z]| [-x, y, z]).collect(),
        faces: test.faces.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        ..test.clone()
    };
    let [one, other] = [&test, &mirrored].map(|mesh| found(mesh, &SeamOptions::default()));
    assert_eq!(one.edges, other.edges);
}

#[test]
fn seams_of_a_symmetric_surface_mirror_each_other() {
    // edges lie in the mirror plane, and limbs overlap each other
    let bump = |[x, y, z]: [f64; 3], height: f64| height * (-9.0 * (x * x + y * y + z * z)).exp();
    let bent = placed("body", octants(22), |x| {
        let arms = [x[0].abs() - 0.8, x[1] - 0.4, x[2] - 0.45];
        let radius = 1.0 + 0.2 * x[1] + bump(arms, 1.6) + bump([x[0], x[1] + 1.0, x[2] - 0.2], 0.9);
        x.map(|x| radius * x)
    });
    let seams = found(&bent, &for_target(1.25));
    let numbers = bent.vertices.iter().map(|&[x, y, z]| {
        let image = |other: &[f64; 3]| common::distance(*other, [-x, y, z]) < 1e-9;
        bent.vertices.iter().position(image).expect("a symmetric mesh") as u32
    });
    let numbers: Vec<u32> = numbers.collect();
    let image = |[a, b]: [u32; 2]| {
        let [a, b] = [a, b].map(|v| numbers[v as usize]);
        [a.min(b), a.max(b)]
    };
    let edges = edges_of(&seams.edges);
    assert_eq!(edges.iter().copied().map(image).collect::<Edges>(), edges);
}

#[test]
fn tiny_noise_changes_no_seam() {
    let test = bumpy(4);
    let expected = found(&test, &SeamOptions::default()).edges;
    let mut random = Random::new(1);
    let mut noisy = test.clone();
    noisy.vertices.iter_mut().flatten().for_each(|x| *x += random.between(-1e-12, 1e-12));
    assert_eq!(found(&noisy, &SeamOptions::default()).edges, expected);
}

#[test]
fn the_unit_of_the_surface_does_not_matter() {
    let test = bumpy(4);
    let expected = found(&test, &SeamOptions::default());
    // a power of two changes no digit
    let larger = placed("larger", test, |x| x.map(|x| 1024.0 * x));
    assert_eq!(found(&larger, &SeamOptions::default()).edges, expected.edges);
}

#[test]
fn one_result_for_any_number_of_threads() {
    for test in [bumpy(4), torus(24, 12)] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                (found(&test, &SeamOptions::default()), unwrapped(&test, SeamOptions::default()).uv)
            })
        };
        let expected = on(1);
        assert_eq!(expected, on(2));
        assert_eq!(expected, on(5));
    }
}

#[test]
fn a_cancelled_run_asks_no_more() {
    let test = bumpy(5);
    let surface = surface(&test);
    let mut n_cancelled = 0;
    for patience in [0, 3, 10, 40] {
        for is_unwrap in [false, true] {
            let mut reports = 0;
            let mut observer = |_: f64, _: &str| {
                reports += 1;
                reports <= patience
            };
            let error = if is_unwrap {
                authalic::unwrap(&surface, &UnwrapOptions::default(), &mut observer).err()
            } else {
                authalic::seams(&surface, &for_target(1.1), &mut observer).err()
            };
            if patience > 0 && reports <= patience {
                continue; // a machine with few reports is done before
            }
            assert_eq!(error, Some(Error::CancelledEarly), "after {patience} reports");
            assert_eq!(reports, patience + 1);
            n_cancelled += 1;
        }
    }
    assert!(n_cancelled > 2, "only the first reports were refused");
}

#[test]
fn progress_rises() {
    for test in [bumpy(4), torus(24, 12), two_pieces()] {
        let mut reports = Vec::new();
        let mut observer = |fraction: f64, message: &str| {
            assert!(!message.is_empty());
            reports.push(fraction);
            true
        };
        authalic::unwrap(&surface(&test), &UnwrapOptions::default(), &mut observer).unwrap();
        let rises = reports.windows(2).filter(|pair| pair[1] > pair[0]).count();
        assert!(rises > 20, "{}: {rises}", test.name);
        assert!(reports.is_sorted(), "{}: {reports:?}", test.name);
        assert!(reports[0] >= 0.0 && (0.5..=1.0).contains(&reports[reports.len() - 1]), "{}", test.name);
    }
}

#[test]
#[ignore = "known miss: coarse meshes are stiffer than the plate predicts"]
fn the_predicted_shear_is_about_that_of_the_maps() {
    for test in [bumpy(4), ellipsoid(4, [1.0, 2.0, 4.0]), torus(40, 24), cap(18, 2.4)] {
        for target in [1.2, 1.3, 1.5] {
            let options = SeamOptions { target, overlap: true, ..Default::default() };
            let (seams, map) = (found(&test, &options), unwrapped(&test, options));
            let error = map.shear - seams.predicted;
            assert!(
                error.abs() < 0.08,
                "{} at {target}: {} predicted {}",
                test.name,
                map.shear,
                seams.predicted
            );
        }
    }
}

#[test]
fn given_seams_are_unwrapped_as_they_are() {
    let test = cube(1);
    let edges = found(&test, &SeamOptions::default()).edges;
    let options = UnwrapOptions { seams: UnwrapSeams::Given(edges.view()), ..Default::default() };
    let map = authalic::unwrap(&surface(&test), &options, &mut Silent).unwrap();
    assert_eq!(map.edges, edges);
    assert_sound_map(&test, &map);
}

#[test]
fn what_given_seams_leave_must_be_mappable() {
    let none = Array2::<u32>::zeros((0, 2));
    let options = UnwrapOptions { seams: UnwrapSeams::Given(none.view()), ..Default::default() };
    let kind = |test: TestMesh| authalic::unwrap(&surface(&test), &options, &mut Silent).unwrap_err().kind();
    assert_eq!(kind(octahedron()), ErrorKind::ClosedSurface);
    assert_eq!(kind(torus(6, 8)), ErrorKind::Handles);
    let map = authalic::unwrap(&surface(&grid(7, 5)), &options, &mut Silent).unwrap();
    assert_sound_map(&grid(7, 5), &map);
    assert!((map.shear - 1.0).abs() < 1e-3 && map.edges.is_empty());
}

#[test]
fn what_is_no_surface_is_refused() {
    let vertices = array![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [0., -1., 0.]];
    let kind = |faces: Array2<u32>| {
        let surface = Surface::new(&vertices, faces).unwrap();
        authalic::seams(&surface, &SeamOptions::default(), &mut Silent).map_err(|error| error.kind())
    };
    assert!(kind(array![[0, 1, 2]]).is_ok());
    assert_eq!(kind(array![[0, 1, 2], [0, 1, 2]]), Err(ErrorKind::DuplicateFace));
}

#[test]
fn a_large_surface_is_cut_by_the_seams_of_a_coarser_one() {
    // 40,962 vertices
    let body = bumpy(6);
    let unwrap = unwrapped(&body, for_target(1.25));
    assert_eq!(unwrap.status, Status::Converged);
    assert!(unwrap.shear <= 1.265, "{}", unwrap.shear);
    assert!(unwrap.area_ratio_std <= 0.005, "{}", unwrap.area_ratio_std);
    let patches = surface(&body).cut(&unwrap.edges).expect("seams are edges");
    assert!(patches.iter().all(|patch| patch.is_disk()));
    // not many more seams than the same body needs with a quarter of the vertices
    let small = found(&bumpy(5), &for_target(1.25));
    assert!(unwrap.length < 1.2 * small.length, "{} {}", unwrap.length, small.length);
}

#[test]
fn wishes_are_kept_on_large_surfaces() {
    let ring = torus(120, 105);
    let is_kept_off = |vertex: u32| {
        let [x, y, z] = ring.vertices[vertex as usize];
        x > 0.3 && y > 0.0 && z > -0.1
    };
    let forbid = |vertex: u32| if is_kept_off(vertex) { f64::INFINITY } else { 1.0 };
    let weights: Array1<f64> = (0..ring.vertices.len() as u32).map(forbid).collect();
    let given = array![[0, 1], [1, 2], [2, 3]];
    let options = SeamOptions {
        weights: Some(weights.view()),
        fixed: Some(given.view()),
        max_islands: Some(1),
        ..Default::default()
    };
    let mut fractions = Vec::new();
    let mut observer = |fraction: f64, _: &str| {
        fractions.push(fraction);
        true
    };
    let seams = authalic::seams(&surface(&ring), &options, &mut observer).expect("seams");
    assert_sound_seams(&ring, &seams);
    let edges = edges_of(&seams.edges);
    assert!(rows::<2, u32>(given.view()).iter().all(|edge| edges.contains(edge)));
    assert_eq!(seams.islands, 1);
    let is_given = |edge: &[u32; 2]| edge[1] < 4;
    assert!(edges.iter().all(|edge| is_given(edge) || !edge.iter().any(|&vertex| is_kept_off(vertex))));
    assert!(fractions.is_sorted() && fractions.len() > 20);
}

#[test]
fn a_given_edge_alone_opens_where_a_seam_meets_it() {
    let body = bumpy(3);
    let free = edges_of(&found(&body, &for_target(1.4)).edges);
    let ends: BTreeSet<u32> = free.iter().flatten().copied().collect();
    let beside: Vec<_> =
        all_edges(&body).into_iter().filter(|[a, b]| ends.contains(a) != ends.contains(b)).collect();
    let mut n_met = 0;
    for edge in beside.into_iter().step_by(17).take(6) {
        let given = array![edge];
        let options = SeamOptions { fixed: Some(given.view()), ..for_target(1.4) };
        let unwrap = unwrapped(&body, options);
        let edges = edges_of(&unwrap.edges);
        let is_met = edges.iter().any(|other| *other != edge && other.iter().any(|end| edge.contains(end)));
        n_met += usize::from(is_met);
        let patches = surface(&body).cut(&unwrap.edges).expect("seams are edges");
        let n_points: usize = patches.iter().map(|patch| patch.vertex_of.len()).sum();
        assert_eq!((unwrap.islands, unwrap.uv.nrows()), (patches.len(), n_points), "{edge:?}");
    }
    assert!(n_met > 0);
}
