// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fronts: groups of columns of the factor with (nearly) one pattern, eliminated as one dense block.
//!
//! A front is a dense symmetric block over its own columns and the rows below them. Small neighboring columns
//! share a front even where that stores some zeros, because one larger block is faster than two small ones.

use std::ops::Range;

use super::elimination::{Elimination, first_descendants};
use super::graph::{Graph, NONE};

/// (columns, share): a front of up to so many columns may store at most this share of zeros.
const ALLOWED_ZEROS: [(usize, f64); 4] = [(8, 0.5), (16, 0.4), (48, 0.15), (usize::MAX, 0.05)];

/// Unknowns of consecutive rows of a front that are consecutive in its parent too.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    /// First row of the front, counted from the first below its columns.
    pub(super) from: u32,
    /// First row of the parent, counted from its first column.
    pub(super) to: u32,
    pub(super) length: u32,
}

/// An element of the matrix and its rows in the front.
#[derive(Debug, Clone, Copy)]
pub(in crate::sparse) struct Element {
    /// Index of the clique among those of the analysis.
    pub(in crate::sparse) index: u32,
    /// The row of the front where each corner begins; [`NONE`] for a corner that is held.
    pub(in crate::sparse) rows: [u32; 3],
    /// Unknowns of each corner.
    pub(in crate::sparse) dofs: [u8; 3],
}

/// One dense block of the elimination.
#[derive(Debug, Clone)]
pub(super) struct Front {
    /// The first front of the subtree that ends with this one.
    pub(super) first: u32,
    /// Unknowns eliminated before this front.
    pub(super) first_column: u32,
    pub(super) n_columns: u32,
    /// Rows below the columns.
    pub(super) n_rows: u32,
    /// The number of these rows that are columns of the parent.
    pub(super) n_shared: u32,
    /// True if the depth of the front in the tree is odd.
    pub(super) is_odd: bool,
    runs: Range<u32>,
    elements: Range<u32>,
}

impl Front {
    /// Rows of the whole block.
    pub(super) fn height(&self) -> usize {
        (self.n_columns + self.n_rows) as usize
    }

    pub(super) fn columns(&self) -> usize {
        self.n_columns as usize
    }

    pub(super) fn rows(&self) -> usize {
        self.n_rows as usize
    }
}

/// All fronts in postorder: a subtree is a contiguous range, its last front the root.
#[derive(Debug, Clone)]
pub(super) struct Fronts {
    fronts: Vec<Front>,
    runs: Vec<Run>,
    elements: Vec<Element>,
    /// The offset of each front's panel in the factor, then the length of the factor.
    panels: Vec<usize>,
    /// Multiplications before each front, then the total.
    work: Vec<f64>,
}

impl Fronts {
    pub(super) fn new(graph: &Graph, tree: &Elimination, dofs: &[u8], cliques: &[[u32; 3]]) -> Self {
        let columns = Columns::new(tree, dofs);
        let starts = merge_columns(tree, &columns);
        Builder::new(graph, tree, &columns, &starts, cliques).build(dofs, cliques)
    }

    pub(super) fn len(&self) -> usize {
        self.fronts.len()
    }

    pub(super) fn front(&self, front: usize) -> &Front {
        &self.fronts[front]
    }

