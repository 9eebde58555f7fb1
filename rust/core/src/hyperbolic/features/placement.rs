// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rough places of both surfaces on the unit sphere, the source laid over the target by the curves.
//!
//! Nearly conformal maps take both to the sphere, boundary loops filled; then a rotation brings points of equal
//! parameter on paired curves together. Closed curves have no common start: the best start and the rotation are
//! found in turns. An open curve that clearly runs the other way on the target is reported, and laid over its
//! partner reversed. Among rotations that the curves leave open, the surfaces take the one nearest to their
//! positions in space.
//!
//! Input: two surfaces divided along their closed curves. Cost: two sparse Cholesky factorizations.

use super::curves::CurvePair;
use super::parameters::{on_sphere, shares, unit};
use super::regions::Divided;
use crate::alignment::rotation::{best_rotation, centroid, rotate};
use crate::control::Watch;
use crate::disk::closed;
use crate::error::{Elements, Error, MapError};
use crate::mesh::ties::{first_largest, smallest_first};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::sphere::rough_conformal;
use crate::vector::Vector3;

/// Least distance of a closed curve's middle from the center of the sphere at which it gives a direction.
const LEAST_MIDDLE: f64 = 0.1;
/// Points compared on an open curve.
const OPEN_SAMPLES: usize = 64;
/// Points compared on a closed curve, and starts tried between vertices.
const CLOSED_SAMPLES: usize = 256;
/// Most vertices tried as starts.
const MOST_STARTS: usize = 1024;
/// Rounds of finding starts and rotation in turns.
const ROUNDS: usize = 4;
/// Weight, against that of a curve, of the wish to rotate as little as possible.
const LEAST_TURN: f64 = 1e-9;
/// Factor between two residuals at which the smaller fits clearly better.
const CLEARLY: f64 = 0.5;
/// Residual up to which nothing else fits clearly better.
const NEXT_TO_NOTHING: f64 = 0.1;
/// Least number of curves that tell a direction, and of open curves that tell a mirrored surface.
const FEWEST: usize = 3;

/// A rotation, by rows.
type Rotation = [Vector3; 3];

/// Both surfaces on the unit sphere.
#[derive(Debug, Clone)]
pub(crate) struct Placement {
    /// (n, 3): the source's vertices, rotated over the target's.
    pub source: Vec<Vector3>,
    /// (m, 3): the target's vertices.
    pub target: Vec<Vector3>,
    /// Paired boundary loops that are no curves.
    pub loops: Vec<CurvePair>,
    /// For each curve, then each pair of `loops`: the share of the target's length from its first vertex to the
    /// place of the source's first vertex; 0 for an open curve.
    pub shifts: Vec<f64>,
    /// Whether the source fits clearly better mirrored.
    pub mirrored: bool,
    /// The open curves that fit clearly better when one is run through the other way.
    pub backwards: Vec<usize>,
}

/// Points of equal parameter on a pair of curves.
struct Samples {
    source: Vec<Vector3>,
    target: Vec<Vector3>,
    closed: bool,
    /// The target's curve by its vertices.
    line: Line,
    /// The share of the target's length by which its start lies ahead.
    shift: f64,
    /// Whether an open curve fits clearly better reversed.
    backwards: bool,
}

