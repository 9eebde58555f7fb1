// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outlines of a map: which vertices come near to which edges, and how far a step may go before they meet.

use super::contact::{Contact, Curvature, Stiffness};
use super::energy::Energy;
use super::meeting::first_meeting;
use super::sweep::{Extent, for_each_overlap};
use crate::codomain::planar::PlanarMap;
use crate::mesh::polygon::is_simple_outline;
use crate::mesh::{Corner, Face, Vertex};

/// The outlines of a map: all boundary loops of its surface.
pub(super) struct Outline {
    edges: Vec<Edge>,
    vertices: Vec<Vertex>,
    /// The least rest height beside each of `vertices`.
    heights: Vec<f64>,
    /// The median length of the edges on their rest triangles.
    length: f64,
    /// The end of the edge that leaves each of `vertices`, as a place in them.
    next: Vec<usize>,
}

struct Edge {
    ends: [Vertex; 2],
    /// The third vertex of the edge's face.
    opposite: Vertex,
    /// The least rest height of the face, or the edge itself where it is shorter.
    height: f64,
}

impl Outline {
    pub(super) fn new(energy: &Energy<'_>) -> Self {
        let mesh = energy.mesh;
        let loops = mesh.boundary_loops();
        let vertices: Vec<Vertex> = loops.iter().flatten().copied().collect();
        let mut next = Vec::with_capacity(vertices.len());
        for vertices in loops {
            let first = next.len();
            next.extend((0..vertices.len()).map(|k| first + (k + 1) % vertices.len()));
        }
        let height = |corner: Corner| {
            let [x, y] = energy.hat(corner);
            x.hypot(y).recip()
        };
        let least = |face: Face| face.corners().map(height).into_iter().fold(f64::INFINITY, f64::min);
        let mut edges = Vec::with_capacity(vertices.len());
        for (&from, &to) in vertices.iter().zip(next.iter().map(|&k| &vertices[k])) {
            let leaves = |corner: &&Corner| corner.next().vertex(mesh.faces()) == to;
            let corner = *mesh.vertex_corners(from).iter().find(leaves).expect("an edge has a face");
            let across = corner.previous();
            let opposite = across.vertex(mesh.faces());
            let length = 2.0 * energy.targets[corner.face()] / height(across);
            edges.push((
                Edge { ends: [from, to], opposite, height: least(corner.face()).min(length) },
                length,
            ));
        }
        let mut heights: Vec<f64> = vertices
            .iter()
            .map(|&v| {
                mesh.vertex_corners(v).iter().map(|corner| least(corner.face())).fold(f64::INFINITY, f64::min)
            })
            .collect();
        for (k, (_, length)) in edges.iter().enumerate() {
            [k, next[k]].into_iter().for_each(|end| heights[end] = heights[end].min(*length));
        }
        let mut lengths: Vec<f64> = edges.iter().map(|(_, length)| *length).collect();
        lengths.sort_unstable_by(f64::total_cmp);
        let length = lengths[lengths.len() / 2];
        Self { edges: edges.into_iter().map(|(edge, _)| edge).collect(), vertices, heights, length, next }
    }

    /// Contacts of strength κ.
    pub(super) fn stiffness(&self, kappa: f64) -> Stiffness {
        Stiffness { factor: kappa * self.length }
    }

    /// All pairs nearer to each other than `range` times the heights beside them.
    pub(super) fn contacts(&self, map: &[[f64; 2]], range: f64) -> Vec<Contact> {
        let edges: Vec<Extent> = self
            .edges
            .iter()
            .map(|edge| Extent::of(edge.ends.iter().map(|&v| map[v])).widened(range * edge.height))
            .collect();
        let vertices: Vec<Extent> = self.vertices.iter().map(|&v| Extent::of([map[v]].into_iter())).collect();
        let mut contacts = Vec::new();
        for_each_overlap(&edges, &vertices, |edge, vertex| {
            let reach = range * self.edges[edge].height.min(self.heights[vertex]);
            if self.may_touch(edge, vertex)
                && let Some(contact) = self.contact(map, edge, vertex, reach)
            {
                contacts.push(((edge, vertex), contact));
            }
        });
        contacts.sort_unstable_by_key(|(pair, _)| *pair);
        contacts.into_iter().map(|(_, contact)| contact).collect()
    }

