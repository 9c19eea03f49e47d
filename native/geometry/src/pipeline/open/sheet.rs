//! Sheets, which were closed by a second side: where the sides meet, and which is the real one.

use super::loops::chains;
use super::{Opening, SAME};
use crate::close::Closed;
use crate::deform::Target;
use crate::embed::Solver;
use crate::groups::Groups;
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId};
use crate::mirror::{Doubled, double_sheet};
use crate::pipeline::Error;
use crate::pipeline::part::embed_mesh;
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// One side of a surface alone.
struct Half {
    mesh: TriangleMesh,
    /// The name of each of its vertices in the whole.
    names: Vec<VertexId>,
}

impl Opening {
    /// An even surface made its own other side exactly, from the side that is real.
    ///
    /// # Errors
    /// When cancelled; the text of the inner error is why that cannot be.
    pub fn doubled(
        &self,
        (map, border): (&SphereMap, &HalfedgeMap<bool>),
        target: &Target,
        progress: &Progress<'_>,
    ) -> Result<Result<(SphereMap, Doubled), String>, Error> {
        let half = match self.real_half((map.mesh(), border), target, progress)? {
            Ok(half) => half,
            Err(reason) => return Ok(Err(reason)),
        };
        let doubled = match double_sheet(&half.mesh, &half.names) {
            Ok(doubled) => doubled,
            Err(error) => return Ok(Err(error.to_string())),
        };
        let embedded = embed_mesh(doubled.mesh().clone(), &Solver::default(), progress)?;
        Ok(Ok((embedded.map, doubled)))
    }

    /// The side of an even surface that lies on what is real; the text of the inner error is why
    /// there is none.
    fn real_half(
        &self,
        (mesh, border): (&TriangleMesh, &HalfedgeMap<bool>),
        target: &Target,
        progress: &Progress<'_>,
    ) -> Result<Result<Half, String>, Cancelled> {
        let folds = self.folds.tree(progress)?;
        let lies = |v| folds.closest(mesh.position(v)).distance_squared < SAME * SAME;
        let is_fold = |h| border[h] && lies(mesh.origin(h)) && lies(mesh.target(h));
        let mut groups = Groups::new(mesh.n_faces());
        for h in mesh.halfedge_ids() {
            if let Some(twin) = mesh.twin(h).filter(|_| !is_fold(h)) {
                groups.link(h.face().index(), twin.face().index());
            }
        }
        let (side, n_sides) = groups.numbered();
        if n_sides != 2 {
            let reason = format!("the even surface has {n_sides} sides, not two");
            return Ok(Err(reason));
        }
        let mut votes = [0.0; 2];
        for face in mesh.face_ids() {
            votes[side[face.index()] as usize] += self.vote(&mesh.triangle(face), target);
        }
        let real = u32::from(votes[1] > votes[0]);
        let own = mesh.face_ids().filter(|face| side[face.index()] == real);
        let own = own.map(|face| mesh.face(face));
        let half = TriangleMesh::of_faces(mesh.positions(), own);
        let half = half.map(|(mesh, names)| Half { mesh, names });
        Ok(half.map_err(|error| error.to_string()))
    }
}

/// The borders of a closed part across which it was doubled, on both sides of each edge: there most
/// faces have their own images beyond; not all, for some were split.
pub(super) fn folds(closed: &Closed) -> HalfedgeMap<bool> {
    let (mesh, border) = (&closed.mesh, closed.border());
    let apex = |h: HalfedgeId| mesh.position(mesh.origin(h.prev()));
    let is_image = |h: &HalfedgeId| mesh.twin(*h).is_some_and(|twin| apex(*h) == apex(twin));
    let mut is_fold = HalfedgeMap::filled(border.len(), false);
    for chain in chains(mesh, &border) {
        let n_images = chain.iter().filter(|h| is_image(h)).count();
        for &h in chain.iter().filter(|_| 2 * n_images > chain.len()) {
            is_fold[h] = true;
        }
    }
    is_fold
}
