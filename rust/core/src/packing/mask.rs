// SPDX-License-Identifier: MIT OR Apache-2.0
//! Islands as cells of a grid: every cell that an island touches, or that lies within a distance of it.

use super::outline::Point;

/// What rounding may move a point by, in cells.
pub(super) const ROUNDING: f64 = 1e-7;

/// Rows of cells, each a list of disjoint spans `first..end` from left to right.
#[derive(Debug, Clone, Default)]
pub(super) struct Mask {
    /// The spans of each row.
    pub rows: Vec<Vec<[i32; 2]>>,
    /// The row that `rows` begins with; it may be negative.
    pub first_row: i32,
}

impl Mask {
    /// The cells of the plane with a point that edges enclose or that lies within `distance` of an edge, in O(edges ·
    /// rows of an edge). Lengths are in cells.
    pub fn new(edges: &[[Point; 2]], distance: f64) -> Self {
        let reach = distance + ROUNDING;
        let heights = edges.iter().flatten().map(|point| point[1]);
        let [low, high] =
            heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
        if edges.is_empty() {
            return Self::default();
        }
        let first_row = (low - reach).floor() as i32;
        let n_rows = ((high + reach).floor() as i32 - first_row + 1) as usize;
        let mut rows = inner_spans(edges, first_row, n_rows);
        for &edge in edges {
            add_capsule(&mut rows, first_row, edge, reach);
        }
        rows.iter_mut().for_each(join_spans);
        Self { rows, first_row }
    }

    /// The cells in the first columns and rows.
    pub fn clipped(self, [width, height]: [usize; 2]) -> Self {
        let below = self.first_row.min(0).unsigned_abs() as usize;
        let clip = |[first, end]: [i32; 2]| [first.max(0), end.min(width as i32)];
        let rows = self.rows.into_iter().skip(below).take(height);
        let rows = rows.map(|spans| spans.into_iter().map(clip).filter(|[first, end]| first < end).collect());
        Self { rows: rows.collect(), first_row: self.first_row.max(0) }
    }
}

/// The cells whose middle line runs inside, by winding numbers.
fn inner_spans(edges: &[[Point; 2]], first_row: i32, n_rows: usize) -> Vec<Vec<[i32; 2]>> {
    let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); n_rows];
    for &[a, b] in edges {
        let [low, high, sign] = if a[1] < b[1] { [a[1], b[1], 1.0] } else { [b[1], a[1], -1.0] };
        // rows with low ≤ row + ½ < high
        let [from, to] = [low, high].map(|y| (y - 0.5).ceil() as i32);
        for row in from..to {
            let share = (f64::from(row) + 0.5 - a[1]) / (b[1] - a[1]);
            crossings[(row - first_row) as usize].push((a[0] + share * (b[0] - a[0]), sign as i32));
        }
    }
    crossings.into_iter().map(spans_inside).collect()
}

/// The spans of a line between crossings where the winding number is not zero.
fn spans_inside(mut crossings: Vec<(f64, i32)>) -> Vec<[i32; 2]> {
    crossings.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut spans = Vec::new();
    let mut winding = 0;
    for pair in crossings.windows(2) {
        winding += pair[0].1;
        if winding != 0 {
            spans.push([pair[0].0.floor() as i32, pair[1].0.floor() as i32 + 1]);
        }
    }
    spans
}

/// Adds the cells that have a point within `reach` of an edge.
fn add_capsule(rows: &mut [Vec<[i32; 2]>], first_row: i32, [a, b]: [Point; 2], reach: f64) {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let normal = if length > 0.0 { [a[1] - b[1], b[0] - a[0]].map(|x| x * reach / length) } else { [0.0; 2] };
    let sides = [1.0, -1.0].map(|side| [a, b].map(|p| [p[0] + side * normal[0], p[1] + side * normal[1]]));
    let from = (a[1].min(b[1]) - reach).floor() as i32;
    let to = (a[1].max(b[1]) + reach).floor() as i32;
    for row in from..=to {
        let level = f64::from(row);
        let ranges = [disk_range(a, reach, level), disk_range(b, reach, level)]
            .into_iter()
            .chain(sides.map(|side| segment_range(side, level)))
            .flatten();
        let range = ranges.reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])]);
        if let Some([left, right]) = range {
            let span = [(left - ROUNDING).floor() as i32, (right + ROUNDING).floor() as i32 + 1];
            rows[(row - first_row) as usize].push(span);
        }
    }
}

