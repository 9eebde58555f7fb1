// SPDX-License-Identifier: MIT OR Apache-2.0
//! Wavefront OBJ: read as a mesh, and written again with other UVs.
//!
//! All lines but texture vertices are kept as they are, so that groups, materials and normals survive. Lines that
//! cannot be read are refused with the message of the Python package's reader.

use std::fmt::Write;

use crate::problem::Problem;

/// The longest piece of a line that a message quotes.
const QUOTED: usize = 60;

/// The mesh of an OBJ file, with the lines of the file.
#[derive(Debug, Clone)]
pub struct ObjFile {
    /// The vertices, (n, 3).
    pub vertices: Vec<[f64; 3]>,
    /// The texture vertices, (t, 2).
    pub uv: Vec<[f64; 2]>,
    /// The polygons of three or more corners.
    pub polygons: Vec<Polygon>,
    lines: Vec<Line>,
}

/// A polygon of any number of corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// The vertex at each corner.
    pub vertices: Vec<u32>,
    /// The texture vertex at each corner; none where a corner has none.
    pub uv: Option<Vec<u32>>,
}

/// A line of the file, continued lines joined.
#[derive(Debug, Clone)]
enum Line {
    /// Written as it is.
    Kept(String),
    /// The next polygon.
    Polygon(String),
    /// A texture vertex, or an element without faces: not written again.
    Dropped,
}

impl ObjFile {
    /// Reads the text of a file: lines `v`, `vt` and `f`. Indices may be relative to the end.
    pub fn read(text: &str) -> Result<Self, Problem> {
        let mut file = Self { vertices: Vec::new(), uv: Vec::new(), polygons: Vec::new(), lines: Vec::new() };
        let mut numbers = Vec::new();
        for (number, line) in joined(text).into_iter().enumerate() {
            let Some(line) = file.read_line(line) else {
                return Err(unreadable(number + 1, text));
            };
            numbers.extend(matches!(line, Line::Polygon(_)).then_some(number + 1));
            file.lines.push(line);
        }
        file.check_vertices(&numbers)?;
        file.drop_uv_out_of_range();
        Ok(file)
    }

    /// The triangles, (m, 3), each polygon a fan around its first corner.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.polygons.iter().flat_map(|polygon| fan(&polygon.vertices)).collect()
    }

    /// The texture vertices of the triangles, (m, 3); none where a polygon has none.
    pub fn uv_triangles(&self) -> Option<Vec<[u32; 3]>> {
        let all: Option<Vec<_>> = self.polygons.iter().map(|polygon| polygon.uv.as_deref()).collect();
        all.filter(|polygons| !polygons.is_empty()).map(|all| all.into_iter().flat_map(fan).collect())
    }

    /// The edges that divide polygons into triangles, (d, 2).
    pub fn diagonals(&self) -> Vec<[u32; 2]> {
        let inner = |corners: &[u32]| {
            let first = corners[0];
            corners[2..corners.len() - 1].iter().map(move |&other| [first, other]).collect::<Vec<_>>()
        };
        self.polygons.iter().flat_map(|polygon| inner(&polygon.vertices)).collect()
    }

    /// The file with other UVs: points (k, 2), and the point at each corner of the triangles, (m, 3).
    ///
    /// A polygon that a seam divides becomes triangles.
    pub fn with_uv(&self, points: &[[f64; 2]], triangles: &[[u32; 3]]) -> String {
        let mut text = String::new();
        let mut points = Some(points);
        let (mut polygons, mut rest) = (self.polygons.iter(), triangles);
        for line in &self.lines {
            match line {
                Line::Kept(line) => writeln(&mut text, line),
                Line::Dropped => {}
                Line::Polygon(line) => {
                    points.take().into_iter().for_each(|points| write_points(&mut text, points));
                    let count = polygons.next().map_or(0, |polygon| polygon.vertices.len() - 2);
                    let (own, others) = rest.split_at(count);
                    write_polygon(&mut text, line, own);
                    rest = others;
                }
            }
        }
        text
    }

    /// Reads one line; none where it cannot be read.
    fn read_line(&mut self, line: String) -> Option<Line> {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let [x, y, z] = [words.next()?, words.next()?, words.next()?].map(number);
                self.vertices.push([x?, y?, z?]);
            }
            Some("vt") => {
                self.uv.push([number(words.next()?)?, number(words.next().unwrap_or("0"))?]);
                return Some(Line::Dropped);
            }
            Some("f") => {
                let polygon = self.polygon(words)?;
                if polygon.vertices.len() < 3 {
                    return Some(Line::Dropped);
                }
                self.polygons.push(polygon);
                return Some(Line::Polygon(line));
            }
            Some("l") => {
                let ends: Vec<_> = words.map(|word| word.split('/').next().unwrap_or(word)).collect();
                return Some(Line::Kept(format!("l {}", ends.join(" "))));
            }
            _ => {}
        }
        Some(Line::Kept(line))
    }

    /// The polygon of corners v, v/vt, v/vt/vn or v//vn.
    fn polygon<'a>(&self, words: impl Iterator<Item = &'a str>) -> Option<Polygon> {
        let (mut vertices, mut uv) = (Vec::new(), Some(Vec::new()));
        for word in words {
            let mut parts = word.split('/');
            vertices.push(index(parts.next()?, self.vertices.len())?);
            match parts.next().filter(|part| !part.is_empty()) {
                Some(part) => {
                    let point = index(part, self.uv.len())?;
                    uv.iter_mut().for_each(|uv| uv.push(point));
                }
                None => uv = None,
            }
        }
        Some(Polygon { vertices, uv })
    }

    /// Refuses polygons with vertices that do not exist; `numbers` are their lines.
    fn check_vertices(&self, numbers: &[usize]) -> Result<(), Problem> {
        let count = self.vertices.len() as u64;
        for (polygon, number) in self.polygons.iter().zip(numbers) {
            let last = polygon.vertices.iter().map(|&vertex| u64::from(vertex) + 1).max().unwrap_or(0);
            if last > count {
                let there = if count == 1 { "is 1 vertex".into() } else { format!("are {count} vertices") };
                return Err(Problem::of_file(format!(
                    "line {number} names vertex {last}, but there {there}"
                )));
            }
        }
        Ok(())
    }

    /// Forgets texture vertices that do not exist.
    fn drop_uv_out_of_range(&mut self) {
        let count = self.uv.len() as u32;
        for polygon in &mut self.polygons {
            polygon.uv = polygon.uv.take().filter(|uv| uv.iter().all(|&point| point < count));
        }
    }
}

