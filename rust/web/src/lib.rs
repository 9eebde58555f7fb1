// SPDX-License-Identifier: MIT OR Apache-2.0
//! Authalic in a page of the web: the text of an OBJ file in; UVs, figures and an OBJ file out.
//!
//! [`page`] is what JavaScript sees, by wasm-bindgen. All else is ordinary Rust, which is tested on any machine.

pub mod figures;
pub mod given;
pub mod obj;
pub mod page;
pub mod problem;
pub mod soft;
pub mod unwrapping;
