//! Sharp lines of a rod: those along it, those round it, and the rims of its ends.

use std::collections::{HashMap, HashSet};

use super::fine::{Fine, length};
use super::section::{Profile, Section};
use crate::groups::Groups;
use crate::measure::area_vector;
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, TriangleMesh, VertexId, VertexMap};

/// A sharp edge lies along the rod where it climbs by this share of its length.
const STEEP: f64 = 0.5;
/// The face of an end is no larger than this share of a squared girth, a round one 0.08.
const END_AREA: f64 = 0.4;
/// A line round the rod climbs by no more than this share of a girth.
const LEVEL: f64 = 0.4;
/// A line along the rod may miss this many girths of its way at either end.
const MISSED: f64 = 0.5;

/// The sharp lines of a rod.
pub(super) struct Lines {
    /// The line along the rod that each edge is part of, from 0 on.
    pub along: HalfedgeMap<Option<usize>>,
    /// Closed lines round the rod, lowest first, with how far along it they are.
    pub round: Vec<(f64, Section)>,
    /// Whether the first and the last of them are the rims of the ends.
    pub rims: [bool; 2],
}

impl Lines {
    pub fn new(fine: &Fine, ends: [VertexId; 2], height: &VertexMap<f64>, p: &Profile) -> Self {
        let mesh = &fine.mesh;
        let girth = p.median_girth();
        let along: VertexMap<f64> = height.iter().map(|&level| p.along(level)).collect();
        let climb = |h: HalfedgeId| {
            let [a, b] = [mesh.origin(h), mesh.target(h)];
            (along[b] - along[a]) / length(mesh, [a, b]).max(f64::MIN_POSITIVE)
        };
        let steep = mesh
            .halfedge_ids()
            .map(|h| fine.sharp[h] && climb(h).abs() >= STEEP);
        let steep: HalfedgeMap<bool> = steep.collect();
        let rims = ends.map(|end| rim(fine, end, END_AREA * girth * girth));
        let on_rims: Vec<VertexId> = rims.iter().flatten().flatten().copied().collect();
        let is_level = |h: HalfedgeId| {
            let is_on = |v| on_rims.contains(&v);
            fine.sharp[h] && !steep[h] && !(is_on(mesh.origin(h)) && is_on(mesh.target(h)))
        };
        let mut loops: Vec<Vec<VertexId>> = rounds(mesh, is_level);
        let spread = |vertices: &[VertexId]| {
            let all = vertices.iter().map(|&v| along[v]);
            let low = all.clone().fold(f64::INFINITY, f64::min);
            all.fold(0.0, f64::max) - low
        };
        loops.retain(|vertices| spread(vertices) < LEVEL * girth);
        let is_rim = [rims[0].is_some(), rims[1].is_some()];
        loops.extend(rims.into_iter().flatten());
        let from_to = bounds(&loops, &along, (is_rim, p.length()));
        let along_lines = chains(mesh, &steep, &along, (from_to, MISSED * girth));
        let mean = |vertices: &[VertexId]| {
            vertices.iter().map(|&v| along[v]).sum::<f64>() / vertices.len() as f64
        };
        let mut round: Vec<(f64, Section)> = loops
            .iter()
            .map(|vertices| (mean(vertices), section(mesh, vertices, &along_lines)))
            .collect();
        round.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self {
            along: along_lines,
            round,
            rims: is_rim,
        }
    }

    /// How many lines along the rod there are.
    pub fn n_along(&self) -> usize {
        let lines = self.along.iter().flatten();
        lines.max().map_or(0, |line| line + 1)
    }
}

/// From where to where the rod goes between its rims.
fn bounds(
    loops: &[Vec<VertexId>],
    along: &VertexMap<f64>,
    (is_rim, length): ([bool; 2], f64),
) -> [f64; 2] {
    let all = loops.iter().flatten().map(|&v| along[v]);
    let low = all.clone().fold(length, f64::min);
    let high = all.fold(0.0, f64::max);
    [
        if is_rim[0] { low } else { 0.0 },
        if is_rim[1] { high } else { length },
    ]
}

/// The border of the face of an end, if it is one closed line of sharp edges.
fn rim(fine: &Fine, end: VertexId, most: f64) -> Option<Vec<VertexId>> {
    // The end of a face without a vertex inside is one of its border.
    let mut seeds = fine.mesh.outgoing(end).map(HalfedgeId::face);
    seeds.find_map(|seed| rim_around(fine, seed, most))
}

