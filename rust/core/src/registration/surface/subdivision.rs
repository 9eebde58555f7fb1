// SPDX-License-Identifier: MIT OR Apache-2.0
//! Virtual refinement: faces of the source that span many faces of the target are split into k² parts.
//!
//! A flat face between the images of its three corners sees nothing of what lies between them: on a target that is much
//! finer than the source it cuts limbs short. So the corners of its parts, affine combinations of its own corners in the
//! domain, are looked up on the target, by a walk from face to face, and each part counts by its area with the energy
//! of its own flat image. Where such a corner lies is a smooth function of the places of the face's three vertices, as
//! long as it stays in its target face.
//!
//! By the source's area alone it is cheap to cover much of the target with a small face, the cheaper the more its parts
//! tell of it; so where the target is much finer, both directions count ([`FaceEnergy::both_ways`]).
//!
//! Cost: a short walk for each corner of a part. Where the target is not much finer, none.

use super::density::{Expansion, FaceEnergy, Hats, Jacobian, gram};
use super::target::{Placed, Target};
use crate::location::Locator;
use crate::mesh::{Face, TriangleMesh};
use crate::parallel;
use crate::vector::Vector3;

/// A target with so many times the faces of the source is much finer.
const MUCH_FINER: usize = 3;

/// Vertices of the target in a part.
const INSIDE: f64 = 2.0;

/// Most parts along a side of a face.
const MOST: usize = 4;

/// Most corners of parts: of `MOST`.
const MOST_NODES: usize = (MOST + 1) * (MOST + 2) / 2;

/// Most steps of a walk.
const MOST_STEPS: usize = 1_000;

/// A face cut into k² parts, all similar to it.
struct Grid {
    /// Barycentric coordinates of the corners of the parts; those of the face are first.
    nodes: Vec<[f64; 3]>,
    /// The corners of each part, and how its functions' gradients are those of the face scaled: k or −k.
    parts: Vec<([usize; 3], f64)>,
}

impl Grid {
    fn new(k: usize) -> Self {
        let mut places = vec![[k, 0, 0], [0, k, 0], [0, 0, k]];
        for a in 0..=k {
            for b in 0..=k - a {
                let place = [a, b, k - a - b];
                if !place.contains(&k) {
                    places.push(place);
                }
            }
        }
        let find = |place: [usize; 3]| places.iter().position(|other| *other == place).expect("on the grid");
        let mut parts = Vec::new();
        let beside = |base: [usize; 3], add: bool| {
            std::array::from_fn(|corner| {
                let mut place = base;
                place[corner] = if add { place[corner] + 1 } else { place[corner] - 1 };
                find(place)
            })
        };
        for a in 0..k {
            for b in 0..k - a {
                parts.push((beside([a, b, k - 1 - a - b], true), k as f64));
            }
        }
        for a in 1..k {
            for b in 1..=k - a {
                parts.push((beside([a, b, k + 1 - a - b], false), -(k as f64)));
            }
        }
        let nodes = places.iter().map(|place| place.map(|x| x as f64 / k as f64)).collect();
        Self { nodes, parts }
    }
}

/// The parts along a side of a face with some vertices of the target inside.
fn count(n_inside: u32) -> u8 {
    let even = (f64::from(n_inside) / INSIDE).sqrt().round();
    even.clamp(1.0, MOST as f64) as u8
}

/// How the faces of a source are split.
pub(super) struct Subdivision<'a> {
    /// The parts along a side of each face.
    counts: Vec<u8>,
    /// The grids of 2, 3 … parts along a side.
    grids: Vec<Grid>,
    /// For walks that do not arrive; there is one where faces are split.
    locator: Option<Locator<'a>>,
}

/// Whether a target has so many more faces than a source that those of the source span many.
pub(super) fn is_much_finer(target: &TriangleMesh, source: &TriangleMesh) -> bool {
    target.n_faces() >= MUCH_FINER * source.n_faces()
}

impl<'a> Subdivision<'a> {
    /// All faces whole.
    pub(super) fn none(n_faces: usize) -> Self {
        Self { counts: vec![1; n_faces], grids: Vec::new(), locator: None }
    }