    /// The children of a front, last first.
    pub(super) fn children(&self, front: usize) -> impl Iterator<Item = usize> + '_ {
        self.roots(self.fronts[front].first as usize..front)
    }

    /// The roots of a contiguous range of whole subtrees, last first.
    pub(super) fn roots(&self, range: Range<usize>) -> impl Iterator<Item = usize> + '_ {
        let mut end = range.end;
        std::iter::from_fn(move || {
            (end > range.start).then(|| {
                let root = end - 1;
                end = self.fronts[root].first as usize;
                root
            })
        })
    }

    pub(super) fn runs(&self, front: usize) -> &[Run] {
        let range = &self.fronts[front].runs;
        &self.runs[range.start as usize..range.end as usize]
    }

    pub(super) fn elements(&self, front: usize) -> &[Element] {
        let range = &self.fronts[front].elements;
        &self.elements[range.start as usize..range.end as usize]
    }

    /// The range of the factor that the panels of a range of fronts occupy.
    pub(super) fn panels(&self, range: &Range<usize>) -> Range<usize> {
        self.panels[range.start]..self.panels[range.end]
    }

    /// Numbers that the factor stores.
    pub(super) fn factor_len(&self) -> usize {
        *self.panels.last().expect("one more than fronts")
    }

    /// Numbers that wait on the two stacks of updates at most, where the fronts are eliminated one after the other.
    pub(super) fn updates_len(&self) -> usize {
        let (mut lengths, mut most) = ([0; 2], [0; 2]);
        for (number, front) in self.fronts.iter().enumerate() {
            let own = usize::from(front.is_odd);
            lengths[own] += front.rows() * front.rows();
            most[own] = most[own].max(lengths[own]);
            lengths[1 - own] -=
                self.children(number).map(|child| self.front(child).rows().pow(2)).sum::<usize>();
        }
        most[0] + most[1]
    }

    /// Multiplications that a range of fronts takes.
    pub(super) fn work(&self, range: &Range<usize>) -> f64 {
        self.work[range.end] - self.work[range.start]
    }

    /// The unknowns that a range of fronts eliminates.
    pub(super) fn columns(&self, range: &Range<usize>) -> Range<usize> {
        let start = |front: usize| match self.fronts.get(front) {
            Some(front) => front.first_column as usize,
            None => self.fronts.last().map_or(0, |last| last.first_column as usize + last.columns()),
        };
        start(range.start)..start(range.end)
    }
}

/// Sums over the positions of the elimination.
struct Columns {
    /// Unknowns before each position.
    dofs: Vec<u32>,
    /// Entries of the factor in the columns before each position.
    entries: Vec<u64>,
}

impl Columns {
    fn new(tree: &Elimination, dofs: &[u8]) -> Self {
        let n = tree.order.len();
        let (mut before, mut entries) = (vec![0; n + 1], vec![0; n + 1]);
        for position in 0..n {
            let width = u32::from(dofs[tree.order[position] as usize]);
            before[position + 1] = before[position] + width;
            let height = u64::from(tree.height[position]);
            entries[position + 1] =
                entries[position] + (0..u64::from(width)).map(|k| height - k).sum::<u64>();
        }
        Self { dofs: before, entries }
    }

    fn width(&self, range: &Range<usize>) -> usize {
        (self.dofs[range.end] - self.dofs[range.start]) as usize
    }
}

/// The first position of each front and, last, the number of positions.
fn merge_columns(tree: &Elimination, columns: &Columns) -> Vec<usize> {
    let n = tree.order.len();
    let mut starts: Vec<usize> = Vec::new();
    let mut start = 0;
    for position in 0..n {
        let continues = position + 1 < n && has_same_pattern(tree, columns, position);
        if continues {
            continue;
        }
        // merge with fronts before this one: always its last child
        while let Some(&before) = starts.last() {
            let is_child = (tree.parent[start - 1] as usize) <= position;
            if !is_child || !may_merge(tree, columns, before..position + 1) {
                break;
            }
            start = before;
            starts.pop();
        }
        starts.push(start);
        start = position + 1;
    }
    starts.push(n);
    starts
}

/// True if the column after `position` has the rows of this one, except its own.
fn has_same_pattern(tree: &Elimination, columns: &Columns, position: usize) -> bool {
    let below = tree.height[position] as usize - columns.width(&(position..position + 1));
    tree.parent[position] as usize == position + 1 && tree.height[position + 1] as usize == below
}

