//! A solid's creases: a network without loose ends, whose corners say where singularities belong.
//!
//! Between two creases at a corner lie as many quads as fit the angle there, one at least; so its
//! index is known. A patch between creases has the indices inside that its corners leave it:
//!
//! ```text
//! corner:  k = 4 − Σ n            n = angle of a sector / 90°, rounded, 1 at least
//! patch:   Σ k inside = 4 χ − Σ (2 − n)     over the sectors at its corners
//! ```
//!
//! Singularities that a field of so few triangles has elsewhere are moved to where they belong.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::FRAC_PI_2;

use super::{Sharp, corners};
use crate::flow::field::OrientationField;
use crate::flow::singularities::shift;
use crate::groups::Groups;
use crate::measure::{corner_angle, loose_share};
use crate::mesh::{
    FaceId, FaceMap, HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId, VertexMap,
};
use crate::mirror::Doubled;

/// The share of all creases, by length, that may have a loose end.
const LOOSE: f64 = 0.02;
/// A sector gets one quad more from this angle on, in quarters: an octagon's corners get two and
/// are no corners of quads, a hexagon's one.
const ROUNDS_UP: f64 = 0.4;
/// More units than this are not moved: the creases are then no solid's.
const MOST_MOVES: usize = 2_000;

/// How far from creases singularities are put, in edges of quads, where there is room.
const ASIDE: f64 = 1.0;
/// How far they are moved for it at most.
const FARTHEST: f64 = 4.0;

/// A network of creases on a closed surface of genus 0.
pub struct Network<'a> {
    mesh: &'a TriangleMesh,
    /// The creases, and the edges in the plane of symmetry, on both sides of each.
    sharp: &'a HalfedgeMap<bool>,
    mirror: Option<&'a Doubled>,
    /// The index of every vertex on a crease; the rest of the plane has none.
    indices: VertexMap<Option<i32>>,
    /// The patch of every face.
    patches: FaceMap<u32>,
    /// Σ k that belongs inside each.
    inside: Vec<i32>,
}

impl<'a> Network<'a> {
    /// The network of some creases; none if there are none or too many end loosely.
    pub fn new(
        mesh: &'a TriangleMesh,
        Sharp { edges: sharp, firm }: Sharp<'a>,
        mirror: Option<&'a Doubled>,
    ) -> Option<Self> {
        let may_end = firm.is_some_and(|firm| firm.may_end);
        let is_loose = || !may_end && loose_share(mesh, sharp) > LOOSE;
        if !sharp.iter().any(|&is| is) || is_loose() {
            return None;
        }
        let is_corner = corners(mesh, Sharp { edges: sharp, firm });
        let mut groups = Groups::new(mesh.n_faces());
        for h in mesh.halfedge_ids().filter(|&h| !sharp[h]) {
            if let Some(twin) = mesh.twin(h) {
                groups.link(h.face().index(), twin.face().index());
            }
        }
        let (patches, n_patches) = groups.numbered();
        let patches = FaceMap::from_vec(patches);
        let mut indices = VertexMap::filled(mesh.n_vertices(), None);
        let mut inside = open_euler(mesh, sharp, (&patches, n_patches));
        for total in &mut inside {
            *total *= 4;
        }
        let in_plane = |v: VertexId| mirror.is_some_and(|doubled| doubled.is_in_plane(v));
        for h in mesh.halfedge_ids().filter(|&h| sharp[h]) {
            let v = mesh.origin(h);
            if !is_corner[v] {
                if !in_plane(v) {
                    indices[v] = Some(0);
                }
                continue;
            }
            let n = n_quads(sector(mesh, sharp, h));
            *indices[v].get_or_insert(4) -= n;
            inside[patches[h.face()] as usize] -= 2 - n;
        }
        Some(Self {
            mesh,
            sharp,
            mirror,
            indices,
            patches,
            inside,
        })
    }

    /// The index that belongs at a vertex, where it is a crease's.
    pub fn index(&self, v: VertexId) -> Option<i32> {
        self.indices[v]
    }

    /// Moves singularities to the corners that want them and into the patches that do, on the
    /// shortest ways; in a symmetric field those of the positive side alone. Turns, residuals and
    /// indices change, directions do not. O(n) for every unit that moves.
    pub fn settle(&self, field: &mut OrientationField) {
        let mut deep = None;
        for _ in 0..MOST_MOVES {
            let charges = self.charges(field);
            let is_wrong = |charge: &i32| *charge != 0;
            if !charges
                .vertices
                .iter()
                .chain(&charges.patches)
                .any(is_wrong)
            {
                break;
            }
            let deep = deep.get_or_insert_with(|| self.depths());
            let [from, to] = [1, -1].map(|sign| self.places(field, &charges, (sign, deep)));
            let Some(path) = self.way(&from, &to) else {
                break;
            };
            shift(field, self.mesh, &path, 1);
        }
        debug_assert_eq!(field.check(self.mesh), Ok(()));
    }

