// SPDX-License-Identifier: MIT OR Apache-2.0
//! Seams: where to cut a surface so that its map is hardly sheared.
//!
//! [`seams`] finds short seams along which a surface of any topology becomes disks, whose maps preserve areas and are
//! sheared as little as is wanted. A plate that is clamped along the seams predicts the shear of the maps by one linear
//! solve (`plate`), so that a search over cuts (`search`) of a proxy (`proxy`) needs a few maps in all.
//!
//! 1. The surface is cut along the given seams; each part is treated by itself.
//! 2. The proxy of a part, and what seams cost on it: less in places that are hidden, in creases, and where the caller
//!    prefers them (`cost`).
//! 3. The search, from the first cut that leaves disks only.
//! 4. The seams are lifted to the part (`lift`), its islands mapped (`maps`), and the search goes on where the maps are
//!    sheared more than was predicted (`correction`).
//! 5. Islands must not overlap themselves in the plane (`one_to_one`).
//!
//! A large part has these steps on a coarser mesh first, whose seams and maps are carried to it (`coarse`).
//!
//! Input: a [`Surface`]. Cost: the search does not grow with the mesh; all else is that of one to four maps of it, of one
//! or two where it is large.

mod carry;
mod chord;
mod coarse;
mod component;
mod cones;
mod correction;
mod cost;
mod cut;
mod cut_graph;
mod direct;
mod edge_mesh;
mod given;
mod lift;
mod maps;
mod merge;
mod one_to_one;
mod openness;
mod options;
mod overlap;
mod paths;
mod plate;
mod prepared;
mod progress;
mod proxy;
#[cfg(test)]
mod sample_surfaces;
mod search;
mod symmetry;

use ndarray::Array2;

use crate::arrays::from_rows;
use crate::control::{Observer, Phase, Rising, Status};
use crate::error::Error;
use crate::mesh::{Face, Surface, Vertex};
use crate::parallel;
use component::seek;
use given::{Part, parts};
pub(crate) use given::{length, sorted_edges};
pub(crate) use maps::{IslandMap, MapFigures, Outlines, figures};
use one_to_one::Seamed;
use options::MET;
pub use options::{SeamMethod, SeamOptions, Symmetry};
use progress::report;

/// Seams of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Seams {
    /// (k, 2): the ends of each seam, the lower one first, ascending; the given seams among them.
    pub edges: Array2<u32>,
    /// The number of islands.
    pub islands: usize,
    /// (m,): the island of each face, numbered by their lowest faces.
    pub island_of: Vec<u32>,
    /// The length of the seams, each once, over the square root of the surface's area.
    pub length: f64,
    /// The mean of σ₁/σ₂ over the surface that is predicted for the best maps of the islands.
    pub predicted: f64,
    /// [`Status::Converged`] where the islands' maps, or for a preview the prediction, meet the target, else
    /// [`Status::Stalled`].
    pub status: Status,
}

/// An island of a surface with its map.
#[derive(Debug, Clone)]
pub(crate) struct Island {
    pub map: IslandMap,
    /// The vertex of the surface of which each vertex of the island is a copy.
    pub vertex_of: Vec<Vertex>,
    /// The face of the surface that each face of the island is.
    pub face_of: Vec<Face>,
}

