// SPDX-License-Identifier: MIT OR Apache-2.0
//! Landmark curves, given as paths of vertices, and their check.
//!
//! A curve is open or closed. A closed curve repeats its first vertex at its end, or has at least sixteen
//! vertices, the last and the first joined by an edge. Open curves run the same way on both surfaces; the
//! start and the direction of closed curves mean nothing.
//!
//! Input: two surfaces of genus 0 and as many curves on either. Cost: linear.

use crate::error::{CurveError, Elements, Error, Side};
use crate::mesh::{Corner, Face, TriangleMesh, Vertex};

/// Least number of vertices of a path that counts as closed because an edge joins its ends; a shorter one may
/// just bend around a face or two.
const LEAST_RING: usize = 16;

/// Pairs of corresponding curves, one on the source and one on the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LandmarkCurves<'a> {
    /// (k,): vertex paths along edges of the source, each of at least two edges.
    pub source: &'a [Vec<usize>],
    /// (k,): their partners on the target.
    pub target: &'a [Vec<usize>],
}

/// A checked pair of curves.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CurvePair {
    /// The vertices on the source, each once.
    pub source: Vec<Vertex>,
    /// The vertices on the target, each once.
    pub target: Vec<Vertex>,
    /// Whether an edge leads from the last vertex back to the first.
    pub closed: bool,
    /// Whether both curves are boundary loops.
    pub on_boundary: bool,
    /// The edge that closes the target's curve without being part of the path as given.
    pub gap: Option<Gap>,
}

/// The place on a closed curve of an edge that is not part of the curve as given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Gap {
    /// From the last vertex to the first.
    AtEnd,
    /// From the first vertex to the second.
    AtStart,
}

/// A curve as given.
struct Path {
    vertices: Vec<Vertex>,
    /// Whether the first vertex was repeated at the end.
    repeats_first: bool,
    /// Whether the curve is closed, or can be closed by one more edge.
    can_close: bool,
}

/// The curves of a surface; `side` is `None` for a surface alone.
struct SurfaceCurves<'a> {
    side: Option<Side>,
    mesh: &'a TriangleMesh,
    curves: &'a [Vec<usize>],
}

impl LandmarkCurves<'_> {
    /// Refuses surfaces and curves that cannot be registered, before any work; returns the pairs.
    ///
    /// # Errors
    /// Each names the argument, the curve and its vertices at fault: surfaces that are not one component of
    /// genus 0; different numbers of curves or boundary loops; no curves on closed surfaces; curves that are
    /// too short, leave the mesh or its edges, or meet themselves, each other or the boundary, unless they run
    /// along a whole boundary loop; pairs of which only one curve is closed, or on the boundary.
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

    /// Refuses vertices that are out of range on the source or the target.
    pub(crate) fn check_range(&self, n_vertices: [usize; 2]) -> Result<(), Error> {
        let sides = [(Side::Source, self.source), (Side::Target, self.target)];
        for ((side, curves), n_vertices) in sides.into_iter().zip(n_vertices) {
            for (curve, given) in curves.iter().enumerate() {
                refuse_out_of_range(Some(side), curve, given, n_vertices)?;
            }
        }
        Ok(())
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

/// Checks curves by themselves, then pairs of them, their meetings and the boundary.
fn checked(ours: &SurfaceCurves<'_>, theirs: &SurfaceCurves<'_>) -> Result<Vec<CurvePair>, Error> {
    // 1. Each curve by itself
    let (source_paths, target_paths) = (ours.paths()?, theirs.paths()?);
    // 2. Pairs, and their meetings
    let pairs = source_paths.into_iter().zip(target_paths).enumerate();
    let mut pairs: Vec<_> = pairs.map(|(curve, paths)| paired(curve, paths)).collect::<Result<_, _>>()?;
    let source_vertices: Vec<&[Vertex]> = pairs.iter().map(|pair| &pair.source[..]).collect();
    let target_vertices: Vec<&[Vertex]> = pairs.iter().map(|pair| &pair.target[..]).collect();
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
    // 4. A canonical start and direction of closed curves
    for pair in pairs.iter_mut().filter(|pair| pair.closed) {
        start_canonically(&mut pair.source, ours.mesh);
        if pair.gap.is_none() {
            start_canonically(&mut pair.target, theirs.mesh);
        }
    }
    Ok(pairs)
}

/// Checks the curves of one surface, each its own partner.
pub(crate) fn check_alone(mesh: &TriangleMesh, curves: &[Vec<usize>]) -> Result<Vec<CurvePair>, Error> {
    mesh.require_genus_zero()?;
    let alone = SurfaceCurves { side: None, mesh, curves };
    checked(&alone, &alone)
}

impl SurfaceCurves<'_> {
    fn paths(&self) -> Result<Vec<Path>, Error> {
        (0..self.curves.len()).map(|curve| self.path(curve)).collect()
    }

    /// A curve, checked by itself.
    fn path(&self, curve: usize) -> Result<Path, Error> {
        let (side, given) = (self.side, &self.curves[curve]);
        let repeats_first = given.len() > 1 && given.first() == given.last();
        let edges = given.len().saturating_sub(1);
        if edges < if repeats_first { 3 } else { 2 } {
            return Err(CurveError::Short { side, curve, edges }.into());
        }
        refuse_out_of_range(side, curve, given, self.mesh.n_vertices())?;
        let vertices: Vec<Vertex> =
            given[..given.len() - usize::from(repeats_first)].iter().copied().map(Vertex::new).collect();
        self.refuse_repetitions(curve, &vertices)?;
        let is_off = |ends: &[usize]| !is_edge(self.mesh, Vertex::new(ends[0]), Vertex::new(ends[1]));
        if let Some(place) = given.windows(2).position(is_off) {
            let vertices = Elements::collect([given[place], given[place + 1]]).expect("there are two");
            return Err(CurveError::OffEdges { side, curve, place, vertices }.into());
        }
        let ends_meet = || is_edge(self.mesh, vertices[vertices.len() - 1], vertices[0]);
        let can_close = repeats_first || (vertices.len() >= LEAST_RING && ends_meet());
        Ok(Path { vertices, repeats_first, can_close })
    }

    fn refuse_repetitions(&self, curve: usize, vertices: &[Vertex]) -> Result<(), Error> {
        let mut places: Vec<(Vertex, usize)> = vertices.iter().copied().zip(0..).collect();
        places.sort_unstable();
        let twice = places.windows(2).filter(|pair| pair[0].0 == pair[1].0);
        match twice.map(|pair| (pair[1].1, pair[0].1, pair[0].0)).min() {
            None => Ok(()),
            Some((second, first, vertex)) => Err(CurveError::MeetsItself {
                side: self.side,
                curve,
                places: [first, second],
                vertices: Elements::collect([vertex]).expect("there is one"),
            }
            .into()),
        }
    }

    /// Refuses curves that share a vertex.
    fn refuse_meetings(&self, curves: &[&[Vertex]]) -> Result<(), Error> {
        const NOBODY: usize = usize::MAX;
        let mut owner = vec![NOBODY; self.mesh.n_vertices()];
        for (curve, vertices) in curves.iter().enumerate() {
            let met = vertices.iter().map(|&v| owner[v]).find(|&owner| owner != NOBODY);
            if let Some(met) = met {
                let shared = vertices.iter().copied().filter(|&v| owner[v] == met);
                let vertices = Elements::collect(shared).expect("one was found");
                return Err(CurveError::Meet { side: self.side, curves: [met, curve], vertices }.into());
            }
            vertices.iter().for_each(|&v| owner[v] = curve);
        }
        Ok(())
    }

    /// Whether a curve runs along a whole boundary loop; an error if it only meets the boundary.
    fn bounds(&self, curve: usize, vertices: &[Vertex], closed: bool) -> Result<bool, Error> {
        let met = vertices.iter().copied().filter(|&v| self.mesh.is_boundary(v));
        match Elements::collect(met) {
            None => Ok(false),
            Some(_) if closed && loop_along(self.mesh, vertices).is_some() => Ok(true),
            Some(vertices) => Err(CurveError::OnBoundary { side: self.side, curve, vertices }.into()),
        }
    }
}