/// A mesh of triangles with UVs as the text of a file.
pub fn plain(vertices: &[[f64; 3]], faces: &[[u32; 3]], points: &[[f64; 2]], uv: &[[u32; 3]]) -> String {
    let mut text = String::new();
    vertices.iter().for_each(|[x, y, z]| writeln(&mut text, &format!("v {x} {y} {z}")));
    write_points(&mut text, points);
    for ([a, b, c], [i, j, k]) in faces.iter().map(|face| face.map(|v| v + 1)).zip(uv.iter().map(counted)) {
        writeln(&mut text, &format!("f {a}/{i} {b}/{j} {c}/{k}"));
    }
    text
}

/// The lines of a text, those that a backslash continues joined.
fn joined(text: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut held = String::new();
    for line in text.lines() {
        if let Some(start) = line.strip_suffix('\\') {
            held += start;
            held += " ";
        } else {
            lines.push(std::mem::take(&mut held) + line);
        }
    }
    lines
}

fn unreadable(number: usize, text: &str) -> Problem {
    let line = joined(text).swap_remove(number - 1);
    let quoted: String = line.trim().chars().take(QUOTED).collect();
    Problem::of_file(format!("line {number} cannot be read: '{quoted}'"))
}

fn number(word: &str) -> Option<f64> {
    word.parse().ok()
}

/// From 1 onwards, or from −1 backwards.
fn index(word: &str, count: usize) -> Option<u32> {
    let index: i64 = word.parse().ok()?;
    let place = if index > 0 { index - 1 } else { count as i64 + index };
    u32::try_from(place).ok().filter(|_| index != 0)
}

/// The triangles of a polygon around its first corner.
fn fan(corners: &[u32]) -> Vec<[u32; 3]> {
    corners[1..].windows(2).map(|side| [corners[0], side[0], side[1]]).collect()
}

/// The polygon of a line with the points of its triangles.
fn write_polygon(text: &mut String, line: &str, triangles: &[[u32; 3]]) {
    let words: Vec<_> = line.split_whitespace().skip(1).collect();
    match common_points(triangles) {
        Some(points) => write_corners(text, &words, &points),
        None => {
            for (k, points) in triangles.iter().enumerate() {
                write_corners(text, &[words[0], words[k + 1], words[k + 2]], points);
            }
        }
    }
}

/// The points of a polygon whose triangles agree at each corner.
fn common_points(triangles: &[[u32; 3]]) -> Option<Vec<u32>> {
    let agree = |pair: &[[u32; 3]]| pair[0][0] == pair[1][0] && pair[0][2] == pair[1][1];
    let [first, second, _] = *triangles.first()?;
    let others = triangles.iter().map(|triangle| triangle[2]);
    triangles.windows(2).all(agree).then(|| [first, second].into_iter().chain(others).collect())
}

/// A line `f` of corners, each with its vertex, the number of its point and its normal.
fn write_corners(text: &mut String, words: &[&str], points: &[u32]) {
    text.push('f');
    for (word, point) in words.iter().zip(points) {
        let mut parts = word.split('/');
        let (vertex, normal) = (parts.next().unwrap_or(word), parts.nth(1));
        let normal = normal.map_or_else(String::new, |normal| format!("/{normal}"));
        // writing to a string cannot fail
        let _ = write!(text, " {vertex}/{}{normal}", point + 1);
    }
    text.push('\n');
}

