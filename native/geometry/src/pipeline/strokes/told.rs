//! What became of strokes.

use glam::DVec3;
use serde::Serialize;

use super::chain::Edges;
use super::{FARTHEST, Strokes};
use crate::guidance::{Strength, Stroke};
use crate::measure::{Polyline, angle_between, cut_polygon};
use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::nearest::Bvh;
use crate::pipeline::fault::Fault;
use crate::progress::{Cancelled, Progress};

/// Edges that are nowhere farther from a stroke than this many mean edges lie on it.
const ON_IT: f64 = 0.25;
/// Edges that turn from a stroke by fewer degrees than this, in the mean, follow it.
const FOLLOWS: f64 = 10.0;
/// Points of a stroke are looked at so far apart, in mean edges.
const STEP: f64 = 0.1;

/// What became of a stroke.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum GuideOutcome {
    /// A line of edges lies on it.
    Laid,
    /// Edges run along it.
    Followed,
    /// Neither.
    Lost,
}

/// What is told of a stroke.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct GuideReport {
    /// Which one.
    pub guide: usize,
    /// What was asked for.
    pub strength: Strength,
    /// What became of it; an exact stroke is laid or lost.
    pub outcome: GuideOutcome,
    /// How far the line of edges along it is from it, in the mean, in mean edges of the result; none
    /// where there is none.
    pub distance: Option<f64>,
    /// How many degrees edges turn from it, in the mean; none where it was not drawn.
    pub angle: Option<f64>,
    /// Why it is lost.
    pub text: Option<String>,
    /// Whether it was not drawn but proposed.
    #[serde(skip_serializing_if = "is_drawn")]
    pub is_proposed: bool,
}

/// Reports of strokes that were drawn do not speak of proposals.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands it over so")]
fn is_drawn(is_proposed: &bool) -> bool {
    !is_proposed
}

impl Strokes {
    /// What became of every stroke in a mesh, in the frame of work.
    ///
    /// # Errors
    /// When cancelled.
    pub fn told(
        &self,
        mesh: &PolygonMesh,
        progress: &Progress<'_>,
    ) -> Result<Vec<GuideReport>, Cancelled> {
        let Some((surface, _)) = &self.surface else {
            return Ok(Vec::new());
        };
        let faces = Faces::new(mesh, progress)?;
        let strokes = self.given.iter().zip(&self.far).enumerate();
        let told = strokes.map(|(guide, (stroke, far))| {
            progress.check()?;
            let seen = match far {
                Some(_) => Seen::default(),
                None => faces.seen(stroke, surface),
            };
            let report = report((guide, stroke.strength), *far, &seen);
            let is_proposed = guide >= self.n_drawn;
            Ok(GuideReport {
                is_proposed,
                ..report
            })
        });
        told.collect()
    }
}

fn report((guide, strength): (usize, Strength), far: Option<f64>, seen: &Seen) -> GuideReport {
    let is_on = seen.most.is_some_and(|most| most <= ON_IT);
    let is_along = seen.angle.is_some_and(|angle| angle <= FOLLOWS);
    let outcome = match strength {
        _ if is_on => GuideOutcome::Laid,
        Strength::Follow if is_along => GuideOutcome::Followed,
        _ => GuideOutcome::Lost,
    };
    let text = (outcome == GuideOutcome::Lost).then(|| match (far, seen.most, seen.angle) {
        (Some(far), ..) => format!(
            "it is {:.1} % of the diagonal off the surface, more than {:.0} %, and was not drawn",
            100.0 * far,
            100.0 * FARTHEST
        ),
        (None, Some(most), Some(angle)) => format!(
            "the nearest edges along it are up to {most:.2} edges away and turn from it by {angle:.1} \
             degrees"
        ),
        _ => "no edges run along it".to_owned(),
    });
    GuideReport {
        guide,
        strength,
        outcome,
        distance: seen.mean,
        angle: seen.angle,
        text,
        is_proposed: false,
    }
}

