// SPDX-License-Identifier: MIT OR Apache-2.0
//! Prints the bits of results, for a comparison of platforms: a line each, a name and numbers as hexadecimal digits.
//!
//! The surfaces are made by sums, products, quotients and square roots alone, which are the same numbers everywhere.
//! The elementary functions come first: each platform has its own, which may differ in the last bit.

use authalic::{
    DiskMapOptions, Error, HyperbolicOptions, LandmarkCurves, Landmarks, LayoutOptions, RegistrationOptions,
    Silent, SphereMapOptions, Surface, UnwrapOptions, disk_map, register_disks, register_hyperbolic,
    register_spheres, sphere_map, unwrap,
};
use ndarray::{Array2, ArrayView2};
use std::collections::BTreeMap;

type Point = [f64; 3];

fn main() -> Result<(), Error> {
    functions();
    disks()?;
    spheres()?;
    registrations()
}

/// The elementary functions at 2000 places each.
fn functions() {
    let places: Vec<f64> = (0..2000).map(|i| 0.001 + f64::from(i) / 1999.0 * 0.998).collect();
    let show = |name: &str, function: fn(f64) -> f64| {
        print(&format!("function {name}"), places.iter().map(|&x| function(x)));
    };
    show("sqrt", f64::sqrt);
    show("sin", |x| (7.0 * x).sin());
    show("cos", |x| (7.0 * x).cos());
    show("tan", f64::tan);
    show("asin", f64::asin);
    show("acos", f64::acos);
    show("atan2", |x| x.atan2(0.7 - x));
    show("exp", |x| (30.0 * x - 15.0).exp());
    show("exp2", |x| (30.0 * x - 15.0).exp2());
    show("exp_m1", f64::exp_m1);
    show("ln", f64::ln);
    show("ln_1p", f64::ln_1p);
    show("log2", f64::log2);
    show("powf", |x| x.powf(0.4));
    show("powi", |x| x.powi(5));
    show("cbrt", f64::cbrt);
    show("hypot", |x| x.hypot(1.0 - x));
    show("sinh", f64::sinh);
    show("cosh", f64::cosh);
    show("tanh", f64::tanh);
    show("asinh", f64::asinh);
    show("acosh", |x| (1.0 + x).acosh());
    show("atanh", f64::atanh);
}

fn disks() -> Result<(), Error> {
    for (name, cells) in [("small disk", 12), ("disk", 90)] {
        let map = disk_map(&hill(cells, 0.8)?, &DiskMapOptions::default(), &mut Silent)?;
        rows(name, map.uv.view());
    }
    Ok(())
}

fn spheres() -> Result<(), Error> {
    let surface = ball(4, 0.4)?;
    let map = sphere_map(&surface, &SphereMapOptions::default(), &mut Silent)?;
    rows("sphere", map.positions.view());
    rows("layout", map.layout(&surface, &LayoutOptions::default(), &mut Silent)?.points.view());
    let unwrapped = unwrap(&ball(3, 0.4)?, &UnwrapOptions::default(), &mut Silent)?;
    print("seams", unwrapped.edges.iter().map(|&end| f64::from(end)));
    rows("unwrap", unwrapped.uv.view());
    Ok(())
}

fn registrations() -> Result<(), Error> {
    let options = RegistrationOptions::default();
    let inside = [2 * 13 + 3, 2 * 13 + 9, 6 * 13 + 6, 10 * 13 + 3, 10 * 13 + 9];
    let landmarks = Landmarks { source: &inside, target: &inside };
    let found = register_disks(&hill(12, 0.8)?, &hill(12, -0.3)?, &landmarks, &options, &mut Silent)?;
    rows("registration of disks", found.correspondence.positions().view());
    let landmarks = Landmarks { source: &[0, 1, 2, 4], target: &[0, 1, 2, 4] };
    let found = register_spheres(&ball(3, 0.4)?, &ball(3, -0.3)?, &landmarks, &options, &mut Silent)?;
    rows("registration of spheres", found.correspondence.positions().view());
    let curves = [vec![76, 100, 124, 148], vec![88, 112, 136, 160, 184]];
    let curves = LandmarkCurves { source: &curves, target: &curves };
    let options = HyperbolicOptions::default();
    let found = register_hyperbolic(&band(0.2)?, &band(-0.1)?, &curves, &options, &mut Silent)?;
    rows("registration by curves", found.map.correspondence.positions().view());
    Ok(())
}

