//! Parts with borders and handles: closed before anything else, reopened once quads lie on them.
//!
//! ```text
//! part ─ seal, fill ─▶ whole ─ cut ─▶ genus 0 ─ close ─▶ closed, faces real or virtual ─ flow, borders firm ─▶ quads ─ reopen ─▶ real quads ─ weld twins
//! ```
//!
//! The map is made of the part reduced while it is open, which keeps borders, and closed then.
//! [`Closing`] is what is known of a closed part, [`Opening`] what its quads have to heed:
//!
//! | file | what it says |
//! |---|---|
//! | `whole` | what is closed for good |
//! | `closing` | how the part is closed, and its coarser version |
//! | `filling` | what is real of a closed part |
//! | `loops` | where the borders run and have corners |
//! | `sheet` | which side of a sheet is the real one |
//! | `firm` | which edges quads that flow have to meet |
//! | `hold` | where edges of primitives are held |
//! | `reopen` | which quads are kept |
//! | `puncture` | how short borders are opened |
//! | `rings` | how borders are opened along which no line of edges lies |
//! | `level` | how the two borders of a cut get as many edges |
//! | `weld` | how cut handles are joined again |
//! | `mend` | how inverted quads are opened in the end |

mod closing;
mod filling;
mod firm;
mod hold;
mod level;
mod loops;
mod mend;
mod puncture;
mod reopen;
mod rings;
mod sheet;
mod weld;
mod whole;

use glam::DVec3;

use super::even::Marked;
use crate::deform::Target;
use crate::measure::{FeatureLine, Polyline, Topology};
use crate::mesh::{FaceMap, HalfedgeMap, TriangleMesh, VertexId, VertexMap};
pub use closing::{Closing, Small};
pub use mend::untangled;
use puncture::Puncture;
pub use reopen::Lines;
pub use rings::{Loose, Regions};
pub use whole::Whole;

/// Places nearer to each other than this share of the diagonal are one.
const SAME: f64 = 1e-5;

/// What of a closed part is real, and where its borders lie.
pub struct Opening {
    /// The borders as edges of the map's mesh, on both sides of each.
    pub small: HalfedgeMap<bool>,
    /// The same as lines, from corner to corner.
    pub lines: Vec<FeatureLine>,
    /// Which vertices of the map's mesh are inside caps, where singularities need room.
    pub is_in_cap: VertexMap<bool>,
    /// Where the borders lie on the target.
    pub edges: Marked,
    /// Where a sheet is glued to its other side; empty where there is no other side.
    folds: Marked,
    /// Where handles were cut.
    cuts: Vec<Polyline>,
    /// The other borders that stay open while quads are made.
    borders: Vec<Polyline>,
    /// Whether all caps lie at the end of tubes.
    has_tubes: bool,
    /// The borders that are made once there are quads.
    punctures: Vec<Puncture>,
    /// The shape that is to come out.
    wanted: Topology,
    /// How many quads are wanted on what is real.
    pub n_asked: usize,
    /// The corners of the borders.
    corners: Vec<Corner>,
    /// Which faces of the target are real.
    is_real: FaceMap<bool>,
    /// The real part of the target alone.
    pub bare: Target,
}

impl Opening {
    /// Whether what is virtual may lie on what is real or on itself: the other side of a sheet, the caps
    /// of a cut.
    pub fn overlaps(&self) -> bool {
        self.is_sheet() || !self.cuts.is_empty()
    }

    /// Whether a side lies on another.
    pub fn is_sheet(&self) -> bool {
        !self.folds.is_empty()
    }
}

/// A corner of a border.
struct Corner {
    /// The vertex of the map's mesh that stands for it.
    on_map: DVec3,
    /// Where it is on the target, and where a vertex of the quads belongs.
    goal: DVec3,
}

/// Whether two places are one.
fn is_same(a: DVec3, b: DVec3) -> bool {
    a.distance_squared(b) < SAME * SAME
}

/// A closed line through vertices.
fn polyline(mesh: &TriangleMesh, vertices: &[VertexId]) -> Polyline {
    let round = vertices.iter().chain(vertices.first());
    Polyline::new(round.map(|&v| mesh.position(v)).collect(), true)
}
