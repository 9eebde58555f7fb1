// SPDX-License-Identifier: MIT OR Apache-2.0
//! Assembly of weighted graph Laplacians of a mesh, restricted to its free vertices.
//!
//! The sparsity pattern of `L_II` is the mesh's edges and never changes, so it is computed once and only the
//! values are written again. A weight belongs to a corner: `weight[c]` is what the face of corner `c` adds
//! to the edge opposite `c`. Every entry gathers its own corners in a fixed order, in parallel, without
//! atomics.

use sprs::{CsMat, CsMatI};

use crate::mesh::{Corner, TriangleMesh, Vertex};
use crate::parallel;

/// The two corners that face an edge, the second `None` on the boundary; a diagonal entry has none.
type EdgeCorners = [Option<Corner>; 2];

/// The matrix `L_II` of a mesh over its free vertices I, upper triangle, pattern fixed.
#[derive(Debug, Clone)]
pub struct Laplacian {
    /// Mesh vertex of each unknown, ascending.
    free: Vec<Vertex>,
    /// Unknown of each mesh vertex, `None` where it is held.
    unknown: Vec<Option<usize>>,
    /// The upper triangle with the diagonal last in each column.
    matrix: CsMat<f64>,
    /// For each stored entry the corners it gathers.
    gathers: Vec<EdgeCorners>,
    /// Column of each stored entry.
    columns: Vec<usize>,
}

impl Laplacian {
    /// Analyzes the pattern of the vertices for which `is_free` holds.
    pub fn new(mesh: &TriangleMesh, is_free: impl Fn(Vertex) -> bool) -> Self {
        let (free, unknown) = number_unknowns(mesh.n_vertices(), is_free);
        let columns = upper_columns(mesh, &free, &unknown);
        let (matrix, gathers, columns) = compress(columns);
        Self { free, unknown, matrix, gathers, columns }
    }

    /// Mesh vertex of each unknown, ascending.
    pub fn free(&self) -> &[Vertex] {
        &self.free
    }

    /// Unknown of a mesh vertex, `None` where the vertex is held.
    pub fn unknown(&self, vertex: Vertex) -> Option<usize> {
        self.unknown[vertex]
    }

    /// The assembled matrix: upper triangle, compressed columns.
    pub fn matrix(&self) -> &CsMat<f64> {
        &self.matrix
    }

    /// Writes the values from one weight per corner (of the edge opposite it); `entry(i, j)` scales the
    /// entry of the mesh vertices i, j, so that a caller can project onto tangents.
    pub fn assemble_scaled(
        &mut self,
        mesh: &TriangleMesh,
        weights: &[f64],
        entry: impl Fn(Vertex, Vertex) -> f64 + Sync,
    ) {
        let (free, gathers, columns) = (&self.free, &self.gathers, &self.columns);
        let rows = self.matrix.indices().to_vec();
        parallel::fill(self.matrix.data_mut(), |k| {
            let (row, column) = (free[rows[k]], free[columns[k]]);
            let value = match gathers[k] {
                [None, _] => diagonal(mesh, weights, row),
                [Some(corner), None] => -weights[corner],
                [Some(corner), Some(across)] => -(weights[corner] + weights[across]),
            };
            value * entry(row, column)
        });
    }

    /// Adds `share` of the mean diagonal entry to the diagonal of the assembled matrix.
    pub fn shift_diagonal(&mut self, share: f64) {
        let n = self.free.len();
        // the diagonal is the last entry of each column
        let last: Vec<usize> =
            (0..n).map(|column| self.matrix.indptr().outer_inds_sz(column).end - 1).collect();
        let values = self.matrix.data_mut();
        let shift = share * last.iter().map(|&k| values[k]).sum::<f64>() / n.max(1) as f64;
        last.iter().for_each(|&k| values[k] += shift);
    }

    /// Adds one value per free vertex to the diagonal of the assembled matrix.
    pub fn add_to_diagonal(&mut self, terms: &[f64]) {
        for (column, term) in terms.iter().enumerate() {
            // the diagonal is the last entry of each column
            let last = self.matrix.indptr().outer_inds_sz(column).end - 1;
            self.matrix.data_mut()[last] += term;
        }
    }