/// Finds seams along which the surface becomes disks whose area-preserving maps are hardly sheared.
///
/// The surface may have any genus, any number of boundary loops, and several components. Seams that are given stay and
/// are added to.
///
/// # Errors
/// A surface that is no oriented manifold where it is not cut along given seams; given seams that are no edges; options
/// out of range; [`Error::CancelledEarly`].
///
/// ```
/// use authalic::{SeamOptions, Silent, Surface, seams};
/// use ndarray::array;
///
/// let vertices = array![[3., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
/// let faces = array![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
/// let surface = Surface::new(vertices, faces)?;
/// let seams = seams(&surface, &SeamOptions::default(), &mut Silent)?;
/// assert!(surface.cut(&seams.edges)?.iter().all(|patch| patch.is_disk()));
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn seams(
    surface: &Surface,
    options: &SeamOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<Seams, Error> {
    parallel::install(|| seams_and_maps(surface, options, observer)).map(|(seams, _)| seams)
}

/// The seams with the maps of all islands, which a preview has not.
pub(crate) fn seams_and_maps(
    surface: &Surface,
    options: &SeamOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<(Seams, Vec<Island>), Error> {
    let observer = &mut Rising::new(observer);
    report(observer, 0.0)?;
    // 1. The parts between given seams
    let parts = parts(surface, options)?;
    // 2. to 5. The seams of each
    let mut collected = Collected::new(surface);
    let mut done = 0;
    let n_parts = parts.len();
    for (k, part) in parts.into_iter().enumerate() {
        let [from, to] = [done, done + part.mesh.n_faces()].map(|n| n as f64 / surface.n_faces() as f64);
        done += part.mesh.n_faces();
        let mut phase = Phase { whole: &mut *observer, from, to };
        // every other part is an island at least
        let taken = collected.islands.len() + n_parts - k - 1;
        let room = options.max_islands.unwrap_or(usize::MAX).saturating_sub(taken).max(1);
        let seamed = seek(&part.mesh, &part.wishes(options, room), &mut phase)?;
        collected.add(&part, seamed);
    }
    report(observer, 1.0)?;
    collected.finish(options)
}

/// What has been found on the parts so far.
struct Collected<'a> {
    surface: &'a Surface,
    edges: Vec<[Vertex; 2]>,
    islands: Vec<Island>,
    /// The sums of area, predicted shear · area, and measured shear · area.
    sums: [f64; 3],
}

impl<'a> Collected<'a> {
    fn new(surface: &'a Surface) -> Self {
        Self { surface, edges: Vec::new(), islands: Vec::new(), sums: [0.0; 3] }
    }

    fn add(&mut self, part: &Part, seamed: Seamed) {
        let of_surface = |vertex: Vertex| part.vertex_of[vertex];
        let ends = |edge| {
            let mut ends = part.mesh.edges.ends(edge).map(of_surface);
            ends.sort_unstable();
            ends
        };
        self.edges.extend(seamed.cut.seams().map(ends));
        let unit = part.mesh.unit * part.mesh.mesh.scale();
        let area = unit * unit;
        let measured = seamed.measured.map_or(seamed.predicted.mean, |figures| figures.mean);
        let terms = [area, area * seamed.predicted.mean, area * measured];
        self.sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        self.islands.extend(seamed.islands.into_iter().map(|map| Island {
            vertex_of: map.vertex_of.iter().map(|&vertex| of_surface(vertex)).collect(),
            face_of: map.face_of.iter().map(|&face| part.face_of[face]).collect(),
            map: map.in_units_of(part.mesh.mesh.scale()),
        }));
    }

    fn finish(mut self, options: &SeamOptions<'_>) -> Result<(Seams, Vec<Island>), Error> {
        self.edges.extend(sorted_edges("fixed", options.fixed)?);
        self.edges.sort_unstable();
        self.edges.dedup();
        self.islands.sort_by_key(|island| island.face_of.first().copied());
        let mut island_of = vec![0; self.surface.n_faces()];
        for (number, island) in self.islands.iter().enumerate() {
            island.face_of.iter().for_each(|&face| island_of[face] = number as u32);
        }
        let [area, predicted, measured] = self.sums;
        let is_met = measured <= MET * options.target * area;
        let seams = Seams {
            length: length(self.surface, &self.edges) / area.sqrt(),
            edges: from_rows(self.edges.into_iter().map(|edge| edge.map(|vertex| vertex.0)).collect()),
            islands: self.islands.len(),
            island_of,
            predicted: predicted / area,
            status: if is_met { Status::Converged } else { Status::Stalled },
        };
        Ok((seams, self.islands))
    }
}
