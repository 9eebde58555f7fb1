// SPDX-License-Identifier: MIT OR Apache-2.0
//! Seams of the proxy carried to the mesh that it stands for.
//!
//! Each segment, the longest first, becomes the cheapest path between the vertices for which its ends stand. An edge
//! costs 1 + (d / 1.2 h)² times as much at the distance d from the segment, h the mean length of the proxy's seams; far
//! from the segment and along paths that lie there already it costs thousands of times as much. Turns cost too, on
//! paths of directed edges: so seams follow loops of edges where there are any, in place of stairs.
//!
//! Where both meshes are symmetric, one segment of each pair is lifted and mirrored, and half of a segment that is its own
//! image.
//!
//! Cost: O(e' log e') a segment, e' the edges near to it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::cut::{Cut, Segment};
use super::edge_mesh::EdgeMesh;
use crate::control::Watch;
use crate::error::Error;
use crate::mesh::ties::on_cost_grid;
use crate::mesh::{Edge, Vertex};
use crate::vector::Vector3;

/// Half the width of the corridor around a segment in which edges cost up to twice as much, over h.
const CORRIDOR: f64 = 1.2;

/// The distance from a segment beyond which edges are dear, over h; and their factor.
const FAR: f64 = 3.0;
const FAR_FACTOR: f64 = 1e3;

/// The factor of edges at vertices of other seams.
const TAKEN_FACTOR: f64 = 1e4;

/// A path follows the bends of a segment where that is longer than the straight line by more than this factor.
const BEND: f64 = 1.4;

/// τ, the cost of a turn by 90° over the median edge, and the power of the angle.
const TURN: f64 = 0.35;
const TURN_POWER: f64 = 1.5;

/// What is lifted, and where to.
pub(super) struct Lift<'a> {
    pub fine: &'a EdgeMesh,
    pub proxy: &'a EdgeMesh,
    /// The cost of a seam along each edge of the fine mesh.
    pub cost: &'a [f64],
    /// The fine vertex for which each proxy vertex stands.
    pub nearest: &'a [Vertex],
    /// The mirror images of the vertices of both meshes, where both are symmetric.
    pub mirrors: Option<Mirrors<'a>>,
}

/// The mirror images of the vertices of two meshes.
#[derive(Clone, Copy)]
pub(super) struct Mirrors<'a> {
    pub fine: &'a [Vertex],
    pub proxy: &'a [Vertex],
}

impl Lift<'_> {
    /// The seams on the fine mesh.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`].
    pub(super) fn of(&self, cut: &Cut, watch: &Watch<'_>) -> Result<Cut, Error> {
        let mut segments = cut.segments(self.proxy);
        let length = |segment: &Segment| -> f64 {
            segment.edges.iter().map(|&edge| on_cost_grid(self.proxy.lengths[edge])).sum()
        };
        segments.sort_by(|a, b| length(b).total_cmp(&length(a)));
        let reach = cut.sum(&self.proxy.lengths) / cut.seams().count().max(1) as f64;
        let mut paths = PathFinder::new(self, reach * self.fine.unit);
        let mut lifted = Cut::none(self.fine);
        let mut is_taken = vec![false; self.fine.n_vertices()];
        for segment in &self.without_images(&segments) {
            let mut edges = Vec::new();
            for ends in self.stops(segment).windows(2) {
                if !watch.goes_on() {
                    return Err(Error::CancelledEarly);
                }
                edges.extend(paths.cheapest([ends[0], ends[1]], segment, &is_taken));
            }
            if let Some(mirrors) = self.mirrors.filter(|_| !self.is_in_plane(segment)) {
                let images: Vec<_> =
                    edges.iter().filter_map(|&edge| image(self.fine, edge, mirrors.fine)).collect();
                edges.extend(images);
            }
            edges.retain(|&edge| !self.fine.edges.is_boundary(edge));
            for &edge in &edges {
                self.fine.edges.ends(edge).iter().for_each(|&vertex| is_taken[vertex] = true);
            }
            lifted.add(&edges);
        }
        Ok(lifted)
    }

    /// The segments but those that are the mirror image of an earlier one, and half of each that is its own image.
    fn without_images(&self, segments: &[Segment]) -> Vec<Segment> {
        let Some(mirrors) = self.mirrors else { return segments.to_vec() };
        let mut kept: Vec<Segment> = Vec::new();
        let mut is_covered = vec![false; self.proxy.n_edges()];
        for segment in segments {
            if segment.edges.iter().all(|&edge| is_covered[edge]) {
                continue;
            }
            for &edge in &segment.edges {
                let image = image(self.proxy, edge, mirrors.proxy);
                [Some(edge), image].into_iter().flatten().for_each(|edge| is_covered[edge] = true);
            }
            kept.push(self.half_of(segment).unwrap_or_else(|| segment.clone()));
        }
        kept
    }

    /// Half of a segment that crosses the mirror plane at a vertex and is its own mirror image.
    fn half_of(&self, segment: &Segment) -> Option<Segment> {
        let mirror = self.mirrors?.proxy;
        let middle = segment.edges.len() / 2;
        let mut pairs = segment.vertices.iter().zip(segment.vertices.iter().rev());
        let crosses = !self.is_in_plane(segment) && pairs.all(|(&vertex, &image)| mirror[vertex] == image);
        (crosses && segment.edges.len() == 2 * middle).then(|| Segment {
            vertices: segment.vertices[..=middle].to_vec(),
            edges: segment.edges[..middle].to_vec(),
        })
    }

    /// Whether every vertex of a segment is its own mirror image.
    fn is_in_plane(&self, segment: &Segment) -> bool {
        self.mirrors
            .is_some_and(|mirrors| segment.vertices.iter().all(|&vertex| mirrors.proxy[vertex] == vertex))
    }

    /// The fine vertices that the path of a segment visits: the ends, and vertices between them where the segment bends,
    /// so that the path goes the same way around limbs.
    fn stops(&self, segment: &Segment) -> Vec<Vertex> {
        let line: Vec<_> = segment.vertices.iter().map(|&vertex| self.proxy.mesh.points()[vertex]).collect();
        let mut places = vec![0];
        add_bends(&line, 0, line.len() - 1, &mut places);
        let mut stops: Vec<_> =
            places.into_iter().map(|place| self.nearest[segment.vertices[place]]).collect();
        stops.dedup();
        stops
    }
}

