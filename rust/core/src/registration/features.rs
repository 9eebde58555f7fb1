// SPDX-License-Identifier: MIT OR Apache-2.0
//! Features: signals at the vertices of both surfaces that should agree through the map, as curvature, the depth of
//! sulci or painted weights.

use std::iter;

use ndarray::{ArrayView1, ArrayView2};

use crate::alignment::similarity::similarity;
use crate::error::{Elements, Error};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Signals of both surfaces and their weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Features<'a> {
    /// (n, k): the signals at the source's vertices.
    pub source: ArrayView2<'a, f64>,
    /// (n_t, k): the signals at the target's vertices, in the same order.
    pub target: ArrayView2<'a, f64>,
    /// (k,): how strongly each signal pulls, ≥ 0; or one number for all.
    pub weights: &'a [f64],
}

/// Signals to compare as they are: their weighted difference counts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Signals {
    /// The number of signals.
    pub width: usize,
    /// `width` values for each vertex of the source, one vertex after the other.
    pub source: Vec<f64>,
    /// `width` values for each vertex of the target.
    pub target: Vec<f64>,
}

impl Signals {
    /// Scales the features: each signal is centered on either surface, divided by the standard deviation common to
    /// both, and multiplied by the root of its weight. Means weigh vertices by area.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where shapes do not fit, or a signal is not finite or does not vary.
    pub(crate) fn new(features: &Features<'_>, meshes: [&TriangleMesh; 2]) -> Result<Self, Error> {
        features.check(meshes)?;
        let areas = meshes.map(|mesh| mesh.vertex_shares(mesh.face_areas()));
        let mut signals = Self::default();
        for column in 0..features.source.ncols() {
            let weight = features.weights[if features.weights.len() == 1 { 0 } else { column }];
            let sides = [features.source.column(column), features.target.column(column)];
            let [source, target] = [0, 1].map(|side| centered(sides[side], &areas[side]));
            let names = ["source features", "target features"];
            for (side, name) in [&source, &target].into_iter().zip(names) {
                if !side.varies() {
                    let expected = "signals that vary".into();
                    return Err(Error::InvalidArray {
                        name,
                        found: format!("constant in column {column}"),
                        expected,
                    });
                }
            }
            // either deviation alone may be too large to be squared
            let deviation = source.deviation.hypot(target.deviation) * 0.5f64.sqrt();
            if weight > 0.0 {
                signals.add([source.values, target.values], weight.sqrt() / deviation);
            }
        }
        Ok(signals)
    }

    /// The signals at some vertices of either surface.
    pub(crate) fn at(&self, [source, target]: [&[Vertex]; 2]) -> Self {
        let width = self.width;
        let rows = |values: &[f64], vertices: &[Vertex]| {
            let row = |&vertex: &Vertex| &values[width * vertex.index()..][..width];
            vertices.iter().flat_map(row).copied().collect()
        };
        Self { width, source: rows(&self.source, source), target: rows(&self.target, target) }
    }

    /// Adds one signal, (n,) and (n_t,), times a factor.
    fn add(&mut self, [source, target]: [Vec<f64>; 2], factor: f64) {
        self.source = widened(&self.source, self.width, source.into_iter().map(|value| factor * value));
        self.target = widened(&self.target, self.width, target.into_iter().map(|value| factor * value));
        self.width += 1;
    }

    /// Adds the positions of the vertices, in units of the target's size, the root of its area. The source is moved by
    /// the similarity that brings it nearest to `images`, (n, 3): its image on the target.
    pub(crate) fn add_positions(
        &mut self,
        [source, target]: [&TriangleMesh; 2],
        images: &[Vector3],
        weight: f64,
    ) {
        let alignment = similarity(source.points(), images, &source.vertex_shares(source.face_areas()));
        let moved: Vec<Vector3> = source.points().iter().map(|&point| alignment.apply(point)).collect();
        let area: f64 = target.face_areas().iter().sum();
        for axis in 0..3 {
            let along = |points: &[Vector3]| points.iter().map(|point| point[axis]).collect();
            self.add([along(&moved), along(target.points())], (weight / area).sqrt());
        }
    }
}

impl Features<'_> {
    fn check(&self, [source, target]: [&TriangleMesh; 2]) -> Result<(), Error> {
        check_signals("source features", self.source, source)?;
        check_signals("target features", self.target, target)?;
        let [ours, theirs] = [self.source.ncols(), self.target.ncols()];
        if ours != theirs {
            let expected = format!("as many signals as the source has, {ours}");
            return Err(Error::InvalidArray { name: "target features", found: theirs.to_string(), expected });
        }
        let found = if ![1, ours].contains(&self.weights.len()) {
            format!("of shape ({},)", self.weights.len())
        } else if let Some(bad) = self.weights.iter().find(|weight| !(**weight >= 0.0 && weight.is_finite()))
        {
            bad.to_string()
        } else {
            return Ok(());
        };
        let expected = format!("one finite number ≥ 0, or one for each of the {ours} features");
        Err(Error::InvalidOption { name: "feature_weight", found, expected })
    }
}

