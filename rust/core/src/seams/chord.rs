// SPDX-License-Identifier: MIT OR Apache-2.0
//! The chord that parts two sheets of an island which overlap in the plane.
//!
//! 1. Overlapping faces joined over edges within the island are its sheets; those that share the most area are parted.
//!    Where a sheet overlaps itself, the two faces of a pair that are farthest apart within the island stand for it.
//! 2. Both grow to [`LEAST_AREA`], so that no sliver is cut off, each where it is clearly nearer than the other.
//! 3. The cheapest chord between them is the minimum cut of the dual graph of a disk: a path from border to border that
//!    crosses any path of faces between the sheets an odd number of times (J. H. Reif, Minimum s-t cut of a planar
//!    undirected network in O(n log² n) time, SIAM Journal on Computing 12, 1983). It is a shortest path among pairs of
//!    a vertex and the parity of crossings. In practice it is the neck of a limb.
//!
//! Cost: O(n log n).

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, VecDeque};

use super::cut::Cut;
use super::edge_mesh::EdgeMesh;
use super::maps::IslandMap;
use super::overlap::Overlap;
use crate::mesh::{Corner, Edge, Edges, Face, Vertex};
use crate::vector::Vector3;

/// The number of pairs of sheets tried.
const TRIES: usize = 3;

/// The share of the whole area to which sheets grow before they are parted.
const LEAST_AREA: f64 = 0.02;

/// The upper bound of the distance to the face's own sheet over that to the opposite one, within which a sheet grows.
const NEARER: f64 = 0.8;

/// The upper bound of searches for the faces of a sheet that are farthest apart.
const SWEEPS: usize = 5;

/// A face is farther than another one by this factor at least: less is noise.
const FARTHER: f64 = 1.0 + 1e-9;

/// Bits of the mantissa, of 23, that noise may decide of the area that two sheets share.
const NOISY_BITS: u32 = 16;

/// The price of an edge of median cost: costs that differ by less than a millionth of it are equal.
const MEDIAN_PRICE: f64 = (1 << 20) as f64;

/// The greatest price of an edge of finite cost.
const GREATEST_PRICE: f64 = (1_u64 << 40) as f64;

/// The cheapest edges that part the two sheets of an island with the most overlap and leave disks only, if there are
/// any; edges of infinite cost stay whole.
pub(super) fn chord(
    mesh: &EdgeMesh,
    cut: &Cut,
    cost: &[f64],
    island: &IslandMap,
    overlap: &Overlap,
) -> Option<Vec<Edge>> {
    let disk = Disk::new(mesh, island);
    // 1. Sheets
    let sheets = Sheets::new(&disk, overlap);
    sheets.ranked(overlap).into_iter().take(TRIES).find_map(|pair| {
        // 2. Seeds
        let seeds = disk.grown(sheets.seeds(&disk, overlap, pair));
        // 3. The chord
        let chord = disk.cheapest_chord(&seeds, cost)?;
        cut.with(&chord).islands(mesh).are_disks().then_some(chord)
    })
}

/// An island; faces, vertices and edges are its own.
struct Disk<'a> {
    mesh: &'a EdgeMesh,
    island: &'a IslandMap,
    edges: Edges,
    /// The center of each face.
    centers: Vec<Vector3>,
}

impl<'a> Disk<'a> {
    fn new(mesh: &'a EdgeMesh, island: &'a IslandMap) -> Self {
        let centers = Face::all(island.mesh.n_faces()).map(|face| island.mesh.center(face)).collect();
        Self { mesh, island, edges: Edges::new(&island.mesh), centers }
    }

    fn n_faces(&self) -> usize {
        self.centers.len()
    }

    /// The length of the shortest path over centers of faces from any of `sources` to each face (E. W. Dijkstra, 1959).
    fn distances(&self, sources: &[Face]) -> Vec<f64> {
        let mut distances = vec![f64::INFINITY; self.n_faces()];
        // the bits of positive numbers are ordered as the numbers are
        let mut queue = BinaryHeap::new();
        for &source in sources {
            distances[source] = 0.0;
            queue.push(Reverse((0.0_f64.to_bits(), source)));
        }
        while let Some(Reverse((bits, face))) = queue.pop() {
            let reached = f64::from_bits(bits);
            if reached > distances[face] {
                continue;
            }
            for neighbor in self.island.mesh.neighbors(face) {
                let through = reached + self.centers[face].distance(self.centers[neighbor]);
                if through < distances[neighbor] {
                    distances[neighbor] = through;
                    queue.push(Reverse((through.to_bits(), neighbor)));
                }
            }
        }
        distances
    }