/// Adds places between which a line is nearly straight, and its last place.
fn add_bends(line: &[Vector3], first: usize, last: usize, places: &mut Vec<usize>) {
    let straight = line[first].distance(line[last]);
    let length: f64 = line[first..=last].windows(2).map(|ends| ends[0].distance(ends[1])).sum();
    if length <= BEND * straight || last - first < 2 {
        places.push(last);
        return;
    }
    let ends = [line[first], line[last]];
    let distance = |place: &usize| distance_to(&ends, line[*place]);
    let farthest = (first + 1..last).max_by(|a, b| distance(a).total_cmp(&distance(b)).then(b.cmp(a)));
    let middle = farthest.unwrap_or(first + 1);
    add_bends(line, first, middle, places);
    add_bends(line, middle, last, places);
}

/// The mirror image of an edge, if it is an edge.
pub(super) fn image(mesh: &EdgeMesh, edge: Edge, mirror: &[Vertex]) -> Option<Edge> {
    let [a, b] = mesh.edges.ends(edge);
    mesh.edges.between(mirror[a], mirror[b])
}

/// Cheapest paths of directed edges with turns. Edge e has the directions 2 e, from its lower end, and 2 e + 1.
struct PathFinder<'a> {
    fine: &'a EdgeMesh,
    proxy: &'a EdgeMesh,
    cost: &'a [f64],
    reach: f64,
    /// The cost of a turn by 90°.
    turn: f64,
    costs: Vec<f64>,
    before: Vec<Option<u32>>,
    touched: Vec<u32>,
}

impl<'a> PathFinder<'a> {
    fn new(lift: &Lift<'a>, reach: f64) -> Self {
        let n = 2 * lift.fine.n_edges();
        Self {
            fine: lift.fine,
            proxy: lift.proxy,
            cost: lift.cost,
            reach,
            turn: TURN * lift.fine.median_length(),
            costs: vec![f64::INFINITY; n],
            before: vec![None; n],
            touched: Vec::new(),
        }
    }

    /// The cheapest path near to a segment; empty where there is none.
    fn cheapest(&mut self, [from, to]: [Vertex; 2], segment: &Segment, is_taken: &[bool]) -> Vec<Edge> {
        let line: Vec<_> = segment.vertices.iter().map(|&vertex| self.proxy.mesh.points()[vertex]).collect();
        let is_blocked = |vertex: Vertex| is_taken[vertex] && vertex != from && vertex != to;
        let mut queue = BinaryHeap::new();
        for &(_, edge) in self.fine.edges.around(from) {
            let step = self.step(edge, &line, is_blocked);
            self.reach(directed(self.fine, edge, from), step, None, &mut queue);
        }
        let mut last = None;
        while let Some(Reverse((bits, edge))) = queue.pop() {
            let reached = f64::from_bits(bits);
            if reached > self.costs[edge as usize] {
                continue;
            }
            let head = self.head(edge);
            if head == to {
                last = Some(edge);
                break;
            }
            for &(_, next) in self.fine.edges.around(head) {
                if next.0 != edge / 2 {
                    let onward = directed(self.fine, next, head);
                    let step = self.step(next, &line, is_blocked) + self.turning_cost(edge, onward);
                    self.reach(onward, reached + step, Some(edge), &mut queue);
                }
            }
        }
        self.traced(last)
    }