/// Shortest decimals that read back to the same bits.
fn write_points(text: &mut String, points: &[[f64; 2]]) {
    points.iter().for_each(|[u, v]| writeln(text, &format!("vt {u} {v}")));
}

fn writeln(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

fn counted(corners: &[u32; 3]) -> [u32; 3] {
    corners.map(|corner| corner + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "\
mtllib a.mtl
o square
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0.5
vt 0 0
vt 1 0
vn 0 0 1
usemtl red
f 1/1/1 2/2/1 3/2/1 -1/1/1
l 1/1 2/2
";

    #[test]
    fn lines_of_meshes_are_read_and_all_others_kept() {
        let file = ObjFile::read(SQUARE).unwrap();
        assert_eq!(file.vertices[3], [0.0, 1.0, 0.5]);
        assert_eq!(file.triangles(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(file.uv_triangles().unwrap(), [[0, 1, 1], [0, 1, 0]]);
        assert_eq!(file.diagonals(), [[0, 2]]);
        let points = [[0.25, 0.0], [1.0, 0.0], [1.0, 0.75], [0.0, 1.0]];
        let text = file.with_uv(&points, &[[0, 1, 2], [0, 2, 3]]);
        let wanted = "\
mtllib a.mtl
o square
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0.5
vn 0 0 1
usemtl red
vt 0.25 0
vt 1 0
vt 1 0.75
vt 0 1
f 1/1/1 2/2/1 3/3/1 -1/4/1
l 1 2
";
        assert_eq!(text, wanted);
    }

    #[test]
    fn a_polygon_that_a_seam_divides_becomes_triangles() {
        let file = ObjFile::read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").unwrap();
        let text = file.with_uv(&[[0.0, 0.0]; 6], &[[0, 1, 2], [3, 4, 5]]);
        let faces: Vec<_> = text.lines().filter(|line| line.starts_with('f')).collect();
        assert_eq!(faces, ["f 1/1 2/2 3/3", "f 1/4 3/5 4/6"]);
    }

    #[test]
    fn what_is_written_reads_back_to_the_same_bits() {
        let (third, tiny) = (1.0 / 3.0, 1e-300);
        let text = plain(&[[third, tiny, -1e22]; 3], &[[0, 1, 2]], &[[third, 0.1]; 3], &[[0, 1, 2]]);
        let file = ObjFile::read(&text).unwrap();
        assert_eq!(file.vertices[0].map(f64::to_bits), [third, tiny, -1e22].map(f64::to_bits));
        assert_eq!(file.uv[2].map(f64::to_bits), [third, 0.1].map(f64::to_bits));
        assert_eq!(file.uv_triangles().unwrap(), [[0, 1, 2]]);
    }

    #[test]
    fn continued_lines_are_one_and_carriage_returns_are_space() {
        let file = ObjFile::read("v 0 0 0\r\nv 1 0 \\\n 0\r\nv 0 1 0\r\nf 1 2 \\\n3\n").unwrap();
        assert_eq!(file.triangles(), [[0, 1, 2]]);
    }

    #[test]
    fn a_line_that_cannot_be_read_is_quoted_with_its_number() {
        let message = |text| ObjFile::read(text).unwrap_err().message();
        assert_eq!(message("v 0 0 0\nv 1 x 0\n"), "line 2 cannot be read: 'v 1 x 0'");
        assert_eq!(message("# 1\nf 0 1 2\n"), "line 2 cannot be read: 'f 0 1 2'");
        assert_eq!(message("v 1 2"), "line 1 cannot be read: 'v 1 2'");
        assert_eq!(message("f -1 -2 -3"), "line 1 cannot be read: 'f -1 -2 -3'");
    }

    #[test]
    fn a_line_that_names_a_missing_vertex_is_named() {
        let message = |text: &str| ObjFile::read(text).unwrap_err().message();
        let square = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        let last = format!("{square}f 1 2 3\nf 1 2 4294967296\n");
        assert_eq!(message(&last), "line 5 names vertex 4294967296, but there are 3 vertices");
        assert_eq!(message("v 0 0 0\nf 1 1 2"), "line 2 names vertex 2, but there is 1 vertex");
        // a vertex may come after the polygon that names it
        assert!(ObjFile::read(&format!("f 1 2 3\n{square}")).is_ok());
        assert_eq!(message("v 1_0 0 0"), "line 1 cannot be read: 'v 1_0 0 0'");
    }

    #[test]
    fn missing_texture_vertices_are_as_none() {
        let file = ObjFile::read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/2 3/3\n").unwrap();
        assert_eq!(file.uv_triangles(), None);
        assert_eq!(ObjFile::read("").unwrap().uv_triangles(), None);
    }
}
