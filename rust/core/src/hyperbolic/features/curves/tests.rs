// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::hyperbolic::sample_meshes::{circle, mesh, path, sphere, without};
use crate::mesh::Vertex;
use crate::vector::{Vector3, coordinates};

const X: Vector3 = Vector3([1.0, 0.0, 0.0]);
const Y: Vector3 = Vector3([0.0, 1.0, 0.0]);
const Z: Vector3 = Vector3([0.0, 0.0, 1.0]);

fn whole() -> TriangleMesh {
    mesh(&sphere(3), |x| x)
}

fn cap_removed() -> TriangleMesh {
    mesh(&without(&sphere(3), |x| x[2] > 0.8), |x| x)
}

fn check(
    meshes: [&TriangleMesh; 2],
    source: &[Vec<usize>],
    target: &[Vec<usize>],
) -> Result<Vec<CurvePair>, Error> {
    LandmarkCurves { source, target }.check(meshes[0], meshes[1])
}

/// The message about the same curves on the same surface.
fn message(mesh: &TriangleMesh, curves: &[Vec<usize>]) -> String {
    check([mesh, mesh], curves, curves).unwrap_err().to_string()
}

#[test]
fn open_curves_are_pairs_as_given() {
    let (whole, arc) = (whole(), path(&sphere(3), X, Y));
    let pairs = check([&whole, &whole], std::slice::from_ref(&arc), std::slice::from_ref(&arc)).unwrap();
    let vertices: Vec<Vertex> = arc.iter().copied().map(Vertex::new).collect();
    let expected = CurvePair {
        source: vertices.clone(),
        target: vertices,
        closed: false,
        on_boundary: false,
        gap: None,
    };
    assert_eq!(pairs, [expected]);
}

#[test]
fn curves_are_closed_where_both_partners_can_be() {
    let (whole, ring, arc) = (whole(), circle(&sphere(3), Z, 1.0), path(&sphere(3), X, Y));
    let repeated = [&ring[..], &ring[..1]].concat();
    let pair = |source: &Vec<usize>, target: &Vec<usize>| {
        let pair = check([&whole, &whole], std::slice::from_ref(source), std::slice::from_ref(target));
        pair.map(|pairs| (pairs[0].closed, pairs[0].gap, pairs[0].target.len()))
    };
    let n = ring.len();
    assert_eq!(pair(&repeated, &repeated), Ok((true, None, n)));
    assert_eq!(pair(&ring, &repeated), Ok((true, None, n)));
    assert_eq!(pair(&repeated, &ring), Ok((true, Some(Gap::AtEnd), n)));
    assert_eq!(pair(&ring, &ring), Ok((true, Some(Gap::AtEnd), n)));
    assert_eq!(pair(&ring, &arc), Ok((false, None, arc.len())));
    assert_eq!(
        pair(&arc, &repeated),
        Err(CurveError::NotClosed { side: Some(Side::Source), curve: 0 }.into())
    );
    assert_eq!(
        pair(&repeated, &arc),
        Err(CurveError::NotClosed { side: Some(Side::Target), curve: 0 }.into())
    );
}

#[test]
fn counts_must_agree() {
    let (whole, open, arc) = (whole(), cap_removed(), path(&sphere(3), X, Y));
    let error = check([&whole, &whole], &[arc.clone(), arc.clone(), arc.clone()], &[arc]).unwrap_err();
    assert!(error.to_string().contains("3 on the source and 1 on the target"), "{error}");
    assert!(error.to_string().contains("2 curves (1, 2)"), "{error}");
    assert!(
        check([&whole, &whole], &[], &[]).unwrap_err().to_string().contains("or register by landmark points")
    );
    assert!(check([&open, &open], &[], &[]).unwrap().is_empty());
    let error = check([&open, &whole], &[], &[]).unwrap_err();
    assert_eq!(error, CurveError::LoopCounts { source_count: 1, target_count: 0 }.into());
}

