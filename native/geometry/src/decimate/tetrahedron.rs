//! Collapses a closed mesh of genus 0 down to a tetrahedron and records how.

use thiserror::Error;

use super::fan::Level;
use super::frame::Frame;
use super::quadric::vertex_quadrics;
use super::rings::Rings;
use super::rounds::{BATCH, Choice, Rounds};
use crate::hierarchy::{CollapseHierarchy, HierarchyBuilder, HierarchyError};
use crate::mesh::{TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// The share of the vertices that a round looks at, cheapest first. More makes fewer, larger
/// rounds; less comes closer to taking the single cheapest collapse each time.
const ROUND_SHARE: f64 = 0.2;
/// The largest valence that a collapse may make while there are others: what has many neighbours
/// is slow to place and makes slivers.
const MAX_VALENCE: usize = 10;
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
    progress.check()?;
    let mut collapsing = Collapsing::new(&mesh, progress)?;
    while collapsing.n_left > 4 {
        progress.at(1.0 - (collapsing.n_left - 4) as f64 / mesh.n_vertices() as f64)?;
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
    rounds: Rounds,
    n_left: usize,
    record: HierarchyBuilder,
}

impl Collapsing {
    fn new(mesh: &TriangleMesh, progress: &Progress) -> Result<Self, Cancelled> {
        let n_left = mesh.n_vertices();
        let points = Frame::of_mesh(mesh).points(mesh);
        progress.check()?;
        let level = Level {
            rings: Rings::of_mesh(mesh, progress)?,
            quadrics: vertex_quadrics(mesh, &points, progress)?,
            points,
            max_valence: MAX_VALENCE,
        };
        Ok(Self {
            level,
            rounds: Rounds::new(n_left, ROUND_SHARE),
            n_left,
            record: HierarchyBuilder::new(),
        })
    }

    /// Takes the cheapest collapses that do not touch each other.
    fn round(&mut self, progress: &Progress) -> Result<(), Cancelled> {
        let Some(choices) = self.rounds.next(&self.level, progress)? else {
            // A vertex of valence 5 or less can always be collapsed when the valences that this
            // makes are not bounded, and there always is one.
            self.level.max_valence *= 2;
            self.rounds.mark_all();
            return Ok(());
        };
        for batch in choices.chunks(BATCH) {
            progress.check()?;
            for &choice in batch {
                if self.n_left > 4 {
                    self.commit(choice);
                }
            }
        }
        self.record.end_round();
        Ok(())
    }

    /// Makes a collapse unless it shares a vertex of its ring with an earlier one of the round.
    fn commit(&mut self, Choice { vertex, into, .. }: Choice) {
        let Self { level, rounds, .. } = self;
        let ring = level.rings.of(vertex);
        if rounds.is_changed(vertex) || ring.iter().any(|&w| rounds.is_changed(w)) {
            return;
        }
        let at = ring
            .iter()
            .position(|&w| w == into)
            .expect("the goal is a neighbour");
        let ring = level.rings.collapse(vertex, at);
        for &w in ring {
            rounds.mark(w);
        }
        self.record.push(vertex, ring);
        let quadric = level.quadrics[vertex];
        level.quadrics[into] += quadric;
        self.n_left -= 1;
    }

    /// The faces of the tetrahedron that is left.
    fn base(&self) -> [[VertexId; 3]; 4] {
        let rings = &self.level.rings;
        let left = |v: &VertexId| !rings.of(*v).is_empty();
        let v = self
            .rounds
            .alive
            .iter()
            .copied()
            .find(left)
            .expect("four vertices are left");
        let [a, b, c] = *rings.of(v) else {
            unreachable!("a closed mesh of four vertices is a tetrahedron");
        };
        [[v, a, b], [v, b, c], [v, c, a], [a, c, b]]
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

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
