// SPDX-License-Identifier: MIT OR Apache-2.0
//! Landmark curves, given as paths of vertices, and their check.
//!
//! A curve is open, or closed: then its first vertex stands again at its end, or an edge joins its last
//! vertex to its first and it has at least sixteen. Open curves run the same way on both surfaces; of closed
//! ones neither start nor direction means anything.
//!
//! Input: two surfaces of genus 0 and as many curves on either. Cost: linear.

use crate::error::{CurveError, Elements, Error, Side};
use crate::mesh::TriangleMesh;

/// A path whose ends are joined by an edge is meant to be closed from so many vertices on; shorter ones may
/// just bend around a face or two.
const LEAST_RING: usize = 16;

/// Pairs of curves, one on the source and one on the target, that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Curves<'a> {
    /// (k,): vertex paths along edges of the source, each of at least two edges.
    pub source: &'a [Vec<usize>],
    /// (k,): their partners on the target.
    pub target: &'a [Vec<usize>],
}

/// A checked pair of curves.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CurvePair {
    /// The vertices on the source, each once.
    pub source: Vec<u32>,
    /// The vertices on the target, each once.
    pub target: Vec<u32>,
    /// Whether an edge leads from the last vertex back to the first.
    pub closed: bool,
    /// Whether both are loops of the boundary.
    pub on_boundary: bool,
    /// The edge of the target that closes it without being part of the path as given.
    pub gap: Option<Gap>,
}

/// Where on a closed curve an edge lies that is not part of the curve as given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Gap {
    /// From the last vertex to the first.
    AtEnd,
    /// From the first vertex to the second.
    AtStart,
}

/// One curve as given.
struct Path {
    vertices: Vec<u32>,
    /// Whether the first vertex was repeated at the end.
    repeats_first: bool,
    /// Whether the curve is closed, or can be by one more edge.
    can_close: bool,
}

/// The curves of a surface, which is one of two or alone.
struct SurfaceCurves<'a> {
    side: Option<Side>,
    mesh: &'a TriangleMesh,
    curves: &'a [Vec<usize>],
}

impl Curves<'_> {
    /// Refuses surfaces and curves that cannot be registered, before any work, and says which curves are
    /// closed.
    ///
    /// # Errors
    /// Each names the argument, the curve and its vertices at fault: surfaces that are not one component of
    /// genus 0; other numbers of curves or boundary loops on the target; no curves on closed surfaces; curves
    /// that are too short, leave the mesh or its edges, meet themselves, each other or the boundary, unless
    /// they run along a whole loop of it; pairs of which one is closed only or on the boundary only.
    pub(crate) fn check(
        &self,
        source: &TriangleMesh,
        target: &TriangleMesh,
    ) -> Result<Vec<CurvePair>, Error> {
        // 1. The surfaces and the counts
        source.require_genus_zero().map_err(|error| error.of_surface(Side::Source))?;
        target.require_genus_zero().map_err(|error| error.of_surface(Side::Target))?;
        self.check_counts(source, target)?;
        // 2. The curves
        let ours = SurfaceCurves { side: Some(Side::Source), mesh: source, curves: self.source };
        let theirs = SurfaceCurves { side: Some(Side::Target), mesh: target, curves: self.target };
        checked(&ours, &theirs)
    }

    fn check_counts(&self, source: &TriangleMesh, target: &TriangleMesh) -> Result<(), Error> {
        let [source_count, target_count] = [self.source.len(), self.target.len()];
        let unpaired = source_count.min(target_count)..source_count.max(target_count);
        if let Some(unpaired) = Elements::collect(unpaired) {
            return Err(CurveError::Counts { source_count, target_count, unpaired }.into());
        }
        let is_closed = |mesh: &TriangleMesh| mesh.boundary_loops().is_empty();
        if source_count == 0 && is_closed(source) && is_closed(target) {
            Err(CurveError::NoCurves.into())
        } else {
            Ok(())
        }
    }
}

