// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the caller gives: options are checked, the surface is cut along given seams, and factors and diagonals are
//! carried to its parts.

use ndarray::{Array2, ArrayView1, ArrayView2};

use super::edge_mesh::EdgeMesh;
use super::options::SeamOptions;
use super::prepared::Wishes;
use crate::arrays::rows_of;
use crate::error::Error;
use crate::mesh::{Edge, EdgeTable, Face, Patch, Surface, Vertex};
use crate::vector::Vector3;

/// A part of the surface between given seams.
#[derive(Debug)]
pub(super) struct Part {
    pub mesh: EdgeMesh,
    /// The vertex of the surface of which each vertex is a copy.
    pub vertex_of: Vec<Vertex>,
    /// The face of the surface that each face is.
    pub face_of: Vec<Face>,
    /// Factors of the cost of a seam, (e,).
    weights: Option<Vec<f64>>,
    /// Given seams that lie alone and do not cut the part, until others meet them.
    alone: Vec<Edge>,
}

impl Part {
    /// What the caller wants of the part, which may fall into so many islands.
    pub(super) fn wishes(&self, options: &SeamOptions<'_>, max_islands: usize) -> Wishes<'_> {
        Wishes {
            target: options.target,
            weights: self.weights.as_deref(),
            alone: &self.alone,
            front: options.front.map(|front| Vector3(front).normalized()),
            symmetry: options.symmetry,
            max_islands,
            overlap: options.overlap,
            tries_other_starts: true,
            method: options.method,
        }
    }
}

/// The parts between the given seams, in the order of their lowest faces.
///
/// # Errors
/// Options out of range, seams that are no edges, parts that are no oriented manifold.
pub(super) fn parts(surface: &Surface, options: &SeamOptions<'_>) -> Result<Vec<Part>, Error> {
    let table = EdgeTable::new(surface.n_vertices(), surface.face_rows());
    check(options)?;
    let factors = options.weights.map(|weights| EdgeFactors::new(surface, &table, weights)).transpose()?;
    let diagonals = sorted_edges("diagonals", options.diagonals)?;
    let given = sorted_edges("fixed", options.fixed)?;
    let patches = match options.fixed {
        Some(fixed) => surface.cut(fixed)?,
        None => surface.cut(Array2::zeros((0, 2)))?,
    };
    patches.into_iter().map(|patch| part(patch, [&diagonals, &given], factors.as_ref())).collect()
}

fn check(options: &SeamOptions<'_>) -> Result<(), Error> {
    if !(options.target > 1.0 && options.target.is_finite()) {
        let expected = "a finite number > 1".into();
        return Err(Error::InvalidOption { name: "target", found: options.target.to_string(), expected });
    }
    if let Some(front) = options.front
        && !(Vector3(front).is_finite() && Vector3(front).norm() > 0.0)
    {
        let expected = "a direction of finite length > 0".into();
        return Err(Error::InvalidOption { name: "front", found: format!("{front:?}"), expected });
    }
    if options.max_islands == Some(0) {
        let expected = "a number ≥ 1".into();
        return Err(Error::InvalidOption { name: "max_islands", found: "0".into(), expected });
    }
    let weights = options.weights.iter().flatten();
    if let Some(weight) = weights.copied().find(|&weight| weight <= 0.0 || weight.is_nan()) {
        let expected = "positive, or inf where there must be no seam".into();
        return Err(Error::InvalidArray { name: "weights", found: format!("{weight} somewhere"), expected });
    }
    Ok(())
}

fn part(
    patch: Patch,
    [diagonals, given]: [&[[Vertex; 2]]; 2],
    factors: Option<&EdgeFactors>,
) -> Result<Part, Error> {
    let face_of: Vec<_> = patch.corner_of.rows().into_iter().map(|row| Face(row[0] / 3)).collect();
    let vertex_of = patch.vertex_of;
    let mut mesh = EdgeMesh::new(patch.surface.mesh()?.clone());
    let ends = |edge: Edge| sorted(mesh.edges.ends(edge).map(|vertex| vertex_of[vertex]));
    let contains = |edges: &[[Vertex; 2]], edge: Edge| edges.binary_search(&ends(edge)).is_ok();
    let weights = factors.map(|factors| mesh.edges.all().map(|edge| factors.at(ends(edge))).collect());
    let is_diagonal = mesh.edges.all().map(|edge| contains(diagonals, edge)).collect();
    let is_alone = |&edge: &Edge| !mesh.edges.is_boundary(edge) && contains(given, edge);
    let alone = mesh.edges.all().filter(is_alone).collect();
    mesh.is_diagonal = is_diagonal;
    Ok(Part { mesh, vertex_of, face_of, weights, alone })
}

/// The caller's factors at the edges.
struct EdgeFactors {
    edges: Vec<[Vertex; 2]>,
    factors: Vec<f64>,
}

impl EdgeFactors {
    /// Factors at the vertices, of which an edge has the mean, or at the edges.
    fn new(surface: &Surface, table: &EdgeTable, weights: ArrayView1<'_, f64>) -> Result<Self, Error> {
        let edges: Vec<_> = table.edges().map(|(edge, _)| edge).collect();
        let factors = if weights.len() == surface.n_vertices() {
            edges.iter().map(|[a, b]| 0.5 * (weights[a.index()] + weights[b.index()])).collect()
        } else if weights.len() == edges.len() {
            weights.to_vec()
        } else {
            let found = format!("of shape ({},)", weights.len());
            let (n, e) = (surface.n_vertices(), edges.len());
            let expected = format!("of shape ({n},), one for each vertex, or ({e},), one for each edge");
            return Err(Error::InvalidArray { name: "weights", found, expected });
        };
        Ok(Self { edges, factors })
    }

