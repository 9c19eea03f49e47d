//! Triangles that lie on the sphere and on the surface at once.

use std::collections::HashSet;

use glam::DVec3;
use robust::{Coord3D, orient3d};

use super::triangulation::Triangulation;
use crate::mesh::{FaceId, HalfedgeId, TriangleMesh, VertexId, VertexMap};
use crate::sphere_map::{SphereMap, SurfacePoint, is_positive, walk_along};

/// A triangulation whose vertices have a place on the surface, and through the map a point of the
/// sphere. Every triangle is positive on the sphere: what would fold one is refused.
pub struct Net<'a> {
    pub map: &'a SphereMap,
    pub triangulation: Triangulation,
    places: VertexMap<SurfacePoint>,
    sphere: VertexMap<DVec3>,
    positions: VertexMap<DVec3>,
    /// Edges that are never turned, smaller end first.
    kept: HashSet<[VertexId; 2]>,
}

/// The corners of a regular tetrahedron and its faces.
const TETRAHEDRON: [DVec3; 4] = [
    DVec3::new(1.0, 1.0, 1.0),
    DVec3::new(1.0, -1.0, -1.0),
    DVec3::new(-1.0, 1.0, -1.0),
    DVec3::new(-1.0, -1.0, 1.0),
];
const TETRAHEDRON_FACES: [[u32; 3]; 4] = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];

impl<'a> Net<'a> {
    /// Four vertices that surround the sphere.
    pub fn tetrahedron(map: &'a SphereMap) -> Self {
        let places = TETRAHEDRON.map(|direction| map.locate(direction)).to_vec();
        let faces = TETRAHEDRON_FACES.map(|f| f.map(VertexId)).to_vec();
        let mesh = TriangleMesh::new(TETRAHEDRON.to_vec(), faces);
        let mesh = mesh.expect("a tetrahedron is a closed mesh");
        Self {
            map,
            triangulation: Triangulation::of(&mesh),
            sphere: places.iter().map(|&at| map.sphere_position(at)).collect(),
            positions: places.iter().map(|&at| map.surface_position(at)).collect(),
            places: VertexMap::from_vec(places),
            kept: HashSet::new(),
        }
    }

    /// Saves an edge from being turned.
    pub fn keep_edge(&mut self, a: VertexId, b: VertexId) {
        self.kept.insert([a.min(b), a.max(b)]);
    }

    /// Whether the way over the sphere from a vertex to another leaves it between two neighbours,
    /// the first on the right, so that it crosses the edge that joins them.
    pub fn looks_between(
        &self,
        from: VertexId,
        [right, left]: [VertexId; 2],
        to: VertexId,
    ) -> bool {
        let [p, r, l, q] = [from, right, left, to].map(|v| self.sphere[v]);
        is_positive(p, r, q) && is_positive(p, q, l)
    }

    /// Whether an edge is saved from being turned.
    pub fn is_kept(&self, [a, b]: [VertexId; 2]) -> bool {
        self.kept.contains(&[a.min(b), a.max(b)])
    }

    /// The edge from a vertex to another.
    pub fn halfedge(&self, [a, b]: [VertexId; 2]) -> Option<HalfedgeId> {
        let mut around = self.triangulation.outgoing(a);
        around.find(|&h| self.triangulation.target(h) == b)
    }

    /// Whether the ways over the sphere between two vertices each cross.
    pub fn cross(&self, one: [VertexId; 2], other: [VertexId; 2]) -> bool {
        let [[a, b], [c, d]] = [one, other].map(|ends| ends.map(|v| self.sphere[v]));
        let is_left = is_positive(a, b, c) && is_positive(b, a, d);
        let is_right = is_positive(a, b, d) && is_positive(b, a, c);
        (is_left && is_positive(c, d, b) && is_positive(d, c, a))
            || (is_right && is_positive(c, d, a) && is_positive(d, c, b))
    }

    pub fn n_vertices(&self) -> usize {
        self.places.len()
    }

    pub fn place(&self, vertex: VertexId) -> SurfacePoint {
        self.places[vertex]
    }

    /// Where a vertex lies on the unit sphere.
    pub fn sphere(&self, vertex: VertexId) -> DVec3 {
        self.sphere[vertex]
    }

    /// Where a vertex lies on the surface.
    pub fn position(&self, vertex: VertexId) -> DVec3 {
        self.positions[vertex]
    }

    /// The face that a point of the sphere lies in, found by walking from a vertex.
    pub fn face_at(&self, point: DVec3, start: VertexId) -> FaceId {
        let start = self.triangulation.outgoing(start).next();
        let mut face = start.expect("every vertex has a face").face();
        // Among Delaunay triangles a walk never comes back (De Floriani et al. 1991).
        for _ in 0..3 * self.triangulation.n_faces() {
            let edges = [0, 1, 2].map(|i| HalfedgeId(face.0 * 3 + i));
            let beyond = |&h: &HalfedgeId| {
                let [a, b] = [self.triangulation.origin(h), self.triangulation.target(h)];
                is_positive(self.sphere[b], self.sphere[a], point)
            };
            match edges.into_iter().find(beyond) {
                Some(h) => face = self.triangulation.twin(h).face(),
                None => break,
            }
        }
        face
    }