    /// The seeds with the faces nearest to each until it has [`LEAST_AREA`].
    fn grown(&self, mut seeds: [Vec<Face>; 2]) -> [Vec<Face>; 2] {
        let distances = [0, 1].map(|side| self.distances(&seeds[side]));
        for (side, seed) in seeds.iter_mut().enumerate() {
            let [near, far] = [&distances[side], &distances[1 - side]];
            let is_around = |&face: &Face| 0.0 < near[face] && near[face] < NEARER * far[face];
            let mut around: Vec<Face> = Face::all(self.n_faces()).filter(is_around).collect();
            around.sort_unstable_by(|&a, &b| near[a].total_cmp(&near[b]).then(a.cmp(&b)));
            let mut area: f64 = seed.iter().map(|&face| self.area(face)).sum();
            for face in around {
                if area >= LEAST_AREA {
                    break;
                }
                area += self.area(face);
                seed.push(face);
            }
        }
        seeds
    }

    fn area(&self, face: Face) -> f64 {
        self.mesh.areas[self.island.face_of[face]]
    }

    /// The edges of the mesh, ascending, on the cheapest path from border to border that parts two sets of faces.
    fn cheapest_chord(&self, seeds: &[Vec<Face>; 2], cost: &[f64]) -> Option<Vec<Edge>> {
        let is_crossed = self.crossings(seeds);
        let prices = self.prices(seeds, cost);
        // a state is a vertex and the parity of the crossings on the way to it
        let mut reached = vec![[u64::MAX; 2]; self.island.mesh.n_vertices()];
        let mut last = vec![[None; 2]; reached.len()];
        let mut queue = BinaryHeap::new();
        for vertex in Vertex::all(reached.len()).filter(|&vertex| self.island.mesh.is_boundary(vertex)) {
            reached[vertex][0] = 0;
            queue.push(Reverse((0, vertex, 0)));
        }
        while let Some(Reverse((price, vertex, parity))) = queue.pop() {
            if price > reached[vertex][parity] {
                continue;
            }
            if parity == 1 && self.island.mesh.is_boundary(vertex) {
                return Some(self.walk_back((vertex, parity), &last, &is_crossed));
            }
            for &(neighbor, edge) in self.edges.around(vertex) {
                let Some(edge_price) = prices[edge] else { continue };
                let (through, parity) = (price + edge_price, parity ^ usize::from(is_crossed[edge]));
                if through < reached[neighbor][parity] {
                    reached[neighbor][parity] = through;
                    last[neighbor][parity] = Some(edge);
                    queue.push(Reverse((through, neighbor, parity)));
                }
            }
        }
        None
    }

    /// The edges of the mesh on the path to a state.
    fn walk_back(
        &self,
        (mut vertex, mut parity): (Vertex, usize),
        last: &[[Option<Edge>; 2]],
        is_crossed: &[bool],
    ) -> Vec<Edge> {
        let mut path = Vec::new();
        while let Some(edge) = last[vertex][parity] {
            path.extend(self.edge_of(edge));
            vertex = self.edges.other_end(edge, vertex);
            parity ^= usize::from(is_crossed[edge]);
        }
        path.sort_unstable();
        // a ring within the island and the slit that leads to it and back
        path.dedup();
        path
    }

    /// The edge of the mesh that an edge is.
    fn edge_of(&self, edge: Edge) -> Option<Edge> {
        let [a, b] = self.edges.ends(edge).map(|vertex| self.island.vertex_of[vertex]);
        self.mesh.edges.between(a, b)
    }

