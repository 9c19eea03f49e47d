//! A row of quads on both sides of edges that run to and fro across a line.
//!
//! A sheet that goes on across a line may have no edges along it. Any way of edges near it will do:
//! each of its vertices gets copies, one for each side, the faces of that side take it, and a quad
//! goes between each edge and its copy on either side. So the way can be laid on the line, however
//! it ran, and four quads meet at each of its vertices. Where a way ends inside the sheet, the quads
//! ahead of its last vertex are cut in three:
//!
//! ```text
//!            z ──── x        z ────── x
//!            │      │        │ ╲    ╱ │          p the way's last vertex,
//!            │      │   →    │   c ─  x'        x, y the vertices ahead and beside it
//!            y ──── p        y ─ y' ─ p
//! ```

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::Leveling;
use crate::mesh::{Id, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::rejoin::chain::Chain;
use crate::rejoin::{Edge, Line, area, sorted};

/// How far copies are from the line, as a share of the way to their neighbours.
const ASIDE: f64 = 0.5;
/// A corner is too flat or turned if the sine of its angle is less.
const FLAT: f64 = 0.17;

/// What becomes of the vertices of some ways.
#[derive(Default)]
struct Copies {
    /// The copy between a vertex of a way and one beside it.
    beside: BTreeMap<Edge, VertexId>,
    /// The copies of the first vertex of an edge on the left and on the right of it.
    left: BTreeMap<Edge, VertexId>,
    right: BTreeMap<Edge, VertexId>,
    /// What faces have instead of a vertex, by the face and the place in it.
    instead: BTreeMap<(usize, usize), VertexId>,
    /// The faces ahead of ends: the place of the end, and its copies after and before it.
    ahead: BTreeMap<usize, (usize, Edge)>,
}

/// The faces and neighbours round a vertex, in order; a face between each two neighbours.
struct Fan {
    neighbours: Vec<VertexId>,
    /// Each by the place of the vertex in it.
    faces: Vec<(usize, usize)>,
    is_closed: bool,
}

impl Leveling {
    /// Lays the ways of sheets that go on across lines on these, in rows of quads where that needs any.
    pub(super) fn pillow(
        &mut self,
        lines: &[Line],
        progress: &Progress<'_>,
    ) -> Result<(), Cancelled> {
        for sheet in 0..self.faces.len() {
            progress.check()?;
            if !self.are_quads[sheet] {
                continue;
            }
            let ways = self.rough_ways(sheet, lines);
            if ways.is_empty() {
                continue;
            }
            let mut edges: BTreeSet<Edge> = BTreeSet::new();
            let mut goals: BTreeMap<VertexId, DVec3> = BTreeMap::new();
            for &(line, k) in &ways {
                let chain = &self.chains[line][k];
                edges.extend(chain.edges());
                goals.extend(even_goals(chain, &lines[line]));
            }
            if let Some(copies) = self.copies((sheet, &edges), &goals) {
                self.put(sheet, &edges, &copies);
                for (v, goal) in goals {
                    self.places[v.index()] = goal;
                }
                for (line, k) in ways {
                    self.chains[line][k].is_changed = false;
                }
                self.is_changed[sheet] = true;
            }
        }
        Ok(())
    }

    /// The chains of a sheet that goes on there, if one of those that hang together cannot be laid on
    /// its line as it is.
    fn rough_ways(&self, sheet: usize, lines: &[Line]) -> Vec<(usize, usize)> {
        let mut through: Vec<(usize, usize)> = Vec::new();
        for (line, chains) in self.chains.iter().enumerate() {
            let own = chains.iter().enumerate();
            let own = own.filter(|(_, c)| c.sheet == sheet && !c.is_border);
            through.extend(own.map(|(k, _)| (line, k)));
        }
        let chain = |&(line, k): &(usize, usize)| &self.chains[line][k];
        let is_rough = |way: &(usize, usize)| self.is_rough(chain(way), &lines[way.0]);
        let mut rough: Vec<(usize, usize)> = through.iter().copied().filter(is_rough).collect();
        loop {
            let on: BTreeSet<VertexId> = rough
                .iter()
                .flat_map(|way| chain(way).vertices.clone())
                .collect();
            let is_more = |way: &&(usize, usize)| {
                !rough.contains(way) && chain(way).vertices.iter().any(|v| on.contains(v))
            };
            let more: Vec<(usize, usize)> = through.iter().filter(is_more).copied().collect();
            if more.is_empty() {
                return rough;
            }
            rough.extend(more);
        }
    }

    /// Whether faces beside a chain are folded or flat once it lies on its line and were not before.
    fn is_rough(&self, chain: &Chain, line: &Line) -> bool {
        let last = chain.vertices.len() - 1;
        let goal = |(i, &v): (usize, &VertexId)| {
            let place = match i {
                0 if !chain.is_closed => line.points[0],
                i if i == last && !chain.is_closed => line.points[line.points.len() - 1],
                _ => line.closest(self.place(v)),
            };
            (v, place)
        };
        let goals: BTreeMap<VertexId, DVec3> =
            chain.vertices.iter().enumerate().map(goal).collect();
        let faces = self.faces[chain.sheet].iter();
        let mut beside = faces.filter(|face| face.iter().any(|v| goals.contains_key(v)));
        beside.any(|face| {
            let before: Vec<DVec3> = face.iter().map(|&v| self.place(v)).collect();
            let moved = face.iter().zip(&before);
            let moved = moved.map(|(v, &p)| goals.get(v).copied().unwrap_or(p));
            let moved: Vec<DVec3> = moved.collect();
            let normal = area(&before);
            n_flat(&moved, normal) > n_flat(&before, normal)
        })
    }

    /// The faces round a vertex, from one neighbour on if it has faces on all sides.
    fn fan(&self, sheet: usize, corners: &[(usize, usize)], first: Option<VertexId>) -> Fan {
        let next = |&(f, i): &(usize, usize)| self.faces[sheet][f][(i + 1) % 4];
        let before = |&(f, i): &(usize, usize)| self.faces[sheet][f][(i + 3) % 4];
        let from: BTreeMap<VertexId, (usize, usize)> = corners
            .iter()
            .map(|corner| (next(corner), *corner))
            .collect();
        let ends: BTreeSet<VertexId> = corners.iter().map(before).collect();
        let open = from.keys().copied().find(|v| !ends.contains(v));
        let start = open.or(first).or_else(|| from.keys().next().copied());
        let mut fan = Fan {
            neighbours: start.into_iter().collect(),
            faces: Vec::new(),
            is_closed: open.is_none(),
        };
        let mut at = start;
        while let Some(corner) = at.and_then(|v| from.get(&v)) {
            fan.faces.push(*corner);
            at = Some(before(corner));
            if fan.is_closed && at == start || fan.faces.len() > corners.len() {
                break;
            }
            fan.neighbours.extend(at);
        }
        fan
    }

    /// Copies of the vertices of some ways of edges; none where a face or fan is in the way.
    fn copies(
        &mut self,
        (sheet, edges): (usize, &BTreeSet<Edge>),
        goals: &BTreeMap<VertexId, DVec3>,
    ) -> Option<Copies> {
        let mut corners: BTreeMap<VertexId, Vec<(usize, usize)>> = BTreeMap::new();
        for (f, face) in self.faces[sheet].iter().enumerate() {
            for (i, v) in face
                .iter()
                .enumerate()
                .filter(|(_, v)| goals.contains_key(v))
            {
                corners.entry(*v).or_default().push((f, i));
            }
        }
        let mut copies = Copies::default();
        for (&p, of_one) in &corners {
            let is_on = |x: VertexId| edges.contains(&sorted([p, x]));
            let near = of_one
                .iter()
                .map(|&(f, i)| self.faces[sheet][f][(i + 1) % 4]);
            let first = near.into_iter().find(|&x| is_on(x));
            let fan = self.fan(sheet, of_one, first);
            if fan.faces.len() != of_one.len() {
                return None;
            }
            let n_on = fan.neighbours.iter().filter(|&&x| is_on(x)).count();
            if n_on == 1 && fan.is_closed {
                self.cap((p, goals[&p]), &fan, &mut copies)?;
            } else {
                self.part((sheet, p, goals[&p]), (&fan, edges), &mut copies);
            }
        }
        Some(copies)
    }

    /// A copy of a vertex of a way for each side, where others go on from it.
    fn part(
        &mut self,
        (sheet, p, goal): (usize, VertexId, DVec3),
        (fan, edges): (&Fan, &BTreeSet<Edge>),
        copies: &mut Copies,
    ) {
        let n = fan.neighbours.len();
        let is_on = |x: VertexId| edges.contains(&sorted([p, x]));
        let mut at = 0;
        while at < fan.faces.len() {
            // From one edge of a way to the next.
            let mut to = at + 1;
            while to < fan.faces.len() && !is_on(fan.neighbours[to % n]) {
                to += 1;
            }
            let around = (at..=to).map(|i| fan.neighbours[i % n]);
            let beside: Vec<VertexId> = around.filter(|&x| !is_on(x)).collect();
            let is_border = |i: usize| !fan.is_closed && (i == 0 || i == fan.faces.len());
            // Copies of what lies on a border do too.
            let on_border = [at, to].into_iter().filter(|&i| is_border(i));
            let on_border: Vec<VertexId> = on_border.map(|i| fan.neighbours[i % n]).collect();
            let across: Vec<VertexId> = fan.faces[at..to]
                .iter()
                .map(|&(f, i)| self.faces[sheet][f][(i + 2) % 4])
                .collect();
            let towards = [&on_border, &beside, &across];
            let towards = towards.into_iter().find(|of| !of.is_empty());
            let towards = towards.expect("a face has a corner across");
            let middle = towards.iter().map(|&x| self.place(x)).sum::<DVec3>();
            let place = goal.lerp(middle / towards.len() as f64, ASIDE);
            let copy = self.add(place, [p, towards[0]]);
            copies.beside.extend(beside.iter().map(|&x| ([p, x], copy)));
            for &corner in &fan.faces[at..to] {
                copies.instead.insert(corner, copy);
            }
            let [first, last] = [at, to].map(|i| fan.neighbours[i % n]);
            if is_on(first) {
                copies.left.insert([p, first], copy);
            }
            if is_on(last) {
                copies.right.insert([p, last], copy);
            }
            at = to;
        }
    }

    /// Copies of the last vertex of a way inside the sheet, one towards each neighbour but the one on
    /// the way.
    fn cap(&mut self, (p, goal): (VertexId, DVec3), fan: &Fan, copies: &mut Copies) -> Option<()> {
        let n = fan.neighbours.len();
        if n < 3 {
            return None;
        }
        let back = fan.neighbours[0];
        let mut own = Vec::with_capacity(n - 1);
        for &x in &fan.neighbours[1..] {
            let copy = self.add(goal.lerp(self.place(x), ASIDE), [p, x]);
            copies.beside.insert([p, x], copy);
            own.push(copy);
        }
        let [first, last] = [own[0], own[own.len() - 1]];
        copies.left.insert([p, back], first);
        copies.right.insert([p, back], last);
        copies.instead.insert(fan.faces[0], first);
        copies.instead.insert(fan.faces[n - 1], last);
        for (pair, &(f, i)) in own.windows(2).zip(&fan.faces[1..n - 1]) {
            if copies.ahead.insert(f, (i, [pair[0], pair[1]])).is_some() {
                return None;
            }
        }
        Some(())
    }

    /// Puts the rows between ways and their copies.
    fn put(&mut self, sheet: usize, edges: &BTreeSet<Edge>, copies: &Copies) {
        for (&(f, i), &copy) in &copies.instead {
            self.faces[sheet][f][i] = copy;
        }
        for (&f, &(i, [next, before])) in &copies.ahead {
            let mut corners = self.faces[sheet][f].clone();
            corners.rotate_left(i);
            let [p, x, z, y] = [0, 1, 2, 3].map(|k| corners[k]);
            let place = self.place(p).lerp(self.place(z), ASIDE);
            let inner = self.add(place, [p, z]);
            self.faces[sheet][f] = vec![p, next, inner, before];
            self.faces[sheet].extend([vec![next, x, z, inner], vec![inner, z, y, before]]);
        }
        for &[a, b] in edges {
            for [u, v] in [[a, b], [b, a]] {
                if let (Some(&of_u), Some(&of_v)) =
                    (copies.left.get(&[u, v]), copies.right.get(&[v, u]))
                {
                    self.faces[sheet].push(vec![u, v, of_v, of_u]);
                }
            }
        }
        let between = |[a, b]: Edge| -> Vec<VertexId> {
            if edges.contains(&sorted([a, b])) {
                return Vec::new();
            }
            let copies = [copies.beside.get(&[a, b]), copies.beside.get(&[b, a])];
            copies.into_iter().flatten().copied().collect()
        };
        let features = std::mem::take(&mut self.features);
        for [a, b] in features {
            let along = [vec![a], between([a, b]), vec![b]].concat();
            self.features
                .extend(along.windows(2).map(|w| sorted([w[0], w[1]])));
        }
        self.lengthen(sheet, between);
    }
}

/// Where the vertices of a chain belong on its line.
fn even_goals(chain: &Chain, line: &Line) -> Vec<(VertexId, DVec3)> {
    let n = chain.vertices.len();
    let n_steps = if chain.is_closed { n } else { n - 1 };
    let vertices = chain.vertices.iter().enumerate();
    let goal = |(i, &v): (usize, &VertexId)| (v, line.at(i as f64 / n_steps as f64));
    vertices.map(goal).collect()
}

/// How many corners of a polygon are flat or turn against a direction.
fn n_flat(corners: &[DVec3], normal: DVec3) -> usize {
    let n = corners.len();
    let normal = normal.normalize_or_zero();
    let turn = |i: usize| {
        let [a, b, c] = [i, i + 1, i + 2].map(|i| corners[i % n]);
        let sides = [b - a, c - b].map(DVec3::normalize_or_zero);
        sides[0].cross(sides[1]).dot(normal)
    };
    (0..n).filter(|&i| turn(i) <= FLAT).count()
}
