//! How good a result is: the score, or the little of it that warnings are made of.

use super::clock::Clock;
use super::frame::Prepared;
use super::settings::Settings;
use crate::clean;
use crate::measure::topology_of_triangles;
use crate::mesh::PolygonMesh;
use crate::progress::{Cancelled, Progress};
use crate::score::{self, Glance, Reference, Score};

/// What is measured of a result.
pub struct Scored {
    /// None when it was not asked for or could not be measured.
    pub score: Option<Score>,
    /// Why it could not be measured.
    pub refused: Option<String>,
    /// None when it could not be measured.
    pub glance: Option<Glance>,
}

impl Scored {
    /// Measures a result against its input, whose topology is that of the prepared mesh.
    ///
    /// A result that cannot be scored is a result all the same; only a cancellation ends the run.
    pub fn new(
        (input, prepared): (&PolygonMesh, &Prepared),
        output: &PolygonMesh,
        settings: &Settings,
        (clock, progress): (&mut Clock, &Progress<'_>),
    ) -> Result<Self, Cancelled> {
        let reference = Reference {
            mesh: input,
            topology: Some(topology_of_triangles(&prepared.mesh)),
        };
        let mut scored = Self {
            score: None,
            refused: None,
            glance: None,
        };
        let Some(wanted) = settings.score() else {
            let found = clock.step("score", || score::glance(input, output, progress));
            scored.glance = told(found)?.ok();
            return Ok(scored);
        };
        let found = clock.step("score", || {
            score::score(reference, output, &wanted, progress)
        });
        match told(found)? {
            Ok(score) => {
                scored.glance = Some(score.glance);
                scored.score = Some(score);
            }
            Err(error) => scored.refused = Some(error.to_string()),
        }
        Ok(scored)
    }
}

fn told<T>(found: Result<T, score::Error>) -> Result<Result<T, score::Error>, Cancelled> {
    match found {
        Err(score::Error::Cancelled(cancelled)) => Err(cancelled),
        found => Ok(found),
    }
}

/// Says how good `output` is as a new mesh of `input`, as [`remesh`](super::remesh) does: whether the
/// topology is the same is told of the input once it is cleaned, with borders that lie on each other
/// welded and faces without area or that repeat dropped; of one that cannot be cleaned, as it comes.
///
/// # Errors
/// When one of them has no area, a setting is 0, or cancelled.
pub fn score(
    input: &PolygonMesh,
    output: &PolygonMesh,
    settings: &score::Settings,
    progress: &Progress<'_>,
) -> Result<Score, score::Error> {
    let weld = Settings::default().weld;
    let topology = match clean::take_apart(input, weld, &progress.part("", 0.0, 0.1)) {
        Err(clean::Error::Cancelled(cancelled)) => return Err(cancelled.into()),
        Ok(apart) if apart.tangles.is_empty() => Some(topology_of_triangles(&apart.mesh)),
        _ => None,
    };
    let reference = Reference {
        mesh: input,
        topology,
    };
    score::score(reference, output, settings, &progress.part("", 0.1, 1.0))
}
