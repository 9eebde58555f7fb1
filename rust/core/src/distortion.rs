// SPDX-License-Identifier: MIT OR Apache-2.0
//! Quality figures of a map: area ratios, authalic energy, folds, angle distortion.
//!
//! Areas are signed: the image area of a folded face is negative, its log₂ area ratio −∞ and its angle
//! distortion +∞, so it never scores like a good one. Target areas are rescaled so that their sum is the
//! image's area A = Σ|a_τ|; then E_A = Σ (a_τ − |τ|)²/|τ| (Liu & Yueh 2023, equations (5.1) and (5.2)).
//! Exact predicates decide which faces are folded.

use std::borrow::Cow;

use ndarray::{Array1, Array2, ArrayView1, ArrayView2};
use robust::{Coord, Coord3D, orient2d, orient3d};

use crate::arrays::{from_rows, from_vectors, rows_of};
use crate::error::{Elements, Error, MapError};
use crate::mesh::geometry::{area, triangle};
use crate::mesh::{Face, Surface, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Lower bound of a density, in units of the largest.
const SMALLEST_DENSITY: f64 = 1e-12;

/// The figures of one map. Per-face arrays have one entry per face, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Distortion {
    /// E_A on targets rescaled to the image's area; 0 for an area-preserving map.
    pub authalic_energy: f64,
    /// Mean over the faces of the signed image area over the rescaled target; 1 for an area-preserving map.
    pub area_ratio_mean: f64,
    /// Population standard deviation of the area ratio.
    pub area_ratio_std: f64,
    /// log₂ of the area ratio of each face, (m,); −∞ for a folded face.
    pub log2_area_ratio: Array1<f64>,
    /// Faces whose exact orientation in the image is not positive, ascending.
    pub folded: Vec<usize>,
    /// σ₁/σ₂ ≥ 1 of the linear map of each face, (m,); 1 where angles are preserved, +∞ for a folded face.
    pub angle_distortion: Array1<f64>,
    /// Mean of [`Self::angle_distortion`] over the faces.
    pub angle_distortion_mean: f64,
    /// 99th percentile of [`Self::angle_distortion`], linearly interpolated.
    pub angle_distortion_p99: f64,
    /// Maximum of [`Self::angle_distortion`].
    pub angle_distortion_max: f64,
}

/// A map of vertices, into the plane or onto the unit sphere.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Image<'a> {
    /// (n, 2) positions; a face is positive where it runs counter-clockwise.
    Plane(&'a [[f64; 2]]),
    /// (n, 3) positions around the origin; a face is positive where it is seen counter-clockwise from
    /// outside.
    Sphere(&'a [Vector3]),
}

impl Image<'_> {
    /// The number of vertices.
    pub(crate) fn len(self) -> usize {
        match self {
            Self::Plane(map) => map.len(),
            Self::Sphere(map) => map.len(),
        }
    }

    /// The image of a vertex as a point in space, where the plane is z = 0.
    pub(crate) fn point(self, vertex: Vertex) -> Vector3 {
        match self {
            Self::Plane(map) => Vector3([map[vertex][0], map[vertex][1], 0.0]),
            Self::Sphere(map) => map[vertex],
        }
    }
}

/// A map of vertices that is owned.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OwnedImage {
    /// (n, 2) positions in the plane.
    Plane(Vec<[f64; 2]>),
    /// (n, 3) positions around the origin.
    Sphere(Vec<Vector3>),
}

impl OwnedImage {
    /// The rows of an array for the `n_vertices` vertices of a surface.
    pub(crate) fn new(array: ArrayView2<'_, f64>, n_vertices: usize) -> Result<Self, Error> {
        let (length, width) = array.dim();
        if !matches!(width, 2 | 3) {
            let (found, expected) =
                (format!("of shape ({length}, {width})"), "of shape (n, 2) or (n, 3)".into());
            return Err(Error::InvalidArray { name: "image", found, expected });
        }
        if length != n_vertices {
            let expected = format!("of shape ({n_vertices}, 2) or ({n_vertices}, 3), one row per vertex");
            return Err(Error::InvalidArray { name: "image", found: format!("of {length} rows"), expected });
        }
        match width {
            2 => Ok(Self::Plane(rows_of("image", array)?.into_owned())),
            _ => Ok(Self::Sphere(rows_of("image", array)?.iter().copied().map(Vector3).collect())),
        }
    }

