// SPDX-License-Identifier: MIT OR Apache-2.0
//! A map read backwards: from points of the disk or the sphere to places on the surface, and from places to points.
//!
//! A map is linear on each face. On the sphere, the image of the place with barycentric coordinates β in a face with
//! corners x₁, x₂, x₃ is the direction of β₁x₁ + β₂x₂ + β₃x₃: the central projection of the flat triangle. So each way
//! is the inverse of the other up to rounding. Where a sphere map has split faces, each part is linear, and places
//! are still counted on the face that was split.
//!
//! Cost: O(m log² m) for a tree over the faces, once; O(log m) for a point.

use std::sync::OnceLock;

use ndarray::{Array1, Array2, ArrayView1, ArrayView2};

use crate::arrays::{from_rows, rows_of};
use crate::control::{Observer, Watch};
use crate::error::{Elements, Error};
use crate::location::{FaceTree, Location, Locator};
use crate::mesh::geometry::triangle;
use crate::mesh::{Face, Vertex};
use crate::parallel;
use crate::sphere::SphereMap;
use crate::vector::Vector3;

/// Points this near to a map of a disk count as on it, in parts of the disk's radius: what rounding moves.
const ROUNDING: f64 = 1e-12;

/// Fewer points are looked up as they come.
const FEW: usize = 2000;

/// Points are located in portions, between which the observer is asked.
const PORTION: usize = 1 << 16;

/// A map whose places can be looked up. It keeps the tree of the faces for the next points.
#[derive(Debug)]
pub struct InverseMap {
    /// In the plane z = 1, or on the unit sphere; those of split points after those of the vertices.
    pub(super) positions: Vec<Vector3>,
    /// The faces of the map, or the parts of its split faces.
    pub(super) faces: Vec<[Vertex; 3]>,
    pub(super) split: Option<Split>,
    pub(super) in_plane: bool,
    n_vertices: usize,
    /// The faces as oriented, without splits.
    pub(super) whole_faces: Vec<[Vertex; 3]>,
    tree: OnceLock<FaceTree>,
}

/// The parts of split faces.
#[derive(Debug)]
pub(super) struct Split {
    /// The face that each part belongs to, ascending.
    pub face_of: Vec<Face>,
    /// The corners of each part in barycentric coordinates of its face.
    corners: Vec<[Vector3; 3]>,
}

/// Places on a surface, one for each point that was looked up.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    /// (k,): the face of each place; −1 where there is none.
    pub triangles: Array1<i64>,
    /// (k, 3): the weights of the corners of that face as oriented; NaN where there is no place.
    pub barycentric: Array2<f64>,
}

/// What becomes of points outside the image of a disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Outside {
    /// They have no place.
    #[default]
    Nowhere,
    /// They take the nearest place on the boundary.
    Nearest,
}

impl InverseMap {
    /// The inverse of a map of a disk: `uv` (n, 2), `faces` (m, 3) as oriented.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] for arrays that are no map.
    pub fn of_disk(uv: ArrayView2<'_, f64>, faces: ArrayView2<'_, u32>) -> Result<Self, Error> {
        let positions = rows_of::<2, _>("uv", uv)?.iter().map(|&[u, v]| Vector3([u, v, 1.0])).collect();
        Self::new(positions, true, face_rows(faces)?, None, uv.nrows())
    }

    /// The inverse of a map onto the sphere, `faces` (m, 3) as oriented.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] for arrays that are no map.
    pub fn of_sphere(map: &SphereMap, faces: ArrayView2<'_, u32>) -> Result<Self, Error> {
        let refinement = map.refinement.as_deref().map(|refinement| RefinedFaces {
            parents: refinement.parents.view(),
            positions: refinement.positions.view(),
            faces: refinement.faces.view(),
            face_of: &refinement.face_of,
        });
        Self::of_positions(map.positions.view(), faces, refinement)
    }

    /// The inverse of a map onto the sphere, given by its arrays.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] for arrays that are no map.
    pub fn of_positions(
        positions: ArrayView2<'_, f64>,
        faces: ArrayView2<'_, u32>,
        refined: Option<RefinedFaces<'_>>,
    ) -> Result<Self, Error> {
        let n_vertices = positions.nrows();
        let mut points: Vec<Vector3> =
            rows_of("positions", positions)?.iter().copied().map(Vector3).collect();
        if let Some(refined) = &refined {
            points.extend(rows_of("positions", refined.positions)?.iter().copied().map(Vector3));
        }
        Self::new(points, false, face_rows(faces)?, refined, n_vertices)
    }

