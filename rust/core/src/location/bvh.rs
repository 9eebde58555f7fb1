// SPDX-License-Identifier: MIT OR Apache-2.0
//! A bounding volume hierarchy: a tree of boxes that finds the few faces, of many, in or near to which a point may lie.
//!
//! Each node halves its faces along the longest side of the box of their centers, so that the depth is log₂ of their
//! number whatever their shapes. Cost: O(n log² n) to build, O(log n) for a point in boxes that overlap little.

use crate::mesh::Face;
use crate::vector::Vector3;

/// Most elements in a leaf.
const LEAF: usize = 3;

/// Most nodes that wait at once: one for each level of a tree of 2³² elements, and some.
const STACK: usize = 40;

/// A closed box with sides along the axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub low: Vector3,
    pub high: Vector3,
}

impl Default for Bounds {
    /// The empty box.
    fn default() -> Self {
        Self { low: Vector3([f64::INFINITY; 3]), high: Vector3([f64::NEG_INFINITY; 3]) }
    }
}

impl Bounds {
    /// The smallest box that contains this one and a point.
    pub(super) fn with(self, point: Vector3) -> Self {
        self.union(Self { low: point, high: point })
    }

    /// Every side moved outward.
    pub(super) fn padded(self, by: f64) -> Self {
        Self { low: self.low.map(|x| x - by), high: self.high.map(|x| x + by) }
    }

    fn union(self, other: Self) -> Self {
        Self {
            low: Vector3::from_fn(|k| self.low[k].min(other.low[k])),
            high: Vector3::from_fn(|k| self.high[k].max(other.high[k])),
        }
    }

    fn center(&self) -> Vector3 {
        Vector3::from_fn(|k| 0.5 * self.low[k] + 0.5 * self.high[k])
    }

    fn longest_axis(&self) -> usize {
        let side = |k: usize| self.high[k] - self.low[k];
        (1..3).fold(0, |longest, k| if side(k) > side(longest) { k } else { longest })
    }

    fn contains(&self, point: Vector3) -> bool {
        (0..3).all(|k| self.low[k] <= point[k] && point[k] <= self.high[k])
    }

    /// The square of the distance of a point; 0 inside.
    fn squared_distance(&self, point: Vector3) -> f64 {
        (0..3).map(|k| (self.low[k] - point[k]).max(point[k] - self.high[k]).max(0.0).powi(2)).sum()
    }
}

/// A half-line, prepared for boxes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    pub origin: Vector3,
    pub direction: Vector3,
    /// The reciprocals of the coordinates of the direction.
    reciprocal: Vector3,
}

impl Ray {
    pub(super) fn new(origin: Vector3, direction: Vector3) -> Self {
        Self { origin, direction, reciprocal: direction.map(f64::recip) }
    }

    /// Whether the ray meets a box. Where it runs within a side, 0 · ∞ is NaN, which `min` and `max` pass over.
    fn meets(&self, bounds: &Bounds) -> bool {
        let (mut enters, mut leaves) = (0.0, f64::INFINITY);
        for axis in 0..3 {
            let low = (bounds.low[axis] - self.origin[axis]) * self.reciprocal[axis];
            let high = (bounds.high[axis] - self.origin[axis]) * self.reciprocal[axis];
            enters = f64::max(enters, low.min(high));
            leaves = f64::min(leaves, low.max(high));
        }
        enters <= leaves
    }
}

/// A leaf over `order[first..first + count]`; with `count` 0 a fork whose children are the next node and `first`.
#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    first: usize,
    count: usize,
}

/// The tree over faces, each known by its box.
#[derive(Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    order: Vec<Face>,
}

impl Tree {
    /// Builds the tree over at least one box.
    pub(super) fn new(boxes: &[Bounds]) -> Self {
        let centers: Vec<Vector3> = boxes.iter().map(Bounds::center).collect();
        let mut order: Vec<Face> = Face::all(boxes.len()).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        branch(boxes, &centers, &mut order, 0, &mut nodes);
        Self { nodes, order }
    }

