// SPDX-License-Identifier: MIT OR Apache-2.0
//! A multifrontal Cholesky factorization for systems on the vertices of a mesh.
//!
//! J. W. H. Liu, The multifrontal method for sparse matrix solution, SIAM Review 34 (1992). The matrix is a sum of
//! small dense elements (of faces, or single entries). It is eliminated along a tree of dense fronts: each takes its
//! elements and the updates of its children, eliminates its own columns, and leaves an update for its parent.
//! Subtrees are independent and run on threads of their own; within a front all additions have a fixed order, so the
//! result does not depend on the number of threads.
//!
//! Input: the cliques of the unknowns' graph, and for each factorization their matrices. Cost for the n vertices of a
//! surface: about n log n numbers and n^1.5 multiplications.

pub(super) mod dense;
#[cfg(all(feature = "metis", not(windows)))]
mod dissection;
mod elimination;
mod fronts;
mod graph;
mod kernels;
mod numeric;
mod schedule;
mod solve;

use super::faer::{Scalar, minimum_degree};
use crate::control::Watch;
use crate::error::Error;
use crate::memory;
use crate::mesh::Vertex;
pub(crate) use dense::Failure;
use elimination::Elimination;
pub(super) use fronts::Element;
use fronts::Fronts;
use graph::Graph;
pub(super) use graph::NONE;
#[cfg(test)]
pub(crate) use kernels::processor;
pub(super) use numeric::Place;

/// What a Newton step keeps, its factor among it, in factors: a little more than was measured on squares, and half as
/// much again as on strips.
const FACTORS_OF_A_STEP: f64 = 2.75;

/// The elimination order of the nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    /// An order computed to keep the factor sparse.
    Sparse,
    /// The given order: that of a mesh in [`elimination_order`], or of some of its vertices.
    AsGiven,
}

/// The vertices of a mesh in an order that keeps factors sparse, every subtree of the elimination tree contiguous.
///
/// # Errors
/// [`NumericsError::FactorizationFailed`](crate::NumericsError::FactorizationFailed) where the mesh is too large for
/// 32-bit indices.
pub(crate) fn elimination_order(n_vertices: usize, faces: &[[Vertex; 3]]) -> Result<Vec<Vertex>, Error> {
    let cliques: Vec<_> = faces.iter().map(|face| face.map(|vertex| vertex.0)).collect();
    let graph = Graph::of_cliques(n_vertices, &cliques);
    let order = fill_reducing_order(&graph)?;
    let tree = Elimination::new(&graph, &order, &vec![1; n_vertices]);
    Ok(tree.order.into_iter().map(Vertex).collect())
}

/// The pattern of the factor for one mesh and the unknowns of its vertices.
#[derive(Debug, Clone)]
pub(crate) struct Analysis {
    /// The first unknown of each vertex, then the number of unknowns.
    first_unknown: Vec<u32>,
    symbolic: Symbolic,
}

impl Analysis {
    /// Orders and analyzes the matrices that faces assemble, `dofs[v]` (0 where it is held, 1 or 2) unknowns at vertex
    /// v.
    ///
    /// The unknowns are numbered by ascending vertex.
    ///
    /// # Errors
    /// [`NumericsError::FactorizationFailed`](crate::NumericsError::FactorizationFailed) where the mesh is too large
    /// for 32-bit indices, and [`NumericsError::ArraysOutOfMemory`](crate::NumericsError::ArraysOutOfMemory) where
    /// there is no memory for the factor.
    pub(crate) fn new(
        n_vertices: usize,
        faces: &[[Vertex; 3]],
        dofs: &[u8],
        order: Order,
    ) -> Result<Self, Error> {
        debug_assert_eq!(n_vertices, dofs.len());
        let mut first_unknown = vec![0; n_vertices + 1];
        let mut node_of = vec![NONE; n_vertices];
        let mut node_dofs = Vec::with_capacity(n_vertices);
        for vertex in 0..n_vertices {
            first_unknown[vertex + 1] = first_unknown[vertex] + u32::from(dofs[vertex]);
            if dofs[vertex] > 0 {
                node_of[vertex] = node_dofs.len() as u32;
                node_dofs.push(dofs[vertex]);
            }
        }
        let cliques: Vec<[u32; 3]> = faces.iter().map(|face| face.map(|vertex| node_of[vertex])).collect();
        let symbolic = Symbolic::new(&cliques, &node_dofs, order)?;
        symbolic.require_memory(FACTORS_OF_A_STEP)?;
        Ok(Self { first_unknown, symbolic })
    }

