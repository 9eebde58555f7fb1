// SPDX-License-Identifier: MIT OR Apache-2.0
//! Faces of an island whose images cover the same place of the plane.
//!
//! 1. A map of a disk without folds is one-to-one where its outline is simple: every point is covered as many times as
//!    the outline winds around it.
//! 2. Otherwise a grid lists the pairs of faces whose boxes overlap.
//! 3. The interiors of two triangles are disjoint if and only if the line of a side of one of them separates them, which
//!    exact orientations decide; the area of their intersection is that of a clipped polygon (I. E. Sutherland,
//!    G. W. Hodgman, Reentrant polygon clipping, Communications of the ACM 17, 1974), up to rounding.
//!
//! Cost: linear in the faces, plus one comparison for every two boxes in one cell of the grid.

use robust::{Coord, orient2d};

use super::maps::IslandMap;
use crate::mesh::polygon::is_simple_outline;
use crate::mesh::{Face, Vertex};

/// An island of which a smaller share is covered twice touches itself, up to rounding: no texel is as small.
const TOUCH: f64 = 1e-10;

type Point = [f64; 2];
type Triangle = [Point; 3];

/// The overlap of an island with itself.
#[derive(Debug, Clone, Default)]
pub(super) struct Overlap {
    /// The faces of the island whose images share interior points, the lower face first, ascending.
    pub pairs: Vec<[Face; 2]>,
    /// The area that the images of each pair share, (p,).
    pub pair_areas: Vec<f64>,
    /// The sum of `pair_areas` over the covered area. That is the share of the covered area that is covered twice; a
    /// place covered k times counts k(k − 1)/2 times.
    pub share: f64,
}

/// The overlap of a mapped island with itself; none where it touches itself only.
pub(super) fn overlap(island: &IslandMap) -> Overlap {
    let triangles: Vec<Triangle> =
        island.mesh.faces().iter().map(|&face| face.map(|vertex| island.uv[vertex])).collect();
    // 1. One-to-one maps
    if is_one_to_one(island, &triangles) {
        return Overlap::default();
    }
    // 2. and 3. Pairs of faces
    let (pairs, pair_areas): (Vec<_>, Vec<_>) = overlapping_pairs(&triangles).into_iter().unzip();
    let total: f64 = triangles.iter().map(|triangle| polygon_area(triangle).abs()).sum();
    let shared: f64 = pair_areas.iter().sum();
    let share = shared / covered_area(total, shared);
    if share < TOUCH { Overlap::default() } else { Overlap { pairs, share, pair_areas } }
}

/// The area of a union of triangles, from the sums of their areas and of the areas that two of them share; where three
/// of them meet, a lower bound.
fn covered_area(total: f64, shared: f64) -> f64 {
    // with k triangles over a point, ∫k = total and ∫k² = total + 2 shared: k − k(k − 1)/2 ≤ 1 gives the first bound,
    // the inequality of Cauchy and Schwarz the second, which is never 0
    (total - shared).max(total * total / (total + 2.0 * shared))
}

/// Whether the winding of the outline proves the map one-to-one.
fn is_one_to_one(island: &IslandMap, triangles: &[Triangle]) -> bool {
    let mesh = &island.mesh;
    if !mesh.topology().is_disk() || triangles.iter().any(|&[a, b, c]| orientation(a, b, c) <= 0.0) {
        return false;
    }
    let outline: Vec<Point> =
        mesh.boundary_loops().iter().flatten().map(|&v: &Vertex| island.uv[v]).collect();
    let next: Vec<usize> = (0..outline.len()).map(|k| (k + 1) % outline.len()).collect();
    is_simple_outline(&outline, &next)
}

