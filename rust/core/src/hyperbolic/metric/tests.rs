// SPDX-License-Identifier: MIT OR Apache-2.0
//! Metrics of spheres with holes, smooth and noisy ones.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use super::newton::{Surface, element_for_tests};
use super::*;
use crate::control::Silent;
use crate::mesh::geometry::{add, dot, norm, scaled};
