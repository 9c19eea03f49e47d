//! Fewer and simpler singularities, at the resolution of the result.
//!
//! Two singularities of opposite sign that are closer than a quad or so cannot both have a vertex
//! in the result; nor should one vertex take two quarters if a vertex beside it can take the other.
//! Moving s quarters along a path of edges a → b adds s to the turns of the path's halfedges:
//! nothing else changes, and the field stays consistent throughout.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

use crate::elementary::sin;
use crate::flow::field::OrientationField;
use crate::mesh::{FaceMap, HalfedgeId, TriangleMesh, VertexId, VertexMap};

/// Opposite singularities closer than this many edges of a quad are merged. Smaller leaves pairs
/// that the result cannot hold; at 1.8 more loops close, but fingers and thin limbs lose shape.
const MERGE_RADIUS: f64 = 1.2;
/// Two negative ones must be closer: merging them makes a vertex of valence 6.
const MERGE_RADIUS_NEGATIVE: f64 = 0.5;

/// How far apart the units of a split singularity are put.
const SPLIT_DISTANCE: f64 = 1.1;
/// How far around places are sought for them, or as many times as far as there are enough.
const SPLIT_REACH: f64 = 2.4;

/// Merges and splits singularities for quads with edges as long as `sizes` says for each face.
///
/// Opposite ones closer than 1.2 edges are merged, nearest first, pairs that cancel before others;
/// negative ones closer than half an edge where the sum is at least −2. Those with index 2 or more, or −3
/// or less, are split into units about an edge of a quad apart, at regular vertices around, as far
/// as the mesh has any. At the end of a limb these are the four corners of a quad around the tip.
/// Directions are kept, so along the paths they no longer agree with the turns: see
/// [`settle`](super::field::settle). Turns, residuals and indices change. O(s · n) for s
/// singularities.
pub fn tidy(mesh: &TriangleMesh, field: &mut OrientationField, sizes: &FaceMap<f64>) {
    // What was split may have come close to others.
    for _ in 0..2 {
        merge(mesh, field, sizes);
        split(mesh, field, sizes);
    }
    debug_assert_eq!(field.check(mesh), Ok(()));
}

/// Two singularities and the way from one to the other.
struct Pair {
    ends: [VertexId; 2],
    length: f64,
    path: Vec<HalfedgeId>,
}

fn merge(mesh: &TriangleMesh, field: &mut OrientationField, sizes: &FaceMap<f64>) {
    let mut pairs = close_pairs(mesh, field, sizes);
    loop {
        let mut best: Option<(f64, usize)> = None;
        pairs.retain(|pair| pair.ends.iter().all(|&end| field.indices[end] != 0));
        for (i, pair) in pairs.iter().enumerate() {
            let [a, b] = pair.ends.map(|end| field.indices[end]);
            let Some(cost) = merge_cost([a, b], pair.length) else {
                continue;
            };
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, i));
            }
        }
        let Some((_, i)) = best else {
            return;
        };
        let index = field.indices[pairs[i].ends[0]];
        shift(field, mesh, &pairs[i].path, index);
    }
}

/// How willingly two indices this many edges apart are merged: the least first, none never.
fn merge_cost([a, b]: [i32; 2], distance: f64) -> Option<f64> {
    let sum = a + b;
    let opposite = a * b < 0 && sum.abs() <= a.abs().max(b.abs());
    let negative = a < 0 && b < 0 && sum >= -2 && distance < MERGE_RADIUS_NEGATIVE;
    (opposite || negative).then_some(if sum == 0 { 0.7 * distance } else { distance })
}

/// All pairs of singularities that may be close enough, each once.
fn close_pairs(mesh: &TriangleMesh, field: &OrientationField, sizes: &FaceMap<f64>) -> Vec<Pair> {
    let singular = |v: &VertexId| field.indices[*v] != 0;
    let mut reach = Reach::new(mesh, sizes);
    let mut pairs = Vec::new();
    for a in mesh.vertex_ids().filter(singular) {
        reach.spread(a, MERGE_RADIUS);
        for &b in reach.seen.iter().filter(|&&b| a < b && singular(&b)) {
            pairs.push(Pair {
                ends: [a, b],
                length: reach.distances[b],
                path: reach.path(b),
            });
        }
    }
    pairs
}

