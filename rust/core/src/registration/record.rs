// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registrations by points, and what they consist of, as named arrays.

use std::sync::Arc;

use ndarray::Array1;

use super::correspondence::{Correspondence, Registered};
use super::result::{CarryingOptions, Registration};
use crate::arrays::{from_rows, from_vectors};
use crate::disk::DiskMap;
use crate::distortion::Distortion;
use crate::error::Error;
use crate::location::Location;
use crate::mesh::{Face, Surface, Vertex};
use crate::record::{Recorded, Tree, index_entry, misfit};
use crate::sphere::{SphereFilling, SphereMap};
use crate::vector::Vector3;

impl Recorded for Distortion {
    fn record(&self) -> Tree {
        Tree::new()
            .with("authalic_energy", self.authalic_energy)
            .with("area_ratio_mean", self.area_ratio_mean)
            .with("area_ratio_std", self.area_ratio_std)
            .with("log2_area_ratio", self.log2_area_ratio.clone())
            .with("folded", self.folded.as_slice())
            .with("angle_distortion", self.angle_distortion.clone())
            .with("angle_distortion_mean", self.angle_distortion_mean)
            .with("angle_distortion_p99", self.angle_distortion_p99)
            .with("angle_distortion_max", self.angle_distortion_max)
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        Ok(Self {
            authalic_energy: record.real("authalic_energy")?,
            area_ratio_mean: record.real("area_ratio_mean")?,
            area_ratio_std: record.real("area_ratio_std")?,
            log2_area_ratio: record.reals("log2_area_ratio")?,
            folded: record.indices("folded")?,
            angle_distortion: record.reals("angle_distortion")?,
            angle_distortion_mean: record.real("angle_distortion_mean")?,
            angle_distortion_p99: record.real("angle_distortion_p99")?,
            angle_distortion_max: record.real("angle_distortion_max")?,
        })
    }
}

impl Recorded for DiskMap {
    fn record(&self) -> Tree {
        Tree::new()
            .with("uv", self.uv.clone())
            .with("status", self.status.as_str())
            .with("history", self.history.record())
            .with("distortion", self.distortion.record())
            .with("seconds", self.seconds)
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        Ok(Self {
            uv: record.reals("uv")?,
            status: record.status()?,
            history: record.read("history")?,
            distortion: record.read("distortion")?,
            seconds: record.real("seconds")?,
        })
    }
}

/// Maps of registrations have no split faces.
impl Recorded for SphereMap {
    fn record(&self) -> Tree {
        let record = Tree::new()
            .with("positions", self.positions.clone())
            .with("status", self.status.as_str())
            .with("history", self.history.record())
            .with("distortion", self.distortion.record())
            .with("targets", Array1::from(self.targets.clone()))
            .with("seconds", self.seconds);
        match &self.filling {
            Some(filling) => record.with("filling", filling.record()),
            None => record,
        }
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        Ok(Self {
            positions: record.reals("positions")?,
            status: record.status()?,
            history: record.read("history")?,
            distortion: record.read("distortion")?,
            targets: record.reals("targets")?.to_vec(),
            refinement: None,
            filling: if record.has("filling") { Some(Box::new(record.read("filling")?)) } else { None },
            seconds: record.real("seconds")?,
        })
    }
}

impl Recorded for SphereFilling {
    fn record(&self) -> Tree {
        let faces = index_entry(self.faces.rows().into_iter().map(|face| [face[0], face[1], face[2]]));
        Tree::new()
            .with("positions", self.positions.clone())
            .with("faces", faces)
            .with("targets", Array1::from(self.targets.clone()))
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        Ok(Self {
            positions: record.reals("positions")?,
            faces: from_rows(record.index_rows::<3>("faces")?),
            targets: record.reals("targets")?.to_vec(),
        })
    }
}

impl Recorded for Surface {
    fn record(&self) -> Tree {
        let faces = index_entry(self.face_rows().iter().map(|face| face.map(|vertex| vertex.0)));
        Tree::new().with("vertices", self.vertices().to_owned()).with("faces", faces)
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        let vertices: ndarray::Array2<f64> = record.reals("vertices")?;
        Self::new(vertices, from_rows(record.index_rows::<3>("faces")?))
    }
}

impl Recorded for Registered {
    fn record(&self) -> Tree {
        Tree::new()
            .with("surface", self.surface.record())
            .with("faces", index_entry(self.faces.iter().map(|face| face.map(|vertex| vertex.0))))
            .with("in_domain", from_vectors(self.in_domain.clone()))
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        let surface: Surface = record.read("surface")?;
        let faces: Vec<_> = record.index_rows("faces")?.into_iter().map(|face| face.map(Vertex)).collect();
        let in_domain: Vec<_> = record.rows("in_domain")?.into_iter().map(Vector3).collect();
        let n_vertices = surface.n_vertices();
        if faces.len() != surface.n_faces() || in_domain.len() != n_vertices {
            return Err(misfit("faces", "of another surface"));
        }
        if faces.iter().flatten().any(|vertex| vertex.index() >= n_vertices) {
            return Err(misfit("faces", "out of range"));
        }
        Ok(Self { surface, faces, in_domain })
    }
}

