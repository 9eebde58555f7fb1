// SPDX-License-Identifier: MIT OR Apache-2.0
//! How many repairs of each kind were made.

/// How many repairs of each kind were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct RepairCounts {
    /// Vertices with a coordinate that is NaN or infinite, dropped.
    pub vertices_not_finite: usize,
    /// Faces at these vertices, dropped.
    pub faces_not_finite: usize,
    /// Vertices without a face, dropped.
    pub loose_vertices: usize,
    /// Points that were merged with another one.
    pub merged_points: usize,
    /// Faces without area, removed so that no hole appears.
    pub faces_without_area: usize,
    /// Faces that repeat another one, dropped.
    pub repeated_faces: usize,
    /// Edges of three or more faces, split.
    pub split_edges: usize,
    /// Vertices added where parts touched only in a vertex or an edge.
    pub split_vertices: usize,
    /// Faces turned over, to be oriented like most of their piece.
    pub turned_faces: usize,
    /// Pieces dropped.
    pub dropped_pieces: usize,
    /// Holes closed.
    pub closed_holes: usize,
    /// Handles closed.
    pub closed_handles: usize,
}

impl RepairCounts {
    /// The counts with their names.
    pub fn named(&self) -> [(&'static str, usize); 12] {
        [
            ("vertices_not_finite", self.vertices_not_finite),
            ("faces_not_finite", self.faces_not_finite),
            ("loose_vertices", self.loose_vertices),
            ("merged_points", self.merged_points),
            ("faces_without_area", self.faces_without_area),
            ("repeated_faces", self.repeated_faces),
            ("split_edges", self.split_edges),
            ("split_vertices", self.split_vertices),
            ("turned_faces", self.turned_faces),
            ("dropped_pieces", self.dropped_pieces),
            ("closed_holes", self.closed_holes),
            ("closed_handles", self.closed_handles),
        ]
    }

    /// What was done, one sentence without its stop for each kind of repair.
    pub(super) fn sentences(&self) -> Vec<String> {
        let sentences = [
            (self.vertices_not_finite, "dropped {} with NaN or infinity", "vertex"),
            (self.faces_not_finite, "dropped {} at such vertices", "face"),
            (self.loose_vertices, "dropped {} without a face", "vertex"),
            (self.merged_points, "merged {} with others at the same place", "point"),
            (self.faces_without_area, "removed {} without area", "face"),
            (self.repeated_faces, "dropped {} repeating another one", "face"),
            (self.split_edges, "split {} of three or more faces", "edge"),
            (self.split_vertices, "added {} where parts only touched", "vertex"),
            (self.turned_faces, "turned {} over", "face"),
            (self.dropped_pieces, "dropped {}", "smaller piece"),
            (self.closed_holes, "closed {}", "hole"),
            (self.closed_handles, "closed {}", "handle"),
        ];
        let made = sentences.into_iter().filter(|(count, ..)| *count > 0);
        made.map(|(count, sentence, noun)| sentence.replace("{}", &counted(count, noun))).collect()
    }
}

/// A number of things in words.
pub(super) fn counted(count: usize, noun: &str) -> String {
    match (count, noun) {
        (1, noun) => format!("1 {noun}"),
        (count, "vertex") => format!("{count} vertices"),
        (count, noun) => format!("{count} {noun}s"),
    }
}
