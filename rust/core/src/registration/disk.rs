// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration of two disks (Liu & Yueh 2023, section 6): φ = g⁻¹ ∘ h ∘ f.
//!
//! f and g are the area-preserving maps of source and target to the unit disk, h moves the source's landmarks onto the
//! target's. The paper holds the boundary of h at the best rotation; here it slides along the circle, which preserves
//! the areas of the faces next to it too.

use super::Landmarks;
use super::landmark_descent::Carrying;
use super::landmarks::best_turn;
use super::options::RegistrationOptions;
use super::result::{DiskRegistration, Registration};
use super::verdict::{MISSED, located, missed, verdict};
use crate::codomain::CanonicalDomain;
use crate::codomain::planar::{flat, lifted};
use crate::control::{History, Observer, Phase, Status};
use crate::disk::{DiskMap, DiskMapOptions, disk_map};
use crate::distortion::{Image, distortion, folded_in_plane};
use crate::error::{Error, Side};
use crate::location::Locator;
use crate::mesh::TriangleMesh;
use crate::vector::Vector3;

/// Registers two disks by landmarks inside them.
///
/// # Errors
/// Surfaces that are no disks, landmarks that are no pairs of interior vertices, and options out of range, all before
/// any work; the errors of [`disk_map`]; [`Error::CancelledEarly`].
///
/// ```
/// use authalic::registration::{Landmarks, RegistrationOptions, register_disks};
/// use authalic::{Silent, mesh::TriangleMesh};
/// let vertices = [[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
/// let mesh = TriangleMesh::new(&vertices, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])?;
/// let landmarks = Landmarks { source: &[0], target: &[0] };
/// let registration = register_disks(&mesh, &mesh, &landmarks, &RegistrationOptions::default(), &mut Silent)?;
/// assert!(registration.distortion.folded.is_empty() && registration.missed.is_empty());
/// assert_eq!(registration.positions(&vertices)[0], vertices[0]);
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn register_disks(
    source: &TriangleMesh,
    target: &TriangleMesh,
    landmarks: &Landmarks<'_>,
    options: &RegistrationOptions,
    observer: &mut dyn Observer,
) -> Result<DiskRegistration, Error> {
    let mut history = History::start();
    // 1. Refuse what cannot be registered before any work
    source.require_disk().map_err(|error| error.of_surface(Side::Source))?;
    target.require_disk().map_err(|error| error.of_surface(Side::Target))?;
    landmarks.check(source, target, CanonicalDomain::Disk)?;
    options.check()?;
    // 2. Both surfaces to the disk
    let alone = DiskMapOptions { angle_weight: options.angle_weight, ..Default::default() };
    let map = |mesh: &TriangleMesh, side, observer: &mut dyn Observer| {
        disk_map(mesh, &alone, observer).map_err(|error| error.of_surface(side))
    };
    let f = map(source, Side::Source, &mut Phase { whole: observer, from: 0.0, to: 0.3 })?;
    let g = map(target, Side::Target, &mut Phase { whole: observer, from: 0.3, to: 0.6 })?;
    // 3. The best rotation of the landmarks
    let places = picked(&g, landmarks.target);
    let turned = turned(source, &f, best_turn(&picked(&f, landmarks.source), &places));
    // 4. h: the source's landmarks carried to the target's; if some are missed, the target's to the source's
    let ours: Vec<Vector3> = landmarks.source.iter().map(|&vertex| turned[vertex]).collect();
    let disk = |mesh, landmarks, places| Carrying {
        mesh,
        domain: CanonicalDomain::Disk,
        landmarks,
        places,
        options,
    };
    let there = disk(source, landmarks.source, &places);
    let mut phase = Phase { whole: observer, from: 0.6, to: 0.9 };
    let (carried, status) = there.carry(turned.clone(), &mut history, &mut phase)?;
    let there = Meeting { gap: there.farthest(&carried), source: carried, target: lifted(&g.uv), status };
    let met = if there.gap > MISSED && status != Status::Cancelled {
        let back = disk(target, landmarks.target, &ours);
        let mut phase = Phase { whole: observer, from: 0.9, to: 0.95 };
        let (carried, status) = back.carry(lifted(&g.uv), &mut history, &mut phase)?;
        let back = Meeting { gap: back.farthest(&carried), source: turned, target: carried, status };
        if back.gap < there.gap { back } else { there }
    } else {
        there
    };
    // 5. g⁻¹: the locations on the target
    let mut phase = Phase { whole: observer, from: 0.95, to: 1.0 };
    let locator = Locator::new(&met.target, target.faces());
    let (locations, status) = located(&locator, &met.source, met.status, &mut phase)?;
    // 6. Figures
    let error = |(&p, &q): (&usize, &usize)| met.source[p].distance(met.target[q]);
    let landmark_error: Vec<f64> = landmarks.source.iter().zip(landmarks.target).map(error).collect();
    let missed = missed(landmarks, &landmark_error, target, &locations);
    let registered = flat(&met.source);
    let target_registered = flat(&met.target);
    let figures = |mesh: &TriangleMesh, map: &[[f64; 2]]| {
        distortion(mesh.points(), mesh.faces(), Image::Plane(map), mesh.face_areas())
    };
    let target_distortion = figures(target, &target_registered)?;
    let distortion = figures(source, &registered)?;
    if status != Status::Cancelled {
        observer.progress(1.0, "Done");
    }
    let status = verdict(status, [f.status, g.status], &missed, [&distortion, &target_distortion]);
    Ok(Registration {
        locations,
        registered,
        target_registered,
        target_faces: target.faces().to_vec(),
        source_map: f,
        target_map: g,
        landmark_error,
        status,
        missed,
        iterations: history.iterations(),
        distortion,
        target_distortion,
        seconds: history.seconds(),
    })
}

/// Both surfaces in the disk with their landmarks together, up to a gap.
struct Meeting {
    source: Vec<Vector3>,
    target: Vec<Vector3>,
    gap: f64,
    status: Status,
}

/// A map rotated by an angle, or as it is if rounding would fold a sliver.
fn turned(mesh: &TriangleMesh, map: &DiskMap, turn: f64) -> Vec<Vector3> {
    let (sine, cosine) = turn.sin_cos();
    let turned: Vec<[f64; 2]> =
        map.uv.iter().map(|&[u, v]| [cosine * u - sine * v, sine * u + cosine * v]).collect();
    if folded_in_plane(mesh.faces(), &turned).is_empty() { lifted(&turned) } else { lifted(&map.uv) }
}

/// The images of some vertices.
fn picked(map: &DiskMap, vertices: &[usize]) -> Vec<Vector3> {
    lifted(&vertices.iter().map(|&vertex| map.uv[vertex]).collect::<Vec<_>>())
}