impl Recorded for Correspondence {
    fn record(&self) -> Tree {
        let triangles: Vec<usize> = self.triangles().to_vec();
        Tree::new()
            .with("source", self.source.record())
            .with("target", self.target.record())
            .with("triangles", triangles.as_slice())
            .with("barycentric", self.barycentric())
            .with("positions", self.positions())
            .with("area_ratio", self.area_ratio())
            .with("in_holes", self.in_holes.as_slice())
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        let (source, target): (Registered, Registered) = (record.read("source")?, record.read("target")?);
        let (triangles, barycentric) = (record.indices("triangles")?, record.rows("barycentric")?);
        let positions: Vec<_> = record.rows("positions")?.into_iter().map(Vector3).collect();
        let n_vertices = source.in_domain.len();
        if [triangles.len(), barycentric.len(), positions.len()] != [n_vertices; 3] {
            return Err(misfit("triangles", "of another surface"));
        }
        if triangles.iter().any(|&face| face >= target.faces.len()) {
            return Err(misfit("triangles", "out of range"));
        }
        let location = |(triangle, barycentric)| Location { triangle: Face::new(triangle), barycentric };
        let area_ratio: Array1<f64> = record.reals("area_ratio")?;
        if area_ratio.len() != source.faces.len() {
            return Err(misfit("area_ratio", "of another length"));
        }
        Ok(Self {
            locations: triangles.into_iter().zip(barycentric).map(location).collect(),
            positions,
            area_ratio: area_ratio.to_vec(),
            in_holes: record.indices_below("in_holes", n_vertices)?,
            source: Arc::new(source),
            target: Arc::new(target),
        })
    }
}

impl<Map: Recorded> Recorded for Registration<Map> {
    fn record(&self) -> Tree {
        let [landmarks, target_landmarks] = &self.landmarks;
        let tree = Tree::new()
            .with("correspondence", self.correspondence.record())
            .with("registered", self.registered.clone())
            .with("target_registered", self.target_registered.clone())
            .with("source_map", self.source_map.record())
            .with("target_map", self.target_map.record())
            .with("source_landmarks", landmarks.as_slice())
            .with("target_landmarks", target_landmarks.as_slice())
            .with("landmark_error", self.landmark_error.clone())
            .with("missed", self.missed.as_slice())
            .with("off_boundary", self.off_boundary.as_slice())
            .with("status", self.status.as_str())
            .with("iterations", self.iterations)
            .with("distortion", self.distortion.record())
            .with("target_distortion", self.target_distortion.record())
            .with("seconds", self.seconds)
            .with("weight", self.carrying.weight)
            .with("angle_weight", self.carrying.angle_weight);
        let also = [("whole", &self.whole), ("original", &self.original)];
        also.into_iter().fold(tree, |tree, (name, registration)| match registration {
            Some(registration) => tree.with(name, registration.record()),
            None => tree,
        })
    }

    fn of_record(record: &Tree) -> Result<Self, Error> {
        let optional = |name: &str| {
            let read = |name: &str| record.read(name).map(Arc::new);
            record.has(name).then(|| read(name)).transpose()
        };
        let correspondence: Correspondence = record.read("correspondence")?;
        let [n, n_target] =
            [&correspondence.source, &correspondence.target].map(|surface| surface.in_domain.len());
        let landmark_error: Array1<f64> = record.reals("landmark_error")?;
        let landmarks = [
            record.indices_below("source_landmarks", n)?,
            record.indices_below("target_landmarks", n_target)?,
        ];
        if landmarks.iter().any(|side| side.len() != landmark_error.len()) {
            return Err(misfit("landmark_error", "of another length"));
        }
        Ok(Self {
            registered: record.table("registered", n)?,
            target_registered: record.table("target_registered", n_target)?,
            source_map: record.read("source_map")?,
            target_map: record.read("target_map")?,
            missed: record.indices_below("missed", landmark_error.len())?,
            off_boundary: record.indices_below("off_boundary", n)?,
            correspondence,
            landmarks,
            landmark_error,
            status: record.status()?,
            iterations: record.count("iterations")?,
            distortion: record.read("distortion")?,
            target_distortion: record.read("target_distortion")?,
            seconds: record.real("seconds")?,
            carrying: CarryingOptions {
                weight: record.real("weight")?,
                angle_weight: record.real("angle_weight")?,
            },
            whole: optional("whole")?,
            original: optional("original")?,
        })
    }
}
