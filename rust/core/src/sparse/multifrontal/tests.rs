// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::control::Silent;
use crate::mesh::faces_of_indices;

/// A grid of n × n vertices, its squares cut into two faces.
pub(super) fn grid(n: usize) -> (usize, Vec<[u32; 3]>) {
    let vertex = |x: usize, y: usize| (y * n + x) as u32;
    let square = |x: usize, y: usize| {
        let [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    let faces = (0..(n.max(1) - 1) * (n.max(1) - 1)).flat_map(|k| square(k % (n - 1), k / (n - 1))).collect();
    (n * n, faces)
}

/// A number in (−1, 1) that depends on its arguments like a random one.
fn noise(a: usize, b: usize) -> f64 {
    let mut x = (a as u64) << 32 ^ (b as u64) ^ 0x9E37_79B9_7F4A_7C15;
    for _ in 0..3 {
        x ^= x >> 31;
        x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    }
    (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A positive definite matrix for each face: a square and a little of the identity.
fn element(face: usize) -> [[f64; 6]; 6] {
    let root: [[f64; 6]; 6] =
        std::array::from_fn(|i| std::array::from_fn(|j| noise(36 * face + 6 * i + j, 1)));
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            (0..6).map(|k| root[k][i] * root[k][j]).sum::<f64>() + if i == j { 0.3 } else { 0.0 }
        })
    })
}

fn analyzed(n: usize, faces: &[[u32; 3]], dofs: &[u8], order: Order) -> Analysis {
    Analysis::new(n, &faces_of_indices(faces), dofs, order).unwrap()
}

/// 0, 1 or 2 unknowns at each vertex.
fn mixed_dofs(n: usize) -> Vec<u8> {
    (0..n).map(|vertex| (noise(vertex, 7) * 1.5 + 1.5) as u8).collect()
}

/// A x of the assembled matrix.
fn multiply(analysis: &Analysis, faces: &[[u32; 3]], dofs: &[u8], x: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    for (face, corners) in faces.iter().enumerate() {
        let matrix = element(face);
        let places = |a: usize| {
            let vertex = corners[a] as usize;
            (0..usize::from(dofs[vertex])).map(move |i| (analysis.first_unknown(vertex) + i, 2 * a + i))
        };
        for (row, i) in (0..3).flat_map(places) {
            for (column, j) in (0..3).flat_map(places) {
                out[row] += matrix[i][j] * x[column];
            }
        }
    }
    out
}

fn factored<T: Scalar>(analysis: &Analysis) -> Factor<T> {
    let (mut silent, mut factor) = (Silent, Factor::new(analysis));
    factor.refactor(analysis, &element, &Watch::new(&mut silent, 0.0, "")).unwrap();
    factor
}

/// The largest |A x − b| for two right-hand sides.
fn residual<T: Scalar>(n: usize, faces: &[[u32; 3]], dofs: &[u8]) -> f64 {
    let residuals = [Order::Sparse, Order::AsGiven].map(|order| residual_in::<T>(order, n, faces, dofs));
    residuals[0].max(residuals[1])
}

fn residual_in<T: Scalar>(order: Order, n: usize, faces: &[[u32; 3]], dofs: &[u8]) -> f64 {
    let analysis = analyzed(n, faces, dofs, order);
    let factor = factored::<T>(&analysis);
    let b: [Vec<f64>; 2] = [1, 2].map(|k| (0..analysis.n_unknowns()).map(|i| noise(i, k)).collect());
    let mut x = b.concat();
    factor.solve(&analysis, &mut x);
    let mut worst: f64 = 0.0;
    for (x, b) in x.chunks(analysis.n_unknowns().max(1)).zip(&b) {
        let product = multiply(&analysis, faces, dofs, x);
        worst = product.iter().zip(b).map(|(p, b)| (p - b).abs()).fold(worst, f64::max);
    }
    worst
}

#[test]
fn solves_grids_with_none_one_and_two_unknowns_at_a_vertex() {
    for size in [2, 3, 5, 10, 40, 120] {
        let (n, faces) = grid(size);
        for dofs in [vec![2; n], vec![1; n], mixed_dofs(n)] {
            let (double, single) = (residual::<f64>(n, &faces, &dofs), residual::<f32>(n, &faces, &dofs));
            assert!(double < 1e-11 && single < 1e-2, "{size}: {double:e} {single:e}");
        }
    }
}

/// Runs `work` on a pool of so many threads.
fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

/// The bits of the factor and of one solution.
fn bits<T: Scalar>(analysis: &Analysis, threads: usize) -> (Vec<u64>, Vec<u64>) {
    on_threads(threads, || {
        let factor = factored::<T>(analysis);
        let mut x: Vec<f64> = (0..analysis.n_unknowns()).map(|i| noise(i, 3)).collect();
        factor.solve(analysis, &mut x);
        let bits = |value: f64| value.to_bits();
        (factor.values.iter().map(|value| bits(value.to_f64())).collect(), x.into_iter().map(bits).collect())
    })
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let (n, faces) = grid(150);
    let analysis = analyzed(n, &faces, &mixed_dofs(n), Order::Sparse);
    let (double, single) = (bits::<f64>(&analysis, 1), bits::<f32>(&analysis, 1));
    for threads in [2, 2, 2, 7, 7] {
        assert!(bits::<f64>(&analysis, threads) == double);
        assert!(bits::<f32>(&analysis, threads) == single);
    }
}

