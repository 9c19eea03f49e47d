//! A part with what closes its borders and handles for good.

use glam::DVec3;

use crate::close::{self, handles};
use crate::measure::{Topology, topology_of_triangles};
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh};
use crate::pipeline::borders::Opened;
use crate::pipeline::handles::Handles;
use crate::pipeline::marks::Marks;
use crate::pipeline::{Error, Settings};
use crate::progress::Progress;

/// A part, its handles sealed and its borders filled that are to be.
#[derive(Clone)]
pub struct Whole {
    pub mesh: TriangleMesh,
    /// What its shape is.
    pub shape: Topology,
    /// What filled borders and sealed handles.
    pub filling: Vec<[DVec3; 3]>,
    /// What is told of it.
    pub told: Option<Opened>,
    /// The marked edges of the part that were split where handles were sealed, piece by piece.
    pub pieces: Marks,
}

impl Whole {
    /// Seals and fills what the settings say; handles first, so that what is left of them is filled
    /// like any border.
    ///
    /// # Errors
    /// A part that cannot be closed; when cancelled.
    pub fn new(
        part: TriangleMesh,
        (settings, marks): (&Settings, &Marks),
        progress: &Progress<'_>,
    ) -> Result<Self, Error> {
        let shape = topology_of_triangles(&part);
        let mut whole = Self {
            mesh: part,
            shape,
            filling: Vec::new(),
            told: None,
            pieces: Marks::default(),
        };
        if !whole.is_open() {
            return Ok(whole);
        }
        let n_part = whole.mesh.n_faces();
        let mut n_first = n_part;
        let mut n_sealed = 0;
        if let (Handles::SealUpTo(size_pct), true) = (settings.handles, whole.has_handles()) {
            let sealed = handles::seal(&whole.mesh, size_pct / 100.0, progress)?;
            n_sealed = sealed.n_sealed;
            n_first = sealed.sides.len() / 3;
            let marked = (&whole.mesh, marks);
            whole.pieces = marks_of_pieces(marked, (&sealed.mesh, &sealed.sides));
            whole.mesh = sealed.mesh;
        }
        let fill = settings.close().fill;
        let filled = close::fill(&whole.mesh, |b| fill.takes(&whole.mesh, b), progress)?;
        whole.mesh = filled.mesh;
        whole.shape = topology_of_triangles(&whole.mesh);
        let more = whole.mesh.face_ids().skip(n_first);
        whole.filling = more.map(|face| whole.mesh.triangle(face)).collect();
        whole.told = Opened::new([shape.n_borders, filled.n_filled], n_sealed);
        Ok(whole)
    }

    /// Whether it has borders or handles.
    pub fn is_open(&self) -> bool {
        !self.shape.closed || self.has_handles()
    }

    fn has_handles(&self) -> bool {
        self.shape.genus != Some(0)
    }
}

/// The marked edges of a mesh that are split in another, piece by piece: of each halfedge of that its
/// own, where it came from one.
pub fn marks_of_pieces(
    (mesh, marks): (&TriangleMesh, &Marks),
    (pieces, sides): (&TriangleMesh, &HalfedgeMap<Option<HalfedgeId>>),
) -> Marks {
    if marks.is_empty() {
        return Marks::default();
    }
    let marked = marks.on(mesh);
    let halfedges = pieces.halfedge_ids().zip(sides);
    let is_piece = |side: &Option<HalfedgeId>| side.is_some_and(|side| marked[side]);
    let ends = halfedges.filter(|(_, side)| is_piece(side));
    let ends = ends.map(|(h, _)| [pieces.origin(h), pieces.target(h)].map(|v| pieces.position(v)));
    Marks::at(ends)
}
