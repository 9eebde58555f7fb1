// SPDX-License-Identifier: MIT OR Apache-2.0
//! Newton's method on the places of the source's vertices, by steps that fold no face.
//!
//! A step is a tangent vector at each vertex; the vertex walks along it straight over the target. Target edges are
//! kinks of the energy: a vertex that lies lowest on one stays there ([`kinks`](super::kinks)). A few faces near their
//! limit would hold up a whole step: their vertices go a part of the way, their neighbors up to twice that part, and so
//! on. Steps that are shortened or keep little of their promise damp the next ones (D. W. Marquardt, An algorithm for
//! least-squares estimation of nonlinear parameters, J. SIAM 11, 1963): with undamped ones noise in the input grows from
//! step to step.
//!
//! Cost of a step: one factorization of two unknowns per vertex.

use super::density::Expansion;
use super::energy::SurfaceEnergy;
use super::kinks::Course;
use super::target::{Placed, boundary_edge};
use crate::control::Watch;
use crate::location::Location;
use crate::mesh::{Face, Vertex};
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure};
use crate::vector::Vector3;

/// Shift of the Hessian's diagonal relative to itself, and to the area of a face.
const SHIFTS: [f64; 2] = [1e-8, 1e-6];

/// Parts of the decrease promised by the quadratic model below which the next step is damped more, and above which it is
/// damped less, by a factor; the least that it is raised to, and the most.
const POOR: f64 = 0.25;
const GOOD: f64 = 0.75;
const DAMPING_FACTOR: f64 = 4.0;
const LEAST_DAMPING: f64 = 0.1;
const MOST_DAMPING: f64 = 1.0;

/// Longest step of a vertex; the target has an area of 1.
const LONGEST: f64 = 0.2;

/// Factor from one try of a step to the next, and the number of tries.
const SHORTER: f64 = 0.4;
const TRIES: usize = 12;

/// Part of the predicted decrease that a step has to reach.
const SUFFICIENT: f64 = 1e-4;

/// Rise of a face's energy, in parts of itself and absolute, that is taken for a barrier.
const BARRIER: [f64; 2] = [2.0, 1.0];

/// Rounds of holding vertices back in one try.
const ROUNDS: usize = 16;

/// Part of its way that a vertex keeps in a round: in the first rounds, in later ones, and in the last.
const KEPT: [(usize, f64); 3] = [(6, 0.3), (9, 0.02), (ROUNDS, 0.0)];

/// Rounds in which faces are held back only because the energy does not fall enough, and the part of all faces that
/// may be.
const RELENTING: usize = 6;
const FEW: f64 = 0.02;

/// How the vertices move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Motion {
    Held,
    /// Along the boundary of the target.
    Slides,
    Free,
}

impl Motion {
    pub(super) fn n_unknowns(self) -> u8 {
        match self {
            Self::Held => 0,
            Self::Slides => 1,
            Self::Free => 2,
        }
    }
}

/// The places of the vertices, and how they may move.
pub(super) struct Moving<'a, 'p> {
    pub energy: &'a SurfaceEnergy<'p>,
    pub motions: &'a [Motion],
    pub map: Vec<Placed>,
    /// The face that each vertex has left with its last step into another.
    pub(super) left: Vec<Option<Face>>,
    /// Factor of the Hessian's diagonal that is added to it.
    damping: f64,
}

/// A direction with its slope.
struct Direction {
    /// The unknowns of each vertex.
    unknowns: Vec<[f64; 2]>,
    courses: Vec<Course>,
    expansions: Vec<Expansion>,
    slope: f64,
}

/// What a step has done.
pub(super) struct Step {
    /// The energy before and after.
    pub energies: [f64; 2],
    /// The share of the whole step.
    pub share: f64,
    /// The slope of the energy along the whole step.
    pub slope: f64,
}

/// Parts of a step.
struct Trial {
    map: Vec<Placed>,
    value: f64,
}

impl<'a, 'p> Moving<'a, 'p> {
    pub(super) fn new(energy: &'a SurfaceEnergy<'p>, motions: &'a [Motion], map: Vec<Placed>) -> Self {
        let left = vec![None; map.len()];
        Self { energy, motions, map, left, damping: 0.0 }
    }