    /// The map as the functions inside take it.
    pub(crate) fn view(&self) -> Image<'_> {
        match self {
            Self::Plane(map) => Image::Plane(map),
            Self::Sphere(map) => Image::Sphere(map),
        }
    }

    /// The map as an array, (n, 2) or (n, 3).
    pub(crate) fn into_array(self) -> Array2<f64> {
        match self {
            Self::Plane(map) => from_rows(map),
            Self::Sphere(map) => from_vectors(map),
        }
    }
}

/// An image scaled by a power of two to coordinates of size 1: exact, and safe from over- and underflow.
#[derive(Clone, Copy)]
struct Scaled<'a> {
    image: Image<'a>,
    factor: f64,
}

impl<'a> Scaled<'a> {
    /// Refuses coordinates that are not finite.
    fn new(image: Image<'a>) -> Result<Self, Error> {
        let not_finite = (0..image.len()).filter(|&vertex| !image.point(Vertex::new(vertex)).is_finite());
        if let Some(vertices) = Elements::collect(not_finite) {
            return Err(MapError::NonFinite { name: "image", vertices }.into());
        }
        let largest = (0..image.len())
            .fold(0.0, |most, vertex| f64::max(most, image.point(Vertex::new(vertex)).max_abs()));
        let exponent = if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0) } else { 0.0 };
        Ok(Self { image, factor: (-exponent).exp2() })
    }

    fn corners(&self, face: [Vertex; 3]) -> [Vector3; 3] {
        face.map(|vertex| self.image.point(vertex) * self.factor)
    }

    fn is_folded(&self, face: [Vertex; 3]) -> bool {
        let corners = self.corners(face);
        match self.image {
            Image::Plane(_) => {
                let [a, b, c] = corners.map(|Vector3([x, y, _])| Coord { x, y });
                orient2d(a, b, c) <= 0.0
            }
            Image::Sphere(_) => {
                let [a, b, c] = corners.map(|Vector3([x, y, z])| Coord3D { x, y, z });
                // positive where the origin lies below the plane through a, b, c
                orient3d(a, b, c, Coord3D { x: 0.0, y: 0.0, z: 0.0 }) <= 0.0
            }
        }
    }
}

/// Faces whose exact orientation in the plane is not positive, ascending. Coordinates must be finite and
/// moderate.
pub fn folded_in_plane(faces: &[[Vertex; 3]], map: &[[f64; 2]]) -> Vec<usize> {
    folded(faces, Scaled { image: Image::Plane(map), factor: 1.0 })
}

/// Faces whose exact orientation around the origin is not positive, ascending: the folds of an outward oriented map
/// onto the sphere. Coordinates must be finite and moderate.
pub fn folded_on_sphere(faces: &[[Vertex; 3]], map: &[Vector3]) -> Vec<usize> {
    folded(faces, Scaled { image: Image::Sphere(map), factor: 1.0 })
}

/// Measures a map of a surface: area ratios, authalic energy, folds, angle distortion.
///
/// `image` is (n, 2) in the plane, where a face is positive counter-clockwise, or (n, 3) around the origin, where it is
/// positive counter-clockwise from outside. `density` (m,) is a positive target measure of each face on any scale; the
/// face areas where `None`. Targets are rescaled so that they sum to the image's area. The surface need not be a
/// manifold.
///
/// # Errors
/// Faces without area, an image or a density of another shape, coordinates that are not finite, a density that is not
/// positive, an image without area.
///
/// ```
/// use authalic::{Surface, distortion};
/// use ndarray::array;
///
/// let vertices = array![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let square = Surface::new(&vertices, array![[0, 1, 2], [0, 2, 3]])?;
/// let image = array![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
/// let figures = distortion(&square, image.view(), None)?;
/// assert_eq!(figures.area_ratio_std, 0.0);
/// assert!((figures.angle_distortion_max - 2.0).abs() < 1e-12);
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn distortion(
    surface: &Surface,
    image: ArrayView2<'_, f64>,
    density: Option<ArrayView1<'_, f64>>,
) -> Result<Distortion, Error> {
    let image = OwnedImage::new(image, surface.n_vertices())?;
    let triangles = surface.triangles()?;
    let targets = targets(density, triangles.areas)?;
    measure(triangles.points, triangles.faces, image.view(), &targets)
}

