//! Draws a loop tight on the surface, across faces and past vertices.
//!
//! The loop becomes a line over faces that crosses edges, at first just left of its vertices. Every
//! crossing moves along its edge to where the line is straight, in turn; where a line is held at a
//! vertex that it would pass more shortly on the other side, it is led round that side.

use std::collections::VecDeque;

use glam::DVec3;

use super::slit::fan;
use super::split::Place;
use crate::measure::angle_between;
use crate::mesh::{HalfedgeId, TriangleMesh, VertexId};

/// Crossings stay so far from the ends of their edges, as shares of these: nearer, a crossing has
/// no way out any more, as those beside it are there too.
const LEAST: f64 = 0.02;
/// And so far from ends on a border, so that there is a lane between the two.
const LANE: f64 = 0.35;
/// At most so many rounds of sweeps: what is left then are bends over hundreds of faces.
const MOST_ROUNDS: usize = 400;
/// A round in which no crossing moves by more than this share of its edge is the last.
const SETTLED: f64 = 1e-4;

/// Where a line passes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Stop {
    /// A vertex.
    Vertex(VertexId),
    /// A place on an edge, from the face of the halfedge to that of its twin.
    Edge(Place),
}

impl Stop {
    /// Where it is.
    pub fn position(self, mesh: &TriangleMesh) -> DVec3 {
        match self {
            Self::Vertex(v) => mesh.position(v),
            Self::Edge(Place { edge, share }) => {
                let [a, b] = ends(mesh, edge).map(|v| mesh.position(v));
                a.lerp(b, share)
            }
        }
    }
}

/// The two ends of an edge.
pub fn ends(mesh: &TriangleMesh, h: HalfedgeId) -> [VertexId; 2] {
    [mesh.origin(h), mesh.target(h)]
}

/// A closed line along which a loop of inner vertices is tight; it keeps to some of these.
pub fn tighten(
    mesh: &TriangleMesh,
    line: &[VertexId],
    is_kept: impl Fn(usize) -> bool,
) -> Vec<Stop> {
    let mut tight = Tight {
        mesh,
        stops: VecDeque::new(),
    };
    for (i, &v) in line.iter().enumerate() {
        if is_kept(i) {
            tight.stops.push_back(Stop::Vertex(v));
            continue;
        }
        let [from, to] = [
            line[(i + line.len() - 1) % line.len()],
            line[(i + 1) % line.len()],
        ];
        // The first of the fan leads along the loop.
        let crossed = fan(mesh, [from, v, to]).into_iter().skip(1).rev();
        for edge in crossed {
            tight.stops.push_back(middle(edge));
        }
    }
    for _ in 0..MOST_ROUNDS {
        let moved = tight.sweep();
        let is_led = tight.lead_round();
        if !is_led && moved < SETTLED {
            break;
        }
    }
    tight.stops.into()
}

struct Tight<'a> {
    mesh: &'a TriangleMesh,
    stops: VecDeque<Stop>,
}

