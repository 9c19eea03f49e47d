//! The passes in order: a surface in, quads out.

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::complex::{Counted, FirmLine};
use super::cones::keep_cones;
use super::conformal::flatten;
use super::dress::{Dressed, dress};
use super::error::Error;
use super::field::OrientationField;
use super::guides::{Guides, Real};
use super::laid::{Laid, lay};
use super::mirror::Plan;
use super::search::{Quantised, Score, quantise};
use super::settings::{Creases, Settings};
use super::sizes;
use super::thin::n_irregular;
use crate::measure::Seam;
use crate::mesh::{
    FaceMap, HalfedgeId, HalfedgeMap, PolygonMesh, TriangleMesh, VertexId, VertexMap,
};
use crate::progress::Progress;
use crate::sphere_map::SphereMap;

/// Quads that flow, not yet laid on the surface.
#[derive(Clone, PartialEq, Debug)]
pub struct Flow {
    /// The quads, closed, at first positions near the surface.
    pub mesh: PolygonMesh,
    /// A proposal for the sphere point of each vertex, folds and all; zero where there is none.
    pub sphere: Vec<DVec3>,
    /// One arm of the cross of every face of the surface, which the quads' edges follow.
    pub crosses: FaceMap<DVec3>,
    /// How long edges are wanted at every face of the surface.
    pub sizes: FaceMap<f64>,
    /// Vertices that belong on the surface's sharp edges, and where.
    pub seams: Vec<Seam>,
    /// The edges of the quads along what had to be met.
    pub firm: Vec<[VertexId; 2]>,
    /// An edge of the surface on every line of these that nobody drew and no edges lie along.
    pub unmet: Vec<HalfedgeId>,
    /// The image of every vertex, where the quads are their own image in a plane.
    pub images: Option<Vec<VertexId>>,
    /// How they were found.
    pub report: Report,
}

/// How the quads were found.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Report {
    /// How many quads there are.
    pub n_quads: usize,
    /// How many vertices of the quads are irregular.
    pub n_cones: usize,
    /// How good the grid is, before strips were taken out.
    pub score: Score,
    /// How many quads were taken out in strips.
    pub n_thinned: usize,
    /// How many roundings and moves of periods were scored.
    pub n_trials: usize,
    /// How many roundings got stuck.
    pub n_stuck: usize,
    /// How many lines of sharp edges there are, and along how many of them quads lie.
    pub n_creases: [usize; 2],
}

/// The weight of the count where creases leave few to choose from: as dear as elsewhere, a cube of 6 n²
/// quads would be twisted rather than be a few quads off.
const COUNT_OF_SOLIDS: f64 = 6.0;

/// Along all creases of a solid the number of quads may be off by one in so many: a cube has 6 n².
/// With less room lines are given up, and corners are cut.
const SLACK: usize = 8;
/// Or by this many less half of those that are asked for: four stairs need 36, a bevelled letter 80.
const SLACK_OF_FEW: usize = 80;

/// How far the number of quads may be off: 2 %, or 2 quads.
pub(super) fn tolerance(n_wanted: usize) -> usize {
    (n_wanted / 50).max(2)
}

/// Makes a closed mesh of quads whose edges follow the shape of a surface of genus 0.
///
/// Edges lie along the surface's sharp edges where these are clear, and along those that are marked.
///
/// The surface's triangles should be even, and some times as many as the quads. What is returned
/// is closed, without doubled edges, and has as many quads as wanted within 2 %, or more where the
/// settings admit them; whether it can be laid on the sphere is not known yet. Costs a second or two
/// for 2,000 quads.
///
/// # Errors
/// [`Error`].
pub fn flow(
    map: &SphereMap,
    guides: Guides<'_>,
    settings: &Settings,
    progress: &Progress,
) -> Result<Flow, Error> {
    let mesh = map.mesh();
    let part = progress.part("", 0.0, 0.05);
    let mut sizes = sizes::sizes(mesh, settings.n_quads, &settings.sizes, &part)?;
    if let Some(doubled) = guides.mirror {
        for face in mesh.face_ids().take(mesh.n_faces() / 2) {
            sizes[doubled.image_of_face(face)] = sizes[face];
        }
    }
    let part = progress.part("", 0.05, 0.2);
    let dressed = dress(mesh, (guides, &sizes), settings, &part)?;
    let laid = search(map, guides, (&dressed, settings), progress)?;
    let n_lines = dressed.plans[0].lines().count();
    let report = Report {
        n_quads: laid.quads.len(),
        n_cones: n_irregular(laid.placed.positions.len(), &laid.quads),
        score: laid.report.score,
        n_thinned: 0,
        n_trials: laid.report.n_trials,
        n_stuck: laid.report.n_stuck,
        n_creases: [n_lines, laid.seams.len()],
    };
    Ok(Flow {
        mesh: PolygonMesh::from_faces(laid.placed.positions, &laid.quads)?,
        sphere: laid.placed.sphere,
        crosses: dressed.field.directions,
        sizes,
        images: laid.images,
        seams: laid.seams,
        firm: laid.firm,
        unmet: borders(&laid.unmet, guides).collect(),
        report,
    })
}

