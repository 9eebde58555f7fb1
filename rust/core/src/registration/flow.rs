// SPDX-License-Identifier: MIT OR Apache-2.0
//! A smooth flow of the whole domain that carries landmarks to given places and preserves areas.
//!
//! Each landmark moves straight to its place, on the sphere along the shortest arc, and the [`Field`] through these
//! velocities moves everything else. A flow along smooth fields is one-to-one, and as they are free of divergence it
//! changes no area; so a map that folds nothing stays nearly as good as it was, up to what its faces are too coarse to
//! follow.
//!
//! Input: a map, landmark vertices and their places. Cost: four velocities per step and vertex, each a sum over the k
//! landmarks, and three systems of 2k unknowns.

mod field;

use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

use super::landmarks::Domain;
use crate::control::Watch;
use crate::energy::motion::Motion;
use crate::mesh::geometry::{Vector, add, cross, distance, dot, norm, scaled, sub};
use crate::parallel;
use field::Field;

/// A landmark this close to its place has arrived.
const ARRIVED: f64 = 1e-9;
/// Nothing moves farther in one step.
const LONGEST_MOVE: f64 = 0.1;
/// No two landmarks move relative to each other by more than this share of their distance in one step.
const LARGEST_STRAIN: f64 = 0.25;
/// Steps after which the flow ends wherever it is.
const MOST_STEPS: usize = 120;
/// How often a step that the caller does not accept is halved.
const HALVINGS: usize = 6;
/// Points at most this far from the circle, in squared distance from the centre, lie on it.
const ON_CIRCLE: f64 = 1e-12;
/// Vertices between two questions whether to go on.
const BREATH: usize = 512;

/// Carries the `landmarks`, vertices of `map`, towards their `places`, and all other vertices along.
///
/// Returns the last map that `accepts`, the landmarks as near to their places as it came; the very map given where they
/// are there already.
pub(super) fn flow(
    domain: Domain,
    map: Vec<Vector>,
    landmarks: &[u32],
    places: &[Vector],
    accepts: &dyn Fn(&[Vector]) -> bool,
    watch: &Watch<'_>,
) -> Vec<Vector> {
    let mut map = map;
    for steps_left in (1..=MOST_STEPS).rev() {
        // 1. Where the landmarks are and how far they have to go
        let now: Vec<Vector> = landmarks.iter().map(|&vertex| map[vertex as usize]).collect();
        let ways: Vec<Vector> = now.iter().zip(places).map(|(&x, &place)| domain.way(x, place)).collect();
        if ways.iter().all(|&way| norm(way) <= ARRIVED) || !watch.goes_on() {
            break;
        }
        // 2. The velocities that would take them there in a unit of time, and the part of that for this step
        let Some(velocities) = domain.velocities(&map, &now, &ways, watch) else { break };
        let share = 1.0 / steps_needed(&now, &ways, &velocities).clamp(1.0, steps_left as f64);
        // 3. The longest step that the caller accepts
        let step = |share| domain.step(&map, &velocities, &now, &ways, share, watch);
        let shares = (0..=HALVINGS).map(|halvings| share * 0.5f64.powi(halvings as i32));
        let accepted = shares.map_while(step).find(|moved| accepts(moved));
        match accepted {
            Some(moved) => map = moved,
            None => break,
        }
    }
    map
}

