// SPDX-License-Identifier: MIT OR Apache-2.0
//! Results as named arrays, from which they are made again: what files of results hold.
//!
//! A [`Tree`] has entries by name: real numbers, integers, words, and trees of their own. A type that is [`Recorded`]
//! writes such a tree and reads it. Names and shapes are a format that later versions read, so they never change their
//! meanings.

use std::collections::BTreeMap;

use ndarray::{Array, Array1, Array2, ArrayD, Dimension};

use crate::control::{History, Record, Status};
use crate::error::Error;

/// A result as entries by name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tree(BTreeMap<String, Entry>);

/// An entry of a [`Tree`].
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// Real numbers.
    Reals(ArrayD<f64>),
    /// Indices and counts.
    Integers(ArrayD<i64>),
    /// A word.
    Text(String),
    /// A part of the result.
    Tree(Tree),
    /// Parts of one kind.
    Trees(Vec<Tree>),
}

/// A result that can be written as a [`Tree`] and made again of it.
pub trait Recorded: Sized {
    /// The result as named arrays.
    fn record(&self) -> Tree;

    /// The result of such arrays.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where an entry is missing, or is not what it should be.
    fn of_record(record: &Tree) -> Result<Self, Error>;
}

impl Tree {
    /// The tree without entries.
    pub fn new() -> Self {
        Self::default()
    }

    /// The tree with one entry more.
    #[must_use]
    pub fn with(mut self, name: &str, entry: impl Into<Entry>) -> Self {
        self.0.insert(name.into(), entry.into());
        self
    }

    /// The entries by name.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &Entry)> {
        self.0.iter().map(|(name, entry)| (name.as_str(), entry))
    }

    /// Whether there is an entry.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// An array of real numbers.
    ///
    /// # Errors
    /// As [`Recorded::of_record`].
    pub fn reals<D: Dimension>(&self, name: &str) -> Result<Array<f64, D>, Error> {
        match self.0.get(name) {
            Some(Entry::Reals(reals)) => {
                reals.clone().into_dimensionality().map_err(|_| misfit(name, "of another shape"))
            }
            Some(_) => Err(misfit(name, "no array of real numbers")),
            None => Err(misfit(name, "missing")),
        }
    }

    /// One real number.
    ///
    /// # Errors
    /// As [`Recorded::of_record`].
    pub fn real(&self, name: &str) -> Result<f64, Error> {
        let reals: Array1<f64> = self.reals(name)?;
        reals.first().copied().ok_or_else(|| misfit(name, "empty"))
    }

    /// Real numbers as rows of a fixed length.
    pub(crate) fn rows<const N: usize>(&self, name: &str) -> Result<Vec<[f64; N]>, Error> {
        let table: Array2<f64> = self.reals(name)?;
        Ok(crate::arrays::rows_of::<N, _>("a saved array", table.view())?.into_owned())
    }

    /// Indices and counts, not negative, in one row.
    ///
    /// # Errors
    /// As [`Recorded::of_record`].
    pub fn indices(&self, name: &str) -> Result<Vec<usize>, Error> {
        self.integers(name)?.iter().map(|&index| not_negative(name, index)).collect()
    }

    /// Indices below a limit, in one row.
    pub(crate) fn indices_below(&self, name: &str, limit: usize) -> Result<Vec<usize>, Error> {
        let indices = self.indices(name)?;
        if indices.iter().any(|&index| index >= limit) {
            return Err(misfit(name, "out of range"));
        }
        Ok(indices)
    }

    /// Real numbers in a table of so many rows.
    pub(crate) fn table(&self, name: &str, n_rows: usize) -> Result<Array2<f64>, Error> {
        let table: Array2<f64> = self.reals(name)?;
        if table.nrows() == n_rows { Ok(table) } else { Err(misfit(name, "of another length")) }
    }

    /// One count.
    ///
    /// # Errors
    /// As [`Recorded::of_record`].
    pub fn count(&self, name: &str) -> Result<usize, Error> {
        self.indices(name)?.first().copied().ok_or_else(|| misfit(name, "empty"))
    }

    /// Indices below 2³² as rows of a fixed length.
    pub(crate) fn index_rows<const N: usize>(&self, name: &str) -> Result<Vec<[u32; N]>, Error> {
        let table = self.integers(name)?.clone().into_dimensionality::<ndarray::Ix2>();
        let table = table.map_err(|_| misfit(name, "of another shape"))?;
        let narrow = |&index: &i64| u32::try_from(index).map_err(|_| misfit(name, "no index"));
        let flat = table.iter().map(narrow).collect::<Result<Vec<u32>, Error>>()?;
        if table.ncols() != N {
            return Err(misfit(name, "of another shape"));
        }
        Ok(flat.as_chunks().0.to_vec())
    }

    fn integers(&self, name: &str) -> Result<&ArrayD<i64>, Error> {
        match self.0.get(name) {
            Some(Entry::Integers(integers)) => Ok(integers),
            Some(_) => Err(misfit(name, "no array of integers")),
            None => Err(misfit(name, "missing")),
        }
    }

    /// A word.
    ///
    /// # Errors
    /// As [`Recorded::of_record`].
    pub fn text(&self, name: &str) -> Result<&str, Error> {
        match self.0.get(name) {
            Some(Entry::Text(text)) => Ok(text),
            Some(_) => Err(misfit(name, "no word")),
            None => Err(misfit(name, "missing")),
        }
    }

    /// A part.
    ///
    /// # Errors
    /// As [`Recorded::of_record`].
    pub fn tree(&self, name: &str) -> Result<&Self, Error> {
        match self.0.get(name) {
            Some(Entry::Tree(tree)) => Ok(tree),
            Some(_) => Err(misfit(name, "no part of a result")),
            None => Err(misfit(name, "missing")),
        }
    }

    /// Parts of one kind.
    ///
    /// # Errors
    /// As [`Recorded::of_record`].
    pub fn trees(&self, name: &str) -> Result<&[Self], Error> {
        match self.0.get(name) {
            Some(Entry::Trees(trees)) => Ok(trees),
            Some(_) => Err(misfit(name, "no list of parts")),
            None => Err(misfit(name, "missing")),
        }
    }

    /// The reason why a run ended.
    pub(crate) fn status(&self) -> Result<Status, Error> {
        Status::of_word(self.text("status")?).ok_or_else(|| misfit("status", "an unknown word"))
    }

    /// A part of a type.
    pub(crate) fn read<T: Recorded>(&self, name: &str) -> Result<T, Error> {
        T::of_record(self.tree(name)?)
    }
}

