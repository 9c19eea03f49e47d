//! Closes a part that has borders or handles: all of it, and a coarser version for the map.

use std::f64::consts::TAU;

use glam::DVec3;

use super::loops::Loops;
use super::puncture::{self, Puncture};
use super::sheet::folds;
use super::whole::{Whole, marks_of_pieces};
use super::{Corner, Opening, SAME, polyline};
use crate::close::{self, Closed, handles};
use crate::decimate;
use crate::deform::Target;
use crate::measure::{Polyline, Topology, total_area};
use crate::mesh::{HalfedgeMap, Id, TriangleMesh, VertexId, VertexMap};
use crate::pipeline::Error;
use crate::pipeline::even::Marked;
use crate::pipeline::marks::Marks;
use crate::progress::{Cancelled, Progress};

/// How long the tubes between borders and their caps are, in edges of quads: so there is room for the
/// four singularities of a cap, and its corners are none of quads.
const TUBE: f64 = 1.5;

/// A part that was closed.
pub struct Closing {
    /// The part, open and without handles.
    pub(super) open: TriangleMesh,
    pub(super) closed: Closed,
    /// Where handles were cut.
    cuts: Vec<Polyline>,
    /// Where the seam to its image ends at other borders: these are corners, whatever the turn.
    seam_ends: Vec<DVec3>,
    /// The borders that are made once there are quads, for they are shorter than a few of them.
    punctures: Vec<Puncture>,
    /// The shape that is to come out.
    wanted: Topology,
    /// Its marked edges that cuts have split, piece by piece.
    pub pieces: Marks,
    /// What lies between borders and their caps.
    tubes: close::Tubes,
}

/// A part reduced to the size of the map and closed.
pub struct Small {
    pub mesh: TriangleMesh,
    /// Its edges between real and virtual faces, on both sides of each.
    pub border: HalfedgeMap<bool>,
    /// The same as loops.
    loops: Loops,
    /// Which of its vertices are inside caps.
    is_in_cap: VertexMap<bool>,
    pub report: Option<decimate::Report>,
}

/// Up to which length borders are closed before quads are made.
struct Limits {
    /// Up to this one they are punctures, opened again once there are quads.
    puncture: f64,
    /// No border as long as this is closed: those of cuts are needed, and the shortest of them is
    /// hardly longer.
    below: f64,
}

impl Closing {
    /// Cuts the handles of a part that is to get so many faces, and closes its borders, all with tubes
    /// or those from which the surface goes on smoothly.
    ///
    /// # Errors
    /// A part that cannot be closed; when cancelled.
    pub fn new(
        Whole {
            mesh, shape, seam, ..
        }: &Whole,
        (marks, n_faces, has_tubes): (&Marks, usize, bool),
        progress: &Progress<'_>,
    ) -> Result<Self, Error> {
        let (part, shape) = (mesh, *shape);
        let cut = handles::cut(part, progress)?;
        let area = total_area(part);
        let edge = (area / n_faces.max(1) as f64).sqrt();
        let mut limits = Limits::new(&cut, (area, edge));
        if let Some(seam) = seam {
            limits.keep(seam.shortest_loop(&cut.mesh));
        }
        let borders: Vec<Polyline> = Loops::all(&cut.mesh).closed_lines(&cut.mesh).collect();
        let punctures = borders
            .into_iter()
            .filter(|border| border.length() <= limits.closed())
            .map(|border| Puncture::new(border, edge))
            .collect();
        let cuts = cut.twins.iter().map(|[one, _]| polyline(&cut.mesh, one));
        let cuts: Vec<Polyline> = cuts.collect();
        let settings = close::Settings {
            fill: close::Fill::UpTo(limits.closed()),
            way: close::Way::Measured,
            tubes: close::Tubes {
                length: TUBE * edge,
                everywhere: has_tubes,
                flush: cuts.clone(),
            },
        };
        let closed = close::close(&cut.mesh, &settings, progress)?;
        Ok(Self {
            cuts,
            seam_ends: seam.as_ref().map_or(Vec::new(), |seam| seam.ends.clone()),
            punctures,
            wanted: shape,
            pieces: marks_of_pieces((part, marks), (&cut.mesh, &cut.sides)),
            tubes: settings.tubes,
            closed,
            open: cut.mesh,
        })
    }

    /// Whether it was doubled across its longest border.
    pub fn is_doubled(&self) -> bool {
        self.closed.n_doubled > 0
    }