#[test]
fn bad_curves_are_refused_by_argument_number_and_place() {
    let (whole, arc) = (whole(), path(&sphere(3), X, Y));
    let first = path(&sphere(3), Vector3([-1.0, -0.3, 0.0]), Vector3([0.0, -1.0, -0.4]));
    let with = |curve: Vec<usize>| message(&whole, &[first.clone(), curve]);
    let short = with(arc[..2].to_vec());
    assert!(short.starts_with("source_curves: curve 1 has 1 edges"), "{short}");
    assert!(
        with(vec![]).contains("0 edges") && with(vec![arc[0], arc[1], arc[0]]).contains("a closed one three")
    );
    let outside = with([&arc[..2], &[9999]].concat());
    assert!(outside.contains("curve 1 is out of range at place 2: 9999"), "{outside}");
    let off = with(vec![arc[0], arc[1], arc[3]]);
    assert!(off.contains(&format!("after place 1: no edge joins vertices {}, {};", arc[1], arc[3])), "{off}");
    let back = with(vec![arc[0], arc[1], arc[2], arc[1]]);
    assert!(back.contains(&format!("at vertex {}, at places 1 and 3", arc[1])), "{back}");
    let meeting =
        message(&whole, &[arc.clone(), first.clone(), path(&sphere(3), Y, Vector3([0.0, 0.6, 0.7]))]);
    let shared = arc[arc.len() - 1];
    assert!(
        meeting.contains(&format!("source_curves: curves 0 and 2 meet at vertex {shared}:")),
        "{meeting}"
    );
    let error = check([&whole, &whole], std::slice::from_ref(&arc), &[vec![0, 0, 0, 0]]).unwrap_err();
    assert!(error.to_string().starts_with("target_curves: curve 0 meets itself"), "{error}");
    assert!(error.is_mesh_error() && error.elements().is_some());
}

#[test]
fn the_boundary_is_met_by_whole_loops_only() {
    let open = cap_removed();
    let rim: Vec<usize> = open.boundary_loops()[0].iter().map(|&v| v.index()).collect();
    let n = rim.len();
    let backwards: Vec<usize> = (0..=n).map(|k| rim[(5 + n - k) % n]).collect();
    let pairs = check([&open, &open], std::slice::from_ref(&rim), std::slice::from_ref(&backwards)).unwrap();
    assert!(pairs[0].on_boundary && pairs[0].closed && pairs[0].gap.is_none());
    let part = message(&open, &[rim[..4].to_vec()]);
    assert!(part.contains("curve 0 meets the boundary at 4 vertices"), "{part}");
    // a loop inside the target cannot be the end of the source
    let ring = circle(&without(&sphere(3), |x| x[2] > 0.8), Vector3([0.0, 0.0, -1.0]), 0.5);
    let ring = [&ring[..], &ring[..1]].concat();
    let error = check([&open, &open], &[backwards], &[ring]).unwrap_err();
    assert_eq!(error, CurveError::BoundsOneSide { side: Some(Side::Source), curve: 0 }.into());
}

#[test]
fn surfaces_must_be_one_piece_without_handles() {
    let (points, faces) = sphere(1);
    let shifted: Vec<Vector3> = points.iter().map(|&x| x + Vector3([5.0, 0.0, 0.0])).collect();
    let n = points.len() as u32;
    let other = faces.iter().map(|face| face.map(|v| Vertex(v.0 + n)));
    let both: Vec<[Vertex; 3]> = faces.iter().copied().chain(other).collect();
    let two = TriangleMesh::new(&coordinates([points, shifted].concat()), &both).unwrap();
    let error = check([&whole(), &two], &[vec![0, 1]], &[vec![0, 1]]).unwrap_err();
    assert!(error.to_string().starts_with("the target: the mesh is 2 separate pieces"), "{error}");
}

#[test]
fn noise_does_not_choose_where_a_closed_curve_starts() {
    // a ring of two vertices of the least x each
    let ring: Vec<[f64; 3]> = (0..16)
        .map(|k| std::f64::consts::TAU * (f64::from(k) + 0.5) / 16.0)
        .map(|angle| [angle.cos(), angle.sin(), 0.0])
        .collect();
    let n = ring.len() as u32;
    let faces: Vec<[u32; 3]> = (0..n).flat_map(|k| [[k, (k + 1) % n, n], [(k + 1) % n, k, n + 1]]).collect();
    for seed in 0..20 {
        let noise = |k: usize| 1e-12 * (7.3 * (k + seed) as f64).sin();
        let poles = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        let moved = ring.iter().enumerate().map(|(k, &[x, y, z])| [x + noise(k), y, z]).chain(poles);
        let mesh = TriangleMesh::new(&moved.collect::<Vec<_>>(), &faces).unwrap();
        let mut curve: Vec<Vertex> = (0..n).map(Vertex).collect();
        start_canonically(&mut curve, &mesh);
        assert_eq!(curve[..2], [8, 7].map(Vertex), "{seed}");
    }
}
