// SPDX-License-Identifier: MIT OR Apache-2.0
//! The validated triangle mesh.

use super::corners::{EdgeTable, VertexCorners};
use super::edge_distances::edge_distances;
use super::orientation::Orientation;
use super::topology::Topology;
use super::{Corner, Face, Vertex, geometry, validate};
use crate::error::{Elements, Error, MeshError};
use crate::parallel;
use crate::vector::{Vector3, coordinates};

/// A validated triangle mesh: an oriented manifold surface without degenerate faces.
///
/// Corner `3 * face + k` is vertex `k` of a face; it also stands for the edge opposite to that vertex.
///
/// ```
/// use authalic::Vertex;
/// use authalic::testing::TriangleMesh;
///
/// let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = TriangleMesh::new(&vertices, &[[0, 1, 2], [0, 2, 3]])?;
/// assert_eq!(mesh.boundary_loops(), [[0, 1, 2, 3].map(Vertex)]);
/// assert!(mesh.require_disk().is_ok());
/// # Ok::<(), authalic::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TriangleMesh {
    pub(super) points: Vec<Vector3>,
    pub(super) scale: f64,
    pub(super) faces: Vec<[Vertex; 3]>,
    pub(super) flipped: Vec<Face>,
    pub(super) areas: Vec<f64>,
    pub(super) opposite: Vec<Option<Corner>>,
    pub(super) corners: VertexCorners,
    pub(super) on_boundary: Vec<bool>,
    pub(super) topology: Topology,
    /// Whether the order of the vertices is an elimination order.
    pub(super) in_elimination_order: bool,
}

impl TriangleMesh {
    /// Validates `vertices` (n, 3) and `faces` (m, 3), vertices or their indices.
    ///
    /// Faces oriented against most of their component are flipped: the first vertex stays, the other two
    /// change places.
    ///
    /// # Errors
    /// Each with the elements at fault, and the first cause first: empty arrays, coordinates that are not
    /// finite, indices out of range, faces that repeat a vertex, duplicate faces, faces without area,
    /// edges of three or more faces, surfaces that cannot be oriented, vertices in which parts only touch,
    /// and vertices without a face.
    pub fn new<V>(vertices: &[[f64; 3]], faces: &[[V; 3]]) -> Result<Self, Error>
    where
        V: Copy + Into<Vertex>,
    {
        let faces: Vec<_> = faces.iter().map(|face| face.map(Into::into)).collect();
        validate::arrays(vertices, &faces)?;
        Self::of_checked(vertices, faces)
    }

    /// [`Self::new`] of points that keep their coordinates, which must be of the order of 1.
    pub(crate) fn at_given_points(points: Vec<Vector3>, faces: Vec<[Vertex; 3]>) -> Result<Self, Error> {
        let vertices = coordinates(points.iter().copied());
        validate::arrays(&vertices, &faces)?;
        Self::of_normalized(&vertices, (points, 1.0), faces)
    }

    /// [`Self::new`] of arrays that have passed [`validate::arrays`].
    pub(super) fn of_checked(vertices: &[[f64; 3]], faces: Vec<[Vertex; 3]>) -> Result<Self, Error> {
        Self::of_normalized(vertices, geometry::normalized(vertices), faces)
    }

    /// [`Self::of_checked`] given the points that `vertices` become with their scale.
    fn of_normalized(
        vertices: &[[f64; 3]],
        (points, scale): (Vec<Vector3>, f64),
        mut faces: Vec<[Vertex; 3]>,
    ) -> Result<Self, Error> {
        // 1. Each face by itself.
        let table = EdgeTable::new(points.len(), &faces);
        validate::no_duplicates(&faces, &table)?;
        let areas = validate::positive_areas(vertices, &points, scale, &faces)?;
        // 2. A manifold in its edges, with one orientation.
        validate::manifold_edges(&table)?;
        let mut opposite = table.opposites();
        drop(table);
        let orientation = Orientation::propagate(&faces, &opposite);
        validate::refuse(Elements::edges(orientation.conflict), |edges| MeshError::NotOrientable { edges })?;
        orientation.apply(&mut faces, &mut opposite);
        // 3. A manifold in its vertices.
        let corners = VertexCorners::new(points.len(), &faces);
        validate::manifold_vertices(&corners, points.len(), &opposite)?;
        // 4. Its topology.
        let flipped = flipped_faces(&orientation);
        let topology = Topology::of_oriented(&points, &faces, &opposite, orientation);
        let on_boundary = mark_boundary(points.len(), &topology.boundary_loops);
        Ok(Self {
            points,
            scale,
            faces,
            flipped,
            areas,
            opposite,
            corners,
            on_boundary,
            topology,
            in_elimination_order: false,
        })
    }