    /// One step; `None` where none lowers the energy.
    pub(super) fn step(
        &mut self,
        analysis: &Analysis,
        factor: &mut Factor<f64>,
        watch: &Watch<'_>,
    ) -> Result<Option<Step>, Failure> {
        // 1. Vertices at kinks stay there, or turn into the face that they go down
        let courses = self.courses();
        self.turn_into(&courses);
        // 2. The direction
        let direction = self.direction(courses, analysis, factor, watch)?;
        // 3. As much of it as lowers the energy
        let values = self.energy.face_values(&self.map);
        let of_vertices = parallel::map(self.map.len(), |vertex| {
            self.energy.vertex_value(Vertex::new(vertex), &self.map[vertex])
        });
        let before = self.total(&values, &of_vertices);
        let mut share = 1.0;
        for _ in 0..TRIES {
            if !watch.goes_on() {
                return Err(Failure::Cancelled);
            }
            if let Some(trial) = self.trial(&direction, share, &values, &of_vertices) {
                self.go_to(trial.map);
                let energies = [before, trial.value];
                let kept = if share < 1.0 { 0.0 } else { (before - trial.value) / (-0.5 * direction.slope) };
                self.damp(kept);
                return Ok(Some(Step { energies, share, slope: direction.slope }));
            }
            share *= SHORTER;
        }
        Ok(None)
    }

    /// Damps the next steps according to the part of its promise that one has kept, none if it was shortened.
    fn damp(&mut self, kept: f64) {
        if kept < POOR {
            self.damping = (DAMPING_FACTOR * self.damping).clamp(LEAST_DAMPING, MOST_DAMPING);
        } else if kept > GOOD {
            self.damping /= DAMPING_FACTOR;
        }
    }

    fn total(&self, values: &[f64], of_vertices: &[f64]) -> f64 {
        let areas = &self.energy.areas;
        parallel::dot(areas, values) + parallel::sum(of_vertices.len(), |vertex| of_vertices[vertex])
    }

    /// Newton's direction.
    fn direction(
        &self,
        courses: Vec<Course>,
        analysis: &Analysis,
        factor: &mut Factor<f64>,
        watch: &Watch<'_>,
    ) -> Result<Direction, Failure> {
        let (energy, map) = (self.energy, &self.map);
        // 1. The faces' parts, with a vertex's own in the first of its corners
        let expansions = parallel::map(energy.areas.len(), |face| {
            let vertices = energy.source.faces()[face];
            let corners = vertices.map(|vertex| &map[vertex]);
            let mut expansion =
                energy.face_expansion(face, corners, vertices.map(|vertex| &courses[vertex].frame));
            for (k, vertex) in vertices.into_iter().enumerate() {
                if energy.source.vertex_corners(vertex)[0] == Face::new(face).corner(k) {
                    let own = energy.vertex_expansion(vertex, &map[vertex], &courses[vertex].frame);
                    add_vertex(&mut expansion, k, &own.gradient, &own.hessian);
                }
            }
            expansion
        });
        // 2. The system
        let gradient = parallel::map(map.len(), |vertex| {
            let corners = energy.source.vertex_corners(Vertex::new(vertex));
            corners.iter().fold([0.0; 2], |sum, corner| {
                let (of_face, k) = (&expansions[corner.face()].gradient, 2 * corner.place());
                [sum[0] + of_face[k], sum[1] + of_face[k + 1]]
            })
        });
        let element = |face: usize| shifted(&expansions[face].hessian, energy.areas[face], self.damping);
        factor.refactor(analysis, &element, watch)?;
        // 3. Its solution, in steps of bounded length
        let mut rhs = vec![0.0; analysis.n_unknowns()];
        for (vertex, slopes) in gradient.iter().enumerate() {
            let first = analysis.first_unknown(vertex);
            (0..self.n_unknowns(vertex)).for_each(|d| rhs[first + d] = -slopes[d]);
        }
        factor.solve(analysis, &mut rhs);
        let unknowns = parallel::map(map.len(), |vertex| {
            let first = analysis.first_unknown(vertex);
            let mut along = [0.0; 2];
            (0..self.n_unknowns(vertex)).for_each(|d| along[d] = rhs[first + d]);
            let length = along[0].hypot(along[1]);
            if length > LONGEST { along.map(|x| x * LONGEST / length) } else { along }
        });
        let slope =
            parallel::sum(map.len(), |v| gradient[v][0] * unknowns[v][0] + gradient[v][1] * unknowns[v][1]);
        Ok(Direction { unknowns, courses, expansions, slope })
    }