/// The quads with all lines, or without those of sharp edges, or without any, where that gives none
/// or where too few sharp ones are met.
fn search(
    map: &SphereMap,
    guides: Guides<'_>,
    (dressed, settings): (&Dressed, &Settings),
    progress: &Progress,
) -> Result<Laid, Error> {
    let mesh = map.mesh();
    let worn = (&dressed.field, &dressed.wish);
    let (last, lined) = dressed.plans.split_last().expect("there is a plan");
    let lay_plan = |plan: &Plan, progress: &Progress| {
        let [part, ends] = [(0.0, 0.9), (0.9, 1.0)].map(|(from, to)| progress.part("", from, to));
        let whole = whole(mesh, worn, (plan, guides), settings, &part)?;
        lay(map, guides, (whole, plan), &ends)
    };
    let mut from = 0.2;
    for plan in lined {
        let to = f64::midpoint(from, 1.0);
        match lay_plan(plan, &progress.part("", from, to)) {
            Ok(laid) if dressed.are_met(mesh, plan, &laid.is_met) && laid.unmet.is_empty() => {
                return Ok(laid);
            }
            // Fewer fixed points leave more ways out.
            Ok(_)
            | Err(
                Error::Quantise(_) | Error::Doubled { .. } | Error::Count { .. } | Error::Uneven,
            ) => {}
            Err(error) => return Err(error),
        }
        from = to;
    }
    let laid = lay_plan(last, &progress.part("", from, 1.0))?;
    // Of what was drawn as much is met as can be.
    match borders(&laid.unmet, guides).count() {
        n_unmet if n_unmet > 0 && settings.creases == Creases::All => Err(Error::Creases {
            n_met: laid.is_met.len() - n_unmet,
            n_lines: laid.is_met.len(),
        }),
        _ => Ok(laid),
    }
}

/// Those of some lines, by an edge of each, that nobody drew.
fn borders<'a>(
    lines: &'a [HalfedgeId],
    guides: Guides<'a>,
) -> impl Iterator<Item = HalfedgeId> + use<'a> {
    let is_drawn = move |h: HalfedgeId| guides.drawn.is_some_and(|drawn| drawn[h]);
    lines.iter().copied().filter(move |&h| !is_drawn(h))
}

