//! raw: n m then f64 (n,3), u32 (m,3)
use authalic::{SeamMethod, SeamOptions, Silent, Surface, Symmetry, seams};
use ndarray::Array2;
fn main() {
    let mut args = std::env::args().skip(1);
    let target: f64 = args.next().unwrap().parse().unwrap();
    let mode = args.next().unwrap();
    for path in args {
        let bytes = std::fs::read(&path).unwrap();
        let n = u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
        let m = u64::from_le_bytes(bytes[8..16].try_into().unwrap()) as usize;
        let v: Vec<f64> =
            bytes[16..16 + 24 * n].chunks(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect();
        let f: Vec<u32> = bytes[16 + 24 * n..16 + 24 * n + 12 * m]
            .chunks(4)
            .map(|c| u32::from_le_bytes(c.try_into().unwrap()))
            .collect();
        let t = std::time::Instant::now();
        let surface = Surface::new(
            Array2::from_shape_vec((n, 3), v).unwrap(),
            Array2::from_shape_vec((m, 3), f).unwrap(),
        )
        .unwrap();
        let options = SeamOptions {
            target,
            method: if mode.contains('c') { SeamMethod::Cones } else { SeamMethod::Search },
            symmetry: if mode.contains('n') { Symmetry::Off } else { Symmetry::Auto },
            ..Default::default()
        };
        match seams(&surface, &options, &mut Silent) {
            Ok(s) => {
                println!(
                    "{} V {n} L {:.3} islands {} predicted {:.3} edges {} {:.2} s",
                    path.rsplit('/').next().unwrap(),
                    s.length,
                    s.islands,
                    s.predicted,
                    s.edges.nrows(),
                    t.elapsed().as_secs_f64()
                );
                if let Ok(out) = std::env::var("SEAMS_OUT") {
                    let b: Vec<u8> = s.edges.iter().flat_map(|x| x.to_le_bytes()).collect();
                    std::fs::write(format!("{out}/{}.edges", path.rsplit('/').next().unwrap()), b).unwrap();
                }
            }
            Err(e) => println!("{path}: {e}"),
        }
    }
}
