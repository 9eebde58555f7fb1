// SPDX-License-Identifier: MIT OR Apache-2.0
//! The areas of overlaps between a face and the cells of a grid, by Green's theorem.
//!
//! A grid has cells between lines x = const and y = const, with dx dy the element of area (on the sphere: longitude and
//! height). For a face to the left of its edges and a row between y₀ and y₁, the area within a column is
//!
//! ```text
//! −∮ (min(max(y, y₀), y₁) − y₀) dx
//! ```
//!
//! over the parts of the edges in the column. Each edge is cut at the lines of the grid and where it is highest or
//! lowest; between the cuts it runs up or down within one cell, and the integral of y is known: on the sphere an edge
//! is an arc of a great circle with the normal n, and with u = λ − arg(n_x + i n_y), c = −|(n_x, n_y)| sgn(n_z) / |n|,
//!
//! ```text
//! tan φ = −|(n_x, n_y)|/n_z · cos u,    ∫ z dλ = arcsin(c sin u).
//! ```
//!
//! A face around the north pole has λ run once around, and the cells above its edges too. The areas of a face add up
//! to its own whatever the places of the cuts, since a cut ends one integral where it begins the next.
//!
//! Cost: the number of cells that the box around the face covers.

use std::f64::consts::{PI, TAU};

use super::grids::Grid;
use crate::mesh::Vertex;
use crate::vector::Vector3;

/// The share of a cell that a face covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Overlap {
    /// The number of the cell, row by row.
    pub cell: usize,
    /// The area of the overlap.
    pub area: f64,
}

/// The overlaps of the positive face `vertices` with corners `points`, on the unit sphere or in the plane. A cell may be
/// listed twice, where a face around a pole comes back to it: then its parts count together.
pub(super) fn overlaps(grid: &Grid, vertices: [Vertex; 3], points: [Vector3; 3], out: &mut Vec<Overlap>) {
    let edges = if grid.is_round() { on_sphere(vertices, points) } else { in_plane(points) };
    let Some(mut face) = Coverage::new(grid, &edges) else { return };
    edges.arcs.iter().for_each(|arc| face.add(arc));
    face.finish(edges.around_north, out);
}

/// The edges of a face in the coordinates of the grid.
struct Edges {
    arcs: Vec<Arc>,
    /// Whether the north pole lies inside.
    around_north: bool,
    /// The lowest and the highest place y of the face.
    heights: [f64; 2],
}

/// A directed edge.
struct Arc {
    /// Where it begins and ends, as x runs on without a jump.
    from: f64,
    to: f64,
    curve: Curve,
}

/// The graph y(x) of an edge.
#[derive(Clone, Copy)]
enum Curve {
    /// A straight line through a point, with a slope.
    Line { x: f64, y: f64, slope: f64 },
    /// A great circle: the place `middle` where it is highest or lowest, the tangent of the latitude there, and the sine
    /// and cosine of that latitude.
    Circle { middle: f64, tangent: f64, sine: f64, cosine: f64 },
    /// A pole, which all longitudes have in common.
    Pole { y: f64 },
}

impl Curve {
    fn y(self, x: f64) -> f64 {
        match self {
            Self::Line { x: x0, y, slope } => y + slope * (x - x0),
            Self::Circle { middle, sine, cosine, .. } => {
                // sin of the latitude whose tangent is that of the middle times cos u
                let (along, across) = (sine * (x - middle).cos(), cosine);
                if along == 0.0 { 0.0 } else { along / along.hypot(across) }
            }
            Self::Pole { y } => y,
        }
    }

    /// ∫ y dx.
    fn integral(self, from: f64, to: f64) -> f64 {
        match self {
            Self::Line { .. } => 0.5 * (self.y(from) + self.y(to)) * (to - from),
            Self::Circle { middle, sine, cosine, .. } => {
                let antiderivative = |x: f64| {
                    let (sin, cos) = (x - middle).sin_cos();
                    (sine * sin).atan2(cos.hypot(cosine * sin))
                };
                antiderivative(to) - antiderivative(from)
            }
            Self::Pole { y } => y * (to - from),
        }
    }