    fn reach(
        &mut self,
        edge: u32,
        cost: f64,
        before: Option<u32>,
        queue: &mut BinaryHeap<Reverse<(u64, u32)>>,
    ) {
        if cost < self.costs[edge as usize] {
            self.costs[edge as usize] = cost;
            self.before[edge as usize] = before;
            self.touched.push(edge);
            queue.push(Reverse((cost.to_bits(), edge)));
        }
    }

    /// The edges that lead to the last one, and a clean slate.
    fn traced(&mut self, mut last: Option<u32>) -> Vec<Edge> {
        let mut edges = Vec::new();
        while let Some(edge) = last {
            edges.push(Edge(edge / 2));
            last = self.before[edge as usize];
        }
        for edge in self.touched.drain(..) {
            self.costs[edge as usize] = f64::INFINITY;
            self.before[edge as usize] = None;
        }
        edges.reverse();
        edges
    }

    /// The cost of an edge near to a line.
    fn step(&self, edge: Edge, line: &[Vector3], is_blocked: impl Fn(Vertex) -> bool) -> f64 {
        let ends = self.fine.edges.ends(edge);
        let [a, b] = ends.map(|vertex| self.fine.mesh.points()[vertex]);
        let distance = distance_to(line, (a + b) * 0.5) / self.reach;
        let mut cost = self.cost[edge] * (1.0 + (distance / CORRIDOR).powi(2));
        if ends.into_iter().any(is_blocked) {
            cost *= TAKEN_FACTOR;
        }
        on_cost_grid(if distance > FAR { cost * FAR_FACTOR } else { cost })
    }

    fn turning_cost(&self, from: u32, to: u32) -> f64 {
        let cosine = self.direction(from).dot(self.direction(to)).clamp(-1.0, 1.0);
        on_cost_grid(self.turn * (cosine.acos() / std::f64::consts::FRAC_PI_2).powf(TURN_POWER))
    }

    fn direction(&self, edge: u32) -> Vector3 {
        let [a, b] = self.fine.edges.ends(Edge(edge / 2)).map(|vertex| self.fine.mesh.points()[vertex]);
        if edge.is_multiple_of(2) { (b - a).normalized() } else { (a - b).normalized() }
    }

    fn head(&self, edge: u32) -> Vertex {
        let [low, high] = self.fine.edges.ends(Edge(edge / 2));
        if edge.is_multiple_of(2) { high } else { low }
    }
}

/// An edge in the direction away from one of its ends.
fn directed(mesh: &EdgeMesh, edge: Edge, tail: Vertex) -> u32 {
    2 * edge.0 + u32::from(mesh.edges.ends(edge)[0] != tail)
}

