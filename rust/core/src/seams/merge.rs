// SPDX-License-Identifier: MIT OR Apache-2.0
//! Islands that join neighbors.
//!
//! Two disks that share a segment become one disk without it; what else they share stays as slits.

use super::cut::{Cut, Islands};
use super::edge_mesh::EdgeMesh;
use crate::mesh::Edge;

/// The cut without islands beyond a number: the smallest join their neighbors.
pub(super) fn merged(mesh: &EdgeMesh, cost: &[f64], mut cut: Cut, most: usize) -> Cut {
    let given = Cut::none(mesh);
    loop {
        let islands = cut.islands(mesh);
        if islands.len() <= most {
            return cut;
        }
        let smallest_first = by_area(&islands);
        match smallest_first
            .into_iter()
            .find_map(|island| joined(mesh, cost, (&cut, &given), &islands, island, |edges| edges.to_vec()))
        {
            Some(joined) => cut = joined,
            None => return cut,
        }
    }
}

/// The islands, the smallest first.
pub(super) fn by_area(islands: &Islands) -> Vec<usize> {
    let mut order: Vec<_> = (0..islands.len()).collect();
    order.sort_by(|&a, &b| islands.areas[a].total_cmp(&islands.areas[b]).then(a.cmp(&b)));
    order
}

/// The cut in which an island has joined the neighbor with which it shares the dearest segment, `given` seams staying;
/// `with_partners` adds edges that go with others.
pub(super) fn joined(
    mesh: &EdgeMesh,
    cost: &[f64],
    (cut, given): (&Cut, &Cut),
    islands: &Islands,
    island: usize,
    with_partners: impl Fn(&[Edge]) -> Vec<Edge>,
) -> Option<Cut> {
    let separates = |&edge: &Edge| match mesh.faces_at(edge) {
        (first, Some(second)) => {
            let sides = [first, second].map(|face| islands.of_face[face] as usize);
            sides[0] != sides[1] && sides.contains(&island)
        }
        _ => false,
    };
    let mut shared: Vec<_> = cut.segments(mesh);
    shared.retain(|segment| {
        segment.edges.iter().all(separates) && !segment.edges.iter().any(|&edge| given.is_seam(edge))
    });
    let cost_of = |edges: &[Edge]| edges.iter().map(|&edge| cost[edge]).sum::<f64>();
    shared.sort_by(|a, b| cost_of(&b.edges).total_cmp(&cost_of(&a.edges)));
    // a ring on a sphere stays in part, as a slit
    let removals = |edges: &[Edge]| [edges.to_vec(), edges[..edges.len() / 2].to_vec()];
    let mut without = shared
        .iter()
        .flat_map(|segment| removals(&segment.edges))
        .map(|edges| cut.without(&with_partners(&edges)));
    without.find(|cut| {
        let joined = cut.islands(mesh);
        joined.are_disks() && joined.len() < islands.len()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Vertex;
    use crate::seams::sample_surfaces::{flat_grid, sphere};

    #[test]
    fn the_smallest_islands_join_until_no_more_are_left_than_wanted() {
        let mesh = EdgeMesh::new(flat_grid(8, 6));
        let column = |i: u32| mesh.path_edges(&(0..=6).map(|j| Vertex(9 * j + i)).collect::<Vec<_>>());
        let cut = Cut::none(&mesh).with(&[column(1), column(3), column(6)].concat());
        assert_eq!(merged(&mesh, &mesh.lengths, cut.clone(), 4), cut);
        let without_first = cut.without(&column(1));
        assert_eq!(merged(&mesh, &mesh.lengths, cut.clone(), 3), without_first);
        assert!(merged(&mesh, &mesh.lengths, cut, 1).is_empty());
    }

    #[test]
    fn a_ring_on_a_sphere_becomes_a_slit() {
        let mesh = EdgeMesh::new(sphere(3));
        let is_on_equator = |vertex: &Vertex| mesh.mesh.points()[*vertex][2].abs() < 1e-9;
        let ring = mesh.edges.all().filter(|&edge| mesh.edges.ends(edge).iter().all(is_on_equator));
        let cut = Cut::none(&mesh).with(&ring.collect::<Vec<_>>());
        assert_eq!(cut.islands(&mesh).len(), 2);
        let merged = merged(&mesh, &mesh.lengths, cut, 1);
        assert_eq!(merged.islands(&mesh).euler_characteristics, [1]);
    }
}