/// Where a disk lies in the row of cells above a level.
fn disk_range(center: Point, radius: f64, level: f64) -> Option<[f64; 2]> {
    let height = center[1] - center[1].clamp(level, level + 1.0);
    let half = radius * radius - height * height;
    (half >= 0.0).then(|| [center[0] - half.sqrt(), center[0] + half.sqrt()])
}

/// Where a segment lies in the row of cells above a level.
fn segment_range([a, b]: [Point; 2], level: f64) -> Option<[f64; 2]> {
    let [low, high] = if a[1] < b[1] { [a, b] } else { [b, a] };
    if high[1] < level || low[1] > level + 1.0 {
        return None;
    }
    let rise = high[1] - low[1];
    let x_at = |y: f64| {
        let share = if rise > 0.0 { ((y - low[1]) / rise).clamp(0.0, 1.0) } else { 0.0 };
        low[0] + share * (high[0] - low[0])
    };
    let level_segment = rise <= ROUNDING;
    let [x, y] = if level_segment { [low[0], high[0]] } else { [x_at(level), x_at(level + 1.0)] };
    Some([x.min(y), x.max(y)])
}

/// Sorts spans and joins those that meet.
fn join_spans(spans: &mut Vec<[i32; 2]>) {
    spans.sort_unstable();
    let mut joined: Vec<[i32; 2]> = Vec::with_capacity(spans.len());
    for &[first, end] in &*spans {
        match joined.last_mut() {
            Some(last) if last[1] >= first => last[1] = last[1].max(end),
            _ => joined.push([first, end]),
        }
    }
    *spans = joined;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[Point]) -> Vec<[Point; 2]> {
        (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]).collect()
    }

    /// Distance between a cell and a segment, by samples of the cell.
    fn distance(cell: Point, [a, b]: [Point; 2]) -> f64 {
        let samples =
            (0..=20).flat_map(|i| (0..=20).map(move |j| [f64::from(i) / 20.0, f64::from(j) / 20.0]));
        let along = [b[0] - a[0], b[1] - a[1]];
        samples
            .map(|s| {
                let p = [cell[0] + s[0] - a[0], cell[1] + s[1] - a[1]];
                let share = (p[0] * along[0] + p[1] * along[1]) / (along[0].powi(2) + along[1].powi(2));
                let t = share.clamp(0.0, 1.0);
                (p[0] - t * along[0]).hypot(p[1] - t * along[1])
            })
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn cells_near_the_edges_are_marked_and_no_others() {
        let edges = polygon(&[[0.3, 0.2], [9.7, 2.1], [4.4, 3.3], [6.1, 8.9]]);
        for reach in [0.0, 0.7, 1.6] {
            let mask = Mask::new(&edges, reach);
            for (row, spans) in mask.rows.iter().enumerate() {
                let y = row as i32 + mask.first_row;
                for x in -4..14 {
                    let cell = [f64::from(x), f64::from(y)];
                    let nearest =
                        edges.iter().map(|&edge| distance(cell, edge)).fold(f64::INFINITY, f64::min);
                    let is_marked = spans.iter().any(|&[first, end]| (first..end).contains(&x));
                    assert!(is_marked || nearest > reach, "{x} {y}: {nearest}");
                    let inside = is_inside([cell[0] + 0.5, cell[1] + 0.5], &edges);
                    assert!(!is_marked || inside || nearest < reach + 0.08, "{x} {y}: {nearest}");
                }
            }
        }
    }

    fn is_inside(point: Point, edges: &[[Point; 2]]) -> bool {
        let crossed = edges.iter().filter(|[a, b]| (a[1] > point[1]) != (b[1] > point[1]));
        let right =
            crossed.filter(|[a, b]| point[0] < a[0] + (point[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
        right.count() % 2 == 1
    }

    #[test]
    fn a_hole_stays_free_and_an_overlap_is_covered() {
        let outer = [[0.1, 0.1], [9.9, 0.1], [9.9, 9.9], [0.1, 9.9]];
        let hole = [[3.5, 3.5], [3.5, 6.5], [6.5, 6.5], [6.5, 3.5]];
        let mask = Mask::new(&[polygon(&outer), polygon(&hole)].concat(), 0.0);
        assert_eq!(mask.rows[4], [[0, 4], [6, 10]]);
        let twice = Mask::new(&[polygon(&outer), polygon(&outer)].concat(), 0.0);
        assert_eq!(twice.rows, vec![vec![[0, 10]]; 10]);
    }
}
