//! Everything made one closed surface first, which is then remeshed as any; the artist's data comes
//! from what came in.

use glam::DVec3;
use serde::Serialize;

use super::carried::CarriedReport;
use super::clock::Clock;
use super::frame::{Frame, Prepared};
use super::kept::{Kept, count};
use super::origins::origins;
use super::{CarriedEdge, Error, Input, Mirror, Remeshed, Settings, shells, taken_apart};
use crate::clean::{Apart, Cleaned};
use crate::embed::OffsetPredictor;
use crate::measure::{self, cut_polygon};
use crate::mesh::{Id, PolygonMesh, TriangleMesh, VertexId, bounds};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::{solid, transfer};

/// The side of a cell, in percent of the diagonal: what most want.
pub const SOLID_DETAIL: f64 = 0.4;
/// The finest and the coarsest: below, no machine has the memory; above, nothing is left of a shape.
pub const SOLID_DETAILS: [f64; 2] = [0.02, 5.0];
/// Where no place of the frame of work is nearest.
const AWAY: DVec3 = DVec3::splat(4.0);

/// What is told of it.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Solid {
    /// The side of a cell, in percent of the diagonal.
    pub cell_pct: f64,
    /// What became of the shells.
    #[serde(flatten)]
    pub report: solid::Report,
}

impl Solid {
    /// What became of the shells, in a line.
    pub fn text(&self) -> String {
        let report = &self.report;
        let counted = [
            (report.n_walls, "with borders closed"),
            (report.n_turned, "turned inside out"),
            (report.n_sheets, "too thin to bound anything made thick"),
            (report.n_scraps, "of these too small for that left out"),
        ];
        let counted = counted.iter().filter(|(n, _)| *n > 0);
        let mut told: Vec<String> = counted.map(|(n, what)| format!("{n} {what}")).collect();
        if report.n_dropped > 0 {
            told.push(format!("{} left out", count(report.n_dropped, "speck")));
        }
        let [shells, pieces] = [
            count(report.n_shells, "shell"),
            count(report.n_pieces, "closed surface"),
        ];
        if told.is_empty() {
            return format!("{shells} made {pieces}");
        }
        format!("{shells} made {pieces} ({})", told.join(", "))
    }
}

/// The outer surface of a mesh, with what the artist wants of it.
struct Outer<'a> {
    /// What came in, with its seams closed.
    input: Input<'a>,
    /// Its surfaces; those that are hidden lie where nothing is nearest.
    old: Prepared,
    tree: Bvh,
    mesh: PolygonMesh,
    density: Option<Vec<f64>>,
    marked: Vec<[VertexId; 2]>,
    carried: Vec<[VertexId; 2]>,
    /// Which edge of the input each of these is a piece of.
    names: Vec<usize>,
    report: Solid,
}

