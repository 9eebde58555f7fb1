// SPDX-License-Identifier: MIT OR Apache-2.0
//! Outlines that cross each other a little are pushed apart.
//!
//! 1. Where a vertex of an outline lies within another part of the image, the nearest edge of the outline of that part is
//!    the way out.
//! 2. A spring pulls the vertex a little beyond this edge, and the edge over the vertex; one Newton step on the energy
//!    of the map and of the springs follows.
//! 3. Again with stiffer springs, until no outline crosses another.
//!
//! Input: a map that is almost stationary. Cost: one factorization of two unknowns per vertex for each step.

use std::collections::BTreeSet;

use super::contact::{Contact, add_forces};
use super::descent::{DAMPING, MARGIN};
use super::energy::{Energy, Hessian};
use super::meeting::first_fold;
use super::outline::Outline;
use super::surface::Prepared;
use super::sweep::{Extent, for_each_overlap};
use super::system::{Linearized, System};
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::mesh::{Corner, Face};
use crate::parallel;

/// The stiffness of the first springs, whose unit is that of the energy at a vertex.
const FIRST_STIFFNESS: f64 = 1.0;

/// Its growth from one step to the next.
const GROWTH: f64 = 3.0;

/// Its upper bound.
const LARGEST_STIFFNESS: f64 = 300.0;

/// The most steps.
const MOST: usize = 10;

/// How far beyond an edge springs pull, in units of the heights beside it.
const BEYOND: f64 = 0.1;

/// The way out is sought in this many rings around the face that covers a vertex.
const MOST_RINGS: usize = 12;

/// The rings that are looked at beyond the first that meets the outline.
const MORE_RINGS: usize = 2;

/// The shift of the Hessian in units of its diagonal.
const SHIFT: f64 = 1e-10;

/// How near to the minimum the map is taken to be, which sets the precision of the step.
const RATIO: f64 = 1e-4;

/// A map whose outlines do not cross, near to a map without folds; `None` where outlines cross too far.
pub(super) fn pushed_apart(
    prepared: &Prepared<'_>,
    mut map: PlanarMap,
    weight: f64,
    watch: &Watch<'_>,
) -> Option<PlanarMap> {
    let Prepared { energy, analysis, outline } = *prepared;
    let crossings = Crossings::new(energy, outline);
    let mut system = System::new(energy, analysis, None);
    let mut stiffness = FIRST_STIFFNESS;
    for _ in 0..MOST {
        if outline.is_simple(&map) {
            return Some(map);
        }
        // 1. The ways out
        let contacts = crossings.ways_out(&map)?;
        // 2. A Newton step
        let force = |contact: &Contact| stiffness * (contact.gap - BEYOND) * contact.reach;
        let springs: Vec<[f64; 2]> = contacts.iter().map(|contact| [force(contact), stiffness]).collect();
        let mut gradient = energy.gradient(&map, weight);
        add_forces(&mut gradient, &contacts, &springs);
        let state = Linearized {
            map: &map,
            gradient: &gradient,
            contacts: &contacts,
            springs: &springs,
            ratio: RATIO,
        };
        let how = Hessian { weight, damping: DAMPING, least: 1.0, curvature: None };
        let along = system.solve(&state, &how, SHIFT, watch).ok()?.along;
        let step = (MARGIN * first_fold(energy.mesh, &map, &along)).min(1.0);
        map = parallel::map(map.len(), |v| [0, 1].map(|k| map[v][k] + step * along[v][k]));
        // 3. Stiffer springs
        stiffness = (GROWTH * stiffness).min(LARGEST_STIFFNESS);
    }
    outline.is_simple(&map).then_some(map)
}

/// The places where outlines may cross.
struct Crossings<'a> {
    energy: &'a Energy<'a>,
    outline: &'a Outline,
    /// The place of each vertex in the outline.
    place_of: Vec<Option<usize>>,
}

impl<'a> Crossings<'a> {
    fn new(energy: &'a Energy<'a>, outline: &'a Outline) -> Self {
        let mut place_of = vec![None; energy.mesh.n_vertices()];
        outline.vertices().iter().enumerate().for_each(|(place, &vertex)| place_of[vertex] = Some(place));
        Self { energy, outline, place_of }
    }

    /// For each vertex of an outline within another part of the image, the edge that is its way out, as a contact of
    /// negative gap; and the contacts of all vertices that are hardly out. `None` where a vertex has no way out near to
    /// it, or none is within another part.
    fn ways_out(&self, map: &[[f64; 2]]) -> Option<Vec<Contact>> {
        let covered = self.covered(map);
        let way_out = |&(place, face): &(usize, Face)| self.way_out(map, place, face);
        let mut contacts = covered.iter().map(way_out).collect::<Option<Vec<_>>>()?;
        if contacts.is_empty() {
            return None;
        }
        let mut is_covered = vec![false; self.outline.vertices().len()];
        covered.iter().for_each(|&(place, _)| is_covered[place] = true);
        let is_out =
            |contact: &Contact| self.place_of[contact.vertices[0]].is_some_and(|place| !is_covered[place]);
        let near = self.outline.contacts(map, BEYOND).into_iter().filter(is_out);
        contacts.extend(near.map(|contact| Contact {
            gap: BEYOND * contact.gap,
            reach: contact.reach / BEYOND,
            ..contact
        }));
        Some(contacts)
    }

