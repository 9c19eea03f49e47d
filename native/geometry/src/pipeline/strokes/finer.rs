//! Where strokes want smaller quads: a small ring has no room inside for the irregular vertices that it
//! needs there, nor enough edges to be round.

use glam::DVec3;

use super::OnPart;
use crate::guidance::Strength;
use crate::measure::Polyline;

/// A ring is to have so many edges: of fewer than eight hardly any is met; at 20 sizes differ so much
/// that no whole periods are found where a body has five rings.
const EDGES_ROUND: f64 = 16.0;
/// Edges are to be shorter by this factor at most; at 2.5 as with 20 edges.
const FINEST: f64 = 2.0;
/// Points of a ring are so far apart, in edges of a quad.
const STEP: f64 = 0.5;

/// The rings on a part that are small for its quads.
pub struct Finer(Vec<Ring>);

struct Ring {
    line: Polyline,
    /// By which factor edges are to be shorter.
    factor: f64,
    radius: f64,
}

impl Finer {
    /// Those among some strokes, for quads of some edge length.
    pub fn new(strokes: OnPart<'_>, edge: f64) -> Self {
        let closed = strokes.all().iter().filter(|s| s.is_closed);
        let rings = closed
            .filter(|s| s.strength == Strength::Exact)
            .filter_map(|stroke| {
                let length = stroke.length();
                let factor = (EDGES_ROUND * edge / length).clamp(1.0, FINEST);
                let mut points = stroke.spaced(STEP * edge);
                points.push(points[0]);
                (factor > 1.0).then(|| Ring {
                    line: Polyline::new(points, true),
                    factor,
                    radius: length / std::f64::consts::TAU,
                })
            });
        Self(rings.collect())
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// By which factor edges are to be shorter at a place: all inside a ring, less outside it.
    pub fn at(&self, place: DVec3) -> f64 {
        let factors = self.0.iter().map(|ring| {
            let away = ring.line.distance(place) / ring.radius;
            let share = (2.0 - away / 1.5).clamp(0.0, 1.0);
            1.0 + (ring.factor - 1.0) * share
        });
        factors.fold(1.0, f64::max)
    }
}
