//! Simplifies a mesh to a number of faces.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::frame::Frame;
use super::merge::{Guard, Merging};
use super::quadric::{Quadric, vertex_quadrics};
use super::rings::Rings;
use super::rounds::{BATCH, Choice, Rounds};
use crate::mesh::{Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// The share of the vertices that a round looks at, cheapest first.
const ROUND_SHARE: f64 = 0.2;
/// How much heavier than its faces a border weighs in the quadrics of its vertices.
const BORDER_WEIGHT: f64 = 10.0;

/// What [`simplify`] is asked for.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// How many faces the result should have; at least 4.
    pub n_faces: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { n_faces: 20_000 }
    }
}

/// What [`simplify`] did.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Report {
    /// How many faces came in.
    pub n_faces_before: usize,
    /// How many are left.
    pub n_faces: usize,
    /// How many vertices are left.
    pub n_vertices: usize,
    /// How many edges were collapsed.
    pub n_collapses: usize,
    /// Whether no more faces are left than asked for. If not, the topology admits no further
    /// collapse, or those left would turn triangles over: ask for more faces.
    pub complete: bool,
}

/// A mesh of fewer faces.
#[derive(Clone, PartialEq, Debug)]
pub struct Simplified {
    /// The mesh.
    pub mesh: TriangleMesh,
    /// How it came about.
    pub report: Report,
}

