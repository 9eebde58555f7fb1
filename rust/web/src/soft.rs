// SPDX-License-Identifier: MIT OR Apache-2.0
//! Islands mapped with a weight of angles: better shapes, less even areas.

use authalic::{
    Boundary, DiskMapOptions, Error, Observer, PackOptions, PlanarIsland, Surface, Vertex, disk_maps, pack,
};
use ndarray::Array2;

use crate::figures::{area, rows, signed_area};

/// The part of the progress that the maps take; the rest is packing.
const MAPS: f64 = 0.9;

/// UVs of a surface.
#[derive(Debug, Clone)]
pub struct Layout {
    /// The points in the unit square, (k, 2).
    pub uv: Vec<[f64; 2]>,
    /// The vertex of each point, (k,).
    pub vertex_of: Vec<Vertex>,
    /// The point at each corner of the faces, (m, 3).
    pub faces: Vec<[u32; 3]>,
    /// The number of islands.
    pub islands: usize,
    /// The island of each face, (m,).
    pub island_of: Vec<u32>,
}

/// Maps the islands between seams (s, 2) with a weight of angles, at one density, and packs them into the unit square.
///
/// # Errors
/// As `disk_maps`; [`Error::CancelledEarly`].
pub fn soft_layout(
    surface: &Surface,
    seams: &Array2<u32>,
    angle_weight: f64,
    observer: &mut dyn Observer,
) -> Result<Layout, Error> {
    // 1. The islands
    let patches = surface.cut(seams)?;
    // 2. Their maps, each scaled to the area of its island
    let options =
        DiskMapOptions { boundary: Boundary::Free, angle_weight, fill_holes: true, ..Default::default() };
    let tasks: Vec<_> = patches.iter().map(|patch| (patch.surface.clone(), options.clone())).collect();
    let mut of_maps = |fraction: f64, message: &str| observer.progress(MAPS * fraction, message);
    let mut shapes = Vec::new();
    for (map, patch) in disk_maps(&tasks, &mut of_maps).into_iter().zip(&patches) {
        let map = map.ok_or(Error::CancelledEarly)??;
        shapes.push(scaled(rows(&map.uv), &patch.surface));
    }
    // 3. Packing
    let islands: Vec<_> = shapes.iter().map(|(points, faces)| PlanarIsland { points, faces }).collect();
    let mut of_packing =
        |fraction: f64, message: &str| observer.progress(MAPS + (1.0 - MAPS) * fraction, message);
    let packing = pack(&islands, &PackOptions::default(), &mut of_packing)?;
    // 4. Points and faces
    let m = surface.n_faces();
    let (mut uv, mut vertex_of) = (Vec::new(), Vec::new());
    let (mut faces, mut island_of) = (vec![[0; 3]; m], vec![0; m]);
    for (number, (patch, (points, own))) in patches.iter().zip(&shapes).enumerate() {
        let first = uv.len() as u32;
        uv.extend(points.iter().map(|&point| packing.apply(number, point)));
        vertex_of.extend(&patch.vertex_of);
        for (corner, vertex) in patch.corner_of.iter().zip(own.iter().flatten()) {
            let [face, place] = [corner / 3, corner % 3].map(|index| index as usize);
            faces[face][place] = first + vertex.0;
            island_of[face] = number as u32;
        }
    }
    Ok(Layout { uv, vertex_of, faces, islands: patches.len(), island_of })
}

/// A map at the scale at which it has the area of its island, with the faces of the island.
fn scaled(points: Vec<[f64; 2]>, island: &Surface) -> (Vec<[f64; 2]>, Vec<[Vertex; 3]>) {
    let places: Vec<[f64; 3]> =
        island.vertices().rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect();
    let faces: Vec<[u32; 3]> = rows(&island.faces());
    let corners = || faces.iter().map(|face| face.map(|vertex| vertex as usize));
    let wanted: f64 = corners().map(|face| area(face.map(|vertex| places[vertex]))).sum();
    let found: f64 = corners().map(|face| signed_area(face.map(|vertex| points[vertex])).abs()).sum();
    let scale = (wanted / found).sqrt();
    let points = points.into_iter().map(|point| point.map(|x| scale * x)).collect();
    (points, faces.into_iter().map(|face| face.map(Vertex)).collect())
}
