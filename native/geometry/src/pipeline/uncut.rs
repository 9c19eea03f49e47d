//! Faces of a part with borders or handles where none can be made any other way.
//!
//! The part's own triangles, more or fewer, are paired as they are: nothing is cut, closed or opened, so
//! that the topology is the part's whatever it is.

use glam::DVec3;

use super::Error;
use super::clock::Clock;
use super::open::Whole;
use super::part::Wanted;
use super::settings::Kind;
use crate::deform::{Deformed, Target, settle};
use crate::measure::PolygonEdges;
use crate::mesh::{HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::progress::Progress;
use crate::{decimate, measure, pair};

/// How often triangles are made, so that their pairs have the count.
const N_TRIES: usize = 3;
/// The share that the count may be off before they are made again.
const NEAR_COUNT: f64 = 0.01;
/// Quality up to which quads are mended, and up to which with vertices on edges that are kept.
const ENOUGH: f64 = 0.5;
const OPEN: f64 = 0.05;
/// A handle needs so many faces round it: of fewer none is cut, which costs time and comes to nothing.
const PER_HANDLE: i64 = 24;
/// But so many are always cut.
const FEW_HANDLES: i64 = 4;
/// Each cut looks at the whole part: handles times triangles are no more than this.
const MOST_WORK: i64 = 10_000_000;

/// Faces, and those of their edges that lie on sharp or marked ones.
struct Faces {
    mesh: PolygonMesh,
    kept: Vec<[VertexId; 2]>,
}

/// Some edges of a mesh, each once, smaller end first, in order.
pub fn edges(mesh: &TriangleMesh, is_wanted: &HalfedgeMap<bool>) -> Vec<[VertexId; 2]> {
    let wanted = mesh.halfedge_ids().filter(|&h| is_wanted[h]);
    let ends = wanted.map(|h| [mesh.origin(h), mesh.target(h)]);
    let mut edges: Vec<_> = ends.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

impl Wanted<'_> {
    /// Why nothing is tried that needs handles to be cut; none where there are few.
    pub fn too_many_handles(&self, whole: &Whole) -> Option<String> {
        let n_handles = whole.shape.genus.unwrap_or(0);
        let n_faces = self.n_faces as i64;
        if n_handles > FEW_HANDLES && PER_HANDLE * n_handles > n_faces {
            return Some(format!(
                "{n_handles} handles are too many for {n_faces} faces"
            ));
        }
        let n_triangles = whole.mesh.n_faces() as i64;
        (n_handles > FEW_HANDLES && n_handles * n_triangles > MOST_WORK).then(|| {
            format!("{n_handles} handles are too many to be cut of {n_triangles} triangles")
        })
    }

    /// Faces of the part's own triangles.
    ///
    /// # Errors
    /// When cancelled.
    pub fn uncut(
        &self,
        whole: &Whole,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Deformed, Error> {
        let per_face = match self.settings.kind {
            Kind::Triangles => 1.0,
            Kind::Quads => 2.0,
        };
        let mut n_triangles = per_face * self.n_faces as f64;
        let mut faces = self.faces_of(whole, n_triangles, clock, progress)?;
        for _ in 1..N_TRIES {
            let share = self.n_faces as f64 / faces.mesh.n_faces().max(1) as f64;
            if (share - 1.0).abs() <= NEAR_COUNT {
                break;
            }
            n_triangles *= share;
            faces = self.faces_of(whole, n_triangles, clock, progress)?;
        }
        let Faces { mesh, kept } = faces;
        let target = Target::new(whole.mesh.clone(), progress)?;
        let is_border = PolygonEdges::new(&mesh, progress)?.border_vertices(mesh.n_vertices());
        let mut is_fixed = is_border.clone();
        for v in kept.iter().flatten() {
            is_fixed[v.index()] = true;
        }
        let mesh = settle(&mesh, (&is_fixed, ENOUGH), &target, progress)?;
        // What lies on edges that are kept goes off them where nothing else helps.
        let mesh = settle(&mesh, (&is_border, OPEN), &target, progress)?;
        // Nothing was embedded.
        let sphere = vec![DVec3::ZERO; mesh.n_vertices()];
        Ok(Deformed::in_space(mesh, sphere, kept, progress)?)
    }

    /// Faces of so many triangles of the part.
    fn faces_of(
        &self,
        whole: &Whole,
        n_triangles: f64,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Faces, Error> {
        let n_faces = (n_triangles.round() as usize).max(4);
        let part = progress.part("decimate", 0.0, 0.5);
        let mesh = clock.step("decimate", || {
            if whole.mesh.n_faces() > n_faces {
                let settings = decimate::Settings { n_faces };
                return Ok(decimate::simplify(&whole.mesh, &settings, &part)?.mesh);
            }
            Ok::<_, Error>(pair::refine(&whole.mesh, n_faces, &part)?)
        })?;
        let kept = self.kept(whole, &mesh);
        let part = progress.part("pair", 0.5, 1.0);
        if self.settings.kind == Kind::Triangles {
            let kept = edges(&mesh, &kept);
            let mesh = PolygonMesh::from(&mesh);
            return Ok(Faces { mesh, kept });
        }
        let pairs = clock.step("pair", || pair::pair_open(&mesh, &kept, &part))?;
        Ok(Faces {
            mesh: pairs.quads,
            kept: pairs.kept,
        })
    }

    /// The sharp and marked edges of triangles of a part.
    pub(super) fn kept(&self, whole: &Whole, mesh: &TriangleMesh) -> HalfedgeMap<bool> {
        let sharp = measure::sharp_edges(mesh, self.settings.sharp_angle.to_radians());
        let marked = [self.marks.on(mesh), whole.pieces.on(mesh)];
        let halfedges = mesh.halfedge_ids();
        halfedges
            .map(|h| sharp[h] || marked.iter().any(|marked| marked[h]))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embed::Solver;
    use crate::measure::topology;
    use crate::pipeline::Settings;
    use crate::pipeline::density::Density;
    use crate::pipeline::marks::Marks;
    use crate::pipeline::mirror::Role;
    use crate::shapes;

    #[test]
    fn a_torus_and_one_with_a_window_stay_what_they_are_at_any_count() {
        let torus = shapes::torus(24, 12);
        let some = torus.faces().iter().skip(4).copied();
        let (open, _) = TriangleMesh::of_faces(torus.positions(), some).unwrap();
        let (marks, density, quiet) = (Marks::default(), Density::default(), Progress::none());
        for (mesh, n_borders) in [(&torus, 0), (&open, 1)] {
            for n_faces in [40, 300, 900] {
                for kind in [Kind::Quads, Kind::Triangles] {
                    let settings = Settings {
                        kind,
                        ..Settings::default()
                    };
                    let wanted = Wanted {
                        n_faces,
                        settings: &settings,
                        predictor: &Solver::default(),
                        mirror: (&Role::Alone(None), None),
                        reduced: None,
                        marks: &marks,
                        sides: &marks,
                        line: &marks,
                        density: &density,
                        strokes: crate::pipeline::strokes::OnPart::none(),
                        has_tubes: false,
                        is_one_of_many: false,
                    };
                    let whole =
                        Whole::new(mesh.clone(), (&settings, n_faces), (&marks, &marks), &quiet)
                            .unwrap();
                    let made = wanted.uncut(&whole, &mut Clock::default(), &quiet).unwrap();
                    let made = &made.mesh;
                    let found = topology(made, &quiet).unwrap();
                    assert_eq!((found.genus, found.n_borders), (Some(1), n_borders));
                    assert!(10 * made.n_faces().abs_diff(n_faces) <= n_faces);
                    let n_quads = if kind == Kind::Quads {
                        made.n_faces()
                    } else {
                        0
                    };
                    assert_eq!(made.n_quads(), n_quads);
                }
            }
        }
    }
}
