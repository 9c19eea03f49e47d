//! Collapses a closed mesh of genus 0 down to a tetrahedron and records how.

use glam::DVec3;
use rayon::prelude::*;
use thiserror::Error;

use super::fan::{Candidate, Level};
use super::quadric::Quadric;
use super::rings::Rings;
use crate::hierarchy::{CollapseHierarchy, HierarchyBuilder, HierarchyError};
use crate::mesh::{TriangleMesh, VertexId, VertexMap, bounds};
use crate::progress::{Cancelled, Progress};

/// The share of the vertices that a round looks at, cheapest first. More makes fewer, larger
/// rounds; less comes closer to taking the single cheapest collapse each time.
const ROUND_SHARE: f64 = 0.2;
/// The largest valence that a collapse may make while there are others: what has many neighbours
/// is slow to place and makes slivers.
const MAX_VALENCE: usize = 10;
/// Vertices per parallel task, and per look at the cancellation flag (some 10 ms of work).
const TASK: usize = 256;
const BATCH: usize = 8192;

/// Why a mesh cannot be collapsed to a tetrahedron.
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum CollapseError {
    /// The mesh has a border.
    #[error("{n_loops} border loops, {n_edges} border edges: only closed meshes can be collapsed")]
    Open {
        /// How many border loops there are.
        n_loops: usize,
        /// How many border edges there are.
        n_edges: usize,
    },
    /// The mesh has several components, or none.
    #[error("{n_components} components; exactly 1 can be collapsed")]
    Components {
        /// How many there are.
        n_components: usize,
    },
    /// The mesh has handles.
    #[error("genus {genus}: only genus 0 can be collapsed to a tetrahedron")]
    Genus {
        /// How many handles there are.
        genus: i64,
    },
    /// Two triangles back to back.
    #[error("{n_vertices} vertices; at least 4 are needed")]
    TooFewVertices {
        /// How many there are.
        n_vertices: usize,
    },
    /// The record contradicts the mesh, which would be an error of this module.
    #[error(transparent)]
    Hierarchy(#[from] HierarchyError),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Collapses a closed mesh of genus 0 to a tetrahedron and records every step.
///
/// Half-edge collapses v → u, cheapest first, in rounds of collapses whose rings share no vertex.
/// The cost is the quadric error at u (Garland & Heckbert 1997), plus length, times penalties for
/// slivers, turned normals and valences above 6. Shape steers the order only: topology always
/// admits another collapse, so flat parts, slivers and coinciding points all get down. The mesh
/// is kept in the result as it was. About linear in time; the same record for any number of
/// threads.
///
/// # Errors
/// When the mesh is not one closed component of genus 0, or on cancellation.
pub fn collapse_to_tetrahedron(
    mesh: TriangleMesh,
    progress: &Progress,
) -> Result<CollapseHierarchy, CollapseError> {
    check_topology(&mesh)?;
    let mut collapsing = Collapsing::new(&mesh);
    while collapsing.alive.len() > 4 {
        let n_left = (collapsing.alive.len() - 4) as f64;
        progress.at(1.0 - n_left / mesh.n_vertices() as f64)?;
        collapsing.round(progress)?;
    }
    let base = collapsing.base();
    Ok(collapsing.record.build(mesh, base)?)
}

fn check_topology(mesh: &TriangleMesh) -> Result<(), CollapseError> {
    if !mesh.is_closed() {
        let loops = mesh.border_loops();
        return Err(CollapseError::Open {
            n_loops: loops.len(),
            n_edges: loops.iter().map(Vec::len).sum(),
        });
    }
    let (_, n_components) = mesh.face_components();
    if n_components != 1 {
        return Err(CollapseError::Components { n_components });
    }
    let genus = (2 - mesh.euler_number()) / 2;
    if genus != 0 {
        return Err(CollapseError::Genus { genus });
    }
    let n_vertices = mesh.n_vertices();
    if n_vertices < 4 {
        return Err(CollapseError::TooFewVertices { n_vertices });
    }
    Ok(())
}

/// The mesh on its way down.
struct Collapsing {
    level: Level,
    alive: Vec<VertexId>,
    best: VertexMap<Option<Candidate>>,
    /// The round in which `best` was computed, and that in which the ring or quadric changed last.
    evaluated: VertexMap<u32>,
    changed: VertexMap<u32>,
    /// Whose ring has changed since `best` was computed.
    dirty: Vec<VertexId>,
    round: u32,
    max_valence: usize,
    record: HierarchyBuilder,
}

impl Collapsing {
    fn new(mesh: &TriangleMesh) -> Self {
        let n = mesh.n_vertices();
        let points = unit_points(mesh);
        let mut quadrics: VertexMap<Quadric> = VertexMap::filled(n, Quadric::default());
        for face in mesh.faces() {
            let quadric = Quadric::of_triangle(face.map(|v| points[v]));
            for &v in face {
                quadrics[v] += quadric;
            }
        }
        let level = Level {
            rings: Rings::of_mesh(mesh),
            points,
            quadrics,
        };
        Self {
            level,
            alive: mesh.vertex_ids().collect(),
            best: VertexMap::filled(n, None),
            evaluated: VertexMap::filled(n, 0),
            changed: VertexMap::filled(n, 0),
            dirty: mesh.vertex_ids().collect(),
            round: 0,
            max_valence: MAX_VALENCE,
            record: HierarchyBuilder::new(),
        }
    }

    /// One round: refresh costs, take the cheapest collapses that do not touch each other.
    fn round(&mut self, progress: &Progress) -> Result<(), Cancelled> {
        self.round += 1;
        let dirty = std::mem::take(&mut self.dirty);
        self.evaluate(&dirty, progress)?;
        let Some(limit) = self.cost_limit() else {
            self.relax();
            return Ok(());
        };
        let cheap = |v: &VertexId| self.best[*v].is_some_and(|best| best.cost <= limit);
        let cheapest: Vec<VertexId> = self.alive.iter().copied().filter(cheap).collect();
        let stale: Vec<VertexId> = cheapest
            .iter()
            .copied()
            .filter(|&v| self.is_stale(v))
            .collect();
        self.evaluate(&stale, progress)?;
        let mut order: Vec<(f64, VertexId)> = cheapest
            .into_iter()
            .filter_map(|v| Some((self.best[v]?.cost, v)))
            .filter(|&(cost, _)| cost <= limit)
            .collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        self.commit(&order);
        Ok(())
    }

    /// Computes the best collapse of some vertices.
    fn evaluate(&mut self, vertices: &[VertexId], progress: &Progress) -> Result<(), Cancelled> {
        let mut found = Vec::new();
        for batch in vertices.chunks(BATCH) {
            progress.check()?;
            let (level, max_valence) = (&self.level, self.max_valence);
            batch
                .par_iter()
                .with_min_len(TASK)
                .map(|&v| level.best_collapse(v, max_valence))
                .collect_into_vec(&mut found);
            for (&v, &candidate) in batch.iter().zip(&found) {
                self.best[v] = candidate;
                self.evaluated[v] = self.round;
            }
        }
        Ok(())
    }

    /// The cost up to which this round takes collapses; none when nothing can be collapsed.
    fn cost_limit(&self) -> Option<f64> {
        let best = |v: &VertexId| self.best[*v].map(|best| best.cost);
        let mut costs: Vec<f64> = self.alive.iter().filter_map(best).collect();
        let last = costs.len().checked_sub(1)?;
        let at = (ROUND_SHARE * self.alive.len() as f64) as usize;
        let (_, limit, _) = costs.select_nth_unstable_by(at.min(last), f64::total_cmp);
        Some(*limit)
    }

    /// Whether a neighbour has changed since the best collapse of a vertex was computed.
    fn is_stale(&self, vertex: VertexId) -> bool {
        let ring = self.level.rings.of(vertex).iter();
        ring.into_iter()
            .any(|&w| self.changed[w] >= self.evaluated[vertex])
    }

    /// Allows larger valences. A vertex of valence 5 or less can always be collapsed when they are
    /// not bounded, and there is always one.
    fn relax(&mut self) {
        self.max_valence *= 2;
        self.dirty.clone_from(&self.alive);
    }

    /// Makes the collapses in order, but none that shares a vertex of its ring with an earlier one.
    fn commit(&mut self, order: &[(f64, VertexId)]) {
        let mut n_left = self.alive.len();
        for &(_, v) in order {
            let Some(Candidate { into, .. }) = self.best[v] else {
                continue;
            };
            let ring = self.level.rings.of(v);
            let is_taken = |w: &VertexId| self.changed[*w] == self.round;
            if n_left == 4 || is_taken(&v) || ring.iter().any(is_taken) {
                continue;
            }
            let at = ring
                .iter()
                .position(|&w| w == into)
                .expect("the goal is a neighbour");
            let ring = self.level.rings.collapse(v, at);
            self.record.push(v, ring);
            self.dirty.extend_from_slice(ring);
            for &w in ring {
                self.changed[w] = self.round;
            }
            self.changed[v] = self.round;
            let quadric = self.level.quadrics[v];
            self.level.quadrics[into] += quadric;
            n_left -= 1;
        }
        self.record.end_round();
        let Self { alive, level, .. } = self;
        alive.retain(|&v| !level.rings.of(v).is_empty());
    }

    /// The faces of the tetrahedron that is left.
    fn base(&self) -> [[VertexId; 3]; 4] {
        let v = self.alive[0];
        let [a, b, c] = *self.level.rings.of(v) else {
            unreachable!("a closed mesh of four vertices is a tetrahedron");
        };
        [[v, a, b], [v, b, c], [v, c, a], [a, c, b]]
    }
}

/// The positions around the origin, scaled so that the area is 4π, or the size 1 when there is none.
fn unit_points(mesh: &TriangleMesh) -> VertexMap<DVec3> {
    // In two steps, so that neither huge nor tiny coordinates leave the range of numbers.
    let largest = |m: f64, p: &DVec3| m.max(p.abs().max_element());
    let size = mesh
        .positions()
        .iter()
        .fold(0.0, largest)
        .max(f64::MIN_POSITIVE);
    let scaled: Vec<DVec3> = mesh.positions().iter().map(|&p| p / size).collect();
    let [low, high] = bounds(&scaled);
    let middle = low.midpoint(high);
    let extent = (high - low).max_element();
    let scale = |by: f64| scaled.iter().map(|&p| (p - middle) * by).collect();
    if extent == 0.0 {
        return scale(1.0);
    }
    let unit: VertexMap<DVec3> = scale(1.0 / extent);
    let doubled = |face: &[VertexId; 3]| {
        let [a, b, c] = face.map(|v| unit[v]);
        (b - a).cross(c - a).length()
    };
    let area: f64 = 0.5 * mesh.faces().iter().map(doubled).sum::<f64>();
    // What is nearly a line would be blown up without end.
    let by = (4.0 * std::f64::consts::PI / area.max(1e-12)).sqrt();
    unit.iter().map(|&p| p * by).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    fn collapsed(mesh: &TriangleMesh) -> CollapseHierarchy {
        let hierarchy = collapse_to_tetrahedron(mesh.clone(), &Progress::none()).unwrap();
        assert_eq!(hierarchy.check(), Ok(()));
        assert_eq!(hierarchy.n_collapses(), mesh.n_vertices() - 4);
        hierarchy
    }

    #[test]
    fn every_closed_shape_gets_down_and_back_up() {
        for n in [1, 2, 3, 9] {
            for (name, mesh) in shapes::closed(n) {
                let hierarchy = collapsed(&mesh);
                let longest = hierarchy.undone().map(|c| c.ring.len()).max();
                assert!(
                    longest.unwrap_or(3) <= super::super::fan::MAX_RING,
                    "{name}"
                );
            }
        }
    }

    #[test]
    fn a_tetrahedron_is_left_as_it_is() {
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mesh = TriangleMesh::new(points, faces.map(|f| f.map(VertexId)).to_vec()).unwrap();
        assert_eq!(collapsed(&mesh).n_collapses(), 0);
    }

    #[test]
    fn shapes_without_area_get_down_too() {
        for (name, mesh) in shapes::closed(5) {
            let flattened = |to: fn(DVec3) -> DVec3| {
                mesh.with_positions(mesh.positions().iter().map(|&p| to(p)).collect())
            };
            for mesh in [
                flattened(|_| DVec3::ONE),
                flattened(|p| DVec3::X * p.x),
                flattened(|p| p.with_z(0.0)),
                flattened(|p| p * 1e300),
                flattened(|p| p * 1e-310),
                flattened(DVec3::signum),
                flattened(|p| DVec3::splat(1e15) + p),
            ] {
                assert_eq!(collapsed(&mesh).mesh(), &mesh, "{name}");
            }
        }
    }

    #[test]
    fn collapses_of_a_round_share_no_vertex_of_their_rings() {
        for (name, mesh) in shapes::closed(8) {
            let hierarchy = collapsed(&mesh);
            for round in 0..hierarchy.n_rounds() {
                let mut seen = std::collections::HashSet::new();
                for collapse in hierarchy.round(round).map(|i| hierarchy.collapse(i)) {
                    let mut all = collapse.ring.iter().chain([&collapse.vertex]);
                    assert!(all.all(|v| seen.insert(*v)), "{name}, round {round}");
                }
            }
        }
    }
}
