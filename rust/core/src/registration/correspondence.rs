// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where each vertex of one surface lies on another, and what follows from that: positions, data carried over, morphs.
//!
//! Both surfaces lie in a common domain, the unit sphere or the disk in the plane z = 1, so that data at corners of
//! faces can be read on the right side of a seam. Data come and go in the order of the vertices and faces as given,
//! whatever faces were flipped to orient a surface.

use std::sync::Arc;

use ndarray::{Array1, Array2, Array3, ArrayView1, ArrayView2, ArrayView3};

use super::boundary::Carried;
use super::figures::{area_ratios, compare, vertex_areas};
use super::given_faces::{GivenFaces, nearest_given_corners, pull_given_corners};
use super::strain::{Strain, strain};
use super::transfer::{local_similarities, nearest_vertices, pull_vertices, pull_vertices_smoothly};
use crate::arrays::{from_rows, from_vectors, rows, vectors};
use crate::control::{Observer, Watch};
use crate::error::{Error, Side};
use crate::location::{Location, Locator, points_on};
use crate::mesh::geometry::{face_areas, normalized};
use crate::mesh::{Corner, Face, Surface, TriangleMesh, Vertex, index_array};
use crate::parallel;
use crate::vector::Vector3;

/// A one-to-one map g of a source surface onto a target.
#[derive(Debug, Clone)]
pub struct Correspondence {
    pub(super) source: Arc<Registered>,
    pub(super) target: Arc<Registered>,
    pub(super) locations: Vec<Location>,
    pub(super) positions: Vec<Vector3>,
    pub(super) area_ratio: Vec<f64>,
    pub(super) in_holes: Vec<usize>,
}

/// A surface and its place in the domain.
#[derive(Debug)]
pub(crate) struct Registered {
    pub surface: Surface,
    /// As oriented.
    pub faces: Vec<[Vertex; 3]>,
    /// The vertices in the domain.
    pub in_domain: Vec<Vector3>,
}

impl Registered {
    pub(crate) fn new(surface: &Surface, faces: &[[Vertex; 3]], in_domain: Vec<Vector3>) -> Arc<Self> {
        Arc::new(Self { surface: surface.clone(), faces: faces.to_vec(), in_domain })
    }

    /// The part of a filled surface that was given: its first vertices and faces.
    fn of_given(self: &Arc<Self>, given: &Surface) -> Arc<Self> {
        if given.n_faces() == self.faces.len() {
            return self.clone();
        }
        Self::new(given, &self.faces[..given.n_faces()], self.in_domain[..given.n_vertices()].to_vec())
    }

    fn given_faces(&self) -> GivenFaces<'_> {
        GivenFaces { given: self.surface.face_rows(), oriented: &self.faces, registered: &self.in_domain }
    }
}

impl Correspondence {
    /// The map by which each vertex of the source comes to lie at its location among the target's faces as oriented.
    pub(crate) fn new(source: Arc<Registered>, target: Arc<Registered>, locations: Vec<Location>) -> Self {
        let positions = points_on(&locations, &vectors(target.surface.vertices()), &target.faces);
        let area_ratio = area_ratios(rows(source.surface.vertices()), &source.faces, &positions);
        Self { source, target, locations, positions, area_ratio, in_holes: Vec::new() }
    }

    /// g⁻¹, by looking up the target's vertices among the source's faces in the domain; on a disk whose boundary was
    /// carried onto the source's, from there.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`] where the observer ends it.
    pub(super) fn inverse(
        &self,
        carried: Option<&Carried>,
        observer: &mut dyn Observer,
    ) -> Result<Self, Error> {
        let target = match carried {
            None => self.target.clone(),
            Some(Carried { image, .. }) => {
                Registered::new(&self.target.surface, &self.target.faces, image.clone())
            }
        };
        let watch = Watch::new(observer, 0.0, "Looking up places");
        let locator = Locator::new(&self.source.in_domain, &self.source.faces);
        let mut locations = locator.locate_all(&target.in_domain, &watch).ok_or(Error::CancelledEarly)?;
        if let Some(carried) = carried {
            carried.on_rim.set(&mut locations);
        }
        Ok(Self::new(target, self.source.clone(), locations))
    }

