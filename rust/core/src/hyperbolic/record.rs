// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registrations by curves as named arrays: without the metrics, which only tests look at, and without warnings,
//! which are words.

use ndarray::Array1;

use super::assembly::{CurveMap, CurveRegistration, RoughSphere};
use super::harmonic::certificates::Certificates;
use super::harmonic::newton::Descent;
use crate::error::Error;
use crate::record::{Recorded, Tree, misfit};
use crate::registration::Correspondence;

impl Recorded for CurveMap {
    fn record(&self) -> Tree {
        Tree::new()
            .with("correspondence", self.correspondence.record())
            .with("registered", self.registered.clone())
            .with("curve_error", self.curve_error.clone())
            .with("missed", self.missed.as_slice())
            .with("status", self.status.as_str())
            .with("distortion", self.distortion.record())
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        let correspondence: Correspondence = record.read("correspondence")?;
        let curve_error: Array1<f64> = record.reals("curve_error")?;
        Ok(Self {
            registered: record.reals("registered")?,
            missed: record.indices_below("missed", curve_error.len())?,
            correspondence,
            curve_error,
            status: record.status()?,
            distortion: record.read("distortion")?,
        })
    }
}

impl Recorded for RoughSphere {
    fn record(&self) -> Tree {
        Tree::new()
            .with("positions", self.positions.clone())
            .with("targets", Array1::from(self.targets.clone()))
            .with("distortion", self.distortion.record())
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        Ok(Self {
            positions: record.reals("positions")?,
            targets: record.reals("targets")?.to_vec(),
            distortion: record.read("distortion")?,
        })
    }
}

impl Recorded for Certificates {
    fn record(&self) -> Tree {
        Tree::new()
            .with("folded", self.folded.as_slice())
            .with("area", self.area)
            .with("expected_area", self.expected_area)
            .with("curve_error", self.curve_error)
            .with("bank_error", self.bank_error)
            .with("cocycle_error", self.cocycle_error)
            .with("outside", self.outside)
            .with("energy_ratio", self.energy_ratio)
            .with("curvature", Array1::from(self.curvature.to_vec()))
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        let curvature: Array1<f64> = record.reals("curvature")?;
        Ok(Self {
            folded: record.indices("folded")?,
            area: record.real("area")?,
            expected_area: record.real("expected_area")?,
            curve_error: record.real("curve_error")?,
            bank_error: record.real("bank_error")?,
            cocycle_error: record.real("cocycle_error")?,
            outside: record.count("outside")?,
            energy_ratio: record.real("energy_ratio")?,
            curvature: curvature.to_vec().try_into().map_err(|_| misfit("curvature", "of another length"))?,
        })
    }
}

impl Recorded for Descent {
    fn record(&self) -> Tree {
        Tree::new()
            .with("energies", Array1::from(self.energies.clone()))
            .with("gradient", self.gradient)
            .with("status", self.status.as_str())
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        Ok(Self {
            energies: record.reals("energies")?.to_vec(),
            gradient: record.real("gradient")?,
            status: record.status()?,
        })
    }
}

impl Recorded for CurveRegistration {
    fn record(&self) -> Tree {
        let [curves, target_curves] = [0, 1].map(|side| curves_record(&self.curves[side]));
        let [sphere, target_sphere] = [0, 1].map(|side| self.spheres[side].record());
        Tree::new()
            .with("map", self.map.record())
            .with("inverse", self.inverse.record())
            .with("source_curves", curves)
            .with("target_curves", target_curves)
            .with("source_sphere", sphere)
            .with("target_sphere", target_sphere)
            .with("certificates", self.certificates.record())
            .with("descents", self.descents.iter().map(Descent::record).collect::<Vec<_>>())
            .with("iterations", self.iterations)
            .with("seconds", self.seconds)
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        let descents = record.trees("descents")?.iter().map(Descent::of_record);
        let (map, inverse): (CurveMap, CurveMap) = (record.read("map")?, record.read("inverse")?);
        let [n, n_target] = [&map.correspondence, &inverse.correspondence].map(|side| side.positions().len());
        Ok(Self {
            curves: [curves_of(record, "source_curves", n)?, curves_of(record, "target_curves", n_target)?],
            map,
            inverse,
            spheres: [record.read("source_sphere")?, record.read("target_sphere")?],
            certificates: record.read("certificates")?,
            metrics: Vec::new(),
            descents: descents.collect::<Result<_, Error>>()?,
            warnings: Vec::new(),
            iterations: record.count("iterations")?,
            seconds: record.real("seconds")?,
        })
    }
}

fn curves_record(curves: &[Vec<usize>]) -> Vec<Tree> {
    curves.iter().map(|curve| Tree::new().with("vertices", curve.as_slice())).collect()
}

fn curves_of(record: &Tree, name: &str, n_vertices: usize) -> Result<Vec<Vec<usize>>, Error> {
    record.trees(name)?.iter().map(|curve| curve.indices_below("vertices", n_vertices)).collect()
}