    fn new(
        positions: Vec<Vector3>,
        in_plane: bool,
        whole_faces: Vec<[Vertex; 3]>,
        refined: Option<RefinedFaces<'_>>,
        n_vertices: usize,
    ) -> Result<Self, Error> {
        let (faces, split) = match refined {
            None => (whole_faces.clone(), None),
            Some(refined) => {
                let faces = face_rows(refined.faces)?;
                let split = Split::new(&refined, &faces, &whole_faces, n_vertices)?;
                (faces, Some(split))
            }
        };
        if faces.is_empty() || faces.iter().flatten().any(|vertex| vertex.index() >= positions.len()) {
            let (found, expected) =
                ("of other vertices".into(), "faces between the vertices of the map".into());
            return Err(Error::InvalidArray { name: "faces", found, expected });
        }
        Ok(Self { positions, faces, split, in_plane, n_vertices, whole_faces, tree: OnceLock::new() })
    }

    /// The number of vertices of the surface.
    pub fn n_vertices(&self) -> usize {
        self.n_vertices
    }

    /// The number of faces of the surface.
    pub fn n_faces(&self) -> usize {
        self.whole_faces.len()
    }

    /// The places on the surface whose images are `points`: (k, 2) in the plane, or (k, 3) on the sphere, where only
    /// their directions count. Every point of a whole sphere has a place.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] for points of another shape, not finite, or in the center of the sphere;
    /// [`Error::CancelledEarly`].
    pub fn locate(
        &self,
        points: ArrayView2<'_, f64>,
        outside: Outside,
        observer: &mut dyn Observer,
    ) -> Result<Places, Error> {
        let locations = self.locations(&self.points(points)?, outside, observer)?;
        let triangle = |place: &Option<Location>| place.map_or(-1, |place| place.triangle.index() as i64);
        let barycentric = |place: &Option<Location>| place.map_or([f64::NAN; 3], |place| place.barycentric);
        Ok(Places {
            triangles: locations.iter().map(triangle).collect(),
            barycentric: from_rows(locations.iter().map(barycentric).collect()),
        })
    }

    /// The images of places: (k, 2) or (k, 3); NaN for a place that is none, with the triangle −1.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] for triangles out of range and for arrays of other shapes.
    pub fn image(
        &self,
        triangles: ArrayView1<'_, i64>,
        barycentric: ArrayView2<'_, f64>,
    ) -> Result<Array2<f64>, Error> {
        let weights = rows_of::<3, _>("barycentric", barycentric)?;
        let m = self.n_faces();
        if weights.len() != triangles.len() {
            let found = format!("of {} rows", weights.len());
            let expected = format!("of {} rows, one per triangle", triangles.len());
            return Err(Error::InvalidArray { name: "barycentric", found, expected });
        }
        if let Some(bad) = triangles.iter().find(|&&face| face < -1 || face >= m as i64) {
            let (found, expected) =
                (bad.to_string(), format!("indices of the {m} faces, or −1 for no place"));
            return Err(Error::InvalidArray { name: "triangles", found, expected });
        }
        let image = parallel::map(weights.len(), |place| match usize::try_from(triangles[place]) {
            Ok(face) => self.image_of(Face::new(face), weights[place]),
            Err(_) => Vector3([f64::NAN; 3]),
        });
        Ok(if self.in_plane {
            from_rows(image.iter().map(|x| [x[0], x[1]]).collect())
        } else {
            from_rows(image.into_iter().map(|x| x.0).collect())
        })
    }

    /// The image of a place: in the plane z = 1, or on the unit sphere.
    fn image_of(&self, face: Face, weights: [f64; 3]) -> Vector3 {
        let (part, weights) = match &self.split {
            None => (face, weights),
            Some(split) => split.part_with(face, weights),
        };
        let corners = triangle(&self.positions, self.faces[part]);
        let flat = corners[0] * weights[0] + (corners[1] * weights[1] + corners[2] * weights[2]);
        if self.in_plane { flat } else { flat.normalized() }
    }