    /// The map of the given surfaces, as this is the map of the same with their holes filled. A place on a filling keeps
    /// its position; its location is the nearest on the target. The rim of a hole belongs to the target.
    pub(crate) fn of_given(&self, [source, target]: [&Surface; 2]) -> Self {
        let [source, target] = [self.source.of_given(source), self.target.of_given(target)];
        let locator = Locator::new(&target.in_domain, &target.faces);
        let n = source.in_domain.len();
        let on_given = parallel::map(n, |vertex| {
            on_given_face(self.locations[vertex], &self.target.faces, &target.faces, target.in_domain.len())
        });
        let is_in_hole = |vertex: &usize| on_given[*vertex].is_none();
        let locations = parallel::map(n, |vertex| {
            on_given[vertex].unwrap_or_else(|| locator.locate(source.in_domain[vertex]))
        });
        let positions = self.positions[..n].to_vec();
        let area_ratio = area_ratios(rows(source.surface.vertices()), &source.faces, &positions);
        let in_holes = (0..n).filter(is_in_hole).collect();
        Self { source, target, locations, positions, area_ratio, in_holes }
    }

    /// The source and the target.
    pub(crate) fn sides(&self) -> [&Registered; 2] {
        [&self.source, &self.target]
    }

    /// The source's vertices whose positions lie on fillings of the target's holes, ascending. Their locations are the
    /// nearest on the target itself.
    pub fn in_holes(&self) -> &[usize] {
        &self.in_holes
    }

    /// The surface that is mapped.
    pub fn source(&self) -> &Surface {
        &self.source.surface
    }

    /// The surface that it is mapped onto.
    pub fn target(&self) -> &Surface {
        &self.target.surface
    }

    /// The source's faces as oriented, (m, 3).
    pub fn faces(&self) -> Array2<u32> {
        index_array(&self.source.faces)
    }

    /// The target's faces as oriented, (m_t, 3).
    pub fn target_faces(&self) -> Array2<u32> {
        index_array(&self.target.faces)
    }

    /// g(v) of each vertex v of the source, (n, 3), in the target's coordinates.
    pub fn positions(&self) -> Array2<f64> {
        from_vectors(self.positions.clone())
    }

    /// The face of the target in which each of them lies, (n,).
    pub fn triangles(&self) -> Array1<usize> {
        self.locations.iter().map(|location| location.triangle.index()).collect()
    }

    /// The weights of that face's corners as oriented, (n, 3): not negative, and 1 in sum.
    pub fn barycentric(&self) -> Array2<f64> {
        from_rows(self.locations.iter().map(|location| location.barycentric).collect())
    }

    /// The area of each source face's image over its own, (m,), with the source scaled to the area of its image: 1
    /// where g preserves areas. All are 0 where the image has no area.
    pub fn area_ratio(&self) -> Array1<f64> {
        self.area_ratio.clone().into()
    }

    /// Data of the target's vertices, (n_t, k), at those of the source, (n, k).
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where there is not one row per vertex of the target.
    pub fn pull_vertices(&self, values: ArrayView2<'_, f64>) -> Result<Array2<f64>, Error> {
        self.pulled(values, |values, width| pull_vertices(values, width, &self.target.faces, &self.locations))
    }

    /// [`Self::pull_vertices`] by cubics with estimated gradients, in place of linear functions: without the facets of
    /// a target that is coarser than the source.
    ///
    /// # Errors
    /// As [`Self::pull_vertices`].
    pub fn pull_vertices_smoothly(&self, values: ArrayView2<'_, f64>) -> Result<Array2<f64>, Error> {
        let (points, _) = normalized(self.target.surface.vertex_rows());
        self.pulled(values, |values, width| {
            pull_vertices_smoothly(values, width, &points, &self.target.faces, &self.locations)
        })
    }

    /// Data of the target's vertices, carried by `pull(values, width)`.
    fn pulled(
        &self,
        values: ArrayView2<'_, f64>,
        pull: impl Fn(&[f64], usize) -> Vec<f64>,
    ) -> Result<Array2<f64>, Error> {
        let (n, width) = values.dim();
        if n != self.target().n_vertices() {
            return Err(misfit(
                values.shape(),
                format!("({}, k), one row per vertex of the target", self.target().n_vertices()),
            ));
        }
        let values = values.as_standard_layout();
        let pulled = pull(values.as_slice().expect("in standard layout"), width);
        Ok(Array2::from_shape_vec((self.locations.len(), width), pulled).expect("one row per vertex"))
    }

    /// How vectors on the target are turned and scaled on their way to the source, (n, 3, 3): for each vertex v of the
    /// source the linear part of the similarity that takes the target's surroundings of g(v) to those of v.
    ///
    /// # Errors
    /// Errors of the factorization.
    pub fn local_similarities(&self) -> Result<Array3<f64>, Error> {
        let matrices = local_similarities(self.source.surface.mesh()?, &self.positions)?;
        let flat: Vec<f64> = matrices.iter().flatten().flat_map(|row| row.0).collect();
        Ok(Array3::from_shape_vec((matrices.len(), 3, 3), flat).expect("nine numbers per vertex"))
    }