    /// How each vertex goes on.
    fn courses(&self) -> Vec<Course> {
        parallel::map(self.map.len(), |vertex| match self.motions[vertex] {
            Motion::Free => self.energy.course(&self.map, Vertex::new(vertex)),
            _ => Course { location: self.map[vertex].location, frame: self.frame(vertex), edge: None },
        })
    }

    /// Sees the vertices from the faces that they go into.
    fn turn_into(&mut self, courses: &[Course]) {
        for (vertex, course) in courses.iter().enumerate() {
            if course.location != self.map[vertex].location {
                self.map[vertex] = self.energy.target.placed(course.location);
                self.left[vertex] = None;
            }
        }
    }

    /// Moves the vertices, and keeps the faces that they have left.
    fn go_to(&mut self, map: Vec<Placed>) {
        for ((left, before), after) in self.left.iter_mut().zip(&self.map).zip(&map) {
            if before.location.triangle != after.location.triangle {
                *left = Some(before.location.triangle);
            }
        }
        self.map = map;
    }

    fn n_unknowns(&self, vertex: usize) -> usize {
        usize::from(self.motions[vertex].n_unknowns())
    }

    /// The directions in which a vertex may move.
    pub(super) fn frame(&self, vertex: usize) -> [Vector3; 2] {
        let (target, location) = (&self.energy.target, &self.map[vertex].location);
        if self.motions[vertex] == Motion::Slides
            && let Some(edge) = boundary_edge(target.mesh(), location)
        {
            let [from, to] = edge.half_edge(target.faces()).map(|v| target.points[v]);
            return [(to - from).normalized(), Vector3::ZERO];
        }
        target.frame(location.triangle)
    }

    /// A vertex after a part of its step.
    fn moved(&self, direction: &Direction, vertex: usize, share: f64) -> Placed {
        let [a, b] = direction.unknowns[vertex].map(|x| share * x);
        let Course { frame: [first, second], edge, .. } = direction.courses[vertex];
        let along = first * a + second * b;
        let (target, placed) = (&self.energy.target, &self.map[vertex]);
        if self.motions[vertex] != Motion::Free || along == Vector3::ZERO {
            return self.walked(vertex, along, a);
        }
        target.placed(match edge {
            Some(edge) => target.walked_along_edge(placed.location, edge, a),
            None => target.walked_until(placed.location, along, self.left[vertex]),
        })
    }

    /// A vertex after a walk along a vector, or by a distance along the boundary.
    pub(super) fn walked(&self, vertex: usize, along: Vector3, distance: f64) -> Placed {
        let (target, placed) = (&self.energy.target, &self.map[vertex]);
        let location: Location = match self.motions[vertex] {
            Motion::Held => return *placed,
            _ if along == Vector3::ZERO => return *placed,
            Motion::Slides => target.walked_along_boundary(placed.location, distance),
            Motion::Free => target.walked(placed.location, along),
        };
        target.placed(location)
    }

    /// The map after a share of the step, where vertices are held back as far as faces ask for it; `None` where the
    /// energy does not fall.
    fn trial(&self, direction: &Direction, share: f64, values: &[f64], of_vertices: &[f64]) -> Option<Trial> {
        let (energy, n) = (self.energy, self.map.len());
        let before = self.total(values, of_vertices);
        let goal = SUFFICIENT * share * direction.slope;
        let mut shares = vec![share; n];
        let mut map = parallel::map(n, |vertex| self.moved(direction, vertex, share));
        let mut after = energy.face_values(&map);
        let mut relentings = 0;
        for round in 0..ROUNDS {
            // 1. Faces that fold or run into a barrier
            let is_barred = |&face: &usize| after[face] > BARRIER[1] + (1.0 + BARRIER[0]) * values[face];
            let mut obstacles: Vec<usize> = (0..values.len()).filter(is_barred).collect();
            // 2. If there are none: enough, or held up by a few faces
            if obstacles.is_empty() {
                let vertices_after =
                    parallel::map(n, |vertex| energy.vertex_value(Vertex::new(vertex), &map[vertex]));
                let value = self.total(&after, &vertices_after);
                if value - before < goal {
                    return Some(Trial { map, value });
                }
                relentings += 1;
                if relentings > RELENTING {
                    return None;
                }
                let rise = value - before;
                obstacles = self.held_up_by(direction, &shares, values, &after, rise, share)?;
            }
            // 3. These are held back
            let changed = self.held_back(&obstacles, &mut shares, kept(round));
            for &vertex in &changed {
                map[vertex] = self.moved(direction, vertex, shares[vertex]);
            }
            for corner in changed.iter().flat_map(|&v| energy.source.vertex_corners(Vertex::new(v))) {
                let face = corner.face().index();
                after[face] = energy.face_value(face, energy.corners(&map, face));
            }
        }
        None
    }

