//! The lines of a symmetric surface, and the ways that are tied to their images.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::flow::complex::Tie;
use crate::flow::creases::Line;
use crate::flow::field::OrientationField;
use crate::mesh::{HalfedgeId, HalfedgeMap, VertexId, VertexMap};
use crate::mirror::Doubled;

/// A way on the positive side and its image.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Pair {
    /// The halfedges of the way.
    pub path: Vec<HalfedgeId>,
    /// Those of its image.
    pub image: Vec<HalfedgeId>,
    /// How vectors turn from the frame of the way's first face into that of its first twin, whose
    /// image is the frame of the image's first face.
    pub turns: u8,
}

/// What the quads of a symmetric surface have to keep to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Plan {
    /// The lines in the plane.
    pub plane: Vec<Line>,
    /// Sharp lines beside it, each followed by its image.
    pub beside: Vec<Line>,
    /// Ways from the plane to everything on the positive side that is kept.
    pub pairs: Vec<Pair>,
}

impl Plan {
    /// The same with lines that all have to be met.
    pub fn firm(mut self) -> Self {
        let all = self.plane.iter_mut().chain(&mut self.beside);
        all.for_each(|line| line.is_firm = true);
        self
    }

    /// Whether there are lines that have to be met.
    pub fn is_firm(&self) -> bool {
        self.lines().any(|line| line.is_firm)
    }

    /// All lines, those in the plane first.
    pub fn lines(&self) -> impl Iterator<Item = &Line> {
        self.plane.iter().chain(&self.beside)
    }

    /// The halfedges of all lines, then those of the pairs.
    pub fn paths(&self) -> Vec<Vec<HalfedgeId>> {
        let lines = self.lines().map(|line| line.halfedges.clone());
        let pairs = self
            .pairs
            .iter()
            .flat_map(|p| [p.path.clone(), p.image.clone()]);
        lines.chain(pairs).collect()
    }

    /// The ties of the pairs, by the places of their ways among the paths.
    pub fn ties(&self) -> Vec<Tie> {
        let first = self.plane.len() + self.beside.len();
        let tie = |(i, pair): (usize, &Pair)| Tie {
            lines: [first + 2 * i, first + 2 * i + 1],
            turns: pair.turns,
        };
        self.pairs.iter().enumerate().map(tie).collect()
    }
}

/// Plans the lines of a field that is its own image; of the creases given those of the positive
/// side and their images are kept.
///
/// Pieces of the plane's line have to be met where they are `firm`. The plane's line is cut at singularities and where creases end in it; where there is none of
/// either a vertex far from all singularities is chosen. Costs a search over half of the mesh.
pub fn plan(
    (doubled, firm): (&Doubled, Option<&HalfedgeMap<bool>>),
    field: &OrientationField,
    creases: &[Line],
) -> Plan {
    let beside = both_sides(doubled, creases);
    let mut is_kept: VertexMap<bool> = field.indices.iter().map(|&k| k != 0).collect();
    for &end in beside.iter().flat_map(|line| &line.ends) {
        is_kept[end] = true;
    }
    let mut plane = plane(doubled, &mut is_kept);
    for line in &mut plane {
        line.is_firm = firm.is_some_and(|firm| firm[line.halfedges[0]]);
    }
    let pairs = ways(doubled, &is_kept)
        .into_iter()
        .map(|path| Pair {
            image: path.iter().map(|&h| doubled.image_along(h)).collect(),
            turns: field.turns[path[0]],
            path,
        })
        .collect();
    Plan {
        plane,
        beside,
        pairs,
    }
}

fn both_sides(doubled: &Doubled, creases: &[Line]) -> Vec<Line> {
    let is_positive = |h: HalfedgeId| doubled.is_positive(h.face());
    let lies_beside = |h: &HalfedgeId| {
        let twin = doubled.mesh().twin(*h);
        is_positive(*h) && twin.is_some_and(is_positive)
    };
    let own = creases
        .iter()
        .filter(|line| line.halfedges.iter().all(lies_beside));
    let image = |line: &Line| Line {
        halfedges: line
            .halfedges
            .iter()
            .map(|&h| doubled.image_along(h))
            .collect(),
        ends: line.ends.map(|v| doubled.image(v)),
        is_firm: line.is_firm,
    };
    own.flat_map(|line| [line.clone(), image(line)]).collect()
}