/// A surface with an image and maybe a density of its own, as [`distortion`] takes them.
pub type Measurable = (Surface, Array2<f64>, Option<Array1<f64>>);

/// Measures many maps in one go, each as [`distortion`] does.
pub fn distortions(maps: &[Measurable]) -> Vec<Result<Distortion, Error>> {
    parallel::lone_tasks(maps.len(), |k| {
        let (surface, image, density) = &maps[k];
        distortion(surface, image.view(), density.as_ref().map(|density| density.view()))
    })
}

/// Measures a map of the surface `points`, `faces` with one positive target area per face.
///
/// The lengths must agree, indices must be in range, and the faces must have area and one orientation, as those of a
/// [`TriangleMesh`](crate::mesh::TriangleMesh) do.
///
/// # Errors
/// [`MapError::NonFinite`] for coordinates that are not finite, [`Error::InvalidArray`] where the whole image
/// has no area.
pub(crate) fn measure(
    points: &[Vector3],
    faces: &[[Vertex; 3]],
    image: Image<'_>,
    targets: &[f64],
) -> Result<Distortion, Error> {
    let image = Scaled::new(image)?;
    figures(points, faces, image, folded(faces, image), targets)
}

/// Measures a map of a surface onto another in space, whose `folded` faces are known otherwise.
///
/// # Errors
/// As [`distortion`].
pub(crate) fn distortion_in_space(
    points: &[Vector3],
    faces: &[[Vertex; 3]],
    image: &[Vector3],
    folded: Vec<usize>,
    targets: &[f64],
) -> Result<Distortion, Error> {
    figures(points, faces, Scaled::new(Image::Sphere(image))?, folded, targets)
}

fn figures(
    points: &[Vector3],
    faces: &[[Vertex; 3]],
    image: Scaled<'_>,
    folded: Vec<usize>,
    targets: &[f64],
) -> Result<Distortion, Error> {
    // 1. Signed areas of the image
    let areas = signed_areas(faces, image, &folded);
    // 2. Singular values of the linear map of each face
    let angle = angle_distortion(points, faces, image, &folded);
    assembled(&areas, targets, folded, angle, image.factor)
}

/// The figures by signed image areas, in an image scaled by `factor`, targets, and σ₁/σ₂ of all faces.
fn assembled(
    areas: &[f64],
    targets: &[f64],
    folded: Vec<usize>,
    angle: Vec<f64>,
    factor: f64,
) -> Result<Distortion, Error> {
    // 1. The scale c = A/|M| of the targets
    let scale = parallel::sum(areas.len(), |face| areas[face].abs())
        / parallel::sum(targets.len(), |face| targets[face]);
    if !(scale > 0.0 && scale.is_finite()) {
        let found = "collapsed to a line or a point".to_string();
        return Err(Error::InvalidArray {
            name: "image",
            found,
            expected: "a map whose faces have area".into(),
        });
    }
    // 2. Area ratios and their figures
    let ratio = parallel::map(areas.len(), |face| areas[face] / (scale * targets[face]));
    let count = ratio.len() as f64;
    let mean = parallel::sum(ratio.len(), |face| ratio[face]) / count;
    let variance = parallel::sum(ratio.len(), |face| (ratio[face] - mean).powi(2)) / count;
    let energy = parallel::sum(ratio.len(), |face| scale * targets[face] * (ratio[face] - 1.0).powi(2));
    let energy = energy / factor / factor;
    let (angle_mean, angle_p99, angle_max) = summary(&angle);
    Ok(Distortion {
        authalic_energy: energy,
        area_ratio_mean: mean,
        area_ratio_std: variance.sqrt(),
        log2_area_ratio: parallel::map(ratio.len(), |face| ratio[face].max(0.0).log2()).into(),
        folded,
        angle_distortion: angle.into(),
        angle_distortion_mean: angle_mean,
        angle_distortion_p99: angle_p99,
        angle_distortion_max: angle_max,
    })
}

