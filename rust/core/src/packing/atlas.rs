// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cells of the square that are taken, and the search for a place that is free.

use super::mask::Mask;

/// Cells per word.
const WORD: usize = u64::BITS as usize;

/// A square of cells, each taken or free, in rows of words.
///
/// Level k says of each cell whether it or one of the next 2ᵏ − 1 cells to its right is taken, so that two bits tell
/// whether any span of cells is free, and two words tell it of 64 neighboring spans.
#[derive(Debug, Clone)]
pub(super) struct Atlas {
    grid: Grid,
    words: Vec<u64>,
}

/// The shape of an [`Atlas`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    /// Cells along a side.
    pub side: usize,
    /// The length of a cell.
    pub cell: f64,
}

impl Grid {
    /// The length of a side.
    pub fn length(self) -> f64 {
        self.side as f64 * self.cell
    }

    /// A grid of the same square with so many cells in the place of one, along a side.
    pub fn refined(self, n: usize) -> Self {
        Self { side: n * self.side, cell: self.cell / n as f64 }
    }

    /// Words per row, with those that a shifted word reads past the end.
    fn stride(self) -> usize {
        self.side.div_ceil(WORD) + 2
    }

    fn levels(self) -> usize {
        self.side.max(1).ilog2() as usize + 1
    }

    /// The first word of a row.
    fn row(self, level: usize, row: usize) -> usize {
        (level * self.side + row) * self.stride()
    }
}

/// The cells of an island as pairs of bits to look at in an [`Atlas`].
#[derive(Debug, Clone, Default)]
pub(super) struct Probes(Vec<Probe>);

#[derive(Debug, Clone, Copy)]
struct Probe {
    /// The word, for an island at the origin.
    word: u32,
    /// The bit in the word.
    bit: u32,
}

impl Probes {
    /// The probes of a mask in the quarter of positive rows and columns, rows far apart first: they find out soonest that
    /// a place is taken.
    pub fn new(mask: &Mask, grid: Grid) -> Self {
        let first_row = mask.first_row as usize;
        let rows = spread_out(mask.rows.len());
        let probes = rows.into_iter().flat_map(|row| {
            mask.rows[row].iter().flat_map(move |&[first, end]| {
                let level = (end - first).ilog2();
                [first, end - (1 << level)].map(|cell| Probe {
                    word: (grid.row(level as usize, row + first_row) + cell as usize / WORD) as u32,
                    bit: cell as u32 % u64::BITS,
                })
            })
        });
        Self(probes.collect())
    }
}

/// `0..n`, each next number far from those before.
fn spread_out(n: usize) -> Vec<usize> {
    let bits = n.next_power_of_two().trailing_zeros();
    let reversed = |k: usize| if bits == 0 { k } else { k.reverse_bits() >> (usize::BITS - bits) };
    (0..n.next_power_of_two()).map(reversed).filter(|&k| k < n).collect()
}

impl Atlas {
    /// All cells free.
    pub fn new(grid: Grid) -> Self {
        Self { grid, words: vec![0; grid.row(grid.levels(), 0)] }
    }

    /// Takes the cells of a mask moved by (x, y), as far as they lie in the square.
    pub fn take(&mut self, mask: &Mask, [x, y]: [usize; 2]) {
        let side = self.grid.side as i32;
        for (k, spans) in mask.rows.iter().enumerate() {
            let row = k as i32 + mask.first_row + y as i32;
            if (0..side).contains(&row) {
                let words = self.grid.row(0, row as usize);
                for &[first, end] in spans {
                    let cells = [first, end].map(|cell| (cell + x as i32).clamp(0, side) as usize);
                    set_bits(&mut self.words[words..], cells);
                }
                self.raise(row as usize);
            }
        }
    }

    /// Renews the higher levels of a row.
    fn raise(&mut self, row: usize) {
        let stride = self.grid.stride();
        for level in 1..self.grid.levels() {
            let [below, above] = [level - 1, level].map(|level| self.grid.row(level, row));
            let shift = 1_usize << (level - 1);
            for word in 0..stride {
                let next = |k: usize| if k < stride { self.words[below + k] } else { 0 };
                let [low, high] = [0, 1].map(|k| next(word + shift / WORD + k));
                self.words[above + word] =
                    self.words[below + word] | shifted(low, high, (shift % WORD) as u32);
            }
        }
    }

    /// The first x of at most `max_x` at which an island is free in height `y`.
    pub fn first_free(&self, probes: &Probes, y: usize, max_x: usize) -> Option<usize> {
        let words = &self.words[y * self.grid.stride()..];
        (0..=max_x / WORD)
            .find_map(|column| {
                let mut taken = 0;
                for probe in &probes.0 {
                    let word = probe.word as usize + column;
                    taken |= shifted(words[word], words[word + 1], probe.bit);
                    if taken == u64::MAX {
                        return None;
                    }
                }
                Some(column * WORD + taken.trailing_ones() as usize)
            })
            .filter(|&x| x <= max_x)
    }
}

/// 64 bits out of two words, from a bit of the first on.
fn shifted(low: u64, high: u64, bit: u32) -> u64 {
    (low >> bit) | (high << 1 << (u64::BITS - 1 - bit))
}

/// Sets the bits of a range.
fn set_bits(words: &mut [u64], [first, end]: [usize; 2]) {
    let mut bit = first;
    while bit < end {
        let n = (WORD - bit % WORD).min(end - bit);
        words[bit / WORD] |= (u64::MAX >> (WORD - n)) << (bit % WORD);
        bit += n;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mask(rows: &[&[[i32; 2]]]) -> Mask {
        Mask { rows: rows.iter().map(|row| row.to_vec()).collect(), first_row: 0 }
    }

    #[test]
    fn the_first_free_place_is_that_of_a_plain_search() {
        let grid = Grid { side: 150, cell: 1.0 };
        let mut atlas = Atlas::new(grid);
        let mut taken = vec![[false; 150]; 150];
        for k in 0..40_usize {
            let [x, y, length] = [k * 53 % 140, k * 31 % 149, 1 + k * 7 % 40];
            atlas.take(&mask(&[&[[0, length as i32]], &[[-3, 2]]]), [x, y]);
            taken[y][x..150.min(x + length)].fill(true);
            taken[y + 1][x.saturating_sub(3)..x + 2].fill(true);
        }
        let shape: [&[[i32; 2]]; 3] = [&[[0, 9]], &[[0, 1], [7, 9]], &[[2, 9]]];
        let probes = Probes::new(&mask(&shape), grid);
        for y in 0..147 {
            let is_free = |x: &usize| {
                let cells = shape.iter().enumerate().flat_map(|(row, spans)| {
                    spans
                        .iter()
                        .flat_map(move |&[first, end]| (first..end).map(move |cell| (row, cell as usize)))
                });
                cells.into_iter().all(|(row, cell)| !taken[y + row][x + cell])
            };
            assert_eq!(atlas.first_free(&probes, y, 141), (0..=141).find(is_free), "{y}");
        }
    }

    #[test]
    fn all_numbers_come_once() {
        for n in [0, 1, 2, 7, 64, 100] {
            let mut numbers = spread_out(n);
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(0..n));
        }
    }
}