#[test]
fn solves_closed_meshes_fans_and_parts_that_do_not_touch() {
    let octahedron = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let fan: Vec<[u32; 3]> = (1..1500).map(|k| [0, k, k + 1]).collect();
    let apart = [[0, 1, 2], [3, 4, 5]];
    let strip: Vec<[u32; 3]> = (0..20_000).map(|k| [k, k + 1, k + 2]).collect();
    for (n, faces) in [(6, &octahedron[..]), (1501, &fan), (6, &apart), (20_002, &strip)] {
        for dofs in [vec![2; n], mixed_dofs(n), vec![1; n]] {
            assert!(residual::<f64>(n, faces, &dofs) < 1e-10);
        }
    }
}

#[test]
fn tiny_systems_and_none_at_all_are_solved() {
    let face = [[0, 1, 2]];
    for dofs in [[0, 0, 0], [0, 1, 0], [2, 0, 0], [1, 2, 0], [2, 2, 2]] {
        assert!(residual::<f64>(3, &face, &dofs) < 1e-12, "{dofs:?}");
    }
    assert_eq!(residual::<f64>(0, &[], &[]), 0.0);
    let analysis = analyzed(3, &face, &[1, 0, 2], Order::Sparse);
    assert_eq!(analysis.n_unknowns(), 3);
    assert_eq!([0usize, 1, 2].map(|vertex| analysis.first_unknown(vertex)), [0, 1, 1]);
}

#[test]
fn indefinite_singular_and_broken_matrices_are_refused() {
    for size in [2, 60] {
        let (n, faces) = grid(size);
        let analysis = analyzed(n, &faces, &vec![2; n], Order::Sparse);
        // the only face of one corner of the grid
        let lonely = 2 * (size - 2);
        for wrong in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
            let matrix = |face: usize| {
                if face == lonely {
                    element(face).map(|row| row.map(|value| value * wrong))
                } else {
                    element(face).map(|row| row.map(|value| value * 1e-3))
                }
            };
            let (mut silent, mut factor) = (Silent, Factor::<f64>::new(&analysis));
            let outcome = factor.refactor(&analysis, &matrix, &Watch::new(&mut silent, 0.0, ""));
            assert_eq!(outcome, Err(Failure::NotPositiveDefinite), "{size} {wrong}");
        }
    }
}

#[test]
fn the_stacks_of_updates_are_as_long_as_foreseen() {
    for size in [3, 12, 30] {
        let (n, faces) = grid(size);
        let fronts = analyzed(n, &faces, &vec![2; n], Order::Sparse).symbolic.fronts;
        // each front in turn: its update is put on one stack, and those of its children are taken off the other
        let (mut stacks, mut most) = ([Vec::<usize>::new(), Vec::new()], [0, 0]);
        for front in 0..fronts.len() {
            let own = usize::from(fronts.front(front).is_odd);
            stacks[own].push(fronts.front(front).rows().pow(2));
            most[own] = most[own].max(stacks[own].iter().sum());
            for child in fronts.children(front) {
                assert_eq!(stacks[1 - own].pop(), Some(fronts.front(child).rows().pow(2)), "{size}");
            }
        }
        assert_eq!(fronts.updates_len(), most[0] + most[1]);
        assert!(fronts.updates_len() > 0);
    }
}

#[test]
fn a_factorization_can_be_cancelled_and_done_again() {
    let (n, faces) = grid(400);
    let analysis = analyzed(n, &faces, &vec![2; n], Order::Sparse);
    let mut factor = Factor::<f64>::new(&analysis);
    let mut reports = 0;
    let mut cancel = |_: f64, _: &str| {
        reports += 1;
        false
    };
    let outcome = factor.refactor(&analysis, &element, &Watch::new(&mut cancel, 0.0, ""));
    // a fast machine may be done before the first report
    assert_eq!(outcome, if reports == 0 { Ok(()) } else { Err(Failure::Cancelled) });
    assert!(reports <= 1);
    let mut silent = Silent;
    factor.refactor(&analysis, &element, &Watch::new(&mut silent, 0.0, "")).unwrap();
    assert!(factor.values == factored::<f64>(&analysis).values);
}

