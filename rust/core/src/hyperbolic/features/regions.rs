// SPDX-License-Identifier: MIT OR Apache-2.0
//! The regions into which closed curves divide the surfaces, and the pairs of corresponding regions.
//!
//! On a surface of genus 0 every closed curve has two sides. A map that keeps orientation takes left to left,
//! so closed curves of the target are reversed where their left side corresponds to the right side of their
//! partners.
//!
//! Input: checked pairs of curves. Cost: linear in the faces, k² for k curves.

use super::curves::{CurvePair, Gap, face_on_left, loop_along};
use crate::error::{CurveError, Error, Side};
use crate::mesh::geometry::triangle;
use crate::mesh::{Corner, Face, TriangleMesh, Vertex};
use crate::vector::Vector3;

/// The region beyond the boundary, which is none.
pub(super) const OUTSIDE: usize = usize::MAX;

/// Least difference, as a share of the whole area, by which areas left and right of a curve tell its sides.
const CLEAR_SHARE: f64 = 0.02;

/// Least difference by which areas overrule a single curve.
const OUTVOTES: f64 = 0.2;

/// The regions of one surface.
#[derive(Debug, Clone)]
pub(crate) struct Regions {
    /// (m,): the region of each face, numbered by their lowest faces.
    pub of_face: Vec<usize>,
    /// The number of regions.
    pub count: usize,
    /// The regions on the left and right of each curve; they are equal for an open curve, [`OUTSIDE`] beyond the
    /// boundary.
    pub sides: Vec<[usize; 2]>,
    /// The region of each boundary loop that is no curve, with the number of the loop.
    pub loops: Vec<(usize, usize)>,
    /// The share of each region in the area of the surface.
    shares: Vec<f64>,
    /// The centroid of each region times its share.
    moments: Vec<Vector3>,
}

/// Both surfaces divided, with closed curves of the target in the direction of their partners.
#[derive(Debug, Clone)]
pub(crate) struct Divided {
    /// The pairs, with corresponding sides.
    pub pairs: Vec<CurvePair>,
    /// The regions of the source.
    pub source: Regions,
    /// The regions of the target.
    pub target: Regions,
    /// The region of the target that corresponds to each region of the source.
    pub partner: Vec<usize>,
}

/// Divides both surfaces along closed curves and pairs their regions.
///
/// # Errors
/// [`CurveError::Sides`] and [`CurveError::LoopSides`] if the sides of a closed curve cannot correspond.
pub(crate) fn divided(
    source: &TriangleMesh,
    target: &TriangleMesh,
    mut pairs: Vec<CurvePair>,
) -> Result<Divided, Error> {
    let curves = |side: fn(&CurvePair) -> &Vec<Vertex>| pairs.iter().map(side).collect::<Vec<_>>();
    let closed: Vec<bool> = pairs.iter().map(|pair| pair.closed).collect();
    let ours = Regions::new(source, &curves(|pair| &pair.source), &closed);
    let mut theirs = Regions::new(target, &curves(|pair| &pair.target), &closed);
    // 1. Left to left
    for (curve, pair) in pairs.iter_mut().enumerate().filter(|(_, pair)| pair.closed) {
        if is_turned(curve, &ours, &theirs) {
            turn(pair);
            theirs.sides[curve].reverse();
        }
    }
    // 2. The same curves and loops must lie on the left
    (0..pairs.len())
        .filter(|&curve| closed[curve])
        .try_for_each(|curve| check_sides(curve, &ours, &theirs))?;
    // 3. Regions on the same sides correspond
    let mut partner = vec![0; ours.count];
    for curve in (0..pairs.len()).filter(|&curve| closed[curve]) {
        for side in (0..2).filter(|&side| ours.sides[curve][side] != OUTSIDE) {
            partner[ours.sides[curve][side]] = theirs.sides[curve][side];
        }
    }
    Ok(Divided { pairs, source: ours, target: theirs, partner })
}

