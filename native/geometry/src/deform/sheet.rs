//! The moving mesh: faces whose vertices live on the surface and on the sphere at once.

use std::array;
use std::collections::HashSet;
use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;

use crate::elementary::sin_cos;
use crate::mesh::{FaceId, FaceMap, PolygonMesh, VertexId, VertexMap};
use crate::sphere_map::{SphereMap, SurfacePoint, is_unfolded, stays_cover, walk_along};

/// Cosine between a quad's own normal and the surface's below which the quad counts as turned over.
const LEAST_AGREEMENT: f64 = 0.2;

/// A triangle or a quad.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Face {
    corners: [VertexId; 4],
    n: u8,
}

impl Face {
    /// A face of three or four corners.
    pub fn new(corners: &[VertexId]) -> Self {
        let mut all = [corners[0]; 4];
        all[..corners.len()].copy_from_slice(corners);
        Self {
            corners: all,
            n: corners.len() as u8,
        }
    }

    pub fn corners(&self) -> &[VertexId] {
        &self.corners[..self.n as usize]
    }

    /// The corner `steps` after corner `i`, around and around.
    pub fn corner(&self, i: usize, steps: usize) -> VertexId {
        self.corners[(i + steps) % self.n as usize]
    }

    /// Which corner a vertex is.
    pub fn find(&self, vertex: VertexId) -> Option<usize> {
        self.corners().iter().position(|&v| v == vertex)
    }
}

/// Where a vertex is: on the map's surface, on the sphere, and in space.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Point {
    pub position: DVec3,
    /// The normal of the map's surface there.
    pub normal: DVec3,
    pub sphere: DVec3,
    pub place: SurfacePoint,
}

impl Point {
    /// Eight unit vectors along the surface, an eighth of a turn apart.
    pub fn ways(&self) -> [DVec3; 8] {
        let (x, y) = self.normal.any_orthonormal_pair();
        array::from_fn(|i| {
            let (sin, cos) = sin_cos(i as f64 * TAU / 8.0);
            x * cos + y * sin
        })
    }
}

/// A primitive that is being deformed. Its faces always cover the sphere once: every move and flip
/// keeps each face two positive spherical triangles, or one.
#[derive(Clone)]
pub(super) struct Sheet<'a> {
    map: &'a SphereMap,
    surface_normals: VertexMap<DVec3>,
    faces: FaceMap<Face>,
    rings: VertexMap<Vec<FaceId>>,
    points: VertexMap<Point>,
    pinned: VertexMap<bool>,
    /// Edges that no flip takes away, smaller end first.
    kept: HashSet<[VertexId; 2]>,
}

impl<'a> Sheet<'a> {
    /// Puts a primitive of triangles and quads onto the map's surface.
    pub fn new(map: &'a SphereMap, normals: VertexMap<DVec3>, primitive: &PolygonMesh) -> Self {
        let faces: FaceMap<Face> = primitive.faces().map(Face::new).collect();
        let mut rings = VertexMap::filled(primitive.n_vertices(), Vec::with_capacity(6));
        for (face, corners) in faces.iter_ids() {
            for &v in corners.corners() {
                rings[v].push(face);
            }
        }
        let places = primitive.positions().par_iter().map(|&direction| {
            let place = map.locate(direction);
            Point {
                sphere: direction,
                ..point_at(map, &normals, place)
            }
        });
        let points = VertexMap::from_vec(places.collect());
        let pinned = VertexMap::filled(points.len(), false);
        Self {
            map,
            surface_normals: normals,
            faces,
            rings,
            points,
            pinned,
            kept: HashSet::new(),
        }
    }

    pub fn n_vertices(&self) -> usize {
        self.points.len()
    }

    pub fn vertex_ids(&self) -> impl ExactSizeIterator<Item = VertexId> + use<> {
        self.points.ids()
    }

    pub fn faces(&self) -> &FaceMap<Face> {
        &self.faces
    }

    /// The faces at a vertex, in no particular order.
    pub fn ring(&self, vertex: VertexId) -> &[FaceId] {
        &self.rings[vertex]
    }

    pub fn point(&self, vertex: VertexId) -> &Point {
        &self.points[vertex]
    }

    pub fn position(&self, vertex: VertexId) -> DVec3 {
        self.points[vertex].position
    }

    /// Where every vertex is in space.
    pub fn positions(&self) -> VertexMap<DVec3> {
        self.points.iter().map(|point| point.position).collect()
    }

