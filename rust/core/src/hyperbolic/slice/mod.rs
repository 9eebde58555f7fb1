// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cutting a pair of pieces open: along their features, and along arcs between these into disks.
//!
//! The features of a surface of genus 0 become its boundary loops; a chain of arcs joins these into one. The
//! disks of source and target have the same sides in the same order; points of equal parameter correspond.
//!
//! 1. The chain: an order and directions of the features, the same on both ([`chain`]).
//! 2. The features are marked for cutting and the chords between them split ([`cutting`]).
//! 3. Arcs on the source, and along their images on the target ([`arcs`]).
//! 4. Corners that meet across uncut edges become one vertex; the boundary of the disk is divided into sides.
//!
//! Input: the features are disjoint, slits simple paths of two or more edges off the boundary, loops whole
//! boundary loops. Paper: Shi, Zeng, Su et al., "Hyperbolic Harmonic Mapping for Constrained Brain Surface
//! Registration", CVPR 2013, which slices along the landmarks, too; the chain of arcs takes the place of its
//! pants and hexagons. Cost: at most O(B n log n) for B features.

mod arcs;
mod chain;
mod cutting;
pub(super) mod isotopy;
pub(super) mod openings;
mod paths;
mod polyline;
pub(super) mod sliced;
#[cfg(test)]
mod tests;

use super::features::piece::{Feature, Piece};
use crate::control::Watch;
use crate::error;
use crate::error::{CurveError, Error};
use crate::mesh::Vertex;
use arcs::Carry;
use cutting::{Cutting, Seam};

pub(super) use openings::{BoundaryCorners, Opened};
use sliced::{Side, Sliced, SlicedPair};

/// Cuts both pieces open along their features and along arcs of the same homotopy class.
///
/// `carry` deforms a polyline on the sphere of the source (unit vectors, about 0.01 rad apart) into one on
/// the sphere of the target, so that the features of the source go onto those of the target; `None` if it
/// fails.
///
/// # Errors
/// [`CurveError::Uncuttable`] for features that are no paths of edges or touch each other, [`CurveError::NoArc`]
/// for features that cannot be joined, on either surface; [`Error::CancelledEarly`].
pub(super) fn slice_pair(
    source: &Piece,
    target: &Piece,
    carry: Carry<'_>,
    watch: &Watch<'_>,
) -> Result<SlicedPair, Error> {
    let (of_source, of_target) = (
        |error: Error| error.of_surface(error::Side::Source),
        |error: Error| error.of_surface(error::Side::Target),
    );
    // 1. Order and directions.
    let chain = chain::order(source, target);
    let [source_features, target_features] = [source, target].map(|piece| chain::features(piece, &chain));
    // 2. Cut along the features.
    let mut source = cut_features(source).map_err(of_source)?;
    let mut target = cut_features(target).map_err(of_target)?;
    // 3. Cut along arcs.
    let links = chain::links(&source_features);
    let source_arcs = arcs::source_arcs(&mut source, &links, watch).map_err(of_source)?;
    let guides = arcs::guides(&source, &source_arcs, carry);
    let links = chain::links(&target_features);
    let (target_arcs, followed) = arcs::target_arcs(&mut target, &links, guides, watch).map_err(of_target)?;
    // 4. Open both.
    let source = open(source, &source_features, &source_arcs).map_err(of_source)?;
    let target = open(target, &target_features, &target_arcs).map_err(of_target)?;
    Ok(SlicedPair { source, target, followed })
}

/// Cuts a piece open along its features and along arcs; returns the chain too.
///
/// # Errors
/// The errors of [`slice_pair`], without a side.
pub(super) fn slice_alone(piece: &Piece, watch: &Watch<'_>) -> Result<(Sliced, Vec<(usize, bool)>), Error> {
    let chain = chain::order(piece, piece);
    let features = chain::features(piece, &chain);
    let mut cutting = cut_features(piece)?;
    let arcs = arcs::source_arcs(&mut cutting, &chain::links(&features), watch)?;
    Ok((open(cutting, &features, &arcs)?, chain))
}