impl Tight<'_> {
    /// How near a crossing may come to the two ends of its edge.
    fn bounds(&self, edge: HalfedgeId) -> [f64; 2] {
        let [low, high] =
            ends(self.mesh, edge).map(|v| if self.mesh.is_border(v) { LANE } else { LEAST });
        [low, 1.0 - high]
    }

    /// A crossing within its bounds.
    fn held(&self, Place { edge, share }: Place) -> Stop {
        let [low, high] = self.bounds(edge);
        let share = share.clamp(low, high);
        Stop::Edge(Place { edge, share })
    }

    /// Straightens the line at every crossing, there and back; how far one moved at most.
    fn sweep(&mut self) -> f64 {
        let n = self.stops.len();
        let mut most: f64 = 0.0;
        for i in (0..n).chain((0..n).rev()) {
            let Stop::Edge(place) = self.stops[i] else {
                continue;
            };
            let beside = [self.stops[(i + n - 1) % n], self.stops[(i + 1) % n]];
            if let Some(share) = self.straight(place.edge, beside) {
                let moved = self.held(Place { share, ..place });
                if let Stop::Edge(Place { share, .. }) = moved {
                    most = most.max((share - place.share).abs());
                }
                self.stops[i] = moved;
            }
        }
        most
    }

    /// Where a straight line between points of the two faces at an edge crosses it.
    fn straight(&self, edge: HalfedgeId, beside: [Stop; 2]) -> Option<f64> {
        let [a, b] = ends(self.mesh, edge).map(|v| self.mesh.position(v));
        let along = (b - a).try_normalize()?;
        let [(x, up), (z, down)] = beside.map(|stop| {
            let from = stop.position(self.mesh) - a;
            let x = from.dot(along);
            (x, (from - along * x).length())
        });
        let share = (x * down + z * up) / (up + down) / a.distance(b);
        share.is_finite().then_some(share)
    }

    /// Leads the line round the other side of vertices that hold it, where that is shorter.
    fn lead_round(&mut self) -> bool {
        let mut is_led = false;
        for _ in 0..self.stops.len() {
            if let Some(held) = self.held_at_first() {
                self.pass(&held);
                is_led = true;
            }
            if !self.stops.is_empty() {
                self.stops.rotate_left(1);
            }
        }
        if is_led {
            self.cancel();
        }
        is_led
    }

    /// The vertex that holds the line from the first stop on, if it is shorter on the other side.
    fn held_at_first(&self) -> Option<Held> {
        let Stop::Edge(first) = self.stops[0] else {
            return None;
        };
        let held = [0, 1].map(|side| self.held_at(ends(self.mesh, first.edge)[side], side));
        held.into_iter().flatten().next()
    }

    /// The same for an end of the first crossing's edge.
    fn held_at(&self, vertex: VertexId, side: usize) -> Option<Held> {
        let at = |stop: &Stop| match stop {
            Stop::Edge(place) => ends(self.mesh, place.edge).contains(&vertex),
            Stop::Vertex(_) => false,
        };
        let n = self.stops.iter().take_while(|stop| at(stop)).count();
        let is_run = n < self.stops.len() && !self.stops.back().is_some_and(at);
        let held = Held { vertex, side, n };
        let is_free = is_run && !self.mesh.is_border(vertex);
        (is_free && self.is_shorter(&held)).then_some(held)
    }

    /// Whether a vertex is in the way of a straight line, and not on its other side.
    fn is_shorter(&self, held: &Held) -> bool {
        let mesh = self.mesh;
        let at = mesh.position(held.vertex);
        let ray = |stop: &Stop| match stop {
            Stop::Edge(place) => mesh.position(ends(mesh, place.edge)[1 - held.side]) - at,
            Stop::Vertex(v) => mesh.position(*v) - at,
        };
        let before = self.stops[self.stops.len() - 1].position(mesh) - at;
        let after = self.stops[held.n].position(mesh) - at;
        let inner = self.stops.iter().take(held.n).map(ray);
        let rays: Vec<DVec3> = [before].into_iter().chain(inner).chain([after]).collect();
        let own: f64 = rays.windows(2).map(|w| angle_between(w[0], w[1])).sum();
        let whole = mesh.outgoing(held.vertex).map(|h| {
            let [a, b] = [mesh.target(h), mesh.origin(h.prev())].map(|v| mesh.position(v));
            angle_between(a - at, b - at)
        });
        let other = whole.sum::<f64>() - own;
        let straight = std::f64::consts::PI;
        other < straight - 1e-6 && own > straight
    }

    /// Leads the line round the other side of a vertex.
    fn pass(&mut self, held: &Held) {
        let edge = |stop: &Stop| match stop {
            Stop::Edge(place) => place.edge,
            Stop::Vertex(_) => unreachable!("only crossings are held"),
        };
        let first = edge(&self.stops[0]);
        let last = edge(&self.stops[held.n - 1]);
        let to = self.mesh.twin(last).map(HalfedgeId::face);
        self.stops.drain(..held.n);
        let turn = |h: HalfedgeId| if held.side == 0 { h.prev() } else { h.next() };
        let mut crossed = Vec::new();
        let mut h = turn(first);
        while Some(h.face()) != to {
            crossed.push(middle(h));
            h = turn(self.mesh.twin(h).expect("the vertex is inside"));
        }
        for stop in crossed.into_iter().rev() {
            self.stops.push_front(stop);
        }
    }

    /// Takes out what crosses an edge and comes back.
    fn cancel(&mut self) {
        let is_back = |a: Option<&Stop>, b: Option<&Stop>| match (a, b) {
            (Some(Stop::Edge(a)), Some(Stop::Edge(b))) => self.mesh.twin(a.edge) == Some(b.edge),
            _ => false,
        };
        let mut kept: VecDeque<Stop> = VecDeque::with_capacity(self.stops.len());
        for stop in &self.stops {
            if is_back(kept.back(), Some(stop)) {
                kept.pop_back();
            } else {
                kept.push_back(*stop);
            }
        }
        while kept.len() > 1 && is_back(kept.back(), kept.front()) {
            kept.pop_back();
            kept.pop_front();
        }
        self.stops = kept;
    }
}

/// Where crossings begin: near the ends their way would be long, many small steps round a vertex.
fn middle(edge: HalfedgeId) -> Stop {
    Stop::Edge(Place { edge, share: 0.5 })
}

/// A vertex that holds a line.
struct Held {
    vertex: VertexId,
    /// Which end of the first crossings' halfedges it is.
    side: usize,
    /// How many crossings it holds.
    n: usize,
}