    /// The vertices of all outlines; each edge leaves the vertex at its own place.
    pub(super) fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// The way of a vertex, by its place, out of the image beyond an edge: a contact of negative gap.
    pub(super) fn beyond(&self, map: &[[f64; 2]], edge: usize, place: usize) -> Option<Contact> {
        if !self.may_touch(edge, place) {
            return None;
        }
        let contact = self.contact(map, edge, place, f64::INFINITY)?;
        let reach = self.edges[edge].height.min(self.heights[place]);
        let slopes = contact.slopes.map(|slope| -slope);
        Some(Contact { gap: -contact.curvature.distance() / reach, reach, slopes, ..contact })
    }

    fn may_touch(&self, edge: usize, vertex: usize) -> bool {
        let (edge, vertex) = (&self.edges[edge], self.vertices[vertex]);
        !edge.ends.contains(&vertex) && edge.opposite != vertex
    }

    fn contact(&self, map: &[[f64; 2]], edge: usize, vertex: usize, reach: f64) -> Option<Contact> {
        let ([from, to], vertex) = (self.edges[edge].ends, self.vertices[vertex]);
        let [a, b, x] = [from, to, vertex].map(|v| map[v]);
        let (along, offset) = ([b[0] - a[0], b[1] - a[1]], [x[0] - a[0], x[1] - a[1]]);
        let squared = along[0] * along[0] + along[1] * along[1];
        let t = ((offset[0] * along[0] + offset[1] * along[1]) / squared).clamp(0.0, 1.0);
        let apart = [offset[0] - t * along[0], offset[1] - t * along[1]];
        let distance = apart[0].hypot(apart[1]);
        if distance.is_nan() || distance >= reach {
            return None;
        }
        let [u, v] = if distance > 0.0 { apart.map(|c| c / distance) } else { [0.0; 2] };
        let of_point = |[u, v]: [f64; 2]| [u, v, (t - 1.0) * u, (t - 1.0) * v, -t * u, -t * v];
        let curvature = if t == 0.0 || t == 1.0 {
            Curvature::End { across: of_point([-v, u]), distance }
        } else {
            let length = squared.sqrt();
            let [p, q] = [u / length, v / length];
            let turning = [0.0, 0.0, -p, -q, p, q];
            Curvature::Inner { turning, along: of_point(along.map(|c| c / length)), distance }
        };
        let vertices = [vertex, from, to];
        Some(Contact { vertices, gap: distance / reach, reach, slopes: of_point([u, v]), curvature })
    }

    /// The largest step up to `longest` along `direction` that takes no vertex through an edge.
    pub(super) fn longest_step(&self, map: &[[f64; 2]], direction: &[[f64; 2]], longest: f64) -> f64 {
        let path = |v: Vertex| {
            let (x, d) = (map[v], direction[v]);
            [x, [x[0] + longest * d[0], x[1] + longest * d[1]]]
        };
        let edges: Vec<Extent> =
            self.edges.iter().map(|edge| Extent::of(edge.ends.iter().flat_map(|&v| path(v)))).collect();
        let vertices: Vec<Extent> = self.vertices.iter().map(|&v| Extent::of(path(v).into_iter())).collect();
        let mut step = longest;
        for_each_overlap(&edges, &vertices, |edge, vertex| {
            if self.may_touch(edge, vertex) {
                let [a, b] = self.edges[edge].ends;
                let triple = [a, b, self.vertices[vertex]];
                let [at, along] = [map, direction].map(|of| triple.map(|v| of[v]));
                step = step.min(first_meeting(at, along, step).unwrap_or(step));
            }
        });
        step
    }

