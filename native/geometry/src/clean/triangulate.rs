//! Polygons to triangles.

use std::collections::BTreeMap;

use glam::DVec3;

use super::edges::Edges;
use super::polygons::Polygons;
use super::scale::Scale;
use crate::measure::clip_ears;
use crate::mesh::{FaceId, HalfedgeId, Id, PolygonMesh, VertexId};

/// A diagonal must be shorter than the other by more than this share to be taken instead: the
/// diagonals of a square that was turned in space differ by rounding alone.
const CLEARLY_SHORTER: f64 = 1e-9;

/// The triangles of some polygons, with the polygon and the input face of each.
pub(super) struct Triangulated {
    /// The input's positions, then centres of polygons that were cut from their centre.
    pub(super) positions: Vec<DVec3>,
    /// For each position the input vertex that stands for it in messages.
    pub(super) origins: Vec<VertexId>,
    pub(super) faces: Vec<[VertexId; 3]>,
    pub(super) source: Vec<FaceId>,
    polygon: Vec<u32>,
    /// How each polygon is cut that is not cut the usual way.
    ways: BTreeMap<u32, Way>,
    scale: Scale,
    n_input: usize,
}

/// How a polygon is cut.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// A quad by its better diagonal, others by clipping ears.
    Usual,
    /// A quad by its other diagonal.
    OtherDiagonal,
    /// From a new vertex at the centre, which never meets what others do.
    Centre,
}

impl Triangulated {
    pub(super) fn new(input: &PolygonMesh, polygons: &Polygons) -> Self {
        let mut triangulated = Self {
            positions: input.positions().to_vec(),
            origins: (0..input.n_vertices()).map(VertexId::from_index).collect(),
            faces: Vec::with_capacity(polygons.corners().len() - 2 * polygons.len()),
            source: Vec::new(),
            polygon: Vec::new(),
            ways: BTreeMap::new(),
            scale: Scale::of(input.positions()),
            n_input: input.n_vertices(),
        };
        triangulated.cut_all(polygons);
        triangulated
    }

    /// Cuts all polygons, which need not be those from before.
    pub(super) fn cut_all(&mut self, polygons: &Polygons) {
        self.positions.truncate(self.n_input);
        self.origins.truncate(self.n_input);
        self.faces.clear();
        self.source.clear();
        self.polygon.clear();
        for i in 0..polygons.len() {
            let way = self.ways.get(&(i as u32)).copied();
            self.cut(polygons.polygon(i), way.unwrap_or(Way::Usual));
            self.source.resize(self.faces.len(), polygons.source(i));
            self.polygon.resize(self.faces.len(), i as u32);
        }
    }

    /// Whether a triangle has no area, as far as rounding lets one see.
    pub(super) fn is_flat(&self, face: [VertexId; 3]) -> bool {
        let corners = face.map(|v| self.positions[v.index()]);
        self.scale.is_flat(corners)
    }

    /// The place of a vertex, in a scale in which products are safe.
    pub(super) fn scaled(&self, vertex: VertexId) -> DVec3 {
        self.scale.point(self.positions[vertex.index()])
    }

    /// Where a side of a triangle starts and ends.
    pub(super) fn ends(&self, h: HalfedgeId) -> [VertexId; 2] {
        let face = self.faces[h.face().index()];
        [face[h.corner()], face[h.next().corner()]]
    }

    /// The polygon that a triangle is a piece of.
    pub(super) fn polygon_of(&self, face: FaceId) -> u32 {
        self.polygon[face.index()]
    }

    pub(super) fn is_face_flat(&self, face: FaceId) -> bool {
        self.is_flat(self.faces[face.index()])
    }

    /// Keeps some of the triangles only.
    pub(super) fn keep(&mut self, is_kept: &[bool]) {
        let flags = || is_kept.iter().copied();
        let mut kept = flags();
        self.faces.retain(|_| kept.next() == Some(true));
        let mut kept = flags();
        self.source.retain(|_| kept.next() == Some(true));
        let mut kept = flags();
        self.polygon.retain(|_| kept.next() == Some(true));
    }

    /// A vertex more, which messages call by another.
    pub(super) fn add(&mut self, position: DVec3, like: VertexId) -> VertexId {
        let vertex = VertexId::from_index(self.positions.len());
        self.positions.push(position);
        self.origins.push(self.origins[like.index()]);
        vertex
    }

