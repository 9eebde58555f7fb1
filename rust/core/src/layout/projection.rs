// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of an equal-area projection of the sphere.

use super::isometry::Isometry;
use crate::vector::Vector3;

/// An equal-area projection of the unit sphere, cut open along arcs that end at its singular points.
///
/// The first axis of its coordinates points to the seam, the third to the pole.
pub(super) trait Projection: Sync {
    /// The points of the sphere at which the layout is not flat.
    const SINGULAR: &'static [Vector3];

    /// Area in the plane, by [`Projection::place`], over area on the sphere.
    const SCALE: f64;

    /// Whether the singular points are tips of cones, whose images are points. Otherwise they are poles, whose images
    /// are lines.
    const HAS_CONES: bool;

    /// The periods in which [`Isometry`] counts translations.
    const PERIODS: [f64; 2];

    /// The image of a point of the sphere.
    fn place(point: Vector3) -> [f64; 2];

    /// The isometry that takes the image of the end of the shorter great arc, across the cuts on the way, next to the
    /// image of its start.
    fn crossing(start: Vector3, end: Vector3) -> Isometry;

    /// The isometry that moves a polygon into the layout.
    fn home(extent: &Extent) -> Isometry;

    /// Whether a polygon has strayed too far out of the layout as its vertices moved.
    fn has_strayed(extent: &Extent) -> bool;

    /// Whether a vertex may be moved to this place.
    fn is_within(place: [f64; 2]) -> bool;

    /// The final position of a place, in a layout with the area of the sphere.
    fn finished(place: [f64; 2]) -> [f64; 2];
}

/// The extent of a polygon in the plane, without corners at singular points.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Extent {
    /// The lower left corner of its bounding box.
    pub low: [f64; 2],
    /// The mean of its corners.
    pub center: [f64; 2],
}

/// Whether a point is a singular point of the projection, exactly.
pub(super) fn is_singular<P: Projection>(point: Vector3) -> bool {
    P::SINGULAR.contains(&point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::chart::signed_area;
    use crate::layout::lambert::Lambert;
    use crate::layout::octahedral::Octahedral;
    use crate::layout::sample_spheres::small_triangles;
    use crate::mesh::geometry::area;

    /// The corners of a triangle next to each other, by the crossings of its edges.
    fn image<P: Projection>([a, b, c]: [Vector3; 3]) -> [[f64; 2]; 3] {
        let beside = |end: Vector3| P::crossing(a, end).image(P::PERIODS, P::place(end));
        [P::place(a), beside(b), beside(c)]
    }

    fn assert_areas_are_preserved<P: Projection>() {
        let mut count = 0;
        for triangle in small_triangles() {
            let surface = area(triangle);
            let outward = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).dot(triangle[0]);
            let ratio = signed_area(image::<P>(triangle)) / (P::SCALE * surface) * outward.signum();
            assert!((ratio - 1.0).abs() < 0.02, "{ratio} at {triangle:?}");
            count += 1;
        }
        assert!(count > 1900);
    }

    #[test]
    fn both_projections_preserve_areas_and_orientations() {
        assert_areas_are_preserved::<Lambert>();
        assert_areas_are_preserved::<Octahedral>();
    }

    #[test]
    fn finished_places_have_the_area_of_the_sphere() {
        let triangle = [[0.1, 0.2], [0.5, 0.3], [0.2, 0.7]];
        let ratio =
            |finished: [[f64; 2]; 3], scale: f64| signed_area(finished) * scale / signed_area(triangle);
        assert!((ratio(triangle.map(Lambert::finished), Lambert::SCALE) - 1.0).abs() < 1e-14);
        assert!((ratio(triangle.map(Octahedral::finished), Octahedral::SCALE) - 1.0).abs() < 1e-14);
    }
}