/// A square of `cells` by `cells` squares with a hill of some height beside its middle.
fn hill(cells: u32, height: f64) -> Result<Surface, Error> {
    let at = |i: u32| 2.0 * f64::from(i) / f64::from(cells) - 1.0;
    let side = cells + 1;
    let point = |v: u32| {
        let (x, y) = (at(v % side), at(v / side));
        [x, y + 0.1 * x * x, height / (1.0 + 4.0 * (x - 0.2) * (x - 0.2) + 9.0 * y * y)]
    };
    let corners = (0..cells * cells).map(|cell| cell / cells * side + cell % cells);
    let faces = corners.flat_map(|a| [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]).collect();
    surface((0..side * side).map(point).collect(), faces)
}

/// An octahedron whose faces have been divided `level` times, blown up to a ball with bumps.
fn ball(level: u32, bumps: f64) -> Result<Surface, Error> {
    let mut points: Vec<Point> =
        vec![[1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
    let mut faces: Vec<[u32; 3]> = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]).collect();
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let (p, q) = (points[a as usize], points[b as usize]);
                points.push([0, 1, 2].map(|axis| 0.5 * (p[axis] + q[axis])));
                points.len() as u32 - 1
            })
        };
        faces = faces
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [x, y, z] = [middle(b, c), middle(c, a), middle(a, b)];
                [[a, z, y], [z, b, x], [y, x, c], [x, y, z]]
            })
            .collect();
    }
    let round = points.into_iter().map(|p| {
        let [x, y, z] = p.map(|coordinate| coordinate / (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt());
        let radius = 1.0 + bumps * (x * y + 0.5 * z * z * z);
        [radius * x, 1.2 * radius * y, 1.5 * radius * z]
    });
    surface(round.collect(), faces)
}

/// A ball without its poles, wider on one side: 13 rings of 24 vertices.
fn band(bump: f64) -> Result<Surface, Error> {
    let point = |v: u32| {
        let (height, turn) = (-0.9 + 0.15 * f64::from(v / 24), f64::from(v % 24) / 6.0);
        // a quarter of the circle by a rational parameter, then turned by right angles
        let t = turn.fract();
        let (x, y) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        let [x, y] = [[x, y], [-y, x], [-x, -y], [y, -x]][turn as usize];
        let radius = (1.0 - height * height).sqrt() * (1.0 + bump * x);
        [radius * x, radius * y, height]
    };
    let ring = |a: u32| a / 24 * 24 + (a + 1) % 24;
    let faces = (0..12 * 24).flat_map(|a| [[a, ring(a), ring(a) + 24], [a, ring(a) + 24, a + 24]]).collect();
    surface((0..13 * 24).map(point).collect(), faces)
}

fn surface(points: Vec<Point>, faces: Vec<[u32; 3]>) -> Result<Surface, Error> {
    let vertices = Array2::from_shape_fn((points.len(), 3), |(v, axis)| points[v][axis]);
    Surface::new(vertices, Array2::from_shape_fn((faces.len(), 3), |(face, corner)| faces[face][corner]))
}

fn rows(name: &str, numbers: ArrayView2<f64>) {
    print(name, numbers.iter().copied());
}

fn print(name: &str, numbers: impl Iterator<Item = f64>) {
    let digits: Vec<String> = numbers.map(|x| format!("{:016x}", x.to_bits())).collect();
    println!("{name}: {}", digits.join(" "));
}