    /// Replaces all triangles by pieces of them, each with the triangle that it is a piece of.
    pub(super) fn replace(&mut self, pieces: &[(FaceId, [VertexId; 3])]) {
        self.faces = pieces.iter().map(|(_, piece)| *piece).collect();
        let of = |f: &FaceId| (self.source[f.index()], self.polygon[f.index()]);
        (self.source, self.polygon) = pieces.iter().map(|(face, _)| of(face)).unzip();
    }

    fn cut(&mut self, polygon: &[VertexId], way: Way) {
        match (polygon, way) {
            (_, Way::Centre) => self.cut_from_centre(polygon),
            (&[a, b, c], _) => self.faces.push([a, b, c]),
            (&[a, b, c, d], _) => {
                let usual = self.prefers_first_diagonal([a, b, c, d]);
                self.faces.extend(if usual == (way == Way::Usual) {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[b, c, d], [b, d, a]]
                });
            }
            _ => {
                let point = |v: &VertexId| self.scale.point(self.positions[v.index()]);
                let points: Vec<DVec3> = polygon.iter().map(point).collect();
                match clip_ears(&points) {
                    Some(triangles) => {
                        let faces = triangles
                            .into_iter()
                            .map(|t| t.map(|i| polygon[i as usize]));
                        let is_face =
                            |f: &[VertexId; 3]| f[0] != f[1] && f[1] != f[2] && f[2] != f[0];
                        self.faces.extend(faces.filter(is_face));
                    }
                    None => self.cut_from_centre(polygon),
                }
            }
        }
    }

    fn cut_from_centre(&mut self, polygon: &[VertexId]) {
        let share = 1.0 / polygon.len() as f64;
        let centre = polygon
            .iter()
            .map(|v| self.positions[v.index()] * share)
            .sum();
        let vertex = VertexId::from_index(self.positions.len());
        self.positions.push(centre);
        self.origins.push(polygon[0]);
        let next = polygon.iter().cycle().skip(1);
        self.faces
            .extend(polygon.iter().zip(next).map(|(&a, &b)| [vertex, a, b]));
    }

    /// Whether a quad is better cut from its first to its third corner: the diagonal that lies
    /// inside of it; the shorter one if both or none do; the first if they are equal.
    fn prefers_first_diagonal(&self, quad: [VertexId; 4]) -> bool {
        let [a, b, c, d] = quad.map(|v| self.scale.point(self.positions[v.index()]));
        let normal = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p);
        let first = normal(a, b, c).dot(normal(a, c, d)) > 0.0;
        let second = normal(b, c, d).dot(normal(b, d, a)) > 0.0;
        if first != second {
            return first;
        }
        let [first, second] = [(c - a).length_squared(), (d - b).length_squared()];
        first <= second * (1.0 + CLEARLY_SHORTER)
    }

    /// Cuts polygons another way whose diagonals give an edge more than two triangles, and says
    /// whether there were any. Two quads with the same two opposite corners, for one, must not
    /// both be cut there.
    pub(super) fn resolve_conflicts(&mut self, edges: &Edges, polygons: &Polygons) -> bool {
        let mut wrong = Vec::new();
        for run in edges.runs().filter(|run| run.len() > 2) {
            let mut owners: Vec<u32> = run.iter().map(|h| self.polygon[h.face().index()]).collect();
            owners.sort_unstable();
            // A polygon that is twice at an edge has a diagonal there.
            let twice: Vec<u32> = owners
                .chunk_by(|a, b| a == b)
                .filter(|run| run.len() > 1)
                .map(|run| run[0])
                .collect();
            let n_sides = owners.len() - 2 * twice.len();
            wrong.extend(twice.into_iter().skip(usize::from(n_sides == 0)));
        }
        wrong.retain(|i| self.ways.get(i) != Some(&Way::Centre));
        wrong.sort_unstable();
        wrong.dedup();
        for &i in &wrong {
            let is_quad = polygons.polygon(i as usize).len() == 4;
            let way = match self.ways.get(&i) {
                None if is_quad => Way::OtherDiagonal,
                _ => Way::Centre,
            };
            self.ways.insert(i, way);
        }
        if !wrong.is_empty() {
            self.cut_all(polygons);
        }
        !wrong.is_empty()
    }
}
