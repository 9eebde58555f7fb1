// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration of two disks (Liu & Yueh 2023, section 6): φ = g⁻¹ ∘ h ∘ f.
//!
//! f and g are the area-preserving maps of source and target to the unit disk, h moves the source's landmarks onto the
//! target's. The paper holds the boundary of h at the best rotation; here it slides along the circle, which preserves
//! the areas of the faces next to it too. At last it is laid onto the boundary of g's image, which is a polygon.

use super::between::{Between, Lowered};
use super::boundary::{OnRim, Onto};
use super::correspondence::{Correspondence, Registered, meshes};
use super::extremities::with_extremities;
use super::features::Signals;
use super::filling::Filling;
use super::landmark_descent::Carrying;
use super::landmarks::{Landmarks, best_turn, fewest};
use super::options::{Energy, RegistrationOptions, SHARE_OF_DOMAIN};
use super::result::{CarryingOptions, DiskRegistration, Registration};
use super::start_grid::StartSurface;
use super::starts::{Rank, best_of};
use super::surface::Start;
use super::verdict::{MISSED, located, missed, verdict};
use crate::arrays::{from_rows, rows, vectors};
use crate::codomain::CanonicalDomain;
use crate::codomain::planar::{flat, lifted};
use crate::control::{History, Observer, Phase, Rising, Status};
use crate::disk::{DiskMap, DiskMapOptions, map_disk};
use crate::distortion::{Image, folded_in_plane, measure};
use crate::error::{Error, Side};
use crate::location::{Location, Locator};
use crate::mesh::{Surface, TriangleMesh};
use crate::vector::Vector3;

/// Disks with more vertices have one start.
const LARGE: usize = 30_000;