/// Marks the features of a piece for cutting and splits the chords between them.
fn cut_features(piece: &Piece) -> Result<Cutting, Error> {
    let mut cutting = Cutting::new(piece);
    for feature in &piece.features {
        let is_free = outline(feature).iter().all(|&vertex| !cutting.is_cut(vertex));
        let banks = if feature.is_loop { vec![&feature.left, &feature.right] } else { vec![&feature.left] };
        let are_paths = banks.iter().all(|bank| cutting.mark(&bank.vertices, Seam::Feature));
        if !is_free || !are_paths {
            return Err(CurveError::Uncuttable { curve: feature.curve }.into());
        }
    }
    let vertices = cutting.cut_vertices();
    cutting.split_chords(&vertices);
    Ok(cutting)
}

/// The vertices once around a feature: along its left bank and back along its right bank.
fn outline(feature: &Feature) -> Vec<Vertex> {
    let back = feature.right.vertices.iter().rev().skip(1);
    let mut vertices: Vec<Vertex> = feature.left.vertices.iter().chain(back).copied().collect();
    vertices.pop();
    vertices
}

/// Opens a surface along its features, and a copy along its arcs too.
fn open(cutting: Cutting, features: &[Feature], arcs: &[Vec<Vertex>]) -> Result<Sliced, Error> {
    let opposite_unless = |is_open: fn(Seam) -> bool| {
        let pairs = cutting.opposite.iter().zip(&cutting.seams);
        pairs.map(|(&across, &seam)| across.filter(|_| !is_open(seam))).collect()
    };
    let surface = Opened::new(&cutting.faces, opposite_unless(|seam| seam == Seam::Feature));
    let disk = Opened::new(&cutting.faces, opposite_unless(|seam| seam != Seam::None));
    let boundary = match features.first() {
        Some(first) => {
            let edge = cutting.half_edge(first.left.vertices[0], first.left.vertices[1]);
            disk.boundary_from(edge.ok_or(CurveError::Uncuttable { curve: first.curve })?)
        }
        None => Vec::new(),
    };
    let sides = match_sides(expected_sides(&cutting, features, arcs), &boundary, &disk.vertex_of)
        .map_err(|index| CurveError::Uncuttable { curve: features[index].curve })?;
    let Cutting { points, faces, places, .. } = cutting;
    Ok(Sliced { points, faces, places, surface, disk, sides })
}

/// The sides in order, with their vertices before cutting.
fn expected_sides(cutting: &Cutting, features: &[Feature], arcs: &[Vec<Vertex>]) -> Vec<Side> {
    let side = |is_arc, index, vertices: &[Vertex], parameters: &[f64]| Side {
        is_arc,
        index,
        vertices: vertices.to_vec(),
        parameters: parameters.to_vec(),
    };
    let (mut out, mut back) = (Vec::new(), Vec::new());
    for (index, Feature { left, right, .. }) in features.iter().enumerate() {
        out.push(side(false, index, &left.vertices, &left.parameters));
        back.push(reversed(side(false, index, &right.vertices, &right.parameters)));
        if let Some(arc) = arcs.get(index) {
            let arc = side(true, index, arc, &shares_of_length(cutting, arc));
            back.push(reversed(arc.clone()));
            out.push(arc);
        }
    }
    back.reverse();
    out.append(&mut back);
    out
}

fn reversed(mut side: Side) -> Side {
    side.vertices.reverse();
    side.parameters.reverse();
    side
}

/// The length of a path up to each of its vertices as a share of the whole.
fn shares_of_length(cutting: &Cutting, path: &[Vertex]) -> Vec<f64> {
    let mut so_far = vec![0.0];
    for ends in path.windows(2) {
        so_far.push(so_far[so_far.len() - 1] + cutting.length(ends[0], ends[1]));
    }
    let whole = so_far[so_far.len() - 1];
    so_far.into_iter().map(|length| length / whole).collect()
}

/// Replaces the vertices of the sides by those of the disk along `boundary`.
///
/// The error is the feature at or after which the boundary does not run along the sides.
fn match_sides(mut sides: Vec<Side>, boundary: &[Vertex], vertex_of: &[Vertex]) -> Result<Vec<Side>, usize> {
    let mut begin = 0;
    for side in &mut sides {
        for (place, vertex) in side.vertices.iter_mut().enumerate() {
            let disk_vertex = boundary[(begin + place) % boundary.len()];
            if vertex_of[disk_vertex] != *vertex {
                return Err(side.index);
            }
            *vertex = disk_vertex;
        }
        begin += side.vertices.len() - 1;
    }
    match sides.last() {
        Some(last) if begin != boundary.len() => Err(last.index),
        _ => Ok(sides),
    }
}