fn refuse_out_of_range(
    side: Option<Side>,
    curve: usize,
    given: &[usize],
    n_vertices: usize,
) -> Result<(), Error> {
    match given.iter().position(|&vertex| vertex >= n_vertices) {
        None => Ok(()),
        Some(place) => {
            Err(CurveError::OutOfRange { side, curve, place, value: given[place], n_vertices }.into())
        }
    }
}

/// Makes a pair of two paths; it is closed if both can be.
fn paired(curve: usize, (source, target): (Path, Path)) -> Result<CurvePair, Error> {
    let closed = source.can_close && target.can_close;
    if !closed && (source.repeats_first || target.repeats_first) {
        let side = if source.repeats_first { Side::Target } else { Side::Source };
        return Err(CurveError::NotClosed { side: Some(side), curve }.into());
    }
    let gap = (closed && !target.repeats_first).then_some(Gap::AtEnd);
    Ok(CurvePair { source: source.vertices, target: target.vertices, closed, on_boundary: false, gap })
}

/// Coordinates of a surface of unit size that differ by less are equal but for noise.
const SAME_COORDINATE: f64 = 1e-9;

/// Starts a closed curve at the vertex with the least coordinates, toward the lesser of its neighbors, so that
/// the start and the direction given do not matter.
fn start_canonically(closed: &mut [Vertex], mesh: &TriangleMesh) {
    let is_less = |a: Vertex, b: Vertex| {
        let [a, b] = [a, b].map(|vertex| mesh.points()[vertex]);
        let axis = (0..3).find(|&axis| (a[axis] - b[axis]).abs() > SAME_COORDINATE);
        axis.is_some_and(|axis| a[axis] < b[axis])
    };
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

/// The boundary loop along which a closed curve runs as a whole, from any vertex and in any direction.
pub(in crate::hyperbolic) fn loop_along(mesh: &TriangleMesh, curve: &[Vertex]) -> Option<usize> {
    mesh.boundary_loops().iter().position(|vertices| {
        let n = vertices.len();
        let Some(first) = vertices.iter().position(|&v| v == curve[0]).filter(|_| n == curve.len()) else {
            return false;
        };
        let forward = (0..n).all(|k| vertices[(first + k) % n] == curve[k]);
        forward || (0..n).all(|k| vertices[(first + n - k) % n] == curve[k])
    })
}

/// The face on the left of the edge from one vertex to another, if there is one.
pub(super) fn face_on_left(mesh: &TriangleMesh, from: Vertex, to: Vertex) -> Option<Face> {
    let corners = mesh.vertex_corners(from).iter();
    corners.copied().find(|corner| corner.next().vertex(mesh.faces()) == to).map(Corner::face)
}

/// Whether an edge joins two vertices.
fn is_edge(mesh: &TriangleMesh, a: Vertex, b: Vertex) -> bool {
    face_on_left(mesh, a, b).or(face_on_left(mesh, b, a)).is_some()
}

#[cfg(test)]
mod tests;