    /// Lifts every vertex to a position.
    pub fn lift_all(&mut self, positions: &VertexMap<DVec3>) {
        for (v, &position) in positions.iter_ids() {
            self.lift(v, position);
        }
    }

    /// Makes a vertex stay where it is led.
    pub fn pin(&mut self, vertex: VertexId) {
        self.pinned[vertex] = true;
    }

    pub fn unpin(&mut self, vertex: VertexId) {
        self.pinned[vertex] = false;
    }

    pub fn is_pinned(&self, vertex: VertexId) -> bool {
        self.pinned[vertex]
    }

    /// Saves an edge, which lies along a sharp one, from flips.
    pub fn keep_edge(&mut self, a: VertexId, b: VertexId) {
        self.kept.insert([a.min(b), a.max(b)]);
    }

    /// Whether an edge is saved from flips.
    pub fn is_kept(&self, a: VertexId, b: VertexId) -> bool {
        self.kept.contains(&[a.min(b), a.max(b)])
    }

    /// The edges that are saved from flips, in order.
    pub fn led(&self) -> Vec<[VertexId; 2]> {
        let mut edges: Vec<_> = self.kept.iter().copied().collect();
        edges.sort_unstable();
        edges
    }

    /// Those that have both ends where they were led, in order.
    pub fn features(&self) -> Vec<[VertexId; 2]> {
        let is_there = |[a, b]: &[VertexId; 2]| self.is_pinned(*a) && self.is_pinned(*b);
        self.led().into_iter().filter(is_there).collect()
    }

    /// The face on the left of the edge from `a` to `b`.
    pub fn face_left_of(&self, a: VertexId, b: VertexId) -> Option<FaceId> {
        let leaves = |face: &FaceId| {
            let face = &self.faces[*face];
            face.find(a).is_some_and(|i| face.corner(i, 1) == b)
        };
        self.rings[a].iter().copied().find(leaves)
    }

    /// The area of a face, flattened.
    pub fn area(&self, face: FaceId) -> f64 {
        let p = |i| self.position(self.faces[face].corner(0, i));
        match self.faces[face].corners().len() {
            3 => (p(1) - p(0)).cross(p(2) - p(0)).length() / 2.0,
            _ => (p(2) - p(0)).cross(p(3) - p(1)).length() / 2.0,
        }
    }

    /// The mean length of all edges.
    pub fn mean_edge(&self) -> f64 {
        let lengths = |face: &Face| {
            let edge = |i| {
                self.position(face.corner(0, i))
                    .distance(self.position(face.corner(1, i)))
            };
            (0..face.corners().len()).map(edge).sum::<f64>()
        };
        let n_corners: usize = self.faces.iter().map(|face| face.corners().len()).sum();
        self.faces.iter().map(lengths).sum::<f64>() / n_corners.max(1) as f64
    }

    /// The mesh in space and the sphere point of every vertex.
    pub fn into_mesh(self) -> (PolygonMesh, Vec<DVec3>) {
        let faces: Vec<Vec<u32>> = self
            .faces
            .iter()
            .map(|f| f.corners().iter().map(|v| v.0).collect())
            .collect();
        let positions = self.points.iter().map(|p| p.position).collect();
        let mesh = PolygonMesh::from_faces(positions, &faces);
        let sphere = self.points.iter().map(|p| p.sphere).collect();
        (
            mesh.expect("vertices only move to finite positions"),
            sphere,
        )
    }

    /// The vertex's whereabouts after a walk on the map's surface towards a position in space.
    pub fn walked(&self, vertex: VertexId, wanted: DVec3) -> Point {
        let place = walk_along(self.map, self.points[vertex].place, wanted);
        point_at(self.map, &self.surface_normals, place)
    }

    /// Moves a vertex unless that folds a face on the sphere.
    pub fn try_move(&mut self, vertex: VertexId, to: Point) -> bool {
        let fits = to.position.is_finite() && self.covers(vertex, to.sphere);
        if fits {
            self.points[vertex] = to;
        }
        fits
    }

    /// Moves a vertex in space only; its sphere point stays.
    pub fn lift(&mut self, vertex: VertexId, position: DVec3) {
        if position.is_finite() {
            self.points[vertex].position = position;
        }
    }

    /// Says what the normals are, where vertices have left the places that they had theirs from.
    pub fn turn(&mut self, normals: &VertexMap<DVec3>) {
        for (v, &normal) in normals.iter_ids() {
            self.points[v].normal = normal;
        }
    }

