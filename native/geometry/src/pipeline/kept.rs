//! Parts of the input that are not remeshed, and every reason why.

use std::fmt::Write;

use glam::DVec3;
use serde::Serialize;

use crate::mesh::{FaceId, PolygonMesh, VertexId};

/// The most edges or faces that a reason names.
const MOST_NAMED: usize = 10_000;
/// The most parts that one line of text tells of.
const MOST_TOLD: usize = 8;

/// A part of the input that was not remeshed.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Kept {
    /// Which part it is, counted from 0 among all parts in the order of their first faces.
    pub part: usize,
    /// How many of the input's faces it has.
    pub n_faces: usize,
    /// Whether it is in the result.
    pub outcome: Outcome,
    /// Why, all of it.
    pub reasons: Vec<Reason>,
}

/// What became of a part that was not remeshed.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// It is in the result as it was.
    Kept,
    /// It is not.
    Dropped,
}

/// A reason not to remesh a part. Vertices and faces are the input's.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Reason {
    /// What it is.
    #[serde(flatten)]
    pub flaw: Flaw,
    /// The same in words.
    pub text: String,
    /// A point of the spot, in the input's coordinates.
    pub place: [f64; 3],
    /// The edges of the spot, 10,000 at most.
    pub edges: Vec<[VertexId; 2]>,
    /// The faces of the part, 10,000 at most.
    pub faces: Vec<FaceId>,
}

/// What keeps a part from being remeshed.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Flaw {
    /// It has borders, and what is to be made of it can have none.
    Border {
        /// How many loops.
        n_loops: usize,
        /// How many edges they have together.
        n_edges: usize,
    },
    /// It has handles.
    Handles {
        /// How many.
        genus: i64,
    },
    /// It has one side only.
    OneSided,
    /// It encloses nothing.
    Flat {
        /// How many different points it has.
        n_points: usize,
    },
    /// It is closed and lies wholly inside another.
    Inside {
        /// Which part that is.
        of: usize,
    },
    /// It is too small for its share of the faces, or smaller than was asked for.
    Small {
        /// Its share of the faces, where that is too few.
        share: Option<f64>,
        /// How large it is, in percent of the mesh's diagonal.
        size_pct: f64,
    },
    /// Its run failed.
    Failed,
}

impl Kept {
    /// Whether it is merely small.
    pub fn is_small(&self) -> bool {
        let is_small = |reason: &Reason| matches!(reason.flaw, Flaw::Small { .. });
        self.reasons.iter().any(is_small)
    }

    /// Whether it lies inside another and was to go.
    pub fn is_inner(&self) -> bool {
        let is_inner = |reason: &Reason| matches!(reason.flaw, Flaw::Inside { .. });
        self.reasons.iter().any(is_inner)
    }

    /// Whether something is wrong with it: more than its size or its place.
    pub fn is_bad(&self) -> bool {
        !self.is_small() && !self.is_inner()
    }

    /// All reasons in words.
    pub fn text(&self) -> String {
        let texts: Vec<&str> = self.reasons.iter().map(|r| r.text.as_str()).collect();
        texts.join("; ")
    }
}

impl Reason {
    /// A reason that lies on some edges of a part, or on all of it.
    pub fn new(
        mesh: &PolygonMesh,
        faces: &[FaceId],
        edges: &[[VertexId; 2]],
        flaw: Flaw,
        text: String,
    ) -> Self {
        let middle = |[a, b]: &[VertexId; 2]| mesh.position(*a).midpoint(mesh.position(*b));
        let corner = || faces.first().map(|&face| mesh.position(mesh.face(face)[0]));
        let place = edges.first().map(middle).or_else(corner);
        Self {
            flaw,
            text,
            place: place.unwrap_or(DVec3::ZERO).to_array(),
            edges: edges.iter().take(MOST_NAMED).copied().collect(),
            faces: faces.iter().take(MOST_NAMED).copied().collect(),
        }
    }
}

/// Why no part, or not all of them, can be done, in one line.
pub fn refusal(kept: &[Kept], n_parts: usize) -> String {
    let told: Vec<&Kept> = kept.iter().filter(|kept| kept.is_bad()).collect();
    // Where all are small, that is the reason.
    let told = if told.is_empty() {
        kept.iter().collect()
    } else {
        told
    };
    if let ([one], 1) = (&told[..], n_parts) {
        return one.text();
    }
    let mut text = if told.len() == n_parts {
        format!("none of the {n_parts} parts can be done")
    } else {
        format!("{} of {n_parts} parts cannot be done", told.len())
    };
    for (i, kept) in told.iter().take(MOST_TOLD).enumerate() {
        let before = if i == 0 { ":" } else { ";" };
        let _ = write!(text, "{before} part {}: {}", kept.part + 1, kept.text());
    }
    if told.len() > MOST_TOLD {
        let _ = write!(text, "; and {} more", told.len() - MOST_TOLD);
    }
    text
}

/// A number of things.
pub fn count(n: usize, what: &str) -> String {
    let ending = if n == 1 { "" } else { "s" };
    format!("{n} {what}{ending}")
}