    /// Each face in as many parts as the target's vertices in its image ask for; all whole where the target is not much
    /// finer.
    pub(super) fn new(source: &TriangleMesh, target: &Target<'a>, map: &[Placed]) -> Self {
        if !is_much_finer(target.mesh(), source) {
            return Self::none(source.n_faces());
        }
        let images: Vec<Vector3> = map.iter().map(|placed| placed.in_domain).collect();
        let locator = Locator::new(&images, source.faces());
        let vertices = target.in_domain();
        let faces = parallel::map(vertices.len(), |vertex| locator.locate(vertices[vertex]).triangle);
        let mut n_inside = vec![0u32; source.n_faces()];
        faces.into_iter().for_each(|face| n_inside[face.index()] += 1);
        Self {
            counts: n_inside.into_iter().map(count).collect(),
            grids: (2..=MOST).map(Grid::new).collect(),
            locator: Some(Locator::new(target.in_domain(), target.faces())),
        }
    }

    fn grid(&self, face: usize) -> Option<&Grid> {
        let count = usize::from(self.counts[face]);
        (count > 1).then(|| &self.grids[count - 2])
    }

    /// The energy per area of a split face in space; `None` of one that is whole.
    pub(super) fn value(
        &self,
        target: &Target<'_>,
        kind: FaceEnergy,
        face: usize,
        hats: &Hats,
        corners: [&Placed; 3],
    ) -> Option<f64> {
        let grid = self.grid(face)?;
        let mut points = [Vector3::ZERO; MOST_NODES];
        (0..3).for_each(|node| points[node] = corners[node].point);
        for (node, _, place) in self.places(grid, target, corners) {
            points[node] = place.point(target);
        }
        let of_part = |&(nodes, scale): &([usize; 3], f64)| {
            kind.value(gram(&part_jacobian(hats, scale, nodes.map(|node| points[node]))))
        };
        Some(grid.parts.iter().map(of_part).sum::<f64>() / grid.parts.len() as f64)
    }

    /// That energy with its derivatives.
    pub(super) fn expansion(
        &self,
        target: &Target<'_>,
        kind: FaceEnergy,
        face: usize,
        hats: &Hats,
        corners: [&Placed; 3],
        frames: [&[Vector3; 2]; 3],
    ) -> Option<Expansion> {
        let grid = self.grid(face)?;
        // 1. The velocities of the corners in the domain
        let pushed: [Vector3; 6] = std::array::from_fn(|i| {
            let (k, d) = (i / 2, i % 2);
            let change = target.coordinates(corners[k].location.triangle, frames[k][d]);
            target.pushed(corners[k], change)
        });
        // 2. The places of all nodes, and their velocities in space
        let mut points = [Vector3::ZERO; MOST_NODES];
        let mut velocities = [[Vector3::ZERO; 6]; MOST_NODES];
        for node in 0..3 {
            points[node] = corners[node].point;
            (0..2).for_each(|d| velocities[node][2 * node + d] = frames[node][d]);
        }
        for (node, weights, place) in self.places(grid, target, corners) {
            points[node] = place.point(target);
            velocities[node] =
                std::array::from_fn(|i| place.velocity(target, points[node], pushed[i] * weights[i / 2]));
        }
        // 3. The parts
        let mut sum = Expansion::default();
        for &(nodes, scale) in &grid.parts {
            let jacobian = part_jacobian(hats, scale, nodes.map(|node| points[node]));
            let changes: [Jacobian; 6] =
                std::array::from_fn(|i| part_jacobian(hats, scale, nodes.map(|node| velocities[node][i])));
            sum.add(1.0 / grid.parts.len() as f64, &kind.expansion_along(&jacobian, &changes));
        }
        Some(sum)
    }

    /// The nodes of a grid besides the corners, with their weights and places, each found by a walk from the last.
    fn places<'s>(
        &'s self,
        grid: &'s Grid,
        target: &'s Target<'_>,
        corners: [&'s Placed; 3],
    ) -> impl Iterator<Item = (usize, &'s [f64; 3], Place)> {
        let mut at = corners[0].location.triangle;
        grid.nodes.iter().enumerate().skip(3).map(move |(node, weights)| {
            let place = self.place(target, corners, weights, at);
            at = place.face;
            (node, weights, place)
        })
    }

