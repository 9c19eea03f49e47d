//! Tubes between loops and their caps.
//!
//! ```text
//!   ,-----.  cap with four singularities, as far from the loop as the tube is long
//!   |     |  tube
//!   '-----'  loop
//! ```
//!
//! Beyond a flush cap's loop there may be no room for the quads round the four singularities that a
//! disc has, and where the loop has corners the cap has them too.

use glam::DVec3;

use super::cap::Sheet;
use crate::measure::{Polyline, area_vector};
use crate::mesh::{HalfedgeId, Id, VertexId};

/// A loop has a tube if its area is no less than this share of the square of its length: a circle has
/// 0.16, a slit none.
const LEAST_OPEN: f64 = 0.01;
/// A surface goes on smoothly into a tube if the cosine of the angle between both is no less in the
/// mean: round a window in a plate it is 0, at the end of a pipe 1.
const SMOOTH: f64 = 0.5;
/// How often the ways of a tube are smoothed along its loop.
const N_SMOOTHINGS: usize = 3;
/// A tube has this many rows of faces at most.
const MOST_ROWS: usize = 8;
/// A loop lies along a line if it is nowhere farther from it than this share of a tube's length.
const ALONG: f64 = 0.2;

/// What lies between loops and their caps.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Tubes {
    /// How long the tubes are; 0 for none.
    pub length: f64,
    /// Whether loops get one too where it turns away from the surface.
    pub everywhere: bool,
    /// Lines along which loops get none but then.
    pub flush: Vec<Polyline>,
}

/// The vertices of a loop, the surface on the right.
struct Ring<'a> {
    vertices: &'a [VertexId],
    points: Vec<DVec3>,
    round: f64,
}

impl Ring<'_> {
    fn next(&self, i: usize) -> usize {
        (i + 1) % self.points.len()
    }

    fn before(&self, i: usize) -> usize {
        (i + self.points.len() - 1) % self.points.len()
    }

    /// The direction across it; none where it encloses nothing.
    fn across(&self) -> Option<DVec3> {
        let n = self.points.len();
        let middle = self.points.iter().sum::<DVec3>() / n as f64;
        let side = |i: usize| [i, self.next(i)].map(|i| self.points[i] - middle);
        let sides = (0..n).map(side);
        let across: DVec3 = sides.map(|[a, b]| a.cross(b)).sum();
        let is_open = across.length() >= LEAST_OPEN * self.round * self.round;
        is_open.then(|| across.normalize_or_zero())
    }
}

