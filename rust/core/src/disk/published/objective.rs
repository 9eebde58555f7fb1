// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps to the unit disk as a [`Objective`]: interior vertices in the plane, boundary vertices held or sliding
//! on the circle.
//!
//! Reduced coordinates: first coordinates of the interior vertices, then their second ones, then, where the
//! boundary slides, one angle per boundary vertex. The preconditioner is the block diagonal of the frozen
//! quadratic form E_S ≈ fᵀ(I₂ ⊗ L_S(f⁰))f: the paper's M = I₂ ⊗ [L_S(f⁰)]_II twice over one factor, and the
//! boundary block projected on the tangents of the circle.

use std::f64::consts::PI;

use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::disk::boundary::ArcBarrier;
use crate::disk::options::Boundary;
use crate::disk::{boundary, certificate};
use crate::energy::StretchEnergy;
use crate::energy::stretch::{Profile, Value};
use crate::error::Error;
use crate::mesh::{TriangleMesh, Vertex};
use crate::optimize::published::{Energies, Objective};
use crate::parallel;
use crate::sparse::{Cholesky, Laplacian, solve_dirichlet};

/// A Laplacian with its factor.
#[derive(Debug)]
struct Block {
    laplacian: Laplacian,
    factor: Cholesky,
}

impl Block {
    fn analyze(mesh: &TriangleMesh, laplacian: Laplacian) -> Result<Self, Error> {
        let factor = Cholesky::analyze_on(mesh, laplacian.matrix())?;
        Ok(Self { laplacian, factor })
    }
}

/// The parts of a sliding boundary: its block of the preconditioner, and the barrier that keeps its arcs open.
#[derive(Debug)]
struct SlidingBoundary {
    block: Block,
    barrier: ArcBarrier,
}

/// Maps of one mesh to the unit disk.
#[derive(Debug)]
pub(crate) struct DiskObjective<'a> {
    mesh: &'a TriangleMesh,
    energy: StretchEnergy<'a>,
    interior: Block,
    /// Only where the boundary slides.
    boundary: Option<SlidingBoundary>,
    /// The map at which the preconditioner was set; empty where it was not.
    preconditioned_at: PlanarMap,
    /// Maps with a folded face have an infinite objective.
    guarded: bool,
}

impl<'a> DiskObjective<'a> {
    /// Analyzes the systems of the domain; the preconditioner must be set before it is used.
    pub(crate) fn new(mesh: &'a TriangleMesh, targets: &'a [f64], boundary: Boundary) -> Result<Self, Error> {
        let interior = Block::analyze(mesh, Laplacian::new(mesh, |vertex| !mesh.is_boundary(vertex)))?;
        let boundary = match boundary {
            Boundary::ArcLength | Boundary::Free | Boundary::Rectangle => None,
            Boundary::Sliding => {
                let block = Block::analyze(mesh, Laplacian::new(mesh, |vertex| mesh.is_boundary(vertex)))?;
                Some(SlidingBoundary { block, barrier: ArcBarrier::new(mesh) })
            }
        };
        let energy = StretchEnergy::new(mesh, targets);
        Ok(Self { mesh, energy, interior, boundary, preconditioned_at: PlanarMap::new(), guarded: false })
    }

    /// Solves L_II f_I = −L_IB f_B in place for one weight per corner, the boundary held.
    pub(crate) fn solve_dirichlet(
        &mut self,
        weights: &[f64],
        map: &mut [[f64; 2]],
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        self.preconditioned_at.clear();
        let Block { laplacian, factor } = &mut self.interior;
        solve_dirichlet(self.mesh, laplacian, factor, weights, map, watch)
    }

    /// From now on a map with a folded face has an infinite objective, and one near to folding a large one.
    pub(super) fn guard(&mut self) {
        self.guarded = true;
        self.preconditioned_at.clear();
        self.energy = self.energy.with_profile(Profile::Barrier);
    }

    /// Sets M = 2 I₂ ⊗ L_S(f) at f = `map`.
    pub(super) fn set_preconditioner(&mut self, map: &[[f64; 2]], watch: &Watch<'_>) -> Result<(), Error> {
        if self.preconditioned_at == map {
            return Ok(());
        }
        self.preconditioned_at.clear();
        let scale = 2.0 * PI / self.energy.area(map);
        let mut weights = self.energy.laplacian_weights(map);
        parallel::fill_with_old(&mut weights, |_, weight| scale * weight);
        self.interior.laplacian.assemble(self.mesh, &weights);
        self.interior.factor.refactor_while(self.interior.laplacian.matrix(), watch)?;
        if let Some(SlidingBoundary { block: Block { laplacian, factor }, .. }) = &mut self.boundary {
            let cosine = |i: Vertex, j: Vertex| map[i][0] * map[j][0] + map[i][1] * map[j][1];
            laplacian.assemble_scaled(self.mesh, &weights, cosine);
            factor.refactor_while(laplacian.matrix(), watch)?;
        }
        self.preconditioned_at = map.to_vec();
        Ok(())
    }

