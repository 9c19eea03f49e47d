//! What becomes of handles, and where they are.

use serde::{Deserialize, Serialize};

use super::borders::MAX_FILL;
use super::{Error, Settings};
use crate::close::handles::{Limits, short_loop};
use crate::mesh::{Id, TriangleMesh, VertexId};
use crate::progress::Progress;

/// Round handles that a grid makes go loops of this many cells at most: gaps narrower than a cell are
/// bridged here and there.
const CELLS_ROUND: f64 = 6.0;
/// Tunnels round which go so many edges of quads at most are sealed in what was made solid: cloth,
/// hair and belts that touch make them, and quads have no way into them.
const EDGES_ROUND: f64 = 5.0;
/// But none wider than that share of the diagonal: that is a shape.
const WIDEST: f64 = 0.12;

/// What becomes of handles.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Handles {
    /// They stay.
    #[default]
    Keep,
    /// Those are cut and closed for good round which a tight loop is no longer than so many percent
    /// of the whole mesh's diagonal, from 0 to 1000.
    SealUpTo(f64),
}

impl Settings {
    /// Whether the size is in its range.
    pub(super) fn check_handles(&self) -> Result<(), Error> {
        match self.handles {
            Handles::SealUpTo(value) if !(0.0..=MAX_FILL).contains(&value) => {
                Err(Error::SizeOutOfRange {
                    name: "seal size",
                    value,
                    most: MAX_FILL,
                })
            }
            _ => Ok(()),
        }
    }
}

impl Settings {
    /// Which handles are sealed of a part whose quads have some edge length, in the frame of work:
    /// those that were asked for, and of what was made solid those that the grid made, and tunnels
    /// too narrow for quads.
    pub(super) fn sealed_up_to(&self, edge: f64) -> Option<Limits> {
        let asked = match self.handles {
            Handles::Keep => 0.0,
            Handles::SealUpTo(size_pct) => size_pct / 100.0,
        };
        if !self.solid {
            return (asked > 0.0).then(|| Limits::same(asked));
        }
        let any = asked.max(CELLS_ROUND * self.solid_detail / 100.0);
        let tunnels = (EDGES_ROUND * edge).min(WIDEST);
        Some(Limits {
            any,
            tunnels: any.max(tunnels),
        })
    }
}

/// The edges of a short loop in each component that has handles.
pub fn loops(mesh: &TriangleMesh) -> Vec<Vec<[VertexId; 2]>> {
    let components = mesh.named_components(&Progress::none());
    let components = components.expect("nobody cancels").into_iter();
    let found = components.map(|(part, vertices)| {
        let line = short_loop(&part).unwrap_or_default();
        let line = line.into_iter().map(|v| vertices[v.index()]);
        let next = line.clone().cycle().skip(1);
        line.zip(next).map(|(a, b)| [a, b]).collect()
    });
    found.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn what_was_made_solid_has_no_handles_of_a_few_cells() {
        let solid = Settings {
            solid: true,
            solid_detail: 0.5,
            ..Settings::default()
        };
        let sealed = |handles, edge| {
            let settings = Settings {
                handles,
                ..solid.clone()
            };
            let limits = settings.sealed_up_to(edge).unwrap();
            [limits.any, limits.tunnels].map(|size| (1000.0 * size).round() as usize)
        };
        let asked = Handles::SealUpTo;
        assert_eq!(Settings::default().sealed_up_to(0.1), None);
        assert_eq!(sealed(Handles::Keep, 0.001), [30, 30]);
        assert_eq!(sealed(asked(5.0), 0.001), [50, 50]);
        assert_eq!(sealed(asked(1.0), 0.001), [30, 30]);
        // Tunnels that quads have no room in, but none that is a shape.
        assert_eq!(sealed(Handles::Keep, 0.01), [30, 50]);
        assert_eq!(sealed(Handles::Keep, 0.1), [30, 120]);
    }

    #[test]
    fn sizes_of_handles_to_seal_go_from_0_to_10_diagonals() {
        let with = |size_pct| Settings {
            handles: Handles::SealUpTo(size_pct),
            ..Settings::default()
        };
        for size in [-1.0, 1000.5, f64::NAN, f64::INFINITY] {
            let message = with(size).check().unwrap_err().to_string();
            let wanted = format!("the seal size is {size}; it goes from 0 to 1000");
            assert_eq!(message, wanted);
        }
        for size in [0.0, 3.5, MAX_FILL] {
            assert!(with(size).check().is_ok(), "{size}");
        }
    }

    #[test]
    fn a_loop_of_a_torus_closes_and_a_ball_has_none() {
        let torus = shapes::torus(8, 6);
        let found = &loops(&torus)[0];
        assert!((3..=8).contains(&found.len()), "{found:?}");
        for v in found.iter().flatten() {
            assert_eq!(found.iter().flatten().filter(|w| *w == v).count(), 2);
        }
        let ball = shapes::sphere(4);
        assert!(loops(&ball)[0].is_empty());
    }

    #[test]
    fn a_border_is_no_handle() {
        let ball = shapes::sphere(4);
        let some = ball.faces().iter().skip(9).copied();
        let (open, _) = TriangleMesh::of_faces(ball.positions(), some).unwrap();
        assert!(!open.is_closed() && loops(&open)[0].is_empty());
    }
}