/// Places two surfaces on the sphere, by `spheres` (source, target) if given.
///
/// # Errors
/// [`Error::InvalidArray`] and [`MapError::NoDirection`] if `spheres` are no positions,
/// [`NumericsError::FactorizationFailed`](crate::NumericsError::FactorizationFailed) if slivers spoil a conformal
/// map, [`Error::CancelledEarly`] if cancelled.
pub(crate) fn placed(
    meshes: [&TriangleMesh; 2],
    divided: &Divided,
    spheres: Option<[&[Vector3]; 2]>,
    watch: &Watch<'_>,
) -> Result<Placement, Error> {
    // 1. Each surface by itself
    let [source, target] = match spheres {
        Some([source, target]) => {
            [normalized(meshes[0], "source_sphere", source)?, normalized(meshes[1], "target_sphere", target)?]
        }
        None => {
            let of_curves = |of: fn(&CurvePair) -> &Vec<Vertex>| -> Vec<Vertex> {
                divided.pairs.iter().flat_map(of).copied().collect()
            };
            let [ours, theirs] = [of_curves(|pair| &pair.source), of_curves(|pair| &pair.target)];
            [upright(meshes[0], &ours, watch)?, upright(meshes[1], &theirs, watch)?]
        }
    };
    // 2. A rotation without starts, then starts and rotation in turns
    let of_pair = |pair: &CurvePair| Samples::new(pair, meshes, [&source, &target]);
    let curves: Vec<Samples> = divided.pairs.iter().map(of_pair).collect();
    let mut rotation = first_rotation(&curves);
    let loops = paired_loops(meshes, divided, [&source, &target], rotation);
    let mut samples = curves;
    samples.extend(loops.iter().map(of_pair));
    for _ in 0..ROUNDS {
        samples.iter_mut().filter(|samples| samples.closed).for_each(|samples| samples.find_shift(rotation));
        if samples.len() >= FEWEST {
            let open = samples.iter_mut().filter(|samples| !samples.closed);
            open.for_each(|samples| samples.find_direction(rotation));
        }
        rotation = rotation_over(samples.iter().flat_map(Samples::pairs));
    }
    // 3. Reversed curves and mirrored surfaces
    let backwards = (0..samples.len()).filter(|&curve| samples[curve].backwards).collect();
    let source = parallel::map(source.len(), |vertex| unit(rotate(rotation, source[vertex])));
    let shifts = samples.iter().map(|samples| samples.shift).collect();
    let mirrored = fits_mirrored(&mut samples);
    Ok(Placement { source, target, loops, shifts, mirrored, backwards })
}

/// Given positions on the unit sphere.
fn normalized(mesh: &TriangleMesh, name: &'static str, given: &[Vector3]) -> Result<Vec<Vector3>, Error> {
    if given.len() != mesh.n_vertices() {
        let expected = format!("of shape ({}, 3), one place for each vertex", mesh.n_vertices());
        return Err(Error::InvalidArray { name, found: format!("of shape ({}, 3)", given.len()), expected });
    }
    let is_bad = |vertex: &usize| !(given[*vertex].norm() > 0.0 && given[*vertex].norm().is_finite());
    match Elements::collect((0..given.len()).filter(is_bad)) {
        None => Ok(given.iter().map(|&x| unit(x)).collect()),
        Some(vertices) => Err(MapError::NoDirection { name, vertices }.into()),
    }
}

/// The nearly conformal map of a surface, holes filled, rotated to its directions in space; the vertices of its `curves`
/// tell the sides of a symmetric surface apart.
fn upright(mesh: &TriangleMesh, curves: &[Vertex], watch: &Watch<'_>) -> Result<Vec<Vector3>, Error> {
    let whole = closed(mesh)?;
    let weights = whole.vertex_shares(whole.face_areas());
    let mut map = rough_conformal(&whole, &weights, curves, watch)?;
    map.truncate(mesh.n_vertices());
    let weights = mesh.vertex_shares(mesh.face_areas());
    let center = centroid(mesh.points(), &weights);
    let directions = parallel::map(map.len(), |vertex| mesh.points()[vertex] - center);
    let rotation = best_rotation(&map, &directions, &weights);
    Ok(parallel::map(map.len(), |vertex| unit(rotate(rotation, map[vertex]))))
}

impl Samples {
    fn new(pair: &CurvePair, meshes: [&TriangleMesh; 2], spheres: [&[Vector3]; 2]) -> Self {
        let line = |side: usize| {
            let vertices = [&pair.source, &pair.target][side];
            Line::new(vertices, pair.closed, meshes[side].points(), spheres[side])
        };
        let (source, target) = (line(0), line(1));
        Self {
            source: source.samples(pair.closed, 0.0),
            target: target.samples(pair.closed, 0.0),
            line: target,
            closed: pair.closed,
            shift: 0.0,
            backwards: false,
        }
    }

