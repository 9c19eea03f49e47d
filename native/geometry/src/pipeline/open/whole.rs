//! A part with what closes its borders and handles for good.

use glam::DVec3;

use crate::close::{self, handles};
use crate::measure::{Topology, topology_of_triangles, total_area};
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh};
use crate::pipeline::borders::Opened;
use crate::pipeline::marks::Marks;
use crate::pipeline::mirror::Seam;
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
    /// Where it is to be joined to its image, if it is half of a part.
    pub seam: Option<Seam>,
}

impl Whole {
    /// Seals and fills what the settings say of a part that is to get so many faces; handles first, so that what is left of them is filled
    /// like any border.
    ///
    /// # Errors
    /// A part that cannot be closed; when cancelled.
    pub fn new(
        part: TriangleMesh,
        (settings, n_faces): (&Settings, usize),
        (marks, line): (&Marks, &Marks),
        progress: &Progress<'_>,
    ) -> Result<Self, Error> {
        let shape = topology_of_triangles(&part);
        let mut whole = Self {
            mesh: part,
            shape,
            filling: Vec::new(),
            told: None,
            pieces: Marks::default(),
            seam: None,
        };
        if !whole.is_open() {
            return Ok(whole);
        }
        let n_part = whole.mesh.n_faces();
        let mut n_first = n_part;
        let mut n_sealed = 0;
        let edge = (total_area(&whole.mesh) / n_faces.max(1) as f64).sqrt();
        if let (Some(limits), true) = (settings.sealed_up_to(edge), whole.has_handles()) {
            let sealed = handles::seal(&whole.mesh, limits, progress)?;
            n_sealed = sealed.n_sealed;
            n_first = sealed.sides.len() / 3;
            let marked = (&whole.mesh, marks);
            whole.pieces = marks_of_pieces(marked, (&sealed.mesh, &sealed.sides));
            whole.mesh = sealed.mesh;
        }
        let fill = settings.close().fill;
        let is_line = line.on(&whole.mesh);
        let is_free = |border: &[HalfedgeId]| !border.iter().any(|&h| is_line[h]);
        let is_filled = |border: &[HalfedgeId]| fill.takes(&whole.mesh, border) && is_free(border);
        let filled = close::fill(&whole.mesh, is_filled, progress)?;
        whole.mesh = filled.mesh;
        whole.shape = topology_of_triangles(&whole.mesh);
        let more = whole.mesh.face_ids().skip(n_first);
        whole.filling = more.map(|face| whole.mesh.triangle(face)).collect();
        whole.told = Opened::new([shape.n_borders, filled.n_filled], n_sealed);
        Ok(whole)
    }

    /// Half of it, with its marked edges and the seam.
    pub fn halved(&self, half: TriangleMesh, (pieces, seam): (Marks, Seam)) -> Self {
        Self {
            shape: topology_of_triangles(&half),
            mesh: half,
            filling: Vec::new(),
            told: self.told,
            pieces,
            seam: Some(seam),
        }
    }

    /// Whether it has borders or handles.
    pub fn is_open(&self) -> bool {
        !self.shape.closed || self.has_handles()
    }

    /// Whether it has handles.
    pub fn has_handles(&self) -> bool {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::sin_cos;
    use crate::mesh::VertexId;
    use crate::pipeline::Borders;
    use crate::pipeline::Handles;
    use crate::shapes;

    fn whole(mesh: &TriangleMesh, settings: &Settings) -> Whole {
        let nothing = Marks::default();
        let asked = (settings, 100);
        let on_it = (&nothing, &nothing);
        Whole::new(mesh.clone(), asked, on_it, &Progress::none()).unwrap()
    }

    /// A torus of wavy rings, so that no edges go straight round its tube.
    fn wavy() -> TriangleMesh {
        let torus = shapes::torus(60, 20);
        let bent = torus.positions().iter().enumerate().map(|(i, p)| {
            let (wave, _) = sin_cos(0.3 * (i % 20) as f64 * std::f64::consts::TAU / 2.0);
            let (s, c) = sin_cos(0.1 * wave);
            DVec3::new(c * p.x - s * p.y, s * p.x + c * p.y, p.z)
        });
        torus.with_positions(bent.collect())
    }

    #[test]
    fn a_border_longer_than_a_handle_is_filled_before_the_handle_is_cut() {
        let torus = shapes::torus(48, 12);
        // A window nearly half round the ring.
        let is_left = |face: &[VertexId; 3]| {
            face.iter().any(|&v| {
                let p = torus.position(v);
                p.y < 0.2 || p.z < 0.1
            })
        };
        let faces = torus.faces().iter().copied().filter(is_left);
        let (open, _) = TriangleMesh::of_faces(torus.positions(), faces).unwrap();
        let settings = Settings {
            borders: Borders::Fill,
            ..Settings::default()
        };
        let whole = whole(&open, &settings);
        assert_eq!((whole.shape.closed, whole.shape.genus), (true, Some(1)));
        assert_eq!(whole.told.unwrap().n_filled, 1);
        assert!(!whole.filling.is_empty());
    }

    #[test]
    fn sealed_handles_are_told_of_and_their_lids_fill() {
        let torus = shapes::torus(48, 24);
        let settings = |size_pct| Settings {
            handles: Handles::SealUpTo(size_pct),
            ..Settings::default()
        };
        let tube = 40.0 * std::f64::consts::TAU;
        let sealed = whole(&torus, &settings(1.1 * tube));
        assert_eq!(
            (sealed.shape.genus, sealed.told.unwrap().n_sealed),
            (Some(0), 1)
        );
        assert!(sealed.shape.closed);
        assert!(!sealed.is_open() && !sealed.filling.is_empty());
        let kept = whole(&torus, &settings(0.9 * tube));
        assert!(kept.is_open() && kept.told.is_none());
    }

    #[test]
    fn marks_on_edges_that_a_cut_splits_go_on_in_the_pieces() {
        let mesh = wavy();
        let ends = mesh
            .halfedge_ids()
            .map(|h| [mesh.origin(h), mesh.target(h)]);
        let all = Marks::at(ends.map(|ends| ends.map(|v| mesh.position(v))));
        let cut = handles::cut(&mesh, &Progress::none()).unwrap();
        let pieces = marks_of_pieces((&mesh, &all), (&cut.mesh, &cut.sides));
        let (before, after) = (all.on(&cut.mesh), pieces.on(&cut.mesh));
        let halves = cut.mesh.halfedge_ids().zip(&cut.sides);
        let own: Vec<_> = halves.filter(|(_, side)| side.is_some()).collect();
        assert!(own.iter().any(|&(h, _)| !before[h]));
        assert!(own.iter().all(|&(h, _)| after[h]));
    }
}