/// Moves the units of indices of 2 and more, or −3 and less, to places spread around.
fn split(mesh: &TriangleMesh, field: &mut OrientationField, sizes: &FaceMap<f64>) {
    let mut reach = Reach::new(mesh, sizes);
    for v in mesh.vertex_ids() {
        let index = field.indices[v];
        if (-2..=1).contains(&index) {
            continue;
        }
        let n = index.unsigned_abs() as usize;
        let is_free = |u: &VertexId| field.indices[*u] == 0;
        let mut radius = SPLIT_REACH;
        let free = loop {
            reach.spread(v, radius);
            let free: Vec<VertexId> = reach.seen.iter().copied().filter(is_free).collect();
            // Around a spike edges may be longer than that, and one vertex would keep all units.
            if free.len() >= n || reach.seen.len() == mesh.n_vertices() {
                break free;
            }
            radius *= 2.0;
        };
        for place in places(&reach, &free, (v, n)) {
            shift(field, mesh, &reach.path(place), index.signum());
        }
    }
}

/// Up to `n` of the free vertices on a circle round `v`, far from each other, for which `n`
/// singularities are about an edge of a quad apart.
fn places(reach: &Reach, free: &[VertexId], (v, n): (VertexId, usize)) -> Vec<VertexId> {
    let radius = SPLIT_DISTANCE / (2.0 * sin(PI / n as f64));
    let size = reach.size_at(v);
    let mut places: Vec<VertexId> = Vec::new();
    let mut rooms = vec![0.0; free.len()];
    for (room, &u) in rooms.iter_mut().zip(free) {
        *room = -(reach.distances[u] - radius).abs();
    }
    let misfits = rooms.clone();
    while places.len() < n.min(free.len()) {
        let best = (0..free.len()).max_by(|&a, &b| rooms[a].total_cmp(&rooms[b]));
        let place = free[best.expect("there are more free vertices than places")];
        for (i, &u) in free.iter().enumerate() {
            let gap = reach.mesh.position(u).distance(reach.mesh.position(place)) / size;
            let room = if u == place {
                f64::NEG_INFINITY
            } else {
                gap + misfits[i]
            };
            rooms[i] = if places.is_empty() {
                room
            } else {
                rooms[i].min(room)
            };
        }
        places.push(place);
    }
    places
}

/// Moves `quarters` of index from the start of a path to its end.
pub(super) fn shift(
    field: &mut OrientationField,
    mesh: &TriangleMesh,
    path: &[HalfedgeId],
    quarters: i32,
) {
    let [Some(&first), Some(&last)] = [path.first(), path.last()] else {
        return;
    };
    for &h in path {
        let twin = mesh.twin(h).expect("the mesh of a field is closed");
        field.turns[h] = (i32::from(field.turns[h]) + quarters).rem_euclid(4) as u8;
        field.turns[twin] = (4 - field.turns[h]) % 4;
        // r grew and the cross stayed: it is ahead of −r by that much more.
        field.residuals[h] += f64::from(quarters);
        field.residuals[twin] -= f64::from(quarters);
    }
    field.indices[mesh.origin(first)] -= quarters;
    field.indices[mesh.target(last)] += quarters;
}

/// Shortest ways along edges from one vertex (Dijkstra), within a radius; in edges of quads.
pub(super) struct Reach<'a> {
    mesh: &'a TriangleMesh,
    sizes: &'a FaceMap<f64>,
    distances: VertexMap<f64>,
    /// The last halfedge of the way to each vertex.
    arrivals: VertexMap<Option<HalfedgeId>>,
    /// The vertices within the radius, nearest first.
    seen: Vec<VertexId>,
    touched: Vec<VertexId>,
}

