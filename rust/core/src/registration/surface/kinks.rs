// SPDX-License-Identifier: MIT OR Apache-2.0
//! Edges and vertices of the target are kinks of the energy: where a vertex of the source lies on one, each face beside it
//! has a slope of its own.
//!
//! A vertex that lowers the energy in no direction stays on its edge and moves along it, or at its vertex and does not
//! move; else it goes into the face where the energy falls most steeply. A vertex that would return into the face that
//! it came from stops on the edge between, so that Newton's steps do not go to and fro over a kink forever.
//!
//! Cost: two energies of a star for each vertex on an edge, and some six for one at a vertex.

use super::energy::SurfaceEnergy;
use super::target::Placed;
use crate::location::Location;
use crate::mesh::{Corner, Vertex};
use crate::vector::Vector3;

/// How a vertex goes on from its place.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Course {
    /// Its place, seen from the face that it goes into.
    pub location: Location,
    /// The directions in which it moves; those in which it does not are 0.
    pub frame: [Vector3; 2],
    /// The edge that it moves along, as the corner opposite to it.
    pub edge: Option<Corner>,
}

/// A direction out of a kink, with the slope of the energy.
struct Way {
    course: Course,
    slope: f64,
}

impl SurfaceEnergy<'_> {
    /// How a vertex goes on that is free to move.
    pub(super) fn course(&self, map: &[Placed], vertex: Vertex) -> Course {
        let location = map[vertex].location;
        let at_edge = |edge| self.course_at_edge(map, vertex, location.triangle.corner(edge));
        match location.barycentric.map(|coordinate| coordinate == 0.0) {
            [false, false, false] => self.course_in_face(location),
            [true, false, false] => at_edge(0),
            [false, true, false] => at_edge(1),
            [false, false, true] => at_edge(2),
            _ => self.course_at_vertex(map, vertex),
        }
    }

    /// Freely over the face.
    fn course_in_face(&self, location: Location) -> Course {
        Course { location, frame: self.target.frame(location.triangle), edge: None }
    }

    /// Along an edge.
    fn course_along(&self, location: Location, edge: Corner) -> Course {
        let [along, _] = self.target.edge_frame(edge);
        Course { location, frame: [along, Vector3::ZERO], edge: Some(edge) }
    }

    /// Into the face on one of the sides of an edge, or along it.
    fn course_at_edge(&self, map: &[Placed], vertex: Vertex, edge: Corner) -> Course {
        let here = map[vertex].location;
        let across = self.target.mesh().opposite(edge);
        let seen_across = across.map(|across| self.target.seen_from(&here, edge, across));
        let slope =
            |side: Corner, location| self.slopes(map, vertex, location, self.target.edge_frame(side))[1];
        let ours = slope(edge, here);
        let theirs = across.zip(seen_across).map_or(0.0, |(across, location)| slope(across, location));
        match seen_across {
            Some(location) if theirs < 0.0 && theirs < ours => self.course_in_face(location),
            _ if ours < 0.0 => self.course_in_face(here),
            _ => self.course_along(here, edge),
        }
    }

    /// Into a face around a vertex of the target or along an edge there, or nowhere.
    fn course_at_vertex(&self, map: &[Placed], vertex: Vertex) -> Course {
        let here = map[vertex].location;
        let at = (0..3).find(|&k| here.barycentric[k] != 0.0).unwrap_or(0);
        let center = self.target.faces()[here.triangle][at];
        let mut least =
            Way { course: Course { location: here, frame: [Vector3::ZERO; 2], edge: None }, slope: 0.0 };
        for &corner in self.target.mesh().vertex_corners(center) {
            for way in self.ways(map, vertex, corner) {
                if way.slope < least.slope {
                    least = way;
                }
            }
        }
        least.course
    }

    /// The ways from a corner of the target: along its first edge, and down the slope of the face where that lies between
    /// both. The second edge is the first of the next corner, where there is one: which of two sides of an edge a vertex
    /// goes along is not left to rounding.
    fn ways(&self, map: &[Placed], vertex: Vertex, corner: Corner) -> Vec<Way> {
        let location = Location::at_corner(corner);
        // the edge to the next corner is opposite to the one before
        let [first, second] = [corner.next().next(), corner.next()];
        let [along, inward] = self.target.edge_frame(first);
        let [x, y] = self.slopes(map, vertex, location, [along, inward]);
        let course = self.course_along(location, second);
        let other = course.frame[0] * -1.0;
        let mut ways = vec![Way { course: self.course_along(location, first), slope: x }];
        if self.target.mesh().opposite(second).is_none() {
            ways.push(Way { course, slope: x * other.dot(along) + y * other.dot(inward) });
        }
        // the steepest descent lies to the left of the first edge and to the right of the second
        let down = along * -x - inward * y;
        if y < 0.0 && down.cross(other).dot(along.cross(inward)) > 0.0 {
            ways.push(Way { course: self.course_in_face(location), slope: -x.hypot(y) });
        }
        ways
    }

    /// The slopes of the energy if a vertex moved along two vectors in the plane of a face, from a place there.
    fn slopes(&self, map: &[Placed], vertex: Vertex, location: Location, frame: [Vector3; 2]) -> [f64; 2] {
        let placed = self.target.placed(location);
        let mut slopes = self.vertex_expansion(vertex, &placed, &frame).gradient;
        for corner in self.source.vertex_corners(vertex) {
            let face = corner.face();
            let corners = self.source.faces()[face].map(|v| if v == vertex { &placed } else { &map[v] });
            let expansion = self.face_expansion(face.index(), corners, [&frame; 3]);
            let k = 2 * corner.place();
            slopes = [slopes[0] + expansion.gradient[k], slopes[1] + expansion.gradient[k + 1]];
        }
        slopes
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::descend;
    use super::super::energy::Guard;
    use super::super::problem::SurfaceProblem;
    use super::super::sample_maps::{Sample, at_vertex, mesh};
    use super::*;
    use crate::codomain::CanonicalDomain;
    use crate::control::{History, Silent};
    use crate::location::tests::{number, octasphere};

    const GUARD: Guard = Guard { weight: 0.1, slack: 3.0 };

    /// Length of the steps that try a direction.
    const H: f64 = 1e-6;

    /// The energy around a vertex after a short walk from a place.
    fn energy_near(
        energy: &SurfaceEnergy<'_>,
        map: &[Placed],
        vertex: Vertex,
        from: Location,
        along: Vector3,
    ) -> f64 {
        let placed = energy.target.placed(energy.target.walked(from, along * H));
        energy.star_value(map, vertex, &placed, f64::INFINITY)
    }

    /// The place with one of its coordinates set to 0.
    fn on_edge(location: Location, k: usize) -> Location {
        let mut barycentric = location.barycentric;
        barycentric[k] = 0.0;
        let sum: f64 = barycentric.iter().sum();
        Location { barycentric: barycentric.map(|x| x / sum), ..location }
    }

    /// The map after a descent, with one of its vertices moved onto an edge of the target where that folds no face.
    fn maps_at_edges<'s>(
        problem: &'s SurfaceProblem<'_>,
        energy: &'s SurfaceEnergy<'_>,
        start: &[Location],
    ) -> impl Iterator<Item = (Vertex, Vec<Placed>)> + 's {
        let descended = descend(problem, start.to_vec(), &mut History::start(), &mut Silent).unwrap();
        let map: Vec<Placed> =
            descended.locations.into_iter().map(|location| energy.target.placed(location)).collect();
        let edges = Vertex::all(map.len()).flat_map(|vertex| [0, 1, 2].map(|k| (vertex, k)));
        edges.filter_map(move |(vertex, k)| {
            let mut map = map.clone();
            let place = on_edge(map[vertex].location, k);
            if place.barycentric.iter().filter(|&&x| x == 0.0).count() != 1 {
                return None;
            }
            map[vertex] = energy.target.placed(place);
            energy.star_value(&map, vertex, &map[vertex], f64::INFINITY).is_finite().then_some((vertex, map))
        })
    }

    #[test]
    fn a_vertex_on_an_edge_stays_there_where_both_sides_rise_and_else_goes_down() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let mut n_staying = 0;
        for (vertex, map) in maps_at_edges(&problem, &energy, &sample.start) {
            let here = map[vertex].location;
            let course = energy.course(&map, vertex);
            let before = energy.star_value(&map, vertex, &map[vertex], f64::INFINITY);
            let corner = here.triangle.corner((0..3).find(|&k| here.barycentric[k] == 0.0).unwrap());
            let across = sample.target.opposite(corner).unwrap();
            let sides = [(corner, here), (across, energy.target.seen_from(&here, corner, across))];
            // the differences quotient into each face, along its own inward direction
            let slopes = sides.map(|(side, location)| {
                let inward = energy.target.edge_frame(side)[1];
                (energy_near(&energy, &map, vertex, location, inward) - before) / H
            });
            let noise = 1e-5 * before;
            if slopes.iter().any(|slope| slope.abs() < noise) {
                continue;
            }
            match course.edge {
                Some(edge) => {
                    n_staying += 1;
                    assert!(slopes.iter().all(|&slope| slope > 0.0), "{vertex}: {slopes:?}");
                    assert_eq!((edge, course.frame[1]), (corner, Vector3::ZERO));
                }
                None => {
                    let k = usize::from(course.location.triangle == across.face());
                    assert!(slopes[k] < 0.0 && slopes[k] <= slopes[1 - k] + noise, "{vertex}: {slopes:?}");
                }
            }
            // seen from the other face, the place is the same
            let there = energy.target.placed(course.location);
            assert!(there.point.distance(map[vertex].point) < 1e-14);
        }
        assert!(n_staying > 0);
    }

    /// Two balls, each with a spike of its own length, one over the other.
    fn spikes(lengths: [f64; 2]) -> Sample {
        let (points, faces) = octasphere(2);
        let [source, target] = lengths.map(|length| {
            let spiky = |(i, &x): (usize, &Vector3)| if i == 0 { x * length } else { x };
            mesh(points.iter().enumerate().map(spiky), &faces)
        });
        let start = Vertex::all(points.len()).map(|vertex| at_vertex(&target, vertex)).collect();
        Sample { source, target, domain: CanonicalDomain::Sphere, target_in_domain: points, start }
    }

    #[test]
    fn a_vertex_at_a_vertex_goes_where_the_energy_falls_if_it_falls_anywhere() {
        // the tip of a longer spike would have to be longer still, that of a shorter one less long
        for (lengths, is_held) in [([1.6, 1.4], true), ([1.2, 1.4], false)] {
            let sample = spikes(lengths);
            let problem = sample.problem();
            let energy = SurfaceEnergy::new(&problem, GUARD);
            let map = sample.placed_on(&energy.target);
            let before = energy.star_value(&map, Vertex(0), &map[0], f64::INFINITY);
            let course = energy.course(&map, Vertex(0));
            assert_eq!(course.frame == [Vector3::ZERO; 2], is_held);
            let slopes = slopes_around(&energy, &map, Vertex(0));
            let least = slopes.iter().fold(f64::INFINITY, |least, &slope| least.min(slope));
            assert_eq!(least > 0.0, is_held, "{least}");
            if !is_held {
                let [first, second] = course.frame;
                let ways = (0..60).map(|k| (TAU * f64::from(k) / 60.0).sin_cos());
                let falls = ways.map(|(sine, cosine)| {
                    let along = first * cosine + second * sine;
                    (energy_near(&energy, &map, Vertex(0), course.location, along) - before) / H
                });
                let steepest = falls.fold(f64::INFINITY, f64::min);
                assert!(steepest < 0.98 * least, "{steepest} {least}");
            }
        }
    }

    /// The differences quotients in directions over all faces around the vertex of the target at which a vertex lies.
    fn slopes_around(energy: &SurfaceEnergy<'_>, map: &[Placed], vertex: Vertex) -> Vec<f64> {
        let here = map[vertex].location;
        let before = energy.star_value(map, vertex, &map[vertex], f64::INFINITY);
        let at = (0..3).find(|&k| here.barycentric[k] == 1.0).unwrap();
        let center = energy.target.faces()[here.triangle][at];
        let mut slopes = Vec::new();
        for &corner in energy.target.mesh().vertex_corners(center) {
            let location = Location::at_corner(corner);
            let [x, y] = energy.target.frame(corner.face());
            for k in 0..60 {
                let (sine, cosine) = (TAU * f64::from(k) / 60.0).sin_cos();
                let along = x * cosine + y * sine;
                let change = energy.target.coordinates(corner.face(), along);
                if (0..3).all(|i| i == corner.place() || change[i] >= 0.0) {
                    slopes.push((energy_near(energy, map, vertex, location, along) - before) / H);
                }
            }
        }
        slopes
    }

    #[test]
    fn rounding_does_not_choose_the_side_of_an_edge() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let map = sample.placed_on(&energy.target);
        let mut n_along = 0;
        for vertex in Vertex::all(map.len()) {
            // 1. At each vertex of the target to which it can move
            let face = energy.target.faces()[map[vertex].location.triangle];
            for center in face {
                let mut at_center = map.clone();
                at_center[vertex] = energy.target.placed(at_vertex(&sample.target, center));
                let course = energy.course(&at_center, vertex);
                if course.edge.is_none() {
                    continue;
                }
                n_along += 1;
                // 2. With noise at the others
                for seed in 0..4 {
                    let mut noisy = at_center.clone();
                    for other in Vertex::all(map.len()).filter(|&other| other != vertex) {
                        let noise = Vector3::from_fn(|axis| 1e-14 * number(seed + 7 * other.index() + axis));
                        noisy[other].point += noise;
                    }
                    let with_noise = energy.course(&noisy, vertex);
                    assert_eq!((with_noise.edge, with_noise.location), (course.edge, course.location));
                }
            }
        }
        assert!(n_along > 10, "{n_along}");
    }

    #[test]
    fn a_vertex_within_a_face_goes_anywhere_in_it() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let inside = Location { barycentric: [0.2, 0.3, 0.5], ..sample.start[4] };
        let mut map = sample.placed_on(&energy.target);
        map[4] = energy.target.placed(inside);
        let course = energy.course(&map, Vertex(4));
        assert_eq!((course.location, course.edge), (inside, None));
        assert_eq!(course.frame, energy.target.frame(inside.triangle));
    }
}