    /// Moves singularities that are nearer to a crease than an edge of a quad away from it, where the
    /// patch has room: else they and the crease would have to coincide. Directions do not change.
    pub fn clear(&self, field: &mut OrientationField, sizes: &FaceMap<f64>) {
        let depths = self.depths();
        let edge = |v: VertexId| {
            let (n, sum) = (self.mesh.outgoing(v))
                .fold((0.0, 0.0), |(n, sum), h| (n + 1.0, sum + sizes[h.face()]));
            sum / f64::max(n, 1.0)
        };
        let lies_free = |v: VertexId| self.indices[v].is_none() && !self.is_in_plane(v);
        let near = |v: &VertexId| depths[*v] < ASIDE * edge(*v);
        let own = self
            .mesh
            .vertex_ids()
            .filter(|&v| self.is_own(v) && lies_free(v));
        let close: Vec<VertexId> = own.filter(|v| field.indices[*v] != 0 && near(v)).collect();
        for v in close {
            let patch = self.patch(v);
            let is_free = |u: VertexId| {
                let is_inside = lies_free(u) && field.indices[u] == 0 && !near(&u);
                is_inside && self.patch(u) == patch
            };
            let (distances, arrivals, last) = self.spread(&[v], is_free);
            let within = |u: &VertexId| distances[*u] < FARTHEST * edge(v);
            if let Some(last) = last.filter(within) {
                let way = self.way_back(&arrivals, last);
                shift(field, self.mesh, &way, field.indices[v]);
            }
        }
        debug_assert_eq!(field.check(self.mesh), Ok(()));
    }

    /// The way by which a vertex was reached.
    fn way_back(
        &self,
        arrivals: &VertexMap<Option<HalfedgeId>>,
        last: VertexId,
    ) -> Vec<HalfedgeId> {
        let step = |v: VertexId| arrivals[v];
        let way = std::iter::successors(step(last), |&h| step(self.mesh.origin(h)));
        let mut way: Vec<HalfedgeId> = way.collect();
        way.reverse();
        way
    }

    fn charges(&self, field: &OrientationField) -> Charges {
        let mut charges = Charges {
            vertices: vec![0; self.mesh.n_vertices()],
            patches: self.inside.iter().map(|&total| -total).collect(),
        };
        for (v, index) in self.indices.iter_ids().filter(|(v, _)| self.is_own(*v)) {
            let found = field.indices[v];
            match index {
                // Half of what is in the plane belongs to either side.
                Some(index) if self.is_in_plane(v) => {
                    charges.vertices[v.index()] = (found - index) / 2;
                }
                Some(index) => charges.vertices[v.index()] = found - index,
                None if self.is_in_plane(v) => charges.patches[self.patch(v)] += found / 2,
                None => charges.patches[self.patch(v)] += found,
            }
        }
        for face in self.mesh.face_ids().filter(|&face| !self.is_own_face(face)) {
            charges.patches[self.patches[face] as usize] = 0;
        }
        charges
    }

    /// Where a unit of some sign may be taken away.
    fn places(
        &self,
        field: &OrientationField,
        charges: &Charges,
        (sign, deep): (i32, &VertexMap<f64>),
    ) -> Vec<VertexId> {
        let own = || self.mesh.vertex_ids().filter(|&v| self.is_own(v));
        let inside = |patch: usize| {
            own().filter(move |&v| self.indices[v].is_none() && self.patch(v) == patch)
        };
        let mut places: Vec<VertexId> = own()
            .filter(|&v| self.indices[v].is_some() && charges.vertices[v.index()] * sign > 0)
            .collect();
        for patch in (0..self.inside.len()).filter(|&patch| charges.patches[patch] * sign > 0) {
            let there = |v: &VertexId| field.indices[*v] * sign > 0;
            let before = places.len();
            places.extend(inside(patch).filter(there));
            if places.len() == before {
                // Two at one vertex are better than none in a patch of few.
                let deepest = |index: i32| {
                    let is_free =
                        |v: &VertexId| field.indices[*v] * -sign == index && !self.is_in_plane(*v);
                    let free = inside(patch).filter(is_free);
                    free.max_by(|a, b| deep[*a].total_cmp(&deep[*b]))
                };
                places.extend(deepest(0).or_else(|| deepest(1)));
            }
        }
        places
    }

    /// How far every vertex is from the creases, along edges.
    fn depths(&self) -> VertexMap<f64> {
        let on_crease = |v: &VertexId| self.mesh.outgoing(*v).any(|h| self.sharp[h]);
        let creases: Vec<VertexId> = self.mesh.vertex_ids().filter(on_crease).collect();
        self.spread(&creases, |_| false).0
    }

