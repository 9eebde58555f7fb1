// SPDX-License-Identifier: MIT OR Apache-2.0
//! The islands along given seams, mapped.

use ndarray::{Array2, ArrayView2};

use crate::arrays::from_rows;
use crate::control::{Observer, Phase, Status};
use crate::error::Error;
use crate::mesh::{Face, Patch, Surface};
use crate::seams::{Island, IslandMap, Outlines, length, sorted_edges};

/// A surface cut into islands that are mapped.
pub(super) struct CutSurface {
    pub islands: Vec<Island>,
    /// (s, 2): the seams, the lower end first, ascending.
    pub edges: Array2<u32>,
    /// The length of the seams, each once, over the square root of the area.
    pub length: f64,
    pub status: Status,
}

/// The islands between given seams and the boundary.
///
/// # Errors
/// Seams that are no edges; islands that are closed or have handles; [`Error::CancelledEarly`].
pub(super) fn along(
    surface: &Surface,
    seams: ArrayView2<'_, u32>,
    overlap: bool,
    observer: &mut dyn Observer,
) -> Result<CutSurface, Error> {
    let patches = surface.cut(seams)?;
    for patch in &patches {
        let mesh = patch.surface.mesh()?;
        mesh.require_genus_zero()?;
        if patch.is_closed() {
            mesh.require_disk()?;
        }
    }
    let outlines = if overlap { Outlines::MayCross } else { Outlines::MayNotCross };
    let n = patches.len() as f64;
    let mut islands = Vec::with_capacity(patches.len());
    let mut status = Status::Converged;
    for (k, patch) in patches.into_iter().enumerate() {
        let mut phase = Phase { whole: &mut *observer, from: k as f64 / n, to: (k + 1) as f64 / n };
        let (island, outcome) = mapped(patch, outlines, &mut phase)?;
        islands.push(island);
        if outcome != Status::Converged {
            status = outcome;
        }
    }
    let mut edges = sorted_edges("seams", Some(seams))?;
    edges.dedup();
    let area: f64 = islands.iter().map(|island| island.map.area()).sum();
    let length = length(surface, &edges) / area.sqrt();
    let edges = from_rows(edges.into_iter().map(|edge| edge.map(|vertex| vertex.0)).collect());
    Ok(CutSurface { islands, edges, length, status })
}

fn mapped(patch: Patch, outlines: Outlines, observer: &mut dyn Observer) -> Result<(Island, Status), Error> {
    let face_of: Vec<_> = patch.corner_of.rows().into_iter().map(|row| Face(row[0] / 3)).collect();
    let mesh = patch.surface.mesh()?.clone();
    let mut map = IslandMap::new(mesh);
    let status = map.map(outlines, None, observer)?;
    if status == Status::Cancelled {
        return Err(Error::CancelledEarly);
    }
    Ok((Island { map, vertex_of: patch.vertex_of, face_of }, status))
}
