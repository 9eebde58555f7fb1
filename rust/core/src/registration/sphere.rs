// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration of two closed surfaces of genus 0 (Sutti & Yueh 2024, section 6.6): g = f₁⁻¹ ∘ h₁⁻¹ ∘ h₀ ∘ f₀.
//!
//! f₀ and f₁ are the area-preserving maps of source and target to the sphere. After the best rotation h₀ and
//! h₁ move both landmarks of a pair to the middle between them, so that each surface moves only half the way.

use std::borrow::Cow;

use super::between::{Between, Lowered};
use super::coarse_to_fine::CoarsePair;
use super::correspondence::{Correspondence, Registered, meshes};
use super::extremities::with_extremities;
use super::feature_start::{OnSphere, aligned};
use super::features::Signals;
use super::filling::Filling;
use super::landmark_descent::Carrying;
use super::landmarks::{Landmarks, fewest};
use super::options::{Energy, RegistrationOptions, SHARE_OF_DOMAIN, START_ANGLE_WEIGHTS};
use super::result::{CarryingOptions, Registration, SphereRegistration};
use super::start_grid::{StartSurface, turned_back};
use super::starts::{Rank, best_of};
use super::surface::Start;
use super::verdict::{MISSED, located, missed, verdict, worst};
use crate::alignment::rotation::{best_rotation, rotate};
use crate::arrays::{from_vectors, vectors};
use crate::codomain::CanonicalDomain;
use crate::control::{History, Observer, Phase, Rising, Status, Watch};
use crate::distortion::{Image, folded_on_sphere, measure};
use crate::error::{Error, Side};
use crate::location::{Location, Locator};
use crate::mesh::geometry::{area_vector, triangle};
use crate::mesh::{Surface, TriangleMesh};
use crate::parallel;
use crate::sphere::{SphereMap, SphereMapOptions, map_sphere};
use crate::vector::Vector3;

/// Two meeting places are too close below this part of the distance of their landmarks on either surface.
const CROWDED: f64 = 0.3;

/// Angle weight of both maps where features alone lay the spheres over each other: maps that trade areas for angles lay
/// like parts of two surfaces at like places of the sphere.
const FEATURE_ANGLE_WEIGHT: f64 = 1.0;

/// Sweeps that even out the maps of coarse meshes on their way to the whole; those of either surface alone get one.
const SWEEPS: usize = 4;

/// Distance up to which exact landmarks of coarse meshes have met; else the whole surfaces are laid over each other.
const MET: f64 = 1e-9;

/// Sine of the angle between two points up to which they lie about one axis.
const ON_ONE_AXIS: f64 = 1e-2;

/// Weight, against that of a landmark, of the wish to rotate as little as possible.
const LEAST_TURN: f64 = 1e-9;

