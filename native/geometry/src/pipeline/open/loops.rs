//! The loops of a border and their corners.

use glam::DVec3;

use crate::groups::Groups;
use crate::measure::{FeatureLine, Polyline, angle_between};
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId};

/// A border has a corner where it turns by more than this from one half of an edge of a quad to the
/// next (50°).
const CORNER: f64 = 0.87;
/// Two corners nearer to each other than this many edges that turn opposite ways are a step too low
/// for a quad, and none.
const STEP: f64 = 1.0;
/// How far it is looked to either side, in edges of quads.
const REACH: f64 = 0.5;
/// But no farther than this share of the loop.
const MOST_OF_LOOP: f64 = 0.1;
/// A corner of the part belongs to a vertex of the map's mesh no farther away, in edges of quads.
const NEAR: f64 = 1.0;

/// The loops of a border, vertex by vertex.
#[derive(Clone, Debug)]
pub struct Loops(Vec<Vec<VertexId>>);

impl Loops {
    /// All borders of an open mesh.
    pub fn all(open: &TriangleMesh) -> Self {
        Self::new(open, &HalfedgeMap::filled(3 * open.n_faces(), true))
    }

    /// Those of an open mesh that are still borders once it is closed.
    pub fn new(open: &TriangleMesh, border: &HalfedgeMap<bool>) -> Self {
        let loops = open.border_loops().into_iter();
        let left = loops.filter(|edges| border[edges[0]]);
        Self(
            left.map(|edges| edges.iter().map(|&h| open.origin(h)).collect())
                .collect(),
        )
    }

    /// How long they are.
    pub fn lengths(&self, mesh: &TriangleMesh) -> Vec<f64> {
        self.closed_lines(mesh).map(|line| line.length()).collect()
    }

    /// They as closed lines, the faces on the left.
    pub fn closed_lines(&self, mesh: &TriangleMesh) -> impl Iterator<Item = Polyline> {
        self.0
            .iter()
            .map(move |border| super::polyline(mesh, border))
    }

    /// Where they have corners for quads of some edge length; so they have in any case at some places.
    pub fn corners(&self, mesh: &TriangleMesh, (edge, places): (f64, &[DVec3])) -> Vec<DVec3> {
        let bends = self.0.iter().map(|border| Bends::new(mesh, border, edge));
        bends
            .flat_map(|bends| bends.points_at(&bends.corners(places)))
            .collect()
    }

    /// The same without steps that are lower than a quad.
    pub fn calm_corners(&self, mesh: &TriangleMesh, (edge, places): (f64, &[DVec3])) -> Vec<DVec3> {
        let bends = self.0.iter().map(|border| Bends::new(mesh, border, edge));
        let calm = |bends: Bends| {
            let corners = bends.corners(places);
            bends.points_at(&bends.without_steps(&corners, (edge, places)))
        };
        bends.flat_map(calm).collect()
    }

    /// The loops from corner to corner: each corner's nearest vertex is one, if it is near. Each line
    /// comes with the places of its ends; those that go round have none.
    pub fn lines(&self, mesh: &TriangleMesh, (corners, edge): (&[DVec3], f64)) -> Vec<Between> {
        let near = (NEAR * edge).powi(2);
        let mut ends: Vec<Vec<Option<DVec3>>> = self
            .0
            .iter()
            .map(|border| vec![None; border.len()])
            .collect();
        for &corner in corners {
            let all = self.0.iter().enumerate();
            let all = all.flat_map(|(i, border)| (0..border.len()).map(move |k| (i, k)));
            let away =
                |&(i, k): &(usize, usize)| mesh.position(self.0[i][k]).distance_squared(corner);
            let free = all.filter(|&(i, k)| ends[i][k].is_none());
            let nearest = free.min_by(|a, b| away(a).total_cmp(&away(b)));
            if let Some((i, k)) = nearest.filter(|at| away(at) <= near) {
                ends[i][k] = Some(corner);
            }
        }
        let loops = self.0.iter().zip(&ends);
        loops
            .flat_map(|(border, ends)| between(mesh, border, ends))
            .collect()
    }
}

