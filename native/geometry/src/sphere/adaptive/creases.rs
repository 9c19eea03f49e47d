//! Vertices on creases, which stay there, and the edges between them.

use std::collections::{BTreeSet, HashMap, VecDeque};

use glam::DVec3;

use super::Net;
use crate::measure::{FeatureLine, face_areas};
use crate::mesh::{FaceId, HalfedgeId, TriangleMesh, VertexId, VertexMap};
use crate::nearest::Bvh;
use crate::sphere_map::{SphereMap, SurfacePoint};

/// Other vertices keep this share of an edge away from those on creases: nearer ones make slivers,
/// farther ones leave gaps beside the crease.
const ROOM: f64 = 0.6;
/// How far into its face a vertex is put that lies on an edge of the net, in weights.
const ASIDE: [f64; 4] = [0.0, 1e-12, 1e-9, 1e-6];
/// More edges are not turned to make way for one between two vertices of a crease.
const MOST_TURNS: usize = 50;
/// Stops of a line that are nearer to each other than this share of a step are one.
const NARROW: f64 = 1e-3;

/// Where vertices are wanted along lines: arc lengths, from end to end of each.
pub struct Stops<'a> {
    lines: &'a [FeatureLine],
    /// How long edges are wanted along each.
    sizes: Vec<f64>,
    at: Vec<Vec<f64>>,
}

/// All lines together have no more steps than this for each face.
const MOST_STEPS: f64 = 2.0;

impl<'a> Stops<'a> {
    /// As far apart as edges are long where `n_faces` triangles are spread by a density.
    pub fn new(
        map: &SphereMap,
        (density, lines): (&VertexMap<f64>, &'a [FeatureLine]),
        n_faces: usize,
    ) -> Self {
        let unit = edge_of_density_one(map.mesh(), density, n_faces);
        let size = |line: &FeatureLine| {
            let n_ends = line.vertices.len() as f64;
            let density = line.vertices.iter().map(|&v| density[v]).sum::<f64>() / n_ends;
            unit / density.sqrt()
        };
        let mut sizes: Vec<f64> = lines.iter().map(size).collect();
        let n_steps = lines
            .iter()
            .zip(&sizes)
            .map(|(line, size)| line.length() / size);
        let n_steps = n_steps.sum::<f64>();
        let most = MOST_STEPS * n_faces as f64;
        if n_steps > most {
            // A part that is all border has next to no area for its length.
            for (line, size) in lines.iter().zip(&mut sizes) {
                *size = (*size * n_steps / most).max(line.length() / most);
            }
        }
        let stops = |(line, size): (&FeatureLine, &f64)| {
            let least = if line.is_closed() { 3.0 } else { 1.0 };
            let n = (line.length() / size).round().max(least);
            let at = (0..=n as usize).map(|i| line.length() * i as f64 / n);
            at.collect()
        };
        Self {
            at: lines.iter().zip(&sizes).map(stops).collect(),
            lines,
            sizes,
        }
    }

    /// One more between each two that are named: at the vertex of the line that is nearest to their
    /// middle. False if there is none between any.
    pub fn refine(&mut self, mesh: &TriangleMesh, rough: &BTreeSet<Step>) -> bool {
        let mut is_finer = false;
        // From behind, so that the numbers of those before stay.
        for step in rough.iter().rev() {
            let at = &mut self.at[step.line];
            let [from, to] = [at[step.from], at[step.from + 1]];
            let middle = 0.5 * (from + to);
            let least = NARROW * (to - from);
            let places = lengths(mesh, &self.lines[step.line]);
            let between = places.filter(|place| *place > from + least && *place < to - least);
            let nearest = between.min_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs()));
            if let Some(place) = nearest {
                at.insert(step.from + 1, place);
                is_finer = true;
            }
        }
        is_finer
    }

    /// The steps of a line.
    pub fn steps(&self, line: usize) -> impl Iterator<Item = Step> {
        (1..self.at[line].len()).map(move |to| Step { line, from: to - 1 })
    }
}

/// From a stop of a line to the next.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Step {
    pub line: usize,
    pub from: usize,
}

/// How far along a line its vertices lie.
fn lengths(mesh: &TriangleMesh, line: &FeatureLine) -> impl Iterator<Item = f64> {
    let steps = line.vertices.windows(2);
    steps.scan(0.0, |length, ends| {
        *length += mesh.position(ends[0]).distance(mesh.position(ends[1]));
        Some(*length)
    })
}

/// Places along lines.
#[derive(Default)]
pub struct Creases {
    pub places: Vec<SurfacePoint>,
    /// Those that lie next to each other on a line, and between which stops.
    pub pairs: Vec<([usize; 2], Step)>,
    positions: Vec<DVec3>,
    /// How long edges are wanted at each.
    sizes: Vec<f64>,
}

