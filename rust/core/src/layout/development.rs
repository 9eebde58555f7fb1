// SPDX-License-Identifier: MIT OR Apache-2.0
//! Develops a mesh of the sphere into the plane, face by face and polygon by polygon.
//!
//! An edge is a great arc. The cuts that it crosses give the isometry that takes the image of its end next to that of
//! its start. Composed along the edges of a polygon, these isometries join its corners. Then the polygon as a whole is
//! moved into the layout.

use std::marker::PhantomData;

use super::chart::Chart;
use super::isometry::Isometry;
use super::polygons::{Diagonal, Polygons};
use super::projection::{Extent, Projection, is_singular};
use crate::mesh::{Corner, Face, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Distance below which two images of a point count as equal.
const SAME_PLACE: f64 = 1e-6;

/// Develops `faces`, counter-clockwise between `points` of the unit sphere.
///
/// A vertex on a singular point must have exactly the coordinates of that point.
pub(super) fn develop<'a, P: Projection>(
    points: &[Vector3],
    faces: &'a [[Vertex; 3]],
    polygons: &Polygons,
) -> Chart<'a, P> {
    // 1. Place each vertex, and join the corners of each face.
    let singular: Vec<bool> = parallel::map(points.len(), |vertex| is_singular::<P>(points[vertex]));
    let developed = parallel::map(faces.len(), |face| Triangle::new::<P>(points, &singular, faces[face]));
    let mut chart = Chart {
        faces,
        places: parallel::map(points.len(), |vertex| P::place(points[vertex])),
        isometries: developed.iter().map(|triangle| triangle.isometries).collect(),
        polar: if P::HAS_CONES { Vec::new() } else { polar_corners(faces, &singular, polygons) },
        is_closed: developed.iter().map(|triangle| triangle.is_closed).collect(),
        projection: PhantomData,
    };
    // 2. Join the faces of each polygon.
    join_polygons(&mut chart, &singular, polygons);
    // 3. Move each polygon into the layout.
    move_polygons(&mut chart, &singular, polygons, P::home);
    chart
}

/// Moves polygons that have strayed out of the layout back into it.
pub(super) fn bring_back<P: Projection>(chart: &mut Chart<'_, P>, singular: &[bool], polygons: &Polygons) {
    move_polygons(chart, singular, polygons, |extent| {
        if P::has_strayed(extent) { P::home(extent) } else { Isometry::default() }
    });
}

/// Moves each polygon as a whole, by an isometry that depends on its extent.
fn move_polygons<P: Projection>(
    chart: &mut Chart<'_, P>,
    singular: &[bool],
    polygons: &Polygons,
    by: impl Fn(&Extent) -> Isometry,
) {
    let moves: Vec<Isometry> = extents(chart, singular, polygons).iter().map(by).collect();
    parallel::fill_with_old(&mut chart.isometries, |face, isometries| {
        isometries.map(|isometry| moves[polygons.of[face]].after(isometry))
    });
}

/// A face with its corners joined.
#[derive(Clone, Copy, Default)]
struct Triangle {
    isometries: [Isometry; 3],
    is_closed: bool,
}

impl Triangle {
    fn new<P: Projection>(points: &[Vector3], singular: &[bool], face: [Vertex; 3]) -> Self {
        // arcs to singular points touch a cut, which leaves undetermined only an isometry about that point
        let base = (0..3).find(|&corner| !singular[face[corner]]).unwrap_or(0);
        let [second, third] = [(base + 1) % 3, (base + 2) % 3];
        let [a, b, c] = [base, second, third].map(|corner| points[face[corner]]);
        let mut isometries = [Isometry::default(); 3];
        isometries[second] = P::crossing(a, b);
        isometries[third] = P::crossing(a, c);
        let mut triangle = Self { isometries, is_closed: false };
        let to_third = isometries[second].after(P::crossing(b, c));
        let n_singular = face.iter().filter(|&&vertex| singular[vertex]).count();
        triangle.is_closed = if P::HAS_CONES {
            let to_second = isometries[third].after(P::crossing(c, b));
            let mut closes = to_third == isometries[third];
            for (corner, around) in [(third, to_third), (second, to_second)] {
                let vertex = face[corner];
                if singular[vertex] {
                    let place = P::place(points[vertex]);
                    let [direct, around] = [isometries[corner], around].map(|i| i.image(P::PERIODS, place));
                    closes = is_same_place(direct, around);
                }
            }
            closes && n_singular <= 2
        } else {
            (to_third == isometries[third] || n_singular > 0) && n_singular <= 1
        };
        triangle
    }
}