fn check_signals(name: &'static str, signals: ArrayView2<'_, f64>, mesh: &TriangleMesh) -> Result<(), Error> {
    let (rows, columns) = signals.dim();
    let invalid = |found: String, expected: String| Err(Error::InvalidArray { name, found, expected });
    if rows != mesh.n_vertices() || columns == 0 {
        let expected =
            format!("of shape ({}, k), one row per vertex and at least one signal", mesh.n_vertices());
        return invalid(format!("of shape ({rows}, {columns})"), expected);
    }
    let is_bad = |&row: &usize| signals.row(row).iter().any(|value| !value.is_finite());
    match Elements::collect((0..rows).filter(is_bad)) {
        None => Ok(()),
        Some(rows) => Err(Error::InvalidRows {
            name,
            found: "NaN or infinite".into(),
            expected: "finite".into(),
            row: "vertex",
            rows,
        }),
    }
}

/// A signal less its mean.
struct Centered {
    values: Vec<f64>,
    deviation: f64,
    largest: f64,
}

impl Centered {
    /// Whether the signal is more than the rounding of a constant.
    fn varies(&self) -> bool {
        self.deviation > 1e-12 * self.largest
    }
}

fn centered(signal: ArrayView1<'_, f64>, areas: &[f64]) -> Centered {
    let largest = signal.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    if largest == 0.0 {
        return Centered { values: signal.to_vec(), deviation: 0.0, largest };
    }
    // in units of the largest value no square over- or underflows
    let mut values: Vec<f64> = signal.iter().map(|value| value / largest).collect();
    let [total, sum] = parallel::sums(values.len(), |v| [areas[v], areas[v] * values[v]]);
    values.iter_mut().for_each(|value| *value -= sum / total);
    let square = parallel::sum(values.len(), |v| areas[v] * values[v] * values[v]);
    let deviation = (square / total).sqrt() * largest;
    values.iter_mut().for_each(|value| *value *= largest);
    Centered { values, deviation, largest }
}

/// Rows of `width` values, each with one more behind.
fn widened(rows: &[f64], width: usize, more: impl ExactSizeIterator<Item = f64>) -> Vec<f64> {
    let mut wide = Vec::with_capacity(rows.len() + more.len());
    for (row, value) in more.enumerate() {
        wide.extend(rows[row * width..(row + 1) * width].iter().copied().chain(iter::once(value)));
    }
    wide
}

#[cfg(test)]
mod tests {
    use ndarray::{Array2, array};

    use super::*;

    fn tetrahedron() -> TriangleMesh {
        let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
        TriangleMesh::new(&corners, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]).unwrap()
    }

    fn prepared(source: &Array2<f64>, target: &Array2<f64>, weights: &[f64]) -> Result<Signals, Error> {
        let mesh = tetrahedron();
        Signals::new(&Features { source: source.view(), target: target.view(), weights }, [&mesh, &mesh])
    }

    #[test]
    fn signals_are_centered_and_scaled_alike() {
        let source = array![[1., 5.], [3., 0.], [1., 0.], [3., 0.]];
        let target = array![[17., 0.], [19., 0.], [17., 7.], [19., 0.]];
        let signals = prepared(&source, &target, &[4.0, 0.0]).unwrap();
        assert_eq!(signals.width, 1);
        for (values, wanted) in [(&signals.source, [-2., 2., -2., 2.]), (&signals.target, [-2., 2., -2., 2.])]
        {
            assert!(values.iter().zip(wanted).all(|(value, wanted)| (value - wanted).abs() < 1e-12));
        }
        // sizes whose squares overflow
        let huge = prepared(&source.mapv(|x| 1e200 * x), &target.mapv(|x| 1e200 * x), &[4.0, 1.0]).unwrap();
        assert!((huge.source[2] - 2.0).abs() < 1e-12 && huge.width == 2 && huge.source.len() == 8);
    }

    #[test]
    fn bad_signals_are_refused_by_name() {
        let good = array![[1.], [2.], [3.], [4.]];
        let said = |source: &Array2<f64>, target: &Array2<f64>, weights: &[f64]| {
            prepared(source, target, weights).map(|_| ()).unwrap_err().to_string()
        };
        assert!(said(&array![[1.], [2.]], &good, &[1.0]).contains("source features must be of shape (4, k)"));
        assert!(said(&good, &array![[1.], [f64::NAN], [3.], [4.]], &[1.0]).contains("infinite at vertex 1"));
        assert!(said(&good, &array![[5.], [5.], [5.], [5.]], &[1.0]).contains("constant in column 0"));
        assert!(
            said(&good, &array![[1., 2.], [2., 1.], [3., 5.], [4., 6.]], &[1.0]).contains("as many signals")
        );
        assert!(said(&good, &good, &[1.0, 2.0]).contains("feature_weight"));
        assert!(said(&good, &good, &[-1.0]).contains("feature_weight"));
    }

    #[test]
    fn positions_agree_after_a_similarity() {
        let source = tetrahedron();
        let turned = source.points().iter().map(|&Vector3([x, y, z])| Vector3([-y, x, z]) * 3.0).collect();
        let target = source.at_points(turned);
        let mut signals = Signals::default();
        signals.add_positions([&source, &target], target.points(), 2.0);
        assert_eq!(signals.width, 3);
        assert!(
            signals.source.iter().zip(&signals.target).all(|(ours, theirs)| (ours - theirs).abs() < 1e-12)
        );
    }
}
