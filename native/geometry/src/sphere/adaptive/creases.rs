//! Vertices on creases, which stay there, and the edges between them.

use std::collections::HashMap;

use glam::DVec3;

use super::Net;
use crate::measure::{FeatureLine, face_areas};
use crate::mesh::{FaceId, TriangleMesh, VertexId, VertexMap};
use crate::nearest::Bvh;
use crate::sphere_map::{SphereMap, SurfacePoint};

/// Other vertices keep this share of an edge away from those on creases: nearer ones make slivers,
/// farther ones leave gaps beside the crease.
const ROOM: f64 = 0.6;
/// How far into its face a vertex is put that lies on an edge of the net, in weights.
const ASIDE: [f64; 4] = [0.0, 1e-12, 1e-9, 1e-6];
/// More edges are not turned to make way for one between two vertices of a crease.
const MOST_TURNS: usize = 50;

/// Places along lines.
#[derive(Default)]
pub struct Creases {
    pub places: Vec<SurfacePoint>,
    /// Those that lie next to each other on a line.
    pub pairs: Vec<[usize; 2]>,
    positions: Vec<DVec3>,
    /// How long edges are wanted at each.
    sizes: Vec<f64>,
}

impl Creases {
    /// Places along the lines of a map's mesh, as far apart as edges are long where `n_faces`
    /// triangles are spread by a density; the ends of lines are among them.
    pub fn new(
        map: &SphereMap,
        (density, lines): (&VertexMap<f64>, &[FeatureLine]),
        n_faces: usize,
    ) -> Self {
        let mesh = map.mesh();
        let mut creases = Self::default();
        let mut at_vertex: HashMap<VertexId, usize> = HashMap::new();
        let unit = edge_of_density_one(mesh, density, n_faces);
        for line in lines {
            let n_ends = line.vertices.len() as f64;
            let density = line.vertices.iter().map(|&v| density[v]).sum::<f64>() / n_ends;
            let size = unit / density.sqrt();
            let least = if line.is_closed() { 3.0 } else { 1.0 };
            let n = (line.length() / size).round().max(least);
            let mut before = None;
            for i in 0..=n as usize {
                let ([a, b], share) = line.between(line.length() * i as f64 / n);
                let end = (i == 0).then_some(a).or((i == n as usize).then_some(b));
                let known = end.and_then(|v| at_vertex.get(&v).copied());
                let name = known.unwrap_or_else(|| {
                    let share = if end == Some(b) { 1.0 } else { share };
                    creases.add(map, place_between(mesh, [a, b], share), size)
                });
                if let Some(v) = end {
                    at_vertex.insert(v, name);
                }
                creases.pairs.extend(before.map(|before| [before, name]));
                before = Some(name);
            }
        }
        creases
    }

    fn add(&mut self, map: &SphereMap, place: SurfacePoint, size: f64) -> usize {
        self.places.push(place);
        self.positions.push(map.surface_position(place));
        self.sizes.push(size);
        self.places.len() - 1
    }

    /// Those of some places that leave the creases room.
    pub fn clear(&self, map: &SphereMap, mut places: Vec<SurfacePoint>) -> Vec<SurfacePoint> {
        if self.places.is_empty() {
            return places;
        }
        let tree = Bvh::of_points(&self.positions);
        places.retain(|&place| {
            let closest = tree.closest(map.surface_position(place));
            let size = self.sizes[closest.face.0 as usize];
            closest.distance_squared > (ROOM * size).powi(2)
        });
        places
    }

    /// Puts the places into a net and fixes what joins them.
    pub fn insert(&self, net: &mut Net) -> Inserted {
        let names: Vec<Option<VertexId>> = self
            .places
            .iter()
            .map(|&place| insert_exactly(net, place))
            .collect();
        let mut edges = Vec::with_capacity(self.pairs.len());
        for pair in &self.pairs {
            if let [Some(a), Some(b)] = pair.map(|i| names[i])
                && join(net, [a, b])
            {
                net.keep_edge(a, b);
                edges.push([a.min(b), a.max(b)]);
            }
        }
        edges.sort_unstable();
        Inserted {
            vertices: names.into_iter().flatten().collect(),
            n_apart: self.pairs.len() - edges.len(),
            edges,
        }
    }
}

/// Places in a net.
pub struct Inserted {
    pub vertices: Vec<VertexId>,
    /// The edges that join neighbours on a line, each once, smaller end first, in order.
    pub edges: Vec<[VertexId; 2]>,
    /// How many neighbours could not be joined.
    pub n_apart: usize,
}

/// How long the edges of even triangles are where the density is 1.
fn edge_of_density_one(mesh: &TriangleMesh, density: &VertexMap<f64>, n_faces: usize) -> f64 {
    let wanted = |face: FaceId| mesh.face(face).map(|v| density[v]).into_iter().sum::<f64>() / 3.0;
    let areas = face_areas(mesh);
    let total: f64 = areas.iter_ids().map(|(f, area)| area * wanted(f)).sum();
    (total / n_faces as f64 * 4.0 / 3f64.sqrt()).sqrt()
}

/// The place a share of the way along an edge of a mesh.
fn place_between(mesh: &TriangleMesh, [a, b]: [VertexId; 2], share: f64) -> SurfacePoint {
    let along = mesh.outgoing(a).find(|&h| mesh.target(h) == b);
    let h = along.expect("a line follows edges");
    let mut weights = [0.0; 3];
    weights[h.corner()] = 1.0 - share;
    weights[h.next().corner()] = share;
    SurfacePoint {
        face: h.face(),
        weights,
    }
}

/// Inserts a place, or one a hair beside it where it lies on an edge.
fn insert_exactly(net: &mut Net, place: SurfacePoint) -> Option<VertexId> {
    let last = VertexId(net.n_vertices() as u32 - 1);
    for aside in ASIDE {
        let weights = place.weights.map(|w| (1.0 - aside) * w + aside / 3.0);
        let place = SurfacePoint { weights, ..place };
        let face = net.face_at(net.map.sphere_position(place), last);
        if net.insert(face, place) {
            return Some(VertexId(net.n_vertices() as u32 - 1));
        }
    }
    None
}

/// Turns the edges between two vertices until one joins them.
fn join(net: &mut Net, [a, b]: [VertexId; 2]) -> bool {
    for _ in 0..MOST_TURNS {
        if net.triangulation.neighbours(a).any(|v| v == b) {
            return true;
        }
        let across = net.triangulation.outgoing(a).find(|&h| {
            let ends = [net.triangulation.target(h), net.triangulation.apex(h)];
            net.looks_between(a, ends, b)
        });
        let Some(h) = across else { return false };
        if !net.flip(h.next()) {
            return false;
        }
    }
    false
}
