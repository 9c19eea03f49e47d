//! Which vertices of sheets stand where lines end and sheets touch.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::chain::Sheets;
use super::{Corner, Line, Touch};
use crate::mesh::VertexId;

/// A corner is at most so many mean edges of its sheet from the vertex that stands for it.
const FARTHEST: f64 = 2.0;
/// A place lies on a border that is nearer than so many mean edges.
const ON_BORDER: f64 = 0.1;

/// What of a sheet is at a corner; the greatest counts.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// It is touched there.
    Touched,
    /// A line ends there that goes over the sheet.
    GoesOn,
    /// A line ends there at which the sheet ends.
    Ends,
}

/// The vertices that stand for corners of sheets, each for one of a sheet.
pub(super) struct Corners(BTreeMap<Corner, VertexId>);

impl Corners {
    /// Gives each corner a vertex, the nearest pairs first: corners of borders one of these.
    pub(super) fn new(sheets: &Sheets<'_>, lines: &[Line], touches: &[Touch]) -> Self {
        let mut wanted: BTreeMap<Corner, (DVec3, Kind)> = BTreeMap::new();
        for line in lines.iter().filter(|line| !line.is_closed) {
            let places = [line.points[0], line.points[line.points.len() - 1]];
            for strand in &line.strands {
                for (name, place) in strand.ends.into_iter().zip(places) {
                    let sheet = strand.sheet;
                    let kind = if strand.is_border {
                        Kind::Ends
                    } else {
                        Kind::GoesOn
                    };
                    let of_one = wanted
                        .entry(Corner { sheet, name })
                        .or_insert((place, kind));
                    of_one.1 = of_one.1.max(kind);
                }
            }
        }
        for touch in touches {
            for &corner in &touch.corners {
                wanted.entry(corner).or_insert((touch.place, Kind::Touched));
            }
        }
        let mut pairs: Vec<(f64, Corner, VertexId)> = Vec::new();
        for (&corner, &(place, kind)) in &wanted {
            let mean = sheets.mean(corner.sheet);
            let is_border =
                kind == Kind::Ends || sheets.off_border(corner.sheet, place) < ON_BORDER * mean;
            let kind = (is_border, kind == Kind::GoesOn);
            let near = sheets.near(corner.sheet, (place, FARTHEST * mean), kind);
            pairs.extend(near.into_iter().map(|(v, off)| (off, corner, v)));
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut given = BTreeMap::new();
        let mut taken: BTreeSet<VertexId> = BTreeSet::new();
        for (_, corner, v) in pairs {
            if !given.contains_key(&corner) && taken.insert(v) {
                given.insert(corner, v);
            }
        }
        Self(given)
    }

    /// The vertex that stands for a corner, if one is near.
    pub(super) fn vertex(&self, corner: Corner) -> Option<VertexId> {
        self.0.get(&corner).copied()
    }

    /// All of them.
    pub(super) fn vertices(&self) -> BTreeSet<VertexId> {
        self.0.values().copied().collect()
    }
}