    /// The mesh with other points, between which every face must have an area; [`Self::face_areas`] stay those of
    /// the surface.
    pub(crate) fn at_points(&self, points: Vec<Vector3>) -> Self {
        Self { points, ..self.clone() }
    }

    /// The surface with other points, between which every face must have an area, in a unit of their own: [`Self::scale`]
    /// stays that of the points before.
    pub(crate) fn reshaped(&self, points: Vec<Vector3>) -> Self {
        Self { areas: geometry::face_areas(&points, &self.faces), ..self.at_points(points) }
    }

    /// The surface with the opposite orientation: corners 1 and 2 of every face change places.
    pub(crate) fn turned_over(&self) -> Self {
        let faces: Vec<[Vertex; 3]> = self.faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let mut opposite = vec![None; self.opposite.len()];
        for corner in Corner::all(faces.len()) {
            opposite[corner.mirrored()] = self.opposite[corner].map(Corner::mirrored);
        }
        let mut topology = self.topology.clone();
        topology.boundary_loops.iter_mut().for_each(|vertices| vertices[1..].reverse());
        let corners = VertexCorners::new(self.points.len(), &faces);
        Self { faces, opposite, corners, topology, ..self.clone() }
    }

    /// The vertices, centered on their bounding box and scaled to a unit diagonal, (n, 3).
    ///
    /// All geometry is computed on these, so that huge and tiny coordinates neither over- nor underflow.
    pub fn points(&self) -> &[Vector3] {
        &self.points
    }

    /// The diagonal of the bounding box: a length in the input is a length of [`Self::points`] times this.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The faces, consistently oriented, (m, 3).
    pub fn faces(&self) -> &[[Vertex; 3]] {
        &self.faces
    }

    /// The faces that were flipped to orient the mesh, in ascending order.
    pub fn flipped_faces(&self) -> &[Face] {
        &self.flipped
    }