/// The plane's line in pieces between vertices that are kept.
fn plane(doubled: &Doubled, is_kept: &mut VertexMap<bool>) -> Vec<Line> {
    let mesh = doubled.mesh();
    let mut border = doubled.border().to_vec();
    let first = border.iter().position(|&h| is_kept[mesh.origin(h)]);
    let first = first.unwrap_or_else(|| {
        let kept: Vec<VertexId> = mesh.vertex_ids().filter(|&v| is_kept[v]).collect();
        let room = |h: &HalfedgeId| {
            let at = mesh.position(mesh.origin(*h));
            let far = kept.iter().map(|&v| mesh.position(v).distance_squared(at));
            far.fold(f64::INFINITY, f64::min)
        };
        let rooms: Vec<f64> = border.iter().map(room).collect();
        let best = (0..rooms.len()).max_by(|&a, &b| rooms[a].total_cmp(&rooms[b]).then(b.cmp(&a)));
        best.expect("a plane that cuts a mesh has edges in it")
    });
    border.rotate_left(first);
    is_kept[mesh.origin(border[0])] = true;
    let pieces = border.chunk_by(|_, &h| !is_kept[mesh.origin(h)]);
    pieces
        .map(|piece| Line {
            halfedges: piece.to_vec(),
            ends: [mesh.origin(piece[0]), mesh.target(piece[piece.len() - 1])],
            is_firm: false,
        })
        .collect()
}

/// The shortest ways inside the positive side to each kept vertex there, from one that has a way
/// or lies in the plane.
fn ways(doubled: &Doubled, is_kept: &VertexMap<bool>) -> Vec<Vec<HalfedgeId>> {
    let mesh = doubled.mesh();
    let mut distances = VertexMap::filled(mesh.n_vertices(), f64::INFINITY);
    let mut arrivals: VertexMap<Option<HalfedgeId>> = VertexMap::filled(mesh.n_vertices(), None);
    let mut queue = BinaryHeap::new();
    for v in doubled.border().iter().map(|&h| mesh.origin(h)) {
        if is_kept[v] {
            distances[v] = 0.0;
            queue.push(Reverse((0_u64, v)));
        }
    }
    let mut ends = Vec::new();
    while let Some(Reverse((bits, v))) = queue.pop() {
        let distance = f64::from_bits(bits);
        if distance > distances[v] {
            continue;
        }
        if is_kept[v] && arrivals[v].is_some() {
            ends.push(v);
        }
        for h in mesh.outgoing(v).filter(|&h| doubled.is_positive(h.face())) {
            let to = mesh.target(h);
            let through = distance + mesh.position(v).distance(mesh.position(to));
            if !doubled.is_in_plane(to) && through < distances[to] {
                distances[to] = through;
                arrivals[to] = Some(h);
                // The bits of positive numbers are ordered as the numbers are.
                queue.push(Reverse((through.to_bits(), to)));
            }
        }
    }
    let way = |end: &VertexId| {
        let mut at = *end;
        let mut way = Vec::new();
        while let Some(h) = arrivals[at] {
            way.push(h);
            at = mesh.origin(h);
            if is_kept[at] {
                break;
            }
        }
        way.reverse();
        way
    };
    ends.iter().map(way).collect()
}

/// The edges in the plane, on both sides of each.
pub fn plane_edges(doubled: &Doubled) -> HalfedgeMap<bool> {
    let mut is_in_plane = HalfedgeMap::filled(3 * doubled.mesh().n_faces(), false);
    for &h in doubled.border() {
        is_in_plane[h] = true;
        is_in_plane[doubled.image_of_halfedge(h)] = true;
    }
    is_in_plane
}