/// Measures a map of faces that consist of parts: the area of a face is the sum over its parts, its σ₁/σ₂ their mean by
/// target, and it is folded where a part is.
///
/// `of_parts` has the figures of the parts by [`distortion`], the other arguments are as there; `face_of` has the face
/// of each part, ascending from 0 without gaps.
///
/// # Errors
/// As [`distortion`].
pub(crate) fn distortion_of_wholes(
    of_parts: &Distortion,
    parts: &[[Vertex; 3]],
    image: Image<'_>,
    targets: &[f64],
    face_of: &[Face],
) -> Result<Distortion, Error> {
    let image = Scaled::new(image)?;
    let areas = signed_areas(parts, image, &of_parts.folded);
    let n_faces = face_of.last().map_or(0, |face| face.index() + 1);
    let mut sums = vec![[0.0; 3]; n_faces];
    for (part, &face) in face_of.iter().enumerate() {
        let values = [areas[part], targets[part], targets[part] * of_parts.angle_distortion[part]];
        (0..3).for_each(|k| sums[face][k] += values[k]);
    }
    let mut folded: Vec<usize> = of_parts.folded.iter().map(|&part| face_of[part].index()).collect();
    folded.dedup();
    let [areas, targets, angle] = [0, 1, 2].map(|k| sums.iter().map(|sum| sum[k]).collect::<Vec<f64>>());
    let angle = angle.iter().zip(&targets).map(|(sum, target)| sum / target).collect();
    assembled(&areas, &targets, folded, angle, image.factor)
}

/// The target measure of each face: the given one, or its area.
///
/// # Errors
/// As [`normalized_density`].
pub(crate) fn targets<'a>(
    density: Option<ArrayView1<'_, f64>>,
    areas: &'a [f64],
) -> Result<Cow<'a, [f64]>, Error> {
    match density {
        Some(density) => Ok(normalized_density(&density.to_vec(), areas.len())?.into()),
        None => Ok(areas.into()),
    }
}

/// Checks one target measure per face and scales the largest to 1, so that sums neither over- nor underflow.
///
/// # Errors
/// [`Error::InvalidArray`] for another length, [`MapError::Density`] for values that are not positive and
/// finite.
pub(crate) fn normalized_density(density: &[f64], n_faces: usize) -> Result<Vec<f64>, Error> {
    if density.len() != n_faces {
        let (found, expected) =
            (format!("of shape ({},)", density.len()), format!("of shape ({n_faces},), one value per face"));
        return Err(Error::InvalidArray { name: "density", found, expected });
    }
    let finite = density.iter().copied().filter(|value| value.is_finite());
    let largest = finite.fold(0.0, f64::max);
    // a target far below the others leaves the energy no digits
    let good = |value: f64| value.is_finite() && value > 0.0 && value >= SMALLEST_DENSITY * largest;
    if let Some(faces) = Elements::collect((0..n_faces).filter(|&face| !good(density[face]))) {
        return Err(MapError::Density { value: density[faces.first[0]], faces }.into());
    }
    Ok(density.iter().map(|value| value / largest).collect())
}

fn folded(faces: &[[Vertex; 3]], image: Scaled<'_>) -> Vec<usize> {
    let is_folded = parallel::map(faces.len(), |face| image.is_folded(faces[face]));
    (0..faces.len()).filter(|&face| is_folded[face]).collect()
}

/// Flat image areas with the exact sign; the rounded sign differs only for areas of rounding size.
fn signed_areas(faces: &[[Vertex; 3]], image: Scaled<'_>, folded: &[usize]) -> Vec<f64> {
    let mut areas = parallel::map(faces.len(), |face| area(image.corners(faces[face])));
    for &face in folded {
        areas[face] = -areas[face];
    }
    areas
}

fn angle_distortion(
    points: &[Vector3],
    faces: &[[Vertex; 3]],
    image: Scaled<'_>,
    folded: &[usize],
) -> Vec<f64> {
    let mut ratios = parallel::map(faces.len(), |face| {
        singular_value_ratio(triangle(points, faces[face]), image.corners(faces[face]))
    });
    for &face in folded {
        ratios[face] = f64::INFINITY;
    }
    ratios
}

/// σ₁/σ₂ of the linear map from one triangle to another, both laid into the plane.
///
/// σ₁ ± σ₂ come from the conformal and the anticonformal part of the map, which does not cancel near σ₁ = σ₂.
fn singular_value_ratio(rest: [Vector3; 3], image: [Vector3; 3]) -> f64 {
    let ([base, x, height], [to_base, to_x, to_height]) = (laid_flat(rest), laid_flat(image));
    let (a, d) = (to_base / base, to_height / height);
    let b = (to_x - x * a) / height;
    let (sum, difference) = ((a + d).hypot(b), (a - d).hypot(b));
    if sum > difference { (sum + difference) / (sum - difference) } else { f64::INFINITY }
}

