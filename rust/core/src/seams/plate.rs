// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shear of the best area-preserving map of a cut surface, predicted by one linear solve.
//!
//! Let h be the trace-free change of metric that makes the surface flat and keeps its areas. To first order
//! div div h = −2K with the Gauss curvature K. Among all such h with a free outline, ∫|h|² is least for h = −(∇∇ψ)₀ with
//! Δ²ψ = 4K and ψ = ∂ψ/∂n = 0 on all borders: the deflection of a plate that is clamped along boundary and seams and
//! loaded with the curvature. The map of a face then has ln(σ₁/σ₂) = |(∇∇ψ)₀| / √2 to first order. A cap of radius r on
//! a sphere of curvature K has K r² / 4, as Lambert's map; a cone of angle defect κ has κ / 2π.
//!
//! Discretization: Morley's triangle (L. S. D. Morley, The triangular equilibrium element in the solution of plate
//! bending problems, Aeronautical Quarterly 19, 1968). Unknowns are ψ at the vertices and its derivative along the
//! normal at the edges; the Hessian is constant on each face. Only edge lengths enter, so the mesh need not be flat.
//!
//! A cut is a set of pinned unknowns: those of the seams and of their vertices. The mesh is never cut; pins decouple
//! both banks of a seam. All cuts share one pattern, which is analyzed once; a solve is a numeric factorization.
//!
//! Input: a mesh of n vertices. Cost: one factorization of some 4n unknowns.

use sprs::CsMat;

use super::cut::Cut;
use super::edge_mesh::EdgeMesh;
use crate::control::Watch;
use crate::error::Error;
use crate::mesh::{Face, Vertex};
use crate::sparse::Cholesky;

/// What is added to the diagonal, over its mean; and what in a second attempt, where rounding has made the matrix
/// indefinite.
const SHIFTS: [f64; 2] = [1e-9, 1e-6];

/// The plate on one mesh.
#[derive(Debug)]
pub(super) struct Plate {
    n_vertices: usize,
    /// The unknowns of each face: of its corners, then of the edges opposite to them.
    unknowns: Vec<[u32; 6]>,
    /// The Hessian (xx, xy, yy) in each face's plane by its unknowns.
    hessians: Vec<[[f64; 3]; 6]>,
    /// The stiffness matrix without pins, upper triangle.
    stiffness: CsMat<f64>,
    /// Twice the angle defect at the vertices, 0 at the edges.
    load: Vec<f64>,
    /// The mean of the diagonal of `stiffness`.
    mean_diagonal: f64,
    analyzed: Cholesky,
}

/// Room for the solves of one thread.
#[derive(Debug, Clone)]
pub(super) struct Workspace {
    matrix: CsMat<f64>,
    factor: Cholesky,
}

/// The deflection of the plate for one cut.
#[derive(Debug, Clone)]
pub(super) struct Deflection {
    /// ψ at each vertex, (n,).
    pub psi: Vec<f64>,
    /// ln(σ₁/σ₂) of each face as predicted, (m,).
    pub shear: Vec<f64>,
}

impl Plate {
    /// Assembles and analyzes the plate on a mesh.
    ///
    /// # Errors
    /// [`NumericsError::FactorizationFailed`](crate::NumericsError::FactorizationFailed) where the mesh is too large
    /// for 32-bit indices.
    pub(super) fn new(mesh: &EdgeMesh) -> Result<Self, Error> {
        let n_vertices = mesh.n_vertices();
        let n_unknowns = n_vertices + mesh.n_edges();
        let unknowns: Vec<_> = Face::all(mesh.n_faces()).map(|face| unknowns_of(mesh, face)).collect();
        let hessians: Vec<_> = Face::all(mesh.n_faces()).map(|face| hessian(mesh, face)).collect();
        let stiffness = assemble(n_unknowns, &unknowns, &hessians, &mesh.areas);
        let mut load = vec![0.0; n_unknowns];
        load.iter_mut().zip(mesh.angle_defects()).for_each(|(load, defect)| *load = 2.0 * defect);
        let diagonal: f64 = stiffness.iter().filter(|(_, (row, column))| row == column).map(|(x, _)| x).sum();
        let analyzed = Cholesky::analyze(&stiffness)?;
        let mean_diagonal = diagonal / n_unknowns as f64;
        Ok(Self { n_vertices, unknowns, hessians, stiffness, load, mean_diagonal, analyzed })
    }

    /// Room for the solves of one thread.
    pub(super) fn workspace(&self) -> Workspace {
        Workspace { matrix: self.stiffness.clone(), factor: self.analyzed.clone() }
    }

