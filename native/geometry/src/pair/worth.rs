//! What a pair of triangles is worth as a quad.

use std::array;
use std::f64::consts::PI;

use glam::DVec3;

use super::Stay;
use super::matching::NONE;
use crate::measure::{area_vector, corner_angle};
use crate::mesh::{FaceId, HalfedgeId, Id, TriangleMesh, VertexId};

/// What it costs when an edge that is to stay becomes a diagonal.
const KEPT: f64 = 4.0;
/// What a right angle between the triangles costs.
const FOLD: f64 = 1.0;
/// What an end of the diagonal gains by each face it has more than six, and loses by each less:
/// quads want four at a vertex, triangles six.
const FACE: f64 = 0.06;
/// More faces than this at a vertex gain no more.
const MOST_FACES: usize = 9;
/// What an end with three faces costs: two quads would be left there.
const TIP: f64 = 2.0;
/// A border that turns by more than this at a vertex, on the side of a single quad, has no corner
/// there: it is nearer to going straight on than to a right angle.
const FLAT: f64 = 0.75 * PI;
/// By how much a pair is made dearer that leaves two quads at a vertex.
const EASING: f64 = 0.7;

/// For every triangle its neighbours, and what the pair is worth. Borders have to be firm.
pub(super) fn arcs(mesh: &TriangleMesh, stay: Stay<'_>) -> Vec<[(u32, f64); 3]> {
    let kept = stay.kept;
    let valences: Vec<usize> = mesh.vertex_ids().map(|v| mesh.valence(v)).collect();
    let end = |v: VertexId| {
        let n = valences[v.index()];
        let tip = if n <= 3 { TIP } else { 0.0 };
        FACE * (n.min(MOST_FACES) as f64 - 6.0) - tip
    };
    let arc = |h: HalfedgeId| {
        if stay.is_firm(h) {
            return (NONE, 0.0);
        }
        let twin = mesh.twin(h).expect("borders are firm");
        // The same for both sides, to the last bit.
        let first = h.min(twin);
        let stays = if kept[h] || kept[twin] { KEPT } else { 0.0 };
        let [a, b] = [mesh.origin(first), mesh.target(first)];
        let normals = [first.face(), h.max(twin).face()]
            .map(|f| area_vector(mesh.triangle(f)).normalize_or_zero());
        let fold = FOLD * (1.0 - normals[0].dot(normals[1]));
        let shape = squareness(corners(mesh, first).map(|v| mesh.position(v)));
        (twin.face().0, shape - stays - fold + end(a) + end(b))
    };
    let all = mesh.face_ids().map(|face| {
        let first = mesh.halfedge(face);
        [first, first.next(), first.prev()].map(arc)
    });
    all.collect()
}

/// Makes the pairs dearer whose worst corner has a smaller sine than `least`.
pub(super) fn shun(mesh: &TriangleMesh, arcs: &mut [[(u32, f64); 3]], (least, by): (f64, f64)) {
    for h in mesh.halfedge_ids() {
        let Some(twin) = mesh.twin(h) else { continue };
        let quad = corners(mesh, h.min(twin)).map(|v| mesh.position(v));
        if squareness(quad) < least {
            arcs[h.face().index()][h.corner()].1 -= by;
        }
    }
}

/// Makes the pairs dearer that leave two quads or fewer at a vertex, or one on a side of firm edges
/// that go straight on; false if there are none.
pub(super) fn ease(
    mesh: &TriangleMesh,
    stay: Stay<'_>,
    arcs: &mut [[(u32, f64); 3]],
    mate: &[u32],
) -> bool {
    let is_paired = |h: &HalfedgeId| {
        let is_mate = |twin: HalfedgeId| mate[h.face().index()] == twin.face().0;
        !stay.is_firm(*h) && mesh.twin(*h).is_some_and(is_mate)
    };
    let mut found = false;
    for v in mesh.vertex_ids() {
        for sector in sectors(mesh, stay, v) {
            let paired: Vec<HalfedgeId> = sector.iter().copied().filter(is_paired).collect();
            let n_left = sector.len() - paired.len();
            let is_firm = stay.is_firm(sector[0]);
            if n_left > if is_firm { 1 } else { 2 } || (is_firm && !is_flat(mesh, &sector)) {
                continue;
            }
            found |= !paired.is_empty();
            for h in paired {
                let twin = mesh.twin(h).expect("pairs lie on both sides");
                for side in [h, twin] {
                    arcs[side.face().index()][side.corner()].1 -= EASING;
                }
            }
        }
    }
    found
}

/// The edges that leave a vertex, counter-clockwise, from each firm one to the next; all where none
/// is firm.
fn sectors(mesh: &TriangleMesh, stay: Stay<'_>, v: VertexId) -> Vec<Vec<HalfedgeId>> {
    let mut around: Vec<HalfedgeId> = mesh.outgoing(v).collect();
    if let Some(first) = around.iter().position(|&h| stay.is_firm(h)) {
        around.rotate_left(first);
    }
    let mut sectors = Vec::new();
    for h in around {
        if sectors.is_empty() || stay.is_firm(h) {
            sectors.push(Vec::new());
        }
        sectors.last_mut().expect("one was pushed").push(h);
    }
    sectors
}

/// Whether the faces of some edges that leave a vertex have nearly a half turn there or more.
fn is_flat(mesh: &TriangleMesh, sector: &[HalfedgeId]) -> bool {
    let angle = |h: &HalfedgeId| corner_angle(mesh.triangle(h.face()), h.corner());
    sector.iter().map(angle).sum::<f64>() > FLAT
}

/// The triangles without a partner.
pub(super) fn triangles(mesh: &TriangleMesh, mate: &[u32]) -> Vec<[u32; 3]> {
    let alone = mesh.face_ids().filter(|f| mate[f.index()] == NONE);
    alone.map(|f| mesh.face(f).map(|v| v.0)).collect()
}

/// The quads of partners; the first corner and the third are the ends of the edge between them.
pub(super) fn quads(mesh: &TriangleMesh, stay: Stay<'_>, mate: &[u32]) -> Vec<[u32; 4]> {
    let is_first = |f: &FaceId| mate[f.index()] != NONE && f.0 < mate[f.index()];
    let first = mesh.face_ids().filter(is_first);
    let quad = first.map(|face| {
        let first = mesh.halfedge(face);
        let all = [first, first.next(), first.prev()];
        let meets = |h: &HalfedgeId| {
            let is_mate = |twin: HalfedgeId| twin.face().0 == mate[face.index()];
            !stay.is_firm(*h) && mesh.twin(*h).is_some_and(is_mate)
        };
        let between = all.into_iter().find(meets).expect("partners share an edge");
        corners(mesh, between).map(|v| v.0)
    });
    quad.collect()
}

/// The corners of the two triangles at an edge, from one end of it around.
fn corners(mesh: &TriangleMesh, h: HalfedgeId) -> [VertexId; 4] {
    let twin = mesh.twin(h).expect("pairs lie on both sides");
    [
        mesh.origin(h),
        mesh.origin(twin.prev()),
        mesh.target(h),
        mesh.origin(h.prev()),
    ]
}

/// The sine of the worst corner of a quad, seen along its own normal: 1 for a rectangle, negative
/// where a corner turns the wrong way.
pub fn squareness(p: [DVec3; 4]) -> f64 {
    let normal = (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero();
    let edges: [DVec3; 4] = array::from_fn(|i| (p[(i + 1) % 4] - p[i]).normalize_or_zero());
    let turns = (0..4).map(|i| edges[i].cross(edges[(i + 1) % 4]).dot(normal));
    turns.fold(1.0, f64::min)
}