    /// The number of unknowns.
    pub(crate) fn n_unknowns(&self) -> usize {
        self.first_unknown(self.first_unknown.len() - 1)
    }

    /// The first unknown of a vertex; that of the next vertex where it has none.
    pub(crate) fn first_unknown(&self, vertex: impl Into<usize>) -> usize {
        self.first_unknown[vertex.into()] as usize
    }
}

/// The pattern of a factor over nodes with one or two unknowns each.
#[derive(Debug, Clone)]
pub(super) struct Symbolic {
    fronts: Fronts,
    /// The unknown of each column of the factor.
    unknowns: Vec<u32>,
}

impl Symbolic {
    /// Orders and analyzes the sum of matrices over cliques of nodes; [`NONE`] is no node.
    pub(super) fn new(cliques: &[[u32; 3]], dofs: &[u8], order: Order) -> Result<Self, Error> {
        let graph = Graph::of_cliques(dofs.len(), cliques);
        let order = match order {
            Order::Sparse => fill_reducing_order(&graph)?,
            Order::AsGiven => (0..dofs.len() as u32).collect(),
        };
        let tree = Elimination::new(&graph, &order, dofs);
        let fronts = Fronts::new(&graph, &tree, dofs, cliques);
        Ok(Self { fronts, unknowns: unknowns_in_order(&tree.order, dofs) })
    }

    /// Refuses factorizations for which, with as much as so many factors, there is no memory.
    ///
    /// # Errors
    /// [`NumericsError::ArraysOutOfMemory`](crate::NumericsError::ArraysOutOfMemory) with the numbers.
    pub(super) fn require_memory(&self, factors: f64) -> Result<(), Error> {
        let kept = (self.fronts.factor_len() as f64 * factors) as usize;
        Ok(memory::require_for_numbers(size_of::<f64>() as u64, kept + self.fronts.updates_len())?)
    }
}

/// From this number of nodes on, nested dissection pays for itself within a few factorizations.
#[cfg(all(feature = "metis", not(windows)))]
const LARGE: usize = 200_000;

/// An order of the nodes that keeps the factor sparse.
fn fill_reducing_order(graph: &Graph) -> Result<Vec<u32>, Error> {
    #[cfg(all(feature = "metis", not(windows)))]
    if graph.n_nodes() >= LARGE
        && let Some(order) = dissection::nested_dissection(graph)?
    {
        return Ok(order);
    }
    let (starts, neighbors) = graph.compressed();
    minimum_degree(starts, neighbors)
}

fn unknowns_in_order(order: &[u32], dofs: &[u8]) -> Vec<u32> {
    let mut first = Vec::with_capacity(dofs.len());
    let mut count = 0;
    for &width in dofs {
        first.push(count);
        count += u32::from(width);
    }
    let of_node = |&node: &u32| (0..u32::from(dofs[node as usize])).map(move |k| (node, k));
    order.iter().flat_map(of_node).map(|(node, k)| first[node as usize] + k).collect()
}

/// A factor L of a matrix A = L Lᵀ in the precision T.
#[derive(Debug, Clone)]
pub(crate) struct Factor<T> {
    values: Vec<T>,
    /// Memory for the next factorization.
    scratch: Vec<numeric::Updates<T>>,
}