    /// Calls `visit` with every element whose leaf's box contains the point, in no particular order, until it returns
    /// true.
    pub(super) fn visit(&self, point: Vector3, mut visit: impl FnMut(Face) -> bool) {
        let mut waiting = Stack::default();
        let mut next = Some(0);
        while let Some(index) = next {
            let node = &self.nodes[index];
            if !node.bounds.contains(point) {
                next = waiting.pop();
            } else if node.count == 0 {
                waiting.push(node.first);
                next = Some(index + 1);
            } else if self.elements(node).iter().any(|&element| visit(element)) {
                return;
            } else {
                next = waiting.pop();
            }
        }
    }

    /// Whether `is_hit` holds for an element whose leaf's box meets the ray.
    pub(super) fn any_along(&self, ray: &Ray, is_hit: impl Fn(Face) -> bool) -> bool {
        let mut waiting = Stack::default();
        let mut next = Some(0);
        while let Some(index) = next {
            let node = &self.nodes[index];
            if !ray.meets(&node.bounds) {
                next = waiting.pop();
            } else if node.count == 0 {
                waiting.push(node.first);
                next = Some(index + 1);
            } else if self.elements(node).iter().any(|&element| is_hit(element)) {
                return true;
            } else {
                next = waiting.pop();
            }
        }
        false
    }

    /// The element of the least `squared_distance`, which must not be less than that of its box; the first of equals,
    /// element 0 if all are NaN.
    pub(super) fn nearest(&self, point: Vector3, squared_distance: impl Fn(Face) -> f64) -> Face {
        let (mut nearest, mut least) = (Face::default(), f64::INFINITY);
        let mut waiting = Stack::default();
        let mut next = Some(0);
        while let Some(index) = next {
            let node = &self.nodes[index];
            if node.bounds.squared_distance(point) > least {
                next = waiting.pop();
                continue;
            }
            for &element in self.elements(node) {
                let distance = squared_distance(element);
                if distance < least || (distance == least && element < nearest) {
                    (nearest, least) = (element, distance);
                }
            }
            next = match node.count {
                0 => Some(self.nearer_child(index, point, &mut waiting)),
                _ => waiting.pop(),
            };
        }
        nearest
    }

    /// The child nearer to the point; the farther one waits.
    fn nearer_child(&self, index: usize, point: Vector3, waiting: &mut Stack) -> usize {
        let [left, right] = [index + 1, self.nodes[index].first];
        let distance = |child: usize| self.nodes[child].bounds.squared_distance(point);
        let (near, far) = if distance(right) < distance(left) { (right, left) } else { (left, right) };
        waiting.push(far);
        near
    }

    /// The elements of a leaf; none for a fork.
    fn elements(&self, node: &Node) -> &[Face] {
        if node.count == 0 { &[] } else { &self.order[node.first..node.first + node.count] }
    }
}

/// Adds the nodes over `order`, which begins at `first` in the tree's order; returns their box.
fn branch(
    boxes: &[Bounds],
    centers: &[Vector3],
    order: &mut [Face],
    first: usize,
    nodes: &mut Vec<Node>,
) -> Bounds {
    let index = nodes.len();
    if order.len() <= LEAF {
        let bounds = order.iter().fold(Bounds::default(), |all, &e| all.union(boxes[e]));
        nodes.push(Node { bounds, first, count: order.len() });
        return bounds;
    }
    nodes.push(Node { bounds: Bounds::default(), first: 0, count: 0 });
    // the index decides between equal centers, so that the order does not depend on the machine
    let axis = order.iter().fold(Bounds::default(), |all, &e| all.with(centers[e])).longest_axis();
    let place = |element: &Face| centers[*element][axis];
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
    let (left, right) = order.split_at_mut(middle);
    let left_bounds = branch(boxes, centers, left, first, nodes);
    nodes[index].first = nodes.len();
    let right_bounds = branch(boxes, centers, right, first + middle, nodes);
    nodes[index].bounds = left_bounds.union(right_bounds);
    nodes[index].bounds
}

/// The nodes still to be looked at.
struct Stack {
    nodes: [usize; STACK],
    height: usize,
}

impl Default for Stack {
    fn default() -> Self {
        Self { nodes: [0; STACK], height: 0 }
    }
}

impl Stack {
    fn push(&mut self, node: usize) {
        self.nodes[self.height] = node;
        self.height += 1;
    }

    fn pop(&mut self) -> Option<usize> {
        self.height = self.height.checked_sub(1)?;
        Some(self.nodes[self.height])
    }
}