/// Edges on both sides of each, those that hang together in one list.
pub fn chains(mesh: &TriangleMesh, is_on: &HalfedgeMap<bool>) -> Vec<Vec<HalfedgeId>> {
    let on = || mesh.halfedge_ids().filter(|&h| is_on[h]);
    let mut groups = Groups::new(mesh.n_vertices());
    for h in on() {
        groups.link(mesh.origin(h).index(), mesh.target(h).index());
    }
    let (group, n_groups) = groups.numbered();
    let mut chains = vec![Vec::new(); n_groups];
    for h in on() {
        chains[group[mesh.origin(h).index()] as usize].push(h);
    }
    chains.retain(|chain| !chain.is_empty());
    chains
}

/// A line along a border.
#[derive(Clone, Debug)]
pub struct Between {
    pub line: FeatureLine,
    /// The corners where its ends belong; none where it goes round.
    pub ends: Option<[DVec3; 2]>,
}

fn between(mesh: &TriangleMesh, border: &[VertexId], ends: &[Option<DVec3>]) -> Vec<Between> {
    let n = border.len();
    let at: Vec<usize> = (0..n).filter(|&i| ends[i].is_some()).collect();
    let along = |from: usize, n_edges: usize| {
        let vertices = (0..=n_edges).map(|i| border[(from + i) % n]).collect();
        FeatureLine::new(mesh, vertices)
    };
    let Some(&first) = at.first() else {
        return vec![Between {
            line: along(0, n),
            ends: None,
        }];
    };
    let after = at.iter().skip(1).copied().chain([first + n]);
    at.iter()
        .zip(after)
        .map(|(&from, to)| Between {
            line: along(from, to - from),
            ends: ends[from].zip(ends[to % n]).map(|(a, b)| [a, b]),
        })
        .collect()
}

/// How a loop turns.
struct Bends {
    points: Vec<DVec3>,
    /// The length up to each point, and that of the whole.
    lengths: Vec<f64>,
    reach: f64,
}

impl Bends {
    fn new(mesh: &TriangleMesh, border: &[VertexId], edge: f64) -> Self {
        let points: Vec<DVec3> = border.iter().map(|&v| mesh.position(v)).collect();
        let mut lengths = vec![0.0];
        for i in 0..points.len() {
            let next = points[(i + 1) % points.len()];
            lengths.push(lengths[i] + points[i].distance(next));
        }
        let whole = lengths[points.len()];
        Self {
            points,
            lengths,
            reach: (REACH * edge).min(MOST_OF_LOOP * whole),
        }
    }

    fn whole(&self) -> f64 {
        self.lengths[self.points.len()]
    }

    /// The point at a length, round and round.
    fn at(&self, length: f64) -> DVec3 {
        let length = length.rem_euclid(self.whole().max(f64::MIN_POSITIVE));
        let after = self.lengths.partition_point(|&l| l <= length);
        let i = after.saturating_sub(1).min(self.points.len() - 1);
        let step = self.lengths[i + 1] - self.lengths[i];
        let share = if step > 0.0 {
            (length - self.lengths[i]) / step
        } else {
            0.0
        };
        self.points[i].lerp(
            self.points[(i + 1) % self.points.len()],
            share.clamp(0.0, 1.0),
        )
    }

    /// The ways up to a point and from it on.
    fn ways(&self, i: usize) -> [DVec3; 2] {
        let [before, after] = [-self.reach, self.reach].map(|d| self.at(self.lengths[i] + d));
        [self.points[i] - before, after - self.points[i]]
    }

    fn turn(&self, i: usize) -> f64 {
        let [before, after] = self.ways(i);
        angle_between(before, after)
    }

    /// What it turns about at a point.
    fn axis(&self, i: usize) -> DVec3 {
        let [before, after] = self.ways(i);
        before.cross(after)
    }

    /// The points that turn most within reach, of those that turn by more than a corner does, and those
    /// at some places.
    fn corners(&self, places: &[DVec3]) -> Vec<usize> {
        let n = self.points.len();
        let turns: Vec<f64> = (0..n).map(|i| self.turn(i)).collect();
        let mut order: Vec<usize> = (0..n).filter(|&i| turns[i] > CORNER).collect();
        order.sort_by(|&a, &b| turns[b].total_cmp(&turns[a]).then(a.cmp(&b)));
        let mut taken: Vec<usize> = (0..n)
            .filter(|&i| places.contains(&self.points[i]))
            .collect();
        for i in order {
            if taken.iter().all(|&j| self.apart(i, j) > self.reach) {
                taken.push(i);
            }
        }
        taken.sort_unstable();
        taken
    }