/// The border of the smooth piece around a face, if it is one closed line.
fn rim_around(fine: &Fine, seed: FaceId, most: f64) -> Option<Vec<VertexId>> {
    let mesh = &fine.mesh;
    let mut is_in: HashSet<FaceId> = HashSet::new();
    let mut open = vec![seed];
    let mut border = Vec::new();
    let mut size = 0.0;
    while let Some(face) = open.pop() {
        if !is_in.insert(face) {
            continue;
        }
        size += area_vector(mesh.triangle(face)).length();
        if size > most {
            return None;
        }
        let first = mesh.halfedge(face);
        for h in [first, first.next(), first.prev()] {
            match mesh.twin(h) {
                Some(_) if fine.sharp[h] => border.push(h),
                Some(twin) => open.push(twin.face()),
                None => return None,
            }
        }
    }
    // A sharp edge with the face of the end on both its sides is a crease in it.
    border.retain(|&h| mesh.twin(h).is_some_and(|t| !is_in.contains(&t.face())));
    border.sort_unstable();
    let next: HashMap<VertexId, VertexId> = border
        .iter()
        .map(|&h| (mesh.origin(h), mesh.target(h)))
        .collect();
    let start = mesh.origin(*border.first()?);
    let mut vertices = vec![start];
    let mut at = *next.get(&start)?;
    while at != start && vertices.len() <= border.len() {
        vertices.push(at);
        at = *next.get(&at)?;
    }
    (vertices.len() == border.len() && vertices.len() > 2).then_some(vertices)
}

/// The closed lines of some edges that touch nothing else of them.
fn rounds(mesh: &TriangleMesh, is_level: impl Fn(HalfedgeId) -> bool) -> Vec<Vec<VertexId>> {
    let around = |v: VertexId| -> Vec<VertexId> {
        let leaving = mesh.outgoing(v).filter(|&h| is_level(h));
        leaving.map(|h| mesh.target(h)).collect()
    };
    let mut is_seen = VertexMap::filled(mesh.n_vertices(), false);
    let mut loops = Vec::new();
    for start in mesh.vertex_ids() {
        if is_seen[start] || around(start).len() != 2 {
            continue;
        }
        let mut vertices = vec![start];
        let mut at = around(start)[0];
        let mut is_closed = true;
        while at != start {
            let ways = around(at);
            if is_seen[at] || ways.len() != 2 {
                is_closed = false;
                break;
            }
            is_seen[at] = true;
            let from = vertices[vertices.len() - 1];
            vertices.push(at);
            at = if ways[0] == from { ways[1] } else { ways[0] };
        }
        is_seen[start] = true;
        if is_closed && vertices.len() > 2 {
            loops.push(vertices);
        }
    }
    loops
}

/// Which steep edges follow each other from one end to the other, numbered.
fn chains(
    mesh: &TriangleMesh,
    steep: &HalfedgeMap<bool>,
    along: &VertexMap<f64>,
    ([low, high], missed): ([f64; 2], f64),
) -> HalfedgeMap<Option<usize>> {
    let mut groups = Groups::new(steep.len());
    for h in mesh.halfedge_ids().filter(|&h| steep[h]) {
        if let Some(twin) = mesh.twin(h) {
            groups.link(h.0 as usize, twin.0 as usize);
        }
    }
    for v in mesh.vertex_ids() {
        let leaving = || mesh.outgoing(v).filter(|&h| steep[h]);
        let climbs = |h: &HalfedgeId| along[mesh.target(*h)] > along[v];
        let [mut up, mut down] = [true, false].map(|up| leaving().filter(move |h| climbs(h) == up));
        if let (Some(a), None, Some(b), None) = (up.next(), up.next(), down.next(), down.next()) {
            groups.link(a.0 as usize, b.0 as usize);
        }
    }
    let mut reach: HashMap<usize, [f64; 2]> = HashMap::new();
    for h in mesh.halfedge_ids().filter(|&h| steep[h]) {
        let at = along[mesh.origin(h)];
        let span = reach.entry(groups.root(h.0 as usize)).or_insert([at; 2]);
        *span = [span[0].min(at), span[1].max(at)];
    }
    let is_whole = |span: &[f64; 2]| span[0] < low + missed && span[1] > high - missed;
    let mut whole: Vec<usize> = reach
        .iter()
        .filter(|r| is_whole(r.1))
        .map(|r| *r.0)
        .collect();
    whole.sort_unstable();
    let line = |h: HalfedgeId| {
        let root = groups.root(h.0 as usize);
        whole.binary_search(&root).ok().filter(|_| steep[h])
    };
    mesh.halfedge_ids().map(line).collect()
}

/// A closed line over vertices, with where lines along the rod meet it.
fn section(
    mesh: &TriangleMesh,
    vertices: &[VertexId],
    along: &HalfedgeMap<Option<usize>>,
) -> Section {
    let mut crossed = Vec::new();
    for (i, &v) in vertices.iter().enumerate() {
        let mut lines: Vec<usize> = mesh.outgoing(v).filter_map(|h| along[h]).collect();
        lines.sort_unstable();
        lines.dedup();
        crossed.extend(lines.into_iter().map(|line| (line, i)));
    }
    let points = vertices.iter().map(|&v| mesh.position(v)).collect();
    Section::new(points, crossed)
}