impl Recorded for History {
    fn record(&self) -> Tree {
        let column = |value: fn(&Record) -> f64| self.records().iter().map(value).collect::<Array1<f64>>();
        Tree::new()
            .with("authalic_energy", column(|record| record.authalic_energy))
            .with("step", column(|record| record.step))
            .with("gradient_norm", column(|record| record.gradient_norm))
            .with("seconds", column(|record| record.seconds))
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        let columns = ["authalic_energy", "step", "gradient_norm", "seconds"];
        let columns: Vec<Array1<f64>> =
            columns.into_iter().map(|name| record.reals(name)).collect::<Result<_, Error>>()?;
        let length = columns[0].len();
        if columns.iter().any(|column| column.len() != length) {
            return Err(misfit("history", "of several lengths"));
        }
        let row = |iteration: usize| Record {
            iteration,
            authalic_energy: columns[0][iteration],
            step: columns[1][iteration],
            gradient_norm: columns[2][iteration],
            seconds: columns[3][iteration],
        };
        Ok(Self::of_records((0..length).map(row).collect()))
    }
}

fn not_negative(name: &str, index: i64) -> Result<usize, Error> {
    usize::try_from(index).map_err(|_| misfit(name, "negative"))
}

/// The error about an entry that is not what it should be.
pub(crate) fn misfit(name: &str, found: &str) -> Error {
    let (found, expected) = (format!("{found} ({name})"), "as it was saved".into());
    Error::InvalidArray { name: "the saved result", found, expected }
}

/// Rows of indices as an entry.
pub(crate) fn index_entry<const N: usize>(rows: impl IntoIterator<Item = [u32; N]>) -> Entry {
    let flat: Vec<i64> = rows.into_iter().flatten().map(i64::from).collect();
    let shape = ndarray::IxDyn(&[flat.len() / N, N]);
    Entry::Integers(ArrayD::from_shape_vec(shape, flat).expect("the lengths agree"))
}

impl<D: Dimension> From<Array<f64, D>> for Entry {
    fn from(reals: Array<f64, D>) -> Self {
        Self::Reals(reals.into_dyn())
    }
}

impl From<f64> for Entry {
    fn from(real: f64) -> Self {
        Array1::from_elem(1, real).into()
    }
}

impl From<&[usize]> for Entry {
    fn from(indices: &[usize]) -> Self {
        Self::Integers(indices.iter().map(|&index| index as i64).collect::<Array1<i64>>().into_dyn())
    }
}

impl From<usize> for Entry {
    fn from(count: usize) -> Self {
        [count].as_slice().into()
    }
}

impl From<&str> for Entry {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<Tree> for Entry {
    fn from(tree: Tree) -> Self {
        Self::Tree(tree)
    }
}

impl From<Vec<Tree>> for Entry {
    fn from(trees: Vec<Tree>) -> Self {
        Self::Trees(trees)
    }
}

#[cfg(test)]
mod tests {
    use ndarray::{Ix2, array};

    use super::*;

    fn sample() -> Tree {
        let part = Tree::new().with("word", "converged").with("count", 7);
        Tree::new()
            .with("table", array![[1.0, f64::NAN]])
            .with("part", part)
            .with("faces", index_entry([[0, 1, 2]]))
    }

    #[test]
    fn entries_come_back_as_they_were_written() {
        let tree = sample();
        let table: Array2<f64> = tree.reals::<Ix2>("table").unwrap();
        assert!(table[[0, 0]] == 1.0 && table[[0, 1]].is_nan());
        assert_eq!(tree.index_rows::<3>("faces").unwrap(), [[0, 1, 2]]);
        let part = tree.tree("part").unwrap();
        assert_eq!((part.text("word").unwrap(), part.count("count").unwrap()), ("converged", 7));
    }

    #[test]
    fn what_is_missing_or_of_another_kind_is_an_error_that_names_it() {
        let tree = sample();
        for (error, words) in [
            (tree.real("nothing").unwrap_err(), "missing (nothing)"),
            (tree.real("table").unwrap_err(), "of another shape (table)"),
            (tree.real("faces").unwrap_err(), "no array of real numbers (faces)"),
            (tree.index_rows::<2>("faces").unwrap_err(), "of another shape (faces)"),
            (tree.indices_below("count", 7).unwrap_err(), "missing (count)"),
            (tree.tree("part").unwrap().indices_below("count", 7).unwrap_err(), "out of range (count)"),
            (tree.table("table", 2).unwrap_err(), "of another length (table)"),
            (tree.text("part").map(str::to_owned).unwrap_err(), "no word (part)"),
        ] {
            assert!(error.to_string().contains(words), "{error}");
        }
    }
}