    /// The part, closed.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.closed.mesh
    }

    /// The edges of the closed part between real and virtual faces, on both sides of each.
    pub fn border(&self) -> HalfedgeMap<bool> {
        self.closed.border()
    }

    /// The part reduced to a number of faces, if it has more, and closed.
    ///
    /// # Errors
    /// A part that cannot be reduced or closed; when cancelled.
    pub fn reduced(&self, n_faces: usize, progress: &Progress<'_>) -> Result<Small, Error> {
        let share = self.closed.mesh.n_faces() as f64 / self.open.n_faces() as f64;
        let n_faces = (n_faces as f64 / share) as usize;
        if self.open.n_faces() <= n_faces {
            return Ok(Small::new(&self.open, self.closed.clone(), None));
        }
        let settings = decimate::Settings { n_faces };
        let coarse = decimate::simplify(&self.open, &settings, progress)?;
        let closed = close::close(&coarse.mesh, &self.alike(&coarse.mesh), progress)?;
        Ok(Small::new(&coarse.mesh, closed, Some(coarse.report)))
    }

    /// How a coarser version is closed the same way: the shortest loops are filled, as many.
    fn alike(&self, coarse: &TriangleMesh) -> close::Settings {
        let mut lengths = Loops::all(coarse).lengths(coarse);
        lengths.sort_by(f64::total_cmp);
        let fill = match self.closed.n_filled {
            0 => close::Fill::None,
            n if n >= lengths.len() => close::Fill::All,
            n => close::Fill::UpTo(f64::midpoint(lengths[n - 1], lengths[n])),
        };
        let way = match self.closed.n_doubled {
            0 => close::Way::Cap,
            _ => close::Way::Double,
        };
        close::Settings {
            fill,
            way,
            tubes: self.tubes.clone(),
        }
    }

    /// What the quads have to keep to, and what of them is kept; so many are wanted on all of it, and
    /// on what is real.
    ///
    /// # Errors
    /// When cancelled.
    pub fn opening(
        self,
        small: &Small,
        [n_faces, n_asked]: [usize; 2],
        progress: &Progress<'_>,
    ) -> Result<Opening, Cancelled> {
        let mesh = &self.closed.mesh;
        let on_border = self.closed.border();
        let edge = (total_area(mesh) / n_faces.max(1) as f64).sqrt();
        // Where a handle was cut the surface goes on.
        let is_cut = |p: DVec3| self.cuts.iter().any(|cut| cut.distance(p) < SAME);
        let loops = Loops::new(&self.open, &on_border);
        let mut corners = if self.tubes.everywhere {
            loops.calm_corners(mesh, (edge, &self.seam_ends))
        } else {
            loops.corners(mesh, (edge, &self.seam_ends))
        };
        corners.retain(|&corner| !is_cut(corner));
        let has_tubes = self.tubes.everywhere;
        let borders = loops.closed_lines(mesh);
        let borders = borders.filter(|line| !is_cut(line.point(0.0))).collect();
        let between = small.loops.lines(&small.mesh, (&corners, edge));
        let corners = between.iter().filter_map(|line| {
            let along = &line.line.vertices;
            let [first, last] = line.ends?;
            Some([(along[0], first), (along[along.len() - 1], last)])
        });
        let corners = corners.flatten().map(|(v, goal)| Corner {
            on_map: small.mesh.position(v),
            goal,
        });
        Ok(Opening {
            corners: corners.collect(),
            lines: between.into_iter().map(|line| line.line).collect(),
            small: small.border.clone(),
            is_in_cap: small.is_in_cap.clone(),
            edges: Marked::new(mesh, &on_border),
            folds: Marked::new(mesh, &folds(&self.closed)),
            bare: Target::new(self.real(), progress)?,
            cuts: self.cuts,
            borders,
            has_tubes,
            punctures: self.punctures,
            wanted: self.wanted,
            n_asked,
            is_real: self.closed.is_real,
        })
    }
}

impl Small {
    /// An open mesh that was closed.
    fn new(open: &TriangleMesh, closed: Closed, report: Option<decimate::Report>) -> Self {
        let border = closed.border();
        Self {
            loops: Loops::new(open, &border),
            is_in_cap: in_caps(open, &closed),
            border,
            mesh: closed.mesh,
            report,
        }
    }
}

impl Limits {
    /// Those of a part of some area that is to get quads of some edge length.
    fn new(cut: &handles::Cut, (area, edge): (f64, f64)) -> Self {
        let of_cuts = cut.twins.iter().map(|[one, _]| polyline(&cut.mesh, one));
        let shortest = of_cuts.fold(f64::INFINITY, |least, cut| least.min(cut.length()));
        // A circle of length l has the area l²/4π.
        let round = (puncture::LARGEST * area * TAU * 2.0).sqrt();
        Self {
            puncture: (puncture::LONGEST * edge).min(round),
            below: shortest * (1.0 - SAME),
        }
    }

    /// Keeps borders of some length open too.
    fn keep(&mut self, length: f64) {
        self.below = self.below.min(length * (1.0 - SAME));
    }

    /// Up to which length they are closed before quads are made.
    fn closed(&self) -> f64 {
        self.puncture.min(self.below)
    }
}

/// Which vertices of a closed mesh came with caps; none where a side lies on another.
fn in_caps(open: &TriangleMesh, closed: &Closed) -> VertexMap<bool> {
    let is_new = |v: VertexId| closed.n_doubled == 0 && v.index() >= open.n_vertices();
    closed.mesh.vertex_ids().map(is_new).collect()
}