/// Checks curves by themselves, then pairs of them with what they meet.
fn checked(ours: &SurfaceCurves<'_>, theirs: &SurfaceCurves<'_>) -> Result<Vec<CurvePair>, Error> {
    // 1. Each curve by itself
    let (source_paths, target_paths) = (ours.paths()?, theirs.paths()?);
    // 2. Pairs, and what they meet
    let pairs = source_paths.into_iter().zip(target_paths).enumerate();
    let mut pairs: Vec<_> = pairs.map(|(curve, paths)| paired(curve, paths)).collect::<Result<_, _>>()?;
    let source_vertices: Vec<&[u32]> = pairs.iter().map(|pair| &pair.source[..]).collect();
    let target_vertices: Vec<&[u32]> = pairs.iter().map(|pair| &pair.target[..]).collect();
    ours.refuse_meetings(&source_vertices)?;
    theirs.refuse_meetings(&target_vertices)?;
    // 3. The boundary
    for (curve, pair) in pairs.iter_mut().enumerate() {
        let bounds = ours.bounds(curve, &pair.source, pair.closed)?;
        pair.on_boundary = theirs.bounds(curve, &pair.target, pair.closed)?;
        if bounds != pair.on_boundary {
            let side = if bounds { ours.side } else { theirs.side };
            return Err(CurveError::BoundsOneSide { side, curve }.into());
        }
    }
    check_loops(ours.mesh, theirs.mesh, &pairs)?;
    // 4. Closed curves from a start and in a direction of their own
    for pair in pairs.iter_mut().filter(|pair| pair.closed) {
        start_canonically(&mut pair.source, ours.mesh);
        if pair.gap.is_none() {
            start_canonically(&mut pair.target, theirs.mesh);
        }
    }
    Ok(pairs)
}

/// The same for curves of one surface, each its own partner.
pub(crate) fn check_alone(mesh: &TriangleMesh, curves: &[Vec<usize>]) -> Result<Vec<CurvePair>, Error> {
    mesh.require_genus_zero()?;
    let alone = SurfaceCurves { side: None, mesh, curves };
    checked(&alone, &alone)
}

impl SurfaceCurves<'_> {
    fn paths(&self) -> Result<Vec<Path>, Error> {
        (0..self.curves.len()).map(|curve| self.path(curve)).collect()
    }

    /// One curve, checked by itself.
    fn path(&self, curve: usize) -> Result<Path, Error> {
        let (side, given) = (self.side, &self.curves[curve]);
        let repeats_first = given.len() > 1 && given.first() == given.last();
        let edges = given.len().saturating_sub(1);
        if edges < if repeats_first { 3 } else { 2 } {
            return Err(CurveError::Short { side, curve, edges }.into());
        }
        let n_vertices = self.mesh.n_vertices();
        if let Some(place) = given.iter().position(|&vertex| vertex >= n_vertices) {
            return Err(CurveError::OutOfRange { side, curve, place, value: given[place], n_vertices }.into());
        }
        let vertices: Vec<u32> =
            given[..given.len() - usize::from(repeats_first)].iter().map(|&v| v as u32).collect();
        self.refuse_repetitions(curve, &vertices)?;
        let is_off = |ends: &[usize]| !is_edge(self.mesh, ends[0] as u32, ends[1] as u32);
        if let Some(place) = given.windows(2).position(is_off) {
            let vertices = Elements::collect([given[place], given[place + 1]]).expect("there are two");
            return Err(CurveError::OffEdges { side, curve, place, vertices }.into());
        }
        let ends_meet = || is_edge(self.mesh, vertices[vertices.len() - 1], vertices[0]);
        let can_close = repeats_first || (vertices.len() >= LEAST_RING && ends_meet());
        Ok(Path { vertices, repeats_first, can_close })
    }

    fn refuse_repetitions(&self, curve: usize, vertices: &[u32]) -> Result<(), Error> {
        let mut places: Vec<(u32, usize)> = vertices.iter().copied().zip(0..).collect();
        places.sort_unstable();
        let twice = places.windows(2).filter(|pair| pair[0].0 == pair[1].0);
        match twice.map(|pair| (pair[1].1, pair[0].1, pair[0].0)).min() {
            None => Ok(()),
            Some((second, first, vertex)) => Err(CurveError::MeetsItself {
                side: self.side,
                curve,
                places: [first, second],
                vertices: Elements::collect([vertex as usize]).expect("there is one"),
            }
            .into()),
        }
    }

    /// Refuses curves that share a vertex.
    fn refuse_meetings(&self, curves: &[&[u32]]) -> Result<(), Error> {
        const NOBODY: usize = usize::MAX;
        let mut owner = vec![NOBODY; self.mesh.n_vertices()];
        for (curve, vertices) in curves.iter().enumerate() {
            let other = vertices.iter().map(|&v| owner[v as usize]).find(|&other| other != NOBODY);
            if let Some(other) = other {
                let shared = vertices.iter().map(|&v| v as usize).filter(|&v| owner[v] == other);
                let vertices = Elements::collect(shared).expect("one was found");
                return Err(CurveError::Meet { side: self.side, curves: [other, curve], vertices }.into());
            }
            vertices.iter().for_each(|&v| owner[v as usize] = curve);
        }
        Ok(())
    }

    /// Whether a curve runs along a whole boundary loop; an error where it only meets the boundary.
    fn bounds(&self, curve: usize, vertices: &[u32], closed: bool) -> Result<bool, Error> {
        let met = vertices.iter().map(|&v| v as usize).filter(|&v| self.mesh.is_boundary(v));
        match Elements::collect(met) {
            None => Ok(false),
            Some(_) if closed && loop_along(self.mesh, vertices).is_some() => Ok(true),
            Some(vertices) => Err(CurveError::OnBoundary { side: self.side, curve, vertices }.into()),
        }
    }
}