    /// The place on the target of a combination of corners in the domain.
    fn place(&self, target: &Target<'_>, corners: [&Placed; 3], weights: &[f64; 3], from: Face) -> Place {
        let flat: Vector3 = (0..3).map(|k| corners[k].in_domain * weights[k]).sum();
        target.place_of(flat, from).unwrap_or_else(|| {
            let locator = self.locator.as_ref().expect("there is one where faces are split");
            target.place_in(flat, locator.locate(target.onto_domain(flat)).triangle)
        })
    }
}

/// The linear map of a part of a face whose functions have `scale` times the gradients of those of the face.
fn part_jacobian(hats: &Hats, scale: f64, images: [Vector3; 3]) -> Jacobian {
    [0, 1].map(|axis| (0..3).map(|corner| images[corner] * (scale * hats[corner][axis])).sum())
}

/// A place on the target, given by a point of the domain, up to its length.
struct Place {
    face: Face,
    /// Normals of the planes through the center and two corners of the face in the domain, inward.
    normals: [Vector3; 3],
    /// The products with the point; shares of the corners, up to their sum.
    shares: [f64; 3],
}

impl Place {
    fn point(&self, target: &Target<'_>) -> Vector3 {
        let shares = self.shares.map(|share| share.max(0.0));
        let sum: f64 = shares.iter().sum();
        let corners = target.corners(self.face);
        (0..3).map(|k| corners[k] * (shares[k] / sum)).sum()
    }

    /// Its velocity in space where the point of the domain has this one.
    fn velocity(&self, target: &Target<'_>, point: Vector3, in_domain: Vector3) -> Vector3 {
        let sum: f64 = self.shares.iter().sum();
        let corners = target.corners(self.face);
        (0..3).map(|k| (corners[k] - point) * (self.normals[k].dot(in_domain) / sum)).sum()
    }
}

