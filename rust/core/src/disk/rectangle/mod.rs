// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps onto a rectangle: four boundary vertices at its corners, the others sliding along its sides.
//!
//! The rectangle is convex, so a map without folded faces whose boundary vertices keep their order is one-to-one. As on the
//! disk a guarded Gauss–Newton descent lowers the energy of the areas with a share of the angles; a vertex on a side has
//! one unknown.
//!
//! A free aspect is found along with the map. Stretching the rectangle one way and pressing it the other by the same factor
//! changes no area and folds no face, so only the angles tell one aspect from another: after each descent the aspect of
//! least angle energy is taken ([`best_stretch`]), until it moves no more.
//!
//! Inside, rectangles are centered on (0, 0) and have the area of the unit disk; results have their lower left corner in
//! (0, 0) and a longer side of 1.
//!
//! Cost: that of a disk map, and a few iterations for each correction of the aspect.

mod corners;

use std::f64::consts::PI;

use super::options::{Boundary, DiskMapOptions};
use super::published::fixed_point::fixed_point;
use super::published::objective::DiskDomain;
use super::run::Run;
use super::{certificate, unfold};
use crate::codomain::motion::Motion;
use crate::codomain::planar::{PlanarMap, flat, lifted};
use crate::codomain::{Codomain, SpatialMap};
use crate::control::{History, Observer, Phase, Silent, Status, Watch};
use crate::energy::authalic::AuthalicEnergy;
use crate::energy::stretch::Profile;
use crate::error::{Elements, Error, MapError, NumericsError};
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::corner_cotangents;
use crate::mesh::renumbering::Renumbered;
use crate::optimize::gauss_newton::angle_schedule::AnglePath;
use crate::optimize::gauss_newton::area_tolerance::within_tolerance;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, minimize, target_floors};
use crate::optimize::published::Stopping;
use crate::sparse::{Order, elimination_order};
use crate::vector::Vector3;
use corners::Outline;

/// Limit of the fixed-point steps, and the √(gᵀM⁻¹g) that ends them.
const FIXED_POINT: Stopping = Stopping { max_iterations: 5, tolerance: 0.15 };

/// Limit of the unguarded iterations that unfold.
const OPEN_ITERATIONS: usize = 12;

/// Guarded iterations: the number that suffices where it leaves a small area deviation, and the limit.
const GUARDED_ITERATIONS: [usize; 2] = [27, 1000];

/// The descent has converged when the area deviation is below this.
const TOLERANCE: f64 = 2e-4;

/// Limit of the corrections of a free aspect where angles count.
const MOST_CORRECTIONS: usize = 30;

/// Over-relaxation: factor of every correction but the first and the last, which saves about half of them.
const RELAXATION: f64 = 1.5;

/// The aspect is settled when the correction of its logarithm is below this.
const SETTLED: f64 = 1e-4;

/// Upper bound of an aspect and of its inverse.
const MOST_ASPECT: f64 = 1e4;

/// A cancelled run without a map still computes one on surfaces of up to this many vertices.
const QUICK: usize = 50_000;

const MESSAGE: &str = "Start map";

/// A surface with its corners.
struct Rectangle<'a> {
    run: Run<'a>,
    /// The boundary vertices of the bottom, right, top and left side, each without its last corner.
    sides: [Vec<u32>; 4],
    /// The given aspect.
    aspect: Option<f64>,
}

/// Refuses options that do not fit a rectangle, and options of rectangles elsewhere.
pub(super) fn check(mesh: &TriangleMesh, options: &DiskMapOptions<'_>) -> Result<(), Error> {
    if options.boundary != Boundary::Rectangle {
        let given = [("corners", options.corners.is_some()), ("aspect", options.aspect.is_some())];
        return match given.into_iter().find(|&(_, is_given)| is_given) {
            None => Ok(()),
            Some((name, _)) => Err(Error::InvalidOption {
                name,
                found: "given".into(),
                expected: "left out unless the boundary is a rectangle".into(),
            }),
        };
    }
    if let Some(aspect) = options.aspect
        && !(1.0 / MOST_ASPECT..=MOST_ASPECT).contains(&aspect)
    {
        let expected = "width over height, from 1e-4 to 1e4".into();
        return Err(Error::InvalidOption { name: "aspect", found: aspect.to_string(), expected });
    }
    corners_of(mesh, options).map(|_| ())
}

