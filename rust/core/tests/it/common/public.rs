// SPDX-License-Identifier: MIT OR Apache-2.0
//! The public functions on the meshes of the tests, whose own coordinates the surfaces have, and their arrays as rows.

use authalic::testing::{TriangleMesh, Vector3, rows, vectors};
use authalic::{
    CurveRegistration, DiskMap, DiskMapOptions, DiskRegistration, Error, HyperbolicOptions, LandmarkCurves,
    Landmarks, Observer, Patch, RegistrationOptions, SphereMap, SphereMapOptions, SphereRegistration,
    Surface,
};
use ndarray::{Array2, aview2};

/// The surface of a mesh.
pub fn surface(mesh: &TriangleMesh) -> Surface {
    let vertices: Vec<[f64; 3]> = mesh.points().iter().map(|&point| point.into()).collect();
    Surface::new(aview2(&vertices), aview2(&super::indices(mesh.faces()))).expect("a mesh is a surface")
}

pub fn disk_map(
    mesh: &TriangleMesh,
    options: &DiskMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<DiskMap, Error> {
    authalic::disk_map(&surface(mesh), options, observer)
}

pub fn sphere_map(
    mesh: &TriangleMesh,
    options: &SphereMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<SphereMap, Error> {
    authalic::sphere_map(&surface(mesh), options, observer)
}

pub fn register_disks(
    source: &TriangleMesh,
    target: &TriangleMesh,
    landmarks: &Landmarks<'_>,
    options: &RegistrationOptions,
    observer: &mut dyn Observer,
) -> Result<DiskRegistration, Error> {
    authalic::register_disks(&surface(source), &surface(target), landmarks, options, observer)
}

pub fn register_spheres(
    source: &TriangleMesh,
    target: &TriangleMesh,
    landmarks: &Landmarks<'_>,
    options: &RegistrationOptions,
    observer: &mut dyn Observer,
) -> Result<SphereRegistration, Error> {
    authalic::register_spheres(&surface(source), &surface(target), landmarks, options, observer)
}

pub fn register_hyperbolic(
    source: &TriangleMesh,
    target: &TriangleMesh,
    curves: &LandmarkCurves<'_>,
    options: &HyperbolicOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<CurveRegistration, Error> {
    authalic::register_hyperbolic(&surface(source), &surface(target), curves, options, observer)
}

/// The image of a disk map, or another array of the plane.
pub fn planar(array: &Array2<f64>) -> &[[f64; 2]] {
    rows(array.view())
}

/// The image of a sphere map, or another array in space.
pub fn spatial(array: &Array2<f64>) -> Vec<Vector3> {
    vectors(array.view())
}

/// Vectors as an array.
pub fn array(vectors: &[Vector3]) -> Array2<f64> {
    Array2::from_shape_fn((vectors.len(), 3), |(vertex, axis)| vectors[vertex][axis])
}

/// Triples of indices.
pub fn triples(array: &Array2<u32>) -> &[[u32; 3]] {
    rows(array.view())
}

/// Cuts vertices and faces along seams.
pub fn cut(vertices: &[[f64; 3]], faces: &[[u32; 3]], seams: &[[u32; 2]]) -> Result<Vec<Patch>, Error> {
    Surface::new(aview2(vertices), aview2(faces))?.cut(aview2(seams))
}

/// The vertices of a patch.
pub fn vertices_of(patch: &Patch) -> &[[f64; 3]] {
    rows(patch.surface.vertices())
}

/// The faces of a patch.
pub fn faces_of(patch: &Patch) -> Vec<[u32; 3]> {
    triples(&patch.surface.faces()).to_vec()
}