/// Reverses the target's curve, keeping its first vertex.
fn turn(pair: &mut CurvePair) {
    pair.target[1..].reverse();
    pair.gap = pair.gap.map(|_| Gap::AtStart);
}

/// Whether the left of the target's curve corresponds to the right of the source's.
fn is_turned(curve: usize, ours: &Regions, theirs: &Regions) -> bool {
    let (left, their_left) = (ours.on_left(curve), theirs.on_left(curve));
    // 1. By the boundary, or by most of the other curves
    if ours.sides[curve].contains(&OUTSIDE) {
        return (ours.sides[curve][0] == OUTSIDE) != (theirs.sides[curve][0] == OUTSIDE);
    }
    let witnesses = (0..ours.sides.len()).filter(|&witness| witness != curve);
    let agree = |witness: &usize| left[ours.region(*witness)] == their_left[theirs.region(*witness)];
    let (agreeing, turned): (Vec<usize>, Vec<usize>) = witnesses.partition(agree);
    let (share, theirs_on_left) = (ours.share_of(&left), theirs.share_of(&their_left));
    let by_area = (share - theirs_on_left).abs() - (1.0 - share - theirs_on_left).abs();
    // a single curve against clear areas is more likely on the wrong side itself
    let is_outvoted = agreeing.len().max(turned.len()) == 1 && by_area.abs() > OUTVOTES;
    if agreeing.len() != turned.len() && !is_outvoted {
        return agreeing.len() < turned.len();
    }
    // 2. By boundary loops, or by areas
    let [on_left, their_loops] = [ours.loops_in(&left), theirs.loops_in(&their_left)];
    let on_right = ours.loops.len() - on_left;
    if on_left != on_right {
        return on_right.abs_diff(their_loops) < on_left.abs_diff(their_loops);
    }
    if by_area.abs() > CLEAR_SHARE {
        return by_area > 0.0;
    }
    // 3. By the directions of the sides in space
    ours.direction_to(&left).dot(theirs.direction_to(&their_left)) < 0.0
}

/// Refuses curves and loops that lie on different sides of a closed curve on source and target.
fn check_sides(closed: usize, ours: &Regions, theirs: &Regions) -> Result<(), Error> {
    let (left, their_left) = (ours.on_left(closed), theirs.on_left(closed));
    let left_is_inside = ours.share_of(&left) <= 0.5;
    for curve in (0..ours.sides.len()).filter(|&curve| curve != closed) {
        let [on_left, their_side] = [left[ours.region(curve)], their_left[theirs.region(curve)]];
        if on_left != their_side {
            let side = if on_left == left_is_inside { Side::Source } else { Side::Target };
            return Err(CurveError::Sides { curve, closed, side }.into());
        }
    }
    let [on_left, their_loops] = [ours.loops_in(&left), theirs.loops_in(&their_left)];
    let inside = |on_left| if left_is_inside { on_left } else { ours.loops.len() - on_left };
    if on_left == their_loops {
        Ok(())
    } else {
        let [source_count, target_count] = [inside(on_left), inside(their_loops)];
        Err(CurveError::LoopSides { closed, source_count, target_count }.into())
    }
}

impl Regions {
    fn new(mesh: &TriangleMesh, curves: &[&Vec<Vertex>], closed: &[bool]) -> Self {
        let walls = curves.iter().zip(closed).filter(|(_, closed)| **closed).map(|(curve, _)| &curve[..]);
        let (of_face, count) = flooded(mesh, &walls_at_corners(mesh, walls));
        let region = |face: Option<Face>| face.map_or(OUTSIDE, |face| of_face[face]);
        let sides = curves.iter().map(|curve| {
            let [a, b] = [curve[0], curve[1]];
            [region(face_on_left(mesh, a, b)), region(face_on_left(mesh, b, a))]
        });
        let sides: Vec<[usize; 2]> = sides.collect();
        let named: Vec<usize> = curves.iter().filter_map(|curve| loop_along(mesh, curve)).collect();
        let unnamed = (0..mesh.boundary_loops().len()).filter(|number| !named.contains(number));
        let loops = unnamed.map(|number| {
            let vertices = &mesh.boundary_loops()[number];
            (number, region(face_on_left(mesh, vertices[0], vertices[1])))
        });
        let loops = loops.collect();
        let (mut shares, mut moments) = (vec![0.0; count], vec![Vector3::ZERO; count]);
        let total: f64 = mesh.face_areas().iter().sum();
        for (face, &region) in of_face.iter().enumerate() {
            let (share, [a, b, c]) =
                (mesh.face_areas()[face] / total, triangle(mesh.points(), mesh.faces()[face]));
            shares[region] += share;
            moments[region] += (a + (b + c)) * (share / 3.0);
        }
        Self { of_face, count, sides, loops, shares, moments }
    }