impl<T: Scalar> Factor<T> {
    /// Room for the factors of the analyzed pattern.
    pub(crate) fn new(analysis: &Analysis) -> Self {
        Self::of(&analysis.symbolic)
    }

    pub(super) fn of(symbolic: &Symbolic) -> Self {
        Self { values: vec![T::ZERO; symbolic.fronts.factor_len()], scratch: Vec::new() }
    }

    /// Factors the sum of the faces' matrices: `element(face)` is symmetric, two rows for each corner of the face in
    /// its order, of which a corner with one unknown uses the first and one that is held none. It is called once for
    /// each face that has unknowns, from any thread.
    ///
    /// # Errors
    /// [`Failure::NotPositiveDefinite`] to the precision T, [`Failure::Cancelled`] by the watch; the factor is unusable
    /// then.
    pub(crate) fn refactor(
        &mut self,
        analysis: &Analysis,
        element: &(dyn Fn(usize) -> [[f64; 6]; 6] + Sync),
        watch: &Watch<'_>,
    ) -> Result<(), Failure> {
        let assemble = |target: &Element, place: &mut Place<'_, T>| {
            add_element(target, &element(target.index as usize), place);
        };
        self.refactor_by(&analysis.symbolic, &assemble, watch)
    }

    pub(super) fn refactor_by(
        &mut self,
        symbolic: &Symbolic,
        assemble: &(impl Fn(&Element, &mut Place<'_, T>) + Sync),
        watch: &Watch<'_>,
    ) -> Result<(), Failure> {
        numeric::factorize(&symbolic.fronts, &mut self.values, assemble, &mut self.scratch, watch)
    }

    /// Solves A x = b in place for the columns of `rhs`, each in the order of the unknowns and stored one after
    /// another.
    pub(crate) fn solve(&self, analysis: &Analysis, rhs: &mut [f64]) {
        self.solve_by(&analysis.symbolic, rhs);
    }

    pub(super) fn solve_by(&self, symbolic: &Symbolic, rhs: &mut [f64]) {
        let mut columns = rhs.chunks_mut(symbolic.unknowns.len().max(1));
        while let Some(first) = columns.next() {
            match columns.next() {
                Some(second) => self.solve_columns(symbolic, [first, second]),
                None => self.solve_columns(symbolic, [first]),
            }
        }
    }

    /// Solves for K columns at once, so that the factor is read once for all of them.
    fn solve_columns<const K: usize>(&self, symbolic: &Symbolic, mut rhs: [&mut [f64]; K]) {
        let Symbolic { fronts, unknowns } = symbolic;
        let mut x = vec![T::ZERO; K * unknowns.len()];
        for_each_place::<K>(fronts, |place, k, column| {
            x[place] = T::from_f64(rhs[k][unknowns[column] as usize]);
        });
        solve::substitute::<T, K>(fronts, &self.values, &mut x);
        for_each_place::<K>(fronts, |place, k, column| {
            rhs[k][unknowns[column] as usize] = x[place].to_f64();
        });
    }
}

/// Calls `visit(place, right-hand side, column)` for the order of [`solve::substitute`].
fn for_each_place<const K: usize>(fronts: &Fronts, mut visit: impl FnMut(usize, usize, usize)) {
    for front in 0..fronts.len() {
        let columns = fronts.columns(&(front..front + 1));
        for k in 0..K {
            let first = K * columns.start + k * columns.len();
            columns.clone().enumerate().for_each(|(j, column)| visit(first + j, k, column));
        }
    }
}

/// Adds the matrix of a face to its front.
fn add_element<T: Scalar>(element: &Element, matrix: &[[f64; 6]; 6], place: &mut Place<'_, T>) {
    for a in 0..3 {
        for b in 0..=a {
            for i in 0..usize::from(element.dofs[a]) {
                let last = if a == b { i + 1 } else { usize::from(element.dofs[b]) };
                for j in 0..last {
                    let value = matrix[2 * a + i][2 * b + j];
                    place.add(element.rows[a] as usize + i, element.rows[b] as usize + j, value);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
