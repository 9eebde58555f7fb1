// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area-preserving (authalic) maps of triangle meshes.
//!
//! An authalic map preserves areas: a face that covers one percent of the surface covers one percent of the image.
//! [`disk_map`] maps a surface with one boundary to the unit disk or onto a rectangle, [`sphere_map`] a closed surface
//! onto the unit sphere, which [`SphereMap::layout`] lays out in the plane. No such map has a folded face; exact
//! predicates decide. [`register_disks`] and [`register_spheres`] map one surface onto another by landmark points,
//! [`register_hyperbolic`] by landmark curves. [`untangle()`] removes the folds of a given map, [`distortion()`]
//! measures any map.
//!
//! All of them take a [`Surface`]: vertices (n, 3) and faces (m, 3) as arrays of the crate [`ndarray`], checked once
//! and never copied again. Results are arrays too, or lists. A [`Vertex`], [`Face`] or [`Corner`] converts to its
//! index; lists of elements to report, as of folded faces, hold the indices themselves.
//!
//! # A disk
//!
//! ```
//! use authalic::{DiskMapOptions, Silent, Surface, disk_map};
//! use ndarray::array;
//!
//! // a pyramid without its base: one boundary loop, so a disk
//! let vertices = array![[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
//! let surface = Surface::new(vertices, array![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])?;
//!
//! let map = disk_map(&surface, &DiskMapOptions::default(), &mut Silent)?;
//!
//! assert_eq!(map.uv.shape(), [5, 2]);
//! assert!(map.distortion.folded.is_empty() && map.distortion.area_ratio_std < 1e-6);
//! # Ok::<(), authalic::Error>(())
//! ```
//!
//! # A sphere
//!
//! An [`Observer`] hears of the progress and may end the run, which then returns the best map so far.
//!
//! ```
//! use authalic::{SphereMapOptions, Surface, sphere_map};
//! use ndarray::array;
//!
//! let vertices = array![[3., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
//! let faces = array![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
//! let surface = Surface::new(vertices, faces)?;
//!
//! let mut keep_going = |fraction: f64, _message: &str| (0.0..=1.0).contains(&fraction);
//! let map = sphere_map(&surface, &SphereMapOptions::default(), &mut keep_going)?;
//!
//! println!("{} after {} iterations", map.status.as_str(), map.history.iterations());
//! assert!(map.positions.rows().into_iter().all(|row| (row.dot(&row) - 1.0).abs() < 1e-12));
//! # Ok::<(), authalic::Error>(())
//! ```
//!
//! # Registration by landmark points
//!
//! ```
//! use authalic::{Landmarks, RegistrationOptions, Silent, Surface, homotopy, register_spheres};
//! use ndarray::array;
//!
//! let corners = array![[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
//! let faces = array![[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]];
//! let small = Surface::new(&corners, &faces)?;
//! let large = Surface::new(&corners * 3.0, &faces)?;
//!
//! let landmarks = Landmarks { source: &[0, 1], target: &[0, 1] };
//! let options = RegistrationOptions::default();
//! let registration = register_spheres(&small, &large, &landmarks, &options, &mut Silent)?;
//!
//! let map = &registration.correspondence;
//! assert!((map.positions() - &corners * 3.0).iter().all(|difference| difference.abs() < 1e-6));
//! // per-vertex data of the target at the vertices of the source, and the middle of the morph
//! let heights = map.pull_vertices(large.vertices().slice(ndarray::s![.., 2..]))?;
//! let middle = homotopy(small.vertices(), map, 0.5, false)?;
//! assert!((heights[[0, 0]] - 3.0).abs() < 1e-6 && (middle[[0, 2]] - 2.0).abs() < 1e-6);
//! # Ok::<(), authalic::Error>(())
//! ```
//!
//! # Registration by landmark curves
//!
//! Curves are paths of vertices along edges; boundary loops are features too. The certificates prove that the map is
//! one-to-one.
//!
//! ```
//! use authalic::{HyperbolicOptions, LandmarkCurves, Silent, Surface, register_hyperbolic};
//! use ndarray::Array2;
//!
//! // a ball without its poles: 13 rings of 24 vertices
//! let vertices = Array2::from_shape_fn((13 * 24, 3), |(vertex, axis)| {
//!     let (height, angle) = (-0.9 + 0.15 * (vertex / 24) as f64, (vertex % 24) as f64 * std::f64::consts::TAU / 24.0);
//!     let radius = (1.0 - height * height).sqrt();
//!     [radius * angle.cos(), radius * angle.sin(), height][axis]
//! });
//! let faces = Array2::from_shape_fn((12 * 48, 3), |(face, corner)| {
//!     let (quad, is_upper) = (face as u32 / 2, face % 2 == 1);
//!     let (below, beside) = (quad, quad / 24 * 24 + (quad + 1) % 24);
//!     (if is_upper { [below, beside + 24, below + 24] } else { [below, beside, beside + 24] })[corner]
//! });
//! let band = Surface::new(vertices, faces)?;
//!
//! let curves = [vec![76, 100, 124, 148], vec![88, 112, 136, 160, 184]];
//! let curves = LandmarkCurves { source: &curves, target: &curves };
//! let registration = register_hyperbolic(&band, &band, &curves, &HyperbolicOptions::default(), &mut Silent)?;
//!
//! assert!(registration.certificates.folded.is_empty() && registration.certificates.curve_error < 1e-9);
//! # Ok::<(), authalic::Error>(())
//! ```
//!
//! # Errors and determinism
//!
//! Only broken input and failed numerics are errors; they name the elements at fault as data ([`Error`]). A run that
//! stops early returns its best map with a [`Status`]. Results do not depend on the number of threads.
//!
//! # WebAssembly
//!
//! The crate works on `wasm32-unknown-unknown`, on one thread. There is no clock: all seconds are 0.
//!
//! # Feature flags
//!
//! None is on by default.
//!
//! - `metis`: orders the unknowns of large systems (from about 200,000 vertices) by nested dissection with METIS, which
//!   makes their factorizations faster. METIS is C code under the Apache license that is compiled along: this needs a C
//!   compiler. On Windows the feature changes nothing.