    /// The places of points in the plane z = 1, or of directions.
    pub(super) fn locations(
        &self,
        points: &[Vector3],
        outside: Outside,
        observer: &mut dyn Observer,
    ) -> Result<Vec<Option<Location>>, Error> {
        let tree = self.tree.get_or_init(|| FaceTree::new(&self.positions, &self.faces)).clone();
        let locator = Locator::with_tree(&self.positions, &self.faces, tree);
        let place = |x: Vector3| match outside {
            Outside::Nowhere => locator.locate_within(x, ROUNDING),
            Outside::Nearest => Some(locator.locate(x)),
        };
        let watch = Watch::new(observer, 0.0, "Looking up places");
        // neighbors one after the other, so that the faces around them are in the cache
        let order = along_curve(points);
        let mut locations = vec![None; points.len()];
        for (done, portion) in order.chunks(PORTION).enumerate() {
            watch.reach((done * PORTION) as f64 / points.len() as f64);
            if !watch.goes_on() {
                return Err(Error::CancelledEarly);
            }
            let found = parallel::map(portion.len(), |k| {
                place(points[portion[k]]).map(|location| self.on_whole_face(location))
            });
            portion.iter().zip(found).for_each(|(&point, location)| locations[point] = location);
        }
        Ok(locations)
    }

    /// The face that a part belongs to, and the place there of the middle of the part.
    pub(super) fn middle_of(&self, part: usize) -> (usize, [f64; 3]) {
        let location = Location { triangle: Face::new(part), barycentric: [1.0 / 3.0; 3] };
        let Location { triangle, barycentric } = self.on_whole_face(location);
        (triangle.index(), barycentric)
    }

    /// A place on a part of a face as a place on the face.
    fn on_whole_face(&self, Location { triangle, barycentric }: Location) -> Location {
        match &self.split {
            None => Location { triangle, barycentric },
            Some(split) => split.on_whole_face(triangle, barycentric),
        }
    }

    /// Points of the plane or the sphere as the locator takes them.
    pub(super) fn points(&self, points: ArrayView2<'_, f64>) -> Result<Vec<Vector3>, Error> {
        let points: Vec<Vector3> = if self.in_plane {
            rows_of::<2, _>("points", points)?.iter().map(|&[u, v]| Vector3([u, v, 1.0])).collect()
        } else {
            rows_of("points", points)?.iter().map(|&point| in_range(Vector3(point))).collect()
        };
        let is_bad = |point: &Vector3| !point.is_finite();
        match Elements::collect((0..points.len()).filter(|&k| is_bad(&points[k]))) {
            None => Ok(points),
            Some(bad) => Err(Error::InvalidArray {
                name: "points",
                found: format!("no such thing in {} of its rows ({bad})", bad.count),
                expected: if self.in_plane { "finite" } else { "finite, and no row zero" }.into(),
            }),
        }
    }
}

/// The points along Morton's curve (1966) through the cells of a grid of 1024³, which passes through neighbors together.
fn along_curve(points: &[Vector3]) -> Vec<usize> {
    if points.len() < FEW {
        return (0..points.len()).collect();
    }
    let mut keys: Vec<(u32, u32)> = parallel::map(points.len(), |point| {
        // directions at one distance, points of a plane within their square
        let cell = points[point].normalized().map(|x| 512.0 * (x + 1.0));
        let bits = |axis: usize| spread((cell[axis] as u32).min(1023)) << axis;
        (bits(0) | bits(1) | bits(2), point as u32)
    });
    keys.sort_unstable();
    keys.into_iter().map(|(_, point)| point as usize).collect()
}

/// The ten bits of a number, each followed by two zeros.
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00FF;
    let x = (x | x << 8) & 0x0300_F00F;
    let x = (x | x << 4) & 0x030C_30C3;
    (x | x << 2) & 0x0924_9249
}

/// A direction whose square does not overflow or vanish; NaN where it is zero.
fn in_range(direction: Vector3) -> Vector3 {
    let size = direction.max_abs();
    if (1e-100..1e100).contains(&size) { direction } else { direction * (1.0 / size) }
}

/// The split faces of a map onto the sphere, as in [`Refinement`](crate::Refinement).
#[derive(Debug, Clone, Copy)]
pub struct RefinedFaces<'a> {
    /// (k, 2): the ends of the edge that each split point halves.
    pub parents: ArrayView2<'a, u32>,
    /// (k, 3): the images of the split points.
    pub positions: ArrayView2<'a, f64>,
    /// (m', 3): the parts of the faces.
    pub faces: ArrayView2<'a, u32>,
    /// (m',): the face that each part belongs to, ascending.
    pub face_of: &'a [usize],
}