/// A triangle as (0, 0), (base, 0), (x, height).
fn laid_flat([a, b, c]: [Vector3; 3]) -> [f64; 3] {
    let base = a.distance(b);
    [base, (c - a).dot(b - a) / base, 2.0 * area([a, b, c]) / base]
}

/// Mean, 99th percentile and maximum.
fn summary(values: &[f64]) -> (f64, f64, f64) {
    let mean = parallel::sum(values.len(), |i| values[i]) / values.len() as f64;
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len() - 1;
    let position = 0.99 * last as f64;
    let (low, part) = (position as usize, position.fract());
    let p99 = if part > 0.0 { sorted[low] * (1.0 - part) + sorted[low + 1] * part } else { sorted[low] };
    (mean, p99, sorted[last])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::faces_of_indices;

    const SQUARE: [Vector3; 4] = [
        Vector3([0.0, 0.0, 0.0]),
        Vector3([1.0, 0.0, 0.0]),
        Vector3([1.0, 1.0, 0.0]),
        Vector3([0.0, 1.0, 0.0]),
    ];
    const HALVES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn measured(map: &[[f64; 2]]) -> Distortion {
        measure(&SQUARE, &faces_of_indices(&HALVES), Image::Plane(map), &[0.5, 0.5]).unwrap()
    }

    #[test]
    fn an_affine_map_keeps_area_ratios_and_has_its_own_singular_values() {
        // diag(6, 2): singular values 6 and 2
        let figures = measured(&[[0.0, 0.0], [6.0, 0.0], [6.0, 2.0], [0.0, 2.0]]);
        assert_eq!(figures.area_ratio_std, 0.0);
        assert_eq!(figures.authalic_energy, 0.0);
        figures.angle_distortion.iter().for_each(|ratio| assert!((ratio - 3.0).abs() < 1e-14));
    }

    #[test]
    fn a_shear_has_the_singular_values_of_its_matrix() {
        // [[1, 1], [0, 1]]: the ratio is the square of the golden ratio
        let figures = measured(&[[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [1.0, 1.0]]);
        let golden = (1.0 + 5f64.sqrt()) / 2.0;
        figures.angle_distortion.iter().for_each(|ratio| assert!((ratio - golden * golden).abs() < 1e-13));
    }

    #[test]
    fn a_folded_face_never_scores_like_a_good_one() {
        let figures = measured(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0]]);
        assert_eq!(figures.folded, [1]);
        assert_eq!(figures.log2_area_ratio[1], f64::NEG_INFINITY);
        assert_eq!(figures.angle_distortion_max, f64::INFINITY);
        assert_eq!(figures.area_ratio_std, 1.0);
        assert_eq!(figures.authalic_energy, 2.0);
    }

    #[test]
    fn a_face_within_rounding_of_a_line_is_decided_exactly() {
        let faces = [[0, 1, 2].map(Vertex)];
        // the third point lies off the line through the others by less than the rounding of the products
        let above = [[0.0, 0.0], [1e16, 1e16], [3.0, 3.0 + 4.440892098500626e-16]];
        let below = [[0.0, 0.0], [1e16, 1e16], [3.0, 3.0 - 4.440892098500626e-16]];
        assert!(folded_in_plane(&faces, &above).is_empty());
        assert_eq!(folded_in_plane(&faces, &below), [0]);
    }

    #[test]
    fn faces_of_the_sphere_are_positive_seen_from_outside() {
        let octant = [0, 1, 2].map(Vector3::unit);
        let figures = |face| measure(&octant, &[face], Image::Sphere(&octant), &[1.0]).unwrap();
        assert!(figures([0, 1, 2].map(Vertex)).folded.is_empty());
        assert_eq!(figures([0, 2, 1].map(Vertex)).folded, [0]);
    }

    #[test]
    fn a_collapsed_image_is_refused() {
        let flat = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]];
        let refused = measure(&SQUARE, &faces_of_indices(&HALVES), Image::Plane(&flat), &[0.5, 0.5]);
        assert!(matches!(refused, Err(Error::InvalidArray { name: "image", .. })));
    }

    #[test]
    fn the_percentile_is_interpolated() {
        let values: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!(summary(&values), (50.0, 99.0, 100.0));
        assert!((summary(&values[..51]).1 - 49.5).abs() < 1e-12);
    }
}