/// The places of the corners along the boundary.
fn corners_of(mesh: &TriangleMesh, options: &DiskMapOptions<'_>) -> Result<[usize; 4], Error> {
    let outline = Outline::new(mesh);
    match (options.corners, options.initial) {
        (Some(corners), _) => outline.given(corners),
        (None, None) => outline.found(options.aspect),
        (None, Some(initial)) => outline.given(corners_of_map(outline.vertices, initial)),
    }
}

/// The boundary vertices nearest to the corners of the bounding box of a map.
fn corners_of_map(outline: &[u32], map: &[[f64; 2]]) -> [usize; 4] {
    let place = |v: u32| map[v as usize];
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]: [f64; 2]| {
        let [low, high] = bounds(outline, map);
        let corner = [if x < 0.0 { low[0] } else { high[0] }, if y < 0.0 { low[1] } else { high[1] }];
        let off = |v: u32| (place(v)[0] - corner[0]).hypot(place(v)[1] - corner[1]);
        *outline.iter().min_by(|&&a, &&b| off(a).total_cmp(&off(b))).expect("a loop has vertices") as usize
    })
}

/// The lowest and highest coordinates.
fn bounds(outline: &[u32], map: &[[f64; 2]]) -> [[f64; 2]; 2] {
    outline.iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], &v| {
        let x = map[v as usize];
        [[0, 1].map(|k| low[k].min(x[k])), [0, 1].map(|k| high[k].max(x[k]))]
    })
}

/// The area inside an outline, negative where it runs clockwise.
fn signed_area(outline: &[u32], map: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let cross = |(&a, &b): (&u32, &u32)| {
        let ([x, y], [u, v]) = (map[a as usize], map[b as usize]);
        x * v - u * y
    };
    0.5 * outline.iter().zip(next).map(cross).sum::<f64>()
}

/// Refuses a start map whose boundary does not run along the sides of an upright rectangle.
pub(super) fn check_initial(
    mesh: &TriangleMesh,
    options: &DiskMapOptions<'_>,
    initial: &[[f64; 2]],
) -> Result<(), Error> {
    let outline = Outline::new(mesh);
    let [low, high] = bounds(outline.vertices, initial);
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let refuse =
        |vertices: &[u32], reason: &str| match Elements::collect(vertices.iter().map(|&v| v as usize)) {
            None => Ok(()),
            Some(vertices) => Err(MapError::InitialBoundary { vertices, reason: reason.into() }.into()),
        };
    if !(high[0] > low[0] && high[1] > low[1]) {
        return refuse(outline.vertices, "it must run around a rectangle");
    }
    if signed_area(outline.vertices, initial) <= 0.0 {
        return refuse(
            outline.vertices,
            "it must run counter-clockwise (mirror the map if it runs clockwise)",
        );
    }
    let is_off = |&&v: &&u32| {
        let on = |axis: usize, line: f64| (initial[v as usize][axis] - line).abs() <= 1e-6 * size;
        ![0, 1].iter().any(|&axis| on(axis, low[axis]) || on(axis, high[axis]))
    };
    let off: Vec<u32> = outline.vertices.iter().filter(is_off).copied().collect();
    refuse(&off, "it must lie on the sides of an upright rectangle")?;
    let corners = corners_of(mesh, options)?;
    for (k, side) in sides(outline.vertices, &corners).iter().enumerate() {
        let (across, line) = ((k + 1) % 2, if k == 0 || k == 3 { low } else { high });
        let off = |&&v: &&u32| (initial[v as usize][across] - line[across]).abs() > 1e-6 * size;
        let off: Vec<u32> = side.iter().filter(off).copied().collect();
        refuse(&off, "it must lie on the sides of an upright rectangle, the corners in its corners")?;
    }
    Ok(())
}

