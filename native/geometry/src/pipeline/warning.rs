//! What is not as it was to be in a result, in an artist's words.

use serde::Serialize;

use super::fault::Fault;
use super::flowed::Flowed;
use super::mirror::{Mirror, Plane};
use super::region::KeptFaces;
use super::report::{Mirrored, PartReport, Rejoined};
use super::settings::Settings;
use super::small::Beside;
use crate::measure::cut_polygon;
use crate::mesh::PolygonMesh;
use crate::nearest::{Bvh, crossing_pairs};
use crate::progress::{Cancelled, Progress};
use crate::score::Glance;

/// Of a part's triangles so many per cent may cross: below, a finger touches the next one.
const MOST_CROSSING_PCT: f64 = 0.5;
/// A surface farther off than so many edges has lost a limb, or has one too many.
const MOST_EDGES_OFF: f64 = 2.0;
/// The number of faces may be off by so many per cent.
const MOST_COUNT_PCT: f64 = 5.0;
/// Of sharp and marked lines so many per cent may lack edges: short ones are lost.
const MOST_LOST_PCT: f64 = 10.0;

/// Something that is not as it was to be.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Warning {
    /// What it is, with its numbers.
    #[serde(flatten)]
    pub what: Fault,
    /// The same in a plain sentence.
    pub text: String,
    /// Whether the result is not fit for use as it is.
    pub grave: bool,
}

/// What warnings are made of.
pub(super) struct Made<'a> {
    /// The parts that were made, one after the other, and maybe faces that were not.
    pub mesh: &'a PolygonMesh,
    pub parts: &'a [PartReport],
    pub plane: Option<Plane>,
    /// The length of the input's diagonal.
    pub diagonal: f64,
    pub glance: Option<Glance>,
    /// The share of the marked edges that no edge lies along.
    pub lost_marks: f64,
    pub rejoined: Option<Rejoined>,
    pub kept_faces: Option<KeptFaces>,
    /// Small parts that stay.
    pub staying_small: Beside,
}

impl From<Fault> for Warning {
    fn from(what: Fault) -> Self {
        Self {
            text: what.text(),
            grave: what.is_grave(),
            what,
        }
    }
}

/// The sentences of what is grave, in one line.
pub(super) fn grave(warnings: &[Warning]) -> String {
    let grave = warnings.iter().filter(|warning| warning.grave);
    let texts: Vec<&str> = grave.map(|warning| warning.text.as_str()).collect();
    texts.join("; ")
}

/// All that is not as it was to be, what is grave first.
pub(super) fn warnings(
    made: &Made<'_>,
    settings: &Settings,
    progress: &Progress<'_>,
) -> Result<Vec<Warning>, Cancelled> {
    let faults = [
        made.inverted(),
        made.crossing(progress)?,
        made.far(),
        made.count(settings),
        made.flow(),
        made.replaced(),
        made.mirror(settings),
        made.lines(settings),
        made.rejoined.and_then(Rejoined::fault),
        made.kept_faces.and_then(KeptFaces::fault),
        made.kept_faces.and_then(KeptFaces::mirror_fault),
        made.network(),
    ];
    Ok(faults.into_iter().flatten().map(Warning::from).collect())
}