    fn at(&self, edge: [Vertex; 2]) -> f64 {
        self.edges.binary_search(&edge).map_or(1.0, |place| self.factors[place])
    }
}

/// The rows of an array of edges, each with its lower end first, ascending.
pub(crate) fn sorted_edges(
    name: &'static str,
    edges: Option<ArrayView2<'_, u32>>,
) -> Result<Vec<[Vertex; 2]>, Error> {
    let Some(edges) = edges else { return Ok(Vec::new()) };
    let mut rows: Vec<_> = rows_of(name, edges)?.iter().map(|row| sorted(row.map(Vertex))).collect();
    rows.sort_unstable();
    Ok(rows)
}

fn sorted([a, b]: [Vertex; 2]) -> [Vertex; 2] {
    [a.min(b), a.max(b)]
}

/// The length of edges of a surface.
pub(crate) fn length(surface: &Surface, edges: &[[Vertex; 2]]) -> f64 {
    let points = surface.vertex_rows();
    let lengths = edges.iter().map(|&[a, b]| Vector3(points[a]).distance(Vector3(points[b])));
    // the sum of no numbers is −0
    0.0 + lengths.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use ndarray::{Array1, array};

    use super::*;
    use crate::error::ErrorKind;
    use crate::seams::sample_surfaces::{flat_grid, random_numbers, torus};

    fn grid() -> Surface {
        Surface::of_mesh(&flat_grid(4, 3))
    }

    fn refused(options: &SeamOptions<'_>) -> ErrorKind {
        parts(&grid(), options).unwrap_err().kind()
    }

    #[test]
    fn weights_of_vertices_and_of_edges_reach_every_part() {
        let surface = grid();
        let mut random = random_numbers(1);
        let at_vertices: Array1<f64> = (0..20).map(|_| 0.5 + random()).collect();
        let edges: Vec<_> = EdgeTable::new(20, surface.face_rows()).edges().map(|(edge, _)| edge).collect();
        assert!(edges.is_sorted());
        let mean =
            |edge: &[Vertex; 2]| 0.5 * edge.map(|vertex| at_vertices[vertex.index()]).iter().sum::<f64>();
        let at_edges: Array1<f64> = edges.iter().map(mean).collect();
        // from the lower to the upper side
        let fixed = array![[2, 7], [12, 7], [12, 17]];
        for weights in [at_vertices.view(), at_edges.view()] {
            let options =
                SeamOptions { weights: Some(weights), fixed: Some(fixed.view()), ..Default::default() };
            let parts = parts(&surface, &options).unwrap();
            assert_eq!(parts.len(), 2);
            for part in &parts {
                let wishes = part.wishes(&options, 9);
                for (edge, &weight) in part.mesh.edges.all().zip(wishes.weights.unwrap()) {
                    let ends = part.mesh.edges.ends(edge).map(|vertex| part.vertex_of[vertex]);
                    assert_eq!(weight, mean(&sorted(ends)));
                }
            }
        }
    }

    #[test]
    fn parts_are_in_the_order_of_their_lowest_faces_and_know_diagonals() {
        let surface = grid();
        let (fixed, diagonals) = (array![[12, 7], [2, 7], [17, 12]], array![[6, 0], [8, 14]]);
        let options = SeamOptions {
            fixed: Some(fixed.view()),
            diagonals: Some(diagonals.view()),
            ..Default::default()
        };
        let parts = parts(&surface, &options).unwrap();
        let lowest: Vec<_> = parts.iter().map(|part| part.face_of[0].0).collect();
        assert_eq!(lowest, [0, 4]);
        for (part, diagonal) in parts.iter().zip([[0, 6], [8, 14]]) {
            let marked = part.mesh.edges.all().filter(|&edge| part.mesh.is_diagonal[edge]);
            let ends = |edge| part.mesh.edges.ends(edge).map(|vertex| part.vertex_of[vertex].0);
            assert_eq!(marked.map(ends).collect::<Vec<_>>(), [diagonal]);
        }
    }

    #[test]
    fn options_out_of_range_are_refused() {
        for target in [1.0, 0.0, -2.0, f64::NAN, f64::INFINITY] {
            assert_eq!(refused(&SeamOptions { target, ..Default::default() }), ErrorKind::InvalidOption);
        }
        for front in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]] {
            let options = SeamOptions { front: Some(front), ..Default::default() };
            assert_eq!(refused(&options), ErrorKind::InvalidOption);
        }
        let options = SeamOptions { max_islands: Some(0), ..Default::default() };
        assert_eq!(refused(&options), ErrorKind::InvalidOption);
    }

    #[test]
    fn broken_arrays_are_refused() {
        for weight in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
            let mut weights = Array1::ones(20);
            weights[3] = weight;
            let options = SeamOptions { weights: Some(weights.view()), ..Default::default() };
            assert_eq!(refused(&options), ErrorKind::InvalidArray);
        }
        let weights = Array1::ones(21);
        let options = SeamOptions { weights: Some(weights.view()), ..Default::default() };
        assert_eq!(refused(&options), ErrorKind::InvalidArray);
        let fixed = array![[0, 12]];
        let options = SeamOptions { fixed: Some(fixed.view()), ..Default::default() };
        assert_eq!(refused(&options), ErrorKind::SeamNotEdge);
    }

    #[test]
    fn the_length_of_edges_is_in_the_unit_of_the_surface() {
        let surface = grid();
        let edges = sorted_edges("seams", Some(array![[6, 0], [1, 0]].view())).unwrap();
        assert_eq!(edges, [[0, 1], [0, 6]].map(|edge: [u32; 2]| edge.map(Vertex)));
        let unit = flat_grid(4, 3).scale();
        assert!((length(&surface, &edges) * unit - (1.0 + 2f64.sqrt())).abs() < 1e-12);
    }

    #[test]
    fn a_closed_surface_without_given_seams_is_one_part() {
        let parts = parts(&Surface::of_mesh(&torus()), &SeamOptions::default()).unwrap();
        assert_eq!((parts.len(), parts[0].mesh.mesh.euler_characteristic()), (1, 0));
    }
}
