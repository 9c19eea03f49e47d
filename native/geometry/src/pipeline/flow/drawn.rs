//! The even surface with the artist's strokes along its edges.

use glam::DVec3;

use super::ground::{Firm, Surface};
use crate::deform::Target;
use crate::flow::{CORNER_ANGLE, FirmEdges};
use crate::guidance::{Drawn, Pen, Strength, draw};
use crate::measure::angle_between;
use crate::mesh::{FaceId, HalfedgeMap, Id, TriangleMesh, VertexId, VertexMap};
use crate::nearest::Bvh;
use crate::pipeline::flow::Asked;
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// Points of a stroke are so far apart, in edges of a quad: at 1 a ring of six quads loses a twentieth
/// of its width.
const STEP: f64 = 0.5;

impl Surface {
    /// The same with the strokes that are asked for along its edges; it as it is where they cannot be
    /// drawn.
    ///
    /// # Errors
    /// When cancelled.
    pub fn drawn(
        self,
        (asked, target, edge): (Asked<'_>, &Target, f64),
        progress: &Progress<'_>,
    ) -> Result<Self, Cancelled> {
        if asked.strokes.is_empty() {
            return Ok(self);
        }
        let mesh = self.even.mesh();
        let faces = self.real_faces();
        let triangles: Vec<[DVec3; 3]> = faces.iter().map(|&f| mesh.triangle(f)).collect();
        let tree = Bvh::build(&triangles, progress)?;
        let bare = asked.bare(target).bvh();
        let locate = |p: DVec3| {
            let closest = asked
                .strokes
                .is_here(p)
                .then(|| tree.closest(bare.closest(p).position));
            closest.map(|closest| (faces[closest.face.index()], closest.position))
        };
        let none = HalfedgeMap::filled(3 * mesh.n_faces(), false);
        let border = self.border.as_ref().map_or(&none, |border| &border.is_on);
        let drawn = draw(
            mesh,
            asked.strokes.all(),
            &Pen {
                step: STEP * edge,
                locate: &locate,
                settle: &|p| bare.closest(p).position,
                is_fixed: &self.on_lines(border),
                is_barrier: border,
            },
        );
        let map = drawn.as_ref().and_then(|drawn| self.split_map(drawn));
        let (Some(drawn), Some(map)) = (drawn, map) else {
            return Ok(self);
        };
        Ok(self.along((drawn, map), (asked, target)))
    }

    /// The faces that lie on what is real.
    fn real_faces(&self) -> Vec<FaceId> {
        let real = self.border.as_ref().and_then(|border| border.real.as_ref());
        let faces = self.even.mesh().face_ids();
        let is_real = |face: &FaceId| real.is_none_or(|real| real.is_real[*face]);
        faces.filter(is_real).collect()
    }

    /// Vertices that lines go through already.
    fn on_lines(&self, border: &HalfedgeMap<bool>) -> VertexMap<bool> {
        let mesh = self.even.mesh();
        let mut is_on = VertexMap::filled(mesh.n_vertices(), false);
        for h in mesh.halfedge_ids() {
            is_on[mesh.origin(h)] |= self.lines[h] || border[h];
        }
        is_on
    }

    /// The sphere map of the surface once it is split: new vertices between old ones.
    fn split_map(&self, drawn: &Drawn) -> Option<SphereMap> {
        let mut sphere = self.even.sphere().clone().into_vec();
        for parents in &drawn.parents {
            let sum: DVec3 = (parents.iter())
                .map(|&(v, share)| sphere[v.index()] * share)
                .sum();
            sphere.push(sum.normalize_or_zero());
        }
        SphereMap::prove(drawn.mesh.clone(), VertexMap::from_vec(sphere)).ok()
    }

    fn along(
        self,
        (drawn, even): (Drawn, SphereMap),
        (asked, target): (Asked<'_>, &Target),
    ) -> Self {
        let mesh = even.mesh();
        let exact = drawn.along(Strength::Exact);
        let with = |edges| drawn.carried(edges).or(&exact);
        let border = asked.opening.zip(self.border.as_ref());
        let border =
            border.map(|(opening, old)| opening.firm(mesh, drawn.carried(&old.is_on), target));
        Self {
            lines: with(&self.lines),
            marked: with(&self.marked),
            strokes: Firm::new(mesh, &exact, border.as_ref()),
            turned: Some(drawn.along(Strength::Follow)),
            regions: None,
            border,
            even,
            doubled: None,
        }
    }
}

impl Firm {
    /// The edges of strokes that have to be met, and those along borders; none where there are none.
    pub fn new(
        mesh: &TriangleMesh,
        exact: &HalfedgeMap<bool>,
        border: Option<&FirmEdges>,
    ) -> Option<Self> {
        exact.iter().any(|&is| is).then(|| {
            let mut edges = border.cloned().unwrap_or_else(|| FirmEdges {
                is_on: HalfedgeMap::filled(exact.len(), false),
                is_corner: VertexMap::filled(mesh.n_vertices(), false),
                twins: Vec::new(),
                real: None,
                may_end: true,
            });
            for v in mesh.vertex_ids() {
                edges.is_corner[v] |= turns(mesh, exact, v);
            }
            edges.is_on = edges.is_on.or(exact);
            edges.may_end = true;
            Self {
                edges,
                exact: exact.clone(),
            }
        })
    }
}

/// Whether a line has a corner at a vertex.
fn turns(mesh: &TriangleMesh, on: &HalfedgeMap<bool>, v: VertexId) -> bool {
    let mut leaving = mesh.outgoing(v).filter(|&h| on[h]);
    let (Some(a), Some(b)) = (leaving.next(), leaving.next()) else {
        return false;
    };
    let [a, b] = [a, b].map(|h| mesh.position(mesh.target(h)) - mesh.position(v));
    angle_between(-a, b) > CORNER_ANGLE
}