impl Made<'_> {
    fn inverted(&self) -> Option<Fault> {
        let n_quads = self.parts.iter().map(|p| p.deform.n_inverted).sum();
        (n_quads > 0).then_some(Fault::Inverted { n_quads })
    }

    /// Parts may pass through each other as they did before; faces of one part may not.
    fn crossing(&self, progress: &Progress<'_>) -> Result<Option<Fault>, Cancelled> {
        let mut faces = self.mesh.faces();
        let (mut n_pairs, mut n_involved, mut n_all) = (0, 0, 0);
        for part in self.parts {
            let mut triangles = Vec::new();
            for face in faces.by_ref().take(part.n_faces) {
                cut_polygon(self.mesh, face, &mut triangles);
            }
            let at = |v| self.mesh.position(v);
            let corners: Vec<_> = triangles.iter().map(|t| t.map(at)).collect();
            let tree = Bvh::build(&corners, progress)?;
            let pairs = crossing_pairs(&tree, &triangles, at, progress)?;
            let mut involved = pairs.concat();
            involved.sort_unstable();
            involved.dedup();
            n_pairs += pairs.len();
            n_involved += involved.len();
            n_all += triangles.len();
        }
        let pct = 100.0 * n_involved as f64 / n_all.max(1) as f64;
        Ok((pct > MOST_CROSSING_PCT).then_some(Fault::Crossing { n_pairs, pct }))
    }

    fn far(&self) -> Option<Fault> {
        let hausdorff_pct = self.glance?.hausdorff_pct;
        let in_edges = hausdorff_pct / 100.0 * self.diagonal / self.mean_edge();
        (in_edges > MOST_EDGES_OFF).then_some(Fault::Far {
            hausdorff_pct,
            in_edges,
        })
    }

    /// Of the faces that were made.
    fn mean_edge(&self) -> f64 {
        let (mut sum, mut n) = (0.0, 0);
        for face in self.mesh.faces().take(self.n_faces()) {
            let next = face.iter().cycle().skip(1);
            let ends = face.iter().zip(next);
            sum += ends
                .map(|(&a, &b)| self.mesh.position(a).distance(self.mesh.position(b)))
                .sum::<f64>();
            n += face.len();
        }
        sum / f64::max(n as f64, 1.0)
    }

    fn n_faces(&self) -> usize {
        self.parts.iter().map(|part| part.n_faces).sum()
    }

    fn count(&self, settings: &Settings) -> Option<Fault> {
        let small = self.staying_small;
        let n_asked = settings.faces + small.n_less;
        let n_faces = self.n_faces() + small.n_faces;
        let off_pct = 100.0 * n_faces.abs_diff(n_asked) as f64 / n_asked as f64;
        (off_pct > MOST_COUNT_PCT).then_some(Fault::Count { n_asked, n_faces })
    }

    fn flow(&self) -> Option<Fault> {
        let reason = |part: &PartReport| match &part.flow {
            Some(Flowed::Refused { reason, .. }) => Some(reason.clone()),
            _ => None,
        };
        let (n_parts, reason) = self.refused(reason)?;
        Some(Fault::Flow { n_parts, reason })
    }

    fn mirror(&self, settings: &Settings) -> Option<Fault> {
        // Nobody has asked for a plane of a part with borders that has too few quads to flow.
        let flows = |part: &PartReport| matches!(part.flow, Some(Flowed::Used { .. }));
        let is_asked = |part: &PartReport| {
            settings.mirror != Mirror::Auto || part.opened.is_none() || flows(part)
        };
        let reason = |part: &PartReport| match &part.mirrored {
            Some(Mirrored::Refused { reason }) if is_asked(part) => Some(reason.clone()),
            _ => None,
        };
        let (n_parts, reason) = self.refused(reason)?;
        Some(Fault::Mirror { n_parts, reason })
    }

    /// How many parts were refused something, and why the first.
    fn refused(&self, reason: impl Fn(&PartReport) -> Option<String>) -> Option<(usize, String)> {
        let mut reasons = self.parts.iter().filter_map(reason);
        let first = reasons.next()?;
        Some((1 + reasons.count(), first))
    }

    /// Nothing is replaced where no part is made its own image.
    fn replaced(&self) -> Option<Fault> {
        let plane = self.plane.filter(|plane| !plane.was_symmetric)?;
        let is_made = |part: &PartReport| matches!(&part.mirrored, Some(Mirrored::Used));
        self.parts
            .iter()
            .any(is_made)
            .then_some(Fault::MirrorReplaced {
                axis: ["x", "y", "z"][plane.axis],
                off_pct: plane.off_pct,
            })
    }

    /// Sharp lines are those of 40° and more: of others, wanted or not, nothing is told.
    fn lines(&self, settings: &Settings) -> Option<Fault> {
        let sharp = self.glance.and_then(|glance| glance.lost_lines_pct);
        let sharp = sharp.filter(|_| settings.sharp_angle <= Settings::default().sharp_angle);
        let lost_pct = sharp.unwrap_or(0.0).max(100.0 * self.lost_marks);
        (lost_pct > MOST_LOST_PCT).then_some(Fault::Lines { lost_pct })
    }

    fn network(&self) -> Option<Fault> {
        let parts = self.parts.iter();
        let n_parts = parts
            .filter(|p| p.embedding.repair.fell_back_to_solver)
            .count();
        (n_parts > 0).then_some(Fault::Network { n_parts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_is_one_object_with_its_kind_its_numbers_and_a_sentence() {
        let warning = Warning::from(Fault::Inverted { n_quads: 1 });
        let told = serde_json::to_value(&warning).unwrap();
        assert_eq!(
            told,
            serde_json::json!({
                "kind": "inverted", "n_quads": 1, "grave": true,
                "text": "1 quad is folded over or turned inside out",
            })
        );
        let replaced = Fault::MirrorReplaced {
            axis: "x",
            off_pct: 7.25,
        };
        let told = serde_json::to_value(Warning::from(replaced)).unwrap();
        assert_eq!(
            (&told["kind"], &told["axis"], &told["grave"]),
            (&"mirror-replaced".into(), &"x".into(), &false.into())
        );
    }
}
