// SPDX-License-Identifier: MIT OR Apache-2.0
//! UVs of a surface in one call: cut, mapped, packed.
//!
//! 1. Seams: found ([`seams`](crate::seams())), given, or none.
//! 2. Every island is mapped to the plane: areas to a few thousandths, little shear, no overlap.
//! 3. All islands have one density, and are packed into the unit square ([`crate::packing`]), unless the caller has a
//!    packer.
//!
//! Cost: that of the seams, of the maps, and of the packing.

mod islands;

use ndarray::{Array2, ArrayView2};

use crate::arrays::from_rows;
use crate::clock::Instant;
use crate::control::{Observer, Phase, Status};
use crate::error::Error;
use crate::mesh::{Face, Surface, Vertex};
use crate::packing::{self, Margin, PackOptions, Packing, Rotation, pack};
use crate::parallel;
use crate::seams::{Island, MapFigures, SeamMethod, SeamOptions, figures, seams_and_maps};
use islands::{CutSurface, along};

/// Where the seams of an unwrap come from.
#[derive(Debug, Clone)]
pub enum UnwrapSeams<'a> {
    /// They are found; those that the options fix are added to.
    Automatic(SeamOptions<'a>),
    /// They are given, (k, 2), each the two ends of an edge: no others are made.
    Given(ArrayView2<'a, u32>),
}

/// Options of [`unwrap`].
#[derive(Debug, Clone)]
pub struct UnwrapOptions<'a> {
    /// Where the seams come from; by default they are found.
    pub seams: UnwrapSeams<'a>,
    /// Let islands overlap themselves where the seams are given.
    pub overlap: bool,
    /// Pack the islands into the unit square; else each stays where its map lies.
    pub pack: bool,
    /// The least distance between islands, and to the border of the square, in units of the square.
    pub margin: f64,
    /// Whether packing may turn islands.
    pub rotate: bool,
}

impl Default for UnwrapOptions<'_> {
    fn default() -> Self {
        let seams = UnwrapSeams::Automatic(SeamOptions::default());
        Self { seams, overlap: false, pack: true, margin: 0.002, rotate: true }
    }
}

/// The UVs of a surface.
#[derive(Debug, Clone)]
pub struct Unwrap {
    /// (k, 2): the points, in the order of their islands, then of their vertices; in the unit square if they are
    /// packed, else with the areas of the surface.
    pub uv: Array2<f64>,
    /// (m, 3): the faces between points; their corners are in the order of the surface's.
    pub faces: Array2<u32>,
    /// (k,): the vertex of each point.
    pub vertex_of: Vec<Vertex>,
    /// (m,): the island of each face.
    pub island_of: Vec<u32>,
    /// The number of islands.
    pub islands: usize,
    /// (s, 2): the seams, the lower end first.
    pub edges: Array2<u32>,
    /// The length of the seams, each once, over the square root of the area.
    pub length: f64,
    /// The mean of σ₁/σ₂, weighted by area.
    pub shear: f64,
    /// The 99th percentile of σ₁/σ₂, weighted by area.
    pub shear_p99: f64,
    /// The standard deviation of the area ratio, weighted by area.
    pub area_ratio_std: f64,
    /// The share of the unit square that islands cover; 0 if they are not packed.
    pub packed: f64,
    /// [`Status::Converged`] where the wanted shear is reached, or where seams are given; else [`Status::Stalled`].
    pub status: Status,
    /// Wall time of the whole call.
    pub seconds: f64,
}

