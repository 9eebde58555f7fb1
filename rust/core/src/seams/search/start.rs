// SPDX-License-Identifier: MIT OR Apache-2.0
//! The first cut, which leaves disks only.
//!
//! With a boundary or handles it is the cut graph. A closed surface of genus 0 is slit between two of its far points,
//! the pair that lowers the distortion most for the cost; on a symmetric mesh two points of the mirror curve, along it.

use super::{LEAST_ISLAND, Problem, Search, coarse};
use crate::control::Observer;
use crate::error::Error;
use crate::mesh::{Edge, Vertex};
use crate::seams::cut::Cut;
use crate::seams::cut_graph::cut_graph;
use crate::seams::edge_mesh::EdgeMesh;
use crate::seams::merge::{by_area, joined};
use crate::seams::paths::{Paths, far_points, far_points_within_reach};

/// The number of far points, and of those along the mirror curve.
const FAR_POINTS: usize = 6;
const CURVE_POINTS: usize = 10;

/// The part of the cost that counts beside the distortion.
const COST_SHARE: f64 = 0.1;

impl Search<'_> {
    /// A cut that leaves disks only.
    pub(super) fn first_cut(&mut self, observer: &mut dyn Observer) -> Result<Cut, Error> {
        let Problem { mesh, cost, given, .. } = self.problem;
        let is_sphere = mesh.mesh.euler_characteristic() == 2 && mesh.mesh.topology().is_closed();
        if given.is_empty() && is_sphere && self.problem.mirror.is_some() {
            let slits = self.slits_along_mirror();
            if !slits.is_empty() {
                return self.best_of(slits, observer);
            }
        }
        let cut = cut_graph(mesh, cost, given);
        if cut.islands(mesh).euler_characteristics.contains(&2) {
            let slits = self.slits_between_far_points(&cut);
            return self.best_of(slits, observer);
        }
        let cut = cut.with(&self.with_partners(&cut.seams().collect::<Vec<_>>()));
        Ok(self.absorb(cut))
    }

    /// The cheapest paths between far points.
    fn slits_between_far_points(&self, cut: &Cut) -> Vec<Cut> {
        let Problem { mesh, cost, .. } = self.problem;
        let points = far_points_within_reach(mesh, FAR_POINTS, cost);
        self.paths_between(&points, cost)
            .into_iter()
            .map(|path| cut.with(&self.with_partners(&path)))
            .filter(|cut| cut.islands(mesh).are_disks())
            .collect()
    }

    /// The paths between far points of the mirror curve, along it.
    fn slits_along_mirror(&self) -> Vec<Cut> {
        let Problem { mesh, cost, .. } = self.problem;
        let on_curve = mirror_curve(mesh, self.problem.mirror.unwrap_or_default());
        let Some(start) = mesh.edges.all().find(|&edge| on_curve[edge]) else { return Vec::new() };
        let along = |value: &[f64]| -> Vec<f64> {
            value.iter().zip(&on_curve).map(|(&x, &on)| if on { x } else { f64::INFINITY }).collect()
        };
        let start = mesh.edges.ends(start)[0];
        let points = far_points(mesh, start, CURVE_POINTS, &along(&mesh.lengths));
        self.paths_between(&points, &along(cost))
            .into_iter()
            .map(|path| Cut::none(mesh).with(&path))
            .filter(|cut| cut.islands(mesh).are_disks())
            .collect()
    }

    /// The cheapest paths of two edges or more between the points.
    fn paths_between(&self, points: &[Vertex], cost: &[f64]) -> Vec<Vec<Edge>> {
        let mesh = self.problem.mesh;
        let mut all = Vec::new();
        for (k, &from) in points.iter().enumerate() {
            let paths = Paths::from(mesh, &[from], cost);
            all.extend(points[k + 1..].iter().map(|&to| paths.to(mesh, to)).filter(|path| path.len() > 1));
        }
        all
    }

    /// The cut of least distortion and cost.
    fn best_of(&mut self, cuts: Vec<Cut>, observer: &mut dyn Observer) -> Result<Cut, Error> {
        let Problem { mesh, plate, cost, .. } = self.problem;
        let this = &*self;
        let prices = this.for_each(cuts.len(), observer, |k, workspace, watch| {
            let deflection = plate.solve(mesh, &cuts[k], None, workspace, watch)?;
            Ok(coarse(this.distortion(&deflection.shear) + COST_SHARE * cuts[k].sum(cost)))
        })?;
        let best = prices.iter().zip(&cuts).min_by(|a, b| a.0.total_cmp(b.0));
        Ok(best.map_or_else(|| Cut::none(mesh), |(_, cut)| cut.clone()))
    }

    /// The cut without islands that are too small or too many: each joins the neighbor with which it shares most.
    fn absorb(&self, mut cut: Cut) -> Cut {
        let Problem { mesh, cost, given, max_islands, .. } = self.problem;
        loop {
            let islands = cut.islands(mesh);
            let mut order = by_area(&islands);
            order.retain(|&k| islands.areas[k] < LEAST_ISLAND || islands.len() > max_islands);
            if islands.len() < 2 {
                return cut;
            }
            let with_partners = |edges: &[Edge]| self.with_partners(edges);
            let joined = order
                .into_iter()
                .find_map(|island| joined(mesh, cost, (&cut, given), &islands, island, with_partners));
            match joined {
                Some(joined) => cut = joined,
                None => return cut,
            }
        }
    }
}

/// Whether each edge lies in the mirror plane: it is its own mirror image, and its neighbors mirror each other.
fn mirror_curve(mesh: &EdgeMesh, mirror: &[Edge]) -> Vec<bool> {
    let is_fixed = |edge: Edge| mirror[edge] == edge;
    mesh.edges
        .all()
        .map(|edge| {
            let (corner, _) = mesh.edges.sides(edge);
            // an edge that crosses the plane is its own image too, but then its faces are their own as well
            let beside = mesh.edges.opposite_to(corner.next());
            is_fixed(edge) && !mesh.edges.is_boundary(edge) && crosses(mesh, edge, mirror[beside]).is_none()
        })
        .collect()
}

/// The edge itself where the other edge bounds the first face beside it.
fn crosses(mesh: &EdgeMesh, edge: Edge, other: Edge) -> Option<Edge> {
    let face = mesh.faces_at(edge).0;
    (0..3).any(|k| mesh.edge_of(face, k) == other).then_some(edge)
}
