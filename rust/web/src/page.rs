// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the page's worker sees of all this. Arrays are flat and row-major.

use wasm_bindgen::prelude::wasm_bindgen;

use crate::figures::Figures;
use crate::obj::ObjFile;
use crate::problem::Problem;
use crate::unwrapping::{Mesh, Preset, Unwrapped, Wishes};

#[wasm_bindgen]
extern "C" {
    /// Functions that the worker defines for all of its scope.
    #[wasm_bindgen(js_name = reportProgress)]
    fn report_progress(fraction: f64, message: &str);
    #[wasm_bindgen(js_name = reportPanic)]
    fn report_panic(message: &str);
}

/// A mesh that the page shows.
#[wasm_bindgen]
pub struct PageMesh {
    mesh: Mesh,
    given: Option<Figures>,
    repairs: String,
}

/// UVs that the page shows.
#[wasm_bindgen]
pub struct PageUv {
    unwrapped: Unwrapped,
    file: String,
}

/// Lets the worker hear of panics; called once.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| report_panic(&panic.to_string())));
}

#[wasm_bindgen]
impl PageMesh {
    /// The mesh of the text of an OBJ file, if wanted repaired.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, repair: bool) -> Result<PageMesh, Problem> {
        let file = ObjFile::read(text)?;
        if repair {
            let (mesh, repairs) = Mesh::repaired(&file)?;
            return Ok(Self { mesh, given: None, repairs });
        }
        let mesh = Mesh::of_file(file)?;
        let given = mesh.given().map(|measured| measured.figures);
        Ok(Self { mesh, given, repairs: String::new() })
    }

    /// The vertices, (n, 3).
    pub fn vertices(&self) -> Vec<f32> {
        self.mesh.surface.vertices().iter().map(|&x| x as f32).collect()
    }

    /// The triangles, (m, 3).
    pub fn triangles(&self) -> Vec<u32> {
        self.mesh.surface.faces().into_iter().collect()
    }

    /// The figures of the UVs that the file has.
    pub fn given(&self) -> Option<Figures> {
        self.given
    }

    /// What a repair did, a line for each kind; empty where none was wanted.
    pub fn repairs(&self) -> String {
        self.repairs.clone()
    }

    /// UVs. `preset` is "even", "balanced" or "soft".
    pub fn unwrap(&self, keep_seams: bool, target: f64, preset: &str) -> Result<PageUv, Problem> {
        let preset = match preset {
            "balanced" => Preset::Balanced,
            "soft" => Preset::Soft,
            _ => Preset::Even,
        };
        let mut observer = |fraction: f64, message: &str| {
            report_progress(fraction, message);
            true
        };
        let unwrapped = self.mesh.unwrapped(&Wishes { keep_seams, target, preset }, &mut observer)?;
        let file = self.mesh.written(&unwrapped.layout);
        Ok(PageUv { unwrapped, file })
    }
}

#[wasm_bindgen]
impl PageUv {
    /// The points in the unit square, (k, 2).
    pub fn points(&self) -> Vec<f32> {
        self.unwrapped.layout.uv.iter().flatten().map(|&x| x as f32).collect()
    }

    /// The point at each corner of the triangles, (m, 3).
    pub fn corners(&self) -> Vec<u32> {
        self.unwrapped.layout.faces.iter().flatten().copied().collect()
    }

    /// The island of each triangle, (m,).
    pub fn islands(&self) -> Vec<u32> {
        self.unwrapped.layout.island_of.clone()
    }

    /// The ends of the seams, (s, 2).
    pub fn seams(&self) -> Vec<u32> {
        self.unwrapped.seams.iter().flatten().copied().collect()
    }

    /// log₂ of the area ratio of each triangle, (m,).
    #[wasm_bindgen(js_name = areaRatios)]
    pub fn area_ratios(&self) -> Vec<f32> {
        self.unwrapped.measured.log2_area_ratio.clone()
    }

    /// σ₁/σ₂ of each triangle, (m,).
    pub fn shears(&self) -> Vec<f32> {
        self.unwrapped.measured.shear.clone()
    }

    /// The figures.
    pub fn figures(&self) -> Figures {
        self.unwrapped.measured.figures
    }

    /// The length of the seams over the square root of the area.
    #[wasm_bindgen(js_name = seamLength)]
    pub fn seam_length(&self) -> f64 {
        self.unwrapped.seam_length
    }

    /// The share of the unit square that the islands cover.
    pub fn packed(&self) -> f64 {
        self.unwrapped.packed
    }

    /// The OBJ file with these UVs.
    pub fn file(&self) -> String {
        self.file.clone()
    }
}
