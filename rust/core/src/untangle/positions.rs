// SPDX-License-Identifier: MIT OR Apache-2.0
//! The positions of a map in the plane or on the sphere, and the flat charts of its patches.
//!
//! The sphere's charts are gnomonic: great circles become straight lines, so a face is folded in the chart if and only
//! if it is folded on the sphere.

use crate::distortion::{Image, OwnedImage, folded_in_plane, folded_on_sphere};
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::Vector3;

/// Least cosine of the angle between the rim of a patch on the sphere and the center of its chart.
const RIM: f64 = 0.1;

/// Least cosine of the angle between points and the center of a chart; points beyond are moved to it.
const HORIZON: f64 = 0.05;

/// The positions of a map, of size 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Positions {
    Plane(Vec<[f64; 2]>),
    Sphere(Vec<Vector3>),
}

impl Positions {
    /// The given positions; in the plane scaled by a power of two to size 1.
    pub(super) fn new(image: Image<'_>) -> Self {
        match image {
            Image::Sphere(map) => Self::Sphere(map.to_vec()),
            Image::Plane(map) => {
                let factor = 1.0 / unit(map);
                Self::Plane(map.iter().map(|x| x.map(|x| x * factor)).collect())
            }
        }
    }

    /// The indices of the folded faces among `faces`.
    pub(super) fn folded(&self, faces: &[[Vertex; 3]]) -> Vec<usize> {
        match self {
            Self::Plane(map) => folded_in_plane(faces, map),
            Self::Sphere(map) => folded_on_sphere(faces, map),
        }
    }

    /// Whether each vertex is in a component most of whose area is mirrored.
    pub(super) fn mirrored(&self, mesh: &TriangleMesh, components: &[usize]) -> Vec<bool> {
        let n_components = components.iter().max().map_or(0, |&last| last + 1);
        let mut areas = vec![0.0; n_components];
        for face in mesh.faces() {
            areas[components[face[0]]] += self.signed_area(*face);
        }
        components.iter().map(|&component| areas[component] < 0.0).collect()
    }

    /// Twice the area of a face, with the sign of its orientation.
    fn signed_area(&self, face: [Vertex; 3]) -> f64 {
        match self {
            Self::Plane(map) => super::triangle::doubled_area(face.map(|v| map[v])).0,
            Self::Sphere(map) => {
                let [a, b, c] = face.map(|v| map[v]);
                a.dot(b.cross(c))
            }
        }
    }

    /// The positions with some vertices mirrored.
    pub(super) fn turned_over(&self, mirrored: &[bool]) -> Self {
        match self {
            Self::Plane(map) => {
                let turned = map.iter().zip(mirrored).map(|(&[x, y], &is)| [if is { -x } else { x }, y]);
                Self::Plane(turned.collect())
            }
            Self::Sphere(map) => {
                let turned = map.iter().zip(mirrored).map(|(&x, &is)| if is { x * -1.0 } else { x });
                Self::Sphere(turned.collect())
            }
        }
    }

    /// Whether a vertex lies elsewhere in another map.
    pub(super) fn differs(&self, other: &Self, vertex: usize) -> bool {
        match (self, other) {
            (Self::Plane(here), Self::Plane(there)) => here[vertex] != there[vertex],
            (Self::Sphere(here), Self::Sphere(there)) => here[vertex] != there[vertex],
            _ => true,
        }
    }

    /// Puts a vertex where it is in another map.
    pub(super) fn copy(&mut self, other: &Self, vertex: Vertex) {
        match (self, other) {
            (Self::Plane(here), Self::Plane(there)) => here[vertex] = there[vertex],
            (Self::Sphere(here), Self::Sphere(there)) => here[vertex] = there[vertex],
            _ => {}
        }
    }

    /// The positions of some vertices.
    pub(super) fn at(&self, vertices: &[Vertex]) -> Self {
        match self {
            Self::Plane(map) => Self::Plane(vertices.iter().map(|&v| map[v]).collect()),
            Self::Sphere(map) => Self::Sphere(vertices.iter().map(|&v| map[v]).collect()),
        }
    }

    /// Puts some vertices to positions that [`Self::at`] has read.
    pub(super) fn put(&mut self, vertices: &[Vertex], positions: &Self) {
        match (self, positions) {
            (Self::Plane(map), Self::Plane(kept)) => {
                vertices.iter().zip(kept).for_each(|(&v, &x)| map[v] = x);
            }
            (Self::Sphere(map), Self::Sphere(kept)) => {
                vertices.iter().zip(kept).for_each(|(&v, &x)| map[v] = x);
            }
            _ => {}
        }
    }

    /// The distance of a vertex from the mean of its neighbors, where one shared by two faces counts twice.
    pub(super) fn distance_from_neighbors(&self, mesh: &TriangleMesh, vertex: Vertex) -> f64 {
        let corners = mesh.vertex_corners(vertex);
        let ring = corners.iter().flat_map(|&corner| mesh.faces()[corner.face()]);
        let ring = ring.filter(|&neighbor| neighbor != vertex);
        let share = 0.5 / corners.len() as f64;
        let place = |v: Vertex| match self {
            Self::Plane(map) => Vector3([map[v][0], map[v][1], 0.0]),
            Self::Sphere(map) => map[v],
        };
        let mean = ring.fold(Vector3::ZERO, |sum, neighbor| sum + place(neighbor)) * share;
        mean.distance(place(vertex))
    }