    /// The strain of g, with the vertices of the source at each of its landmarks or curves.
    pub(crate) fn strain(&self, landmarks: &[Vec<usize>]) -> Strain {
        let (target, diagonal) = normalized(self.target.surface.vertex_rows());
        let target_area = face_areas(&target, &self.target.faces).iter().sum();
        let positions: Vec<Vector3> = self.positions.iter().map(|&x| x * (1.0 / diagonal)).collect();
        strain(self.source.surface.vertex_rows(), &self.source.faces, &positions, target_area, landmarks)
    }

    /// Data of the corners of the target's faces, (m_t, 3, k), at those of the source, (m, 3, k), both in the order of
    /// the faces as given. Each corner takes the value on that side of a seam of the data on which its face lies.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where there is not one row per corner of the target.
    pub fn pull_corners(&self, values: ArrayView3<'_, f64>) -> Result<Array3<f64>, Error> {
        let (m, three, width) = values.dim();
        if (m, three) != (self.target().n_faces(), 3) {
            return Err(misfit(
                values.shape(),
                format!("({}, 3, k), one row per corner of the target", self.target().n_faces()),
            ));
        }
        let values = values.as_standard_layout();
        let flat = values.as_slice().expect("in standard layout");
        let (source, target) = (self.source.given_faces(), self.target.given_faces());
        let pulled = pull_given_corners(flat, width, &source, &target, &self.locations);
        Ok(Array3::from_shape_vec((self.source.faces.len(), 3, width), pulled).expect("three rows per face"))
    }

    /// The vertex of the target nearest to each vertex of the source, (n,): where to take labels from.
    pub fn nearest_vertices(&self) -> Vec<Vertex> {
        nearest_vertices(&self.target.faces, &self.locations)
    }

    /// The corner of the target, 3 × face + corner as given, nearest to each corner of the source, (3 m,), on that side
    /// of a seam on which its face lies.
    pub fn nearest_corners(&self) -> Vec<Corner> {
        nearest_given_corners(&self.source.given_faces(), &self.target.given_faces(), &self.locations)
    }

    /// How well scalars at the vertices of both surfaces, (n,) and (n_t,), agree, weighted by area on the source:
    /// Pearson's correlation, NaN where one side is constant, and the mean absolute difference.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where there is not one value per vertex.
    pub fn compare(
        &self,
        source_values: ArrayView1<'_, f64>,
        target_values: ArrayView1<'_, f64>,
    ) -> Result<(f64, f64), Error> {
        if source_values.len() != self.source().n_vertices() {
            return Err(misfit(
                source_values.shape(),
                format!("({},), one value per vertex of the source", self.source().n_vertices()),
            ));
        }
        let target_values = target_values.to_owned().insert_axis(ndarray::Axis(1));
        let pulled = self.pull_vertices(target_values.view())?;
        let pulled = pulled.as_slice().expect("in standard layout");
        Ok(compare(&source_values.to_vec(), pulled, &self.vertex_areas()))
    }

    /// g(v) as rows.
    pub(super) fn position_rows(&self) -> &[Vector3] {
        &self.positions
    }

    /// A third of the area of the faces at each vertex of the source.
    pub(super) fn vertex_areas(&self) -> Vec<f64> {
        vertex_areas(rows(self.source.surface.vertices()), &self.source.faces)
    }
}

/// Two surfaces as meshes; errors say which one is at fault.
pub(crate) fn meshes<'a>(
    source: &'a Surface,
    target: &'a Surface,
) -> Result<(&'a TriangleMesh, &'a TriangleMesh), Error> {
    let mesh = |surface: &'a Surface, side| surface.mesh().map_err(|error| error.of_surface(side));
    Ok((mesh(source, Side::Source)?, mesh(target, Side::Target)?))
}

fn misfit(shape: &[usize], expected: String) -> Error {
    let lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
    let found = format!("of shape ({})", lengths.join(", "));
    Error::InvalidArray { name: "values", found, expected: format!("of shape {expected}") }
}

/// A location among the faces of a filled surface as one among the given faces, which come first; `None` inside a filling.
fn on_given_face(
    location: Location,
    filled: &[[Vertex; 3]],
    given: &[[Vertex; 3]],
    n_given: usize,
) -> Option<Location> {
    if location.triangle.index() < given.len() {
        return Some(location);
    }
    let corners = filled[location.triangle];
    let weights = location.barycentric;
    let used: Vec<usize> = (0..3).filter(|&k| weights[k] > 0.0).collect();
    if used.iter().any(|&k| corners[k].index() >= n_given) {
        return None;
    }
    let face = given.iter().position(|face| used.iter().all(|&k| face.contains(&corners[k])))?;
    let weight_of =
        |vertex: Vertex| used.iter().find(|&&k| corners[k] == vertex).map_or(0.0, |&k| weights[k]);
    Some(Location { triangle: Face::new(face), barycentric: given[face].map(weight_of) })
}
