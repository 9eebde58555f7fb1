// SPDX-License-Identifier: MIT OR Apache-2.0
//! An elastic deformation of a surface on the sphere that brings its signals to those of another.
//!
//! It minimizes Σ a_v |s(v) − t(x_v)|² + μ ∫ |∇d|² / 4π over the places x_v of the vertices, with the displacements d
//! from the start, by Gauss–Newton. a_v is the vertex's share of the surface's area. No step folds a face.

use super::smoothing::bounded_cotangents;
use super::sphere_signals::{SpherePlace, SphereSignals};
use crate::codomain::motion::{Frame, Motion, frames};
use crate::control::Watch;
use crate::distortion::folded_on_sphere;
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure, Order};
use crate::vector::Vector3;

/// μ, in units of the signals' variances.
const STIFFNESS: f64 = 1.0;
/// Most steps for signals of one smoothness.
const STEPS: usize = 10;
/// A step that gains less than this part of the energy is the last.
const LEAST_GAIN: f64 = 2e-3;
/// Halvings of a step that folds a face or does not lower the energy.
const HALVINGS: usize = 6;
/// Added to the diagonal, relative to the stiffness, against turns of the whole that no signal resists.
const SHIFT: f64 = 1e-9;

/// The deformation of a surface.
pub(super) struct Elastic<'a> {
    mesh: &'a TriangleMesh,
    start: Vec<Vector3>,
    /// The vertices as they are.
    pub map: Vec<Vector3>,
    /// (m, 3): the stiffness of the edge opposite to each corner.
    stiffness: Vec<[f64; 3]>,
    /// The vertices' shares of the area.
    shares: Vec<f64>,
    analysis: Analysis,
}

/// The signals of both surfaces at a map.
struct State {
    places: Vec<SpherePlace>,
    energy: f64,
}

impl<'a> Elastic<'a> {
    pub(super) fn new(mesh: &'a TriangleMesh, start: Vec<Vector3>) -> Result<Self, Error> {
        let n = mesh.n_vertices();
        let stiffness = bounded_cotangents(mesh.faces(), &start)
            .into_iter()
            .map(|face| face.map(|cotangent| STIFFNESS * 0.5 * cotangent / (4.0 * std::f64::consts::PI)))
            .collect();
        let areas = mesh.vertex_shares(mesh.face_areas());
        let total: f64 = areas.iter().sum();
        let shares = areas.iter().map(|area| area / total).collect();
        let analysis = Analysis::new(n, mesh.faces(), &vec![2; n], Order::Sparse)?;
        Ok(Self { mesh, map: start.clone(), start, stiffness, shares, analysis })
    }

    /// Lowers the energy for `signals`, `width` at each vertex; false if cancelled.
    pub(super) fn descend(&mut self, signals: &[f64], target: &SphereSignals<'_>, watch: &Watch<'_>) -> bool {
        let places = parallel::map(self.map.len(), |v| target.place(self.map[v]));
        let mut state = self.state(&self.map, signals, target, &places);
        let mut factor = Factor::<f64>::new(&self.analysis);
        for _ in 0..STEPS {
            let direction = match self.direction(&mut factor, signals, target, &state, watch) {
                Ok(direction) => direction,
                Err(Failure::Cancelled) => return false,
                Err(Failure::NotPositiveDefinite) => return true,
            };
            let Some((map, next)) = self.step(&direction, signals, target, &state) else { return true };
            let gain = state.energy - next.energy;
            (self.map, state) = (map, next);
            if gain <= LEAST_GAIN * state.energy {
                break;
            }
        }
        watch.goes_on()
    }

    /// The energy of a map whose places are near the given ones.
    fn state(
        &self,
        map: &[Vector3],
        signals: &[f64],
        target: &SphereSignals<'_>,
        near: &[SpherePlace],
    ) -> State {
        let places = parallel::map(map.len(), |v| target.place_near(map[v], near[v]));
        let width = target.width;
        let differences = parallel::sum(map.len(), |v| {
            let square = |signal| (signals[v * width + signal] - target.value(&places[v], signal)).powi(2);
            self.shares[v] * (0..width).map(square).sum::<f64>()
        });
        let faces = self.mesh.faces();
        let strain = parallel::sum(faces.len(), |face| {
            let moved = faces[face].map(|vertex| map[vertex] - self.start[vertex]);
            let square = |c: usize| {
                let along = moved[(c + 1) % 3] - moved[(c + 2) % 3];
                self.stiffness[face][c] * along.dot(along)
            };
            square(0) + square(1) + square(2)
        });
        State { places, energy: differences + strain }
    }