    /// Whether a path of faces from the first set to the second crosses each edge.
    fn crossings(&self, seeds: &[Vec<Face>; 2]) -> Vec<bool> {
        let mut before: Vec<Option<Corner>> = vec![None; self.n_faces()];
        let mut is_reached = vec![false; self.n_faces()];
        seeds[0].iter().for_each(|&face| is_reached[face] = true);
        let mut pending: VecDeque<Face> = seeds[0].iter().copied().collect();
        while let Some(face) = pending.pop_front() {
            for corner in face.corners() {
                let across = self.island.mesh.opposite(corner).map(Corner::face);
                if let Some(neighbor) = across.filter(|&neighbor| !is_reached[neighbor]) {
                    is_reached[neighbor] = true;
                    before[neighbor] = Some(corner);
                    pending.push_back(neighbor);
                }
            }
        }
        let mut is_crossed = vec![false; self.edges.len()];
        let mut face = seeds[1][0];
        while let Some(corner) = before[face] {
            is_crossed[self.edges.opposite_to(corner)] = true;
            face = corner.face();
        }
        is_crossed
    }

    /// The cost of each edge in units that hide noise; none of the border, within a set of faces and where the cost is
    /// infinite.
    fn prices(&self, seeds: &[Vec<Face>; 2], cost: &[f64]) -> Vec<Option<u64>> {
        let mut seed_of = vec![None; self.n_faces()];
        for (side, seed) in seeds.iter().enumerate() {
            seed.iter().for_each(|&face| seed_of[face] = Some(side));
        }
        let open_cost = |edge: Edge| {
            let (first, second) = self.edges.sides(edge);
            let [first, second] = [seed_of[first.face()], seed_of[second?.face()]];
            let cost = cost[self.edge_of(edge)?];
            ((first.is_none() || first != second) && cost.is_finite()).then_some(cost)
        };
        let costs: Vec<Option<f64>> = self.edges.all().map(open_cost).collect();
        let mut open: Vec<f64> = costs.iter().flatten().copied().collect();
        let middle = open.len() / 2;
        let median =
            if open.is_empty() { 1.0 } else { *open.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let price = |cost: f64| (MEDIAN_PRICE * cost / median).clamp(1.0, GREATEST_PRICE).round() as u64;
        costs.into_iter().map(|cost| cost.map(price)).collect()
    }
}

/// The sheets of an island: overlapping faces joined over edges within it.
struct Sheets {
    /// The sheet of each face, numbered by their lowest faces; [`Sheets::NONE`] where nothing overlaps it.
    of_face: Vec<u32>,
}

impl Sheets {
    const NONE: u32 = u32::MAX;

    fn new(disk: &Disk<'_>, overlap: &Overlap) -> Self {
        let mut overlaps = vec![false; disk.n_faces()];
        overlap.pairs.as_flattened().iter().for_each(|&face| overlaps[face] = true);
        let mut of_face = vec![Self::NONE; disk.n_faces()];
        let mut n_sheets = 0;
        for seed in Face::all(disk.n_faces()) {
            if !overlaps[seed] || of_face[seed] != Self::NONE {
                continue;
            }
            of_face[seed] = n_sheets;
            let mut pending = vec![seed];
            while let Some(face) = pending.pop() {
                for neighbor in disk.island.mesh.neighbors(face) {
                    if overlaps[neighbor] && of_face[neighbor] == Self::NONE {
                        of_face[neighbor] = n_sheets;
                        pending.push(neighbor);
                    }
                }
            }
            n_sheets += 1;
        }
        Self { of_face }
    }

    /// The sheets of a pair of faces, the lower one first.
    fn of_pair(&self, pair: [Face; 2]) -> [u32; 2] {
        let [a, b] = pair.map(|face| self.of_face[face]);
        [a.min(b), a.max(b)]
    }

    /// The pairs of sheets that overlap, those that share the most area first.
    fn ranked(&self, overlap: &Overlap) -> Vec<[u32; 2]> {
        let mut areas = BTreeMap::new();
        for (&pair, area) in overlap.pairs.iter().zip(&overlap.pair_areas) {
            *areas.entry(self.of_pair(pair)).or_insert(0.0) += area;
        }
        let mut ranked: Vec<([u32; 2], f64)> = areas.into_iter().collect();
        // mirror images share the same area, up to the accuracy of the map
        let rank = |area: f64| (area as f32).to_bits() >> NOISY_BITS;
        ranked.sort_by_key(|&(_, area)| Reverse(rank(area)));
        ranked.into_iter().map(|(pair, _)| pair).collect()
    }

