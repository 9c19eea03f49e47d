//! Closed parts that lie wholly inside another.

use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::kept::{Flaw, Reason};
use super::split::Part;
use crate::mesh::{PolygonMesh, TriangleMesh, VertexId, bounds};
use crate::nearest::{Bvh, depths};
use crate::progress::{Cancelled, Progress};
use crate::solid::Winding;

/// From this winding number on a vertex is inside: on the surface it is ½, and rounding is far less
/// than what is left to 1.
const INSIDE: f64 = 0.75;

/// What becomes of closed parts that lie wholly inside another.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Inner {
    /// They are parts like others.
    #[default]
    Keep,
    /// They go.
    Drop,
}

impl Inner {
    /// The name, as users write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Drop => "drop",
        }
    }
}

/// A closed surface.
struct Shell {
    mesh: TriangleMesh,
    bounds: [DVec3; 2],
    /// Which part it is.
    part: usize,
}

/// Gives parts that lie wholly inside another a reason more.
///
/// # Errors
/// When cancelled.
pub fn mark(
    parts: &mut [Part],
    (mesh, surfaces): (&PolygonMesh, &TriangleMesh),
    progress: &Progress<'_>,
) -> Result<(), Cancelled> {
    let mut part_of = vec![0; parts.len()];
    for (i, surface) in parts
        .iter()
        .enumerate()
        .filter_map(|(i, part)| Some((i, part.surface?)))
    {
        part_of[surface] = i;
    }
    let shells = surfaces.components(progress)?.into_iter().enumerate();
    let shells = shells
        .filter(|(_, mesh)| mesh.is_closed())
        .map(|(i, mesh)| Shell {
            bounds: bounds(mesh.positions()),
            part: part_of[i],
            mesh,
        });
    let shells: Vec<Shell> = shells.collect();
    let mut outer = vec![None; shells.len()];
    for (i, shell) in shells.iter().enumerate() {
        let may_be = |other: &Shell| shell.may_have_in(other) && !other.may_have_in(shell);
        let inside: Vec<usize> = (0..shells.len())
            .filter(|&j| j != i && outer[j].is_none() && may_be(&shells[j]))
            .collect();
        if inside.is_empty() {
            continue;
        }
        let around = Around::new(shell, progress)?;
        for j in inside {
            progress.check()?;
            if around.contains(&shells[j].mesh) {
                outer[j] = Some(shell.part);
            }
        }
    }
    for (shell, outer) in shells.iter().zip(outer) {
        if let Some(outer) = outer {
            let part = &mut parts[shell.part];
            let text = format!("it lies wholly inside part {}", outer + 1);
            let flaw = Flaw::Inside { of: outer };
            let reason = Reason::new(mesh, &part.faces, &[], flaw, text);
            part.reasons.push(reason);
        }
    }
    Ok(())
}

impl Shell {
    /// Whether the box of another lies in its own.
    fn may_have_in(&self, other: &Self) -> bool {
        let [low, high] = self.bounds;
        let [least, most] = other.bounds;
        low.cmple(least).all() && high.cmpge(most).all()
    }
}

/// A shell that others may lie in.
struct Around<'a> {
    mesh: &'a TriangleMesh,
    winding: Winding,
    tree: Bvh,
}

impl<'a> Around<'a> {
    fn new(shell: &'a Shell, progress: &Progress<'_>) -> Result<Self, Cancelled> {
        let mesh = &shell.mesh;
        let triangles: Vec<_> = mesh.face_ids().map(|face| mesh.triangle(face)).collect();
        Ok(Self {
            mesh,
            winding: Winding::new(&triangles),
            tree: Bvh::build_of_mesh(mesh, progress)?,
        })
    }

    /// Whether all vertices of another shell are inside, and nothing of it crosses.
    fn contains(&self, other: &TriangleMesh) -> bool {
        let is_in = |&p: &DVec3| self.winding.number(p).abs() > INSIDE;
        other.positions().par_iter().all(is_in)
            && !other
                .face_ids()
                .any(|face| self.crosses(other.triangle(face)))
    }

    fn crosses(&self, triangle: [DVec3; 3]) -> bool {
        let [a, b, c] = triangle;
        let mut crosses = false;
        self.tree
            .visit_overlaps(a.min(b).min(c), a.max(b).max(c), |face| {
                let corners = self.mesh.triangle(face);
                let at = |v: VertexId| match v.0 {
                    i @ 0..3 => triangle[i as usize],
                    i => corners[i as usize - 3],
                };
                let names = [[0, 1, 2], [3, 4, 5]].map(|t| t.map(VertexId));
                crosses |= depths(names, at).next().is_some();
            });
        crosses
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embed::Solver;
    use crate::pipeline::{Input, Outcome, Settings, remesh};
    use crate::shapes;

    /// Balls of some sizes and places as one mesh.
    fn balls(all: &[(f64, f64)]) -> PolygonMesh {
        let ball = shapes::sphere(5);
        let (mut points, mut faces) = (Vec::new(), Vec::new());
        for &(radius, x) in all {
            let first = points.len() as u32;
            points.extend(ball.positions().iter().map(|&p| p * radius + DVec3::X * x));
            faces.extend(ball.faces().iter().map(|f| f.map(|v| v.0 + first)));
        }
        PolygonMesh::from_faces(points, &faces).unwrap()
    }

    #[test]
    fn what_lies_inside_goes_and_what_crosses_or_lies_beside_stays() {
        let mesh = balls(&[(0.5, 0.0), (1.0, 0.0), (0.3, 0.9), (0.6, 3.0), (0.2, 0.1)]);
        let run = |inner| {
            let settings = Settings {
                faces: 300,
                inner,
                strict: true,
                ..Settings::default()
            };
            remesh(
                Input::new(&mesh),
                &settings,
                &Solver::default(),
                &Progress::none(),
            )
            .unwrap()
        };
        let made = run(Inner::Drop);
        let kept: Vec<_> = made
            .report
            .kept
            .iter()
            .map(|k| (k.part, k.outcome))
            .collect();
        assert_eq!(kept, [(0, Outcome::Dropped), (4, Outcome::Dropped)]);
        let text = made.report.kept[0].text();
        assert_eq!(text, "it lies wholly inside part 2");
        assert_eq!(made.report.output.n_components, 3);
        assert!(made.report.kept.iter().all(|kept| !kept.is_bad()));
        assert_eq!(run(Inner::Keep).report.output.n_components, 5);
    }
}
