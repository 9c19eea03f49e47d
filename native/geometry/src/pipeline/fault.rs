//! What can be wrong with a result, each with its sentence.

use serde::Serialize;

/// What can be wrong with a result.
#[derive(Clone, PartialEq, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Fault {
    /// Quads with a corner that turns the wrong way.
    Inverted {
        /// How many.
        n_quads: usize,
    },
    /// Faces of a part that pass through each other.
    Crossing {
        /// How many pairs of triangles.
        n_pairs: usize,
        /// The share of triangles in a pair.
        pct: f64,
    },
    /// The surface is far from the input's somewhere.
    Far {
        /// How far, in % of the diagonal.
        hausdorff_pct: f64,
        /// How far, in edges of the new faces.
        in_edges: f64,
    },
    /// Another number of faces.
    Count {
        /// How many were asked for.
        n_asked: usize,
        /// How many there are.
        n_faces: usize,
    },
    /// Quads that do not follow the shape.
    Flow {
        /// Of how many parts.
        n_parts: usize,
        /// Why the first of them.
        reason: String,
    },
    /// Parts that are not symmetric although that was asked for.
    Mirror {
        /// How many.
        n_parts: usize,
        /// Why the first of them.
        reason: String,
    },
    /// The input is not symmetric in the named plane, and one side of it was replaced.
    MirrorReplaced {
        /// The axis across the plane.
        axis: &'static str,
        /// How far the farthest point of the input lies from the input once it is mirrored, in % of
        /// the diagonal.
        off_pct: f64,
    },
    /// Sharp or marked lines without edges along them.
    Lines {
        /// The share of their length.
        lost_pct: f64,
    },
    /// Sheets that met along a line and do no longer.
    Parted {
        /// At how many lines.
        n_left: usize,
        /// Of how many.
        n_shared_lines: usize,
    },
    /// Triangles among quads beside faces that are kept.
    KeptTriangles {
        /// How many.
        n_triangles: usize,
    },
    /// Faces are kept of a mesh that is not symmetric in the named plane.
    KeptUnlikeImage {
        /// How far the others are from their image, in % of the diagonal.
        off_pct: f64,
    },
    /// A stroke that was to be met and is not, or was not drawn.
    Guide {
        /// Which one.
        guide: usize,
        /// What came of it.
        reason: String,
    },
    /// A network's proposal was no use, and the solver's map was taken.
    Network {
        /// For how many parts.
        n_parts: usize,
    },
}

impl Fault {
    /// Whether a result with it is not fit for use as it is.
    pub(super) fn is_grave(&self) -> bool {
        matches!(
            self,
            Self::Inverted { .. } | Self::Crossing { .. } | Self::Far { .. }
        )
    }

    /// It in a plain sentence.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Inverted { n_quads } => {
                let (quads, are) = of(*n_quads, "quad", "is", "are");
                format!("{quads} {are} folded over or turned inside out")
            }
            Self::Crossing { n_pairs, pct } => {
                format!("faces pass through each other in {n_pairs} places ({pct:.1} % of them)")
            }
            Self::Far {
                hausdorff_pct,
                in_edges,
            } => format!(
                "the new surface is off by up to {hausdorff_pct:.1} % of the model's size, the length of \
                 {in_edges:.1} edges: something may be cut off or filled in"
            ),
            Self::Count { n_asked, n_faces } => {
                format!("{n_faces} faces were made, {n_asked} were asked for")
            }
            Self::Flow { n_parts, reason } => {
                let (parts, _) = of(*n_parts, "part", "", "");
                format!("the edges of {parts} do not follow the shape ({reason})")
            }
            Self::Mirror { n_parts, reason } => {
                let (parts, are) = of(*n_parts, "part", "is", "are");
                format!("{parts} {are} not made symmetric ({reason})")
            }
            Self::MirrorReplaced { axis, off_pct } => format!(
                "the model is not symmetric across {axis} (its sides differ by up to {off_pct:.1} % of its \
                 size): the side of negative {axis} was replaced by the image of the other"
            ),
            Self::Lines { lost_pct } => {
                format!("{lost_pct:.0} % of the sharp or marked lines have no edges along them")
            }
            Self::Parted {
                n_left,
                n_shared_lines,
            } => format!(
                "sheets no longer meet vertex by vertex along {n_left} of {n_shared_lines} lines where they did"
            ),
            Self::KeptTriangles { n_triangles } => {
                let (triangles, are) = of(*n_triangles, "triangle", "lies", "lie");
                format!(
                    "{triangles} {are} beside kept faces: quads alone cannot have as many edges there"
                )
            }
            Self::KeptUnlikeImage { off_pct } => format!(
                "nothing was made symmetric: what is not kept is not (its sides differ by up to \
                 {off_pct:.1} % of its size), and made so it would not join what is kept"
            ),
            Self::Guide { guide, reason } => format!("guide {guide} is lost: {reason}"),
            Self::Network { n_parts } => {
                let (parts, _) = of(*n_parts, "part", "", "");
                format!(
                    "the network's proposal for {parts} was beyond repair; the solver's was taken"
                )
            }
        }
    }
}

/// A number of things and the verb that goes with it.
fn of(n: usize, thing: &str, one: &'static str, more: &'static str) -> (String, &'static str) {
    match n {
        1 => (format!("1 {thing}"), one),
        _ => (format!("{n} {thing}s"), more),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_are_plain_and_have_numbers() {
        let faults = [
            Fault::Crossing {
                n_pairs: 34,
                pct: 2.07,
            },
            Fault::Count {
                n_asked: 100,
                n_faces: 126,
            },
            Fault::Flow {
                n_parts: 2,
                reason: "why".to_owned(),
            },
            Fault::Lines { lost_pct: 28.4 },
            Fault::Network { n_parts: 1 },
        ];
        let texts = faults.map(|fault| fault.text());
        assert_eq!(
            texts,
            [
                "faces pass through each other in 34 places (2.1 % of them)",
                "126 faces were made, 100 were asked for",
                "the edges of 2 parts do not follow the shape (why)",
                "28 % of the sharp or marked lines have no edges along them",
                "the network's proposal for 1 part was beyond repair; the solver's was taken",
            ]
        );
    }
}
