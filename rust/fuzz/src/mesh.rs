// SPDX-License-Identifier: MIT OR Apache-2.0
//! Construction: any arrays are a surface or an error that names elements there are.

use authalic::Surface;

use super::Input;

/// One run of the target; whether it came to a result to look at.
pub fn check(bytes: &[u8]) -> bool {
    let (vertices, faces) = Input::new(bytes).arrays();
    let (n, m) = (vertices.nrows(), faces.nrows());
    let surface = match Surface::new(vertices.view(), faces.view()) {
        Ok(surface) => surface,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return false;
        }
    };
    assert_eq!((surface.n_vertices(), surface.n_faces()), (n, m));
    let topology = surface.topology();
    match &topology {
        Ok(topology) => {
            assert!(topology.is_disk() as u8 + topology.is_closed() as u8 <= 1);
            let oriented = surface.oriented_faces().expect("a surface with a topology");
            // Each edge is passed at most once in each direction.
            let mut passed = std::collections::BTreeSet::new();
            for face in oriented.rows() {
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    assert!(passed.insert([face[a], face[b]]), "an edge is passed twice");
                }
            }
        }
        Err(error) => {
            let elements = error.elements().map_or(&[][..], |elements| &elements.first);
            assert!(elements.iter().all(|&index| index < n.max(m)), "{error}");
            assert!(!error.to_string().is_empty());
        }
    }
    topology.is_ok()
}
