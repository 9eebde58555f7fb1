// SPDX-License-Identifier: MIT OR Apache-2.0
//! The maps of all islands of a cut, at one density, and their figures.

use super::cut::Cut;
use super::edge_mesh::EdgeMesh;
use super::progress::report;
use crate::control::{Observer, Phase, Status};
use crate::disk::{IslandGoal, IslandStart, MappedIsland, map_island};
use crate::error::Error;
use crate::mesh::geometry::triangle;
use crate::mesh::{Corner, Face, TriangleMesh, Vertex};
use crate::vector::coordinates;

/// The deviation of areas of the maps, √(E_A/A).
const AREA_TOLERANCE: f64 = 0.0048;

/// One island and its map.
#[derive(Debug, Clone)]
pub(crate) struct IslandMap {
    pub mesh: TriangleMesh,
    /// The vertex of the cut mesh of which each vertex is a copy, (n,), ascending.
    pub vertex_of: Vec<Vertex>,
    /// The face of the cut mesh that each face is, (m,), ascending.
    pub face_of: Vec<Face>,
    /// The length of the unit of the mesh's points.
    pub unit: f64,
    /// The image of each vertex, (n,), whose area is that of the island; empty before it is mapped.
    pub uv: Vec<[f64; 2]>,
    /// The weight of angles of the map; `None` before it is mapped.
    weight: Option<f64>,
}

/// The figures of a map, weighted by area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MapFigures {
    /// The mean of σ₁/σ₂.
    pub mean: f64,
    /// Its 99th percentile.
    pub percentile: f64,
    /// The standard deviation of the area ratio.
    pub area_deviation: f64,
}

/// Whether outlines may cross themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outlines {
    MayCross,
    MayNotCross,
}

/// The island of each number, unmapped: its `uv` is empty.
pub(super) fn islands(mesh: &EdgeMesh, cut: &Cut) -> Result<Vec<IslandMap>, Error> {
    let labels = cut.islands(mesh);
    let copies = Copies::of(mesh, cut);
    let mut faces_of = vec![Vec::new(); labels.len()];
    for (face, &island) in labels.of_face.iter().enumerate() {
        faces_of[island as usize].push(Face::new(face));
    }
    faces_of.into_iter().map(|faces| copies.island(mesh, faces)).collect()
}

impl IslandMap {
    /// An island of its own, not mapped.
    pub(crate) fn new(mesh: TriangleMesh) -> Self {
        let vertex_of = Vertex::all(mesh.n_vertices()).collect();
        let face_of = Face::all(mesh.n_faces()).collect();
        Self { unit: mesh.scale(), vertex_of, face_of, uv: Vec::new(), weight: None, mesh }
    }

    /// The area of the island.
    pub(crate) fn area(&self) -> f64 {
        self.mesh.face_areas().iter().sum::<f64>() * self.unit.powi(2)
    }

    /// Maps the island, from its map if it has one.
    pub(crate) fn map(
        &mut self,
        outlines: Outlines,
        max_iterations: Option<usize>,
        observer: &mut dyn Observer,
    ) -> Result<Status, Error> {
        let overlap = outlines == Outlines::MayCross;
        let start = self.weight.map(|weight| IslandStart::Map(&self.uv, weight));
        let goal = IslandGoal { tolerance: AREA_TOLERANCE, overlap, max_iterations, start };
        let mapped = map_island(&self.mesh, &goal, observer)?;
        Ok(self.take(mapped))
    }

    /// Maps the island from wanted images of its faces; its outline may cross itself.
    pub(super) fn map_from(
        &mut self,
        shapes: &[[[f64; 2]; 3]],
        observer: &mut dyn Observer,
    ) -> Result<Status, Error> {
        let start = Some(IslandStart::Shapes(shapes));
        let goal = IslandGoal { tolerance: AREA_TOLERANCE, overlap: true, max_iterations: None, start };
        let mapped = map_island(&self.mesh, &goal, observer)?;
        Ok(self.take(mapped))
    }

    /// Takes a map, scaled to the area of the island.
    fn take(&mut self, mapped: MappedIsland) -> Status {
        (self.uv, self.weight) = (mapped.uv, Some(mapped.weight));
        let area: f64 = self.mesh.faces().iter().map(|&face| signed_area(face.map(|v| self.uv[v]))).sum();
        let scale = (self.area() / area).sqrt();
        self.uv.iter_mut().flatten().for_each(|x| *x *= scale);
        mapped.status
    }

    /// The island without its map.
    pub(crate) fn unmapped(mut self) -> Self {
        self.uv.clear();
        self.weight = None;
        self
    }

    /// Takes over the map of an island of which this one is a part.
    pub(super) fn take_over(&mut self, whole: &Self) {
        self.uv = vec![[0.0; 2]; self.vertex_of.len()];
        for (corners, face) in self.mesh.faces().iter().zip(&self.face_of) {
            let in_whole = whole.face_of.partition_point(|before| before < face);
            for (&vertex, &image) in corners.iter().zip(&whole.mesh.faces()[in_whole]) {
                self.uv[vertex] = whole.uv[image];
            }
        }
        self.weight = whole.weight;
    }

    /// The island and its map in a unit of which this is the length.
    pub(crate) fn in_units_of(mut self, length: f64) -> Self {
        self.unit *= length;
        self.uv.iter_mut().flatten().for_each(|x| *x *= length);
        self
    }

