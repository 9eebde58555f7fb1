// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is wrong with a file or a mesh, in the words of the Python package.

use authalic::Error;
use wasm_bindgen::prelude::wasm_bindgen;

/// A problem, and whether *Repair first* mends it.
#[wasm_bindgen]
#[derive(Debug, Clone)]
pub struct Problem {
    message: String,
    kind: String,
    is_mendable: bool,
}

#[wasm_bindgen]
impl Problem {
    /// What is wrong, and where.
    #[wasm_bindgen(getter)]
    pub fn message(&self) -> String {
        self.message.clone()
    }

    /// The kind of the error, as the attribute `kind` of the Python package's exceptions; "file" for a file that cannot
    /// be read.
    #[wasm_bindgen(getter)]
    pub fn kind(&self) -> String {
        self.kind.clone()
    }

    /// Whether a repair mends the mesh.
    #[wasm_bindgen(getter, js_name = isMendable)]
    pub fn is_mendable(&self) -> bool {
        self.is_mendable
    }
}

impl Problem {
    /// A file that cannot be read.
    pub fn of_file(message: String) -> Self {
        Self { message, kind: "file".into(), is_mendable: false }
    }
}

impl From<Error> for Problem {
    fn from(error: Error) -> Self {
        let (kind, is_mendable) = (error.kind().as_str().into(), error.is_mended_by_repair());
        Self { message: error.to_string(), kind, is_mendable }
    }
}