/// The boundary vertices of each side, from its first corner up to its last.
fn sides(outline: &[u32], corners: &[usize; 4]) -> [Vec<u32>; 4] {
    let n = outline.len();
    [0, 1, 2, 3].map(|k| {
        let count = (corners[(k + 1) % 4] + n - corners[k]) % n;
        (0..count).map(|step| outline[(corners[k] + step) % n]).collect()
    })
}

/// Maps a surface onto a rectangle with its lower left corner at (0, 0) and a longer side of 1.
///
/// # Errors
/// [`NumericsError::NoEmbedding`] where every start folds, [`Error::CancelledEarly`] where the observer ended the run
/// before there was a map without folds.
pub(super) fn solve(
    run: &Run<'_>,
    history: &mut History,
    observer: &mut dyn Observer,
) -> Result<(PlanarMap, Status), Error> {
    // 1. The surface in elimination order
    let is_cancelled = !observer.progress(0.0, "Ordering");
    if is_cancelled && run.mesh.n_vertices() > QUICK {
        return Err(Error::CancelledEarly);
    }
    let corners = corners_of(run.mesh, run.options)?;
    let by_order = Renumbered::new(run.mesh, elimination_order(run.mesh.n_vertices(), run.mesh.faces())?);
    let targets = by_order.of_faces(run.targets);
    let initial = run.options.initial.map(|map| by_order.of_vertices(map));
    let options = DiskMapOptions { initial: initial.as_deref(), density: None, ..*run.options };
    let outline = Outline::new(&by_order.mesh);
    let rectangle = Rectangle {
        run: Run { mesh: &by_order.mesh, targets: &targets, options: &options, ..*run },
        sides: sides(outline.vertices, &corners),
        aspect: options.aspect,
    };
    let of_initial = options.initial.map(|map| {
        let [low, high] = bounds(outline.vertices, map);
        (high[0] - low[0]) / (high[1] - low[1])
    });
    let likely = of_initial.unwrap_or_else(|| outline.aspect(&corners));
    let aspect = options.aspect.unwrap_or(likely.clamp(1.0 / MOST_ASPECT, MOST_ASPECT));
    // 2. The map
    let solved = rectangle.solve(aspect, &corners, &outline, is_cancelled, history, observer);
    let given_face = |face| run.given_face(by_order.given_face(face));
    let (map, status) = solved.map_err(|error| error.with_faces(given_face))?;
    // 3. Lower left corner in (0, 0), longer side 1
    let (map, scale) = rectangle.laid_out(&map);
    history.rescale(scale * scale);
    Ok((by_order.given(&map), status))
}

