//! What is told of faces that are kept.

use serde::Serialize;

use crate::pipeline::fault::Fault;
use crate::pipeline::kept::count;

/// What became of faces that were to be kept.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct KeptFaces {
    /// How many there are.
    pub n_faces: usize,
    /// How many edges lie between them and what was remeshed.
    pub n_edges: usize,
    /// How many of these were met by one edge of the new mesh; beside the others there are vertices
    /// of another valence.
    pub n_met: usize,
    /// How many triangles were needed beside them among quads.
    pub n_triangles: usize,
    /// How many edges of theirs are beside something that stayed as it came.
    pub n_stayed: usize,
    /// How far what is not kept is from its own image in the plane that was named, in % of the
    /// diagonal, where it was not made so because of what is kept.
    pub plane_off_pct: Option<f64>,
}

impl KeptFaces {
    /// What is wrong with how they were joined.
    pub fn fault(self) -> Option<Fault> {
        (self.n_triangles > 0).then_some(Fault::KeptTriangles {
            n_triangles: self.n_triangles,
        })
    }

    /// What is wrong with the symmetry that was named.
    pub fn mirror_fault(self) -> Option<Fault> {
        let off_pct = self.plane_off_pct?;
        Some(Fault::KeptUnlikeImage { off_pct })
    }

    /// What became of them, in a line.
    pub fn text(&self) -> String {
        let mut told = vec![format!("{} kept", count(self.n_faces, "face"))];
        if self.n_edges > 0 {
            let edges = count(self.n_edges, "edge");
            told.push(format!("joined along {edges} ({} met by one)", self.n_met));
        }
        if self.n_stayed > 0 {
            let edges = count(self.n_stayed, "edge");
            told.push(format!("{edges} beside faces that stayed as they came"));
        }
        told.join(", ")
    }
}