    /// The faces of each of two sheets, or two faces of one that overlaps itself.
    fn seeds(&self, disk: &Disk<'_>, overlap: &Overlap, sheets: [u32; 2]) -> [Vec<Face>; 2] {
        if sheets[0] == sheets[1] {
            return self.farthest_pair(disk, overlap, sheets[0]).map(|face| vec![face]);
        }
        let faces = Face::all(self.of_face.len());
        sheets.map(|sheet| faces.clone().filter(|&face| self.of_face[face] == sheet).collect())
    }

    /// The overlapping faces of one sheet that are the farthest apart, by repeated sweeps.
    fn farthest_pair(&self, disk: &Disk<'_>, overlap: &Overlap, sheet: u32) -> [Face; 2] {
        let pairs: Vec<[Face; 2]> =
            overlap.pairs.iter().copied().filter(|&pair| self.of_pair(pair) == [sheet; 2]).collect();
        // a sweep starts from an end of the sheet
        let from_first = disk.distances(&pairs[0][..1]);
        let farther =
            |best: Face, face: Face| if from_first[face] > FARTHER * from_first[best] { face } else { best };
        let end = pairs.as_flattened().iter().copied().fold(pairs[0][0], farther);
        let (mut farthest, mut greatest) = (pairs[0], 0.0);
        let mut start = end;
        for _ in 0..SWEEPS {
            // two faces are at least as far apart as their distances from a third differ
            let distances = disk.distances(&[start]);
            let apart = |pair: [Face; 2]| (distances[pair[0]] - distances[pair[1]]).abs();
            let farther = |best, pair| if apart(pair) > FARTHER * apart(best) { pair } else { best };
            let pair = pairs.iter().copied().fold(farthest, farther);
            if apart(pair) <= greatest {
                break;
            }
            (farthest, greatest, start) = (pair, apart(pair), pair[0]);
        }
        farthest
    }
}

#[cfg(test)]
mod tests {
    use super::super::overlap::overlap;
    use super::super::overlap::tests::{Ramp, vertex};
    use super::*;

    /// The two edges across the ramp before a column.
    fn across(ramp: &Ramp, column: u32) -> Vec<Edge> {
        let edge = |row| ramp.mesh.edges.between(vertex(column, row), vertex(column, row + 1)).unwrap();
        let mut edges = vec![edge(0), edge(1)];
        edges.sort_unstable();
        edges
    }

    /// The chord of the first island.
    fn first_chord(ramp: &Ramp, cut: &Cut, cost: &[f64]) -> Option<Vec<Edge>> {
        let island = ramp.islands(cut).remove(0);
        chord(&ramp.mesh, cut, cost, &island, &overlap(&island))
    }

    #[test]
    fn the_chord_parts_the_sheets_at_the_waist() {
        for waist in [12, 23, 36] {
            let ramp = Ramp::new(50, Some(waist), false);
            let uncut = Cut::none(&ramp.mesh);
            let chord = first_chord(&ramp, &uncut, &ramp.mesh.lengths).unwrap();
            assert_eq!(chord, across(&ramp, waist));
            let cut = uncut.with(&chord);
            let islands = ramp.islands(&cut);
            assert_eq!(islands.len(), 2);
            assert!(islands.iter().all(|island| overlap(island).pairs.is_empty()));
        }
    }

    #[test]
    fn edges_of_infinite_cost_stay_whole() {
        let ramp = Ramp::new(50, Some(23), false);
        let uncut = Cut::none(&ramp.mesh);
        let mut cost = ramp.mesh.lengths.clone();
        // the chord moves from the waist to the next narrow place
        cost[across(&ramp, 23)[1]] = f64::INFINITY;
        across(&ramp, 31).iter().for_each(|&edge| cost[edge] *= 0.95);
        assert_eq!(first_chord(&ramp, &uncut, &cost).unwrap(), across(&ramp, 31));
        assert_eq!(first_chord(&ramp, &uncut, &vec![f64::INFINITY; cost.len()]), None);
    }