    /// The places between `from` and `to` where the curve turns from up to down or back.
    fn turns(self, from: f64, to: f64) -> Option<f64> {
        let Self::Circle { middle, .. } = self else { return None };
        let (low, high) = (from.min(to), from.max(to));
        let turn = middle + PI * ((low - middle) / PI).ceil();
        (low < turn && turn < high).then_some(turn)
    }

    /// The place between `from` and `to`, where the curve only rises or only falls, at the height `y`.
    fn x(self, y: f64, from: f64, to: f64) -> f64 {
        let x = match self {
            Self::Line { x, y: y0, slope } => x + (y - y0) / slope,
            Self::Circle { middle, tangent, .. } => {
                let half = 0.5 * (from + to);
                let u = (half - middle + PI).rem_euclid(TAU) - PI;
                let cos = y / ((1.0 - y) * (1.0 + y)).sqrt() / tangent;
                half + (cos.clamp(-1.0, 1.0).acos() * u.signum() - u)
            }
            Self::Pole { .. } => to,
        };
        // a number even for a line that is level up to rounding
        if x.is_nan() { to } else { x.clamp(from.min(to), from.max(to)) }
    }
}

fn in_plane(points: [Vector3; 3]) -> Edges {
    let arcs = (0..3).map(|k| {
        let [p, q] = [points[k], points[(k + 1) % 3]];
        let slope = (q[1] - p[1]) / (q[0] - p[0]);
        Arc { from: p[0], to: q[0], curve: Curve::Line { x: p[0], y: p[1], slope } }
    });
    let heights = points.map(|point| point[1]);
    Edges { arcs: arcs.collect(), around_north: false, heights: extremes(heights) }
}

fn on_sphere(vertices: [Vertex; 3], points: [Vector3; 3]) -> Edges {
    let circles: [(f64, Curve); 3] = std::array::from_fn(|k| {
        let next = (k + 1) % 3;
        // both faces of an edge see it from the same end, so that they agree even where it passes through a pole
        if vertices[k] < vertices[next] {
            circle(points[k], points[next])
        } else {
            let (turn, curve) = circle(points[next], points[k]);
            (-turn, curve)
        }
    });
    let is_pole = |point: Vector3| point[0] == 0.0 && point[1] == 0.0;
    let first = (0..3).find(|&k| !is_pole(points[k])).unwrap_or(0);
    let mut arcs = Vec::with_capacity(4);
    let mut x = points[first][1].atan2(points[first][0]);
    let turn: f64 = circles.iter().map(|&(turn, _)| turn).sum();
    for k in (0..3).map(|step| (first + step) % 3) {
        let (around, curve) = circles[k];
        arcs.push(Arc { from: x, to: x + around, curve });
        x += around;
        let corner = points[(k + 1) % 3];
        if is_pole(corner) {
            // the longitudes at a pole go back to where the third edge began
            arcs.push(Arc { from: x, to: x - turn, curve: Curve::Pole { y: corner[2].signum() } });
            x -= turn;
        }
    }
    let has_pole = points.into_iter().any(is_pole);
    let winding = if has_pole { 0.0 } else { (turn / TAU).round() };
    let mut heights = extremes(points.map(|point| point[2]));
    for arc in &arcs {
        if let Some(x) = arc.curve.turns(arc.from, arc.to) {
            heights = extremes([heights[0], heights[1], arc.curve.y(x)]);
        }
    }
    if winding > 0.0 {
        heights[1] = 1.0;
    } else if winding < 0.0 {
        heights[0] = -1.0;
    }
    Edges { arcs, around_north: winding > 0.0, heights }
}

/// How far the longitude turns from p to q along their great circle, and that circle.
fn circle(p: Vector3, q: Vector3) -> (f64, Curve) {
    let normal = p.cross(q - p);
    let turn = (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]);
    let horizontal = normal[0].hypot(normal[1]);
    let length = horizontal.hypot(normal[2]);
    // where the edge runs through the pole, the longitude turns on the side that `turn` says
    let upward = if normal[2] == 0.0 { turn } else { normal[2] };
    let curve = Curve::Circle {
        middle: normal[1].atan2(normal[0]),
        tangent: -horizontal / normal[2].abs().copysign(upward),
        sine: -(horizontal / length).copysign(upward),
        cosine: normal[2].abs() / length,
    };
    (if length > 0.0 { turn } else { 0.0 }, curve)
}