/// Into how many steps the way from here has to be cut.
fn steps_needed(now: &[Vector], ways: &[Vector], velocities: &[Vector]) -> f64 {
    let fastest = velocities.iter().fold(0.0, |fastest, &v| f64::max(fastest, norm(v)));
    let pairs = (0..now.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let strain = pairs.fold(0.0, |most, (i, j)| {
        f64::max(most, distance(ways[i], ways[j]) / distance(now[i], now[j]).max(ARRIVED))
    });
    (fastest / LONGEST_MOVE).max(strain / LARGEST_STRAIN).ceil()
}

impl Domain {
    /// How a vertex may move that is not on the circle.
    fn motion(self) -> Motion {
        match self {
            Self::Disk => Motion::Plane,
            Self::Sphere => Motion::Sphere,
        }
    }

    /// How far the velocity of a landmark is felt: as far as keeps angles best, by measurement.
    fn reach(self) -> f64 {
        match self {
            Self::Disk => 0.6,
            Self::Sphere => 1.0,
        }
    }

    /// The velocity at `from` that leads straight to `to` in a unit of time.
    fn way(self, from: Vector, to: Vector) -> Vector {
        if self == Self::Disk {
            return [to[0] - from[0], to[1] - from[1], 0.0];
        }
        let angle = norm(cross(from, to)).atan2(dot(from, to));
        let along = sub(to, scaled(from, dot(from, to)));
        match norm(along) {
            0.0 if angle == 0.0 => [0.0; 3],
            // all ways to the opposite point are equally long
            length if length < ARRIVED && angle > 1.0 => scaled(self.motion().frame(from).axes[0], PI),
            length => scaled(along, angle / length),
        }
    }

    /// The point and the velocity on the straight path from `x` with velocity `way` at time `t`.
    fn on_path(self, x: Vector, way: Vector, t: f64) -> (Vector, Vector) {
        let speed = norm(way);
        if self == Self::Disk || speed == 0.0 {
            return (add(x, scaled(way, t)), way);
        }
        let (sine, cosine) = (t * speed).sin_cos();
        let point = add(scaled(x, cosine), scaled(way, sine / speed));
        (point, sub(scaled(way, cosine), scaled(x, speed * sine)))
    }

    /// The field through landmarks at time `t` of their paths.
    fn field(self, now: &[Vector], ways: &[Vector], t: f64) -> Option<Field> {
        let (places, velocities): (Vec<_>, Vec<_>) =
            now.iter().zip(ways).map(|(&x, &way)| self.on_path(x, way, t)).unzip();
        Field::through(self, self.reach(), &places, &velocities)
    }

    /// The velocity of every vertex; `None` where cancelled or where landmarks are too close to each other.
    fn velocities(
        self,
        map: &[Vector],
        now: &[Vector],
        ways: &[Vector],
        watch: &Watch<'_>,
    ) -> Option<Vec<Vector>> {
        let field = self.field(now, ways, 0.0)?;
        for_all(map.len(), watch, |vertex| field.velocity(map[vertex]))
    }

    /// One step of the classical Runge–Kutta method over the first `share` of the landmarks' ways.
    fn step(
        self,
        map: &[Vector],
        velocities: &[Vector],
        now: &[Vector],
        ways: &[Vector],
        share: f64,
        watch: &Watch<'_>,
    ) -> Option<Vec<Vector>> {
        let halfway = self.field(now, ways, 0.5 * share)?;
        let end = self.field(now, ways, share)?;
        for_all(map.len(), watch, |vertex| {
            let (x, first) = (map[vertex], velocities[vertex]);
            let second = halfway.velocity(add(x, scaled(first, 0.5 * share)));
            let third = halfway.velocity(add(x, scaled(second, 0.5 * share)));
            let fourth = end.velocity(add(x, scaled(third, share)));
            let mean = [0, 1, 2].map(|k| (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]) / 6.0);
            self.settled(x, add(x, scaled(mean, share)))
        })
    }

    /// A moved point back on the domain: on the sphere, or on the circle if it was there.
    fn settled(self, before: Vector, moved: Vector) -> Vector {
        match self {
            Self::Sphere => scaled(moved, 1.0 / norm(moved)),
            Self::Disk if (1.0 - before[0] * before[0] - before[1] * before[1]).abs() > ON_CIRCLE => {
                [moved[0], moved[1], 1.0]
            }
            Self::Disk => {
                let radius = (moved[0] * moved[0] + moved[1] * moved[1]).sqrt();
                [moved[0] / radius, moved[1] / radius, 1.0]
            }
        }
    }
}

/// The vectors `value(0), …, value(n − 1)`; `None` where cancelled.
fn for_all(
    n: usize,
    watch: &Watch<'_>,
    value: impl Fn(usize) -> Vector + Sync + Send,
) -> Option<Vec<Vector>> {
    let cancelled = AtomicBool::new(false);
    let values = parallel::map(n, |i| {
        if i % BREATH == 0 && !watch.goes_on() {
            cancelled.store(true, Ordering::Relaxed);
        }
        if cancelled.load(Ordering::Relaxed) { [0.0; 3] } else { value(i) }
    });
    (!cancelled.into_inner()).then_some(values)
}

#[cfg(test)]
mod tests;