    /// Some corners but for those near each other that turn opposite ways.
    fn without_steps(&self, corners: &[usize], (edge, places): (f64, &[DVec3])) -> Vec<usize> {
        let n = corners.len();
        let is_step = |a: usize, b: usize| {
            let [one, other] = [corners[a], corners[b]];
            let is_near = self.apart(one, other) < STEP * edge;
            a != b && is_near && self.axis(one).dot(self.axis(other)) < 0.0
        };
        let stays = |&a: &usize| {
            if places.contains(&self.points[corners[a]]) {
                return true;
            }
            let beside = [(a + n - 1) % n, (a + 1) % n];
            !beside.into_iter().any(|b| is_step(a, b))
        };
        (0..n).filter(stays).map(|a| corners[a]).collect()
    }

    /// How far two points are from each other along the loop.
    fn apart(&self, a: usize, b: usize) -> f64 {
        let apart = (self.lengths[a] - self.lengths[b]).abs();
        apart.min(self.whole() - apart)
    }

    fn points_at(&self, corners: &[usize]) -> Vec<DVec3> {
        corners.iter().map(|&i| self.points[i]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    /// A flat grid of n × n squares, its middle at the origin.
    fn grid(n: u32) -> TriangleMesh {
        let cube = shapes::cuboid(n);
        let top = cube
            .positions()
            .iter()
            .map(|p| p.z)
            .fold(f64::MIN, f64::max);
        let lies = |v: &VertexId| (cube.position(*v).z - top).abs() < 1e-9;
        let faces = cube.faces().iter().filter(|face| face.iter().all(lies));
        TriangleMesh::of_faces(cube.positions(), faces.copied())
            .unwrap()
            .0
    }

    #[test]
    fn a_rectangle_has_four_corners_and_a_circle_none() {
        let mesh = grid(8);
        let border = HalfedgeMap::filled(3 * mesh.n_faces(), true);
        let loops = Loops::new(&mesh, &border);
        let corners = loops.corners(&mesh, (0.1, &[]));
        assert_eq!(corners.len(), 4);
        let lines = loops.lines(&mesh, (&corners, 0.1));
        assert_eq!(lines.len(), 4);
        for line in &lines {
            assert_eq!(line.line.vertices.len(), 9);
            let [a, b] = line.ends.unwrap();
            assert_eq!(mesh.position(line.line.vertices[0]), a);
            assert_eq!(mesh.position(line.line.vertices[8]), b);
        }
        let ball = shapes::sphere(12);
        let half = ball.faces().iter();
        let half = half.filter(|f| f.iter().all(|&v| ball.position(v).z > -1e-9));
        let (half, _) = TriangleMesh::of_faces(ball.positions(), half.copied()).unwrap();
        let border = HalfedgeMap::filled(3 * half.n_faces(), true);
        let loops = Loops::new(&half, &border);
        assert!(loops.corners(&half, (0.4, &[])).is_empty());
        let lines = loops.lines(&half, (&[], 0.4));
        assert!(
            lines
                .iter()
                .all(|line| line.line.is_closed() && line.ends.is_none())
        );
    }

    #[test]
    fn a_step_lower_than_a_quad_has_no_calm_corners() {
        let mesh = grid(16);
        // The vertices of one half of a side are drawn out.
        let [low, high] = crate::mesh::bounds(mesh.positions());
        let width = high.x - low.x;
        let drawn = |p: &DVec3| {
            let is_out = p.x > high.x - 1e-9 && p.y > low.y + 0.45 * width;
            *p + DVec3::X * if is_out { 0.12 * width } else { 0.0 }
        };
        let stepped = mesh.with_positions(mesh.positions().iter().map(drawn).collect());
        let loops = Loops::all(&stepped);
        let corners = |edge: f64| loops.corners(&stepped, (edge * width, &[])).len();
        let calm = |edge: f64| loops.calm_corners(&stepped, (edge * width, &[])).len();
        assert_eq!([corners(0.2), calm(0.2)], [6, 4]);
        assert_eq!([corners(0.1), calm(0.1)], [6, 6]);
    }
}