    /// Puts a new vertex into a face and turns edges until the triangulation is Delaunay on the
    /// sphere; `false`, and nothing changed, when it does not lie strictly inside the face.
    pub fn insert(&mut self, face: FaceId, place: SurfacePoint) -> bool {
        let point = self.map.sphere_position(place);
        let [a, b, c] = self.triangulation.face(face).map(|v| self.sphere[v]);
        let inside =
            is_positive(a, b, point) && is_positive(b, c, point) && is_positive(c, a, point);
        if !inside {
            return false;
        }
        let new = self.triangulation.split(face);
        self.places.push(place);
        self.sphere.push(point);
        self.positions.push(self.map.surface_position(place));
        let fan = self.triangulation.outgoing(new);
        let mut open: Vec<HalfedgeId> = fan.map(HalfedgeId::next).collect();
        while let Some(h) = open.pop() {
            let twin = self.triangulation.twin(h);
            if self.is_inside_circle(h) && self.flip(h) {
                let around = [twin.next(), twin.prev(), h.next(), h.prev()];
                let faces_new = |&h: &HalfedgeId| self.triangulation.apex(h) == new;
                open.extend(around.into_iter().filter(faces_new));
            }
        }
        true
    }

    /// Whether the corner beyond an edge lies inside the circle of the triangle on this side.
    fn is_inside_circle(&self, h: HalfedgeId) -> bool {
        let [a, b, c] = self.triangulation.face(h.face());
        let d = self.triangulation.apex(self.triangulation.twin(h));
        let [a, b, c, d] = [a, b, c, d].map(|v| {
            let p = self.sphere[v];
            Coord3D {
                x: p.x,
                y: p.y,
                z: p.z,
            }
        });
        orient3d(a, b, c, d) < 0.0
    }

    /// Turns an edge if both new triangles are positive on the sphere.
    pub fn flip(&mut self, h: HalfedgeId) -> bool {
        let net = &self.triangulation;
        let twin = net.twin(h);
        let corners = [net.origin(h), net.apex(twin), net.target(h), net.apex(h)];
        let ends = [corners[0].min(corners[2]), corners[0].max(corners[2])];
        if self.kept.contains(&ends) {
            return false;
        }
        let [a, d, b, c] = corners.map(|v| self.sphere[v]);
        let allowed = is_positive(d, c, a) && is_positive(c, d, b) && net.can_flip(h);
        if allowed {
            self.triangulation.flip(h);
        }
        allowed
    }

    /// Moves a vertex along the surface towards a position in space, less far when that would
    /// fold a triangle; whether it moved.
    pub fn step(&mut self, vertex: VertexId, target: DVec3) -> bool {
        let from = self.positions[vertex];
        for share in [1.0, 0.5, 0.25] {
            let place = walk_along(self.map, self.places[vertex], from.lerp(target, share));
            let point = self.map.sphere_position(place);
            if self.may_stand_at(vertex, point) {
                self.places[vertex] = place;
                self.sphere[vertex] = point;
                self.positions[vertex] = self.map.surface_position(place);
                return true;
            }
        }
        false
    }

    fn may_stand_at(&self, vertex: VertexId, point: DVec3) -> bool {
        self.triangulation.outgoing(vertex).all(|h| {
            let [b, c] = [self.triangulation.target(h), self.triangulation.apex(h)];
            is_positive(point, self.sphere[b], self.sphere[c])
        })
    }

    /// The triangles as vertex indices and the sphere points of the vertices.
    pub fn into_parts(self) -> (Vec<[u32; 3]>, Vec<DVec3>) {
        let faces = self.triangulation.faces().map(|f| f.map(|v| v.0)).collect();
        (faces, self.sphere.into_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::shapes;

    fn limbs() -> SphereMap {
        let sphere = VertexMap::from_vec(shapes::sphere(10).positions().to_vec());
        SphereMap::prove(shapes::limbs(3, 10), sphere).unwrap()
    }

    fn net(map: &SphereMap) -> Net<'_> {
        let mut random = Random::new(8);
        let mut net = Net::tetrahedron(map);
        for _ in 0..200 {
            let face = FaceId(random.below(map.mesh().n_faces()) as u32);
            let weights = [0.2, 0.3, 0.5];
            let point = map.sphere_position(SurfacePoint { face, weights });
            let at = net.face_at(point, VertexId(2));
            net.insert(at, SurfacePoint { face, weights });
        }
        net
    }

    fn is_positive_everywhere(net: &Net) -> bool {
        let positive =
            |f: [VertexId; 3]| is_positive(net.sphere[f[0]], net.sphere[f[1]], net.sphere[f[2]]);
        net.triangulation.faces().all(positive)
    }

    #[test]
    fn inserted_vertices_are_joined_by_a_delaunay_triangulation() {
        let map = limbs();
        let net = net(&map);
        assert!(net.n_vertices() > 150);
        assert_eq!(net.triangulation.n_faces(), 2 * net.n_vertices() - 4);
        assert!(is_positive_everywhere(&net));
        let mut edges = net.triangulation.halfedge_ids();
        assert!(edges.all(|h| !net.is_inside_circle(h)));
    }

    #[test]
    fn a_place_that_is_taken_is_refused() {
        let map = limbs();
        let mut net = net(&map);
        let before = net.n_vertices();
        for vertex in [0, 1, 50].map(VertexId) {
            let face = net.face_at(net.sphere(vertex), VertexId(7));
            assert!(!net.insert(face, net.place(vertex)));
        }
        assert_eq!(net.n_vertices(), before);
    }

    #[test]
    fn no_step_and_no_flip_folds_a_triangle() {
        let map = limbs();
        let mut net = net(&map);
        let mut random = Random::new(4);
        let mut n_moved = 0;
        for _ in 0..2000 {
            let vertex = VertexId(random.below(net.n_vertices()) as u32);
            let mut shift = || random.unit() - 0.5;
            let target = net.position(vertex) + DVec3::new(shift(), shift(), shift());
            n_moved += usize::from(net.step(vertex, target));
            net.flip(HalfedgeId(
                random.below(3 * net.triangulation.n_faces()) as u32
            ));
        }
        assert!(n_moved > 500, "{n_moved}");
        assert!(is_positive_everywhere(&net));
    }
}
