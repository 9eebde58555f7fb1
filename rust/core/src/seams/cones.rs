// SPDX-License-Identifier: MIT OR Apache-2.0
//! A quick cut: cones joined by cheapest paths.
//!
//! 1. Cones, greedily: the membrane Δu = κ with the angle defect κ as load and u = 0 at the cones and on the boundary
//!    is solved, and the vertex of largest |u| becomes the next cone.
//! 2. The cones are joined to the borders in that order, each by the cheapest path, until the plate predicts the
//!    wanted shear.
//!
//! The cut is some percent longer than what the search makes of it, and comes after some twenty solves: the preview
//! while a slider moves.

use super::cut::Cut;
use super::cut_graph::cut_graph;
use super::edge_mesh::EdgeMesh;
use super::paths::{Paths, first_of_largest_part};
use super::progress::MESSAGE;
use super::search::{Problem, Search, State, coarse};
use crate::control::{Observer, Watch};
use crate::error::Error;
use crate::mesh::geometry::corner_cotangents;
use crate::mesh::{Edge, Vertex};
use crate::sparse::Cholesky;
use sprs::CsMat;

/// The most cones.
const MOST_CONES: usize = 60;

impl Search<'_> {
    /// The cut through as few cones as meet the target.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`], or a failed factorization.
    pub(super) fn through_cones(&mut self, observer: &mut dyn Observer) -> Result<State, Error> {
        let Problem { mesh, cost, given, target, bound, .. } = self.problem();
        let mut cut = cut_graph(mesh, cost, given);
        let cones = cones(mesh, &cut, observer)?;
        let within_reach = Paths::from(mesh, &[first_of_largest_part(mesh, cost)], cost).costs;
        let first = cones.iter().copied().find(|&cone| within_reach[cone].is_finite()).unwrap_or_default();
        let mut left = cones.iter();
        let mut state: Option<State> = None;
        loop {
            if cut.islands(mesh).are_disks() {
                let next = self.state(cut.clone(), observer)?;
                let figures = self.figures(&next.shear);
                state = Some(next);
                if figures.mean <= target && figures.percentile <= bound {
                    break;
                }
            }
            let Some(path) = left.find_map(|&cone| self.path_to(cone, &cut, first)) else { break };
            cut.add(&path);
        }
        match state {
            Some(state) => Ok(state),
            None => self.state(cut, observer),
        }
    }

    /// The cheapest path to a cone from the borders, with its mirror image, unless it makes too many islands; on a closed
    /// surface from the first cone.
    fn path_to(&self, cone: Vertex, cut: &Cut, first: Vertex) -> Option<Vec<Edge>> {
        let Problem { mesh, cost, max_islands, .. } = self.problem();
        let on_border = cut.border_vertices(mesh);
        let borders: Vec<_> = Vertex::all(mesh.n_vertices()).filter(|&vertex| on_border[vertex]).collect();
        let sources = if borders.is_empty() { vec![first] } else { borders };
        let path = Paths::from(mesh, &sources, cost).to(mesh, cone);
        let path = self.with_partners(&path);
        let n_islands = |cut: &Cut| cut.islands(mesh).len();
        let is_allowed = || n_islands(&cut.with(&path)) <= n_islands(cut).max(max_islands);
        (!path.is_empty() && is_allowed()).then_some(path)
    }
}

/// The cones, the first first.
fn cones(mesh: &EdgeMesh, cut: &Cut, observer: &mut dyn Observer) -> Result<Vec<Vertex>, Error> {
    let defects = mesh.angle_defects();
    let on_border = cut.border_vertices(mesh);
    let mut is_pinned = on_border;
    let mut cones = Vec::with_capacity(MOST_CONES);
    if !is_pinned.contains(&true) {
        let largest =
            |a: Vertex, b: Vertex| if coarse(defects[b].abs()) > coarse(defects[a].abs()) { b } else { a };
        let first = Vertex::all(mesh.n_vertices()).fold(Vertex(0), largest);
        is_pinned[first] = true;
        cones.push(first);
    }
    let laplacian = laplacian(mesh);
    let mut factor = Cholesky::analyze(&laplacian)?;
    let mut masked = laplacian.clone();
    while cones.len() < MOST_CONES.min(mesh.n_vertices() / 4) {
        mask(&laplacian, &is_pinned, &mut masked);
        let watch = Watch::new(&mut *observer, 0.0, MESSAGE);
        factor.refactor_while(&masked, &watch)?;
        let mut u: Vec<_> = defects
            .iter()
            .zip(&is_pinned)
            .map(|(&defect, &pinned)| if pinned { 0.0 } else { defect })
            .collect();
        factor.solve(&mut u);
        let largest = |a: Vertex, b: Vertex| if coarse(u[b].abs()) > coarse(u[a].abs()) { b } else { a };
        let next = Vertex::all(mesh.n_vertices()).fold(Vertex(0), largest);
        is_pinned[next] = true;
        cones.push(next);
    }
    Ok(cones)
}