/// Remeshes the outer surface of a mesh.
///
/// # Errors
/// As [`super::remesh`]; when nothing is enclosed or the detail is too fine.
pub fn run(
    given: Input<'_>,
    settings: &Settings,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Remeshed, Error> {
    let mut clock = Clock::default();
    let stage = progress.part("clean", 0.0, 0.02);
    let apart = || taken_apart(given.mesh, settings.weld, &stage);
    let (apart, moved) = clock.step("clean", apart)?;
    let input = Input {
        mesh: moved.as_ref().unwrap_or(given.mesh),
        ..given
    };
    let stage = progress.part("solid", 0.02, 0.1);
    let outer = || Outer::new(input, apart, settings.solid_detail, &stage);
    let outer = clock.step("solid", outer)?;
    let inner = Input {
        mesh: &outer.mesh,
        materials: None,
        reduced: None,
        marked: &outer.marked,
        density: outer.density.as_deref(),
        carried: &outer.carried,
        cuts: None,
        guides: given.guides,
        keep_faces: None,
        guidance: given.guidance,
    };
    let stage = progress.part("", 0.1, 0.97);
    let made = shells((inner, None, clock), settings, predictor, &stage);
    let mut made = made.map_err(unnamed_in)?;
    outer.dress(&mut made, &progress.part("transfer", 0.97, 1.0))?;
    made.report.input = measure::topology(given.mesh, progress)?;
    progress.at(1.0)?;
    Ok(made)
}

impl<'a> Outer<'a> {
    fn new(
        input: Input<'a>,
        apart: Apart,
        detail_pct: f64,
        progress: &Progress<'_>,
    ) -> Result<Self, Error> {
        if apart.mesh.n_faces() == 0 {
            let n_shells = apart.tangles.len();
            return Err(solid::Error::Nothing { n_shells }.into());
        }
        let frame = Frame::new(bounds(apart.mesh.positions()));
        let loose = loose(input.mesh, &apart, &frame);
        let surfaces = apart
            .mesh
            .with_positions(frame.enter(apart.mesh.positions()));
        let edges = input.marked.iter().chain(input.carried);
        let ends = edges.flat_map(|ends| ends.map(|v| input.mesh.position(v)));
        let ends = frame.enter(&ends.collect::<Vec<_>>());
        let lines: Vec<_> = ends
            .chunks_exact(2)
            .map(|ends| [ends[0], ends[1]])
            .collect();
        let shells = solid::Shells {
            surfaces: &surfaces,
            loose: &loose,
            lines: &lines,
        };
        let wanted = solid::Settings {
            cell: detail_pct / 100.0,
        };
        let made = solid::solidify(&shells, &wanted, &progress.part("", 0.0, 0.8))?;
        let cleaned = Cleaned {
            mesh: apart.mesh,
            source: apart.source,
            report: apart.report,
        };
        let (old, _) = Prepared::facing(cleaned, &input, Mirror::Off, progress)?;
        let tree = visible((&old.mesh, &made), wanted.cell, progress)?;
        let density = input
            .density
            .map(|_| density(&input, (&old, &tree), &made.mesh));
        let (marks, carried) = lines.split_at(input.marked.len());
        let marked = on_lines(marks, &made, progress)?;
        let carried = on_lines(carried, &made, progress)?;
        Ok(Self {
            input,
            mesh: polygons(&made.mesh, &frame),
            old,
            tree,
            density,
            marked: marked.iter().map(|edge| edge.ends).collect(),
            carried: carried.iter().map(|edge| edge.ends).collect(),
            names: carried.iter().map(|edge| edge.from).collect(),
            report: Solid {
                cell_pct: detail_pct,
                report: made.report,
            },
        })
    }

    /// Gives a result the data of what came in.
    fn dress(&self, made: &mut Remeshed, progress: &Progress<'_>) -> Result<(), Cancelled> {
        for carried in &mut made.carried {
            carried.from = self.names[carried.from];
        }
        // What stayed is of the outer surface, no face of what came in.
        made.kept_faces = 0;
        let report = &mut made.report;
        report.solid = Some(self.report);
        report.clean = self.old.report;
        unnamed(&mut report.kept);
        if report.carried.is_none() && !self.input.carried.is_empty() {
            report.carried = Some(CarriedReport::default());
        }
        let frame = &self.old.frame;
        let mesh = made.mesh.with_positions(frame.enter(made.mesh.positions()));
        if let Some(of_faces) = self.input.materials {
            let of_faces = self.old.materials(of_faces);
            let part = progress.part("", 0.0, 0.5);
            made.materials = Some(transfer::materials(&self.tree, &of_faces, &mesh, &part)?);
        }
        let part = progress.part("", 0.5, 1.0);
        made.origins = origins(&self.input, (&self.old, &self.tree), &mesh, &part)?;
        Ok(())
    }
}

/// Takes the numbers from reasons: they would name elements of a mesh that nobody has seen.
fn unnamed(kept: &mut [Kept]) {
    for reason in kept.iter_mut().flat_map(|kept| &mut kept.reasons) {
        reason.edges.clear();
        reason.faces.clear();
    }
}

fn unnamed_in(mut error: Error) -> Error {
    match &mut error {
        Error::Refused { kept, .. } => unnamed(kept),
        Error::Unsound { report, .. } => unnamed(&mut report.kept),
        _ => {}
    }
    error
}

/// The edges of the outer surface that lie along some lines.
fn on_lines(
    lines: &[[DVec3; 2]],
    made: &solid::Solid,
    progress: &Progress<'_>,
) -> Result<Vec<CarriedEdge>, Cancelled> {
    if lines.is_empty() {
        return Ok(Vec::new());
    }
    let mesh = &made.mesh;
    let ends = mesh
        .halfedge_ids()
        .map(|h| [mesh.origin(h), mesh.target(h)]);
    let is_on = |[a, b]: &[VertexId; 2]| a < b && made.is_on_line[*a] && made.is_on_line[*b];
    let edges: Vec<_> = ends.filter(is_on).collect();
    let faces: Vec<[u32; 3]> = mesh.faces().iter().map(|f| f.map(|v| v.0)).collect();
    let output = PolygonMesh::from_faces(mesh.positions().to_vec(), &faces);
    let output = output.expect("triangles of a mesh are polygons");
    transfer::edges(lines, &output, &edges, progress)
}

/// The triangles of what is no surface of two sides, in the frame of work.
fn loose(mesh: &PolygonMesh, apart: &Apart, frame: &Frame) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for face in apart.tangles.iter().flat_map(|tangle| &tangle.faces) {
        cut_polygon(mesh, mesh.face(*face), &mut triangles);
    }
    let corners = triangles.iter().flatten().map(|&v| mesh.position(v));
    let corners = frame.enter(&corners.collect::<Vec<_>>());
    corners
        .chunks_exact(3)
        .map(|t| [t[0], t[1], t[2]])
        .collect()
}

