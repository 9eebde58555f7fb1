// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seams that make a surface of any genus, with any number of boundary loops, one disk.
//!
//! Tree–cotree decomposition (D. Eppstein, Dynamic generators of topologically embedded graphs, SODA 2003; J. Erickson,
//! K. Whittlesey, Greedy optimal homotopy and homology generators, SODA 2005):
//!
//! 1. A tree of cheapest paths from a root, along which boundary and given seams are nearly free; it meets each of their
//!    components once, also where several paths to it cost the same.
//! 2. A spanning tree of the faces across the edges outside that tree, which prefers edges that close long loops.
//! 3. The edges in neither tree and the tree's own paths to them are a cut graph; dangling branches are trimmed.
//!
//! The cheapest of several roots is taken. A closed surface of genus 0 stays closed, unless there is a given seam on it: a
//! single edge, which opens nothing, is prolonged. Cost: O(e log e) a root.

use super::cut::Cut;
use super::edge_mesh::EdgeMesh;
use super::paths::Paths;
use crate::mesh::{Edge, Vertex};
use crate::sets::Sets;

/// The number of roots tried.
const ROOTS: usize = 8;

/// The cost of edges of the boundary and of given seams, over the mean cost.
const NEARLY_FREE: f64 = 1e-9;

/// The cheapest cut found that contains `given` and leaves disks only, or closed surfaces of genus 0.
pub(super) fn cut_graph(mesh: &EdgeMesh, cost: &[f64], given: &Cut) -> Cut {
    let cost_of =
        |cut: &Cut| cut.seams().filter(|&edge| !given.is_seam(edge)).map(|edge| cost[edge]).sum::<f64>();
    let cuts = roots(mesh, given).into_iter().map(|root| from_root(mesh, cost, given, root));
    let cheapest = cuts.map(|cut| (cost_of(&cut), cut)).min_by(|a, b| a.0.total_cmp(&b.0));
    let mut cut = cheapest.map_or_else(|| given.clone(), |(_, cut)| cut);
    prolong(mesh, cost, &mut cut);
    cut
}

/// Prolongs single seams on closed islands by the cheapest edge.
fn prolong(mesh: &EdgeMesh, cost: &[f64], cut: &mut Cut) {
    let islands = cut.islands(mesh);
    let is_closed =
        |edge: Edge| islands.euler_characteristics[islands.of_face[mesh.faces_at(edge).0] as usize] == 2;
    for seam in cut.seams().filter(|&edge| is_closed(edge)).collect::<Vec<_>>() {
        let around = mesh.edges.ends(seam).into_iter().flat_map(|vertex| mesh.edges.around(vertex));
        let next = around.map(|&(_, edge)| edge).filter(|&edge| edge != seam);
        let cheapest = next.min_by(|&a, &b| cost[a].total_cmp(&cost[b]).then(a.cmp(&b)));
        cheapest.into_iter().for_each(|edge| cut.add(&[edge]));
    }
}

/// Vertices of the borders where there are any, else of the whole mesh, evenly by index.
fn roots(mesh: &EdgeMesh, given: &Cut) -> Vec<Vertex> {
    let on_border = given.border_vertices(mesh);
    let mut candidates: Vec<_> = Vertex::all(mesh.n_vertices()).filter(|&vertex| on_border[vertex]).collect();
    if candidates.is_empty() {
        candidates = Vertex::all(mesh.n_vertices()).collect();
    }
    let n = ROOTS.min(candidates.len());
    (0..n).map(|k| candidates[k * (candidates.len() - 1) / (n - 1).max(1)]).collect()
}

fn from_root(mesh: &EdgeMesh, cost: &[f64], given: &Cut, root: Vertex) -> Cut {
    // 1. The tree
    let free = NEARLY_FREE * cost.iter().filter(|cost| cost.is_finite()).sum::<f64>() / cost.len() as f64;
    let cost_of = |edge: Edge| if given.is_border(mesh, edge) { free } else { cost[edge] };
    let costs: Vec<_> = mesh.edges.all().map(cost_of).collect();
    let tree = Paths::from(mesh, &[root], &costs);
    let is_in_tree = mark_tree(mesh, given, &tree);
    // 2. The cotree
    let mut crossed: Vec<_> = mesh
        .edges
        .all()
        .filter(|&edge| !given.is_border(mesh, edge) && !is_in_tree[edge])
        .map(|edge| {
            let [a, b] = mesh.edges.ends(edge);
            (tree.costs[a] + tree.costs[b] + costs[edge], edge)
        })
        .collect();
    crossed.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut faces = Sets::new(mesh.n_faces());
    let in_cotree = crossed.into_iter().map(|(_, edge)| edge).filter(|&edge| {
        let (first, second) = mesh.faces_at(edge);
        second.is_some_and(|second| faces.join(first.index(), second.index()))
    });
    // 3. What is left
    let mut cut = Cut::none(mesh);
    cut.add(&mesh.edges.all().filter(|&edge| !mesh.edges.is_boundary(edge)).collect::<Vec<_>>());
    cut.remove(&in_cotree.collect::<Vec<_>>());
    cut.add(&given.seams().collect::<Vec<_>>());
    trim(mesh, &mut cut, given);
    cut
}