    #[test]
    fn noise_of_the_last_digits_moves_no_chord() {
        let ramp = Ramp::new(50, None, false);
        let uncut = Cut::none(&ramp.mesh);
        let noisy: Vec<f64> =
            (0_u32..).zip(&ramp.mesh.lengths).map(|(k, x)| x * (1.0 + 1e-12 * f64::from(k).sin())).collect();
        let chord = first_chord(&ramp, &uncut, &ramp.mesh.lengths);
        assert!(chord.is_some());
        assert_eq!(chord, first_chord(&ramp, &uncut, &noisy));
    }

    #[test]
    fn a_sheet_that_overlaps_itself_is_parted_again_and_again() {
        let ramp = Ramp::new(130, None, true);
        let mut cut = Cut::none(&ramp.mesh);
        for _ in 0..8 {
            let islands = ramp.islands(&cut);
            let overlaps: Vec<Overlap> = islands.iter().map(overlap).collect();
            for (island, overlap) in
                islands.iter().zip(&overlaps).filter(|(_, overlap)| !overlap.pairs.is_empty())
            {
                cut.add(&chord(&ramp.mesh, &cut, &ramp.mesh.lengths, island, overlap).unwrap());
            }
        }
        let islands = ramp.islands(&cut);
        assert!(islands.iter().all(|island| overlap(island).pairs.is_empty()));
        // four islands of less than a turn are the fewest possible
        assert!(islands.len() <= 6, "{}", islands.len());
        assert!(cut.islands(&ramp.mesh).least_area() >= LEAST_AREA);
    }

    #[test]
    fn chords_are_the_least_cuts_of_all_sets_of_faces() {
        let ramp = Ramp::new(4, None, false);
        let uncut = Cut::none(&ramp.mesh);
        let island = ramp.islands(&uncut).remove(0);
        let disk = Disk::new(&ramp.mesh, &island);
        // a linear congruential generator
        let mut state = 3_u64;
        let mut random = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % n
        };
        for _ in 0..12 {
            let cost: Vec<f64> = ramp.mesh.lengths.iter().map(|_| 1.0 + random(100) as f64).collect();
            let [first, second] = [random(16) as usize, random(16) as usize];
            if first == second {
                continue;
            }
            let chord =
                disk.cheapest_chord(&[first, second].map(|face| vec![Face::new(face)]), &cost).unwrap();
            let parts = uncut.with(&chord).islands(&ramp.mesh);
            assert!(parts.are_disks() && parts.len() == 2);
            assert_ne!(parts.of_face[first], parts.of_face[second]);
            // sets of faces as bits
            let sets = (0_usize..1 << 16).filter(|set| set >> first & 1 == 1 && set >> second & 1 == 0);
            let of_set = |set: usize| -> f64 {
                let is_cut = |edge: &Edge| match ramp.mesh.faces_at(*edge) {
                    (a, Some(b)) => (set >> a.index() & 1) != (set >> b.index() & 1),
                    _ => false,
                };
                ramp.mesh.edges.all().filter(is_cut).map(|edge| cost[edge]).sum()
            };
            let least = sets.map(of_set).fold(f64::INFINITY, f64::min);
            approx::assert_relative_eq!(chord.iter().map(|&edge| cost[edge]).sum::<f64>(), least);
        }
    }

    #[test]
    fn the_ends_of_a_sheet_are_its_farthest_pair() {
        let ramp = Ramp::new(90, None, false);
        let uncut = Cut::none(&ramp.mesh);
        let island = ramp.islands(&uncut).remove(0);
        let overlap = overlap(&island);
        let disk = Disk::new(&ramp.mesh, &island);
        let sheets = Sheets::new(&disk, &overlap);
        assert_eq!(sheets.ranked(&overlap), [[0, 0]]);
        let pair = sheets.farthest_pair(&disk, &overlap, 0);
        let apart = |[a, b]: [Face; 2]| disk.distances(&[a])[b];
        let greatest = overlap.pairs.iter().map(|&pair| apart(pair)).fold(0.0, f64::max);
        assert!(apart(pair) > 0.999 * greatest, "{} {greatest}", apart(pair));
    }
}
