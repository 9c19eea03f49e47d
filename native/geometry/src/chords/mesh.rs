//! Quads on their way to fewer: connections, lines, and what vertices are on them.

use glam::DVec3;

use super::chord::MOST_VALENCE;
use super::leaving::{Leaving, end, valences};
use super::{Fewer, Rules, ids, sorted};
use crate::mesh::{PolygonMesh, VertexId};

/// A line that turns by more than this has a corner: its cosine (50 degrees).
const CORNER: f64 = 0.643;
/// No other side.
pub const NONE: usize = usize::MAX;

/// What a vertex is on.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum On {
    Nothing,
    Line,
    Corner,
    /// On nothing, but the middle of many quads, as of a lid, which stays where it is.
    Pole,
}

impl On {
    /// Whether it stays where it is.
    pub fn stays(self) -> bool {
        self >= Self::Corner
    }
}

/// Of vertices that become one those that weigh most say where it is: corners, then borders, then lines.
pub type Weight = (On, bool);

/// Quads on their way.
#[derive(Clone, Debug)]
pub struct State {
    /// The corners of each quad, counter-clockwise.
    pub quads: Vec<[u32; 4]>,
    /// Where each vertex is now.
    pub places: Vec<DVec3>,
    pub on: Vec<On>,
    /// The edges along lines, borders among them, smaller end first, in order.
    pub lines: Vec<[u32; 2]>,
    pub images: Option<Vec<u32>>,
    /// The vertex that each of the first vertices became.
    pub vertex_of: Vec<u32>,
    /// What each of the first vertices weighed.
    pub first_weights: Vec<Weight>,
    /// Whether a vertex is on a border.
    pub is_open: Vec<bool>,
    pub twins: Vec<usize>,
}

impl State {
    /// None where faces are not quads, two at an edge at most.
    pub fn new(mesh: &PolygonMesh, rules: Rules<'_>) -> Option<Self> {
        let quads: Option<Vec<[u32; 4]>> = mesh
            .faces()
            .map(|face| Some(<[VertexId; 4]>::try_from(face).ok()?.map(|v| v.0)))
            .collect();
        let quads = quads?;
        let n = mesh.n_vertices();
        let twins = twins(&quads, n)?;
        let mut lines: Vec<[u32; 2]> = rules.lines.iter().map(|e| e.map(|v| v.0)).collect();
        lines.extend(borders(&quads, &twins));
        lines.sort_unstable();
        lines.dedup();
        let mut on = on_lines(&lines, mesh.positions());
        for (on, n) in on.iter_mut().zip(valences(&quads, n)) {
            if *on == On::Nothing && n > MOST_VALENCE {
                *on = On::Pole;
            }
        }
        let is_open = is_open(&quads, &twins, n);
        Some(Self {
            places: mesh.positions().to_vec(),
            first_weights: weights(&on, &is_open),
            is_open,
            on,
            lines,
            images: rules
                .images
                .map(|images| images.iter().map(|v| v.0).collect()),
            vertex_of: (0..n as u32).collect(),
            twins,
            quads,
        })
    }

    /// The two ends of a halfedge.
    pub fn ends(&self, h: usize) -> [u32; 2] {
        let quad = self.quads[h / 4];
        [quad[h % 4], quad[(h + 1) % 4]]
    }

    pub fn is_line(&self, edge: [u32; 2]) -> bool {
        self.lines.binary_search(&sorted(edge)).is_ok()
    }

    /// What each vertex weighs.
    pub fn weights(&self) -> Vec<Weight> {
        weights(&self.on, &self.is_open)
    }

    /// How many edges there are less how many vertices and quads: the Euler number, turned round.
    pub fn n_edges_less(&self) -> isize {
        let n_open = self.twins.iter().filter(|&&t| t == NONE).count();
        let n_edges = 2 * self.quads.len() + n_open / 2;
        n_edges as isize - (self.places.len() + self.quads.len()) as isize
    }

    /// What is left, over the first vertices' places.
    pub fn fewer(self, first: &[DVec3]) -> Fewer {
        let places = middles(
            (&self.vertex_of, self.places.len()),
            &self.first_weights,
            first,
        );
        let mut open: Vec<[u32; 2]> = borders(&self.quads, &self.twins).collect();
        open.sort_unstable();
        let inner = self
            .lines
            .iter()
            .filter(|edge| open.binary_search(edge).is_err());
        let lines = inner.map(|&edge| ids(edge)).collect();
        let all = |vertices: Vec<u32>| vertices.into_iter().map(VertexId).collect();
        Fewer {
            quads: PolygonMesh::from_faces(places, &self.quads)
                .expect("quads have corners that exist"),
            lines,
            vertex_of: all(self.vertex_of),
            images: self.images.map(all),
        }
    }
}

fn weights(on: &[On], is_open: &[bool]) -> Vec<Weight> {
    on.iter().copied().zip(is_open.iter().copied()).collect()
}

/// Each of `n` new vertices in the middle of those that weigh most of all that became it.
pub fn middles((new, n): (&[u32], usize), weights: &[Weight], places: &[DVec3]) -> Vec<DVec3> {
    let mut members = vec![Vec::new(); n];
    for (v, &at) in new.iter().enumerate() {
        members[at as usize].push(v);
    }
    let middle = |members: Vec<usize>| {
        let most = members.iter().map(|&v| weights[v]).max();
        let chosen = members.iter().filter(|&&v| Some(weights[v]) == most);
        let (sum, n) = chosen.fold((DVec3::ZERO, 0.0), |(sum, n), &v| {
            (sum + places[v], n + 1.0)
        });
        sum / f64::max(n, 1.0)
    };
    members.into_iter().map(middle).collect()
}

/// The other side of each halfedge, or none at a border; nothing where an edge has a side twice.
pub fn twins(quads: &[[u32; 4]], n_vertices: usize) -> Option<Vec<usize>> {
    let leaving = Leaving::new(quads, n_vertices);
    let twin = |h: usize| {
        let [from, to] = [quads[h / 4][h % 4], end(quads, h)];
        let along = leaving.of(from as usize).iter();
        let is_alone = from != to && along.filter(|&&g| end(quads, g) == to).count() == 1;
        is_alone.then(|| leaving.twin(quads, h).unwrap_or(NONE))
    };
    (0..4 * quads.len()).map(twin).collect()
}

/// The edges with one side, smaller end first.
fn borders(quads: &[[u32; 4]], twins: &[usize]) -> impl Iterator<Item = [u32; 2]> {
    let open = (0..twins.len()).filter(|&h| twins[h] == NONE);
    open.map(|h| sorted([quads[h / 4][h % 4], quads[h / 4][(h + 1) % 4]]))
}

/// Whether each vertex is on a border.
pub fn is_open(quads: &[[u32; 4]], twins: &[usize], n_vertices: usize) -> Vec<bool> {
    let mut is_open = vec![false; n_vertices];
    for v in borders(quads, twins).flatten() {
        is_open[v as usize] = true;
    }
    is_open
}

/// What each vertex is on: a corner where lines meet, end or turn.
fn on_lines(lines: &[[u32; 2]], places: &[DVec3]) -> Vec<On> {
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); places.len()];
    for &[a, b] in lines {
        around[a as usize].push(b);
        around[b as usize].push(a);
    }
    let on = |(v, around): (usize, &Vec<u32>)| {
        let away = |u: u32| (places[u as usize] - places[v]).normalize_or_zero();
        match around[..] {
            [] => On::Nothing,
            [a, b] if -away(a).dot(away(b)) > CORNER => On::Line,
            _ => On::Corner,
        }
    };
    around.iter().enumerate().map(on).collect()
}
