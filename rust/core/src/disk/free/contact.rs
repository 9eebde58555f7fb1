// SPDX-License-Identifier: MIT OR Apache-2.0
//! Contacts of an outline with itself: an energy that repels near boundaries, and a bound on every step.
//!
//! A boundary vertex v and a boundary edge e that is neither at v nor opposite to it in its face cost κ h l b(d / h)
//! where their distance d is below h, b(x) = −(x − 1)² ln x, as in M. Li et al., Incremental potential contact, ACM
//! Trans. Graph. 39 (2020); h is a part of the least height of the rest triangles beside both, so that a thin strip
//! does not repel itself, and l the median edge of the outline. The energy has compact support: an outline that does
//! not come near to itself is not changed. A sweep over boxes finds the pairs. Cost: O(n log n) and one comparison for
//! every two boxes that overlap in x.

use crate::codomain::planar::PlanarMap;
use crate::mesh::Vertex;

/// A vertex near an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// The vertex and the ends of the edge.
    pub vertices: [Vertex; 3],
    /// d / h, below 1.
    pub gap: f64,
    /// h.
    pub reach: f64,
    /// The derivatives of d by the positions of the three vertices.
    pub slopes: [f64; 6],
    /// The second derivative of d as a bilinear form.
    pub curvature: Curvature,
}

/// The second derivative of the distance d of a point and an edge.
#[derive(Debug, Clone, Copy)]
pub(super) enum Curvature {
    /// Beside an end: q qᵀ / d, with the motion q across.
    End { across: [f64; 6], distance: f64 },
    /// Beside the edge: −(p qᵀ + q pᵀ) − d p pᵀ, with the turning p of the edge and the motion q of the point along it.
    Inner { turning: [f64; 6], along: [f64; 6], distance: f64 },
}

/// The strength of contacts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stiffness {
    /// κ l.
    pub factor: f64,
}

impl Curvature {
    /// The distance of the point and the edge.
    pub(super) fn distance(&self) -> f64 {
        match self {
            Self::End { distance, .. } | Self::Inner { distance, .. } => *distance,
        }
    }
}

/// Adds the forces of contacts, the first of each pair of springs, to a gradient.
pub(super) fn add_forces(gradient: &mut PlanarMap, contacts: &[Contact], springs: &[[f64; 2]]) {
    for (contact, [force, _]) in contacts.iter().zip(springs) {
        for (k, &v) in contact.vertices.iter().enumerate() {
            (0..2).for_each(|axis| gradient[v][axis] += force * contact.slopes[2 * k + axis]);
        }
    }
}

impl Contact {
    /// d, negative beyond the edge.
    pub(super) fn distance(&self) -> f64 {
        self.gap * self.reach
    }

    /// The energy of the contact; infinite where vertex and edge meet.
    pub(super) fn value(&self, stiffness: Stiffness) -> f64 {
        stiffness.factor * self.reach * -(self.gap - 1.0).powi(2) * self.gap.ln()
    }

    /// The first and second derivative of the energy by the distance.
    pub(super) fn derivatives(&self, stiffness: Stiffness) -> [f64; 2] {
        let (x, y, log) = (self.gap, self.gap - 1.0, self.gap.ln());
        let first = -2.0 * y * log - y * y / x;
        let second = -2.0 * log - 4.0 * y / x + y * y / (x * x);
        [stiffness.factor * first, stiffness.factor / self.reach * second]
    }

    /// The second derivative of the distance times the motion `x` of the three vertices.
    pub(super) fn curvature(&self, x: &[f64; 6]) -> [f64; 6] {
        let dot = |form: &[f64; 6]| form.iter().zip(x).map(|(a, b)| a * b).sum::<f64>();
        match &self.curvature {
            Curvature::End { across, distance } => {
                let by = dot(across) / distance;
                across.map(|c| by * c)
            }
            Curvature::Inner { turning, along, distance } => {
                let (turned, moved) = (dot(turning), dot(along));
                std::array::from_fn(|k| -turned * along[k] - (moved + distance * turned) * turning[k])
            }
        }
    }

    /// The least height beside the vertex and the edge; `range` is that of the search.
    pub(super) fn height_of_reach(&self, range: f64) -> f64 {
        self.reach / range
    }

    /// The first-order gain if the distance fell to zero.
    pub(super) fn possible_gain(&self, stiffness: Stiffness) -> f64 {
        -self.derivatives(stiffness)[0] * self.gap * self.reach
    }
}