/// The grid of whole periods, with the ends of lines among its vertices.
fn whole(
    mesh: &TriangleMesh,
    (field, wish): (&OrientationField, &HalfedgeMap<DVec2>),
    (plan, guides): (&Plan, Guides<'_>),
    settings: &Settings,
    progress: &Progress,
) -> Result<Quantised, Error> {
    let part = progress.part("", 0.0, 0.2);
    let mut complex = flatten(mesh, field, wish.clone(), &plan.paths(), &part)?;
    complex.chains.ties = plan.ties();
    complex.chains.twins = twins(mesh, plan, guides);
    let mut is_wanted = VertexMap::filled(mesh.n_vertices(), false);
    for &end in plan.lines().flat_map(|line| &line.ends) {
        is_wanted[end] = true;
    }
    let mut complex = keep_cones(complex, &is_wanted, &progress.part("", 0.2, 0.25))?;
    let part = progress.part("", 0.25, 1.0);
    let mut search = settings.search;
    if plan.is_firm() {
        if settings.creases == Creases::All {
            search.weights.count = COUNT_OF_SOLIDS;
        }
        let real = guides.firm.and_then(|firm| firm.real.as_ref());
        let firm = plan.lines().enumerate().filter(|(_, line)| line.is_firm);
        let firm = firm.map(|(i, line)| FirmLine {
            line: i,
            ends: line.kept_ends(&complex),
            is_border: is_border(mesh, real, line.halfedges[0]),
        });
        complex.chains.firm = firm.collect();
        let counted = real.map(|real| counted(mesh, real, &complex.original));
        complex.chains.counted = counted.unwrap_or_default();
    }
    let whole = quantise(complex, settings.n_quads, &search, &part)?;
    check(&whole, (settings, plan.is_firm()))?;
    Ok(whole)
}

/// Whether an edge parts what counts from what does not.
fn is_border(mesh: &TriangleMesh, real: Option<&Real>, h: HalfedgeId) -> bool {
    let is_real = |h: HalfedgeId| real.is_some_and(|real| real.is_real[h.face()]);
    mesh.twin(h).is_some_and(|twin| is_real(h) != is_real(twin))
}

/// What of a surface counts, by the vertices that were kept of it.
fn counted(mesh: &TriangleMesh, real: &Real, kept: &[VertexId]) -> Counted {
    let side = |&v: &VertexId| {
        let mut sides = mesh.outgoing(v).map(|h| real.is_real[h.face()]);
        let first = sides.next()?;
        sides.all(|side| side == first).then_some(first)
    };
    Counted {
        n_wanted: Some(real.n_quads),
        is_real: kept.iter().map(side).collect(),
    }
}

/// The lines of a plan along twin loops of edges, for each two of them.
fn twins(mesh: &TriangleMesh, plan: &Plan, guides: Guides<'_>) -> Vec<[Vec<usize>; 2]> {
    let twins = guides.firm.map_or(&[][..], |firm| &firm.twins);
    let of = |edges: &Vec<HalfedgeId>| {
        let mut edges = edges.clone();
        edges.sort_unstable();
        let lies = |h: HalfedgeId| {
            let twin = mesh.twin(h);
            [Some(h), twin]
                .into_iter()
                .flatten()
                .any(|h| edges.binary_search(&h).is_ok())
        };
        let lines = plan.lines().enumerate();
        let lines = lines.filter(|(_, line)| lies(line.halfedges[0]));
        lines.map(|(i, _)| i).collect::<Vec<_>>()
    };
    let twins = twins.iter().map(|two| two.each_ref().map(of));
    twins
        .filter(|two| two.iter().all(|lines| !lines.is_empty()))
        .collect()
}

/// Whether a grid joins no two vertices twice and has about as many quads as wanted.
fn check(whole: &Quantised, (settings, is_firm): (&Settings, bool)) -> Result<(), Error> {
    let n_doubled = whole.report.score.n_doubled;
    if n_doubled > 0 {
        return Err(Error::Doubled { n_doubled });
    }
    let [n_quads, n_wanted] = [whole.grid.quads.len(), whole.n_wanted];
    let tolerance = if is_firm {
        (n_wanted / SLACK).max(SLACK_OF_FEW.saturating_sub(n_wanted / 2))
    } else {
        tolerance(n_wanted)
    };
    let is_too_many = n_quads > n_wanted + tolerance && !settings.may_exceed;
    if is_too_many || n_quads + tolerance < n_wanted {
        return Err(Error::Count { n_quads, n_wanted });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::{CancelToken, Cancelled};
    use crate::shapes;

    /// A map by radial projection, for shapes that are star-shaped from the origin.
    fn radial_map(mesh: TriangleMesh) -> SphereMap {
        let sphere = mesh.positions().iter();
        let sphere = sphere.map(|p| p.normalize_or(DVec3::Z)).collect();
        SphereMap::prove(mesh, sphere).unwrap()
    }

    fn guides(marked: &HalfedgeMap<bool>) -> Guides<'_> {
        Guides {
            lines: marked,
            marked,
            firm: None,
            turned: None,
            drawn: None,
            mirror: None,
        }
    }

    #[test]
    fn blobs_get_closed_quads_of_the_wanted_number() {
        for seed in 0..3 {
            let map = radial_map(shapes::blob(seed, 20));
            let settings = Settings::new(300);
            let marked = HalfedgeMap::filled(3 * map.mesh().n_faces(), false);
            let found = flow(&map, guides(&marked), &settings, &Progress::none()).unwrap();
            let n = found.mesh.n_faces();
            assert_eq!((found.mesh.n_quads(), found.mesh.n_vertices()), (n, n + 2));
            assert!(n.abs_diff(300) <= 6, "{n}");
            assert_eq!(found.crosses.len(), map.mesh().n_faces());
            assert!(found.sphere.iter().all(|p| p.is_finite()));
            assert_eq!(
                flow(&map, guides(&marked), &settings, &Progress::none()),
                Ok(found)
            );
        }
    }

    #[test]
    fn strips_are_taken_out_until_the_count_is_reached() {
        let map = radial_map(shapes::blob(1, 20));
        let marked = HalfedgeMap::filled(3 * map.mesh().n_faces(), false);
        let settings = Settings::new(400);
        let found = flow(&map, guides(&marked), &settings, &Progress::none()).unwrap();
        let n_before = found.mesh.n_faces();
        let thinned = found.clone().thinned(200).unwrap();
        let n = thinned.mesh.n_faces();
        assert!(n.abs_diff(200) <= 4, "{n}");
        assert_eq!(
            (thinned.mesh.n_quads(), thinned.mesh.n_vertices()),
            (n, n + 2)
        );
        assert_eq!(thinned.report.n_thinned, n_before - n);
        assert_eq!(thinned.sphere.len(), n + 2);
        let error = found.thinned(3).unwrap_err();
        assert!(matches!(error, Error::Count { n_wanted: 3, .. }), "{error}");
    }

    #[test]
    fn a_cancelled_flow_says_so() {
        let token = CancelToken::new();
        token.cancel();
        let map = radial_map(shapes::sphere(8));
        let marked = HalfedgeMap::filled(3 * map.mesh().n_faces(), false);
        let result = flow(
            &map,
            guides(&marked),
            &Settings::new(50),
            &Progress::silent(token),
        );
        assert_eq!(result, Err(Error::Cancelled(Cancelled)));
    }
}
