// SPDX-License-Identifier: MIT OR Apache-2.0
//! A mesh out of a file, and its UVs by the options of the page.

use authalic::{
    Observer, RepairOptions, SeamOptions, Surface, UnwrapOptions, UnwrapSeams, Vertex, repair, unwrap,
};
use ndarray::{Array2, aview2};

use crate::figures::{Measured, measured, rows};
use crate::given::GivenUv;
use crate::obj::{ObjFile, plain};
use crate::problem::Problem;
use crate::soft::{Layout, soft_layout};

/// The part of the progress that finding seams takes where the islands are mapped again.
const SEAMS: f64 = 0.6;

/// A mesh to unwrap.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// The surface of the triangles.
    pub surface: Surface,
    /// Edges that divide polygons into triangles, (d, 2).
    diagonals: Array2<u32>,
    /// The file; none where a repair has changed its mesh.
    file: Option<ObjFile>,
}

/// The trade-off between areas and shapes, by the names of the extension's presets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preset {
    /// Areas to a few thousandths.
    #[default]
    Even,
    /// Better shapes, areas nearly as even.
    Balanced,
    /// Shapes before areas.
    Soft,
}

/// What the page asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wishes {
    /// Whether the seams are those of the UVs that the file has.
    pub keep_seams: bool,
    /// The wanted mean of σ₁/σ₂, where seams are found.
    pub target: f64,
    /// The trade-off between areas and shapes.
    pub preset: Preset,
}

/// The UVs of a mesh.
#[derive(Debug, Clone)]
pub struct Unwrapped {
    /// Points and faces.
    pub layout: Layout,
    /// The seams, (s, 2).
    pub seams: Vec<[u32; 2]>,
    /// The length of the seams over the square root of the area.
    pub seam_length: f64,
    /// The figures.
    pub measured: Measured,
    /// The share of the unit square that the islands cover.
    pub packed: f64,
}

impl Preset {
    /// The weight of angles; none where the maps are those by which seams are found.
    fn angle_weight(self) -> Option<f64> {
        match self {
            Self::Even => None,
            Self::Balanced => Some(0.03),
            Self::Soft => Some(0.3),
        }
    }
}

impl Mesh {
    /// The mesh of a file.
    ///
    /// # Errors
    /// A file without faces, coordinates that are not finite, indices out of range, faces that repeat a vertex.
    pub fn of_file(file: ObjFile) -> Result<Self, Problem> {
        let surface = surface_of(&file)?;
        let diagonals = aview2(&file.diagonals()).to_owned();
        Ok(Self { surface, diagonals, file: Some(file) })
    }

    /// The mesh of a file, repaired: it has no polygons and no UVs. Says what was done.
    ///
    /// # Errors
    /// A file without faces, indices out of range, a mesh of which a repair leaves nothing.
    pub fn repaired(file: &ObjFile) -> Result<(Self, String), Problem> {
        let triangles = file.triangles();
        let options = RepairOptions::default();
        let repaired = repair(aview2(&file.vertices), aview2(&triangles), &options)?;
        let report = repaired.report();
        Ok((Self { surface: repaired.surface, diagonals: Array2::zeros((0, 2)), file: None }, report))
    }

    /// The UVs that the file has.
    pub fn given(&self) -> Option<Measured> {
        self.with_given(|given| given.measured().ok()).flatten()
    }

    /// UVs by the wishes of the page.
    ///
    /// # Errors
    /// As `unwrap`.
    pub fn unwrapped(&self, wishes: &Wishes, observer: &mut dyn Observer) -> Result<Unwrapped, Problem> {
        let weight = wishes.preset.angle_weight();
        let share = if weight.is_some() { SEAMS } else { 1.0 };
        // 1. Seams, and even maps
        let kept = if wishes.keep_seams { self.with_given(|given| given.seam_array()) } else { None };
        let options = UnwrapOptions { seams: self.seams(kept.as_ref(), wishes.target), ..Default::default() };
        let mut first = |fraction: f64, message: &str| observer.progress(share * fraction, message);
        let found = unwrap(&self.surface, &options, &mut first)?;
        // 2. Softer maps of the same islands
        let layout = match weight {
            None => Layout {
                uv: rows(&found.uv),
                vertex_of: found.vertex_of,
                faces: rows(&found.faces),
                islands: found.islands,
                island_of: found.island_of,
            },
            Some(weight) => {
                let mut second = |fraction: f64, message: &str| {
                    observer.progress(share + (1.0 - share) * fraction, message)
                };
                soft_layout(&self.surface, &found.edges, weight, &mut second)?
            }
        };
        // 3. Figures
        let places = self.places(&layout.vertex_of);
        let measured = measured(&layout.uv, &places, &layout.faces, layout.islands)?;
        let packed = covered(&layout);
        Ok(Unwrapped { layout, seams: rows(&found.edges), seam_length: found.length, measured, packed })
    }

