// SPDX-License-Identifier: MIT OR Apache-2.0
//! Start maps of free outline: plan view, as rigid as possible, conformal; the best of those that are one-to-one.

use super::arap::as_rigid_as_possible;
use super::energy::Energy;
use super::lscm::{of_area_one, spectral_conformal};
use super::mend::{mended, turns_once_around_every_vertex};
use super::outline::Outline;
use super::poisson::Poisson;
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::mesh::geometry::{area_vector, triangle};
use crate::parallel;
use crate::sparse::{Analysis, Failure};
use crate::vector::Vector3;

/// A later start replaces an earlier one only if its energy is below this part of it, so that rounding breaks no tie.
const MARGIN: f64 = 0.9;

/// Least sum of the area vectors, relative to the area, for a plan view.
const STEEPEST: f64 = 0.05;

/// Local and global steps toward a map that is as rigid as possible.
const RIGID_STEPS: usize = 15;

/// Those that follow on a map assembled from wanted images, one after another until it is one-to-one.
const ASSEMBLED_STEPS: [usize; 4] = [0, 1, 2, 5];

/// Vertices that touch an edge of the outline are moved inwards by this part of the height beside them.
const PULL: f64 = 1e-3;

/// The parts of the time after which the conformal map is known, and then the factor with which it is made more rigid.
const CONFORMAL: f64 = 0.4;
const FACTORED: f64 = 0.6;

/// A start of free outline with its energy.
pub(super) type Start = (f64, PlanarMap);

/// The start of lowest energy; `None` where none is one-to-one.
pub(super) fn best_start(
    energy: &Energy<'_>,
    analysis: &Analysis,
    outline: Option<&Outline>,
    weight: f64,
    watch: &Watch<'_>,
) -> Result<Option<Start>, Failure> {
    let mut best: Option<Start> = None;
    let mut consider = |map: PlanarMap| {
        let verdict = allowed(energy, outline, map);
        let value = verdict.as_ref().map(|map| energy.value(map, weight));
        if let (Some(map), Some(value)) = (verdict, value)
            && best.as_ref().is_none_or(|(least, _)| value < MARGIN * least)
        {
            best = Some((value, map));
        }
    };
    if let Some(map) = plan_view(energy) {
        consider(map);
    }
    let conformal = match spectral_conformal(energy, analysis, watch) {
        Err(Failure::Cancelled) => return Err(Failure::Cancelled),
        conformal => conformal.ok(),
    };
    watch.reach(CONFORMAL);
    if let Some(conformal) = conformal {
        let rigid = Poisson::new(energy, watch).and_then(|poisson| {
            watch.reach(FACTORED);
            as_rigid_as_possible(energy, &poisson, conformal.clone(), RIGID_STEPS, watch)
        });
        match rigid {
            Err(Failure::Cancelled) => return Err(Failure::Cancelled),
            rigid => {
                rigid.into_iter().for_each(|map| consider(of_area_one(energy, mended(energy, map))));
            }
        }
        consider(conformal);
    }
    Ok(best)
}

/// The map whose faces are nearest to wanted images, made more rigid and mended until it is one-to-one.
pub(super) fn assembled(
    energy: &Energy<'_>,
    outline: Option<&Outline>,
    shapes: &[[[f64; 2]; 3]],
    watch: &Watch<'_>,
) -> Option<PlanarMap> {
    let poisson = Poisson::new(energy, watch).ok()?;
    let jacobians = parallel::map(shapes.len(), |face| energy.entries_of(shapes[face], face));
    let mut map = of_area_one(energy, poisson.map(energy, &jacobians));
    for steps in ASSEMBLED_STEPS {
        map = as_rigid_as_possible(energy, &poisson, map, steps, watch).ok()?;
        let mended = of_area_one(energy, mended(energy, map.clone()));
        if let Some(start) = allowed(energy, outline, mended) {
            return Some(start);
        }
    }
    None
}

/// The map, pulled in where its outline only touches itself; `None` where it is not one-to-one.
pub(super) fn allowed(energy: &Energy<'_>, outline: Option<&Outline>, map: PlanarMap) -> Option<PlanarMap> {
    let is_finite = map.iter().flatten().all(|x| x.is_finite());
    if !is_finite || !energy.is_unfolded(&map) || !turns_once_around_every_vertex(energy, &map) {
        return None;
    }
    let Some(outline) = outline else { return Some(map) };
    if outline.is_simple(&map) {
        return Some(map);
    }
    let pulled = pulled_in(energy, outline, &map);
    (energy.is_unfolded(&pulled) && outline.is_simple(&pulled)).then_some(pulled)
}