/// The pairs of triangles whose interiors intersect, ascending, with the areas that they share. A triangle without area
/// has no interior.
fn overlapping_pairs(triangles: &[Triangle]) -> Vec<([Face; 2], f64)> {
    let oriented = |&[a, b, c]: &Triangle| {
        let turn = orientation(a, b, c);
        if turn > 0.0 {
            Some([a, b, c])
        } else if turn < 0.0 {
            Some([a, c, b])
        } else {
            None
        }
    };
    let faces = Face::all(triangles.len());
    let (faces, triangles): (Vec<Face>, Vec<Triangle>) =
        faces.zip(triangles).filter_map(|(face, triangle)| Some((face, oriented(triangle)?))).unzip();
    let mut pairs = Vec::new();
    for_each_candidate(&triangles, |i, j| {
        let pair = [&triangles[i], &triangles[j]];
        if interiors_intersect(pair) {
            pairs.push(([faces[i], faces[j]], shared_area(pair)));
        }
    });
    pairs.sort_unstable_by_key(|&(pair, _)| pair);
    pairs
}

/// Twice the signed area of a triangle; its sign is exact.
fn orientation(a: Point, b: Point, c: Point) -> f64 {
    let [a, b, c] = [a, b, c].map(|[x, y]| Coord { x, y });
    orient2d(a, b, c)
}

/// Whether the interiors of two counterclockwise triangles intersect.
fn interiors_intersect([first, second]: [&Triangle; 2]) -> bool {
    let separates = |triangle: &Triangle, other: &Triangle| {
        (0..3).any(|k| {
            let [from, to] = [triangle[k], triangle[(k + 1) % 3]];
            other.iter().all(|&point| orientation(from, to, point) <= 0.0)
        })
    };
    !separates(first, second) && !separates(second, first)
}

/// The area of the intersection of two counterclockwise triangles.
fn shared_area([first, second]: [&Triangle; 2]) -> f64 {
    // the corners are taken from one of their own, so that little cancels
    let origin = first[0];
    let moved = |point: Point| [point[0] - origin[0], point[1] - origin[1]];
    let (clip, mut polygon) = (first.map(moved), second.map(moved).to_vec());
    for k in 0..3 {
        polygon = clipped(&polygon, clip[k], clip[(k + 1) % 3]);
    }
    polygon_area(&polygon).max(0.0)
}

/// What of a convex polygon lies on the left of a line.
fn clipped(polygon: &[Point], from: Point, to: Point) -> Vec<Point> {
    let height = |[x, y]: Point| (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0]);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &point) in polygon.iter().enumerate() {
        let next = polygon[(k + 1) % polygon.len()];
        let [here, there] = [height(point), height(next)];
        if here >= 0.0 {
            kept.push(point);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            let t = here / (here - there);
            kept.push([0, 1].map(|axis| point[axis] + t * (next[axis] - point[axis])));
        }
    }
    kept
}

/// The signed area of a polygon.
fn polygon_area(corners: &[Point]) -> f64 {
    let Some(&[x, y]) = corners.first() else { return 0.0 };
    let doubled = corners.windows(2).map(|side| {
        let [[x1, y1], [x2, y2]] = [side[0], side[1]];
        (x1 - x) * (y2 - y) - (y1 - y) * (x2 - x)
    });
    0.5 * doubled.sum::<f64>()
}

/// An axis-parallel box.
#[derive(Clone, Copy)]
struct Extent {
    low: Point,
    high: Point,
}

impl Extent {
    fn of(points: &[Point]) -> Self {
        let nothing = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
        points.iter().fold(nothing, |Self { low, high }, x| Self {
            low: [low[0].min(x[0]), low[1].min(x[1])],
            high: [high[0].max(x[0]), high[1].max(x[1])],
        })
    }

    /// The lower corner of the intersection of two boxes whose interiors intersect.
    fn meets(&self, other: &Self) -> Option<Point> {
        let low = [0, 1].map(|axis| self.low[axis].max(other.low[axis]));
        let is_inside = (0..2).all(|axis| low[axis] < self.high[axis].min(other.high[axis]));
        is_inside.then_some(low)
    }
}

/// A grid of squares, about as many as there are boxes.
struct Grid {
    low: Point,
    cell: f64,
    shape: [usize; 2],
}