/// The corners at poles, by polygon and pole.
fn polar_corners(faces: &[[Vertex; 3]], singular: &[bool], polygons: &Polygons) -> Vec<Vec<Corner>> {
    let corners = Corner::all(faces.len()).filter(|corner| singular[corner.vertex(faces)]);
    let mut corners: Vec<(usize, Vertex, Corner)> =
        corners.map(|corner| (polygons.of[corner.face()], corner.vertex(faces), corner)).collect();
    corners.sort_unstable();
    corners
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .map(|group| group.iter().map(|&(_, _, corner)| corner).collect())
        .collect()
}

/// Joins the faces of each polygon along its diagonals. If they do not fit together, none counts as closed.
fn join_polygons<P: Projection>(chart: &mut Chart<'_, P>, singular: &[bool], polygons: &Polygons) {
    for &joint in &polygons.joints {
        let joint = from_regular_end(chart.faces, singular, joint);
        let whole = fitting(chart, singular, joint);
        let face = joint.there[0].face();
        chart.isometries[face] = chart.isometries[face].map(|isometry| whole.after(isometry));
    }
    let mut is_torn = vec![false; polygons.count];
    for diagonal in polygons.joints.iter().chain(&polygons.loops) {
        let fits = (0..2).all(|end| {
            let is_pole = !P::HAS_CONES && singular[diagonal.here[end].vertex(chart.faces)];
            is_pole || is_same_place(chart.image(diagonal.here[end]), chart.image(diagonal.there[end]))
        });
        if !fits {
            is_torn[polygons.of[diagonal.here[0].face()]] = true;
        }
    }
    for (face, is_closed) in chart.is_closed.iter_mut().enumerate() {
        *is_closed &= !is_torn[polygons.of[face]];
    }
}

/// The diagonal with a regular end first, if it has one.
fn from_regular_end(faces: &[[Vertex; 3]], singular: &[bool], diagonal: Diagonal) -> Diagonal {
    if singular[diagonal.here[0].vertex(faces)] { diagonal.reversed() } else { diagonal }
}

/// The isometry that attaches the second triangle of a diagonal to the first.
fn fitting<P: Projection>(chart: &Chart<'_, P>, singular: &[bool], diagonal: Diagonal) -> Isometry {
    let isometry = |corner: Corner| chart.isometries[corner.face()][corner.place()];
    let [here, there] = [diagonal.here[0], diagonal.there[0]];
    let whole = isometry(here).after(isometry(there).inverse());
    if !singular[here.vertex(chart.faces)] {
        return whole;
    }
    // both ends are singular: the joint may need another half turn about the first
    let [_, second] = diagonal.there;
    let vertex = second.vertex(chart.faces);
    let image = whole.after(isometry(second)).image(P::PERIODS, chart.places[vertex]);
    if is_same_place(image, chart.image(diagonal.here[1])) {
        return whole;
    }
    let center = chart.image(here).map(|x| x.round() as i32);
    Isometry::half_turn(center).after(whole)
}

/// The extent of each polygon, without its singular corners if it has others.
fn extents<P: Projection>(chart: &Chart<'_, P>, singular: &[bool], polygons: &Polygons) -> Vec<Extent> {
    let mut extents = vec![Extent { low: [f64::INFINITY; 2], center: [0.0; 2] }; polygons.count];
    let mut counts = vec![0.0; polygons.count];
    for (face, vertices) in Face::all(chart.faces.len()).zip(chart.faces) {
        let polygon = polygons.of[face];
        let all_singular = vertices.iter().all(|&vertex| singular[vertex]);
        let images = chart.corner_images(face);
        for (&vertex, image) in vertices.iter().zip(images) {
            if singular[vertex] && !all_singular {
                continue;
            }
            let extent = &mut extents[polygon];
            extent.low = [0, 1].map(|axis| extent.low[axis].min(image[axis]));
            extent.center = [0, 1].map(|axis| extent.center[axis] + image[axis]);
            counts[polygon] += 1.0;
        }
    }
    for (extent, count) in extents.iter_mut().zip(counts) {
        extent.center = extent.center.map(|sum| sum / count);
    }
    extents
}

fn is_same_place(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < SAME_PLACE
}