    /// The deflection under a cut: on the `faces` (m,) for which it is asked, where ψ of all other faces is held; on
    /// all others the shear is 0.
    ///
    /// # Errors
    /// [`NumericsError::FactorizationFailed`](crate::NumericsError::FactorizationFailed) where the mesh is degenerate
    /// to working precision, [`Error::CancelledEarly`] where the watch's observer ends the run.
    pub(super) fn solve(
        &self,
        mesh: &EdgeMesh,
        cut: &Cut,
        faces: Option<&[bool]>,
        workspace: &mut Workspace,
        watch: &Watch<'_>,
    ) -> Result<Deflection, Error> {
        let is_pinned = self.pins(mesh, cut, faces);
        self.factor(&is_pinned, workspace, watch)?;
        let mut psi = self.load.clone();
        psi.iter_mut().zip(&is_pinned).filter(|(_, is_pinned)| **is_pinned).for_each(|(x, _)| *x = 0.0);
        workspace.factor.solve(&mut psi);
        let shear = self.shear(&psi, faces);
        psi.truncate(self.n_vertices);
        Ok(Deflection { psi, shear })
    }

    /// Whether each unknown is held.
    fn pins(&self, mesh: &EdgeMesh, cut: &Cut, faces: Option<&[bool]>) -> Vec<bool> {
        let mut is_pinned = vec![faces.is_some(); self.load.len()];
        if let Some(faces) = faces {
            let unknowns = self.unknowns.iter().zip(faces).filter(|(_, is_asked)| **is_asked);
            unknowns
                .flat_map(|(unknowns, _)| unknowns)
                .for_each(|&unknown| is_pinned[unknown as usize] = false);
        }
        for edge in mesh.edges.all().filter(|&edge| cut.is_border(mesh, edge)) {
            is_pinned[self.n_vertices + edge.index()] = true;
            mesh.edges.ends(edge).iter().for_each(|&vertex| is_pinned[vertex.index()] = true);
        }
        is_pinned
    }

    /// Factors the stiffness matrix with the rows and columns of pins masked.
    fn factor(&self, is_pinned: &[bool], workspace: &mut Workspace, watch: &Watch<'_>) -> Result<(), Error> {
        let mut outcome = Ok(());
        for shift in SHIFTS {
            let (shift, values) = (shift * self.mean_diagonal, workspace.matrix.data_mut());
            for (value, (&entry, (row, column))) in values.iter_mut().zip(self.stiffness.iter()) {
                *value = match (is_pinned[row] || is_pinned[column], row == column) {
                    (true, true) => self.mean_diagonal,
                    (true, false) => 0.0,
                    (false, true) => entry + shift,
                    (false, false) => entry,
                };
            }
            outcome = workspace.factor.refactor_while(&workspace.matrix, watch);
            if !matches!(outcome, Err(Error::Numerics(_))) {
                break;
            }
        }
        outcome
    }

    fn shear(&self, x: &[f64], faces: Option<&[bool]>) -> Vec<f64> {
        let of_face = |(face, (unknowns, hessians)): (usize, (&[u32; 6], &[[f64; 3]; 6]))| {
            if faces.is_some_and(|faces| !faces[face]) {
                return 0.0;
            }
            let mut hessian = [0.0; 3];
            for (&unknown, basis) in unknowns.iter().zip(hessians) {
                hessian.iter_mut().zip(basis).for_each(|(sum, value)| *sum += value * x[unknown as usize]);
            }
            (0.5 * (hessian[0] - hessian[2])).hypot(hessian[1])
        };
        self.unknowns.iter().zip(&self.hessians).enumerate().map(of_face).collect()
    }
}

/// The unknowns of a face: of its corners, then of the edges opposite to them.
fn unknowns_of(mesh: &EdgeMesh, face: Face) -> [u32; 6] {
    let [a, b, c] = mesh.mesh.faces()[face].map(Vertex::index);
    let [d, e, f] = [0, 1, 2].map(|k| mesh.n_vertices() + mesh.edge_of(face, k).index());
    [a, b, c, d, e, f].map(|unknown| unknown as u32)
}

