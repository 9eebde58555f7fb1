// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration by landmark curves, the whole pipeline (Shi et al. 2013, algorithm 1).

use super::assembly::{Assembly, CurveRegistration};
use super::between::Between;
use super::features::curves::LandmarkCurves;
use super::features::piece::Piece;
use super::features::pieces::pieces;
use super::features::placement::placed;
use super::features::regions::divided;
use super::filling;
use super::harmonic::piece_map::map_piece;
use super::options::{HarmonicSolver, HyperbolicEnergy, HyperbolicOptions};
use super::slice::isotopy::Isotopy;
use super::slice::slice_pair;
use crate::arrays::vectors;
use crate::control::{History, Observer, Phase, Rising, Watch};
use crate::error::{CurveError, Elements, Error, NumericsError, Side};
use crate::mesh::{Surface, TriangleMesh};
use crate::registration::correspondence::meshes;
use crate::registration::inside_out;
use crate::vector::Vector3;

/// Registers two surfaces of genus 0, closed or with boundary, by pairs of landmark curves.
///
/// Curves run along edges from vertex to vertex. Open curves are matched from start to end by shares of their
/// length; the start and the direction of closed curves mean nothing. Boundary loops are features too.
///
/// # Errors
/// Before any work: surfaces of another topology, curves that are no simple edge paths or touch each other, and
/// features that do not pair up. [`NumericsError::NoEmbedding`] and [`NumericsError::NoHyperbolicMetric`] if double
/// precision does not suffice; [`Error::CancelledEarly`].
pub fn register_hyperbolic(
    source_surface: &Surface,
    target_surface: &Surface,
    curves: &LandmarkCurves<'_>,
    options: &HyperbolicOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<CurveRegistration, Error> {
    let mut history = History::start();
    if options.fill_holes {
        let surfaces = [source_surface, target_surface];
        return filling::registered(surfaces, curves, options, observer, register_hyperbolic);
    }
    // an observer that has cancelled the run is not asked again
    let observer: &mut dyn Observer = &mut Rising::new(observer);
    // 1. Refuse what cannot be registered before any work
    let (source, target) = meshes(source_surface, target_surface)?;
    options.check()?;
    let spheres = options.sphere_vectors()?;
    let spheres = spheres.as_ref().map(|[ours, theirs]| [&ours[..], &theirs[..]]);
    let pairs = curves.check(source, target)?;
    let signals = options.signals([source, target])?;
    let same_side;
    let target = if is_closed(source) && is_closed(target) && inside_out(source, target) {
        same_side = target.turned_over();
        &same_side
    } else {
        target
    };
    let divided = divided(source, target, pairs)?;
    // 2. The surfaces laid over each other, and cut into pieces
    let watch = Watch::new(observer, 0.0, "Laying the surfaces over each other");
    let placement = placed([source, target], &divided, spheres, &watch)?;
    if placement.mirrored {
        return Err(CurveError::Mirrored.into());
    }
    let pieces = pieces(source, target, &divided, &placement);
    // 3. Piece by piece onto the target
    let mut assembly = Assembly::new([source, target]);
    for (number, (ours, theirs)) in pieces.iter().enumerate() {
        let fraction = |k: usize| 0.05 + 0.9 * k as f64 / pieces.len() as f64;
        let mut phase = Phase { whole: observer, from: fraction(number), to: fraction(number + 1) };
        let sliced = {
            let watch = Watch::new(&mut phase, 0.0, "Cutting open");
            let isotopy = Isotopy::between(ours, theirs, &watch);
            let carry = |polyline: &[Vector3]| isotopy.as_ref().map(|isotopy| isotopy.carry(polyline));
            slice_pair(ours, theirs, &carry, &watch)?
        };
        let map = map_piece(&sliced, options, &mut phase);
        let map = map.map_err(|error| of_whole_surface(error, ours, theirs))?;
        assembly.take(ours, theirs, &sliced, map, target);
    }
    // 4. A map without folds or none; only the paper's diffusion may end with folds
    if options.solver == HarmonicSolver::Newton
        && let Some(folded) = Elements::collect(assembly.folded.iter().copied())
    {
        return Err(Error::from(NumericsError::NoEmbedding { folded }).of_surface(Side::Source));
    }
    // 5. The descent between the surfaces
    if options.energy == HyperbolicEnergy::Surface {
        let meshes = [source, target];
        let target_points = &vectors(target_surface.vertices());
        let target_in_domain = &placement.target;
        let between = Between { meshes, target_points, target_in_domain, curves, signals, options };
        let mut phase = Phase { whole: observer, from: 0.95, to: 1.0 };
        assembly.lower(between, &mut history, &mut phase)?;
    }
    // 6. Figures
    let surfaces = [source_surface, target_surface];
    let result = assembly.finish(surfaces, [source, target], curves, &placement, &history)?;
    observer.progress(1.0, "Done");
    Ok(result)
}

/// An error about faces of a piece as one about faces of its surface.
fn of_whole_surface(error: Error, source: &Piece, target: &Piece) -> Error {
    let piece = if error.side() == Some(Side::Target) { target } else { source };
    error.with_faces(|face| piece.face_of[face].index())
}

fn is_closed(mesh: &TriangleMesh) -> bool {
    mesh.boundary_loops().is_empty()
}
