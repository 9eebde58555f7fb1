// SPDX-License-Identifier: MIT OR Apache-2.0
//! A smooth flow of the whole domain that carries landmarks to given places and changes no area.
//!
//! Each landmark moves straight to its place, on the sphere along the shortest arc, but around landmarks that it would
//! run into, so that two can change places. The [`Field`] with these velocities moves everything else. A flow along
//! smooth fields is one-to-one, and preserves areas since the fields are free of divergence; so a map without folds
//! stays nearly as good as it was, except where its faces are too coarse to follow.
//!
//! Input: a map, landmark vertices and their places. Cost: four velocities per step and vertex, each a sum over the k
//! landmarks, and three systems of 2k unknowns.

mod field;

use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::codomain::CanonicalDomain;
use crate::control::Watch;
use crate::mesh::Vertex;
use crate::parallel;
use crate::vector::Vector3;
use field::Field;

/// Distance to its place at which a landmark has arrived.
const ARRIVED: f64 = 1e-9;
/// Longest move of a vertex in one step.
const LONGEST_MOVE: f64 = 0.1;
/// Longest relative move of two landmarks in one step, relative to their distance.
const LARGEST_STRAIN: f64 = 0.25;
/// Steps after which the flow ends wherever it is.
const MOST_STEPS: usize = 120;
/// Two landmarks collide if their straight ways bring them nearer than this part of their distance before or after.
const COLLISION: f64 = 0.3;
/// Angle by which colliding landmarks turn aside, all to the same side, so that they go around each other.
const ASIDE: f64 = PI / 3.0;
/// Most halvings of a step that the caller does not accept.
const HALVINGS: usize = 6;
/// Largest deviation of the squared distance from the center from 1 at which a point lies on the circle.
const ON_CIRCLE: f64 = 1e-12;
/// Vertices between two checks for cancellation.
const BREATH: usize = 512;

/// Carries the `landmarks`, vertices of `map`, toward their `places`, and all other vertices along.
///
/// `mended` removes the folds that coarse faces of a moved map may have, or returns `None` if there are too many.
/// Returns the last accepted map; the map given, unchanged, if the landmarks are at their places already.
pub(super) fn flow(
    domain: CanonicalDomain,
    map: Vec<Vector3>,
    landmarks: &[Vertex],
    places: &[Vector3],
    mended: &dyn Fn(Vec<Vector3>) -> Option<Vec<Vector3>>,
    watch: &Watch<'_>,
) -> Vec<Vector3> {
    let mut map = map;
    for steps_left in (1..=MOST_STEPS).rev() {
        // 1. The paths that the landmarks still have to go
        let paths = Paths::new(domain, &map, landmarks, places);
        if paths.ways.iter().all(|&way| way.norm() <= ARRIVED) || !watch.goes_on() {
            break;
        }
        // 2. The velocities that take them there in a unit of time, and the share of it for this step
        let Some(velocities) = paths.velocities(&map, watch) else { break };
        let share = 1.0 / paths.steps_needed(&velocities).clamp(1.0, steps_left as f64);
        // 3. The longest step that the caller accepts
        let step = |share| paths.step(&map, &velocities, share, watch);
        let shares = (0..=HALVINGS).map(|halvings| share * 0.5f64.powi(halvings as i32));
        let accepted = shares.map_while(step).find_map(mended);
        match accepted {
            Some(moved) => map = moved,
            None => break,
        }
    }
    map
}

/// The ways of all landmarks from their present places, each in a unit of time.
struct Paths {
    domain: CanonicalDomain,
    now: Vec<Vector3>,
    ways: Vec<Vector3>,
}

impl Paths {
    fn new(domain: CanonicalDomain, map: &[Vector3], landmarks: &[Vertex], places: &[Vector3]) -> Self {
        let now: Vec<Vector3> = landmarks.iter().map(|&vertex| map[vertex]).collect();
        let ways: Vec<Vector3> = now.iter().zip(places).map(|(&x, &place)| domain.way(x, place)).collect();
        let collides =
            |i: usize| (0..now.len()).any(|j| j != i && collide([now[i], now[j]], [ways[i], ways[j]]));
        let around = |i: usize| if collides(i) { domain.aside(now[i], ways[i]) } else { ways[i] };
        let ways = (0..now.len()).map(around).collect();
        Self { domain, now, ways }
    }

