// SPDX-License-Identifier: MIT OR Apache-2.0
//! Many disks mapped in one go: the small ones at the same time, each on one thread.
//!
//! A small map alone is slow for its size, because each of its loops calls all threads together. Here a thread maps a
//! whole surface, and nothing waits. Large surfaces come first, one after the other on all threads. Every map is what
//! [`disk_map`] makes of its surface, bit for bit.

use std::sync::Mutex;
use std::time::Duration;

use super::{DiskMap, DiskMapOptions, disk_map};
use crate::clock::Instant;
use crate::control::{Observer, Phase};
use crate::error::Error;
use crate::mesh::Surface;
use crate::parallel;

/// Surfaces with at least this many faces keep all threads busy by themselves.
const LARGE: usize = 4000;

/// The least time between two questions to the observer while small surfaces are mapped.
const HEARTBEAT: Duration = Duration::from_millis(50);

/// Maps every surface by its options, as [`disk_map`] does; `None` for those that were not begun when the observer ended
/// the run.
///
/// The observer hears "Island 7 of 100". Cost: that of the maps, on all threads.
///
/// ```
/// use authalic::{Boundary, DiskMapOptions, Silent, Surface, disk_maps};
/// use ndarray::array;
///
/// let square = Surface::new(array![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]], array![[0, 1, 2], [0, 2, 3]])?;
/// let options = DiskMapOptions { boundary: Boundary::Free, ..Default::default() };
/// let maps = disk_maps(&[(square.clone(), options.clone()), (square, options)], &mut Silent);
/// for map in maps.into_iter().flatten() {
///     assert!(map?.distortion.area_ratio_std < 1e-12);
/// }
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn disk_maps(
    surfaces: &[(Surface, DiskMapOptions<'_>)],
    observer: &mut dyn Observer,
) -> Vec<Option<Result<DiskMap, Error>>> {
    let n_faces = |place: usize| surfaces[place].0.n_faces();
    let total = (0..surfaces.len()).map(n_faces).sum::<usize>().max(1) as f64;
    let (large, small): (Vec<usize>, Vec<usize>) =
        (0..surfaces.len()).partition(|&place| n_faces(place) >= LARGE);
    let mut maps: Vec<_> = surfaces.iter().map(|_| None).collect();
    let mut counted = Counted { whole: observer, n_done: 0, n_surfaces: surfaces.len() };
    // 1. Large surfaces, one after the other
    let mut done = 0.0;
    for place in large {
        if !counted.progress(done, "") {
            return maps;
        }
        let share = n_faces(place) as f64 / total;
        let mut phase = Phase { whole: &mut counted, from: done, to: done + share };
        let (surface, options) = &surfaces[place];
        maps[place] = Some(disk_map(surface, options, &mut phase));
        counted.n_done += 1;
        done += share;
    }
    // 2. Small ones, side by side
    if small.is_empty() || !counted.progress(done, "") {
        return maps;
    }
    let line = Line { counted, done, is_cancelled: false, asked: Instant::now() };
    let line = Mutex::new(line);
    let found = parallel::lone_tasks(small.len(), |k| {
        let (surface, options) = &surfaces[small[k]];
        let mut listener = Listener { line: &line };
        if !listener.goes_on() {
            return None;
        }
        let map = disk_map(surface, options, &mut listener);
        listener.has_mapped(surface.n_faces() as f64 / total);
        Some(map)
    });
    small.into_iter().zip(found).for_each(|(place, map)| maps[place] = map);
    maps
}

/// Tells the observer which surface is being mapped.
struct Counted<'a> {
    whole: &'a mut dyn Observer,
    n_done: usize,
    n_surfaces: usize,
}

impl Observer for Counted<'_> {
    fn progress(&mut self, fraction: f64, message: &str) -> bool {
        let colon = if message.is_empty() { "" } else { ": " };
        let number = (self.n_done + 1).min(self.n_surfaces);
        self.whole.progress(fraction, &format!("Island {number} of {}{colon}{message}", self.n_surfaces))
    }
}

/// The one line of all threads to the observer.
struct Line<'a> {
    counted: Counted<'a>,
    /// The fraction of all faces that have been mapped.
    done: f64,
    is_cancelled: bool,
    /// When the observer was asked last.
    asked: Instant,
}

/// The observer of one of many maps that are made at the same time.
struct Listener<'a, 'b> {
    line: &'a Mutex<Line<'b>>,
}

impl Listener<'_, '_> {
    fn goes_on(&mut self) -> bool {
        let Ok(mut line) = self.line.lock() else { return false };
        if !line.is_cancelled && line.asked.elapsed() >= HEARTBEAT {
            let done = line.done;
            line.is_cancelled = !line.counted.progress(done, "");
            line.asked = Instant::now();
        }
        !line.is_cancelled
    }

    fn has_mapped(&mut self, share: f64) {
        if let Ok(mut line) = self.line.lock() {
            line.done += share;
            line.counted.n_done += 1;
        }
    }
}

impl Observer for Listener<'_, '_> {
    fn progress(&mut self, _fraction: f64, _message: &str) -> bool {
        self.goes_on()
    }
}

#[cfg(test)]
mod tests {
    use ndarray::{Array2, array};

    use super::*;
    use crate::control::Silent;
    use crate::disk::Boundary;

    /// A hilly grid of `n` by `n` squares.
    fn hills(n: usize) -> Surface {
        let side = n + 1;
        let points = Array2::from_shape_fn((side * side, 3), |(k, axis)| {
            let [x, y] = [k % side, k / side].map(|x| x as f64 / n as f64);
            [x, y, 0.4 * (5.0 * x).sin() * (4.0 * y).cos()][axis]
        });
        let faces = Array2::from_shape_fn((2 * n * n, 3), |(face, corner)| {
            let a = (face / 2 % n + face / 2 / n * side) as u32;
            let side = side as u32;
            [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]][face % 2][corner]
        });
        Surface::new(points, faces).unwrap()
    }

    fn options() -> DiskMapOptions<'static> {
        DiskMapOptions { boundary: Boundary::Free, angle_weight: 1e-3, ..Default::default() }
    }

    #[test]
    fn many_maps_are_those_of_each_surface_alone_and_errors_stay_in_their_places() {
        let ring = Surface::new(
            array![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]],
            array![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
        );
        let closed = ring.unwrap();
        let surfaces: Vec<_> =
            [hills(3), closed, hills(45), hills(7)].into_iter().map(|surface| (surface, options())).collect();
        let maps = disk_maps(&surfaces, &mut Silent);
        for ((surface, options), map) in surfaces.iter().zip(maps) {
            match (disk_map(surface, options, &mut Silent), map.unwrap()) {
                (Ok(alone), Ok(map)) => assert_eq!(alone.uv, map.uv),
                (Err(alone), Err(error)) => assert_eq!(alone.to_string(), error.to_string()),
                _ => panic!("one has a map and the other has none"),
            }
        }
    }

    #[test]
    fn a_cancelled_run_leaves_out_what_was_not_begun() {
        let surfaces: Vec<_> = (0..5).map(|_| (hills(45), options())).collect();
        let mut heard = Vec::new();
        let mut observer = |_: f64, message: &str| {
            heard.push(message.to_owned());
            !message.starts_with("Island 3")
        };
        let maps = disk_maps(&surfaces, &mut observer);
        assert_eq!(maps.iter().filter(|map| map.is_some()).count(), 2);
        assert!(heard[0].starts_with("Island 1 of 5"), "{heard:?}");
    }
}