mod alignment;
mod arrays;
mod clock;
mod codomain;
mod control;
mod disk;
mod distortion;
mod embedding;
mod energy;
mod error;
mod filling;
mod hyperbolic;
mod layout;
mod location;
#[doc(hidden)]
pub mod memory;
mod mesh;
mod optimize;
mod options;
mod packing;
mod parallel;
mod record;
mod registration;
mod repair;
mod resampling;
mod seams;
mod sets;
mod sparse;
mod sphere;
#[doc(hidden)]
pub mod testing;
mod untangle;
mod unwrap;
mod vector;

pub use control::{History, Observer, Record, Silent, Status};
pub use disk::{Boundary, DiskMap, DiskMapOptions, DiskMethod, disk_map, disk_maps};
pub use distortion::{Distortion, Measurable, distortion, distortions};
pub use energy::{SparseColumns, stretch_hessian};
pub use error::{
    CurveError, Elements, Error, ErrorKind, LandmarkError, MapError, MeshError, NumericsError, Side,
};
pub use hyperbolic::{
    Certificates, Complex, CoverCopy, CurveMap, CurveRegistration, Descent, FlowOptions, HarmonicSolver,
    HyperbolicEnergy, HyperbolicOptions, HyperbolicStructure, LandmarkCurves, MetricMethod, Moebius, Pants,
    RoughSphere, Warning, WarningKind, cover, hyperbolic_structure, register_hyperbolic,
};
pub use layout::{Layout, LayoutKind, LayoutOptions, Precision, Seam, SphereFaces, layout};
pub use mesh::{Corner, Face, Patch, Surface, Topology, Vertex};
pub use optimize::published::gradient_descent::LineSearch;
pub use packing::{Island as PlanarIsland, Margin, PackOptions, Packing, Place, Rotation, pack};
pub use parallel::set_threads;
pub use record::{Entry, Recorded, Tree};
pub use registration::{
    Correspondence, DiskRegistration, Energy, Features, Landmarks, Registration, RegistrationOptions,
    SphereRegistration, Strain, follow, homotopy, register_disks, register_spheres,
};
pub use repair::{CloseHandles, CloseHoles, Keep, RepairCounts, RepairOptions, Repaired, repair};
pub use resampling::{CellIntegrals, Grid, Icosphere, InverseMap, Outside, PerElement, Places, RefinedFaces};
pub use seams::{SeamMethod, SeamOptions, Seams, Symmetry, seams};
pub use sphere::{Refinement, SphereFilling, SphereMap, SphereMapOptions, SphereMethod, sphere_map};
pub use untangle::{UntangleOptions, Untangled, untangle};
pub use unwrap::{Unwrap, UnwrapOptions, UnwrapSeams, unwrap};

/// The examples of the crate's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
