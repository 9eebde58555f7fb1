// SPDX-License-Identifier: MIT OR Apache-2.0
//! Holes that are filled for the time of a registration by curves, as `registration/filling.rs` fills them.
//!
//! All boundary loops are filled but those along which a curve and its partner run on both surfaces. The result is that
//! of the given vertices and faces; the certificates stay those of the map of the filled surfaces.
//!
//! Cost: one sparse LU with some three unknowns per vertex of a hole.

use ndarray::{Axis, Slice};

use super::assembly::{CurveMap, CurveRegistration, RoughSphere, figures};
use super::features::curves::{LandmarkCurves, loop_along};
use super::options::HyperbolicOptions;
use super::warnings::{Warning, distorted};
use crate::arrays::vectors;
use crate::control::Observer;
use crate::error::{Error, Side};
use crate::mesh::{Surface, TriangleMesh, Vertex};
use crate::registration::Features;
use crate::registration::filling::{Filled, PreviewOfGiven, part};

/// A registration by curves, as [`register_hyperbolic`](super::register_hyperbolic).
type Register = fn(
    &Surface,
    &Surface,
    &LandmarkCurves<'_>,
    &HyperbolicOptions<'_>,
    &mut dyn Observer,
) -> Result<CurveRegistration, Error>;

/// The registration of two surfaces by that of the filled ones.
///
/// # Errors
/// Those of the registration; [`Error::InvalidOption`] where spheres are given, which lack what is filled.
pub(super) fn registered(
    given: [&Surface; 2],
    curves: &LandmarkCurves<'_>,
    options: &HyperbolicOptions<'_>,
    observer: &mut dyn Observer,
    register: Register,
) -> Result<CurveRegistration, Error> {
    if options.spheres.is_some() {
        return Err(Error::InvalidOption {
            name: "source_sphere",
            found: "given".into(),
            expected: "left out where holes are filled".into(),
        });
    }
    // 1. Fill all boundary loops that are no curves on both sides
    let mesh = |side: usize| {
        let of_side = [Side::Source, Side::Target][side];
        given[side].mesh().map_err(|error: Error| error.of_surface(of_side))
    };
    let meshes = [mesh(0)?, mesh(1)?];
    curves.check_range(meshes.map(TriangleMesh::n_vertices))?;
    let kept = matched_loops(meshes, curves);
    let filled = [0, 1].map(|side| {
        let loops = meshes[side].boundary_loops().iter().enumerate();
        Filled::of(
            given[side],
            meshes[side],
            loops.filter(|(k, _)| !kept[side].contains(k)).map(|(_, hole)| hole),
        )
    });
    // 2. Register
    let signals = options
        .features
        .map(|features| [filled[0].extended(features.source), filled[1].extended(features.target)]);
    let features = options.features.zip(signals.as_ref()).map(|(features, [ours, theirs])| Features {
        source: ours.view(),
        target: theirs.view(),
        ..features
    });
    let options = HyperbolicOptions { features, fill_holes: false, ..*options };
    let mut observer = PreviewOfGiven { whole: observer, n_vertices: given[0].n_vertices() };
    let whole = register(&filled[0].surface, &filled[1].surface, curves, &options, &mut observer)?;
    if filled.iter().all(|each| each.holes.is_empty()) {
        return Ok(whole);
    }
    // 3. The result of the given vertices and faces
    whole.of_given(given, meshes)
}

/// The boundary loops of either surface along which a curve and its partner run.
fn matched_loops(meshes: [&TriangleMesh; 2], curves: &LandmarkCurves<'_>) -> [Vec<usize>; 2] {
    let pairs = curves.source.iter().zip(curves.target);
    let loops = pairs.filter_map(|(ours, theirs)| Some((along(meshes[0], ours)?, along(meshes[1], theirs)?)));
    let (ours, theirs) = loops.unzip();
    [ours, theirs]
}

/// The boundary loop that a path runs along.
fn along(mesh: &TriangleMesh, path: &[usize]) -> Option<usize> {
    let is_repeated = path.len() > 1 && path.first() == path.last();
    let vertices: Vec<Vertex> =
        path[..path.len() - usize::from(is_repeated)].iter().copied().map(Vertex::new).collect();
    if vertices.is_empty() { None } else { loop_along(mesh, &vertices) }
}

impl CurveRegistration {
    /// The registration of two given surfaces, as this is that of the same with their holes filled.
    fn of_given(mut self, given: [&Surface; 2], meshes: [&TriangleMesh; 2]) -> Result<Self, Error> {
        let [source, target] = given;
        self.map = self.map.of_given(given, meshes[0])?;
        self.inverse = self.inverse.of_given([target, source], meshes[1])?;
        let oriented = self.map.correspondence.sides().map(|side| &side.faces[..]);
        for side in 0..2 {
            let (positions, distortion) = part(&self.spheres[side].positions, meshes[side], oriented[side])?;
            let targets = meshes[side].face_areas().to_vec();
            self.spheres[side] = RoughSphere { positions, targets, distortion };
        }
        self.certificates.folded.retain(|&face| face < source.n_faces());
        self.warnings.retain(|warning| !matches!(warning, Warning::Distorted { .. }));
        self.warnings.extend(distorted(meshes[0], &self.map.distortion));
        Ok(self)
    }
}

impl CurveMap {
    /// The part of a given surface onto another.
    fn of_given(self, given: [&Surface; 2], mesh: &TriangleMesh) -> Result<Self, Error> {
        let correspondence = self.correspondence.of_given(given);
        let registered = self.registered.slice_axis(Axis(0), Slice::from(..mesh.n_vertices())).to_owned();
        let folded = self.distortion.folded.iter().copied().filter(|&face| face < mesh.n_faces()).collect();
        let positions = vectors(correspondence.positions().view());
        let distortion = figures(mesh, &positions, folded)?;
        Ok(Self { correspondence, registered, distortion, ..self })
    }
}