    /// σ₁/σ₂, the area ratio and the area of each face.
    fn stretches(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let to_input = self.unit;
        self.mesh.faces().iter().zip(self.mesh.face_areas()).map(move |(&face, &area)| {
            let rest = triangle(self.mesh.points(), face).map(|point| point * to_input);
            let area = area * to_input * to_input;
            let [p, q] = [rest[1] - rest[0], rest[2] - rest[0]];
            let [u, v, w] = face.map(|vertex| self.uv[vertex]);
            let [u1, u2] = [[v[0] - u[0], v[1] - u[1]], [w[0] - u[0], w[1] - u[1]]];
            // Σσ² = |J|² by the metrics, σ₁σ₂ = det J
            let [pp, pq, qq] = [p.dot(p), p.dot(q), q.dot(q)];
            let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
            let [uu, uv, vv] = [dot(u1, u1), dot(u1, u2), dot(u2, u2)];
            let squares = (qq * uu - 2.0 * pq * uv + pp * vv) / (4.0 * area * area);
            let determinant = (u1[0] * u2[1] - u1[1] * u2[0]) / (2.0 * area);
            let root = (squares * squares - 4.0 * determinant * determinant).max(0.0).sqrt();
            [(squares + root) / (2.0 * determinant), determinant, area]
        })
    }
}

/// The figures of all islands together.
pub(crate) fn figures<'a>(islands: impl IntoIterator<Item = &'a IslandMap>) -> MapFigures {
    let mut stretches: Vec<_> = islands.into_iter().flat_map(IslandMap::stretches).collect();
    let total: f64 = stretches.iter().map(|[_, _, area]| area).sum();
    let average = |value: &dyn Fn(&[f64; 3]) -> f64| {
        stretches.iter().map(|face| value(face) * face[2]).sum::<f64>() / total
    };
    let mean = average(&|face| face[0]);
    let area_deviation = average(&|face| (face[1] - 1.0).powi(2)).sqrt();
    stretches.sort_by(|a, b| b[0].total_cmp(&a[0]));
    let mut above = 0.0;
    let beyond = stretches.iter().find(|face| {
        above += face[2];
        above > 0.01 * total
    });
    MapFigures { mean, percentile: beyond.map_or(1.0, |face| face[0]), area_deviation }
}

/// Maps all islands of a cut.
pub(super) fn map_all(
    islands: &mut [IslandMap],
    outlines: Outlines,
    observer: &mut dyn Observer,
) -> Result<(), Error> {
    let n = islands.len() as f64;
    for (k, island) in islands.iter_mut().enumerate() {
        let mut phase = Phase { whole: &mut *observer, from: k as f64 / n, to: (k + 1) as f64 / n };
        report(&mut phase, 0.0)?;
        if island.map(outlines, None, &mut phase)? == Status::Cancelled {
            return Err(Error::CancelledEarly);
        }
    }
    Ok(())
}

fn signed_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// The copies into which a cut divides the vertices of a mesh.
struct Copies {
    /// The copy at each corner, (3m,).
    at_corner: Vec<u32>,
}

impl Copies {
    fn of(mesh: &EdgeMesh, cut: &Cut) -> Self {
        const NONE: u32 = u32::MAX;
        let mut at_corner = vec![NONE; 3 * mesh.n_faces()];
        let mut n_copies = 0;
        for vertex in Vertex::all(mesh.n_vertices()) {
            let corners = mesh.mesh.vertex_corners(vertex);
            for &corner in corners {
                if at_corner[corner] != NONE {
                    continue;
                }
                let mut pending = vec![corner];
                while let Some(corner) = pending.pop() {
                    if at_corner[corner] != NONE {
                        continue;
                    }
                    at_corner[corner] = n_copies;
                    pending.extend(turns(mesh, cut, corner));
                }
                n_copies += 1;
            }
        }
        Self { at_corner }
    }

    fn island(&self, mesh: &EdgeMesh, face_of: Vec<Face>) -> Result<IslandMap, Error> {
        let corners = |face: &Face| face.corners().map(|corner| (self.at_corner[corner], corner));
        let mut copies: Vec<(u32, Corner)> = face_of.iter().flat_map(corners).collect();
        copies.sort_unstable();
        copies.dedup_by_key(|(copy, _)| *copy);
        let vertex_of: Vec<_> = copies.iter().map(|(_, corner)| corner.vertex(mesh.mesh.faces())).collect();
        let number = |corner: Corner| {
            let copy = self.at_corner[corner];
            Vertex::new(copies.partition_point(|(before, _)| *before < copy))
        };
        let faces: Vec<_> = face_of.iter().map(|face| face.corners().map(number)).collect();
        let points = coordinates(vertex_of.iter().map(|&vertex| mesh.mesh.points()[vertex]));
        let mesh = TriangleMesh::new(&points, &faces)?;
        Ok(IslandMap { unit: mesh.scale(), mesh, vertex_of, face_of, uv: Vec::new(), weight: None })
    }
}

/// The corners at the same vertex in the neighboring faces, unless a border lies between.
fn turns(mesh: &EdgeMesh, cut: &Cut, corner: Corner) -> Vec<Corner> {
    let across =
        |side: Corner| mesh.mesh.opposite(side).filter(|_| !cut.is_seam(mesh.edges.opposite_to(side)));
    // across the edge to the next vertex, the corner after the opposite one; and the other way round
    let forward = across(corner.next()).map(Corner::next);
    let backward = across(corner.previous()).map(Corner::previous);
    forward.into_iter().chain(backward).collect()
}