/// Registers two disks by landmarks inside them.
///
/// # Errors
/// Surfaces that are no disks, landmarks that are no pairs of interior vertices, and options out of range, all before
/// any work; the errors of [`disk_map`](crate::disk_map); [`Error::CancelledEarly`].
///
/// ```
/// use authalic::{Landmarks, RegistrationOptions, Silent, Surface, register_disks};
/// use ndarray::array;
///
/// let vertices = array![[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
/// let surface = Surface::new(&vertices, array![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])?;
/// let landmarks = Landmarks { source: &[0], target: &[0] };
/// let options = RegistrationOptions::default();
/// let registration = register_disks(&surface, &surface, &landmarks, &options, &mut Silent)?;
/// assert!(registration.distortion.folded.is_empty() && registration.missed.is_empty());
/// assert_eq!(registration.correspondence.positions().row(0), vertices.row(0));
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn register_disks(
    source_surface: &Surface,
    target_surface: &Surface,
    landmarks: &Landmarks<'_>,
    options: &RegistrationOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<DiskRegistration, Error> {
    if options.fill_holes {
        let filling = Filling::Disks;
        return filling.registered(
            [source_surface, target_surface],
            landmarks,
            options,
            observer,
            register_disks,
        );
    }
    // an observer that has cancelled the run is not asked again
    let observer: &mut dyn Observer = &mut Rising::new(observer);
    let mut history = History::start();
    // 1. Refuse what cannot be registered before any work
    let (source, target) = meshes(source_surface, target_surface)?;
    source.require_disk().map_err(|error| error.of_surface(Side::Source))?;
    target.require_disk().map_err(|error| error.of_surface(Side::Target))?;
    landmarks.check(source, target, fewest(CanonicalDomain::Disk))?;
    options.check(landmarks.source.len())?;
    let signals = options.signals([source, target])?;
    // 2. Both over each other in the disk, and with the energy between them the descent
    let pair = Pair {
        meshes: [source, target],
        target_points: &vectors(target_surface.vertices()),
        landmarks,
        signals: &signals,
        options,
    };
    let laid = match options.energy {
        Energy::Area => pair.laid(landmarks, &mut history, observer)?,
        Energy::Surface => pair.descended(&mut history, observer)?.measured_on(pair.meshes)?,
    };
    let Laid { maps: [f, g], met, on_rim, locations, status, .. } = laid;
    // 3. Figures
    let error = |(&p, &q): (&usize, &usize)| met.source[p].distance(met.target[q]);
    let landmark_error: Vec<f64> = landmarks.source.iter().zip(landmarks.target).map(error).collect();
    let missed = missed(landmarks, options, &landmark_error, target, &locations);
    let registered = flat(&met.source);
    let target_registered = flat(&met.target);
    let figures = |mesh: &TriangleMesh, map: &[[f64; 2]]| {
        measure(mesh.points(), mesh.faces(), Image::Plane(map), mesh.face_areas())
    };
    let target_distortion = figures(target, &target_registered)?;
    let distortion = figures(source, &registered)?;
    if status != Status::Cancelled {
        observer.progress(1.0, "Done");
    }
    let status =
        verdict(options.energy, status, [f.status, g.status], &missed, [&distortion, &target_distortion]);
    let source = Registered::new(source_surface, source.faces(), met.source);
    let target = Registered::new(target_surface, target.faces(), met.target);
    Ok(Registration {
        correspondence: Correspondence::new(source, target, locations),
        registered: from_rows(registered),
        target_registered: from_rows(target_registered),
        source_map: f,
        target_map: g,
        landmarks: [landmarks.source.to_vec(), landmarks.target.to_vec()],
        landmark_error: landmark_error.into(),
        status,
        missed,
        off_boundary: on_rim.inside,
        carrying: CarryingOptions::new(options),
        whole: None,
        original: None,
        iterations: history.iterations(),
        distortion,
        target_distortion,
        seconds: history.seconds(),
    })
}

/// Two disks to lay over each other.
struct Pair<'a, 'f> {
    meshes: [&'a TriangleMesh; 2],
    /// The target's vertices as given.
    target_points: &'a [Vector3],
    landmarks: &'a Landmarks<'a>,
    signals: &'a Signals,
    options: &'a RegistrationOptions<'f>,
}

/// Two disks over each other.
struct Laid {
    /// f and g.
    maps: [DiskMap; 2],
    met: Meeting,
    on_rim: OnRim,
    /// The locations of the source on the target.
    locations: Vec<Location>,
    /// The energy between the surfaces; infinite before the descent.
    energy: f64,
    status: Status,
}

impl Laid {
    /// The same with the figures of the maps for the given surfaces.
    fn measured_on(self, [source, target]: [&TriangleMesh; 2]) -> Result<Self, Error> {
        let [f, g] = self.maps;
        Ok(Self { maps: [f.measured_on(source)?, g.measured_on(target)?], ..self })
    }
}

impl Pair<'_, '_> {
    /// Lays the disks over each other so that the energy between them is low: from a start with the extremities that
    /// they have in common, if there are some, and one without; large ones without alone.
    fn descended(&self, history: &mut History, observer: &mut dyn Observer) -> Result<Laid, Error> {
        let is_large = self.meshes.iter().any(|mesh| mesh.n_vertices() > LARGE);
        let with_extremities =
            if is_large { None } else { with_extremities(self.meshes, self.landmarks, observer)? };
        let mut starts = vec![*self.landmarks];
        if let Some([source, target]) = &with_extremities {
            starts.insert(0, Landmarks { source, target });
        }
        let lay = |k: usize, observer: &mut dyn Observer| {
            let mut phase = Phase { whole: observer, from: 0.0, to: SHARE_OF_DOMAIN };
            let laid = self.laid(&starts[k], history, &mut phase)?;
            let mut phase = Phase { whole: observer, from: SHARE_OF_DOMAIN, to: 1.0 };
            self.lowered(laid, history, &mut phase)
        };
        let rank =
            |laid: &Laid| Rank { n_apart: self.n_apart(laid), energy: laid.energy, status: laid.status };
        let (best, is_cancelled) = best_of(starts.len(), observer, lay, rank)?;
        // the map of an earlier start is kept, but the run is cancelled
        Ok(if is_cancelled { Laid { status: Status::Cancelled, ..best } } else { best })
    }

    /// Lays the disks over each other by their maps.
    fn laid(
        &self,
        landmarks: &Landmarks<'_>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<Laid, Error> {
        let options = self.options;
        let surfaces = StartSurface::of_both(self.meshes, landmarks, options.energy);
        let [source, target]: [&TriangleMesh; 2] = [&surfaces[0].mesh, &surfaces[1].mesh];
        // 1. Both surfaces to the disk
        let alone = DiskMapOptions { angle_weight: options.angle_weight_in_domain(), ..Default::default() };
        let map = |mesh: &TriangleMesh, side, observer: &mut dyn Observer| {
            map_disk(mesh, &alone, observer).map_err(|error| error.of_surface(side))
        };
        let f = map(source, Side::Source, &mut Phase { whole: observer, from: 0.0, to: 0.3 })?;
        let g = map(target, Side::Target, &mut Phase { whole: observer, from: 0.3, to: 0.6 })?;
        // 2. The best rotation of the landmarks
        let [in_disk, target_in_disk] = [&f, &g].map(|map| lifted(rows(map.uv.view())));
        let places = picked(&target_in_disk, landmarks.target);
        let turn = best_turn(&picked(&in_disk, landmarks.source), &places);
        // 3. h: the source's landmarks carried to the target's; if some are missed, the target's to the source's
        let images = [turned(source, in_disk, turn), target_in_disk];
        let mut met = self.meet([source, target], images, landmarks, history, observer)?;
        // 4. The source's boundary onto the target's, which is a polygon; where that bends the target itself says
        let on_rim = met.onto_target([source, self.meshes[1]], landmarks, options, history, observer)?;
        // 5. g⁻¹: the locations on the target
        let mut phase = Phase { whole: observer, from: 0.95, to: 1.0 };
        let locator = Locator::new(&met.target, target.faces());
        let (mut locations, status) = located(&locator, &met.source, met.status, &mut phase)?;
        on_rim.set(&mut locations);
        Ok(Laid { maps: [f, g], met, on_rim, locations, energy: f64::INFINITY, status })
    }

    /// Carries the source's landmarks to the target's; if some are missed also the target's to the source's, if that is
    /// nearer.
    fn meet(
        &self,
        [source, target]: [&TriangleMesh; 2],
        [source_image, target_image]: [Vec<Vector3>; 2],
        landmarks: &Landmarks<'_>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<Meeting, Error> {
        let options = self.options;
        let ours = picked(&source_image, landmarks.source);
        let theirs = picked(&target_image, landmarks.target);
        let disk = |mesh, landmarks, places| Carrying {
            mesh,
            domain: CanonicalDomain::Disk,
            holds_boundary: false,
            landmarks,
            places,
            weight: options.weight,
            angle_weight: options.angle_weight_in_domain(),
        };
        let there = disk(source, landmarks.source, &theirs);
        let mut phase = Phase { whole: observer, from: 0.6, to: 0.85 };
        let (carried, status) = there.carry(source_image.clone(), history, &mut phase)?;
        let there =
            Meeting { gap: there.farthest(&carried), source: carried, target: target_image.clone(), status };
        if there.gap <= MISSED || status == Status::Cancelled {
            return Ok(there);
        }
        let back = disk(target, landmarks.target, &ours);
        let mut phase = Phase { whole: observer, from: 0.85, to: 0.9 };
        let (carried, status) = back.carry(target_image, history, &mut phase)?;
        let back = Meeting { gap: back.farthest(&carried), source: source_image, target: carried, status };
        Ok(if back.gap < there.gap { back } else { there })
    }

    /// After the descent between the surfaces.
    fn lowered(&self, laid: Laid, history: &mut History, observer: &mut dyn Observer) -> Result<Laid, Error> {
        if laid.status == Status::Cancelled {
            return Ok(laid);
        }
        let Laid { maps, mut met, on_rim, locations, .. } = laid;
        let between = Between {
            source: self.meshes[0],
            target: self.meshes[1],
            target_points: self.target_points,
            domain: CanonicalDomain::Disk,
            target_in_domain: &met.target,
            landmarks: self.landmarks,
            signals: self.signals.clone(),
            options: self.options,
            start: Start::Domain,
            is_coarse: false,
        };
        let Lowered { locations, registered, energy, status } =
            between.lower(locations, history, observer)?;
        met.source = registered;
        Ok(Laid { maps, met, on_rim, locations, energy, status })
    }

    /// The number of exact pairs of landmarks that do not meet.
    fn n_apart(&self, laid: &Laid) -> usize {
        let [ours, theirs] = [&laid.met.source, &laid.met.target];
        let pairs = self.landmarks.source.iter().zip(self.landmarks.target).enumerate();
        let is_apart = |&(pair, (&p, &q)): &(usize, (&usize, &usize))| {
            self.options.pair_weight(pair).is_infinite() && ours[p].distance(theirs[q]) > MISSED
        };
        pairs.filter(is_apart).count()
    }
}

/// Both surfaces in the disk with their landmarks together, up to a gap.
struct Meeting {
    source: Vec<Vector3>,
    target: Vec<Vector3>,
    gap: f64,
    status: Status,
}

impl Meeting {
    /// Carries the source's boundary onto the target's, where that is possible; returns what of it lies where.
    fn onto_target(
        &mut self,
        meshes: [&TriangleMesh; 2],
        landmarks: &Landmarks<'_>,
        options: &RegistrationOptions<'_>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<OnRim, Error> {
        let onto = Onto {
            meshes,
            images: [&self.source, &self.target],
            landmarks: [landmarks.source, landmarks.target],
            weight: options.weight,
            angle_weight: options.angle_weight_in_domain(),
        };
        if self.status == Status::Cancelled {
            // one solve, and the landmarks stay where it takes them
            let on_rim = onto.on_rim(&self.source).unwrap_or_default();
            if !on_rim.map.is_empty() {
                self.source = lifted(&on_rim.map);
            }
            return Ok(on_rim);
        }
        let mut phase = Phase { whole: observer, from: 0.9, to: 0.95 };
        let Some(carried) = onto.carry(history, &mut phase)? else { return Ok(OnRim::default()) };
        self.source = carried.image;
        self.status = carried.status.unwrap_or(self.status);
        Ok(carried.on_rim)
    }
}

/// A map rotated by an angle, or as it is if rounding would fold a sliver.
fn turned(mesh: &TriangleMesh, map: Vec<Vector3>, turn: f64) -> Vec<Vector3> {
    let (sine, cosine) = turn.sin_cos();
    let turned: Vec<[f64; 2]> =
        map.iter().map(|&Vector3([u, v, _])| [cosine * u - sine * v, sine * u + cosine * v]).collect();
    if folded_in_plane(mesh.faces(), &turned).is_empty() { lifted(&turned) } else { map }
}

/// The images of some vertices.
fn picked(map: &[Vector3], vertices: &[usize]) -> Vec<Vector3> {
    vertices.iter().map(|&vertex| map[vertex]).collect()
}