impl Rectangle<'_> {
    /// A map without folds onto the rectangle around (0, 0) with the area of the unit disk.
    fn solve(
        &self,
        aspect: f64,
        corners: &[usize; 4],
        outline: &Outline<'_>,
        is_cancelled: bool,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        let floor = target_floors::floors(self.run.targets)[0];
        let energy = target_floors::energy(self.run.mesh, self.run.targets, Codomain::Plane, floor);
        let problem = Problem::new(energy, self.motions(), Order::AsGiven)?;
        // 1. A map without folds
        let boundary = self.boundary(aspect, corners, outline);
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.4 };
        let (map, status) = self.start(&problem, boundary, is_cancelled, history, &mut phase)?;
        let map = self.with_best_aspect(&problem, &map, 1.0).0;
        if status == Status::Cancelled {
            return Ok((map, status));
        }
        // 2. Guarded descents and corrections of the aspect by turns
        let mut phase = Phase { whole: observer, from: 0.4, to: 0.8 };
        let begun = history.iterations();
        let surface = target_floors::MappedSurface {
            mesh: self.run.mesh,
            targets: self.run.targets,
            codomain: Codomain::Plane,
        };
        if let Some(tolerance) = self.run.options.area_tolerance {
            let options = self.options();
            let (problem, map, status) =
                within_tolerance(&surface, problem, map, tolerance, &options, history, &mut phase);
            // a stretch of the whole changes no area ratio
            return Ok((self.with_best_aspect(&problem, &map, 1.0).0, status));
        }
        let (problem, map, status) =
            target_floors::descend(&surface, problem, map, &self.options(), history, &mut phase);
        let mut phase = Phase { whole: observer, from: 0.8, to: 1.0 };
        Ok(self.settled(&problem, map, status, begun, history, &mut phase))
    }

    /// Corrects a free aspect until it and the map are best for each other.
    fn settled(
        &self,
        problem: &Problem,
        mut map: SpatialMap,
        mut status: Status,
        begun: usize,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Status) {
        let mut options = self.options();
        for round in 0..MOST_CORRECTIONS {
            // 1. The best aspect, over-relaxed on the way
            let (stretched, change) = self.with_best_aspect(problem, &map, 1.0);
            let counts_angles = self.run.options.angle_weight > 0.0;
            let done = history.iterations() - begun;
            let left = self.run.options.max_iterations.map_or(usize::MAX, |most| most.saturating_sub(done));
            options.most_iterations = options.most_iterations.min(left);
            if status == Status::Cancelled
                || change.abs() < SETTLED
                || !counts_angles
                || options.most_iterations == 0
            {
                return (stretched, status);
            }
            map = if round == 0 { stretched } else { self.with_best_aspect(problem, &map, RELAXATION).0 };
            // 2. The map for this aspect
            let from = 1.0 - 0.8f64.powi(round as i32);
            let to = 1.0 - 0.8f64.powi(round as i32 + 1);
            let mut phase = Phase { whole: observer, from, to };
            (map, status) = minimize(problem, map, &options, history, &mut phase);
        }
        (self.with_best_aspect(problem, &map, 1.0).0, status)
    }

    /// The map stretched towards the aspect of least angle energy, and the logarithm by which it is off; unchanged where the
    /// aspect is given.
    fn with_best_aspect(&self, problem: &Problem, map: &SpatialMap, relaxation: f64) -> (SpatialMap, f64) {
        if self.aspect.is_some() {
            return (map.clone(), 0.0);
        }
        let [low, high] = [self.sides[0][0], self.sides[2][0]].map(|corner| map[corner as usize]);
        let now = ((high[0] - low[0]) / (high[1] - low[1])).ln();
        let bound = MOST_ASPECT.ln();
        let change = (now + 2.0 * relaxation * best_stretch(&problem.energy, map)).clamp(-bound, bound) - now;
        let factor = (0.5 * change).exp();
        let stretched: SpatialMap =
            map.iter().map(|&Vector3([x, y, z])| Vector3([x * factor, y / factor, z])).collect();
        if problem.energy.is_embedding(&stretched) { (stretched, change) } else { (map.clone(), 0.0) }
    }

    /// A map without folds.
    fn start(
        &self,
        problem: &Problem,
        boundary: PlanarMap,
        is_cancelled: bool,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        // 1. The given map, or some steps of the papers' fixed point from the harmonic map
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.3 };
        let (near, mut status) = match (is_cancelled, self.run.options.initial) {
            (_, Some(initial)) => (Some(self.given(initial, &boundary)), Status::MaxIterations),
            (true, None) => (None, Status::Cancelled),
            (false, None) => self.near(problem, boundary.clone(), history, &mut phase),
        };
        if is_cancelled {
            status = Status::Cancelled;
        }
        // 2. Folds removed by an unguarded descent, or by mean values
        if let Some(near) = near {
            if problem.energy.is_embedding(&near) {
                return Ok((near, status));
            }
            let mut open = near;
            if status != Status::Cancelled {
                let options = GaussNewtonOptions {
                    profile: Profile::Stretch,
                    until_open: Some(0),
                    usual_iterations: OPEN_ITERATIONS,
                    most_iterations: self
                        .run
                        .options
                        .max_iterations
                        .unwrap_or(OPEN_ITERATIONS)
                        .min(OPEN_ITERATIONS),
                    ..self.options()
                };
                let mut phase = Phase { whole: observer, from: 0.3, to: 0.8 };
                (open, status) = minimize(problem, open, &options, history, &mut phase);
            }
            if problem.energy.is_embedding(&open) {
                return Ok((open, status));
            }
            if status != Status::Cancelled
                && let Some(unfolded) = unfold::unfold(self.run.mesh, &flat(&open)).map(|map| lifted(&map))
                && problem.energy.is_embedding(&unfolded)
            {
                return Ok((unfolded, status));
            }
        }
        // 3. Tutte's embedding
        self.tutte(problem, boundary, status, observer)
    }

    /// The harmonic map and fixed-point steps from it, the boundary held.
    fn near(
        &self,
        problem: &Problem,
        boundary: PlanarMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (Option<SpatialMap>, Status) {
        let Ok(mut domain) = DiskDomain::new(self.run.mesh, problem.energy.targets(), Boundary::ArcLength)
        else {
            return (None, Status::Stalled);
        };
        let by_face = corner_cotangents(self.run.mesh.points(), self.run.mesh.faces());
        let weights: Vec<f64> = by_face.iter().flatten().map(|cotangent| 0.5 * cotangent).collect();
        let mut harmonic = boundary;
        match domain.solve_dirichlet(&weights, &mut harmonic, &Watch::new(observer, 0.0, MESSAGE)) {
            Ok(()) => {}
            Err(Error::CancelledEarly) => return (None, Status::Cancelled),
            Err(_) => return (None, Status::Stalled),
        }
        let (map, status) = fixed_point(&mut domain, harmonic, &FIXED_POINT, history, observer);
        (Some(lifted(&map)), status)
    }

    fn tutte(
        &self,
        problem: &Problem,
        mut map: PlanarMap,
        status: Status,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        if status == Status::Cancelled && self.run.mesh.n_vertices() > QUICK {
            return Err(Error::CancelledEarly);
        }
        let mut silent = Silent;
        let watch = match status {
            // a run already cancelled has no one to ask
            Status::Cancelled => Watch::new(&mut silent, 0.0, MESSAGE),
            _ => Watch::new(observer, 0.8, MESSAGE),
        };
        let mut domain = DiskDomain::new(self.run.mesh, problem.energy.targets(), Boundary::ArcLength)?;
        domain.solve_dirichlet(&vec![0.5; 3 * self.run.mesh.n_faces()], &mut map, &watch)?;
        match Elements::collect(certificate::folded(self.run.mesh, &map)) {
            None => Ok((lifted(&map), status)),
            Some(folded) => Err(NumericsError::NoEmbedding { folded }.into()),
        }
    }

    /// The motions that the vertices are allowed.
    fn motions(&self) -> Vec<Motion> {
        let mut motions = vec![Motion::Plane; self.run.mesh.n_vertices()];
        for (k, side) in self.sides.iter().enumerate() {
            side.iter().for_each(|&vertex| motions[vertex as usize] = Motion::Side(k % 2));
            motions[side[0] as usize] = Motion::Held;
        }
        motions
    }

    /// The boundary on the sides of the rectangle, at distances in proportion to the lengths of the edges.
    fn boundary(&self, aspect: f64, corners: &[usize; 4], outline: &Outline<'_>) -> PlanarMap {
        let [x, y] = half_sides(aspect);
        let places = [[-x, -y], [x, -y], [x, y], [-x, y]];
        let mut map = vec![[0.0; 2]; self.run.mesh.n_vertices()];
        for (k, side) in self.sides.iter().enumerate() {
            let (from, to, whole) =
                (places[k], places[(k + 1) % 4], outline.length(corners[k], corners[(k + 1) % 4]));
            for (step, &vertex) in side.iter().enumerate() {
                let t = match step {
                    0 => 0.0,
                    _ => outline.length(corners[k], (corners[k] + step) % outline.vertices.len()) / whole,
                };
                // both ends share this coordinate exactly
                map[vertex as usize] =
                    [0, 1].map(|c| if from[c] == to[c] { from[c] } else { from[c] + t * (to[c] - from[c]) });
            }
        }
        map
    }

    /// The given start map, on the rectangle of `boundary`.
    fn given(&self, initial: &[[f64; 2]], boundary: &PlanarMap) -> SpatialMap {
        let outline = &self.run.mesh.boundary_loops()[0];
        let ([low, high], [to_low, to_high]) = (bounds(outline, initial), bounds(outline, boundary));
        let along = |x: [f64; 2], k: usize| {
            to_low[k] + (x[k] - low[k]) / (high[k] - low[k]) * (to_high[k] - to_low[k])
        };
        let mut map: SpatialMap = initial.iter().map(|&x| Vector3([along(x, 0), along(x, 1), 1.0])).collect();
        for (k, side) in self.sides.iter().enumerate() {
            let across = (k + 1) % 2;
            side.iter().for_each(|&v| map[v as usize][across] = boundary[side[0] as usize][across]);
            let corner = boundary[side[0] as usize];
            map[side[0] as usize] = Vector3([corner[0], corner[1], 1.0]);
        }
        map
    }

    /// The map with its lower left corner in (0, 0) and a longer side of 1, and the factor.
    fn laid_out(&self, map: &SpatialMap) -> (PlanarMap, f64) {
        let [low, high] = [self.sides[0][0], self.sides[2][0]].map(|corner| map[corner as usize]);
        let sides = [high[0] - low[0], high[1] - low[1]];
        let longer = sides[0].max(sides[1]);
        // the top and right sides exactly straight, the longer one exactly 1
        let place = |x: &Vector3, k: usize| if x[k] == high[k] { sides[k] } else { x[k] - low[k] } / longer;
        let moved: PlanarMap = map.iter().map(|x| [place(x, 0), place(x, 1)]).collect();
        if certificate::folded(self.run.mesh, &moved).is_empty() {
            return (moved, 1.0 / longer);
        }
        // rounding the shift has folded a tiny face; scaling by a power of two rounds nothing
        let scale = (1.0 / longer).log2().floor().exp2();
        (map.iter().map(|&Vector3([x, y, _])| [x * scale, y * scale]).collect(), scale)
    }

    fn options(&self) -> GaussNewtonOptions {
        let options = self.run.options;
        let is_free = options.max_iterations.is_none() && options.tolerance.is_none();
        GaussNewtonOptions {
            profile: Profile::Barrier,
            angle_weight: options.angle_weight,
            path: AnglePath::Balanced,
            usual_iterations: if is_free { GUARDED_ITERATIONS[0] } else { usize::MAX },
            most_iterations: options.max_iterations.unwrap_or(GUARDED_ITERATIONS[1]),
            tolerance: options.tolerance.unwrap_or(TOLERANCE),
            until_open: None,
        }
    }
}

