// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::pack`.

use std::time::Instant;

use authalic::{Margin, PackOptions, PlanarIsland, Rotation, Vertex};
use numpy::PyArray1;
use numpy::ndarray::{Array2, ArrayView2};
use pyo3::prelude::*;
use pyo3::{Borrowed, FromPyObject, IntoPyObjectExt};

use crate::arrays::{Reals, from_array, frozen, real_table};
use crate::errors::{bad_array, bad_option};
use crate::indices::{index_table, labels};
use crate::memory;
use crate::options::choice;
use crate::provenance::{Call, fingerprint_of, options};
use crate::result::{ResultBase, made, restorable};
use crate::run::run;

/// Where the islands of a UV map go in the unit square.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Packing {
    /// (n, 2) float64: the packed points; points without a face stay where they were.
    uv: Reals,
    /// The common scale of all islands, upward.
    scale: f64,
    /// (k,) float64: the angle by which each island is turned, counterclockwise, in radians.
    angles: Py<PyArray1<f64>>,
    /// Wall time of the call.
    seconds: f64,
}

restorable!(Packing { uv, scale, angles, seconds });

#[pymethods]
impl Packing {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let n_islands = self.angles.bind(py).len()?;
        Ok(format!("Packing({n_islands} islands, scale {:.4}, {:.2} s)", self.scale, self.seconds))
    }
}

/// Packs the islands of a UV map into the unit square, outline by outline, all by one scale.
///
/// Small islands come to lie in bays and holes of larger ones. Islands are turned and moved, never mirrored; they may
/// overlap themselves.
///
/// Parameters
/// ----------
/// uv : (n, 2) real array
///     The points of all islands, at the density common to all. Islands may lie over each other.
/// faces : (m, 3) int array
///     Faces between points.
/// island_of : (m,) int array
///     The island of each face, numbered from 0. No two islands have a point in common.
/// margin : float
///     Least distance of islands from each other and from the border of the square, in [0, .5), in units of the
///     square. Default .002, which is two pixels of a texture of 1,024².
/// margin_unit : "square" or "islands"
///     "square", the default; with "islands" the margin is ≥ 0, in units of `uv`.
/// rotate : bool or "cardinal"
///     Let the packing turn islands by any angle, or by right angles only. Default True.
/// aspect : float
///     Width over height of the texture, > 0. Islands keep their shapes on the texture, so that in the square they are
///     narrower by this factor. Default 1.
/// progress : callable(fraction, message) -> bool, optional
///     Called throughout; False cancels, and the call raises.
///
/// Returns
/// -------
/// Packing
///
/// Raises
/// ------
/// MeshError
///     An array does not fit, has values that are not finite, or all islands are without area.
/// ValueError
///     An option is out of its range, or the margin is too large for the number of islands.
/// SolverError
///     The call was cancelled.
///
/// Examples
/// --------
/// Two squares of side 1 and 2, one over the other:
///
/// >>> import authalic
/// >>> uv = [[0, 0], [1, 0], [1, 1], [0, 1], [0, 0], [2, 0], [2, 2], [0, 2]]
/// >>> faces = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]
/// >>> packing = authalic.pack(uv, faces, [0, 0, 1, 1], margin=0)
/// >>> 0.32 < packing.scale <= 1 / 3
/// True
#[pyfunction]
#[pyo3(
    signature = (uv, faces, island_of, *, margin=0.002, margin_unit="square", rotate=Turns(Rotation::Free), aspect=1.0,
        progress=None),
    text_signature = "(uv, faces, island_of, *, margin=0.002, margin_unit=\"square\", rotate=True, aspect=1.0, \
        progress=None)"
)]
#[expect(clippy::too_many_arguments, reason = "the options of the Python function")]
pub fn pack(
    py: Python<'_>,
    uv: &Bound<'_, PyAny>,
    faces: &Bound<'_, PyAny>,
    island_of: &Bound<'_, PyAny>,
    margin: f64,
    margin_unit: &str,
    rotate: Turns,
    aspect: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<Packing>> {
    // 1. Arguments to plain data
    let began = Instant::now();
    let kept = options!(py; island_of, margin, margin_unit, rotate = rotate.given(py)?, aspect)?;
    let uv = real_table::<2>(uv, "uv")?;
    let faces = index_table::<3>(faces, "faces", uv.nrows())?;
    let options = PackOptions {
        margin: choice("margin_unit", margin_unit, &UNITS)?(margin),
        rotation: rotate.0,
        aspect,
    };
    memory::check(py, memory::PACKING, uv.nrows())?;
    let islands = islands(py, uv.view(), faces.view(), &labels(island_of, "island_of")?)?;
    // 2. The run
    let (uv, packing, input) = run(py, progress, move |observer| {
        let input = fingerprint_of(uv.view(), faces.view());
        let shapes: Vec<_> = islands.iter().map(Island::shape).collect();
        let packing = authalic::pack(&shapes, &options, observer)?;
        Ok((packed(uv, &islands, &packing), packing, input))
    })?;
    // 3. The result
    let packing = Packing {
        uv: from_array(py, uv),
        scale: packing.scale,
        angles: frozen(PyArray1::from_iter(py, packing.places.iter().map(|place| place.angle))),
        seconds: began.elapsed().as_secs_f64(),
    };
    made(py, packing, Call::new("pack", &kept, "uv", input).into())
}

/// A margin of a length in one of its units.
type Unit = fn(f64) -> Margin;

const UNITS: [(&str, Unit); 2] = [("square", Margin::OfSquare), ("islands", Margin::OfIslands)];

/// A truth value, or "cardinal".
#[derive(Clone, Copy)]
pub struct Turns(Rotation);

impl Turns {
    /// What Python calls it.
    fn given(self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        match self.0 {
            Rotation::Fixed => false.into_py_any(py),
            Rotation::Cardinal => "cardinal".into_py_any(py),
            Rotation::Free => true.into_py_any(py),
        }
    }
}

impl<'py> FromPyObject<'_, 'py> for Turns {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(is_wanted) = given.extract::<bool>() {
            return Ok(Self(if is_wanted { Rotation::Free } else { Rotation::Fixed }));
        }
        match given.extract::<String>().as_deref() {
            Ok("cardinal") => Ok(Self(Rotation::Cardinal)),
            _ => {
                let found = given.repr()?;
                Err(bad_option(format!("rotate must be True, False or \"cardinal\", but is {found}")))
            }
        }
    }
}