/// The cotangent Laplacian, upper triangle, positive semidefinite but for obtuse angles.
fn laplacian(mesh: &EdgeMesh) -> CsMat<f64> {
    let cotangents = corner_cotangents(mesh.mesh.points(), mesh.mesh.faces());
    let n = mesh.n_vertices();
    let weight = |edge| {
        let (first, second) = mesh.edges.sides(edge);
        let half = |corner: crate::mesh::Corner| 0.5 * cotangents[corner.face()][corner.place()];
        half(first) + second.map_or(0.0, half)
    };
    let mut triplets = sprs::TriMat::new((n, n));
    let mut diagonal = vec![0.0; n];
    for edge in mesh.edges.all() {
        let ([a, b], weight) = (mesh.edges.ends(edge), weight(edge));
        triplets.add_triplet(a.index(), b.index(), -weight);
        diagonal[a] += weight;
        diagonal[b] += weight;
    }
    diagonal.iter().enumerate().for_each(|(k, &value)| triplets.add_triplet(k, k, value));
    triplets.to_csc()
}

/// Masks the rows and columns of pins.
fn mask(matrix: &CsMat<f64>, is_pinned: &[bool], masked: &mut CsMat<f64>) {
    for (value, (&entry, (row, column))) in masked.data_mut().iter_mut().zip(matrix.iter()) {
        *value = match (is_pinned[row] || is_pinned[column], row == column) {
            (true, true) => 1.0,
            (true, false) => 0.0,
            _ => entry,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::mesh::TriangleMesh;
    use crate::seams::plate::Plate;
    use crate::seams::sample_surfaces::{body, cube, flat_grid, perforated_cylinder, torus};

    fn through_cones(surface: TriangleMesh, target: f64) -> (EdgeMesh, State, f64) {
        let mesh = EdgeMesh::new(surface);
        let (plate, given) = (Plate::new(&mesh).unwrap(), Cut::none(&mesh));
        let bound = 1.0 + 6.0 * (target - 1.0);
        let (cost, given, mirror) = (&mesh.lengths[..], &given, None);
        let problem = Problem {
            mesh: &mesh,
            plate: &plate,
            cost,
            mirror,
            parts: None,
            least_rate: 0.0,
            given,
            max_islands: 9,
            target,
            bound,
        };
        let mut search = Search::new(problem);
        let state = search.through_cones(&mut Silent).unwrap();
        let mean = search.figures(&state.shear).mean;
        (mesh, state, mean)
    }

    #[test]
    fn cuts_through_cones_meet_the_target_and_leave_disks() {
        for surface in [cube(8), body(4), torus(), perforated_cylinder()] {
            for target in [1.25, 1.4] {
                let (mesh, state, mean) = through_cones(surface.clone(), target);
                let islands = state.cut.islands(&mesh);
                assert!(islands.are_disks());
                assert_eq!(islands.len(), state.n_islands);
                assert!(mean <= target, "{mean}");
            }
        }
    }

    #[test]
    fn what_is_flat_needs_no_cone() {
        let (_, state, mean) = through_cones(flat_grid(9, 7), 1.1);
        assert!(state.cut.is_empty() && mean < 1.0 + 1e-9);
    }

    #[test]
    fn a_lower_target_needs_longer_seams() {
        let [long, short] = [1.15, 1.5].map(|target| {
            let (mesh, state, _) = through_cones(body(4), target);
            state.cut.sum(&mesh.lengths)
        });
        assert!(long > short);
    }

    #[test]
    fn the_cones_of_a_cube_are_its_corners() {
        let mesh = EdgeMesh::new(cube(6));
        let mut corners = cones(&mesh, &Cut::none(&mesh), &mut Silent).unwrap();
        corners.truncate(8);
        let defects = mesh.angle_defects();
        assert!(corners.iter().all(|&corner| (defects[corner] - 0.5 * std::f64::consts::PI).abs() < 1e-9));
    }
}