    /// (L f)_I for a planar map f of all vertices: the first coordinates of the free vertices, then the
    /// second.
    pub fn residual(&self, mesh: &TriangleMesh, weights: &[f64], map: &[[f64; 2]]) -> Vec<f64> {
        let by_vertex = parallel::map(self.free.len(), |i| apply(mesh, weights, map, self.free[i]));
        by_vertex.iter().map(|value| value[0]).chain(by_vertex.iter().map(|value| value[1])).collect()
    }

    /// Writes the values from one weight per corner (of the edge opposite it).
    pub fn assemble(&mut self, mesh: &TriangleMesh, weights: &[f64]) {
        self.assemble_scaled(mesh, weights, |_, _| 1.0);
    }
}

/// (L f)_v for one vertex.
fn apply(mesh: &TriangleMesh, weights: &[f64], map: &[[f64; 2]], vertex: Vertex) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for &corner in mesh.vertex_corners(vertex) {
        let (next, previous) = (corner.next(), corner.previous());
        for (neighbor, facing) in [(next, previous), (previous, next)] {
            let image = map[neighbor.vertex(mesh.faces())];
            let weight = weights[facing];
            sum[0] += weight * (map[vertex][0] - image[0]);
            sum[1] += weight * (map[vertex][1] - image[1]);
        }
    }
    sum
}

/// L_vv: the weights of all edges at `vertex`.
fn diagonal(mesh: &TriangleMesh, weights: &[f64], vertex: Vertex) -> f64 {
    let corners = mesh.vertex_corners(vertex).iter();
    corners.map(|corner| weights[corner.next()] + weights[corner.previous()]).sum()
}

fn number_unknowns(n_vertices: usize, is_free: impl Fn(Vertex) -> bool) -> (Vec<Vertex>, Vec<Option<usize>>) {
    let free: Vec<Vertex> = Vertex::all(n_vertices).filter(|&v| is_free(v)).collect();
    let mut unknown = vec![None; n_vertices];
    for (i, &v) in free.iter().enumerate() {
        unknown[v] = Some(i);
    }
    (free, unknown)
}

/// For each column the rows above the diagonal with the corners that face the edge, ascending.
fn upper_columns(
    mesh: &TriangleMesh,
    free: &[Vertex],
    unknown: &[Option<usize>],
) -> Vec<Vec<(usize, EdgeCorners)>> {
    parallel::map(free.len(), |column| {
        let mut rows: Vec<(usize, EdgeCorners)> = Vec::with_capacity(4);
        for corner in mesh.vertex_corners(free[column]) {
            let (next, previous) = (corner.next(), corner.previous());
            for (neighbor, facing) in [(next, previous), (previous, next)] {
                let row = unknown[neighbor.vertex(mesh.faces())];
                if let Some(row) = row.filter(|&row| row <= column) {
                    add_neighbor(&mut rows, row, facing);
                }
            }
        }
        rows.sort_unstable();
        rows
    })
}

/// Adds the corner `facing` to the entry of a row, which an earlier face may have begun.
fn add_neighbor(rows: &mut Vec<(usize, EdgeCorners)>, row: usize, facing: Corner) {
    match rows.iter_mut().find(|(seen, _)| *seen == row) {
        // ascending, so that the order of gathering does not depend on the order of the one-ring
        Some((_, [first, second])) => {
            (*first, *second) = ((*first).min(Some(facing)), (*first).max(Some(facing)));
        }
        None => rows.push((row, [Some(facing), None])),
    }
}

type Compressed = (CsMatI<f64, usize>, Vec<EdgeCorners>, Vec<usize>);

/// Compressed columns with the diagonal appended to each.
fn compress(columns: Vec<Vec<(usize, EdgeCorners)>>) -> Compressed {
    let n = columns.len();
    let stored = n + columns.iter().map(Vec::len).sum::<usize>();
    let (mut starts, mut rows) = (Vec::with_capacity(n + 1), Vec::with_capacity(stored));
    let (mut gathers, mut column_of) = (Vec::with_capacity(stored), Vec::with_capacity(stored));
    starts.push(0);
    for (column, entries) in columns.into_iter().enumerate() {
        for (row, corners) in entries {
            rows.push(row);
            gathers.push(corners);
        }
        rows.push(column);
        gathers.push([None, None]);
        column_of.resize(rows.len(), column);
        starts.push(rows.len());
    }
    let values = vec![0.0; rows.len()];
    (CsMatI::new_csc((n, n), starts, rows, values), gathers, column_of)
}