    /// The vertices of outlines that faces cover, each by its place and with such a face, ascending.
    fn covered(&self, map: &[[f64; 2]]) -> Vec<(usize, Face)> {
        let (faces, vertices) = (self.energy.mesh.faces(), self.outline.vertices());
        let boxes: Vec<Extent> = faces.iter().map(|face| Extent::of(face.iter().map(|&v| map[v]))).collect();
        let points: Vec<Extent> = vertices.iter().map(|&v| Extent::of([map[v]].into_iter())).collect();
        let mut covered = Vec::new();
        for_each_overlap(&boxes, &points, |face, place| {
            let (corners, vertex) = (faces[face], vertices[place]);
            if !corners.contains(&vertex) && is_inside(map[vertex], corners.map(|v| map[v])) {
                covered.push((place, Face::new(face)));
            }
        });
        covered.sort_unstable();
        covered
    }

    /// The nearest edge of the outline in some rings around the face that covers a vertex.
    fn way_out(&self, map: &[[f64; 2]], place: usize, face: Face) -> Option<Contact> {
        let mesh = self.energy.mesh;
        let mut seen = BTreeSet::from([face]);
        let mut ring = vec![face];
        let mut nearest: Option<Contact> = None;
        let mut n_rings = MOST_RINGS;
        while n_rings > 0 && !ring.is_empty() {
            for corner in ring.iter().flat_map(|face| face.corners()) {
                if let Some(contact) = self.exit(map, corner, place)
                    && nearest.as_ref().is_none_or(|least| contact.distance() > least.distance())
                {
                    nearest = Some(contact);
                }
            }
            let around = ring.iter().flat_map(|&face| mesh.neighbors(face));
            ring = around.filter(|&face| seen.insert(face)).collect();
            n_rings = if nearest.is_some() { (n_rings - 1).min(MORE_RINGS) } else { n_rings - 1 };
        }
        nearest
    }

    /// The edge opposite to a corner as the way out for a vertex, if it lies on an outline.
    fn exit(&self, map: &[[f64; 2]], corner: Corner, place: usize) -> Option<Contact> {
        let mesh = self.energy.mesh;
        let edge = match mesh.opposite(corner) {
            Some(_) => None,
            None => self.place_of[corner.next().vertex(mesh.faces())],
        };
        self.outline.beyond(map, edge?, place)
    }
}

/// Whether a point lies within a counterclockwise triangle.
fn is_inside(point: [f64; 2], corners: [[f64; 2]; 3]) -> bool {
    (0..3).all(|k| {
        let ([ax, ay], [bx, by]) = (corners[k], corners[(k + 1) % 3]);
        (bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax) > 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::mesh::TriangleMesh;
    use crate::sparse::{Analysis, Order};

    /// A flat strip of `n` by 4 squares.
    fn strip(n: u32) -> TriangleMesh {
        let points: Vec<[f64; 3]> =
            (0..5 * (n + 1)).map(|k| [f64::from(k / 5), f64::from(k % 5), 0.0]).collect();
        let squares = (0..n).flat_map(|i| (0..4).map(move |j| 5 * i + j));
        let faces: Vec<[u32; 3]> = squares.flat_map(|a| [[a, a + 5, a + 6], [a, a + 6, a + 1]]).collect();
        TriangleMesh::new(&points, &faces).unwrap()
    }

    /// The strip around a ring, of area one, so long that its ends overlap by `turns` of the ring.
    fn ring(mesh: &TriangleMesh, n: u32, turns: f64) -> PlanarMap {
        let radius = f64::from(n) / (std::f64::consts::TAU * (1.0 + turns));
        let size = (4.0 * f64::from(n)).sqrt();
        (0..mesh.n_vertices() as u32)
            .map(|k| {
                let angle = -f64::from(k / 5) / radius;
                let distance = (radius - 2.0 + f64::from(k % 5)) / size;
                [distance * angle.cos(), distance * angle.sin()]
            })
            .collect()
    }

    fn with_strip<R>(test: impl FnOnce(&Prepared<'_>, u32) -> R) -> R {
        let n = 60;
        let mesh = strip(n);
        let energy = Energy::new(&mesh, mesh.face_areas());
        let outline = Outline::new(&energy);
        let vertices = mesh.n_vertices();
        let analysis = Analysis::new(vertices, mesh.faces(), &vec![2; vertices], Order::Sparse).unwrap();
        test(&Prepared { energy: &energy, analysis: &analysis, outline: &outline }, n)
    }

    #[test]
    fn ends_that_overlap_a_little_are_pushed_apart() {
        with_strip(|prepared, n| {
            let Prepared { energy, outline, .. } = *prepared;
            let map = ring(energy.mesh, n, 0.02);
            assert!(energy.is_unfolded(&map) && !outline.is_simple(&map));
            let apart = pushed_apart(prepared, map, 0.1, &Watch::new(&mut Silent, 0.0, "")).unwrap();
            assert!(energy.is_unfolded(&apart) && outline.is_simple(&apart));
        });
    }

    #[test]
    fn maps_whose_outlines_do_not_cross_stay_as_they_are() {
        with_strip(|prepared, n| {
            let map = ring(prepared.energy.mesh, n, -0.05);
            let mut silent = Silent;
            let watch = Watch::new(&mut silent, 0.0, "");
            assert_eq!(pushed_apart(prepared, map.clone(), 0.1, &watch), Some(map));
        });
    }

    #[test]
    fn ends_that_overlap_far_are_refused() {
        with_strip(|prepared, n| {
            let map = ring(prepared.energy.mesh, n, 0.6);
            let mut silent = Silent;
            let watch = Watch::new(&mut silent, 0.0, "");
            assert_eq!(pushed_apart(prepared, map, 0.1, &watch), None);
        });
    }
}