    /// Whether two vertices are in the same place.
    pub(super) fn coincide(&self, a: Vertex, b: Vertex) -> bool {
        match self {
            Self::Plane(map) => map[a] == map[b],
            Self::Sphere(map) => map[a] == map[b],
        }
    }

    /// The given image with the positions of the moved vertices replaced.
    pub(super) fn written_over(&self, image: Image<'_>, moved: &[usize]) -> OwnedImage {
        match (self, image) {
            (Self::Plane(map), Image::Plane(given)) => {
                let (mut out, unit) = (given.to_vec(), unit(given));
                moved.iter().for_each(|&v| out[v] = map[v].map(|x| x * unit));
                OwnedImage::Plane(out)
            }
            (Self::Sphere(map), Image::Sphere(given)) => {
                let mut out = given.to_vec();
                moved.iter().for_each(|&v| out[v] = map[v]);
                OwnedImage::Sphere(out)
            }
            _ => self.clone().into_image(),
        }
    }

    /// The positions as they are.
    pub(super) fn into_image(self) -> OwnedImage {
        match self {
            Self::Plane(map) => OwnedImage::Plane(map),
            Self::Sphere(map) => OwnedImage::Sphere(map),
        }
    }
}

/// The largest power of two up to the largest coordinate; 1 if all are 0.
fn unit(map: &[[f64; 2]]) -> f64 {
    let largest = map.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0).exp2() } else { 1.0 }
}

/// A flat chart.
#[derive(Debug, Clone, Copy)]
pub(super) enum Chart {
    /// The plane around a center.
    Plane { center: [f64; 2], scale: f64 },
    /// The plane that touches the sphere of this radius at the third axis.
    Gnomonic { axes: [Vector3; 3], radius: f64, scale: f64 },
}

impl Chart {
    /// The plane as it is.
    #[cfg(test)]
    pub(super) fn identity() -> Self {
        Self::Plane { center: [0.0; 2], scale: 1.0 }
    }

    /// A chart around held vertices; `None` if there are none, or if they do not fit into a hemisphere.
    pub(super) fn around(positions: &Positions, rim: &[Vertex]) -> Option<Self> {
        if rim.is_empty() {
            return None;
        }
        let share = 1.0 / rim.len() as f64;
        match positions {
            Positions::Plane(map) => {
                let sum = rim.iter().map(|&v| map[v]).fold([0.0; 2], |s, x| [s[0] + x[0], s[1] + x[1]]);
                Some(Self::Plane { center: sum.map(|x| x * share), scale: 1.0 })
            }
            Positions::Sphere(map) => {
                let directions: Vec<Vector3> = rim.iter().map(|&v| unit_vector(map[v])).collect();
                let mean = directions.iter().fold(Vector3::ZERO, |sum, &x| sum + x);
                let radius = share * rim.iter().map(|&v| map[v].norm()).sum::<f64>();
                let radius = if (radius - 1.0).abs() < 1e-6 { 1.0 } else { radius };
                let axes = tangent_frame(unit_vector(mean));
                let fits = directions.iter().all(|&x| x.dot(axes[2]) > RIM);
                fits.then_some(Self::Gnomonic { axes, radius, scale: 1.0 })
            }
        }
    }

    /// The chart with the scale `factor`.
    pub(super) fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Plane { center, .. } => Self::Plane { center, scale: factor },
            Self::Gnomonic { axes, radius, .. } => Self::Gnomonic { axes, radius, scale: factor },
        }
    }

    /// The place of a vertex in the chart.
    pub(super) fn down(&self, positions: &Positions, vertex: Vertex) -> [f64; 2] {
        match (self, positions) {
            (Self::Plane { center, scale }, Positions::Plane(map)) => {
                let x = map[vertex];
                [0, 1].map(|axis| scale * (x[axis] - center[axis]))
            }
            (Self::Gnomonic { axes, scale, .. }, Positions::Sphere(map)) => {
                let x = unit_vector(map[vertex]);
                let [u, v, height] = axes.map(|axis| axis.dot(x));
                if height > HORIZON {
                    return [scale * u / height, scale * v / height];
                }
                let length = u.hypot(v).max(f64::MIN_POSITIVE);
                [u, v].map(|x| scale * x / length / HORIZON)
            }
            _ => unreachable!("a chart of the same map"),
        }
    }

    /// Puts a vertex to a place of the chart.
    pub(super) fn up(&self, place: [f64; 2], positions: &mut Positions, vertex: Vertex) {
        match (self, positions) {
            (Self::Plane { center, scale }, Positions::Plane(map)) => {
                map[vertex] = [0, 1].map(|axis| center[axis] + place[axis] / scale);
            }
            (Self::Gnomonic { axes, radius, scale }, Positions::Sphere(map)) => {
                let [u, v] = place.map(|x| x / scale);
                let x = axes[2] + (axes[0] * u + axes[1] * v);
                map[vertex] = unit_vector(x) * *radius;
            }
            _ => unreachable!("a chart of the same map"),
        }
    }
}

fn unit_vector(x: Vector3) -> Vector3 {
    x * (1.0 / x.norm().max(f64::MIN_POSITIVE))
}

/// Two tangents and the normal, a right-handed frame; the normal `z` has length 1.
fn tangent_frame(z: Vector3) -> [Vector3; 3] {
    let least = (0..3).min_by(|&a, &b| z[a].abs().total_cmp(&z[b].abs())).expect("three axes");
    let x = unit_vector(Vector3::unit(least).cross(z));
    [x, z.cross(x), z]
}