/// The points and faces of an island, with the rows of its points.
#[derive(Default)]
struct Island {
    rows: Vec<usize>,
    points: Vec<[f64; 2]>,
    faces: Vec<[Vertex; 3]>,
}

impl Island {
    fn shape(&self) -> PlanarIsland<'_> {
        PlanarIsland { points: &self.points, faces: &self.faces }
    }
}

/// The islands by the labels of their faces.
fn islands(
    py: Python<'_>,
    uv: ArrayView2<'_, f64>,
    faces: ArrayView2<'_, u32>,
    labels: &[i64],
) -> PyResult<Vec<Island>> {
    let refused = |found: String, expected: &str| bad_array(py, "island_of", found, expected.into());
    if labels.len() != faces.nrows() {
        return Err(refused(format!("of shape ({},)", labels.len()), "one number per face"));
    }
    // no island is without a face, so there are no more of them than faces
    if let Some(label) =
        labels.iter().find(|&&label| usize::try_from(label).map_or(true, |k| k >= labels.len()))
    {
        return Err(refused(format!("{label} for a face"), "numbers from 0, below the number of faces"));
    }
    let n_islands = labels.iter().max().map_or(0, |&label| label as usize + 1);
    let mut islands: Vec<Island> = (0..n_islands).map(|_| Island::default()).collect();
    let mut places: Vec<Option<(usize, Vertex)>> = vec![None; uv.nrows()];
    for (face, &label) in faces.rows().into_iter().zip(labels) {
        let label = label as usize;
        let island = &mut islands[label];
        let mut corners = [Vertex(0); 3];
        for (corner, &row) in corners.iter_mut().zip(&face) {
            let row = row as usize;
            let &mut (owner, vertex) = places[row].get_or_insert_with(|| {
                island.rows.push(row);
                island.points.push([uv[[row, 0]], uv[[row, 1]]]);
                (label, Vertex(island.points.len() as u32 - 1))
            });
            if owner != label {
                return Err(refused(format!("{owner} and {label} at point {row}"), "one island per point"));
            }
            *corner = vertex;
        }
        island.faces.push(corners);
    }
    Ok(islands)
}

/// All points where the packing puts them.
fn packed(mut uv: Array2<f64>, islands: &[Island], packing: &authalic::Packing) -> Array2<f64> {
    for (number, island) in islands.iter().enumerate() {
        for (&row, &point) in island.rows.iter().zip(&island.points) {
            let place = packing.apply(number, point);
            uv.row_mut(row).assign(&numpy::ndarray::aview1(&place));
        }
    }
    uv
}