    /// The shortest way from one of some vertices to one of others.
    fn way(&self, from: &[VertexId], to: &[VertexId]) -> Option<Vec<HalfedgeId>> {
        let mut is_goal = VertexMap::filled(self.mesh.n_vertices(), false);
        for &v in to {
            is_goal[v] = true;
        }
        let (_, arrivals, last) = self.spread(from, |v| is_goal[v]);
        Some(self.way_back(&arrivals, last?))
    }

    /// Distances from some vertices and how each was reached, up to the first that is a goal; ways
    /// keep to one side of the plane.
    fn spread(
        &self,
        from: &[VertexId],
        is_goal: impl Fn(VertexId) -> bool,
    ) -> (
        VertexMap<f64>,
        VertexMap<Option<HalfedgeId>>,
        Option<VertexId>,
    ) {
        let mesh = self.mesh;
        let mut distances = VertexMap::filled(mesh.n_vertices(), f64::INFINITY);
        let mut arrivals = VertexMap::filled(mesh.n_vertices(), None);
        let mut queue = BinaryHeap::new();
        for &v in from {
            distances[v] = 0.0;
            queue.push(Reverse((0_u64, v)));
        }
        while let Some(Reverse((bits, v))) = queue.pop() {
            let distance = f64::from_bits(bits);
            if distance > distances[v] {
                continue;
            }
            if is_goal(v) {
                return (distances, arrivals, Some(v));
            }
            // A way may begin or end in the plane, and leads through it nowhere.
            if self.is_in_plane(v) && distance > 0.0 {
                continue;
            }
            for h in mesh.outgoing(v).filter(|h| self.is_own_face(h.face())) {
                let to = mesh.target(h);
                let through = distance + mesh.position(v).distance(mesh.position(to));
                let is_along = self.is_in_plane(v) && self.is_in_plane(to);
                if through < distances[to] && !is_along {
                    distances[to] = through;
                    arrivals[to] = Some(h);
                    // The bits of positive numbers are ordered as the numbers are.
                    queue.push(Reverse((through.to_bits(), to)));
                }
            }
        }
        (distances, arrivals, None)
    }

    /// The patch of a vertex that is on no crease; in the plane that of its positive side.
    fn patch(&self, inner: VertexId) -> usize {
        let mut faces = self.mesh.outgoing(inner).map(HalfedgeId::face);
        let own = faces.find(|&face| self.is_own_face(face));
        self.patches[own.expect("an own vertex has an own face")] as usize
    }

    fn is_own_face(&self, face: FaceId) -> bool {
        self.mirror.is_none_or(|doubled| doubled.is_positive(face))
    }

    fn is_own(&self, v: VertexId) -> bool {
        self.mesh.outgoing(v).any(|h| self.is_own_face(h.face()))
    }

    fn is_in_plane(&self, v: VertexId) -> bool {
        self.mirror.is_some_and(|doubled| doubled.is_in_plane(v))
    }
}

/// How many quarters of index are too many.
struct Charges {
    /// At every vertex on a crease.
    vertices: Vec<i32>,
    /// Inside every patch.
    patches: Vec<i32>,
}

/// The angle on the left of a crease, up to the next one at its origin.
fn sector(mesh: &TriangleMesh, sharp: &HalfedgeMap<bool>, first: HalfedgeId) -> f64 {
    let mut angle = 0.0;
    let mut h = first;
    loop {
        angle += corner_angle(mesh.triangle(h.face()), h.corner());
        let Some(next) = mesh.twin(h.prev()).filter(|&next| !sharp[next]) else {
            return angle;
        };
        h = next;
        if h == first {
            return angle;
        }
    }
}

/// How many quads lie between two creases at some angle.
fn n_quads(angle: f64) -> i32 {
    ((angle / FRAC_PI_2 + 1.0 - ROUNDS_UP).floor() as i32).max(1)
}

/// The Euler number of every patch without the creases around it.
fn open_euler(
    mesh: &TriangleMesh,
    sharp: &HalfedgeMap<bool>,
    (patches, n): (&FaceMap<u32>, usize),
) -> Vec<i32> {
    let mut euler = vec![0; n];
    for &patch in patches {
        euler[patch as usize] += 1;
    }
    for h in mesh.halfedge_ids().filter(|&h| !sharp[h]) {
        let is_first = mesh.twin(h).is_none_or(|twin| h < twin);
        euler[patches[h.face()] as usize] -= i32::from(is_first);
    }
    for v in mesh.vertex_ids() {
        let mut leaving = mesh.outgoing(v);
        let first = leaving.next().expect("a vertex of a closed mesh has edges");
        if !sharp[first] && !leaving.any(|h| sharp[h]) {
            euler[patches[first.face()] as usize] += 1;
        }
    }
    euler
}