    /// The few faces that rise above what the slope promises, without which the energy would fall; `None` if there is
    /// no such few.
    fn held_up_by(
        &self,
        direction: &Direction,
        shares: &[f64],
        values: &[f64],
        after: &[f64],
        rise: f64,
        share: f64,
    ) -> Option<Vec<usize>> {
        let energy = self.energy;
        let excess = parallel::map(values.len(), |face| {
            let vertices = energy.source.faces()[face];
            let gradient = &direction.expansions[face].gradient;
            let promised: f64 = (0..6)
                .map(|i| {
                    let vertex = vertices[i / 2];
                    gradient[i] * shares[vertex] * direction.unknowns[vertex][i % 2]
                })
                .sum();
            energy.areas[face] * (after[face] - values[face]) - promised
        });
        let mut order: Vec<usize> = (0..values.len()).filter(|&face| excess[face] > 0.0).collect();
        order.sort_by(|&a, &b| excess[b].total_cmp(&excess[a]).then(a.cmp(&b)));
        let promised = share * direction.slope;
        let most = 5 + (FEW * values.len() as f64) as usize;
        let (mut rest, mut few) = (rise, Vec::new());
        for face in order.into_iter().take(most) {
            if rest <= 0.2 * promised {
                break;
            }
            rest -= excess[face];
            few.push(face);
        }
        (rest <= 0.05 * promised).then_some(few)
    }

    /// Cuts the shares of the vertices of faces, and those of their neighbors to twice as much at most; returns the
    /// vertices whose share has changed.
    fn held_back(&self, faces: &[usize], shares: &mut [f64], kept: f64) -> Vec<usize> {
        let source = self.energy.source;
        let mut cut: Vec<Vertex> = faces.iter().flat_map(|&face| source.faces()[face]).collect();
        cut.sort_unstable();
        cut.dedup();
        cut.retain(|&vertex| shares[vertex] > 0.0);
        cut.iter().for_each(|&vertex| shares[vertex] *= kept);
        let mut changed: Vec<usize> = cut.iter().map(|vertex| vertex.index()).collect();
        if kept > 0.0 {
            let bound: Vec<f64> = cut.iter().map(|&vertex| 2.0 * shares[vertex]).collect();
            for (&vertex, bound) in cut.iter().zip(bound) {
                let neighbors =
                    source.vertex_corners(vertex).iter().flat_map(|corner| source.faces()[corner.face()]);
                for neighbor in neighbors {
                    if shares[neighbor] > bound && neighbor != vertex {
                        shares[neighbor] = bound;
                        changed.push(neighbor.index());
                    }
                }
            }
        }
        changed.sort_unstable();
        changed.dedup();
        changed
    }
}

/// Part of its way that a vertex keeps in a round.
fn kept(round: usize) -> f64 {
    KEPT.into_iter().find(|(until, _)| round < *until).map_or(0.0, |(_, kept)| kept)
}

/// Adds the derivatives of a vertex's own energy to those of one of its faces.
fn add_vertex(expansion: &mut Expansion, k: usize, gradient: &[f64; 2], &[xx, xy, yy]: &[f64; 3]) {
    let i = 2 * k;
    expansion.gradient[i] += gradient[0];
    expansion.gradient[i + 1] += gradient[1];
    expansion.hessian[i][i] += xx;
    expansion.hessian[i + 1][i + 1] += yy;
    expansion.hessian[i][i + 1] += xy;
    expansion.hessian[i + 1][i] += xy;
}

/// A face's Hessian with its diagonal shifted, by one value for both unknowns of a corner.
fn shifted(hessian: &[[f64; 6]; 6], area: f64, damping: f64) -> [[f64; 6]; 6] {
    let mut element = *hessian;
    for k in 0..3 {
        let shift = (SHIFTS[0] + damping) * (element[2 * k][2 * k] + element[2 * k + 1][2 * k + 1])
            + SHIFTS[1] * area;
        element[2 * k][2 * k] += shift;
        element[2 * k + 1][2 * k + 1] += shift;
    }
    element
}