    /// A region next to a curve.
    fn region(&self, curve: usize) -> usize {
        let [left, right] = self.sides[curve];
        left.min(right)
    }

    /// Whether each region lies on the left of a closed curve.
    fn on_left(&self, closed: usize) -> Vec<bool> {
        let mut on_left = vec![false; self.count];
        if let Some(first) = on_left.get_mut(self.sides[closed][0]) {
            *first = true;
        }
        let joined: Vec<[usize; 2]> = (0..self.sides.len())
            .filter(|&curve| curve != closed)
            .map(|curve| self.sides[curve])
            .filter(|sides| !sides.contains(&OUTSIDE))
            .collect();
        while let Some([a, b]) = joined.iter().find(|[a, b]| on_left[*a] != on_left[*b]) {
            (on_left[*a], on_left[*b]) = (true, true);
        }
        on_left
    }

    fn loops_in(&self, inside: &[bool]) -> usize {
        self.loops.iter().filter(|(_, region)| inside[*region]).count()
    }

    /// The vector to the centroid of some regions from that of the rest.
    fn direction_to(&self, inside: &[bool]) -> Vector3 {
        let share = self.share_of(inside);
        let sum = |wanted: bool| {
            let moments = self.moments.iter().zip(inside).filter(|(_, inside)| **inside == wanted);
            moments.fold(Vector3::ZERO, |sum, (&moment, _)| sum + moment)
        };
        sum(true) * (1.0 / share) - sum(false) * (1.0 / (1.0 - share))
    }

    fn share_of(&self, inside: &[bool]) -> f64 {
        self.shares.iter().zip(inside).map(|(share, &inside)| if inside { *share } else { 0.0 }).sum()
    }
}

/// Whether the edge opposite to each corner lies on a closed curve.
fn walls_at_corners<'a>(mesh: &TriangleMesh, curves: impl Iterator<Item = &'a [Vertex]>) -> Vec<bool> {
    let mut next = vec![[Vertex(u32::MAX); 2]; mesh.n_vertices()];
    for curve in curves {
        for (k, &vertex) in curve.iter().enumerate() {
            let n = curve.len();
            next[vertex] = [curve[(k + 1) % n], curve[(k + n - 1) % n]];
        }
    }
    let is_wall = |corner: Corner| {
        let [a, b] = corner.half_edge(mesh.faces());
        next[a].contains(&b)
    };
    Corner::all(mesh.n_faces()).map(is_wall).collect()
}

/// The region of each face, and the number of regions.
fn flooded(mesh: &TriangleMesh, is_wall: &[bool]) -> (Vec<usize>, usize) {
    let (mut of_face, mut count) = (vec![OUTSIDE; mesh.n_faces()], 0);
    for seed in Face::all(mesh.n_faces()) {
        if of_face[seed] != OUTSIDE {
            continue;
        }
        of_face[seed] = count;
        let mut pending = vec![seed];
        while let Some(face) = pending.pop() {
            for corner in face.corners() {
                let Some(beyond) = mesh.opposite(corner).map(Corner::face) else { continue };
                if !is_wall[corner] && of_face[beyond] == OUTSIDE {
                    of_face[beyond] = count;
                    pending.push(beyond);
                }
            }
        }
        count += 1;
    }
    (of_face, count)
}