    /// Whether the faces cover the sphere once with another sphere point for a vertex.
    pub fn covers(&self, vertex: VertexId, sphere: DVec3) -> bool {
        let ring = self.rings[vertex].iter();
        let ring = ring.map(|&face| self.faces[face].corners());
        stays_cover(ring, (vertex, sphere), |v| self.points[v].sphere)
    }

    /// The worst quality of the faces at a vertex if it were at `to`.
    pub fn worst_quality(&self, vertex: VertexId, to: &Point) -> f64 {
        let at = |v: VertexId| if v == vertex { to } else { &self.points[v] };
        let qualities = self.rings[vertex]
            .iter()
            .map(|&face| quality(&self.faces[face], at));
        qualities.fold(f64::INFINITY, f64::min)
    }

    /// How bad the faces at a vertex were if it were at `to`: Σ (enough − quality)² over those
    /// that are worse than `enough`.
    pub fn badness(&self, vertex: VertexId, to: &Point, enough: f64) -> f64 {
        let at = |v: VertexId| if v == vertex { to } else { &self.points[v] };
        let lacks = self.rings[vertex]
            .iter()
            .map(|&face| (enough - quality(&self.faces[face], at)).max(0.0).powi(2));
        lacks.sum()
    }

    /// The quality of a face.
    pub fn quality(&self, face: FaceId) -> f64 {
        quality(&self.faces[face], |v| &self.points[v])
    }

    /// The quality of a face that is not there yet.
    pub fn quality_of(&self, corners: &[VertexId]) -> f64 {
        quality(&Face::new(corners), |v| &self.points[v])
    }

    /// Whether a face that is not there yet would be positive on the sphere.
    pub fn is_unfolded(&self, corners: &[VertexId]) -> bool {
        is_unfolded(corners, |v| self.points[v].sphere)
    }

    /// Replaces two triangles by the two over the other diagonal: `a b` becomes `c d`, where c
    /// lies left of `a b` and d right of it. The caller has checked that both will be positive.
    pub fn flip(&mut self, [left, right]: [FaceId; 2], [a, b, c, d]: [VertexId; 4]) {
        self.faces[left] = Face::new(&[a, d, c]);
        self.faces[right] = Face::new(&[d, b, c]);
        self.rings[a].retain(|&face| face != right);
        self.rings[b].retain(|&face| face != left);
        self.rings[c].push(right);
        self.rings[d].push(left);
    }
}

fn point_at(map: &SphereMap, normals: &VertexMap<DVec3>, place: SurfacePoint) -> Point {
    let corners = map.mesh().face(place.face);
    let [u, v, w] = place.weights;
    let sum = normals[corners[0]] * u + normals[corners[1]] * v + normals[corners[2]] * w;
    Point {
        position: map.surface_position(place),
        normal: sum.normalize_or_zero(),
        sphere: map.sphere_position(place),
        place,
    }
}

/// How near a face is to a regular polygon seen along the surface's normal: 1 for a regular
/// one, 0 for one without area, negative where a corner turns the wrong way.
///
/// Triangles: 2√3 × twice the area / Σ squared edges. Quads: the scaled Jacobian, the sine of the
/// worst corner, seen along the quad's own normal, and where that does not look out of the surface
/// along the surface's too.
fn quality<'p>(face: &Face, at: impl Fn(VertexId) -> &'p Point) -> f64 {
    let corners = face.corners.map(at);
    let p = corners.map(|c| c.position);
    if face.n == 3 {
        let normal =
            (corners[0].normal + corners[1].normal + corners[2].normal).normalize_or_zero();
        let [e, f, g] = [p[1] - p[0], p[2] - p[1], p[0] - p[2]];
        let squares = e.length_squared() + f.length_squared() + g.length_squared();
        return 2.0 * 3.0f64.sqrt() * e.cross(f).dot(normal) / squares.max(f64::MIN_POSITIVE);
    }
    let sum = corners.iter().fold(DVec3::ZERO, |sum, c| sum + c.normal);
    let outward = sum.normalize_or_zero();
    let own = (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero();
    let edge = |i: usize| (p[(i + 1) % 4] - p[i]).normalize_or_zero();
    let edges = [edge(0), edge(1), edge(2), edge(3)];
    let turns = [0, 1, 2, 3].map(|i| edges[i].cross(edges[(i + 1) % 4]));
    let worst = |normal: DVec3| {
        turns
            .iter()
            .fold(1.0, |least: f64, turn| least.min(turn.dot(normal)))
    };
    if own.dot(outward) > LEAST_AGREEMENT {
        worst(own)
    } else {
        worst(own).min(worst(outward))
    }
}