    /// True if some face of `map` is nearly folded.
    pub(super) fn nearly_folds(&self, map: &[[f64; 2]]) -> bool {
        certificate::nearly_folded(&self.energy.areas(map), self.energy.targets())
    }

    fn free(&self) -> &[Vertex] {
        self.interior.laplacian.free()
    }

    /// Vertices that slide, in the order of their angles in reduced coordinates.
    fn sliding(&self) -> &[Vertex] {
        self.boundary.as_ref().map_or(&[], |boundary| boundary.block.laplacian.free())
    }

    /// The objective with the cost of short arcs; +∞ where the map is not allowed.
    fn full_objective(&self, map: &[[f64; 2]], value: Value) -> f64 {
        if value.area <= 0.0 || (self.guarded && !certificate::clearly_unfolded(self.mesh, map)) {
            return f64::INFINITY;
        }
        match (&self.boundary, self.arcs(map)) {
            (None, _) => value.objective,
            (Some(boundary), Some(arcs)) => value.objective + boundary.barrier.value(&arcs),
            (Some(_), None) => f64::INFINITY,
        }
    }

    fn arcs(&self, map: &[[f64; 2]]) -> Option<Vec<f64>> {
        boundary::arcs(&self.mesh.boundary_loops()[0], map)
    }

    /// Adds the slopes of the arc barrier to the gradient by angles, in the order of the unknowns.
    fn add_barrier(&self, map: &[[f64; 2]], by_angle: &mut [f64]) {
        let (Some(boundary), Some(arcs)) = (&self.boundary, self.arcs(map)) else {
            return;
        };
        for (&vertex, slope) in self.mesh.boundary_loops()[0].iter().zip(boundary.barrier.slopes(&arcs)) {
            let unknown = boundary.block.laplacian.unknown(vertex);
            by_angle[unknown.expect("boundary vertices slide")] += slope;
        }
    }
}

impl Objective for DiskObjective<'_> {
    type Map = PlanarMap;

    fn value(&self, map: &Self::Map) -> f64 {
        self.full_objective(map, self.energy.value(map))
    }

    fn gradient(&self, map: &Self::Map) -> (Energies, Vec<f64>) {
        let (value, gradient) = self.energy.gradient(map);
        let energies =
            Energies { objective: self.full_objective(map, value), authalic_energy: value.authalic_energy };
        let free = self.free().iter().copied();
        let along_circle = |&v: &Vertex| {
            let ([u, w], g) = (map[v], gradient[v]);
            u * g[1] - w * g[0]
        };
        let plane = free.clone().map(|v| gradient[v][0]).chain(free.map(|v| gradient[v][1]));
        let mut reduced: Vec<f64> = plane.chain(self.sliding().iter().map(along_circle)).collect();
        self.add_barrier(map, &mut reduced[2 * self.free().len()..]);
        (energies, reduced)
    }

    fn precondition(&self, _map: &PlanarMap, gradient: &[f64]) -> Vec<f64> {
        let mut h = gradient.to_vec();
        let (plane, angles) = h.split_at_mut(2 * self.free().len());
        self.interior.factor.solve(plane);
        if let Some(boundary) = &self.boundary {
            boundary.block.factor.solve(angles);
        }
        h
    }

    fn retract(&self, map: &Self::Map, direction: &[f64], step: f64) -> Self::Map {
        let mut moved = map.clone();
        let n = self.free().len();
        for (i, &vertex) in self.free().iter().enumerate() {
            moved[vertex][0] += step * direction[i];
            moved[vertex][1] += step * direction[n + i];
        }
        for (&vertex, angle) in self.sliding().iter().zip(&direction[2 * n..]) {
            let ([u, v], (sine, cosine)) = (map[vertex], (step * angle).sin_cos());
            let (x, y) = (cosine * u - sine * v, sine * u + cosine * v);
            let length = x.hypot(y);
            moved[vertex] = [x / length, y / length];
        }
        moved
    }
}