fn may_merge(tree: &Elimination, columns: &Columns, range: Range<usize>) -> bool {
    let last = range.end - 1;
    let below = tree.height[last] as usize - columns.width(&(last..range.end));
    let width = columns.width(&range);
    let stored = width * (width + 1) / 2 + width * below;
    let entries = (columns.entries[range.end] - columns.entries[range.start]) as f64;
    let zeros = 1.0 - entries / stored.max(1) as f64;
    ALLOWED_ZEROS.iter().any(|&(columns, allowed)| width <= columns && zeros < allowed)
}

/// The fronts so far, with the data for the next one.
struct Builder<'a> {
    graph: &'a Graph,
    tree: &'a Elimination,
    columns: &'a Columns,
    starts: &'a [usize],
    /// The cliques of each front, those of front f from `clique_starts[f]`.
    cliques: Vec<u32>,
    clique_starts: Vec<u32>,
    /// Positions of the rows below each front, ascending; emptied once the parent has them.
    rows: Vec<Vec<u32>>,
    /// The last front that contains each position, and its row there.
    met: Vec<u32>,
    row_of: Vec<u32>,
    out: Fronts,
}

impl<'a> Builder<'a> {
    fn new(
        graph: &'a Graph,
        tree: &'a Elimination,
        columns: &'a Columns,
        starts: &'a [usize],
        cliques: &[[u32; 3]],
    ) -> Self {
        let (cliques, clique_starts) = cliques_by_front(tree, starts, cliques);
        let n = tree.order.len();
        Self {
            graph,
            tree,
            columns,
            starts,
            cliques,
            clique_starts,
            rows: vec![Vec::new(); starts.len() - 1],
            met: vec![NONE; n],
            row_of: vec![NONE; n],
            out: Fronts {
                fronts: Vec::with_capacity(starts.len() - 1),
                runs: Vec::new(),
                elements: Vec::new(),
                panels: vec![0],
                work: vec![0.0],
            },
        }
    }

    fn build(mut self, dofs: &[u8], cliques: &[[u32; 3]]) -> Fronts {
        let first_position = first_descendants(&self.tree.parent);
        for front in 0..self.starts.len() - 1 {
            self.push_front(front, &first_position);
            self.find_rows(front);
            self.join_children(front);
            self.place_elements(front, dofs, cliques);
            self.measure(front);
        }
        self.number_depths();
        self.out
    }

    fn number_depths(&mut self) {
        for front in (0..self.out.len()).rev() {
            let children: Vec<usize> = self.out.children(front).collect();
            children
                .into_iter()
                .for_each(|child| self.out.fronts[child].is_odd = !self.out.fronts[front].is_odd);
        }
    }

    fn range(&self, front: usize) -> Range<usize> {
        self.starts[front]..self.starts[front + 1]
    }

    fn push_front(&mut self, front: usize, first_position: &[u32]) {
        let range = self.range(front);
        let first = first_position[range.end - 1] as usize;
        // a front's subtree begins with the front of its first position
        let first = self.starts[..=front].partition_point(|&start| start <= first) - 1;
        self.out.fronts.push(Front {
            first: first as u32,
            first_column: self.columns.dofs[range.start],
            n_columns: self.columns.width(&range) as u32,
            n_rows: 0,
            n_shared: 0,
            is_odd: false,
            runs: 0..0,
            elements: 0..0,
        });
    }

    /// The rows below a front: those of its children and the neighbors of its columns.
    fn find_rows(&mut self, front: usize) {
        let (range, mark) = (self.range(front), front as u32);
        let mut rows = Vec::new();
        let mut meet = |met: &mut [u32], position: u32| {
            if position as usize >= range.end && met[position as usize] != mark {
                met[position as usize] = mark;
                rows.push(position);
            }
        };
        for &node in &self.tree.order[range.clone()] {
            for &neighbor in self.graph.neighbors(node) {
                meet(&mut self.met, self.tree.position[neighbor as usize]);
            }
        }
        for child in self.out.children(front) {
            for &position in &self.rows[child] {
                meet(&mut self.met, position);
            }
        }
        rows.sort_unstable();
        self.number_rows(front, &rows);
        self.rows[front] = rows;
    }

