// SPDX-License-Identifier: MIT OR Apache-2.0
//! The elimination tree: the dependencies between the columns of the factor.
//!
//! Liu's algorithm for the tree and the algorithm of Gilbert, Ng and Peyton for the heights of the columns, both as
//! in Davis, Direct Methods for Sparse Linear Systems (2006), chapter 4. Cost: nearly linear in the edges.

use super::graph::{Graph, NONE};

/// The nodes in an order in which every subtree of the elimination tree is a contiguous range.
pub(super) struct Elimination {
    /// The node that is eliminated at each position.
    pub(super) order: Vec<u32>,
    /// The position of each node.
    pub(super) position: Vec<u32>,
    /// The parent of each position, a later one; [`NONE`] for roots.
    pub(super) parent: Vec<u32>,
    /// Unknowns in the factor's column of each position, from the position's own down.
    pub(super) height: Vec<u32>,
}

impl Elimination {
    /// Builds the tree of a graph for a fill-reducing `order`; `dofs` are the unknowns of each node.
    pub(super) fn new(graph: &Graph, order: &[u32], dofs: &[u8]) -> Self {
        let tree = elimination_tree(graph, order, &inverse(order));
        let post = postorder(&tree);
        let rank = inverse(&post);
        let order: Vec<u32> = post.iter().map(|&old| order[old as usize]).collect();
        let parent: Vec<u32> = post
            .iter()
            .map(|&old| match tree[old as usize] {
                NONE => NONE,
                parent => rank[parent as usize],
            })
            .collect();
        let position = inverse(&order);
        let height = column_heights(graph, &order, &position, &parent, dofs);
        Self { order, position, parent, height }
    }
}

fn inverse(order: &[u32]) -> Vec<u32> {
    let mut position = vec![0; order.len()];
    for (k, &node) in order.iter().enumerate() {
        position[node as usize] = k as u32;
    }
    position
}

/// The parent of each position: the first row below the diagonal of its column in the factor.
fn elimination_tree(graph: &Graph, order: &[u32], position: &[u32]) -> Vec<u32> {
    let mut parent = vec![NONE; order.len()];
    let mut ancestor = vec![NONE; order.len()];
    for (row, &node) in order.iter().enumerate() {
        let row = row as u32;
        for &neighbor in graph.neighbors(node) {
            let mut column = position[neighbor as usize];
            // climb to the root of the tree so far, and make all nodes on the way point to this row
            while column < row {
                let next = std::mem::replace(&mut ancestor[column as usize], row);
                if next == NONE {
                    parent[column as usize] = row;
                    break;
                }
                column = next;
            }
        }
    }
    parent
}

/// Positions in postorder. The largest subtree of each node comes last, so that it can share a front with the node.
fn postorder(parent: &[u32]) -> Vec<u32> {
    let (mut first_child, mut sibling, roots) = child_lists(parent);
    let mut order = Vec::with_capacity(parent.len());
    let mut path = Vec::new();
    for root in roots {
        path.push(root);
        while let Some(&node) = path.last() {
            let child = first_child[node as usize];
            if child == NONE {
                order.push(node);
                path.pop();
            } else {
                first_child[node as usize] = std::mem::replace(&mut sibling[child as usize], NONE);
                path.push(child);
            }
        }
    }
    order
}

/// (first child, next sibling, roots); the child with the largest subtree is the last of its siblings.
fn child_lists(parent: &[u32]) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let heavy = heavy_children(parent);
    let (mut first_child, mut sibling) = (heavy.clone(), vec![NONE; parent.len()]);
    let mut roots = Vec::new();
    for node in (0..parent.len()).rev() {
        match parent[node] {
            NONE => roots.push(node as u32),
            parent if heavy[parent as usize] == node as u32 => {}
            parent => {
                sibling[node] = std::mem::replace(&mut first_child[parent as usize], node as u32);
            }
        }
    }
    roots.reverse();
    (first_child, sibling, roots)
}

/// The child with the largest subtree of each node, [`NONE`] for leaves.
fn heavy_children(parent: &[u32]) -> Vec<u32> {
    let mut size = vec![1_u32; parent.len()];
    let mut heavy = vec![NONE; parent.len()];
    for node in 0..parent.len() {
        let Some(of_parent) = heavy.get_mut(parent[node] as usize) else { continue };
        if *of_parent == NONE || size[*of_parent as usize] < size[node] {
            *of_parent = node as u32;
        }
        size[parent[node] as usize] += size[node];
    }
    heavy
}

/// Unknowns in each column of the factor, including the node's own, for a postordered tree.
///
/// The columns that have an entry in one row form a subtree; each row adds its unknowns at the leaves of that
/// subtree and takes them off again where two branches meet and above its root.
fn column_heights(graph: &Graph, order: &[u32], position: &[u32], parent: &[u32], dofs: &[u8]) -> Vec<u32> {
    let weight = |position: usize| i64::from(dofs[order[position] as usize]);
    let first = first_descendants(parent);
    let mut change: Vec<i64> =
        (0..order.len()).map(|j| if first[j] == j as u32 { weight(j) } else { 0 }).collect();
    let mut leaves = RowLeaves::new(order.len());
    for column in 0..order.len() {
        if parent[column] != NONE {
            change[parent[column] as usize] -= weight(column);
        }
        for &neighbor in graph.neighbors(order[column]) {
            let row = position[neighbor as usize] as usize;
            if row > column && leaves.is_leaf(row, first[column]) {
                change[column] += weight(row);
                if let Some(branching) = leaves.add(row, column) {
                    change[branching] -= weight(row);
                }
            }
        }
        if parent[column] != NONE {
            leaves.ancestor[column] = parent[column];
        }
    }
    for column in 0..order.len() {
        if parent[column] != NONE {
            change[parent[column] as usize] += change[column];
        }
    }
    change.iter().map(|&height| height as u32).collect()
}

/// The first position in the subtree of each position of a postordered tree.
pub(super) fn first_descendants(parent: &[u32]) -> Vec<u32> {
    let mut first: Vec<u32> = (0..parent.len() as u32).collect();
    for node in 0..parent.len() {
        if let Some(of_parent) = first.get_mut(parent[node] as usize).map(|value| *value) {
            first[parent[node] as usize] = of_parent.min(first[node]);
        }
    }
    first
}

/// The leaves of the row subtrees seen so far.
struct RowLeaves {
    /// One more than the greatest first descendant of a leaf of each row.
    seen: Vec<u32>,
    last: Vec<u32>,
    ancestor: Vec<u32>,
}

impl RowLeaves {
    fn new(n: usize) -> Self {
        Self { seen: vec![0; n], last: vec![NONE; n], ancestor: (0..n as u32).collect() }
    }

    fn is_leaf(&self, row: usize, first: u32) -> bool {
        first >= self.seen[row]
    }

    /// Adds a leaf; returns where its branch meets that of the previous leaf.
    fn add(&mut self, row: usize, column: usize) -> Option<usize> {
        // in postorder, every subtree that begins at or before this column has been seen
        self.seen[row] = column as u32 + 1;
        let last = std::mem::replace(&mut self.last[row], column as u32);
        (last != NONE).then(|| self.root(last) as usize)
    }

    fn root(&mut self, leaf: u32) -> u32 {
        let mut root = leaf;
        while self.ancestor[root as usize] != root {
            root = self.ancestor[root as usize];
        }
        let mut node = leaf;
        while node != root {
            node = std::mem::replace(&mut self.ancestor[node as usize], root);
        }
        root
    }
}