/// The Hessian (xx, xy, yy) of Morley's triangle by its six unknowns: (1/A) Σ_e l_e ∇ψ_e ⊗ n_e, made symmetric, with
/// ∇ψ_e = (ψ_b − ψ_a)/l_e t_e + d_e n_e.
fn hessian(mesh: &EdgeMesh, face: Face) -> [[f64; 3]; 6] {
    let corners = laid_flat(mesh.side_lengths(face), mesh.areas[face]);
    let mut basis = [[0.0; 3]; 6];
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let along = [corners[j][0] - corners[i][0], corners[j][1] - corners[i][1]];
        let length = along[0].hypot(along[1]);
        let tangent = along.map(|x| x / length);
        let normal = [tangent[1], -tangent[0]];
        // the unknown of an edge points from its first face to its second
        let sign = if mesh.faces_at(mesh.edge_of(face, k)).0 == face { 1.0 } else { -1.0 };
        let by_end = tangent.map(|x| x / length);
        let gradients = [(i, by_end.map(|x| -x)), (j, by_end), (3 + k, normal.map(|x| x * sign))];
        for (unknown, gradient) in gradients {
            let factor = length / mesh.areas[face];
            basis[unknown][0] += factor * gradient[0] * normal[0];
            basis[unknown][1] += factor * 0.5 * (gradient[0] * normal[1] + gradient[1] * normal[0]);
            basis[unknown][2] += factor * gradient[1] * normal[1];
        }
    }
    basis
}

/// The corners of a triangle in the plane, counterclockwise, from the sides opposite to them and its area.
fn laid_flat([a, b, c]: [f64; 3], area: f64) -> [[f64; 2]; 3] {
    [[0.0, 0.0], [c, 0.0], [(b * b + c * c - a * a) / (2.0 * c), 2.0 * area / c]]
}