/// Makes a pair of two paths; it is closed where both can be.
fn paired(curve: usize, (source, target): (Path, Path)) -> Result<CurvePair, Error> {
    let closed = source.can_close && target.can_close;
    if !closed && (source.repeats_first || target.repeats_first) {
        let side = if source.repeats_first { Side::Target } else { Side::Source };
        return Err(CurveError::NotClosed { side: Some(side), curve }.into());
    }
    let gap = (closed && !target.repeats_first).then_some(Gap::AtEnd);
    Ok(CurvePair { source: source.vertices, target: target.vertices, closed, on_boundary: false, gap })
}

/// Runs through a closed curve from the vertex with the least coordinates on, towards the lesser of its
/// neighbors, so that it does not matter where and which way it was begun.
fn start_canonically(closed: &mut [u32], mesh: &TriangleMesh) {
    let point = |vertex: u32| mesh.points()[vertex as usize];
    let is_less = |a: u32, b: u32| point(a).partial_cmp(&point(b)).is_some_and(std::cmp::Ordering::is_lt);
    let first = (1..closed.len()).fold(0, |best, k| if is_less(closed[k], closed[best]) { k } else { best });
    closed.rotate_left(first);
    if is_less(closed[closed.len() - 1], closed[1]) {
        closed[1..].reverse();
    }
}

fn check_loops(source: &TriangleMesh, target: &TriangleMesh, pairs: &[CurvePair]) -> Result<(), Error> {
    let named = pairs.iter().filter(|pair| pair.on_boundary).count();
    let [source_count, target_count] = [source, target].map(|mesh| mesh.boundary_loops().len() - named);
    if source_count == target_count {
        Ok(())
    } else {
        Err(CurveError::LoopCounts { source_count, target_count }.into())
    }
}

/// The boundary loop that a closed curve runs along as a whole, from whichever vertex and in whichever
/// direction.
pub(super) fn loop_along(mesh: &TriangleMesh, curve: &[u32]) -> Option<usize> {
    mesh.boundary_loops().iter().position(|vertices| {
        let n = vertices.len();
        let Some(first) = vertices.iter().position(|&v| v == curve[0]).filter(|_| n == curve.len()) else {
            return false;
        };
        let forward = (0..n).all(|k| vertices[(first + k) % n] == curve[k]);
        forward || (0..n).all(|k| vertices[(first + n - k) % n] == curve[k])
    })
}

/// The face on the left of the edge from one vertex to another, `None` where there is none.
pub(super) fn face_on_left(mesh: &TriangleMesh, from: u32, to: u32) -> Option<u32> {
    let corners = mesh.vertex_corners(from as usize).iter();
    let next = |corner: u32| mesh.faces()[corner as usize / 3][(corner as usize % 3 + 1) % 3];
    corners.copied().find(|&corner| next(corner) == to).map(|corner| corner / 3)
}

/// Whether an edge joins two vertices.
fn is_edge(mesh: &TriangleMesh, a: u32, b: u32) -> bool {
    face_on_left(mesh, a, b).or(face_on_left(mesh, b, a)).is_some()
}

#[cfg(test)]
mod tests;