/// Whether each edge is in a spanning tree of paths, where all vertices of a border count as one.
fn mark_tree(mesh: &EdgeMesh, given: &Cut, tree: &Paths) -> Vec<bool> {
    let mut vertices = Sets::new(mesh.n_vertices());
    let mut join = |edge: Edge| {
        let [a, b] = mesh.edges.ends(edge);
        vertices.join(a.index(), b.index())
    };
    mesh.edges.all().filter(|&edge| given.is_border(mesh, edge)).for_each(|edge| _ = join(edge));
    let reached =
        |edge: Edge| mesh.edges.ends(edge).map(|vertex| tree.costs[vertex]).into_iter().fold(0.0, f64::max);
    let mut steps: Vec<_> = mesh.edges.all().filter(|&edge| tree.uses(mesh, edge)).collect();
    steps.sort_by(|&a, &b| reached(a).total_cmp(&reached(b)).then(a.cmp(&b)));
    let mut is_in_tree = vec![false; mesh.n_edges()];
    steps.into_iter().filter(|&edge| join(edge)).for_each(|edge| is_in_tree[edge] = true);
    is_in_tree
}

/// Removes seams that end freely, except given ones.
fn trim(mesh: &EdgeMesh, cut: &mut Cut, given: &Cut) {
    let mut degrees = cut.degrees(mesh, true);
    let mut pending: Vec<_> = Vertex::all(mesh.n_vertices()).filter(|&vertex| degrees[vertex] == 1).collect();
    while let Some(vertex) = pending.pop() {
        let around = mesh.edges.around(vertex).iter();
        let dangling = around.copied().find(|&(_, edge)| cut.is_seam(edge) && !given.is_seam(edge));
        let Some((neighbor, edge)) = dangling.filter(|_| degrees[vertex] == 1) else { continue };
        cut.remove(&[edge]);
        degrees[vertex] -= 1;
        degrees[neighbor] -= 1;
        if degrees[neighbor] == 1 {
            pending.push(neighbor);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriangleMesh;
    use crate::seams::sample_surfaces::{
        flat_grid, perforated_cylinder, plate_with_holes, random_numbers, sphere, torus,
    };

    fn surfaces() -> Vec<TriangleMesh> {
        vec![torus(), plate_with_holes(1), plate_with_holes(2), plate_with_holes(3), perforated_cylinder()]
    }

    #[test]
    fn any_surface_becomes_one_disk_without_free_ends() {
        for surface in surfaces() {
            let mesh = EdgeMesh::new(surface);
            let mut random = random_numbers(3);
            let costs: Vec<_> = mesh.lengths.iter().map(|length| length * (0.5 + random())).collect();
            for cost in [&mesh.lengths, &costs] {
                let cut = cut_graph(&mesh, cost, &Cut::none(&mesh));
                assert_eq!(cut.islands(&mesh).euler_characteristics, [1]);
                assert_eq!(cut.n_leaves(&mesh), 0);
                assert!(cut.seams().all(|edge| !mesh.edges.is_boundary(edge)));
            }
        }
    }

    #[test]
    fn disks_and_closed_spheres_stay_whole() {
        for surface in [flat_grid(5, 4), sphere(3)] {
            let mesh = EdgeMesh::new(surface);
            assert!(cut_graph(&mesh, &mesh.lengths, &Cut::none(&mesh)).is_empty());
        }
    }

    #[test]
    fn a_single_seam_on_a_closed_sphere_is_prolonged() {
        let mesh = EdgeMesh::new(sphere(2));
        let given = Cut::none(&mesh).with(&[Edge(17)]);
        assert_eq!(given.islands(&mesh).euler_characteristics, [2]);
        let cut = cut_graph(&mesh, &mesh.lengths, &given);
        assert!(cut.is_seam(Edge(17)) && cut.seams().count() == 2);
        assert_eq!(cut.islands(&mesh).euler_characteristics, [1]);
    }

    #[test]
    fn given_seams_stay_with_their_free_ends() {
        let mesh = EdgeMesh::new(torus());
        let slit = mesh.path_edges(&(300..310).map(Vertex).collect::<Vec<_>>());
        let given = Cut::none(&mesh).with(&slit);
        let cut = cut_graph(&mesh, &mesh.lengths, &given);
        assert!(slit.iter().all(|&edge| cut.is_seam(edge)));
        assert_eq!(cut.islands(&mesh).euler_characteristics, [1]);
        assert!(cut.n_leaves(&mesh) <= 2);
    }

    #[test]
    fn forbidden_edges_are_avoided_where_others_lead_around_them() {
        for surface in surfaces() {
            let mesh = EdgeMesh::new(surface);
            let mut random = random_numbers(5);
            let forbid = |length: &f64| if random() < 0.1 { f64::INFINITY } else { *length };
            let cost: Vec<_> = mesh.lengths.iter().map(forbid).collect();
            let cut = cut_graph(&mesh, &cost, &Cut::none(&mesh));
            assert_eq!(cut.islands(&mesh).euler_characteristics, [1]);
            assert!(cut.sum(&cost).is_finite());
        }
    }

    #[test]
    fn the_cut_of_a_torus_is_about_as_short_as_its_two_circles() {
        let mesh = EdgeMesh::new(torus());
        let cut = cut_graph(&mesh, &mesh.lengths, &Cut::none(&mesh));
        // the inner circle of radius 1.2 and a meridian of radius .8
        let circles = std::f64::consts::TAU * 2.0 / (mesh.unit * mesh.mesh.scale());
        assert!(cut.sum(&mesh.lengths) < 1.05 * circles);
    }
}