    /// The Gauss–Newton direction, a vector at each vertex.
    fn direction(
        &self,
        factor: &mut Factor<f64>,
        signals: &[f64],
        target: &SphereSignals<'_>,
        state: &State,
        watch: &Watch<'_>,
    ) -> Result<Vec<Vector3>, Failure> {
        let n = self.map.len();
        let frames = frames(&vec![Motion::Sphere; n], &self.map);
        let pulls = parallel::map(n, |v| self.pull(v, &frames[v], signals, target, &state.places[v]));
        let element = |face: usize| self.element(face, &frames, &pulls);
        factor.refactor(&self.analysis, &element, watch)?;
        let mut unknowns: Vec<f64> = parallel::map(n, |v| self.slope(v, &frames[v], &pulls[v])).concat();
        factor.solve(&self.analysis, &mut unknowns);
        Ok(parallel::map(n, |v| {
            frames[v].axes[0] * unknowns[2 * v] + frames[v].axes[1] * unknowns[2 * v + 1]
        }))
    }

    /// What the signals at a vertex add to the system.
    fn pull(
        &self,
        vertex: usize,
        frame: &Frame,
        signals: &[f64],
        target: &SphereSignals<'_>,
        place: &SpherePlace,
    ) -> Pull {
        let mut pull = Pull::default();
        for signal in 0..target.width {
            let residual = signals[vertex * target.width + signal] - target.value(place, signal);
            let gradient = target.gradient(place, self.map[vertex], signal);
            let slopes = frame.axes.map(|axis| axis.dot(gradient));
            for a in 0..2 {
                (0..2).for_each(|b| pull.hessian[a][b] += self.shares[vertex] * slopes[a] * slopes[b]);
                pull.force[a] += self.shares[vertex] * slopes[a] * residual;
            }
        }
        pull
    }

    /// The force on a vertex along its frame: of its signals and of the stiffness.
    fn slope(&self, vertex: usize, frame: &Frame, pull: &Pull) -> [f64; 2] {
        let faces = self.mesh.faces();
        let mut force = Vector3::ZERO;
        for corner in self.mesh.vertex_corners(crate::mesh::Vertex::new(vertex)) {
            for (neighbor, facing) in [(corner.next(), corner.previous()), (corner.previous(), corner.next())]
            {
                let other = neighbor.vertex(faces);
                let stretch = (self.map[other] - self.start[other]) - (self.map[vertex] - self.start[vertex]);
                force += stretch * self.stiffness[facing.face()][facing.place()];
            }
        }
        [0, 1].map(|a| pull.force[a] + frame.axes[a].dot(force))
    }

    /// The matrix of a face.
    fn element(&self, face: usize, frames: &[Frame], pulls: &[Pull]) -> [[f64; 6]; 6] {
        let corners = self.mesh.faces()[face];
        let mut element = [[0.0; 6]; 6];
        for c in 0..3 {
            let (i, j) = ((c + 1) % 3, (c + 2) % 3);
            let stiffness = self.stiffness[face][c];
            for a in 0..2 {
                element[2 * i + a][2 * i + a] += stiffness * (1.0 + SHIFT);
                element[2 * j + a][2 * j + a] += stiffness * (1.0 + SHIFT);
                for b in 0..2 {
                    let across = frames[corners[i]].axes[a].dot(frames[corners[j]].axes[b]);
                    element[2 * i + a][2 * j + b] -= stiffness * across;
                    element[2 * j + b][2 * i + a] -= stiffness * across;
                }
            }
            let share = 1.0 / self.mesh.vertex_corners(corners[c]).len() as f64;
            for a in 0..2 {
                (0..2).for_each(|b| element[2 * c + a][2 * c + b] += share * pulls[corners[c]].hessian[a][b]);
            }
        }
        element
    }

    /// The longest step along a direction that lowers the energy and folds nothing, if any.
    fn step(
        &self,
        direction: &[Vector3],
        signals: &[f64],
        target: &SphereSignals<'_>,
        state: &State,
    ) -> Option<(Vec<Vector3>, State)> {
        (0..=HALVINGS).find_map(|halvings| {
            let length = 0.5f64.powi(halvings as i32);
            let map = parallel::map(self.map.len(), |v| (self.map[v] + direction[v] * length).normalized());
            let next = self.state(&map, signals, target, &state.places);
            let is_good = next.energy < state.energy && folded_on_sphere(self.mesh.faces(), &map).is_empty();
            is_good.then_some((map, next))
        })
    }
}

/// The normal equations of the signals at a vertex.
#[derive(Debug, Clone, Default)]
struct Pull {
    hessian: [[f64; 2]; 2],
    force: [f64; 2],
}