/// Half the width and half the height of a rectangle with the area of the unit disk.
fn half_sides(aspect: f64) -> [f64; 2] {
    [0.5 * (PI * aspect).sqrt(), 0.5 * (PI / aspect).sqrt()]
}

/// The t for which the map (eᵗ x, e⁻ᵗ y) has the least angle energy, by Newton's method on a convex function.
fn best_stretch(energy: &AuthalicEnergy, map: &[Vector3]) -> f64 {
    let mut t = 0.0;
    for _ in 0..50 {
        let [slope, curvature] = energy.angle_slopes_of_stretch(map, t);
        let step = (-slope / curvature).clamp(-1.0, 1.0);
        if !step.is_finite() {
            return 0.0;
        }
        t += step;
        if step.abs() < 1e-14 {
            break;
        }
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Silent, disk_map};

    /// A flat grid of `rows` × `columns` vertices of these sides.
    fn grid(rows: u32, columns: u32, [width, height]: [f64; 2]) -> TriangleMesh {
        let place = |i: u32| {
            let (row, column) = (i / columns, i % columns);
            [
                width * f64::from(column) / f64::from(columns - 1),
                height * f64::from(row) / f64::from(rows - 1),
                0.0,
            ]
        };
        let vertices: Vec<[f64; 3]> = (0..rows * columns).map(place).collect();
        let cells = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| row * columns + column));
        let faces: Vec<[u32; 3]> =
            cells.flat_map(|a| [[a, a + 1, a + columns + 1], [a, a + columns + 1, a + columns]]).collect();
        TriangleMesh::new(&vertices, &faces).unwrap()
    }

    fn mapped(mesh: &TriangleMesh, corners: Option<[usize; 4]>, aspect: Option<f64>) -> crate::DiskMap {
        let options =
            DiskMapOptions { boundary: Boundary::Rectangle, corners, aspect, ..DiskMapOptions::default() };
        disk_map(mesh, &options, &mut Silent).unwrap()
    }

    #[test]
    fn a_flat_rectangle_is_mapped_by_a_similarity() {
        let mesh = grid(7, 12, [3.0, 2.0]);
        let map = mapped(&mesh, None, None);
        assert!(map.distortion.area_ratio_std < 1e-9 && map.distortion.angle_distortion_max < 1.0 + 1e-9);
        assert_eq!([map.uv[0], map.uv[11][..].try_into().unwrap()], [[0.0, 0.0], [1.0, 0.0]]);
        assert!((map.uv[83][1] - 2.0 / 3.0).abs() < 1e-9);
    }

    #[test]
    fn given_corners_and_aspect_are_kept_and_vertices_slide_on_their_sides() {
        let mesh = grid(7, 7, [1.0, 1.0]);
        // a quarter turn, and half as high as wide
        let map = mapped(&mesh, Some([6, 48, 42, 0]), Some(2.0));
        let expected = [(6, [0.0, 0.0]), (48, [1.0, 0.0]), (42, [1.0, 0.5]), (0, [0.0, 0.5])];
        expected.iter().for_each(|&(v, x): &(usize, [f64; 2])| assert_eq!(map.uv[v], x));
        (0..7).for_each(|k| assert_eq!(map.uv[6 + 7 * k][1], 0.0));
        assert!(map.distortion.folded.is_empty());
    }

    #[test]
    fn the_best_stretch_makes_the_angle_energy_stationary() {
        let mesh = grid(4, 4, [1.0, 1.0]);
        let energy = AuthalicEnergy::new(&mesh, mesh.face_areas().to_vec(), Codomain::Plane, 0.0);
        let map: SpatialMap = mesh
            .points()
            .iter()
            .map(|p| Vector3([2.0 * p[0] + 0.3 * p[1], p[1] - 0.1 * p[0] * p[1], 1.0]))
            .collect();
        let t = best_stretch(&energy, &map);
        let angle = |t: f64| {
            let stretched: SpatialMap =
                map.iter().map(|x| Vector3([x[0] * t.exp(), x[1] / t.exp(), 1.0])).collect();
            energy.sums(&energy.costs(&stretched)).angle_energy
        };
        assert!(angle(t) < angle(t + 1e-3).min(angle(t - 1e-3)));
        assert!((t + 0.5 * 2f64.ln()).abs() < 0.1);
    }

    #[test]
    fn corners_that_press_a_face_flat_or_run_backwards_are_refused() {
        let mesh = grid(4, 4, [1.0, 1.0]);
        let refused = |corners: [usize; 4]| {
            let options = DiskMapOptions {
                boundary: Boundary::Rectangle,
                corners: Some(corners),
                ..DiskMapOptions::default()
            };
            disk_map(&mesh, &options, &mut Silent).unwrap_err().to_string()
        };
        // 3 and 12 are the only corners of a face each
        assert!(refused([0, 2, 15, 12]).contains("2 vertices (2, 7): an edge inside the surface joins them"));
        assert!(refused([0, 12, 15, 3]).contains("clockwise"));
        assert!(refused([0, 15, 3, 12]).contains("order"));
        assert!(refused([0, 3, 3, 12]).contains("different"));
        assert!(refused([0, 3, 15, 5]).contains("longest boundary loop"));
    }
}