/// A tree over the triangles of the input that lie on the outer surface.
fn visible(
    (old, made): (&TriangleMesh, &solid::Solid),
    cell: f64,
    progress: &Progress<'_>,
) -> Result<Bvh, Cancelled> {
    let outer = Bvh::build_of_mesh(&made.mesh, progress)?;
    let is_seen = |i: usize, [a, b, c]: [DVec3; 3]| {
        let middle = (a + b + c) / 3.0;
        let near = || outer.closest_where(middle, cell * cell, |_| true).is_some();
        made.is_hit[i] || near()
    };
    let mut triangles = Vec::with_capacity(old.n_faces());
    for face in old.face_ids() {
        progress.check()?;
        let triangle = old.triangle(face);
        let is_seen = is_seen(face.index(), triangle);
        triangles.push(if is_seen { triangle } else { [AWAY; 3] });
    }
    Bvh::build(&triangles, progress)
}

/// The density of the input at the nearest place of every vertex of another mesh.
fn density(input: &Input<'_>, (old, tree): (&Prepared, &Bvh), mesh: &TriangleMesh) -> Vec<f64> {
    let values = input.density.unwrap_or_default();
    let value = |face, corner| {
        let corner = old.input_corner(input.mesh, face, corner);
        values[input.mesh.corners()[corner as usize].index()]
    };
    let of = |&p: &DVec3| {
        let place = tree.closest(p);
        let shares = place.weights.iter().enumerate();
        let mixed: f64 = shares.map(|(i, share)| share * value(place.face, i)).sum();
        mixed.clamp(0.0, 1.0)
    };
    mesh.positions().iter().map(of).collect()
}

/// A mesh as polygons in the input's coordinates.
fn polygons(mesh: &TriangleMesh, frame: &Frame) -> PolygonMesh {
    let faces: Vec<[u32; 3]> = mesh.faces().iter().map(|f| f.map(|v| v.0)).collect();
    let places = frame.leave(mesh.positions());
    PolygonMesh::from_faces(places, &faces).expect("triangles of a mesh are polygons")
}

impl Settings {
    /// Whether the detail is in its range.
    pub(super) fn check_solid(&self) -> Result<(), Error> {
        let [least, most] = SOLID_DETAILS;
        let pct = self.solid_detail;
        if (least..=most).contains(&pct) {
            return Ok(());
        }
        Err(Error::DetailOutOfRange { pct })
    }
}

#[cfg(test)]
mod tests;