    /// Corresponding points with their weights; all curves weigh the same.
    fn pairs(&self) -> impl Iterator<Item = (Vector3, Vector3, f64)> {
        let n = self.source.len();
        let partner = move |k: usize| if self.backwards { n - 1 - k } else { k };
        (0..n).map(move |k| (self.source[k], self.target[partner(k)], 1.0 / n as f64))
    }

    /// The root mean square distance of the points after a rotation.
    fn residual(&self, rotation: Rotation) -> f64 {
        residual(&self.pairs().collect::<Vec<_>>(), rotation)
    }

    /// Decides whether an open curve fits clearly better reversed.
    fn find_direction(&mut self, rotation: Rotation) {
        let [given, turned] = [false, true].map(|backwards| {
            self.backwards = backwards;
            self.residual(rotation)
        });
        self.backwards = is_clearly_better(turned, given);
    }

    /// Finds the start of the target's curve that brings it nearest to the source's, rotated.
    fn find_shift(&mut self, rotation: Rotation) {
        let n = self.source.len();
        let turned: Vec<Vector3> = self.source.iter().map(|&x| rotate(rotation, x)).collect();
        // vertices, so that equal curves fit exactly, and places between them
        let vertices = &self.line.parameters[..self.line.parameters.len() - 1];
        let few = vertices.iter().step_by(vertices.len().div_ceil(MOST_STARTS)).copied();
        let shifts: Vec<f64> = few.chain((0..n).map(|k| k as f64 / n as f64)).collect();
        let fit = |shift: usize| -> f64 {
            let target = self.line.samples(true, shifts[shift]);
            turned.iter().zip(target).map(|(&x, y)| x.dot(y)).sum()
        };
        let fits = parallel::map(shifts.len(), fit);
        self.shift = shifts[first_largest(&fits).unwrap_or(0)];
        self.target = self.line.samples(true, self.shift);
    }

    /// The middles of both curves.
    fn middles(&self) -> [Vector3; 2] {
        [middle(&self.source), middle(&self.target)]
    }
}

fn middle(points: &[Vector3]) -> Vector3 {
    points.iter().fold(Vector3::ZERO, |sum, &x| sum + x) * (1.0 / points.len() as f64)
}

/// A curve on the sphere by shares of its length in space.
struct Line {
    /// The vertices; a closed curve repeats the first at the end.
    places: Vec<Vector3>,
    parameters: Vec<f64>,
}

impl Line {
    fn new(vertices: &[Vertex], closed: bool, points: &[Vector3], sphere: &[Vector3]) -> Self {
        let all = || vertices.iter().chain(if closed { &vertices[..1] } else { &[] });
        let parameters = shares(all().map(|&v| points[v]));
        Self { places: all().map(|&v| sphere[v]).collect(), parameters }
    }

    /// Points at equal distances, from parameter `shift` on for a closed curve.
    fn samples(&self, closed: bool, shift: f64) -> Vec<Vector3> {
        let point = |s: f64| on_sphere(&self.places, &self.parameters, s);
        if closed {
            (0..CLOSED_SAMPLES).map(|k| point((k as f64 / CLOSED_SAMPLES as f64 + shift).fract())).collect()
        } else {
            (0..OPEN_SAMPLES).map(|k| point(k as f64 / (OPEN_SAMPLES - 1) as f64)).collect()
        }
    }
}

/// The rotation that brings the first point of each pair nearest to the second; the least of equals.
fn rotation_over(pairs: impl Iterator<Item = (Vector3, Vector3, f64)>) -> Rotation {
    let axes = [0, 1, 2].map(Vector3::unit);
    let (mut from, mut to, mut weights) = (axes.to_vec(), axes.to_vec(), vec![LEAST_TURN; 3]);
    for (x, y, weight) in pairs {
        from.push(x);
        to.push(y);
        weights.push(weight);
    }
    best_rotation(&from, &to, &weights)
}