impl Split {
    fn new(
        refined: &RefinedFaces<'_>,
        parts: &[[Vertex; 3]],
        whole_faces: &[[Vertex; 3]],
        n_vertices: usize,
    ) -> Result<Self, Error> {
        let parents = rows_of::<2, _>("parents", refined.parents)?;
        let misfit = || {
            let (found, expected) = ("of another map".into(), "those of the map's split faces".into());
            Error::InvalidArray { name: "refinement", found, expected }
        };
        // each split point as a mean of vertices
        let mut weights: Vec<Vec<(Vertex, f64)>> = Vec::with_capacity(parents.len());
        for (point, ends) in parents.iter().enumerate() {
            if ends.iter().any(|&end| end as usize >= n_vertices + point) {
                return Err(misfit());
            }
            weights.push(halfway(ends.map(|end| of_vertices(end as usize, n_vertices, &weights))));
        }
        if refined.face_of.len() != parts.len()
            || !refined.face_of.is_sorted()
            || refined.face_of.last().is_some_and(|&face| face >= whole_faces.len())
            || parts.iter().flatten().any(|corner| corner.index() >= n_vertices + parents.len())
        {
            return Err(misfit());
        }
        let corners = (0..parts.len()).map(|part| {
            let whole = whole_faces[refined.face_of[part]];
            parts[part].map(|corner| {
                let weights = of_vertices(corner.index(), n_vertices, &weights);
                Vector3(
                    whole.map(|vertex| weights.iter().filter(|(of, _)| *of == vertex).map(|(_, w)| w).sum()),
                )
            })
        });
        let corners = corners.collect();
        Ok(Self { face_of: refined.face_of.iter().map(|&face| Face::new(face)).collect(), corners })
    }

    /// A place on a part as a place on its face.
    fn on_whole_face(&self, part: Face, weights: [f64; 3]) -> Location {
        let corners = self.corners[part];
        let sum = corners[0] * weights[0] + (corners[1] * weights[1] + corners[2] * weights[2]);
        Location { triangle: self.face_of[part], barycentric: sum.0 }
    }

    /// The part of a face in which a place lies, and the place there.
    fn part_with(&self, face: Face, weights: [f64; 3]) -> (Face, [f64; 3]) {
        let first = self.face_of.partition_point(|&of| of < face);
        let parts = (first..self.face_of.len()).take_while(|&part| self.face_of[part] == face);
        let in_part = |part: usize| {
            // areas in barycentric coordinates are determinants
            let [a, b, c] = self.corners[part];
            let x = Vector3(weights);
            let whole = a.dot(b.cross(c));
            let inside = [x.dot(b.cross(c)), a.dot(x.cross(c)), a.dot(b.cross(x))].map(|area| area / whole);
            (Face::new(part), inside)
        };
        let least = |weights: [f64; 3]| weights.into_iter().fold(f64::INFINITY, f64::min);
        let best = parts.map(in_part).max_by(|(_, a), (_, b)| least(*a).total_cmp(&least(*b)));
        best.expect("each face has parts")
    }
}

/// A vertex or a split point as a mean of vertices.
fn of_vertices(index: usize, n_vertices: usize, split: &[Vec<(Vertex, f64)>]) -> Vec<(Vertex, f64)> {
    match index.checked_sub(n_vertices) {
        None => vec![(Vertex::new(index), 1.0)],
        Some(point) => split[point].clone(),
    }
}

/// The middle between two means of vertices.
fn halfway([one, other]: [Vec<(Vertex, f64)>; 2]) -> Vec<(Vertex, f64)> {
    let mut sum: Vec<(Vertex, f64)> = Vec::new();
    for (vertex, weight) in one.into_iter().chain(other) {
        match sum.iter_mut().find(|(of, _)| *of == vertex) {
            Some((_, half)) => *half += 0.5 * weight,
            None => sum.push((vertex, 0.5 * weight)),
        }
    }
    sum
}

fn face_rows(faces: ArrayView2<'_, u32>) -> Result<Vec<[Vertex; 3]>, Error> {
    Ok(rows_of::<3, _>("faces", faces)?.iter().map(|face| face.map(Vertex)).collect())
}