/// Registers two closed surfaces of genus 0 by landmarks.
///
/// A target that is inside out relative to the source is turned over first.
///
/// # Errors
/// Surfaces that are no spheres, landmarks that are no pairs of vertices, and options out of range, all before
/// any work; the errors of [`sphere_map`](crate::sphere_map); [`Error::CancelledEarly`].
///
/// ```
/// use authalic::{Landmarks, RegistrationOptions, Silent, Surface, register_spheres};
/// use ndarray::array;
///
/// let vertices = array![[3., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
/// let faces = array![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
/// let surface = Surface::new(vertices, faces)?;
/// let landmarks = Landmarks { source: &[0, 2], target: &[0, 2] };
/// let options = RegistrationOptions::default();
/// let registration = register_spheres(&surface, &surface, &landmarks, &options, &mut Silent)?;
/// assert!(registration.distortion.folded.is_empty() && registration.missed.is_empty());
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn register_spheres(
    source_surface: &Surface,
    target_surface: &Surface,
    landmarks: &Landmarks<'_>,
    options: &RegistrationOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<SphereRegistration, Error> {
    if options.fill_holes {
        let filling = Filling::Spheres;
        return filling.registered(
            [source_surface, target_surface],
            landmarks,
            options,
            observer,
            register_spheres,
        );
    }
    // where coarse meshes are of no use, the whole surfaces begin anew
    let observer: &mut dyn Observer = &mut Rising::new(observer);
    let mut history = History::start();
    // 1. Refuse what cannot be registered before any work
    let (source, target) = meshes(source_surface, target_surface)?;
    source.require_sphere().map_err(|error| error.of_surface(Side::Source))?;
    target.require_sphere().map_err(|error| error.of_surface(Side::Target))?;
    let needed = if options.features.is_some() { 0 } else { fewest(CanonicalDomain::Sphere) };
    landmarks.check(source, target, needed)?;
    options.check(landmarks.source.len())?;
    let signals = options.signals([source, target])?;
    let target = &*not_inside_out(target, source);
    // 2. Both over each other on the sphere, and with the energy between them the descent
    let pair = Pair {
        meshes: [source, target],
        target_points: &vectors(target_surface.vertices()),
        landmarks,
        signals: &signals,
        options,
        is_coarse: false,
    };
    let laid = match options.energy {
        Energy::Area => pair.laid(options.angle_weight_in_domain(), landmarks, &mut history, observer)?,
        Energy::Surface => pair.descended(&mut history, observer)?.turned_back(pair.meshes)?,
    };
    let Laid { maps: [f0, f1], registered: [registered, target_registered], locations, status, .. } = laid;
    // 3. Figures
    let landmark_pairs = pairs(landmarks, &registered, &target_registered);
    let landmark_error: Vec<f64> = landmark_pairs.iter().map(|[p, q]| p.distance(*q)).collect();
    let missed = missed(landmarks, options, &landmark_error, target, &locations);
    let figures = |mesh: &TriangleMesh, map: &[Vector3]| {
        measure(mesh.points(), mesh.faces(), Image::Sphere(map), mesh.face_areas())
    };
    let target_distortion = figures(target, &target_registered)?;
    let distortion = figures(source, &registered)?;
    if status != Status::Cancelled {
        observer.progress(1.0, "Done");
    }
    let status =
        verdict(options.energy, status, [f0.status, f1.status], &missed, [&distortion, &target_distortion]);
    let maps = [&registered, &target_registered].map(|map| from_vectors(map.clone()));
    let [on_domain, target_on_domain] = maps;
    let source = Registered::new(source_surface, source.faces(), registered);
    let target = Registered::new(target_surface, target.faces(), target_registered);
    Ok(Registration {
        correspondence: Correspondence::new(source, target, locations),
        registered: on_domain,
        target_registered: target_on_domain,
        source_map: f0,
        target_map: f1,
        landmarks: [landmarks.source.to_vec(), landmarks.target.to_vec()],
        landmark_error: landmark_error.into(),
        status,
        missed,
        off_boundary: Vec::new(),
        carrying: CarryingOptions::new(options),
        whole: None,
        original: None,
        iterations: history.iterations(),
        distortion,
        target_distortion,
        seconds: history.seconds(),
    })
}

/// Two spheres to lay over each other.
#[derive(Clone, Copy)]
struct Pair<'a, 'f> {
    meshes: [&'a TriangleMesh; 2],
    /// The target's vertices as given.
    target_points: &'a [Vector3],
    landmarks: &'a Landmarks<'a>,
    signals: &'a Signals,
    options: &'a RegistrationOptions<'f>,
    /// Whether they are coarse meshes of others.
    is_coarse: bool,
}

/// Two spheres over each other.
struct Laid {
    /// The axes of their frames, see [`StartSurface`]: f₀ is in that of the source, all else in that of the target.
    axes: [[Vector3; 3]; 2],
    /// f₀ and f₁.
    maps: [SphereMap; 2],
    /// h₀∘f₀ and h₁∘f₁.
    registered: [Vec<Vector3>; 2],
    /// The locations of the source on the target.
    locations: Vec<Location>,
    /// The energy between the surfaces; infinite before the descent.
    energy: f64,
    status: Status,
}

impl Laid {
    /// The same in the coordinates of the `given` surfaces, with the figures of their maps; what lies in one frame stays as
    /// it is where rounding would fold a sliver.
    fn turned_back(self, [source, target]: [&TriangleMesh; 2]) -> Result<Self, Error> {
        let is_folded =
            |mesh: &TriangleMesh, map: &[Vector3]| !folded_on_sphere(mesh.faces(), map).is_empty();
        let folds = |(mesh, before, after): (&TriangleMesh, &[Vector3], &[Vector3])| {
            is_folded(mesh, after) && !is_folded(mesh, before)
        };
        let [f0, f1] = self.maps.each_ref().map(|map| vectors(map.positions.view()));
        let [h0, h1] = &self.registered;
        let back = |side: usize, map: &[Vector3]| turned_back(self.axes[side], map);
        // 1. f₀ from the source's frame
        let turned = back(0, &f0);
        let f0 = if folds((source, &f0, &turned)) { f0 } else { turned };
        // 2. All else from the target's
        let turned = [back(1, &f1), back(1, h0), back(1, h1)];
        let pairs = [(target, &f1[..], &turned[0][..]), (source, h0, &turned[1]), (target, h1, &turned[2])];
        let [f1, h0, h1] = if pairs.into_iter().any(folds) { [f1, h0.clone(), h1.clone()] } else { turned };
        let [of_source, of_target] = self.maps;
        let maps = [
            SphereMap { positions: from_vectors(f0), ..of_source }.measured_on(source)?,
            SphereMap { positions: from_vectors(f1), ..of_target }.measured_on(target)?,
        ];
        Ok(Self { maps, registered: [h0, h1], ..self })
    }
}

impl Pair<'_, '_> {
    /// Lays the spheres over each other so that the energy between them is low: from coarse meshes where they are large,
    /// else the best of several starts.
    fn descended(&self, history: &mut History, observer: &mut dyn Observer) -> Result<Laid, Error> {
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.5 };
        if let Some(laid) = self.laid_coarse_to_fine(history, &mut phase)? {
            let mut phase = Phase { whole: observer, from: 0.5, to: 1.0 };
            return self.lowered(laid, Start::Coarse, history, &mut phase);
        }
        let with_extremities = with_extremities(self.meshes, self.landmarks, observer)?;
        let starts = self.starts(with_extremities.as_ref());
        let lay = |k: usize, observer: &mut dyn Observer| {
            let (angle_weight, landmarks) = &starts[k];
            let mut phase = Phase { whole: observer, from: 0.0, to: SHARE_OF_DOMAIN };
            let laid = self.laid(*angle_weight, landmarks, history, &mut phase)?;
            let mut phase = Phase { whole: observer, from: SHARE_OF_DOMAIN, to: 1.0 };
            self.lowered(laid, Start::Domain, history, &mut phase)
        };
        let rank =
            |laid: &Laid| Rank { n_apart: self.n_apart(laid), energy: laid.energy, status: laid.status };
        let (best, is_cancelled) = best_of(starts.len(), observer, lay, rank)?;
        // the map of an earlier start is kept, but the run is cancelled
        Ok(if is_cancelled { Laid { status: Status::Cancelled, ..best } } else { best })
    }

    /// Lays coarse meshes of the spheres over each other, and takes their maps to the whole; `None` where the spheres are
    /// small, or where exact landmarks of the coarse meshes do not meet.
    fn laid_coarse_to_fine(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<Option<Laid>, Error> {
        let domain = CanonicalDomain::Sphere;
        // 1. Coarse meshes
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.1 };
        let Some(coarse) = CoarsePair::new(self.meshes, self.landmarks, &mut phase)? else { return Ok(None) };
        let meshes = coarse.meshes();
        let (landmarks, signals) = (&coarse.landmarks(), &coarse.signals(self.signals));
        let target_points = meshes[1].points();
        let pair = Pair { meshes, target_points, landmarks, signals, is_coarse: true, ..*self };
        // 2. Over each other
        let mut phase = Phase { whole: observer, from: 0.1, to: 0.9 };
        let mut unseen = |fraction: f64, message: &str| phase.progress(fraction, message);
        let laid = pair.descended(history, &mut unseen)?;
        if pair.n_apart(&laid) > 0 {
            return Ok(None);
        }
        // 3. Taken to the whole
        let [f0, f1] = [&laid.maps[0], &laid.maps[1]].map(|map| vectors(map.positions.view()));
        let of_maps = coarse.refined([&f0, &f1], domain, 1);
        let of_registered = coarse.refined([&laid.registered[0], &laid.registered[1]], domain, SWEEPS);
        let (Some([f0, f1]), Some(registered)) = (of_maps, of_registered) else { return Ok(None) };
        let status = laid.status;
        let of_positions = |k: usize, map: Vec<Vector3>| SphereMap::of_positions(self.meshes[k], map, status);
        let maps = [of_positions(0, f0)?, of_positions(1, f1)?];
        let mut phase = Phase { whole: observer, from: 0.9, to: 1.0 };
        self.located(laid.axes, maps, registered, status, &mut phase).map(Some)
    }

    /// The source's locations on the target: h₁⁻¹.
    fn located(
        &self,
        axes: [[Vector3; 3]; 2],
        maps: [SphereMap; 2],
        registered: [Vec<Vector3>; 2],
        status: Status,
        observer: &mut dyn Observer,
    ) -> Result<Laid, Error> {
        let locator = Locator::new(&registered[1], self.meshes[1].faces());
        let (locations, status) = located(&locator, &registered[0], status, observer)?;
        Ok(Laid { axes, maps, registered, locations, energy: f64::INFINITY, status })
    }

    /// After the descent between the surfaces.
    fn lowered(
        &self,
        laid: Laid,
        start: Start,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<Laid, Error> {
        let Laid { registered: [_, target_registered], locations, status, .. } = &laid;
        if *status == Status::Cancelled {
            return Ok(laid);
        }
        let between = Between {
            source: self.meshes[0],
            target: self.meshes[1],
            target_points: self.target_points,
            domain: CanonicalDomain::Sphere,
            target_in_domain: target_registered,
            landmarks: self.landmarks,
            signals: self.signals.clone(),
            options: self.options,
            start,
            is_coarse: self.is_coarse,
        };
        let Lowered { locations, registered, energy, status } =
            between.lower(locations.clone(), history, observer)?;
        let [_, target_registered] = laid.registered;
        Ok(Laid { registered: [registered, target_registered], locations, energy, status, ..laid })
    }

    /// The number of exact pairs of landmarks that do not meet; on coarse meshes they must meet exactly.
    fn n_apart(&self, laid: &Laid) -> usize {
        let limit = if self.is_coarse { MET } else { MISSED };
        let [ours, theirs] = &laid.registered;
        let is_apart = |(pair, [p, q]): &(usize, [Vector3; 2])| {
            self.options.pair_weight(*pair).is_infinite() && p.distance(*q) > limit
        };
        pairs(self.landmarks, ours, theirs).into_iter().enumerate().filter(is_apart).count()
    }

    /// Starts of the descent: the angle weight of the maps, and the landmarks that meet in them.
    fn starts<'a>(&'a self, with_extremities: Option<&'a [Vec<usize>; 2]>) -> Vec<(f64, Landmarks<'a>)> {
        let [keeps_shapes, keeps_areas] = START_ANGLE_WEIGHTS;
        let given = *self.landmarks;
        match with_extremities {
            _ if !self.is_laid_by_landmarks() => vec![(FEATURE_ANGLE_WEIGHT, given)],
            None => vec![(keeps_shapes, given), (keeps_areas, given)],
            Some([source, target]) => {
                vec![(keeps_shapes, Landmarks { source, target }), (keeps_shapes, given)]
            }
        }
    }

    fn is_laid_by_landmarks(&self) -> bool {
        self.landmarks.source.len() >= fewest(CanonicalDomain::Sphere)
    }

    /// Lays the spheres over each other by their maps.
    fn laid(
        &self,
        angle_weight: f64,
        landmarks: &Landmarks<'_>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<Laid, Error> {
        let &Self { signals, options, .. } = self;
        let surfaces = StartSurface::of_both(self.meshes, landmarks, options.energy);
        let [source, target]: [&TriangleMesh; 2] = [&surfaces[0].mesh, &surfaces[1].mesh];
        // 1. Both surfaces to the sphere
        let alone = SphereMapOptions { angle_weight, ..Default::default() };
        let map = |mesh: &TriangleMesh, side, observer: &mut dyn Observer| {
            map_sphere(mesh, &alone, observer).map_err(|error| error.of_surface(side))
        };
        let f0 = map(source, Side::Source, &mut Phase { whole: observer, from: 0.0, to: 0.3 })?;
        let f1 = map(target, Side::Target, &mut Phase { whole: observer, from: 0.3, to: 0.6 })?;
        // 2. The source turned by landmarks, and bent by features; the middle of each pair
        let [on_sphere, target_on_sphere] = [&f0, &f1].map(|map| vectors(map.positions.view()));
        let by_landmarks = self
            .is_laid_by_landmarks()
            .then(|| turned(&surfaces, on_sphere.clone(), landmarks, &target_on_sphere));
        let (turned, start) = match by_landmarks {
            Some(turned) if options.features.is_none() => (turned, Status::Converged),
            by_landmarks => aligned(
                OnSphere { mesh: source, map: &on_sphere },
                OnSphere { mesh: target, map: &target_on_sphere },
                signals,
                by_landmarks,
                &pairs(landmarks, &on_sphere, &target_on_sphere),
                &Watch::new(observer, 0.6, "Aligning features"),
            )?,
        };
        let places = meeting_places(&pairs(landmarks, &turned, &target_on_sphere));
        // 3. h₀ and h₁: the landmarks of both carried to the middles
        let carrying = |mesh, landmarks| Carrying {
            mesh,
            domain: CanonicalDomain::Sphere,
            holds_boundary: false,
            landmarks,
            places: &places,
            weight: options.weight,
            angle_weight,
        };
        let mut phase = Phase { whole: observer, from: 0.6, to: 0.75 };
        let (registered, first) = carrying(source, landmarks.source).carry(turned, history, &mut phase)?;
        let mut phase = Phase { whole: observer, from: 0.75, to: 0.9 };
        let (target_registered, second) =
            carrying(target, landmarks.target).carry(target_on_sphere, history, &mut phase)?;
        // 4. The source's locations on the target
        let mut phase = Phase { whole: observer, from: 0.9, to: 1.0 };
        let status = worst([start, first, second]);
        let axes = surfaces.each_ref().map(|surface| surface.axes);
        self.located(axes, [f0, f1], [registered, target_registered], status, &mut phase)
    }
}

/// Whether one of two surfaces is inside out relative to the other, by the signs of their volumes.
pub(crate) fn inside_out(source: &TriangleMesh, target: &TriangleMesh) -> bool {
    volume(source) * volume(target) < 0.0
}

/// A surface, turned over if it is inside out relative to the other.
fn not_inside_out<'a>(surface: &'a TriangleMesh, other: &TriangleMesh) -> Cow<'a, TriangleMesh> {
    if inside_out(surface, other) { Cow::Owned(surface.turned_over()) } else { Cow::Borrowed(surface) }
}

