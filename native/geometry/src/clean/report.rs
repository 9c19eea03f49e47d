//! What was done to a mesh, in numbers and in words.

use serde::{Deserialize, Serialize};

/// What [`clean`](super::clean) had to do.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Report {
    /// Vertices merged into an earlier one at exactly the same point.
    pub n_welded: usize,
    /// Points of borders that were welded to others across a gap.
    pub n_seam_welded: usize,
    /// The largest gap that was welded so, in the input's units.
    pub weld_distance: f64,
    /// Vertices dropped because no face uses them.
    pub n_isolated: usize,
    /// Faces dropped because fewer than three different corners were left.
    pub n_degenerate: usize,
    /// Faces that lost a repeated corner and went on with the others.
    pub n_shortened: usize,
    /// Faces dropped because the same face came before.
    pub n_duplicates: usize,
    /// Triangles without area that were dropped; others close the surface and stay.
    pub n_flat_dropped: usize,
    /// Triangles dropped because two of them lay back to back and enclosed nothing.
    pub n_doubled: usize,
    /// Triangles turned to agree with their neighbours.
    pub n_reoriented: usize,
    /// Vertices added where several fans of faces met at one.
    pub n_split: usize,
    /// Edges of more than two faces at which surfaces were parted into sheets.
    pub n_shared_edges: usize,
    /// The sheets that meet there.
    pub n_sheets: usize,
}

impl Report {
    /// One sentence for each thing that was done; none for a mesh that came clean.
    pub fn sentences(&self) -> Vec<String> {
        let seams = (self.n_seam_welded > 0).then(|| {
            let (n, gap) = (self.n_seam_welded, self.weld_distance);
            let what = if n == 1 {
                "border point"
            } else {
                "border points"
            };
            format!("{n} {what} welded across gaps of up to {gap:.2e}")
        });
        let counted = [
            (
                self.n_welded,
                "duplicate vertex welded",
                "duplicate vertices welded",
            ),
            (
                self.n_isolated,
                "isolated vertex dropped",
                "isolated vertices dropped",
            ),
            (
                self.n_degenerate,
                "degenerate face dropped",
                "degenerate faces dropped",
            ),
            (
                self.n_shortened,
                "repeated corner dropped from a face",
                "faces lost a repeated corner",
            ),
            (
                self.n_duplicates,
                "duplicate face dropped",
                "duplicate faces dropped",
            ),
            (
                self.n_flat_dropped,
                "triangle without area dropped",
                "triangles without area dropped",
            ),
            (
                self.n_doubled,
                "triangle back to back with another dropped",
                "triangles back to back dropped",
            ),
            (self.n_reoriented, "face re-oriented", "faces re-oriented"),
            (
                self.n_split,
                "vertex added where fans met",
                "vertices added where fans met",
            ),
        ]
        .into_iter()
        .filter(|(n, _, _)| *n > 0)
        .map(|(n, one, many)| format!("{n} {}", if n == 1 { one } else { many }));
        seams
            .into_iter()
            .chain(counted)
            .chain(self.parted())
            .collect()
    }

    /// What was parted into sheets.
    fn parted(&self) -> Option<String> {
        let edges = counted(self.n_shared_edges, "edge");
        let sheets = counted(self.n_sheets, "sheet");
        let told = || format!("{edges} of three or more faces parted into {sheets}");
        (self.n_shared_edges > 0).then(told)
    }
}

/// A number of things.
fn counted(n: usize, what: &str) -> String {
    let ending = if n == 1 { "" } else { "s" };
    format!("{n} {what}{ending}")
}
