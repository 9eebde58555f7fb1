// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area-preserving (authalic) maps of triangle meshes.
#![warn(missing_docs)]

mod error;
pub mod mesh;

pub use error::{Elements, Error};