/// The rotation by open curves and the middles of closed curves.
fn first_rotation(curves: &[Samples]) -> Rotation {
    let middles = curves.iter().filter(|samples| samples.closed).map(|samples| {
        let [ours, theirs] = samples.middles();
        // the middle of a great circle gives no direction
        let weight = if ours.norm().min(theirs.norm()) > LEAST_MIDDLE { 1.0 } else { 0.0 };
        (ours, theirs, weight)
    });
    let open = curves.iter().filter(|samples| !samples.closed).flat_map(Samples::pairs);
    rotation_over(open.chain(middles))
}

/// Pairs the boundary loops that are no curves, region by region, the nearest first.
fn paired_loops(
    meshes: [&TriangleMesh; 2],
    divided: &Divided,
    spheres: [&[Vector3]; 2],
    rotation: Rotation,
) -> Vec<CurvePair> {
    let center = |side: usize, number: usize| {
        let vertices = &meshes[side].boundary_loops()[number];
        unit(middle(&Line::new(vertices, true, meshes[side].points(), spheres[side]).samples(true, 0.0)))
    };
    let ours = divided
        .source
        .loops
        .iter()
        .map(|&(number, region)| (number, divided.partner[region], rotate(rotation, center(0, number))));
    let ours: Vec<_> = ours.collect();
    let theirs = divided.target.loops.iter().map(|&(number, region)| (number, region, center(1, number)));
    let theirs: Vec<_> = theirs.collect();
    // 1. All pairs, the nearest first
    let mut all = Vec::new();
    for (i, &(_, region, x)) in ours.iter().enumerate() {
        let same = theirs.iter().enumerate().filter(|(_, their)| their.1 == region);
        all.extend(same.map(|(j, their)| (x.distance(their.2), i, j)));
    }
    let distances: Vec<f64> = all.iter().map(|(distance, ..)| *distance).collect();
    // 2. Each loop once
    let (mut partner, mut is_taken) = (vec![None; ours.len()], vec![false; theirs.len()]);
    for (_, i, j) in smallest_first(&distances).into_iter().map(|k| all[k]) {
        if partner[i].is_none() && !is_taken[j] {
            (partner[i], is_taken[j]) = (Some(j), true);
        }
    }
    let loops = |i: usize, j: usize| CurvePair {
        source: meshes[0].boundary_loops()[ours[i].0].clone(),
        target: meshes[1].boundary_loops()[theirs[j].0].clone(),
        closed: true,
        on_boundary: true,
        gap: None,
    };
    partner.iter().enumerate().filter_map(|(i, j)| j.map(|j| loops(i, j))).collect()
}

/// The root mean square distance after a rotation.
fn residual(pairs: &[(Vector3, Vector3, f64)], rotation: Rotation) -> f64 {
    let total: f64 = pairs.iter().map(|(_, _, weight)| weight).sum();
    let square = |&(x, y, weight): &(Vector3, Vector3, f64)| weight * rotate(rotation, x).distance(y).powi(2);
    (pairs.iter().map(square).sum::<f64>() / total).sqrt()
}

fn is_clearly_better(better: f64, than: f64) -> bool {
    than > NEXT_TO_NOTHING && better < CLEARLY * than
}

/// Whether open curves fit clearly better after a reflection of the source.
fn fits_mirrored(samples: &mut [Samples]) -> bool {
    samples.iter_mut().for_each(|samples| samples.backwards = false);
    let open = || samples.iter().filter(|samples| !samples.closed);
    if open().count() < FEWEST {
        return false;
    }
    let given: Vec<_> = open().flat_map(Samples::pairs).collect();
    let mirrored: Vec<_> =
        given.iter().map(|&(Vector3([x, y, z]), to, weight)| (Vector3([x, y, -z]), to, weight)).collect();
    let best = |pairs: &[(Vector3, Vector3, f64)]| residual(pairs, rotation_over(pairs.iter().copied()));
    is_clearly_better(best(&mirrored), best(&given))
}

#[cfg(test)]
mod tests;