impl Sheet<'_> {
    /// Adds a tube that goes on from a loop, and returns its other end; none where it gets none.
    pub(super) fn end_of_tube(
        &mut self,
        vertices: &[VertexId],
        tubes: &Tubes,
    ) -> Option<Vec<VertexId>> {
        if tubes.length <= 0.0 {
            return None;
        }
        let points: Vec<DVec3> = vertices.iter().map(|&v| self.mesh.position(v)).collect();
        let ends = points.iter().zip(points.iter().cycle().skip(1));
        let ring = Ring {
            vertices,
            round: ends.map(|(a, b)| a.distance(*b)).sum(),
            points,
        };
        let lies = |line: &Polyline| {
            let mut places = ring.points.iter();
            places.all(|&p| line.distance(p) <= ALONG * tubes.length)
        };
        if !tubes.everywhere && tubes.flush.iter().any(lies) {
            return None;
        }
        let ways = self.ways(&ring)?;
        let goes_on = tubes.everywhere || self.smoothness(&ring, &ways) >= SMOOTH;
        goes_on.then(|| self.add_tube(&ring, &ways, tubes.length))
    }

    /// Which way a tube goes on from each vertex of a loop: across the loop, but where it runs that way
    /// itself, as along a slit, across the surface. None where the loop encloses nothing.
    fn ways(&self, ring: &Ring<'_>) -> Option<Vec<DVec3>> {
        let across = ring.across()?;
        let n = ring.points.len();
        let way = |i: usize| {
            let along = ring.points[ring.next(i)] - ring.points[ring.before(i)];
            let along = along.normalize_or_zero();
            let aside = across - along * across.dot(along);
            let faces = self.mesh.outgoing(ring.vertices[i]).map(HalfedgeId::face);
            let normal: DVec3 = faces.map(|f| area_vector(self.mesh.triangle(f))).sum();
            aside + normal.normalize_or_zero() * (1.0 - aside.length())
        };
        let mut ways: Vec<DVec3> = (0..n).map(way).collect();
        for _ in 0..N_SMOOTHINGS {
            let mean = |i: usize| ways[ring.before(i)] + 2.0 * ways[i] + ways[ring.next(i)];
            ways = (0..n).map(|i| mean(i) / 4.0).collect();
        }
        let unit = |way: DVec3| way.try_normalize().unwrap_or(across);
        Some(ways.into_iter().map(unit).collect())
    }

    /// The mean cosine between the ways of a tube and those of the surface to its border.
    fn smoothness(&self, ring: &Ring<'_>, ways: &[DVec3]) -> f64 {
        let mut sum = 0.0;
        for (i, way) in ways.iter().enumerate() {
            let [from, to] = [i, ring.next(i)].map(|i| ring.vertices[i]);
            // The surface's own halfedge runs the other way.
            let mut leaving = self.mesh.outgoing(to);
            let Some(h) = leaving.find(|&h| self.mesh.target(h) == from) else {
                continue;
            };
            let edge = ring.points[ring.next(i)] - ring.points[i];
            let normal = area_vector(self.mesh.triangle(h.face())).normalize_or_zero();
            let outward = edge.cross(-normal).normalize_or_zero();
            sum += edge.length() * outward.dot(*way);
        }
        sum / ring.round.max(f64::MIN_POSITIVE)
    }

    fn add_tube(&mut self, ring: &Ring<'_>, ways: &[DVec3], length: f64) -> Vec<VertexId> {
        let n = ring.points.len();
        let rows = length * n as f64 / ring.round.max(f64::MIN_POSITIVE);
        let n_rows = (rows.round() as usize).clamp(1, MOST_ROWS);
        let first = self.faces.len();
        let mut last = ring.vertices.to_vec();
        for row in 1..=n_rows {
            let far = length * row as f64 / n_rows as f64;
            let start = self.positions.len();
            let moved = ring.points.iter().zip(ways);
            self.positions.extend(moved.map(|(p, way)| p + way * far));
            let ids = (start..self.positions.len()).map(VertexId::from_index);
            let end: Vec<VertexId> = ids.collect();
            for i in 0..n {
                let next = ring.next(i);
                let [a, b, c, d] = [last[i], last[next], end[next], end[i]];
                self.faces.extend([[a, b, c], [a, c, d]]);
            }
            last = end;
        }
        self.tubes.push(first..self.faces.len());
        last
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::close::tests::{sampled, star, vessel};
    use crate::close::{Settings, Way, close};
    use crate::mesh::TriangleMesh;
    use crate::progress::Progress;

    fn tubes(everywhere: bool) -> Tubes {
        Tubes {
            length: 0.5,
            everywhere,
            ..Tubes::default()
        }
    }

    /// How far beyond a vessel's rim its closed version reaches.
    fn height(mesh: &TriangleMesh, tubes: Tubes) -> f64 {
        let settings = Settings {
            way: Way::Cap,
            tubes,
            ..Settings::default()
        };
        let closed = close(mesh, &settings, &Progress::none()).unwrap();
        closed.mesh.check().unwrap();
        assert!(closed.mesh.is_closed());
        assert_eq!(closed.mesh.euler_number(), 2);
        assert_eq!(&closed.mesh.faces()[..mesh.n_faces()], mesh.faces());
        let heights = closed.mesh.positions().iter().map(|p| p.z);
        heights.fold(f64::MIN, f64::max)
    }

    #[test]
    fn a_pipe_goes_on_into_its_tube_and_caps_lie_at_the_end() {
        for rim in [
            star(24, 0.0),
            sampled(&[[0., 0.], [2., 0.], [2., 1.], [0., 1.]], 0.2),
        ] {
            let pipe = vessel(&rim, 4.0);
            assert!(height(&pipe, Tubes::default()).abs() < 1e-9);
            for everywhere in [false, true] {
                assert!((height(&pipe, tubes(everywhere)) - 0.5).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_rim_that_turns_away_has_a_tube_only_everywhere() {
        // A vessel whose walls stand at an angle of more than 60° to the way out.
        let rim = star(24, 0.0);
        let deep = vessel(&rim, 0.5);
        let wide = deep.positions().iter().enumerate();
        let narrow = |(i, p): (usize, &DVec3)| if i < 24 { *p } else { *p * 0.2 };
        let bowl = deep.with_positions(wide.map(narrow).collect());
        assert!(height(&bowl, tubes(false)).abs() < 1e-9);
        assert!(height(&bowl, tubes(true)) > 0.4);
    }

    #[test]
    fn a_loop_along_a_given_line_stays_flush() {
        let rim = star(24, 0.0);
        let pipe = vessel(&rim, 4.0);
        let round = rim.iter().chain(rim.first()).copied().collect();
        let tubes = Tubes {
            flush: vec![Polyline::new(round, true)],
            ..tubes(false)
        };
        assert!(height(&pipe, tubes).abs() < 1e-9);
    }
}