impl Target<'_> {
    /// The place of a point of the domain in a face.
    fn place_in(&self, flat: Vector3, face: Face) -> Place {
        let [a, b, c] = self.corners_in_domain(face);
        let normals = [b.cross(c), c.cross(a), a.cross(b)];
        Place { face, normals, shares: normals.map(|normal| normal.dot(flat)) }
    }

    /// The place of a point of the domain, by a walk from a face; `None` where it does not arrive.
    fn place_of(&self, flat: Vector3, from: Face) -> Option<Place> {
        let mut face = from;
        let mut came_over = 3;
        for step in 0..MOST_STEPS {
            let place = self.place_in(flat, face);
            // from another edge each time, so that it does not run in circles
            let outside = (0..3).map(|k| (k + step) % 3).find(|&k| k != came_over && place.shares[k] < 0.0);
            let Some(k) = outside else { return Some(place) };
            let across = self.mesh().opposite(face.corner(k))?;
            (face, came_over) = (across.face(), across.place());
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::energy::{Guard, SurfaceEnergy};
    use super::super::sample_maps::{Sample, flat_disk};
    use super::*;
    use crate::codomain::CanonicalDomain;
    use crate::mesh::Vertex;

    const NO_GUARD: Guard = Guard { weight: 0.0, slack: 0.0 };

    #[test]
    fn parts_are_similar_and_fill_the_face() {
        let corners = [Vector3([0.0, 0.0, 0.0]), Vector3([3.0, 0.0, 0.0]), Vector3([1.0, 2.0, 0.0])];
        for k in 2..=MOST {
            let grid = Grid::new(k);
            assert_eq!((grid.parts.len(), grid.nodes.len()), (k * k, (k + 1) * (k + 2) / 2));
            let at = |node: usize| -> Vector3 { (0..3).map(|i| corners[i] * grid.nodes[node][i]).sum() };
            let mut centers: Vec<Vector3> = Vec::new();
            for &(nodes, scale) in &grid.parts {
                assert_eq!(scale.abs(), k as f64);
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let side = at(nodes[j]) - at(nodes[i]);
                    assert!((side * scale).distance(corners[j] - corners[i]) < 1e-12);
                }
                centers.push(nodes.map(at).into_iter().sum::<Vector3>());
            }
            // no two in one place, and together as large as the face
            let apart = |i: usize, j: usize| centers[i].distance(centers[j]) > 0.1;
            assert!((0..k * k).all(|i| (0..i).all(|j| apart(i, j))));
        }
    }

    #[test]
    fn faces_are_split_by_the_vertices_inside_them_where_the_target_is_much_finer() {
        assert_eq!([0, 4, 5, 12, 13, 25, 1000].map(count), [1, 1, 2, 2, 3, 4, 4]);
        for sample in [Sample::coarse_sphere(), Sample::coarse_disk()] {
            let target = Target::new(&sample.target, &sample.target_in_domain, sample.domain);
            let subdivision = Subdivision::new(&sample.source, &target, &sample.placed_on(&target));
            assert!(subdivision.counts.iter().any(|&count| count > 1));
        }
        for sample in [Sample::spheres(), Sample::disks()] {
            let target = Target::new(&sample.target, &sample.target_in_domain, sample.domain);
            let subdivision = Subdivision::new(&sample.source, &target, &sample.placed_on(&target));
            assert!(subdivision.counts.iter().all(|&count| count == 1));
        }
    }

    #[test]
    fn the_energy_of_surfaces_of_like_resolution_stays_as_it_is() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let mut energy = SurfaceEnergy::new(&problem, Guard { weight: 0.7, slack: 3.0 });
        let map = sample.placed_on(&energy.target);
        let before = energy.value(&map);
        energy.subdivide(&map);
        assert_eq!(energy.value(&map), before);
    }

    #[test]
    fn on_a_flat_target_the_parts_of_a_face_count_like_the_whole() {
        let sample = Sample::coarse_disk();
        let (flat, in_domain) = flat_disk(12);
        let target = Target::new(&flat, &in_domain, CanonicalDomain::Disk);
        let map = sample.placed_on(&target);
        let problem = crate::registration::surface::SurfaceProblem {
            target: &flat,
            target_points: flat.points(),
            target_in_domain: &in_domain,
            ..sample.problem()
        };
        let mut energy = SurfaceEnergy::new(&problem, NO_GUARD);
        let expansions = |energy: &SurfaceEnergy<'_>| -> Vec<Expansion> {
            (0..energy.areas.len())
                .map(|face| {
                    let corners = energy.corners(&map, face);
                    let frames = corners.map(|placed| target.frame(placed.location.triangle));
                    energy.face_expansion(face, corners, [&frames[0], &frames[1], &frames[2]])
                })
                .collect()
        };
        let whole = expansions(&energy);
        energy.subdivide(&map);
        for (whole, split) in whole.into_iter().zip(expansions(&energy)) {
            assert!((whole.value - split.value).abs() < 1e-12 * whole.value);
            for i in 0..6 {
                assert!((whole.gradient[i] - split.gradient[i]).abs() < 1e-10 * whole.value);
                for j in 0..6 {
                    assert!((whole.hessian[i][j] - split.hessian[i][j]).abs() < 1e-9 * whole.value);
                }
            }
        }
    }

    #[test]
    fn walks_arrive_where_the_locator_does() {
        for sample in [Sample::coarse_sphere(), Sample::coarse_disk()] {
            let target = Target::new(&sample.target, &sample.target_in_domain, sample.domain);
            let map = sample.placed_on(&target);
            let locator = Locator::new(&sample.target_in_domain, sample.target.faces());
            let mut n_walks = 0;
            for face in sample.source.faces() {
                let corners = face.map(|vertex: Vertex| &map[vertex]);
                let flat: Vector3 = (0..3).map(|k| corners[k].in_domain * [0.5, 0.3, 0.2][k]).sum();
                let place = target.place_of(flat, corners[1].location.triangle).expect("it arrives");
                let expected = target.placed(locator.locate(target.onto_domain(flat)));
                assert!(place.point(&target).distance(expected.point) < 1e-12);
                n_walks += usize::from(place.face != corners[1].location.triangle);
            }
            assert!(n_walks > sample.source.n_faces() / 2);
        }
    }
}