    /// True if no outline crosses or touches itself or another outline, decided exactly.
    pub(super) fn is_simple(&self, map: &[[f64; 2]]) -> bool {
        let corners: PlanarMap = self.vertices.iter().map(|&v| map[v]).collect();
        is_simple_outline(&corners, &self.next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriangleMesh;

    /// A strip of squares bent so that its ends come near to each other, with its outline.
    fn with_outline<R>(test: impl FnOnce(&Outline) -> R) -> R {
        let points: Vec<[f64; 3]> = (0..14).map(|k| [f64::from(k / 2), f64::from(k % 2), 0.0]).collect();
        let faces: Vec<[u32; 3]> =
            (0..6).flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]]).collect();
        let mesh = TriangleMesh::new(&points, &faces).unwrap();
        let energy = Energy::new(&mesh, mesh.face_areas());
        test(&Outline::new(&energy))
    }

    /// The strip around a ring whose ends are `gap` of a turn apart.
    fn ring(gap: f64) -> PlanarMap {
        (0..14)
            .map(|k| {
                let angle = -std::f64::consts::TAU * (1.0 - gap) * f64::from(k / 2) / 6.0;
                let radius = 0.28 + 0.25 * f64::from(k % 2);
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect()
    }

    #[test]
    fn derivatives_of_contacts_are_the_differences_of_their_value() {
        with_outline(|outline| {
            let map = ring(0.03);
            let stiffness = outline.stiffness(0.7);
            let along: PlanarMap = (0..14)
                .map(|v| [(0.4 + 3.0 * f64::from(v)).sin(), (2.0 + 5.0 * f64::from(v)).cos()])
                .collect();
            let moved = |step: f64| -> PlanarMap {
                (0..14).map(|v| [0, 1].map(|k| map[v][k] + step * along[v][k])).collect()
            };
            let contacts = outline.contacts(&map, 0.5);
            assert!(contacts.len() >= 2);
            let value = |step: f64| -> f64 {
                outline.contacts(&moved(step), 0.5).iter().map(|contact| contact.value(stiffness)).sum()
            };
            let (mut slope, mut curvature) = (0.0, 0.0);
            for contact in &contacts {
                let x: [f64; 6] = std::array::from_fn(|k| along[contact.vertices[k / 2]][k % 2]);
                let dot = |form: &[f64; 6]| form.iter().zip(&x).map(|(a, b)| a * b).sum::<f64>();
                let [first, second] = contact.derivatives(stiffness);
                slope += first * dot(&contact.slopes);
                curvature += second * dot(&contact.slopes).powi(2) + first * dot(&contact.curvature(&x));
            }
            let h = 1e-6;
            let difference = (value(h) - value(-h)) / (2.0 * h);
            assert!((slope - difference).abs() < 1e-5 * slope.abs(), "{slope} {difference}");
            let h = 1e-5;
            let difference = (value(h) + value(-h) - 2.0 * value(0.0)) / (h * h);
            assert!((curvature - difference).abs() < 1e-3 * curvature.abs(), "{curvature} {difference}");
        });
    }

    #[test]
    fn a_step_ends_where_the_outline_meets_itself() {
        with_outline(|outline| {
            let (map, beyond) = (ring(0.1), ring(-0.1));
            assert!(outline.is_simple(&map) && !outline.is_simple(&beyond));
            let along: PlanarMap = (0..14).map(|v| [0, 1].map(|k| beyond[v][k] - map[v][k])).collect();
            let step = outline.longest_step(&map, &along, 1.0);
            let moved = |step: f64| -> PlanarMap {
                (0..14).map(|v| [0, 1].map(|k| map[v][k] + step * along[v][k])).collect()
            };
            assert!(step > 0.1 && step < 0.9, "{step}");
            assert!(outline.is_simple(&moved(step - 1e-9)) && !outline.is_simple(&moved(step + 1e-9)));
            let back: PlanarMap = along.iter().map(|x| x.map(|c| -c)).collect();
            assert_eq!(outline.longest_step(&map, &back, 0.5), 0.5);
        });
    }

    #[test]
    fn an_outline_far_from_itself_has_no_contacts() {
        with_outline(|outline| assert!(outline.contacts(&ring(0.3), 0.25).is_empty()));
    }
}