fn extremes(values: [f64; 3]) -> [f64; 2] {
    [values.into_iter().fold(f64::INFINITY, f64::min), values.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

/// The cells in the box around a face, and what of them it covers so far.
struct Coverage<'a> {
    grid: &'a Grid,
    /// The first column, and their number; on the sphere columns run on beyond the last to the first.
    first_column: i64,
    n_columns: usize,
    /// The first row, and their number.
    first_row: usize,
    n_rows: usize,
    /// The areas below edges within their cell, row by row.
    areas: Vec<f64>,
    /// The widths of edges above each cell: they have all cells below them within their columns.
    widths: Vec<f64>,
}

impl<'a> Coverage<'a> {
    /// `None` where the face lies beside the grid, or is no face.
    fn new(grid: &'a Grid, edges: &Edges) -> Option<Self> {
        let ends = edges.arcs.iter().flat_map(|arc| [arc.from, arc.to]);
        let [low, high] =
            ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        let [n_rows, n_columns] = grid.shape();
        let column = |x: f64| ((x - grid.vertical(0.0)) / grid.width()).floor();
        let (mut first, mut last) = (column(low), column(high));
        if !grid.is_round() {
            (first, last) = (first.max(0.0), last.min(n_columns as f64 - 1.0));
        }
        let [top, bottom] = [edges.heights[1], edges.heights[0]].map(|y| row_of(grid, y));
        let (first_row, last_row) = (top.max(0) as usize, bottom.min(n_rows as i64 - 1));
        if first > last || last_row < first_row as i64 {
            return None;
        }
        let (n_columns, n_rows) = ((last - first) as usize + 1, last_row as usize - first_row + 1);
        let cells = n_columns * n_rows;
        let [areas, widths] = [vec![0.0; cells], vec![0.0; cells]];
        Some(Self { grid, first_column: first as i64, n_columns, first_row, n_rows, areas, widths })
    }

    /// Cuts an edge at the vertical lines, and adds its parts.
    fn add(&mut self, arc: &Arc) {
        let (low, high) = (arc.from.min(arc.to), arc.from.max(arc.to));
        if low >= high {
            return;
        }
        let sign = if arc.from < arc.to { -1.0 } else { 1.0 };
        let (first, last) = (self.column_of(low), self.column_of(high));
        for place in first..=last {
            let [left, right] =
                [0, 1].map(|side| self.grid.vertical((self.first_column + place as i64 + side) as f64));
            // on the sphere rounding must not lose the ends of an edge; in the plane what is beside the grid is lost
            let is_round = self.grid.is_round();
            let from = if is_round && place == first { low } else { low.max(left) };
            let to = if is_round && place == last { high } else { high.min(right) };
            if from < to {
                self.add_within_column(arc.curve, [from, to], place, sign);
            }
        }
    }

    /// The column of the box in which a place lies, or the nearest.
    fn column_of(&self, x: f64) -> usize {
        let column = ((x - self.grid.vertical(0.0)) / self.grid.width()).floor() as i64;
        (column - self.first_column).clamp(0, self.n_columns as i64 - 1) as usize
    }

    /// Adds a part of an edge within a column, from left to right.
    fn add_within_column(&mut self, curve: Curve, [from, to]: [f64; 2], column: usize, sign: f64) {
        match curve.turns(from, to) {
            None => self.add_monotone(curve, [from, to], column, sign),
            Some(turn) => {
                self.add_monotone(curve, [from, turn], column, sign);
                self.add_monotone(curve, [turn, to], column, sign);
            }
        }
    }

    /// Cuts a part of an edge that only rises or only falls at the horizontal lines, and adds what is in each row.
    fn add_monotone(&mut self, curve: Curve, [from, to]: [f64; 2], column: usize, sign: f64) {
        let (first, last) = (row_of(self.grid, curve.y(from)), row_of(self.grid, curve.y(to)));
        let step = (last - first).signum();
        let (mut row, mut x) = (first, from);
        loop {
            let next = if row == last {
                to
            } else {
                let line = if step > 0 { row + 1 } else { row };
                curve.x(self.grid.horizontal(line as f64), x, to)
            };
            self.add_within_cell(curve, [x, next], (row, column), sign);
            if row == last {
                break;
            }
            (row, x) = (row + step, next);
        }
    }

    /// Adds a part of an edge within a cell, or above or below the grid.
    fn add_within_cell(
        &mut self,
        curve: Curve,
        [from, to]: [f64; 2],
        (row, column): (i64, usize),
        sign: f64,
    ) {
        let inside = row - self.first_row as i64;
        let width = sign * (to - from);
        if inside < 0 {
            // above the box: all cells of the column below
            self.widths[column] += width;
        }
        if (0..self.n_rows as i64).contains(&inside) {
            let inside = inside as usize;
            let floor = self.grid.horizontal((row + 1) as f64);
            self.areas[inside * self.n_columns + column] += sign * curve.integral(from, to) - floor * width;
            if inside + 1 < self.n_rows {
                self.widths[(inside + 1) * self.n_columns + column] += width;
            }
        }
    }

    /// The areas of all cells.
    fn finish(mut self, around_north: bool, out: &mut Vec<Overlap>) {
        let total = self.grid.shape()[1] as i64;
        if around_north {
            // once around all columns, whose first and last may be one
            let width = self.grid.width();
            self.widths.iter_mut().take(self.n_columns.min(total as usize)).for_each(|each| *each += width);
        }
        for row in 0..self.n_rows {
            let number = self.first_row + row;
            let height = self.grid.horizontal(number as f64) - self.grid.horizontal((number + 1) as f64);
            for column in 0..self.n_columns {
                let cell = row * self.n_columns + column;
                if row > 0 {
                    self.widths[cell] += self.widths[cell - self.n_columns];
                }
                let area = self.areas[cell] + height * self.widths[cell];
                if area != 0.0 {
                    let column = (self.first_column + column as i64).rem_euclid(total);
                    out.push(Overlap { cell: number * total as usize + column as usize, area });
                }
            }
        }
    }
}

/// The row in which a height lies: −1 above the grid, the number of rows below it.
fn row_of(grid: &Grid, y: f64) -> i64 {
    let rows = grid.shape()[0] as i64;
    let guess = match *grid {
        Grid::Equirectangular { .. } => y.clamp(-1.0, 1.0).acos() / PI * rows as f64,
        Grid::EqualArea { .. } => 0.5 * (1.0 - y) * rows as f64,
        Grid::Planar { extent: [_, _, lower, upper], .. } => (upper - y) / (upper - lower) * rows as f64,
    };
    let row = guess.floor().clamp(-1.0, rows as f64) as i64;
    if grid.is_round() { row.clamp(0, rows - 1) } else { row }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::location::tests::{number, octasphere, rings};
    use crate::mesh::geometry::{area, triangle};

    const GRIDS: [Grid; 4] = [
        Grid::Equirectangular { rows: 12, columns: 20 },
        Grid::EqualArea { rows: 9, columns: 16 },
        Grid::EqualArea { rows: 1, columns: 1 },
        Grid::Equirectangular { rows: 2, columns: 3 },
    ];

    fn turned(points: &[Vector3], seed: usize) -> Vec<Vector3> {
        let axis = Vector3([number(seed), number(seed + 1), number(seed + 2)]).normalized();
        let (sin, cos) = (3.0 * number(seed + 3)).sin_cos();
        let turn = |&x: &Vector3| x * cos + axis.cross(x) * sin + axis * (axis.dot(x) * (1.0 - cos));
        points.iter().map(|x| turn(x).normalized()).collect()
    }

    /// The area of a spherical triangle (van Oosterom & Strackee 1983).
    fn spherical(points: [Vector3; 3]) -> f64 {
        let [a, b, c] = points;
        2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    }

    #[test]
    fn the_overlaps_of_a_face_add_up_to_its_area_and_those_of_a_cell_to_its() {
        let (points, faces) = octasphere(3);
        // with and without edges and vertices at the poles
        for points in [points.clone(), turned(&points, 5), turned(&points, 50)] {
            for grid in GRIDS {
                let mut cells = vec![0.0; grid.areas().len()];
                for &face in &faces {
                    let mut found = Vec::new();
                    overlaps(&grid, face, triangle(&points, face), &mut found);
                    let sum: f64 = found.iter().map(|overlap| overlap.area).sum();
                    assert!((sum - spherical(triangle(&points, face))).abs() < 1e-14, "{sum}");
                    let mut of_face = vec![0.0; cells.len()];
                    found.iter().for_each(|overlap| of_face[overlap.cell] += overlap.area);
                    assert!(of_face.iter().all(|&area| area > -1e-14));
                    cells.iter_mut().zip(of_face).for_each(|(cell, area)| *cell += area);
                }
                for (cell, area) in cells.iter().zip(grid.areas()) {
                    assert!((cell - area).abs() < 1e-13, "{cell} {area}");
                }
            }
        }
    }

    #[test]
    fn an_edge_through_a_pole_belongs_to_both_of_its_faces_alike() {
        // an edge from (0, -1, 1) to (0, 1, 1), and the faces beside it
        let points = [[0.0, -1.0, 1.0], [0.0, 1.0, 1.0], [1.0, 0.0, 0.3], [-1.0, 0.0, 0.3]];
        let points = points.map(|point| Vector3(point).normalized());
        let faces = [[0, 2, 1], [0, 1, 3]].map(|face| face.map(Vertex));
        let grid = Grid::Equirectangular { rows: 8, columns: 8 };
        let mut cells = vec![0.0; 64];
        for face in faces {
            let mut found = Vec::new();
            overlaps(&grid, face, triangle(&points, face), &mut found);
            let sum: f64 = found.iter().map(|overlap| overlap.area).sum();
            assert!((sum - spherical(triangle(&points, face))).abs() < 1e-14);
            found.iter().for_each(|overlap| cells[overlap.cell] += overlap.area);
        }
        // the cells at the pole are covered
        assert!((0..8).all(|cell| (cells[cell] - grid.areas()[cell]).abs() < 1e-14), "{cells:?}");
    }

    #[test]
    fn in_the_plane_the_cells_inside_are_covered_and_those_outside_are_not() {
        let (points, faces) = rings(6);
        for (rows, columns, extent) in [
            (7, 9, [-1.0, 1.0, -1.0, 1.0]),
            (40, 31, [-1.5, 1.2, -1.1, 2.0]),
            (5, 5, [-0.3, 0.2, -0.4, 0.5]),
            (1, 1, [-3.0, 3.0, -3.0, 3.0]),
        ] {
            let grid = Grid::Planar { rows, columns, extent };
            let mut cells = vec![0.0; rows * columns];
            for &face in &faces {
                let mut found = Vec::new();
                overlaps(&grid, face, triangle(&points, face), &mut found);
                found.iter().for_each(|overlap| cells[overlap.cell] += overlap.area);
            }
            let whole: f64 = faces.iter().map(|&face| area(triangle(&points, face))).sum();
            let (sum, areas) = (cells.iter().sum::<f64>(), grid.areas());
            let is_around = extent[0] <= -1.0 && extent[1] >= 1.0 && extent[2] <= -1.0 && extent[3] >= 1.0;
            assert!(!is_around || (sum - whole).abs() < 1e-13, "{sum} {whole}");
            for (cell, center) in grid.centers().rows().into_iter().enumerate() {
                let [x, y] = [center[0].abs(), center[1].abs()];
                let half = 0.5 * (areas[cell] / grid.width()).hypot(grid.width());
                let covered = cells[cell] / areas[cell];
                assert!((-1e-12..=1.0 + 1e-12).contains(&covered));
                assert!(x.hypot(y) + half > 0.98 || (covered - 1.0).abs() < 1e-12, "{covered}");
                assert!(x.hypot(y) - half < 1.0 || covered.abs() < 1e-12, "{covered}");
            }
        }
    }
}