/// The distance of a point from a polyline.
fn distance_to(line: &[Vector3], point: Vector3) -> f64 {
    let to_segment = |ends: &[Vector3]| {
        let (along, beside) = (ends[1] - ends[0], point - ends[0]);
        let place = (beside.dot(along) / along.dot(along).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        beside.distance(along * place)
    };
    line.windows(2).map(to_segment).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::seams::paths::Paths;
    use crate::seams::proxy::{Proxy, proxy};
    use crate::seams::sample_surfaces::{body, flat_grid};
    use crate::seams::symmetry::{mirror_plane, mirror_vertices};

    /// Lifts a path of the vertices (i, j) of a grid of 4 × 4 quads to one of 16 × 16, both over the same square.
    fn lifted(path: &[[u32; 2]], is_free: impl Fn([Vector3; 2]) -> bool) -> Vec<[[u32; 2]; 2]> {
        let [coarse, fine] = [4, 16].map(|n| EdgeMesh::new(flat_grid(n, n)));
        let nearest: Vec<_> = (0..25).map(|k| Vertex(4 * (k % 5) + 17 * 4 * (k / 5))).collect();
        let points = fine.mesh.points();
        let price = |edge| {
            let is_open = is_free(fine.edges.ends(edge).map(|vertex| points[vertex]));
            if is_open { fine.lengths[edge] } else { f64::INFINITY }
        };
        let cost: Vec<_> = fine.edges.all().map(price).collect();
        let lift = Lift { fine: &fine, proxy: &coarse, cost: &cost, nearest: &nearest, mirrors: None };
        let path: Vec<_> = path.iter().map(|[i, j]| Vertex(i + 5 * j)).collect();
        let cut = Cut::none(&coarse).with(&coarse.path_edges(&path));
        let seams = lift.of(&cut, &Watch::new(&mut Silent, 0.0, "")).unwrap();
        let place = |vertex: Vertex| [vertex.0 % 17, vertex.0 / 17];
        seams.seams().map(|edge| fine.edges.ends(edge).map(place)).collect()
    }

    fn is_along_an_axis([a, b]: [Vector3; 2]) -> bool {
        (a[0] - b[0]).abs() < 1e-9 || (a[1] - b[1]).abs() < 1e-9
    }

    #[test]
    fn a_straight_seam_stays_straight() {
        let expected: Vec<_> = (0..16).map(|i| [[i, 8], [i + 1, 8]]).collect();
        assert_eq!(lifted(&[[0, 2], [1, 2], [2, 2], [3, 2], [4, 2]], |_| true), expected);
        // the diagonal of the quads
        let expected: Vec<_> = (4..12).map(|i| [[i, i], [i + 1, i + 1]]).collect();
        assert_eq!(lifted(&[[1, 1], [2, 2], [3, 3]], |_| true), expected);
    }

    #[test]
    fn a_seam_across_the_edges_takes_few_turns() {
        let seams = lifted(&[[1, 1], [2, 2], [3, 3]], is_along_an_axis);
        assert_eq!(seams.len(), 16);
        let is_horizontal = |[[_, j], [_, l]]: &[[u32; 2]; 2]| j == l;
        // stairs have 15 turns
        let mut order = seams.clone();
        order.sort_by_key(|[a, _]| a[0] + a[1]);
        let turns =
            order.windows(2).filter(|pair| is_horizontal(&pair[0]) != is_horizontal(&pair[1])).count();
        assert!(turns <= 7, "{turns} turns: {order:?}");
    }

    #[test]
    fn a_seam_of_bends_follows_them() {
        // around three sides of a square, not across it
        let path = [[1, 1], [2, 1], [3, 1], [3, 2], [3, 3], [2, 3], [1, 3]];
        let seams = lifted(&path, |_| true);
        for corner in [[4, 4], [12, 12], [4, 12], [10, 4], [12, 8], [6, 12]] {
            let is_near = |place: &[u32; 2]| place.iter().zip(corner).all(|(x, y)| x.abs_diff(y) <= 1);
            assert!(seams.iter().flatten().any(is_near), "{corner:?}: {seams:?}");
        }
    }

    #[test]
    fn mirrored_seams_stay_mirrored() {
        let surface = body(5);
        let plane = mirror_plane(&surface).unwrap();
        let Proxy { mesh: coarse, nearest, mirror, .. } = proxy(&surface, Some(&plane), &mut Silent).unwrap();
        let [fine, coarse] = [surface, coarse].map(EdgeMesh::new);
        let (mirror, fine_mirror) = (mirror.unwrap(), mirror_vertices(&fine.mesh, &plane).unwrap());
        let paths = Paths::from(&coarse, &[Vertex(0)], &coarse.lengths);
        let far = Vertex::all(coarse.n_vertices())
            .filter(|&v| mirror[v] != v)
            .max_by(|&a, &b| paths.costs[a].total_cmp(&paths.costs[b]).then(b.cmp(&a)));
        let path = paths.to(&coarse, far.unwrap());
        let images = path.iter().filter_map(|&edge| image(&coarse, edge, &mirror)).collect::<Vec<_>>();
        assert_eq!(path.len(), images.len());
        let mirrors = Some(Mirrors { fine: &fine_mirror, proxy: &mirror });
        let lift = Lift { fine: &fine, proxy: &coarse, cost: &fine.lengths, nearest: &nearest, mirrors };
        let cut = Cut::none(&coarse).with(&path).with(&images);
        let seams = lift.of(&cut, &Watch::new(&mut Silent, 0.0, "")).unwrap();
        assert!(seams.seams().count() > path.len());
        assert!(seams.seams().all(|edge| seams.is_seam(image(&fine, edge, &fine_mirror).unwrap())));
    }

    #[test]
    fn the_distance_from_a_line_is_that_from_its_nearest_point() {
        let line = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0]].map(Vector3);
        for (point, expected) in
            [([1.0, 0.0, 3.0], 3.0), ([-3.0, 4.0, 0.0], 5.0), ([3.0, 3.0, 1.0], 3f64.sqrt())]
        {
            assert!((distance_to(&line, Vector3(point)) - expected).abs() < 1e-12, "{point:?}");
        }
    }
}
