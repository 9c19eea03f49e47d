//! What a deformation is told to do.

use serde::{Deserialize, Serialize};

use super::Anchor;

/// What to do, and how much of it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// What faces are evened out to while vertices slide; quads that flow have sizes of their own.
    pub sizes: Sizes,
    /// How far vertices go for sharp lines.
    pub lines: Lines,
    /// Whether vertices of quads that flow end on the surface instead of where their faces miss it
    /// least: with the ends of a drum on its rims, the rings between would stand out beyond them.
    pub is_inscribed: bool,
    /// How often every vertex of a mesh of triangles slides. Fewer leave uneven faces, more cost
    /// time for little.
    pub n_relaxations: usize,
    /// The same for a primitive with quads, which cannot flip its way out.
    pub n_quad_relaxations: usize,
    /// The same for quads that flow.
    pub n_flow_relaxations: usize,
    /// How often the faces are fitted to the surface by least squares.
    pub n_straddles: usize,
    /// The same for quads that flow.
    pub n_flow_straddles: usize,
    /// Whether faces that cross in space are moved apart in the end.
    pub separates: bool,
    /// How strongly vertices are held where they are while faces are fitted.
    pub anchor: Anchor,
    /// The same for quads that flow, which lie along the shape already.
    pub flow_anchor: Anchor,
    /// How much quads that flow wish to be squares while they are fitted, relative to the pull of
    /// the surface: at 0.1 they come nearer but are sheared, at 1 they miss detail.
    pub squareness: f64,
    /// How much edges of quads that flow wish to be equally long while they are fitted, relative to
    /// the pull of the surface; 0 for not at all. Quads wish to be squares of one size with it: else
    /// equal edges make rhombs.
    pub evenness: f64,
}

/// How far vertices go for sharp lines.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Lines {
    /// They walk to lines that are long and clear, as far as that spoils no face.
    #[default]
    Sought,
    /// The target is a solid. Vertices of triangles lie along its lines already, short ones too: they
    /// are set onto them before anything slides. Those of quads that flow are set onto their lines
    /// where that leaves no face inverted, and spread evenly along bent ones.
    Kept,
    /// The same, whatever that does to faces.
    Forced,
}

/// The size that faces are evened out to.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sizes {
    /// One for all.
    #[default]
    Equal,
    /// That of the faces around, for primitives that are finer in places.
    Own,
}

/// How strongly quads are held along the surface that end on it: with less a drum of 54 quads is twisted
/// by 6° between its rims, with more quads are no longer made square.
const INSCRIBED_ALONG: f64 = 1.0;

impl Settings {
    /// How strongly vertices of quads that flow are held while they are fitted.
    pub(super) fn anchor_of_flow(&self) -> Anchor {
        let mut anchor = self.flow_anchor;
        if self.is_inscribed {
            anchor.along = INSCRIBED_ALONG;
        }
        anchor
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            sizes: Sizes::Equal,
            lines: Lines::Sought,
            is_inscribed: false,
            n_relaxations: 4,
            n_quad_relaxations: 0,
            n_flow_relaxations: 40,
            n_straddles: 2,
            n_flow_straddles: 4,
            separates: true,
            anchor: Anchor::default(),
            flow_anchor: Anchor {
                along: 0.02,
                ..Anchor::default()
            },
            squareness: 0.25,
            evenness: 0.0,
        }
    }
}