impl Creases {
    /// The places of stops along lines of a map's mesh; the ends of lines are among them.
    pub fn new(map: &SphereMap, stops: &Stops<'_>) -> Self {
        let mesh = map.mesh();
        let mut creases = Self::default();
        let mut at_vertex: HashMap<VertexId, usize> = HashMap::new();
        for (number, line) in stops.lines.iter().enumerate() {
            let (at, size) = (&stops.at[number], stops.sizes[number]);
            let mut before = None;
            for (i, &length) in at.iter().enumerate() {
                let ([a, b], share) = line.between(length);
                let is_last = i + 1 == at.len();
                let end = (i == 0).then_some(a).or(is_last.then_some(b));
                let known = end.and_then(|v| at_vertex.get(&v).copied());
                let name = known.unwrap_or_else(|| {
                    let share = if end == Some(b) { 1.0 } else { share };
                    creases.add(map, place_between(mesh, [a, b], share), size)
                });
                if let Some(v) = end {
                    at_vertex.insert(v, name);
                }
                let step = |before| {
                    (
                        [before, name],
                        Step {
                            line: number,
                            from: i - 1,
                        },
                    )
                };
                creases.pairs.extend(before.map(step));
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
        let mut inserted = Inserted::default();
        let mut step_of: HashMap<[VertexId; 2], Step> = HashMap::new();
        for (pair, step) in &self.pairs {
            let [Some(a), Some(b)] = pair.map(|i| names[i]) else {
                inserted.rough.insert(*step);
                continue;
            };
            match join(net, [a, b]) {
                Ok(()) => {
                    net.keep_edge(a, b);
                    let ends = [a.min(b), a.max(b)];
                    step_of.insert(ends, *step);
                    inserted.edges.push(ends);
                    inserted.along.push(([a, b], *step));
                }
                Err(in_the_way) => {
                    inserted.rough.insert(*step);
                    let known = in_the_way.iter().filter_map(|ends| step_of.get(ends));
                    inserted.rough.extend(known);
                }
            }
        }
        inserted.edges.sort_unstable();
        inserted.n_apart = self.pairs.len() - inserted.edges.len();
        inserted.vertices = names.into_iter().flatten().collect();
        inserted
    }
}

/// Places in a net.
#[derive(Default)]
pub struct Inserted {
    pub vertices: Vec<VertexId>,
    /// The edges that join neighbours on a line, each once, smaller end first, in order.
    pub edges: Vec<[VertexId; 2]>,
    /// The same along their lines.
    pub along: Vec<([VertexId; 2], Step)>,
    /// How many neighbours could not be joined.
    pub n_apart: usize,
    /// They, and those whose edges were in the way.
    pub rough: BTreeSet<Step>,
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

/// Turns the edges between two vertices until one joins them; else the edges in the way that stay.
fn join(net: &mut Net, [a, b]: [VertexId; 2]) -> Result<(), Vec<[VertexId; 2]>> {
    for _ in 0..MOST_TURNS {
        if net.triangulation.neighbours(a).any(|v| v == b) {
            return Ok(());
        }
        let across = first_across(net, [a, b]);
        let Some(h) = across else { break };
        if !net.flip(h) {
            break;
        }
    }
    let mut open = VecDeque::from(across(net, [a, b]));
    let stay = open.iter().filter(|ends| net.is_kept(**ends));
    let stay: Vec<[VertexId; 2]> = stay.map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    if !stay.is_empty() {
        return Err(stay);
    }
    // Edges that cannot be turned yet can be once others were (Sloan 1993).
    for _ in 0..MOST_TURNS * (1 + open.len()) {
        let Some(ends) = open.pop_front() else { break };
        let Some(h) = net.halfedge(ends) else {
            continue;
        };
        let t = &net.triangulation;
        let turned = [t.apex(h), t.apex(t.twin(h))];
        if !net.flip(h) {
            open.push_back(ends);
        } else if net.cross(turned, [a, b]) {
            open.push_back(turned);
        }
    }
    let is_joined = net.triangulation.neighbours(a).any(|v| v == b);
    if is_joined { Ok(()) } else { Err(Vec::new()) }
}

/// The first edge on the way from a vertex to another.
fn first_across(net: &Net, [a, b]: [VertexId; 2]) -> Option<HalfedgeId> {
    let mut around = net.triangulation.outgoing(a);
    let first = around.find(|&h| {
        let ends = [net.triangulation.target(h), net.triangulation.apex(h)];
        net.looks_between(a, ends, b)
    });
    first.map(HalfedgeId::next)
}

/// All edges on the way, in order, up to a vertex that lies on it.
fn across(net: &Net, [a, b]: [VertexId; 2]) -> Vec<[VertexId; 2]> {
    let t = &net.triangulation;
    let mut found = Vec::new();
    let mut next = first_across(net, [a, b]);
    while let Some(h) = next.filter(|_| found.len() < t.n_faces()) {
        let ends = [t.origin(h), t.target(h)];
        found.push(ends);
        let twin = t.twin(h);
        let beyond = [twin.next(), twin.prev()];
        let crosses = |h: &HalfedgeId| net.cross([t.origin(*h), t.target(*h)], [a, b]);
        next = beyond.into_iter().find(|h| t.apex(twin) != b && crosses(h));
    }
    found
}