/// Why a mesh cannot be simplified.
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum Error {
    /// Not enough for a closed surface.
    #[error("{n_faces} faces were asked for; at least 4 are needed")]
    TooFewFaces {
        /// How many.
        n_faces: usize,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Simplifies a mesh to a number of faces by quadric edge collapses (Garland & Heckbert 1997).
///
/// Each edge collapses into the place of least quadric error, cheapest first, in rounds of
/// collapses that do not touch each other. Keeps: genus, components, border loops, orientation; a
/// border vertex moves only along its border. Vertices that no collapse has moved keep their exact
/// place and their order. Does not keep: sizes or angles of faces beyond a guard against slivers
/// and turned triangles. Surfaces without area are fine. About linear in time; the same result for
/// any number of threads.
///
/// # Errors
/// [`Error::TooFewFaces`], or on cancellation.
pub fn simplify(
    mesh: &TriangleMesh,
    settings: &Settings,
    progress: &Progress,
) -> Result<Simplified, Error> {
    let n_wanted = settings.n_faces;
    if n_wanted < 4 {
        return Err(Error::TooFewFaces { n_faces: n_wanted });
    }
    let n_before = mesh.n_faces();
    let mut simplifying = Simplifying::new(mesh, progress)?;
    while simplifying.n_faces > n_wanted {
        let n_gone = n_before - simplifying.n_faces;
        progress.at(n_gone as f64 / (n_before - n_wanted) as f64)?;
        if !simplifying.round(n_wanted, progress)? {
            break;
        }
    }
    let mesh = simplifying.result(mesh);
    let report = Report {
        n_faces_before: n_before,
        n_faces: mesh.n_faces(),
        n_vertices: mesh.n_vertices(),
        n_collapses: simplifying.n_collapses,
        complete: mesh.n_faces() <= n_wanted,
    };
    Ok(Simplified { mesh, report })
}

struct Simplifying {
    frame: Frame,
    merging: Merging,
    rounds: Rounds,
    /// The vertices that a collapse has moved, and the number of the round in which it did last.
    moved: VertexMap<u32>,
    round: u32,
    n_faces: usize,
    n_collapses: usize,
}

impl Simplifying {
    /// The start; a user who cancels waits for one of its passes over the mesh at most.
    fn new(mesh: &TriangleMesh, progress: &Progress) -> Result<Self, Cancelled> {
        let frame = Frame::of_mesh(mesh);
        progress.check()?;
        let points = frame.points(mesh);
        progress.check()?;
        let mut quadrics = vertex_quadrics(mesh, &points, progress)?;
        for h in mesh.halfedge_ids().filter(|&h| mesh.twin(h).is_none()) {
            let triangle = [h, h.next(), h.prev()].map(|h| points[mesh.origin(h)]);
            let quadric = border_quadric(triangle);
            quadrics[mesh.origin(h)] += quadric;
            quadrics[mesh.target(h)] += quadric;
        }
        progress.check()?;
        let merging = Merging {
            rings: Rings::of_mesh(mesh, progress)?,
            points,
            quadrics,
            guard: Guard::Shape,
        };
        progress.check()?;
        Ok(Self {
            frame,
            merging,
            rounds: Rounds::new(mesh.n_vertices(), ROUND_SHARE),
            moved: VertexMap::filled(mesh.n_vertices(), 0),
            round: 0,
            n_faces: mesh.n_faces(),
            n_collapses: 0,
        })
    }

    /// Takes the cheapest collapses that do not touch each other; whether more could follow.
    fn round(&mut self, n_wanted: usize, progress: &Progress) -> Result<bool, Cancelled> {
        self.round += 1;
        let Some(choices) = self.rounds.next(&self.merging, progress)? else {
            let may_relax = self.merging.guard == Guard::Shape;
            self.merging.guard = Guard::Topology;
            self.rounds.mark_all();
            return Ok(may_relax);
        };
        for batch in choices.chunks(BATCH) {
            progress.check()?;
            for &choice in batch {
                if self.n_faces > n_wanted {
                    self.commit(choice);
                }
            }
        }
        Ok(true)
    }

    /// Makes a collapse unless an earlier one of the round has moved a vertex next to it.
    fn commit(&mut self, Choice { vertex, into, .. }: Choice) {
        let Self { merging, moved, .. } = self;
        let rings = &merging.rings;
        let is_moved = |v: VertexId| !rings.is_virtual(v) && moved[v] == self.round;
        let near = |v: VertexId| is_moved(v) || rings.of(v).iter().any(|&w| is_moved(w));
        if near(vertex) || near(into) {
            return;
        }
        let Some(n_faces) = merging.merge(vertex, into) else {
            return;
        };
        moved[vertex] = self.round;
        moved[into] = self.round;
        self.rounds.mark(into);
        for &w in merging.rings.of(into) {
            if !merging.rings.is_virtual(w) {
                self.rounds.mark(w);
            }
        }
        self.n_faces -= n_faces;
        self.n_collapses += 1;
    }

    /// The mesh of the vertices that are left, in their old order.
    fn result(&self, mesh: &TriangleMesh) -> TriangleMesh {
        let Merging { rings, points, .. } = &self.merging;
        let mut ids = VertexMap::filled(mesh.n_vertices(), VertexId(0));
        let mut positions = Vec::new();
        let left = |v: &VertexId| !rings.of(*v).is_empty();
        for v in mesh.vertex_ids().filter(left) {
            ids[v] = VertexId::from_index(positions.len());
            positions.push(match self.moved[v] {
                0 => mesh.position(v),
                _ => self.frame.leave(points[v]),
            });
        }
        let mut faces = Vec::with_capacity(self.n_faces);
        for v in mesh.vertex_ids().filter(left) {
            let ring = rings.of(v);
            let next = ring.iter().cycle().skip(1);
            for (&a, &b) in ring.iter().zip(next) {
                if v < a && v < b && !rings.is_virtual(a) && !rings.is_virtual(b) {
                    faces.push([ids[v], ids[a], ids[b]]);
                }
            }
        }
        TriangleMesh::new(positions, faces).expect("legal collapses keep the mesh manifold")
    }
}

/// The squared distance to the plane that stands on the border edge (p, q) of a triangle, at the
/// weight of a square on the edge.
fn border_quadric([p, q, r]: [glam::DVec3; 3]) -> Quadric {
    let edge = q - p;
    let upright = edge.cross(edge.cross(r - p));
    upright.try_normalize().map_or_else(Quadric::default, |n| {
        Quadric::of_plane(n, p, BORDER_WEIGHT * edge.length_squared())
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::shapes;

    fn simplified(mesh: &TriangleMesh, n_faces: usize) -> Simplified {
        simplify(mesh, &Settings { n_faces }, &Progress::none()).unwrap()
    }

    /// The shapes with three holes cut into them; one of them touches nothing else.
    fn with_borders() -> Vec<TriangleMesh> {
        let open = |mesh: &TriangleMesh| {
            let keep = |face: &[VertexId; 3]| {
                let p = face.map(|v| mesh.position(v));
                let middle = (p[0] + p[1] + p[2]) / 3.0;
                middle.x < 0.42 && middle.y.abs() < 0.6 && middle.z < 0.28
            };
            let faces: Vec<_> = mesh.faces().iter().copied().filter(keep).collect();
            let mut ids = vec![VertexId(u32::MAX); mesh.n_vertices()];
            let mut positions = Vec::new();
            let mut renumbered = |v: VertexId| {
                if ids[v.index()].0 == u32::MAX {
                    ids[v.index()] = VertexId::from_index(positions.len());
                    positions.push(mesh.position(v));
                }
                ids[v.index()]
            };
            let faces = faces.into_iter().map(|f| f.map(&mut renumbered)).collect();
            TriangleMesh::new(positions, faces)
        };
        let shapes = shapes::closed(12);
        shapes
            .iter()
            .filter_map(|(_, mesh)| open(mesh).ok())
            .collect()
    }

    #[test]
    fn closed_shapes_meet_the_count_and_stay_closed() {
        for (name, mesh) in shapes::closed(12) {
            for n_faces in [4, 60, 600, 5000] {
                let Simplified {
                    mesh: result,
                    report,
                } = simplified(&mesh, n_faces);
                assert!(report.complete, "{name} {report:?}");
                assert!(
                    result.n_faces() + 1 >= n_faces.min(mesh.n_faces()),
                    "{name}"
                );
                assert!(result.is_closed() && result.euler_number() == 2, "{name}");
            }
        }
    }

    #[test]
    fn borders_stay() {
        let meshes = with_borders();
        assert!(meshes.len() > 2);
        for mesh in meshes {
            assert!(!mesh.is_closed());
            let result = simplified(&mesh, 4).mesh;
            assert_eq!(result.euler_number(), mesh.euler_number());
            assert_eq!(result.border_loops().len(), mesh.border_loops().len());
            assert_eq!(result.face_components().1, mesh.face_components().1);
        }
    }

    #[test]
    fn a_flat_sheet_keeps_its_outline() {
        let cube = shapes::mapped_cube(10, |p| p);
        let top = |f: &[VertexId; 3]| f.iter().all(|&v| cube.position(v).z > 0.99);
        let faces: Vec<_> = cube.faces().iter().copied().filter(top).collect();
        let mut used: Vec<VertexId> = faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        let id = |v| VertexId::from_index(used.binary_search(&v).unwrap());
        let faces = faces.into_iter().map(|f| f.map(id)).collect();
        let positions = used.iter().map(|&v| cube.position(v)).collect();
        let result = simplified(&TriangleMesh::new(positions, faces).unwrap(), 4).mesh;
        let area = |f| {
            let [a, b, c]: [DVec3; 3] = result.triangle(f);
            0.5 * (b - a).cross(c - a).z
        };
        let total: f64 = result.face_ids().map(area).sum();
        assert!((total - 4.0).abs() < 1e-3, "{total}");
        assert!(result.n_faces() <= 4);
    }

    #[test]
    fn shapes_without_area_meet_the_count_too() {
        for (name, mesh) in shapes::closed(5) {
            for to in [
                |_| DVec3::ONE,
                |p: DVec3| DVec3::X * p.x,
                |p: DVec3| p.with_z(0.0),
                |p: DVec3| p.signum() * f64::MAX,
                |p: DVec3| p * 1e-310,
            ] {
                let mesh = mesh.with_positions(mesh.positions().iter().map(|&p| to(p)).collect());
                let result = simplified(&mesh, 4).mesh;
                assert_eq!(result.n_faces(), 4, "{name}");
            }
        }
    }

    #[test]
    fn fewer_than_four_faces_are_refused() {
        let error = simplify(
            &shapes::sphere(1),
            &Settings { n_faces: 3 },
            &Progress::none(),
        );
        let message = error.unwrap_err().to_string();
        assert_eq!(message, "3 faces were asked for; at least 4 are needed");
    }
}