#[cfg(test)]
mod tests {
    use super::super::energy::Guard;
    use super::super::sample_maps::Sample;
    use super::*;
    use crate::control::Silent;
    use crate::sparse::Order;

    const GUARD: Guard = Guard { weight: 0.1, slack: 3.0 };

    /// Some steps from the start of a sample.
    fn stepped(sample: &Sample, energy: &SurfaceEnergy<'_>, motions: &[Motion], n: usize) -> Vec<Placed> {
        let dofs: Vec<u8> = motions.iter().map(|motion| motion.n_unknowns()).collect();
        let faces = sample.source.faces();
        let analysis = Analysis::new(motions.len(), faces, &dofs, Order::Sparse).unwrap();
        let mut factor = Factor::new(&analysis);
        let map = sample.placed_on(&energy.target);
        let mut moving = Moving::new(energy, motions, map);
        for _ in 0..n {
            let before = energy.value(&moving.map);
            let mut silent = Silent;
            let watch = Watch::new(&mut silent, 0.0, "");
            let Some(step) = moving.step(&analysis, &mut factor, &watch).unwrap() else { break };
            let after = energy.value(&moving.map);
            assert!(after < before && step.slope < 0.0 && step.share > 0.0);
            // the step tells what the whole energy says
            for (told, value) in step.energies.into_iter().zip([before, after]) {
                assert!((told - value).abs() < 1e-12 * value);
            }
        }
        moving.map
    }

    fn n_folded(sample: &Sample, map: &[Placed]) -> usize {
        let is_folded = |face: &&[Vertex; 3]| {
            let [a, b, c] = face.map(|vertex| map[vertex].in_domain);
            a.dot(b.cross(c)) <= 0.0
        };
        sample.source.faces().iter().filter(is_folded).count()
    }

    #[test]
    fn steps_lower_the_energy_and_fold_nothing() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let motions = vec![Motion::Free; sample.start.len()];
        let [start, end] = [0, 5].map(|n| stepped(&sample, &energy, &motions, n));
        assert_eq!([n_folded(&sample, &start), n_folded(&sample, &end)], [0, 0]);
        assert!(energy.value(&end) < 0.8 * energy.value(&start));
    }

    #[test]
    fn held_vertices_stay_bit_for_bit() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let mut motions = vec![Motion::Free; sample.start.len()];
        (0..motions.len()).step_by(4).for_each(|vertex| motions[vertex] = Motion::Held);
        let [start, end] = [0, 5].map(|n| stepped(&sample, &energy, &motions, n));
        assert!((0..motions.len()).step_by(4).all(|vertex| start[vertex] == end[vertex]));
        assert!((1..motions.len()).step_by(4).any(|vertex| start[vertex] != end[vertex]));
    }

    #[test]
    fn vertices_that_slide_stay_on_the_boundary() {
        let sample = Sample::disks();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let on_boundary = |vertex| sample.source.is_boundary(vertex);
        let motions: Vec<Motion> = Vertex::all(sample.start.len())
            .map(|vertex| if on_boundary(vertex) { Motion::Slides } else { Motion::Free })
            .collect();
        let [start, end] = [0, 5].map(|n| stepped(&sample, &energy, &motions, n));
        assert_eq!([n_folded(&sample, &start), n_folded(&sample, &end)], [0, 0]);
        let mut n_moved = 0;
        for vertex in Vertex::all(end.len()).filter(|&vertex| on_boundary(vertex)) {
            assert!(boundary_edge(&sample.target, &end[vertex].location).is_some());
            n_moved += usize::from(start[vertex] != end[vertex]);
        }
        assert!(n_moved > 0 && energy.value(&end) < energy.value(&start));
    }

    #[test]
    fn a_soft_landmark_draws_its_vertex_near() {
        let sample = Sample::spheres();
        let mut problem = sample.problem();
        let motions = vec![Motion::Free; sample.start.len()];
        let distance = |weight: f64, problem: &mut super::super::SurfaceProblem<'_>| {
            problem.pulls = vec![super::super::Pull { vertex: Vertex(20), place: Vertex(20), weight }];
            let energy = SurfaceEnergy::new(problem, GUARD);
            let end = stepped(&sample, &energy, &motions, 8);
            end[20].point.distance(energy.target.points[20])
        };
        let [weak, strong] = [1e-3, 1e3].map(|weight| distance(weight, &mut problem));
        assert!(strong < 0.1 * weak, "{strong} {weak}");
    }
}