/// The map with vertices that touch an edge of the outline moved a little toward their neighbors.
fn pulled_in(energy: &Energy<'_>, outline: &Outline, map: &[[f64; 2]]) -> PlanarMap {
    let mesh = energy.mesh;
    let mut pulled = map.to_vec();
    for contact in outline.contacts(map, PULL) {
        let v = contact.vertices[0];
        let corners = mesh.vertex_corners(v);
        let mut sum = [0.0; 2];
        for &corner in corners {
            let face = mesh.faces()[corner.face()];
            for k in 1..3 {
                let x = map[face[(corner.place() + k) % 3]];
                (0..2).for_each(|axis| sum[axis] += x[axis] - map[v][axis]);
            }
        }
        let length = sum[0].hypot(sum[1]);
        let by = PULL * contact.height_of_reach(PULL) / length.max(f64::MIN_POSITIVE);
        pulled[v] = [map[v][0] + by * sum[0], map[v][1] + by * sum[1]];
    }
    pulled
}

/// The projection along the sum of the area vectors.
pub(super) fn plan_view(energy: &Energy<'_>) -> Option<PlanarMap> {
    let mesh = energy.mesh;
    let normal = mesh
        .faces()
        .iter()
        .fold(Vector3::ZERO, |sum, &face| sum + area_vector(triangle(mesh.points(), face)));
    let length = normal.norm();
    if length < STEEPEST * mesh.face_areas().iter().sum::<f64>() {
        return None;
    }
    let normal = normal * (1.0 / length);
    let axis =
        (0..3).fold(0, |least, k| if normal[k].abs() < normal[least].abs() - 1e-6 { k } else { least });
    let mut x: Vector3 = Vector3::ZERO;
    x[axis] = 1.0;
    let x = normal.cross(x).cross(normal);
    let x = x.normalized();
    let y = normal.cross(x);
    Some(of_area_one(energy, mesh.points().iter().map(|&p| [p.dot(x), p.dot(y)]).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::mesh::TriangleMesh;
    use crate::sparse::Order;

    /// A flat comb of unit squares, stood upright, with a tooth in every other column.
    fn comb() -> TriangleMesh {
        let (columns, rows) = (7, 4);
        let mut points = Vec::new();
        let mut number = std::collections::BTreeMap::new();
        let mut vertex = |i: u32, j: u32| {
            *number.entry((i, j)).or_insert_with(|| {
                points.push([f64::from(i), 0.0, f64::from(j)]);
                points.len() as u32 - 1
            })
        };
        let mut faces = Vec::new();
        for j in 0..rows {
            for i in (0..columns).filter(|i| j < 2 || i % 2 == 0) {
                let [a, b, c, d] =
                    [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| vertex(i, j));
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
        TriangleMesh::new(&points, &faces).unwrap()
    }

    fn with_comb(test: impl FnOnce(&Energy<'_>, &Analysis, &Watch<'_>)) {
        let mesh = comb();
        let energy = Energy::new(&mesh, mesh.face_areas());
        let n = mesh.n_vertices();
        let analysis = Analysis::new(n, mesh.faces(), &vec![2; n], Order::Sparse).unwrap();
        let mut silent = Silent;
        test(&energy, &analysis, &Watch::new(&mut silent, 0.0, ""));
    }

    #[test]
    fn a_flat_surface_keeps_its_shape_in_plan_view_and_conformally() {
        with_comb(|energy, analysis, watch| {
            let plan = plan_view(energy).unwrap();
            assert!(energy.value(&plan, 1.0) < 1e-28);
            let conformal = spectral_conformal(energy, analysis, watch).unwrap();
            assert!(energy.value(&conformal, 1.0) < 1e-12, "{}", energy.value(&conformal, 1.0));
        });
    }

    #[test]
    fn what_only_touches_is_pulled_in_and_what_crosses_is_refused() {
        with_comb(|energy, _, _| {
            let outline = Outline::new(energy);
            let plan = plan_view(energy).unwrap();
            assert!(allowed(energy, Some(&outline), plan.clone()).is_some_and(|map| map == plan));
            let mirrored: PlanarMap = plan.iter().map(|x| [-x[0], x[1]]).collect();
            assert!(allowed(energy, Some(&outline), mirrored).is_none());
        });
    }
}