    /// The number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.points.len()
    }

    /// The number of faces.
    pub fn n_faces(&self) -> usize {
        self.faces.len()
    }

    /// The areas of the faces of [`Self::points`], (m,), all positive.
    pub fn face_areas(&self) -> &[f64] {
        &self.areas
    }

    /// The corner across the edge opposite to a corner, or `None` on the boundary.
    pub fn opposite(&self, corner: Corner) -> Option<Corner> {
        self.opposite[corner]
    }

    /// The measure of each vertex, (n,): a third of the `measure` (m,) of each of its faces.
    pub(crate) fn vertex_shares(&self, measure: &[f64]) -> Vec<f64> {
        parallel::map(self.n_vertices(), |vertex| {
            self.vertex_corners(Vertex::new(vertex)).iter().map(|&corner| measure[corner.face()] / 3.0).sum()
        })
    }

    /// The corner across each edge; across an inner edge the lower of the two.
    pub(crate) fn edge_corners(&self) -> impl Iterator<Item = Corner> {
        Corner::all(self.n_faces())
            .filter(|&corner| self.opposite(corner).is_none_or(|across| corner < across))
    }

    /// The length of the edge opposite to a corner.
    pub(crate) fn edge_length(&self, corner: Corner) -> f64 {
        let [a, b] = corner.half_edge(&self.faces);
        self.points[a].distance(self.points[b])
    }

    /// The median of the lengths of the edges.
    pub(crate) fn median_edge_length(&self) -> f64 {
        let mut lengths: Vec<f64> = self.edge_corners().map(|corner| self.edge_length(corner)).collect();
        let middle = lengths.len() / 2;
        *lengths.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// The corners at a vertex, in ascending order.
    pub fn vertex_corners(&self, vertex: Vertex) -> &[Corner] {
        self.corners.of(vertex)
    }

    /// The distance along edges of each vertex from the nearest of some vertices, (n,), in units of [`Self::points`];
    /// infinite beyond `most`.
    pub(crate) fn distances_along_edges(
        &self,
        sources: impl IntoIterator<Item = Vertex>,
        most: f64,
    ) -> Vec<f64> {
        edge_distances(&self.points, &self.faces, &self.corners, sources, most)
    }

    /// The boundary loops, the surface on the left of travel: the longest first, each from its smallest
    /// vertex.
    pub fn boundary_loops(&self) -> &[Vec<Vertex>] {
        &self.topology.boundary_loops
    }

    /// The faces across the edges of a face.
    pub(crate) fn neighbors(&self, face: Face) -> impl Iterator<Item = Face> + '_ {
        face.corners().into_iter().filter_map(|corner| self.opposite(corner)).map(Corner::face)
    }

    /// The mean of the corners of a face.
    pub(crate) fn center(&self, face: Face) -> Vector3 {
        let [a, b, c] = geometry::triangle(&self.points, self.faces[face]);
        (a + b + c) * (1.0 / 3.0)
    }

    /// Whether a vertex lies on the boundary.
    pub fn is_boundary(&self, vertex: Vertex) -> bool {
        self.on_boundary[vertex]
    }

    /// Vertices − edges + faces.
    pub fn euler_characteristic(&self) -> i64 {
        self.topology.euler_characteristic
    }

    /// The number of connected components.
    pub fn n_components(&self) -> usize {
        self.topology.n_components()
    }

    /// The number of handles, summed over the components.
    pub fn genus(&self) -> usize {
        self.topology.genus.unwrap_or(0)
    }

    /// Whether the order of the vertices keeps factors sparse.
    pub(crate) fn in_elimination_order(&self) -> bool {
        self.in_elimination_order
    }

    /// The topology of the mesh.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Refuses anything but a topological disk.
    ///
    /// # Errors
    /// Several components, a closed surface, handles, or several boundary loops; each with its own message.
    pub fn require_disk(&self) -> Result<(), Error> {
        self.require_one_component()?;
        let (loops, genus) = (&self.topology.boundary_loops, self.genus());
        match (loops.len(), genus) {
            (0, _) => Err(MeshError::ClosedSurface { genus }.into()),
            (1, 0) => Ok(()),
            (_, 0) => {
                let (vertices, sizes) = described(loops);
                Ok(validate::refuse(vertices, |vertices| MeshError::SeveralBoundaries { vertices, sizes })?)
            }
            _ => Err(MeshError::HasHandles { genus }.into()),
        }
    }

    /// Refuses anything but a topological sphere.
    ///
    /// # Errors
    /// Several components, boundaries, or handles; each with its own message.
    pub fn require_sphere(&self) -> Result<(), Error> {
        self.require_one_component()?;
        let (vertices, sizes) = described(&self.topology.boundary_loops);
        validate::refuse(vertices, |vertices| MeshError::OpenSurface {
            vertices,
            sizes,
            coincident: self.n_coincident(),
        })?;
        match self.genus() {
            0 => Ok(()),
            genus => Err(MeshError::SphereHasHandles { genus }.into()),
        }
    }

    /// Refuses anything but one component of genus 0, with or without a boundary.
    ///
    /// # Errors
    /// Several components, or handles; each with its own message.
    pub fn require_genus_zero(&self) -> Result<(), Error> {
        self.require_one_component()?;
        match self.genus() {
            0 => Ok(()),
            genus => Err(MeshError::GenusNotZero { genus }.into()),
        }
    }

    fn require_one_component(&self) -> Result<(), MeshError> {
        let first_faces = &self.topology.first_faces;
        let faces = Elements::collect(first_faces.iter().copied());
        let several = faces.filter(|_| first_faces.len() > 1);
        validate::refuse(several, |faces| MeshError::SeveralComponents {
            faces,
            coincident: self.n_coincident(),
        })
    }

    /// The number of boundary points that lie at the place of another one.
    fn n_coincident(&self) -> usize {
        let boundary = self.topology.boundary_loops.iter().flatten();
        // adding zero makes −0 and 0 the same
        let mut places: Vec<_> = boundary.map(|&v| self.points[v].0.map(|x| (x + 0.0).to_bits())).collect();
        places.sort_unstable();
        places.chunk_by(|one, next| one == next).map(<[_]>::len).filter(|&points| points > 1).sum()
    }
}

/// A vertex of each loop, and the edge counts of the loops.
fn described(loops: &[Vec<Vertex>]) -> (Option<Elements>, Vec<usize>) {
    let vertices = Elements::collect(loops.iter().map(|vertices| vertices[0]));
    (vertices, loops.iter().map(Vec::len).collect())
}

fn flipped_faces(orientation: &Orientation) -> Vec<Face> {
    let flipped = orientation.flipped.iter().enumerate().filter(|(_, flipped)| **flipped);
    flipped.map(|(face, _)| Face::new(face)).collect()
}

pub(super) fn mark_boundary(n_vertices: usize, loops: &[Vec<Vertex>]) -> Vec<bool> {
    let mut on_boundary = vec![false; n_vertices];
    for &vertex in loops.iter().flatten() {
        on_boundary[vertex] = true;
    }
    on_boundary
}
