// SPDX-License-Identifier: MIT OR Apache-2.0
//! Checks before any work: of arrays that do not fit, and of outlines and pins that make folds inevitable.

use std::f64::consts::TAU;

use super::options::UntangleOptions;
use super::positions::Positions;
use crate::distortion::Image;
use crate::error::{Elements, Error, MapError};
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::Vector3;

/// Refuses arguments that do not fit the mesh.
pub(super) fn arguments(
    mesh: &TriangleMesh,
    image: Image<'_>,
    options: &UntangleOptions<'_>,
) -> Result<(), Error> {
    let n = mesh.n_vertices();
    let (rows, width) = match image {
        Image::Plane(map) => (map.len(), 2),
        Image::Sphere(map) => (map.len(), 3),
    };
    if rows != n {
        let (found, expected) = (format!("of shape ({rows}, {width})"), format!("of shape ({n}, {width})"));
        return Err(Error::InvalidArray { name: "image", found, expected });
    }
    let not_finite = |v: &usize| !image.point(Vertex::new(*v)).is_finite();
    if let Some(vertices) = Elements::collect((0..n).filter(not_finite)) {
        return Err(MapError::NonFinite { name: "image", vertices }.into());
    }
    if let Image::Sphere(map) = image
        && let Some(vertices) = Elements::collect((0..n).filter(|&v| map[v] == Vector3::ZERO))
    {
        return Err(MapError::NoDirection { name: "image", vertices }.into());
    }
    if let Some(&vertex) = options.fixed.iter().find(|&&vertex| vertex >= n) {
        let (found, expected) = (format!("{vertex}"), format!("indices of the {n} vertices"));
        return Err(Error::InvalidArray { name: "fixed", found, expected });
    }
    if (0.0..1.0).contains(&options.tolerance) {
        Ok(())
    } else {
        Err(Error::InvalidOption {
            name: "tolerance",
            found: options.tolerance.to_string(),
            expected: "a number ≥ 0 and < 1".into(),
        })
    }
}

/// The component of each vertex.
pub(super) fn components(mesh: &TriangleMesh) -> Vec<usize> {
    let mut component = vec![usize::MAX; mesh.n_vertices()];
    for (k, &face) in mesh.topology().first_faces.iter().enumerate() {
        let mut front = vec![mesh.faces()[face][0]];
        while let Some(vertex) = front.pop() {
            if component[vertex] == usize::MAX {
                component[vertex] = k;
                let corners = mesh.vertex_corners(vertex);
                front.extend(corners.iter().flat_map(|&corner| mesh.faces()[corner.face()]));
            }
        }
    }
    component
}

/// The vertices that stay: those of the boundary, and the fixed ones.
pub(super) fn held(mesh: &TriangleMesh, fixed: &[usize]) -> Vec<bool> {
    let mut held: Vec<bool> = Vertex::all(mesh.n_vertices()).map(|v| mesh.is_boundary(v)).collect();
    fixed.iter().for_each(|&vertex| held[vertex] = true);
    held
}

/// Refuses outlines and pins that provably admit no map without folds.
pub(super) fn feasible(
    mesh: &TriangleMesh,
    given: &Positions,
    components: &[usize],
    held: &[bool],
    folded: &[usize],
) -> Result<(), Error> {
    // 1. Faces whose corners all stay, or two of which stay and coincide
    let is_lost = |face: &&usize| {
        let kept: Vec<Vertex> = mesh.faces()[**face].into_iter().filter(|&v| held[v]).collect();
        let pairs = [(0, 1), (0, 2), (1, 2)];
        let touch = |&(a, b): &(usize, usize)| b < kept.len() && given.coincide(kept[a], kept[b]);
        kept.len() == 3 || pairs.iter().any(touch)
    };
    if let Some(faces) = Elements::collect(folded.iter().filter(is_lost).copied()) {
        let vertices = faces.first.iter().flat_map(|&face| mesh.faces()[face]);
        let mut vertices: Vec<Vertex> = vertices.filter(|&v| held[v]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let vertices = Elements::collect(vertices).expect("such a face has vertices that stay");
        return Err(MapError::HeldFolded { faces, vertices }.into());
    }
    // 2. Outlines in the plane that turn too little
    let Positions::Plane(map) = given else { return Ok(()) };
    for component in 0..mesh.n_components() {
        let of_component = |face: &&usize| components[mesh.faces()[**face][0]] == component;
        let Some(faces) = Elements::collect(folded.iter().filter(of_component).copied()) else { continue };
        let loops = mesh.boundary_loops().iter();
        let loops: Vec<&Vec<Vertex>> = loops.filter(|ring| components[ring[0]] == component).collect();
        if loops.is_empty() {
            let found =
                "flat on a part without a boundary, which cannot lie in the plane without folds".into();
            let expected = "of shape (n, 3) there, on a sphere; or cut the part open by seams".into();
            return Err(Error::InvalidArray { name: "image", found, expected });
        }
        let most: i64 = loops.iter().map(|ring| most_turns(ring, map)).sum();
        let needed = euler_characteristic(mesh, components, component, &loops);
        if most < needed {
            return Err(MapError::OutlineFolds { faces, turns: most, needed }.into());
        }
    }
    Ok(())
}

/// The counterclockwise turns of a loop; a corner at which it goes straight back counts as a half turn to the left.
fn most_turns(ring: &[Vertex], map: &[[f64; 2]]) -> i64 {
    let edges: Vec<[f64; 2]> = (0..ring.len())
        .map(|k| [ring[k], ring[(k + 1) % ring.len()]].map(|v| map[v]))
        .map(|[from, to]| [to[0] - from[0], to[1] - from[1]])
        .filter(|edge| *edge != [0.0; 2])
        .collect();
    let turn = |k: usize| {
        let (before, after) = (edges[k], edges[(k + 1) % edges.len()]);
        let sine = before[0] * after[1] - before[1] * after[0];
        let cosine = before[0] * after[0] + before[1] * after[1];
        // + 0 turns −0 into 0, a left turn
        (sine + 0.0).atan2(cosine)
    };
    ((0..edges.len()).map(turn).sum::<f64>() / TAU).round() as i64
}

/// Vertices − edges + faces of one component.
fn euler_characteristic(
    mesh: &TriangleMesh,
    components: &[usize],
    component: usize,
    loops: &[&Vec<Vertex>],
) -> i64 {
    let vertices = components.iter().filter(|&&c| c == component).count();
    let faces = mesh.faces().iter().filter(|face| components[face[0]] == component).count();
    let boundary: usize = loops.iter().map(|ring| ring.len()).sum();
    vertices as i64 - (3 * faces + boundary) as i64 / 2 + faces as i64
}

/// The fixed vertices within one edge of the faces, or all fixed vertices if there are none.
pub(super) fn pins_near(mesh: &TriangleMesh, fixed: &[usize], folded: &[usize]) -> Option<Elements> {
    let corners = folded.iter().flat_map(|&face| mesh.faces()[face]);
    let around = corners.flat_map(|vertex| mesh.vertex_corners(vertex));
    let mut near: Vec<usize> =
        around.flat_map(|&corner| mesh.faces()[corner.face()]).map(|v| v.index()).collect();
    near.sort_unstable();
    near.dedup();
    let mut pins: Vec<usize> =
        fixed.iter().copied().filter(|&vertex| !mesh.is_boundary(Vertex::new(vertex))).collect();
    pins.sort_unstable();
    pins.dedup();
    let close = Elements::collect(pins.iter().copied().filter(|pin| near.binary_search(pin).is_ok()));
    close.or_else(|| Elements::collect(pins))
}
