// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a map goes, the disk, the sphere or the plane, and how a vertex may move there.

pub(crate) mod motion;