impl<'a> Reach<'a> {
    pub fn new(mesh: &'a TriangleMesh, sizes: &'a FaceMap<f64>) -> Self {
        Self {
            mesh,
            sizes,
            distances: VertexMap::filled(mesh.n_vertices(), f64::INFINITY),
            arrivals: VertexMap::filled(mesh.n_vertices(), None),
            seen: Vec::new(),
            touched: Vec::new(),
        }
    }

    pub fn spread(&mut self, from: VertexId, radius: f64) {
        for v in self.touched.drain(..) {
            self.distances[v] = f64::INFINITY;
            self.arrivals[v] = None;
        }
        self.seen.clear();
        let mut queue = BinaryHeap::from([Reverse((0_u64, from))]);
        self.distances[from] = 0.0;
        self.touched.push(from);
        while let Some(Reverse((bits, v))) = queue.pop() {
            // The bits of positive numbers are ordered as the numbers are.
            let distance = f64::from_bits(bits);
            if distance > self.distances[v] {
                continue;
            }
            self.seen.push(v);
            for h in self.mesh.outgoing(v) {
                let to = self.mesh.target(h);
                let step = self.mesh.position(to).distance(self.mesh.position(v)) / self.size(h);
                let through = distance + step;
                if through <= radius && through < self.distances[to] {
                    if self.distances[to].is_infinite() {
                        self.touched.push(to);
                    }
                    self.distances[to] = through;
                    self.arrivals[to] = Some(h);
                    queue.push(Reverse((through.to_bits(), to)));
                }
            }
        }
    }

    /// The wanted length of edges at a halfedge.
    fn size(&self, h: HalfedgeId) -> f64 {
        let twin = self.mesh.twin(h).expect("the mesh of a field is closed");
        f64::midpoint(self.sizes[h.face()], self.sizes[twin.face()])
    }

    /// The same at a vertex.
    fn size_at(&self, v: VertexId) -> f64 {
        let first = self.mesh.outgoing(v).next();
        self.size(first.expect("a vertex of a closed mesh has edges"))
    }

    /// The vertices within the radius, nearest first.
    pub fn seen(&self) -> &[VertexId] {
        &self.seen
    }

    /// How far a vertex is from the start; infinite beyond the radius.
    pub fn distance(&self, vertex: VertexId) -> f64 {
        self.distances[vertex]
    }