    /// Records the row of the front at which each of its positions begins.
    fn number_rows(&mut self, front: usize, rows: &[u32]) {
        let range = self.range(front);
        for position in range.clone() {
            self.row_of[position] = self.columns.width(&(range.start..position)) as u32;
        }
        let mut row = self.columns.width(&range);
        for &position in rows {
            self.row_of[position as usize] = row as u32;
            row += self.columns.width(&(position as usize..position as usize + 1));
        }
        self.out.fronts[front].n_rows = (row - self.columns.width(&range)) as u32;
    }

    /// Gives the children the runs of their rows in this front.
    fn join_children(&mut self, front: usize) {
        let end = self.range(front).end;
        let children: Vec<usize> = self.out.children(front).collect();
        for child in children {
            let rows = std::mem::take(&mut self.rows[child]);
            let first_run = self.out.runs.len();
            let (mut from, mut shared) = (0, 0);
            for &position in &rows {
                let position = position as usize;
                let length = self.columns.width(&(position..position + 1)) as u32;
                let to = self.row_of[position];
                match self.out.runs[first_run..].last_mut() {
                    Some(run) if run.to + run.length == to => run.length += length,
                    _ => self.out.runs.push(Run { from, to, length }),
                }
                from += length;
                shared = if position < end { from } else { shared };
            }
            self.out.fronts[child].runs = first_run as u32..self.out.runs.len() as u32;
            self.out.fronts[child].n_shared = shared;
        }
    }

    fn place_elements(&mut self, front: usize, dofs: &[u8], cliques: &[[u32; 3]]) {
        let first = self.out.elements.len() as u32;
        let range = self.clique_starts[front] as usize..self.clique_starts[front + 1] as usize;
        for &index in &self.cliques[range] {
            let corners = cliques[index as usize];
            let rows = corners.map(|node| match node {
                NONE => NONE,
                node => self.row_of[self.tree.position[node as usize] as usize],
            });
            let dofs = corners.map(|node| dofs.get(node as usize).copied().unwrap_or(0));
            self.out.elements.push(Element { index, rows, dofs });
        }
        self.out.fronts[front].elements = first..self.out.elements.len() as u32;
    }

    fn measure(&mut self, front: usize) {
        let (height, columns) = (self.out.fronts[front].height(), self.out.fronts[front].columns());
        let rows = (height - columns) as f64;
        let c = columns as f64;
        let work = c * c * c / 3.0 + c * c * rows + c * rows * rows;
        self.out.panels.push(self.out.factor_len() + height * columns);
        // a front takes time however small it is
        self.out.work.push(self.out.work[front] + work + 1000.0);
    }
}

/// Sorts the cliques by the front that eliminates their first node.
fn cliques_by_front(tree: &Elimination, starts: &[usize], cliques: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    let mut front_of = vec![0_u32; tree.order.len()];
    for front in 0..starts.len() - 1 {
        front_of[starts[front]..starts[front + 1]].fill(front as u32);
    }
    let front = |clique: &[u32; 3]| {
        let nodes = clique.iter().filter(|&&node| node != NONE);
        nodes.map(|&node| tree.position[node as usize]).min().map(|first| front_of[first as usize] as usize)
    };
    let mut ends = vec![0_u32; starts.len()];
    cliques.iter().filter_map(front).for_each(|front| ends[front + 1] += 1);
    for k in 1..ends.len() {
        ends[k] += ends[k - 1];
    }
    let clique_starts = ends.clone();
    let mut sorted = vec![0; *ends.last().expect("one more than fronts") as usize];
    for (index, clique) in cliques.iter().enumerate() {
        if let Some(front) = front(clique) {
            sorted[ends[front] as usize] = index as u32;
            ends[front] += 1;
        }
    }
    (sorted, clique_starts)
}