/// Cuts a surface, maps its islands at one density, and packs them into the unit square.
///
/// # Errors
/// As [`seams`](crate::seams()); with given seams an island that is closed or has handles.
///
/// ```
/// use authalic::{Silent, Surface, UnwrapOptions, unwrap};
/// use ndarray::array;
///
/// let vertices = array![[3., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
/// let faces = array![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
/// let unwrapped = unwrap(&Surface::new(vertices, faces)?, &UnwrapOptions::default(), &mut Silent)?;
/// assert!(unwrapped.uv.iter().all(|x| (0.0..=1.0).contains(x)));
/// assert_eq!(unwrapped.faces.shape(), [8, 3]);
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn unwrap(
    surface: &Surface,
    options: &UnwrapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<Unwrap, Error> {
    let began = Instant::now();
    parallel::install(|| {
        // 1. and 2. The islands
        let mut phase = Phase { whole: &mut *observer, from: 0.0, to: 0.9 };
        let cut = match &options.seams {
            UnwrapSeams::Automatic(seams) => automatic(surface, seams, &mut phase)?,
            UnwrapSeams::Given(seams) => along(surface, *seams, options.overlap, &mut phase)?,
        };
        // 3. Packing
        let mut phase = Phase { whole: observer, from: 0.9, to: 1.0 };
        packed(surface, cut, options, began, &mut phase)
    })
}

fn automatic(
    surface: &Surface,
    options: &SeamOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<CutSurface, Error> {
    if options.method == SeamMethod::Cones {
        // A preview has no maps.
        let mut phase = Phase { whole: &mut *observer, from: 0.0, to: 0.1 };
        let (seams, _) = seams_and_maps(surface, options, &mut phase)?;
        return along(
            surface,
            seams.edges.view(),
            options.overlap,
            &mut Phase { whole: observer, from: 0.1, to: 1.0 },
        );
    }
    let (seams, islands) = seams_and_maps(surface, options, observer)?;
    Ok(CutSurface { islands, edges: seams.edges, length: seams.length, status: seams.status })
}

fn packed(
    surface: &Surface,
    cut: CutSurface,
    options: &UnwrapOptions<'_>,
    began: Instant,
    observer: &mut dyn Observer,
) -> Result<Unwrap, Error> {
    let CutSurface { islands, edges, length, status } = cut;
    let packing = places(&islands, options, observer)?;
    observer.progress(1.0, "Done");
    let mut points = Vec::new();
    let mut vertex_of = Vec::new();
    let mut faces = vec![[0; 3]; surface.n_faces()];
    let mut island_of = vec![0; surface.n_faces()];
    for (number, island) in islands.iter().enumerate() {
        let first = points.len() as u32;
        points.extend(island.map.uv.iter().map(|&point| packing.apply(number, point)));
        vertex_of.extend(&island.vertex_of);
        for (own, &face) in island.map.mesh.faces().iter().zip(&island.face_of) {
            faces[face] = in_order_of(surface, face, own, island).map(|vertex| first + vertex.0);
            island_of[face] = number as u32;
        }
    }
    let area: f64 = islands.iter().map(|island| island.map.area()).sum();
    let MapFigures { mean, percentile, area_deviation } = figures(islands.iter().map(|island| &island.map));
    Ok(Unwrap {
        uv: from_rows(points),
        faces: from_rows(faces),
        vertex_of,
        island_of,
        islands: islands.len(),
        edges,
        length,
        shear: mean,
        shear_p99: percentile,
        area_ratio_std: area_deviation,
        packed: if options.pack { area * packing.scale.powi(2) } else { 0.0 },
        status,
        seconds: began.elapsed().as_secs_f64(),
    })
}

fn places(
    islands: &[Island],
    options: &UnwrapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<Packing, Error> {
    let &UnwrapOptions { pack: is_packed, margin, rotate, .. } = options;
    if !is_packed {
        return Ok(Packing::unmoved(islands.len()));
    }
    let shapes: Vec<_> = islands
        .iter()
        .map(|island| packing::Island { points: &island.map.uv, faces: island.map.mesh.faces() })
        .collect();
    let rotation = if rotate { Rotation::Free } else { Rotation::Fixed };
    pack(&shapes, &PackOptions { margin: Margin::OfSquare(margin), rotation, aspect: 1.0 }, observer)
}

/// The vertices of an island's face in the order of the corners of the surface's face.
fn in_order_of(surface: &Surface, face: Face, own: &[Vertex; 3], island: &Island) -> [Vertex; 3] {
    surface.face_rows()[face].map(|vertex| {
        let copy = own.iter().copied().find(|&copy| island.vertex_of[copy] == vertex);
        copy.unwrap_or(own[0])
    })
}