/// Six times the signed volume inside.
fn volume(mesh: &TriangleMesh) -> f64 {
    parallel::sum(mesh.n_faces(), |face| {
        let corners = triangle(mesh.points(), mesh.faces()[face]);
        2.0 * corners[0].dot(area_vector(corners))
    })
}

/// The source's map rotated so that its landmarks come nearest to the target's, or as it is if rounding would
/// fold a sliver.
fn turned(
    surfaces: &[StartSurface<'_>; 2],
    f0: Vec<Vector3>,
    landmarks: &Landmarks<'_>,
    f1: &[Vector3],
) -> Vec<Vector3> {
    let pairs = pairs(landmarks, &f0, f1);
    let (mut ours, mut theirs): (Vec<Vector3>, Vec<Vector3>) = pairs.iter().map(|&[p, q]| (p, q)).unzip();
    let mut weights = vec![1.0; ours.len()];
    if !determine_rotation(&pairs) {
        // the least of equally good rotations
        let axes = [0, 1, 2].map(Vector3::unit);
        ours.extend(axes.map(|axis| surfaces[0].turned(axis)));
        theirs.extend(axes.map(|axis| surfaces[1].turned(axis)));
        weights.extend([LEAST_TURN; 3]);
    }
    let rotation = best_rotation(&ours, &theirs, &weights);
    let turned = parallel::map(f0.len(), |vertex| {
        let turned = rotate(rotation, f0[vertex]);
        turned.normalized()
    });
    if folded_on_sphere(surfaces[0].mesh.faces(), &turned).is_empty() { turned } else { f0 }
}

/// Whether some points do not lie about one axis on either side, as those of two opposite landmarks do: the best rotation is
/// then determined.
fn determine_rotation(pairs: &[[Vector3; 2]]) -> bool {
    let spread = |i: usize, j: usize| {
        let across = [0, 1].map(|side| pairs[i][side].cross(pairs[j][side]).norm());
        across[0].min(across[1])
    };
    (0..pairs.len()).any(|i| (0..i).any(|j| spread(i, j) > ON_ONE_AXIS))
}

/// The places of the landmarks of each pair on the sphere, the source's first.
fn pairs(landmarks: &Landmarks<'_>, source: &[Vector3], target: &[Vector3]) -> Vec<[Vector3; 2]> {
    landmarks.source.iter().zip(landmarks.target).map(|(&p, &q)| [source[p], target[q]]).collect()
}

/// The meeting places of the pairs: their middles, or the target's landmarks if some middles would coincide, as those
/// of two landmarks that change places.
fn meeting_places(pairs: &[[Vector3; 2]]) -> Vec<Vector3> {
    let middle: Vec<Vector3> = pairs.iter().map(|&[p, q]| between(p, q)).collect();
    let is_crowded = |i: usize, j: usize| {
        let apart = |side: usize| pairs[i][side].distance(pairs[j][side]);
        middle[i].distance(middle[j]) < CROWDED * apart(0).min(apart(1))
    };
    let are_crowded = (0..middle.len()).any(|i| (0..i).any(|j| is_crowded(i, j)));
    if are_crowded { pairs.iter().map(|&[_, q]| q).collect() } else { middle }
}

/// The midpoint of two points of the sphere; of opposite points the second.
fn between(a: Vector3, b: Vector3) -> Vector3 {
    let sum = a + b;
    match sum.norm() {
        length if length > 1e-6 => sum * (1.0 / length),
        _ => b,
    }
}