    /// The number of steps that the remaining ways take.
    fn steps_needed(&self, velocities: &[Vector3]) -> f64 {
        let Self { now, ways, .. } = self;
        let fastest = velocities.iter().fold(0.0, |fastest, &v| f64::max(fastest, v.norm()));
        let pairs = (0..now.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let strain = pairs.fold(0.0, |most, (i, j)| {
            f64::max(most, ways[i].distance(ways[j]) / now[i].distance(now[j]).max(ARRIVED))
        });
        (fastest / LONGEST_MOVE).max(strain / LARGEST_STRAIN).ceil()
    }

    /// The field through the landmarks at time `t` of their paths.
    fn field(&self, t: f64) -> Option<Field> {
        let on_path = |(&x, &way)| self.domain.on_path(x, way, t);
        let (places, velocities): (Vec<_>, Vec<_>) = self.now.iter().zip(&self.ways).map(on_path).unzip();
        Field::through(self.domain, self.domain.reach(), &places, &velocities)
    }

    /// The velocity of every vertex; `None` if cancelled or if landmarks are too close to each other.
    fn velocities(&self, map: &[Vector3], watch: &Watch<'_>) -> Option<Vec<Vector3>> {
        let field = self.field(0.0)?;
        for_all(map.len(), watch, |vertex| field.velocity(map[vertex]))
    }

    /// One step of the classical Runge–Kutta method over the first `share` of the landmarks' ways.
    fn step(
        &self,
        map: &[Vector3],
        velocities: &[Vector3],
        share: f64,
        watch: &Watch<'_>,
    ) -> Option<Vec<Vector3>> {
        let halfway = self.field(0.5 * share)?;
        let end = self.field(share)?;
        for_all(map.len(), watch, |vertex| {
            let (x, first) = (map[vertex], velocities[vertex]);
            let second = halfway.velocity(x + first * (0.5 * share));
            let third = halfway.velocity(x + second * (0.5 * share));
            let fourth = end.velocity(x + third * share);
            let sum = first + (second + third) * 2.0 + fourth;
            self.domain.settled(x, x + sum.map(|x| x / 6.0) * share)
        })
    }
}

/// Whether two points run into each other on their straight ways.
fn collide([x, y]: [Vector3; 2], [x_way, y_way]: [Vector3; 2]) -> bool {
    let (apart, drift) = (x - y, x_way - y_way);
    let when = (-apart.dot(drift) / drift.dot(drift).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let nearest = (apart + drift * when).norm();
    nearest < COLLISION * apart.norm().min((apart + drift).norm())
}

impl CanonicalDomain {
    /// A velocity at `x` turned aside by [`ASIDE`].
    fn aside(self, x: Vector3, way: Vector3) -> Vector3 {
        let normal = if self == Self::Disk { Vector3::unit(2) } else { x };
        way * ASIDE.cos() + normal.cross(way) * ASIDE.sin()
    }

    /// The length scale of the field around a landmark; measured to distort angles least.
    fn reach(self) -> f64 {
        match self {
            Self::Disk => 0.6,
            Self::Sphere => 1.0,
        }
    }

    /// The velocity at `from` that leads straight to `to` in a unit of time.
    fn way(self, from: Vector3, to: Vector3) -> Vector3 {
        if self == Self::Disk {
            return Vector3([to[0] - from[0], to[1] - from[1], 0.0]);
        }
        let angle = from.cross(to).norm().atan2(from.dot(to));
        let along = to - from * from.dot(to);
        match along.norm() {
            0.0 if angle == 0.0 => Vector3::ZERO,
            // all ways to the opposite point are equally long
            length if length < ARRIVED && angle > 1.0 => self.motion(false).frame(from).axes[0] * PI,
            length => along * (angle / length),
        }
    }

    /// The point and the velocity on the straight path from `x` with velocity `way` at time `t`.
    fn on_path(self, x: Vector3, way: Vector3, t: f64) -> (Vector3, Vector3) {
        let speed = way.norm();
        if self == Self::Disk || speed == 0.0 {
            return (x + way * t, way);
        }
        let (sine, cosine) = (t * speed).sin_cos();
        let point = x * cosine + way * (sine / speed);
        (point, way * cosine - x * (speed * sine))
    }

    /// A moved point back on the domain: on the sphere, or on the circle if it was on it before.
    fn settled(self, before: Vector3, moved: Vector3) -> Vector3 {
        match self {
            Self::Sphere => moved.normalized(),
            Self::Disk if (1.0 - before[0] * before[0] - before[1] * before[1]).abs() > ON_CIRCLE => {
                Vector3([moved[0], moved[1], 1.0])
            }
            Self::Disk => {
                let radius = (moved[0] * moved[0] + moved[1] * moved[1]).sqrt();
                Vector3([moved[0] / radius, moved[1] / radius, 1.0])
            }
        }
    }
}

/// The vectors `value(0), …, value(n − 1)`; `None` if cancelled.
fn for_all(
    n: usize,
    watch: &Watch<'_>,
    value: impl Fn(usize) -> Vector3 + Sync + Send,
) -> Option<Vec<Vector3>> {
    let cancelled = AtomicBool::new(false);
    let values = parallel::map(n, |i| {
        if i % BREATH == 0 && !watch.goes_on() {
            cancelled.store(true, Ordering::Relaxed);
        }
        if cancelled.load(Ordering::Relaxed) { Vector3::ZERO } else { value(i) }
    });
    (!cancelled.into_inner()).then_some(values)
}

#[cfg(test)]
mod tests;