/// The sum of the faces' matrices A/2 Hᵀ H, which is coercive and for clamped flat plates equal to that of the
/// trace-free part of H; upper triangle.
fn assemble(
    n_unknowns: usize,
    unknowns: &[[u32; 6]],
    hessians: &[[[f64; 3]; 6]],
    areas: &[f64],
) -> CsMat<f64> {
    let mut entries = Vec::with_capacity(21 * unknowns.len());
    for ((unknowns, hessian), area) in unknowns.iter().zip(hessians).zip(areas) {
        for i in 0..6 {
            for j in 0..=i {
                let [p, q] = [hessian[i], hessian[j]];
                let value = 0.5 * area * (p[0] * q[0] + 2.0 * p[1] * q[1] + p[2] * q[2]);
                let [row, column] = [unknowns[i].min(unknowns[j]), unknowns[i].max(unknowns[j])];
                entries.push((u64::from(column) << 32 | u64::from(row), value));
            }
        }
    }
    // a stable sort: entries of one place are added in the order of the faces
    entries.sort_by_key(|&(place, _)| place);
    let mut starts = vec![0; n_unknowns + 1];
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for entries in entries.chunk_by(|a, b| a.0 == b.0) {
        starts[(entries[0].0 >> 32) as usize + 1] += 1;
        rows.push(entries[0].0 as u32 as usize);
        values.push(entries.iter().map(|(_, value)| value).sum());
    }
    for column in 0..n_unknowns {
        starts[column + 1] += starts[column];
    }
    CsMat::new_csc((n_unknowns, n_unknowns), starts, rows, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::mesh::geometry::triangle;
    use crate::seams::sample_surfaces::rings;

    fn cap(n: usize, radius: f64) -> EdgeMesh {
        let place = |r: f64, angle: f64| {
            let theta = radius * r;
            [theta.sin() * angle.cos(), theta.sin() * angle.sin(), theta.cos()]
        };
        EdgeMesh::new(rings(n, place))
    }

    /// A cone whose apex lacks the angle `defect`.
    fn cone(n: usize, defect: f64) -> EdgeMesh {
        let width = 1.0 - defect / std::f64::consts::TAU;
        let height = (1.0 - width * width).sqrt();
        let place = |r: f64, angle: f64| [width * r * angle.cos(), width * r * angle.sin(), -height * r];
        EdgeMesh::new(rings(n, place))
    }

    /// The seams along the diameter of a disk of rings, which leave it at angle 0 and π.
    fn diameter(mesh: &EdgeMesh, n: usize) -> Cut {
        let spoke = |sector: usize| (1..=n).map(move |ring| 1 + 3 * ring * (ring - 1) + sector * ring);
        let path: Vec<_> = spoke(3).rev().chain([0]).chain(spoke(0)).map(Vertex::new).collect();
        Cut::none(mesh).with(&mesh.path_edges(&path))
    }

    fn solved(mesh: &EdgeMesh, cut: &Cut, faces: Option<&[bool]>) -> Deflection {
        let plate = Plate::new(mesh).unwrap();
        let mut silent = Silent;
        let watch = Watch::new(&mut silent, 0.0, "");
        plate.solve(mesh, cut, faces, &mut plate.workspace(), &watch).unwrap()
    }

    fn shear(mesh: &EdgeMesh) -> Vec<f64> {
        solved(mesh, &Cut::none(mesh), None).shear
    }

    fn mean(mesh: &EdgeMesh, values: impl Iterator<Item = f64>) -> f64 {
        mesh.areas.iter().zip(values).map(|(area, value)| area * value).sum()
    }

    /// The mean of σ₁/σ₂ of Lambert's map of a cap, whose stretches are cos(θ/2) and its inverse.
    fn lambert_mean(radius: f64) -> f64 {
        let n = 100_000;
        let terms = (0..n).map(|k| {
            let theta = radius * (f64::from(k) + 0.5) / f64::from(n);
            [theta.sin() / (0.5 * theta).cos().powi(2), theta.sin()]
        });
        let [sum, area] = terms.fold([0.0; 2], |sum, x| [sum[0] + x[0], sum[1] + x[1]]);
        sum / area
    }

    /// The mean error of the predicted shear of each face of a cap, and that of the mean of σ₁/σ₂.
    fn errors_on_cap(n: usize, radius: f64) -> [f64; 2] {
        let mesh = cap(n, radius);
        let (shear, points) = (shear(&mesh), mesh.mesh.points());
        let errors = mesh.mesh.faces().iter().zip(&shear).map(|(&face, shear)| {
            let [a, b, c] = triangle(points, face);
            let chord = points[0].distance((a + b + c) * (1.0 / 3.0)) * mesh.mesh.scale();
            // θ²/4 at the distance θ from the apex
            (shear - (0.5 * chord).asin().powi(2)).abs()
        });
        let mean_ratio = mean(&mesh, shear.iter().map(|shear| shear.exp()));
        [mean(&mesh, errors), (mean_ratio - lambert_mean(radius)).abs()]
    }

    #[test]
    fn a_cap_is_sheared_by_a_quarter_of_its_squared_radius() {
        // what is left is of second order in the curvature
        for (radius, of_face, of_mean) in [(0.4, 0.0015, 1e-4), (0.8, 0.007, 1e-3), (1.2, 0.022, 5e-3)] {
            let errors = [8, 16, 32].map(|n| errors_on_cap(n, radius));
            assert!(errors[2][0] < of_face && errors[2][1] < of_mean, "{radius} {errors:?}");
            for pair in errors.windows(2).filter(|_| radius < 1.0) {
                assert!(
                    pair[1][0] < 0.55 * pair[0][0] && pair[1][1] < 0.55 * pair[0][1],
                    "{radius} {errors:?}"
                );
            }
        }
    }

    #[test]
    fn a_cone_is_sheared_alike_everywhere() {
        for defect in [0.3, 0.6, 1.0] {
            // κ / 2π to first order; on the cone itself its angle takes the place of 2π
            let expected = defect / (std::f64::consts::TAU - defect);
            let errors = [8, 16, 32].map(|n| {
                let mesh = cone(n, defect);
                mean(&mesh, shear(&mesh).iter().map(|shear| (shear - expected).abs()))
            });
            assert!(errors[2] < 0.08 * expected, "{defect} {errors:?}");
            assert!(errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]), "{defect} {errors:?}");
        }
    }

    #[test]
    fn a_flat_plate_stays_flat() {
        let mesh = EdgeMesh::new(rings(10, |r, angle| [r * angle.cos(), r * angle.sin(), 1.0]));
        assert!(shear(&mesh).iter().all(|&shear| shear < 1e-9));
    }

    #[test]
    fn a_slit_lowers_the_shear_of_a_cap() {
        let mesh = cap(12, 1.2);
        let ratios = |cut: &Cut| mean(&mesh, solved(&mesh, cut, None).shear.into_iter().map(f64::exp));
        let whole = ratios(&Cut::none(&mesh));
        let slit: Vec<_> = diameter(&mesh, 12).seams().collect();
        let half = ratios(&Cut::none(&mesh).with(&slit[..12]));
        let parted = ratios(&Cut::none(&mesh).with(&slit));
        assert!(parted < half && half < whole, "{parted} {half} {whole}");
    }

    #[test]
    fn an_island_bends_by_itself() {
        let mesh = cap(10, 1.0);
        let cut = diameter(&mesh, 10);
        let islands = cut.islands(&mesh);
        assert_eq!(islands.len(), 2);
        let whole = solved(&mesh, &cut, None);
        for island in 0..2 {
            let faces: Vec<_> = islands.of_face.iter().map(|&label| label == island).collect();
            let alone = solved(&mesh, &cut, Some(&faces));
            for (face, &is_asked) in faces.iter().enumerate() {
                let expected = if is_asked { whole.shear[face] } else { 0.0 };
                assert!((alone.shear[face] - expected).abs() < 1e-9);
            }
        }
    }
}