    /// The file with new UVs.
    pub fn written(&self, layout: &Layout) -> String {
        match &self.file {
            Some(file) => file.with_uv(&layout.uv, &layout.faces),
            None => {
                let vertices = rows(&self.surface.vertices().to_owned());
                plain(&vertices, &rows(&self.surface.faces()), &layout.uv, &layout.faces)
            }
        }
    }

    fn seams<'a>(&'a self, kept: Option<&'a Array2<u32>>, target: f64) -> UnwrapSeams<'a> {
        match kept {
            Some(edges) => UnwrapSeams::Given(edges.view()),
            None => {
                let diagonals = (!self.diagonals.is_empty()).then(|| self.diagonals.view());
                UnwrapSeams::Automatic(SeamOptions { target, diagonals, ..Default::default() })
            }
        }
    }

    fn with_given<R>(&self, use_it: impl FnOnce(GivenUv<'_>) -> R) -> Option<R> {
        let file = self.file.as_ref()?;
        let triangles = file.uv_triangles()?;
        Some(use_it(GivenUv { surface: &self.surface, points: &file.uv, triangles: &triangles }))
    }

    fn places(&self, vertices: &[Vertex]) -> Vec<[f64; 3]> {
        let all = self.surface.vertices();
        vertices.iter().map(|&vertex| std::array::from_fn(|k| all[[vertex.into(), k]])).collect()
    }
}

fn surface_of(file: &ObjFile) -> Result<Surface, Problem> {
    let triangles = file.triangles();
    Ok(Surface::new(aview2(&file.vertices), aview2(&triangles))?)
}

/// The area of all faces in the plane.
fn covered(layout: &Layout) -> f64 {
    let corners = layout.faces.iter().map(|face| face.map(|point| layout.uv[point as usize]));
    corners.map(|face| crate::figures::signed_area(face).abs()).sum()
}

#[cfg(test)]
mod tests {
    use authalic::Silent;

    use super::*;

    /// A box of six quads, twice as high as wide.
    const BOX: &str = "\
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 2
v 1 0 2
v 1 1 2
v 0 1 2
vn 0 0 1
g sides
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
";

    fn wishes(preset: Preset) -> Wishes {
        Wishes { keep_seams: false, target: 1.4, preset }
    }

    #[test]
    fn the_file_that_is_written_has_the_uvs_of_the_figures() {
        let mesh = Mesh::of_file(ObjFile::read(BOX).unwrap()).unwrap();
        assert!(mesh.given().is_none(), "the file has no UVs");
        let unwrapped = mesh.unwrapped(&wishes(Preset::Even), &mut Silent).unwrap();
        let figures = unwrapped.measured.figures;
        assert!(figures.area_error < 0.01 && figures.flipped == 0);
        assert!((0.1..=1.0).contains(&unwrapped.packed));

        let text = mesh.written(&unwrapped.layout);
        assert!(text.contains("vn 0 0 1\ng sides\nvt "));
        let again = Mesh::of_file(ObjFile::read(&text).unwrap()).unwrap();
        assert_eq!(again.surface.vertices(), mesh.surface.vertices());
        let given = again.given().unwrap().figures;
        assert_eq!(given.islands, figures.islands);
        assert!((given.area_error - figures.area_error).abs() < 1e-9);
        assert!((given.shear - figures.shear).abs() < 1e-9);
    }

    #[test]
    fn seams_of_a_file_are_kept_and_softer_maps_have_better_shapes() {
        let mesh = Mesh::of_file(ObjFile::read(BOX).unwrap()).unwrap();
        let even = mesh.unwrapped(&wishes(Preset::Even), &mut Silent).unwrap();
        let file = ObjFile::read(&mesh.written(&even.layout)).unwrap();
        let with_uv = Mesh::of_file(file).unwrap();
        let kept = Wishes { keep_seams: true, ..wishes(Preset::Soft) };
        let soft = with_uv.unwrapped(&kept, &mut Silent).unwrap();
        assert_eq!(soft.layout.islands, even.layout.islands);
        assert!(soft.measured.figures.shear <= even.measured.figures.shear + 1e-9);
        assert!(soft.layout.uv.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
    }

    #[test]
    fn a_repair_mends_what_a_problem_says_that_it_mends() {
        let file = ObjFile::read(&format!("{BOX}f 1 1 7\n")).unwrap();
        let problem = Mesh::of_file(file.clone()).unwrap_err();
        assert_eq!((problem.kind().as_str(), problem.is_mendable()), ("repeated_vertex", true));
        let (mesh, report) = Mesh::repaired(&file).unwrap();
        assert!(report.contains("removed 1 face without area"), "{report}");
        let unwrapped = mesh.unwrapped(&wishes(Preset::Even), &mut Silent).unwrap();
        assert_eq!(ObjFile::read(&mesh.written(&unwrapped.layout)).unwrap().triangles().len(), 12);
        assert!(!Mesh::of_file(ObjFile::read("").unwrap()).unwrap_err().is_mendable());
    }
}
