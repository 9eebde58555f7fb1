// SPDX-License-Identifier: MIT OR Apache-2.0
//! Seams: where to cut a surface so that its map is hardly sheared.

mod openness;
mod proxy;
#[cfg(test)]
mod sample_surfaces;
mod symmetry;