impl Grid {
    fn new(extents: &[Extent]) -> Self {
        let corners: Vec<Point> = extents.iter().flat_map(|extent| [extent.low, extent.high]).collect();
        let Extent { low, high } = Extent::of(&corners);
        let [width, height] = [high[0] - low[0], high[1] - low[1]];
        let n = extents.len() as f64;
        // the second term keeps the grid of a narrow strip small
        let cell = (width * height / n).sqrt().max((width + height) / n);
        let mut grid = Self { low, cell, shape: [1, 1] };
        grid.shape = grid.place(high).map(|k| k + 1);
        grid
    }

    fn place(&self, point: Point) -> [usize; 2] {
        [0, 1].map(|axis| ((point[axis] - self.low[axis]) / self.cell) as usize)
    }

    /// The cell of a point.
    fn cell_of(&self, point: Point) -> usize {
        let [column, row] = self.place(point);
        row * self.shape[0] + column
    }

    /// The cells that a box touches.
    fn cells(&self, extent: &Extent) -> impl Iterator<Item = usize> + use<> {
        let ([left, low], [right, high], width) =
            (self.place(extent.low), self.place(extent.high), self.shape[0]);
        (low..=high).flat_map(move |row| (left..=right).map(move |column| row * width + column))
    }
}

/// Calls `visit` once for every two triangles whose boxes overlap, the lower one first.
fn for_each_candidate(triangles: &[Triangle], mut visit: impl FnMut(usize, usize)) {
    let extents: Vec<Extent> = triangles.iter().map(|triangle| Extent::of(triangle)).collect();
    if extents.is_empty() {
        return;
    }
    // 1. Sort the triangles into the cells
    let grid = Grid::new(&extents);
    let mut starts = vec![0_usize; grid.shape[0] * grid.shape[1] + 1];
    extents.iter().flat_map(|extent| grid.cells(extent)).for_each(|cell| starts[cell + 1] += 1);
    for cell in 1..starts.len() {
        starts[cell] += starts[cell - 1];
    }
    let mut free = starts.clone();
    let mut members = vec![0_usize; starts[starts.len() - 1]];
    for (k, extent) in extents.iter().enumerate() {
        for cell in grid.cells(extent) {
            members[free[cell]] = k;
            free[cell] += 1;
        }
    }
    // 2. Compare those in one cell; the cell of the lower corner of their intersection reports them
    for (cell, range) in starts.windows(2).enumerate() {
        let members = &members[range[0]..range[1]];
        for (place, &i) in members.iter().enumerate() {
            for &j in &members[place + 1..] {
                let corner = extents[i].meets(&extents[j]);
                if corner.is_some_and(|corner| grid.cell_of(corner) == cell) {
                    visit(i, j);
                }
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::cut::Cut;
    use super::super::edge_mesh::EdgeMesh;
    use super::super::maps::islands;
    use super::*;
    use crate::mesh::TriangleMesh;

    /// A ramp around a ring of radii 1 and 2, two quads wide, and its map into the plane straight down.
    pub(in super::super) struct Ramp {
        pub mesh: EdgeMesh,
        flat: Vec<Point>,
    }

    impl Ramp {
        /// A ramp of `columns` quads of 1/40 turn each; the edges that start column `waist` are shorter. The diagonals of
        /// quads change their direction after the first turn where `alternates`.
        pub(in super::super) fn new(columns: u32, waist: Option<u32>, alternates: bool) -> Self {
            let point = |column: u32, row: u32| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(column % 40) / 40.0).sin_cos();
                let width = if waist == Some(column) { 0.9 } else { 1.0 };
                let radius = 1.0 + 0.5 * width * f64::from(row);
                [radius * cos, radius * sin]
            };
            let vertices = (0..=columns).flat_map(|column| (0..3).map(move |row| (column, row)));
            let flat: Vec<_> = vertices.clone().map(|(column, row)| point(column, row)).collect();
            let points: Vec<_> =
                vertices.zip(&flat).map(|((column, _), &[x, y])| [x, y, 0.1 * f64::from(column)]).collect();
            let quads = (0..columns).flat_map(|column| (0..2).map(move |row| (column, row)));
            let faces: Vec<_> = quads
                .flat_map(|(column, row)| {
                    let [a, b] = [vertex(column, row), vertex(column, row + 1)];
                    let [c, d] = [vertex(column + 1, row + 1), vertex(column + 1, row)];
                    if alternates && column >= 40 { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
                })
                .collect();
            Self { mesh: EdgeMesh::new(TriangleMesh::new(&points, &faces).unwrap()), flat }
        }

        /// The islands of a cut, laid flat.
        pub(in super::super) fn islands(&self, cut: &Cut) -> Vec<IslandMap> {
            let mut islands = islands(&self.mesh, cut).unwrap();
            for island in &mut islands {
                island.uv = island.vertex_of.iter().map(|&vertex| self.flat[vertex]).collect();
            }
            islands
        }
    }

    /// The vertex of the ramp between two columns, from the inside outward.
    pub(in super::super) fn vertex(column: u32, row: u32) -> Vertex {
        Vertex(3 * column + row)
    }

    /// The ramp of one width as one island.
    fn ramp(columns: u32, alternates: bool) -> IslandMap {
        let ramp = Ramp::new(columns, None, alternates);
        ramp.islands(&Cut::none(&ramp.mesh)).remove(0)
    }

    /// The area of two quads of the ramp side by side.
    fn column_area() -> f64 {
        0.5 * (4.0 - 1.0) * (std::f64::consts::TAU / 40.0).sin()
    }

    #[test]
    fn a_ramp_overlaps_itself_after_a_full_turn() {
        for (columns, alternates, per_quad) in [(50, false, 1), (50, true, 4), (41, true, 4), (79, false, 1)]
        {
            let island = ramp(columns, alternates);
            let overlap = overlap(&island);
            let doubled = columns - 40;
            let faces = |quad: u32| [Face(2 * quad), Face(2 * quad + 1)];
            let mut expected: Vec<[Face; 2]> = (0..2 * doubled)
                .flat_map(|quad| faces(quad).into_iter().zip([faces(quad + 80); 2]).enumerate())
                .flat_map(|(k, (low, high))| {
                    let partners = if per_quad == 4 { high.to_vec() } else { vec![high[k]] };
                    partners.into_iter().map(move |high| [low, high])
                })
                .collect();
            expected.sort_unstable();
            assert_eq!(overlap.pairs, expected, "{columns}");
            let area: f64 = overlap.pair_areas.iter().sum();
            approx::assert_relative_eq!(area, f64::from(doubled) * column_area(), max_relative = 1e-12);
            approx::assert_relative_eq!(overlap.share, f64::from(doubled) / 40.0, max_relative = 1e-12);
        }
    }

    #[test]
    fn a_map_that_only_touches_itself_does_not_overlap() {
        for columns in [30, 39, 40] {
            let island = ramp(columns, false);
            let overlap = overlap(&island);
            assert!(overlap.pairs.is_empty() && overlap.share == 0.0, "{columns}");
        }
    }

    #[test]
    fn rounding_makes_no_overlap_of_a_touch() {
        let mut island = ramp(40, false);
        // the banks of the full turn come to lie over each other by a little
        let last = island.uv.len() - 3;
        let moved =
            |by: f64, island: &mut IslandMap| island.uv[last..].iter_mut().for_each(|[_, y]| *y += by);
        moved(1e-14, &mut island);
        assert!(overlap(&island).pairs.is_empty());
        moved(1e-4, &mut island);
        assert!(!overlap(&island).pairs.is_empty());
    }

    #[test]
    fn several_turns_have_a_finite_share() {
        let share = |columns| overlap(&ramp(columns, false)).share;
        approx::assert_relative_eq!(share(80), 1.0, max_relative = 1e-12);
        // three sheets: every place counts three times
        approx::assert_relative_eq!(share(120), 3.0, max_relative = 1e-12);
    }

    #[test]
    fn triangles_that_touch_are_not_reported() {
        let triangles = |rows: &[[[i32; 2]; 3]]| -> Vec<Triangle> {
            rows.iter().map(|corners| corners.map(|point| point.map(f64::from))).collect()
        };
        let first = [[0, 0], [4, 0], [0, 4]];
        let touching = [
            first,
            [[4, 0], [4, 4], [0, 4]],   // a common side
            [[1, 0], [0, -1], [2, -3]], // a corner on a side
            [[-2, 0], [0, 1], [-2, 5]], // the same from the left
            [[0, 4], [1, 6], [-1, 6]],  // a common corner
            [[6, 0], [6, 0], [0, 1]],   // no interior
        ];
        assert!(overlapping_pairs(&triangles(&touching)).is_empty());
        let pairs = overlapping_pairs(&triangles(&[first, [[1, 1], [2, 1], [1, 2]], first]));
        let expected = [([0, 1], 0.5), ([0, 2], 8.0), ([1, 2], 0.5)];
        assert_eq!(pairs, expected.map(|(pair, area)| (pair.map(Face), area)));
    }

    #[test]
    fn a_gap_of_the_last_bit_decides() {
        let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let beside = |x: f64| [[x, 0.0], [2.0, 0.0], [2.0, 1.0]];
        let count = |x: f64| overlapping_pairs(&[triangle, beside(x)]).len();
        assert_eq!((count(1.0_f64.next_down()), count(1.0), count(1.0_f64.next_up())), (1, 0, 0));
    }

    #[test]
    fn pairs_and_areas_are_those_of_all_pairs() {
        // a linear congruential generator
        let mut state = 7_u64;
        let mut random = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % n) as f64
        };
        for size in [3, 8, 40] {
            let mut center = || [random(size), random(size)];
            let triangles: Vec<Triangle> = (0..60).map(|_| [center(), center(), center()]).collect();
            let mut expected = Vec::new();
            for j in 0..triangles.len() {
                for i in 0..j {
                    let area = shared_by_slabs([&triangles[i], &triangles[j]]);
                    if area > 1e-9 {
                        expected.push(([Face::new(i), Face::new(j)], area));
                    }
                }
            }
            expected.sort_unstable_by_key(|&(pair, _)| pair);
            let pairs = overlapping_pairs(&triangles);
            assert!(pairs.iter().map(|(pair, _)| pair).eq(expected.iter().map(|(pair, _)| pair)));
            for ((_, area), (_, expected)) in pairs.iter().zip(&expected) {
                approx::assert_relative_eq!(area, expected, max_relative = 1e-9);
            }
        }
    }

    /// The area that two triangles share, by the trapezoids between the abscissas of corners and crossings.
    fn shared_by_slabs(pair: [&Triangle; 2]) -> f64 {
        let sides = |triangle: &Triangle| [0, 1, 2].map(|k| [triangle[k], triangle[(k + 1) % 3]]);
        let mut cuts: Vec<f64> = pair.iter().flat_map(|triangle| triangle.map(|[x, _]| x)).collect();
        for [a, b] in sides(pair[0]) {
            for [c, d] in sides(pair[1]) {
                let (u, v) = ([b[0] - a[0], b[1] - a[1]], [d[0] - c[0], d[1] - c[1]]);
                let determinant = u[0] * v[1] - u[1] * v[0];
                let t = ((c[0] - a[0]) * v[1] - (c[1] - a[1]) * v[0]) / determinant;
                cuts.extend((determinant != 0.0).then_some(a[0] + t * u[0]));
            }
        }
        cuts.sort_unstable_by(f64::total_cmp);
        let range_at = |triangle: &Triangle, x: f64| {
            let crossed = sides(triangle).into_iter().filter(|[a, b]| (a[0] - x) * (b[0] - x) < 0.0);
            let heights = crossed.map(|[a, b]| a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]));
            heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)])
        };
        let slabs = cuts.windows(2).map(|slab| {
            let middle = 0.5 * (slab[0] + slab[1]);
            let [first, second] = pair.map(|triangle| range_at(triangle, middle));
            (slab[1] - slab[0]) * (first[1].min(second[1]) - first[0].max(second[0])).max(0.0)
        });
        slabs.sum()
    }
}