impl GuideReport {
    /// What is wrong with a stroke that was to be met, or was not drawn.
    pub(in crate::pipeline) fn fault(&self) -> Option<Fault> {
        let is_wrong = self.strength == Strength::Exact || self.angle.is_none();
        let is_wrong = is_wrong && !self.is_proposed;
        let reason = self.text.clone().filter(|_| is_wrong)?;
        let guide = self.guide;
        Some(Fault::Guide { guide, reason })
    }
}

/// How edges lie to a stroke.
#[derive(Default)]
struct Seen {
    mean: Option<f64>,
    most: Option<f64>,
    angle: Option<f64>,
}

/// The faces of a result, to be asked for directions.
struct Faces<'a> {
    mesh: &'a PolygonMesh,
    tree: Option<Bvh>,
    /// The face of each triangle of the tree.
    of: Vec<u32>,
    /// The mean length of edges.
    edge: f64,
}

impl<'a> Faces<'a> {
    fn new(mesh: &'a PolygonMesh, progress: &Progress<'_>) -> Result<Self, Cancelled> {
        let mut triangles = Vec::new();
        let mut of = Vec::new();
        let (mut sum, mut n) = (0.0, 0.0);
        for (i, face) in mesh.faces().enumerate() {
            cut_polygon(mesh, face, &mut triangles);
            of.resize(triangles.len(), i as u32);
            for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
                sum += mesh.position(a).distance(mesh.position(b));
                n += 1.0;
            }
        }
        let corners: Vec<[DVec3; 3]> = triangles
            .iter()
            .map(|t: &[VertexId; 3]| t.map(|v| mesh.position(v)))
            .collect();
        let tree = (!corners.is_empty()).then(|| Bvh::build(&corners, progress));
        Ok(Self {
            mesh,
            tree: tree.transpose()?,
            of,
            edge: sum / f64::max(n, 1.0),
        })
    }

    fn seen(&self, stroke: &Stroke, surface: &Bvh) -> Seen {
        let Some(tree) = &self.tree else {
            return Seen::default();
        };
        let on = |p: DVec3| surface.closest(p).position;
        let mut points: Vec<DVec3> = (stroke.spaced(STEP * self.edge).into_iter())
            .map(on)
            .collect();
        if stroke.is_closed {
            points.push(points[0]);
        }
        let (mut sum, mut whole) = (0.0, 0.0);
        for pair in points.windows(2) {
            let way = pair[1] - pair[0];
            let face = self.of[tree.closest((pair[0] + pair[1]) / 2.0).face.index()];
            if let Some(angle) = self.turned(face, way) {
                sum += angle * way.length();
                whole += way.length();
            }
        }
        let line = Polyline::new(points.clone(), stroke.is_closed);
        let edges = Edges::near(self.mesh, &line, self.edge);
        let chain = edges.along(&points, stroke.is_closed, self.edge);
        Seen {
            mean: chain.as_ref().map(|chain| chain.mean),
            most: chain.as_ref().map(|chain| chain.most),
            angle: (whole > 0.0).then(|| (sum / whole).to_degrees()),
        }
    }

    /// By how much the edges of a face turn from a way; none where it has no four sides.
    fn turned(&self, face: u32, way: DVec3) -> Option<f64> {
        let corners = self.mesh.face(crate::mesh::FaceId(face));
        let &[a, b, c, d] = corners else { return None };
        let [a, b, c, d] = [a, b, c, d].map(|v| self.mesh.position(v));
        let arms = [(b - a) + (c - d), (d - a) + (c - b)];
        let normal = arms[0].cross(arms[1]).normalize_or_zero();
        let way = way - normal * way.dot(normal);
        let angles = arms.iter().flat_map(|&arm| [arm, -arm]);
        Some(
            angles
                .map(|arm| angle_between(way, arm))
                .fold(f64::INFINITY, f64::min),
        )
    }
}
