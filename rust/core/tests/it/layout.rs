// SPDX-License-Identifier: MIT OR Apache-2.0
//! Layouts of sphere maps through the crate's public interface, in its arrays.

use authalic::{
    Error, Layout, LayoutKind, LayoutOptions, Precision, Seam, Silent, SphereFaces, SphereMapOptions,
    Surface, layout, sphere_map,
};
use ndarray::aview2;

use crate::common;

const KINDS: [LayoutKind; 2] = [LayoutKind::Lambert, LayoutKind::Octahedral];

fn surface() -> Surface {
    let ball = common::icosphere(3);
    let stretched: Vec<[f64; 3]> = ball.vertices.iter().map(|&[x, y, z]| [x, 2.0 * y, 3.0 * z]).collect();
    Surface::new(aview2(&stretched), aview2(&ball.faces)).unwrap()
}

/// The signs of the areas of all faces, in integers: the coordinates are numbers of single precision and multiples of
/// 2⁻⁵⁸.
fn assert_opens_in_single_precision(layout: &Layout) {
    let exact = |x: f64| {
        assert_eq!(x, f64::from(x as f32), "a number of single precision");
        let multiple = x * 2f64.powi(58);
        assert_eq!(multiple.fract(), 0.0, "{x} is no multiple");
        multiple as i128
    };
    for face in layout.faces.rows() {
        let [a, b, c] = [0, 1, 2].map(|k| {
            let point = layout.points.row(face[k] as usize);
            [exact(point[0]), exact(point[1])]
        });
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert!(area > 0, "{a:?} {b:?} {c:?}");
    }
}

#[test]
fn a_layout_has_the_faces_of_the_map_and_no_fold_in_single_precision() {
    let surface = surface();
    let map = sphere_map(&surface, &SphereMapOptions::default(), &mut Silent).unwrap();
    for kind in KINDS {
        let (seam, precision) = (Seam::Angle(0.3), Precision::Single);
        let options = LayoutOptions { kind, seam, precision, ..LayoutOptions::default() };
        let layout = map.layout(&surface, &options, &mut Silent).unwrap();
        assert_eq!(layout.points.dim(), (layout.vertex_of.len(), 2));
        let vertices = layout.faces.mapv(|point| layout.vertex_of[point as usize].0);
        assert_eq!(vertices, surface.oriented_faces().unwrap());
        assert_opens_in_single_precision(&layout);
    }
}

#[test]
fn a_refined_map_is_laid_out_with_the_parts_of_its_faces() {
    let surface = surface();
    let options = SphereMapOptions { refine: true, ..SphereMapOptions::default() };
    let map = sphere_map(&surface, &options, &mut Silent).unwrap();
    let parts = &map.refinement.as_ref().expect("asked for").faces;
    let layout = map.layout(&surface, &LayoutOptions::default(), &mut Silent).unwrap();
    assert_eq!(layout.faces.mapv(|point| layout.vertex_of[point as usize].0), parts);
}

/// A ball with bumps that half a turn about the z axis takes to itself, and no mirror; with noise of about 10⁻¹².
fn of_half_turn(seed: u32) -> Surface {
    let ball = common::icosphere(3);
    let noise = |k: usize| f64::from(seed) * 1e-12 * ((k * 7919) % 1000) as f64 / 1000.0;
    let vertices: Vec<[f64; 3]> = (0..ball.vertices.len())
        .map(|k| {
            let [x, y, z] = ball.vertices[k];
            let radius = 1.0 + 0.4 * (x * y + 0.5 * z * z * z);
            [radius * x + noise(k), 1.2 * radius * y - noise(k + 1), 1.5 * radius * z + noise(k + 2)]
        })
        .collect();
    Surface::new(aview2(&vertices), aview2(&ball.faces)).unwrap()
}

#[test]
fn rounding_does_not_choose_between_the_sides_of_a_symmetric_surface() {
    for kind in KINDS {
        let options = LayoutOptions { kind, ..LayoutOptions::default() };
        let of = |seed: u32| {
            let surface = of_half_turn(seed);
            let map = sphere_map(&surface, &SphereMapOptions::default(), &mut Silent).unwrap();
            let layout = map.layout(&surface, &options, &mut Silent).unwrap();
            (map.positions, layout)
        };
        let (map, layout) = of(0);
        for seed in 1..6 {
            let (other_map, other_layout) = of(seed);
            let apart = (&other_map - &map).mapv(f64::abs).fold(0.0, |a: f64, &b| a.max(b));
            assert!(apart < 1e-8, "{kind:?}, {seed}: maps differ by {apart}");
            assert_eq!(other_layout.vertex_of, layout.vertex_of, "{kind:?}, {seed}");
            let apart =
                (&other_layout.points - &layout.points).mapv(f64::abs).fold(0.0, |a: f64, &b| a.max(b));
            assert!(apart < 1e-8, "{kind:?}, {seed}: layouts differ by {apart}");
        }
    }
}

#[test]
fn arrays_that_do_not_fit_are_refused() {
    let image = surface();
    let (n_vertices, n_faces) = (image.n_vertices(), image.n_faces());
    let (targets, parts) = (vec![1.0; n_faces], (0..n_faces).rev().collect::<Vec<_>>());
    let fitting = SphereFaces { image, targets: targets.clone(), face_of: None, n_vertices, n_filling: 0 };
    let refused =
        |sphere: SphereFaces, options: &LayoutOptions<'_>| match layout(&sphere, options, &mut Silent) {
            Err(Error::InvalidArray { name, .. }) => name,
            _ => "none",
        };
    let options = LayoutOptions::default();
    assert_eq!(
        refused(SphereFaces { targets: targets[1..].to_vec(), ..fitting.clone() }, &options),
        "density"
    );
    let cut_off = Some(parts[1..].to_vec());
    assert_eq!(refused(SphereFaces { face_of: Some(parts), ..fitting.clone() }, &options), "face_of");
    assert_eq!(refused(SphereFaces { face_of: cut_off, ..fitting.clone() }, &options), "face_of");
    assert_eq!(refused(SphereFaces { n_vertices: n_vertices + 1, ..fitting.clone() }, &options), "image");
    let polygons = LayoutOptions { polygons: Some(&[0, 1]), ..options };
    assert_eq!(refused(fitting.clone(), &polygons), "polygons");
    let candidates = LayoutOptions { candidates: Some(&[true]), ..options };
    assert_eq!(refused(fitting, &candidates), "candidates");
}