#[test]
#[ignore = "prints times: AUTHALIC_MESH=mesh.obj cargo test --release multifrontal -- --ignored --nocapture"]
fn times() {
    let Ok(path) = std::env::var("AUTHALIC_MESH") else { return };
    let (n, faces) = read_obj(&path);
    for dofs in [1_u8, 2] {
        let began = std::time::Instant::now();
        let analysis = analyzed(n, &faces, &vec![dofs; n], Order::Sparse);
        let fronts = &analysis.symbolic.fronts;
        let largest = (0..fronts.len()).map(|f| fronts.front(f).height()).max().unwrap();
        println!(
            "{dofs} unknowns at {n} vertices: analysis {:.0} ms, {:.2} M numbers, {:.2} G multiplications, {} fronts, {largest} rows",
            began.elapsed().as_secs_f64() * 1e3,
            fronts.factor_len() as f64 / 1e6,
            fronts.work(&(0..fronts.len())) / 1e9,
            fronts.len(),
        );
        times_of_entries(&analysis, &faces, dofs.into());
        for threads in [1, 2] {
            on_threads(threads, || times_of::<f64>("f64", threads, &analysis));
            on_threads(threads, || times_of::<f32>("f32", threads, &analysis));
        }
    }
}

/// Milliseconds of all threads of this process on a processor, as far as the system tells.
fn processor_milliseconds() -> f64 {
    let Ok(tasks) = std::fs::read_dir("/proc/self/task") else { return 0.0 };
    let of_task = |path: std::path::PathBuf| -> Option<f64> {
        let text = std::fs::read_to_string(path.join("schedstat")).ok()?;
        text.split(' ').next()?.parse().ok()
    };
    tasks.flatten().filter_map(|task| of_task(task.path())).sum::<f64>() / 1e6
}

/// The median of five runs: milliseconds by the clock, and of all threads together.
fn milliseconds(mut work: impl FnMut()) -> String {
    let mut all: Vec<[f64; 2]> = (0..5)
        .map(|_| {
            let (began, processor) = (std::time::Instant::now(), processor_milliseconds());
            work();
            [began.elapsed().as_secs_f64() * 1e3, processor_milliseconds() - processor]
        })
        .collect();
    let mut median = |k: usize| {
        all.sort_by(|a, b| a[k].total_cmp(&b[k]));
        all[2][k]
    };
    format!("{:.1} ({:.1})", median(0), median(1))
}

/// The matrix that [`simple_element`] assembles, all vertices with as many unknowns.
fn assembled(n: usize, faces: &[[u32; 3]], dofs: usize) -> sprs::CsMat<f64> {
    let matrix = simple_element();
    let mut triplets = sprs::TriMat::new((n, n));
    for face in faces {
        let places = || (0..3).flat_map(|a| (0..dofs).map(move |i| (dofs * face[a] as usize + i, 2 * a + i)));
        for (row, i) in places() {
            places()
                .filter(|&(column, _)| row <= column)
                .for_each(|(column, j)| triplets.add_triplet(row, column, matrix[i][j]));
        }
    }
    triplets.to_csc()
}

fn times_of_entries(analysis: &Analysis, faces: &[[u32; 3]], dofs: usize) {
    let n = analysis.n_unknowns();
    let matrix = assembled(n, faces, dofs);
    let mut factor = super::super::Cholesky::analyze(&matrix).unwrap();
    let refactor = milliseconds(|| factor.refactor(&matrix).unwrap());
    let mut rhs = vec![1.0; 2 * n];
    let two = milliseconds(|| factor.solve(&mut rhs));
    let one = milliseconds(|| factor.solve(&mut rhs[..n]));
    println!("    entry by entry: factor {refactor}, two solves {two}, one solve {one} ms");
}

fn simple_element() -> [[f64; 6]; 6] {
    std::array::from_fn(|i| {
        std::array::from_fn(
            |j| if i == j { 4.0 + 0.01 * i as f64 } else { -0.5 + 0.1 * ((i + j) % 3) as f64 },
        )
    })
}

fn times_of<T: Scalar>(name: &str, threads: usize, analysis: &Analysis) {
    let simple = simple_element();
    let (mut silent, mut factor) = (Silent, Factor::<T>::new(analysis));
    let refactor = milliseconds(|| {
        factor.refactor(analysis, &|_| simple, &Watch::new(&mut silent, 0.0, "")).unwrap();
    });
    let mut rhs = vec![1.0; 2 * analysis.n_unknowns()];
    let two = milliseconds(|| factor.solve(analysis, &mut rhs));
    rhs.truncate(analysis.n_unknowns());
    let one = milliseconds(|| factor.solve(analysis, &mut rhs));
    println!("    {name}, {threads} threads: factor {refactor}, two solves {two}, one solve {one} ms");
}

/// (number of vertices, faces) of a file with triangles.
fn read_obj(path: &str) -> (usize, Vec<[u32; 3]>) {
    let text = std::fs::read_to_string(path).unwrap();
    let n = text.lines().filter(|line| line.starts_with("v ")).count();
    let face = |line: &str| {
        let mut corners = line[2..]
            .split_whitespace()
            .map(|word| word.split('/').next().unwrap().parse::<u32>().unwrap() - 1);
        std::array::from_fn(|_| corners.next().unwrap())
    };
    (n, text.lines().filter(|line| line.starts_with("f ")).map(face).collect())
}