    /// The halfedges from the start to a vertex that was reached.
    pub fn path(&self, to: VertexId) -> Vec<HalfedgeId> {
        let step = |v: VertexId| self.arrivals[v];
        let last = step(to);
        let mut path: Vec<HalfedgeId> =
            std::iter::successors(last, |&h| step(self.mesh.origin(h))).collect();
        path.reverse();
        path
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::field::{Settings, orient};
    use crate::measure::total_area;
    use crate::progress::Progress;
    use crate::shapes;

    fn even(mesh: &TriangleMesh, n_quads: f64) -> FaceMap<f64> {
        FaceMap::filled(mesh.n_faces(), (total_area(mesh) / n_quads).sqrt())
    }

    fn tidied(mesh: &TriangleMesh, n_quads: f64) -> OrientationField {
        let mut field = orient(mesh, &Settings::default(), &Progress::none()).unwrap();
        tidy(mesh, &mut field, &even(mesh, n_quads));
        field
    }

    #[test]
    fn shapes_keep_consistent_fields_with_simple_singularities() {
        for (name, mesh) in shapes::closed(14) {
            for n_quads in [100.0, 400.0] {
                let field = tidied(&mesh, n_quads);
                assert_eq!(field.check(&mesh), Ok(()), "{name}");
                assert!(field.indices.iter().all(|k| (-2..=1).contains(k)), "{name}");
            }
        }
    }

    #[test]
    fn a_sphere_keeps_eight_singularities() {
        let field = tidied(&shapes::sphere(20), 200.0);
        let singular: Vec<i32> = field.indices.iter().copied().filter(|k| *k != 0).collect();
        assert_eq!(singular, [1; 8]);
    }

    /// A field on a sphere with some of its units at one vertex, which is returned.
    fn gathered(n: usize) -> (TriangleMesh, OrientationField, VertexId) {
        let mesh = shapes::sphere(20);
        let mut field = orient(&mesh, &Settings::default(), &Progress::none()).unwrap();
        let sizes = FaceMap::filled(mesh.n_faces(), 0.3);
        let mut reach = Reach::new(&mesh, &sizes);
        let regular = |v: &VertexId| field.indices[*v] == 0;
        let tip = mesh.vertex_ids().find(regular).unwrap();
        reach.spread(tip, f64::INFINITY);
        let singular: Vec<VertexId> = reach.seen.iter().copied().filter(|v| !regular(v)).collect();
        for v in &singular[..n] {
            let back = reach.path(*v);
            shift(&mut field, &mesh, &back, -1);
        }
        assert_eq!(field.indices[tip], n as i32);
        (mesh, field, tip)
    }

    #[test]
    fn units_are_split_over_edges_longer_than_those_of_the_quads() {
        for size in [0.03, 0.001] {
            let (mesh, mut field, _) = gathered(3);
            split(&mesh, &mut field, &FaceMap::filled(mesh.n_faces(), size));
            assert_eq!(field.check(&mesh), Ok(()));
            assert!(field.indices.iter().all(|k| (0..=1).contains(k)), "{size}");
        }
    }

    #[test]
    fn four_units_at_one_vertex_become_the_corners_of_a_quad() {
        let (mesh, mut field, tip) = gathered(4);
        split(&mesh, &mut field, &FaceMap::filled(mesh.n_faces(), 0.3));
        assert_eq!(field.check(&mesh), Ok(()));
        let at = mesh.position(tip);
        let near = |v: &VertexId| field.indices[*v] == 1 && mesh.position(*v).distance(at) < 0.4;
        let corners: Vec<VertexId> = mesh.vertex_ids().filter(near).collect();
        assert_eq!(corners.len(), 4);
        let center = corners
            .iter()
            .map(|v| mesh.position(*v))
            .sum::<glam::DVec3>()
            / 4.0;
        assert!(center.distance(at) < 0.08, "{}", center.distance(at));
    }

    #[test]
    fn a_unit_moved_away_and_back_leaves_the_field_as_it_was() {
        let mesh = shapes::blob(4, 8);
        let before = orient(&mesh, &Settings::default(), &Progress::none()).unwrap();
        let sizes = FaceMap::filled(mesh.n_faces(), 1.0);
        let mut reach = Reach::new(&mesh, &sizes);
        reach.spread(VertexId(3), f64::INFINITY);
        let path = reach.path(VertexId(200));
        let mut field = before.clone();
        shift(&mut field, &mesh, &path, 3);
        assert_eq!(field.check(&mesh), Ok(()));
        assert_eq!(
            field.indices[VertexId(200)],
            before.indices[VertexId(200)] + 3
        );
        shift(&mut field, &mesh, &path, -3);
        assert_eq!((field.turns, field.indices), (before.turns, before.indices));
    }

    #[test]
    fn opposite_neighbours_are_merged() {
        let mesh = shapes::sphere(10);
        let mut field = orient(&mesh, &Settings::default(), &Progress::none()).unwrap();
        let regular = |v: &VertexId| {
            let around = mesh.neighbours(*v).chain([*v]);
            around.into_iter().all(|u| field.indices[u] == 0)
        };
        let v = mesh.vertex_ids().find(regular).unwrap();
        let path = [mesh.outgoing(v).next().unwrap()];
        let before = field.clone();
        shift(&mut field, &mesh, &path, 1);
        let apart = mesh
            .position(v)
            .distance(mesh.position(mesh.target(path[0])));
        merge(&mesh, &mut field, &FaceMap::filled(mesh.n_faces(), apart));
        assert_eq!((field.turns, field.indices), (before.turns, before.indices));
    }
}
