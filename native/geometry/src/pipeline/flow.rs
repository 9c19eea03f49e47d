//! Quads that flow: an even surface, its flow, a cover of the sphere, the fit.

use serde::Serialize;

use super::Settings;
use super::clock::Clock;
use crate::deform::{self, Deformed, Flowing, Target};
use crate::embed::{self, Covered};
use crate::mesh::{PolygonMesh, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere::{self, Adaptive};
use crate::sphere_map::SphereMap;
use crate::{flow, pipeline};

/// The even surface has this many triangles at least, so that the field sees the shape.
const LEAST_TRIANGLES: usize = 16_000;
/// For few quads that is more than they can show.
const MOST_TRIANGLES_PER_QUAD: usize = 40;
/// And at least this many per quad: below, quads have no vertex inside that places them.
const TRIANGLES_PER_QUAD: usize = 5;

/// Whether a part's quads flow.
#[derive(Clone, PartialEq, Debug, Serialize)]
#[serde(tag = "status", rename_all = "kebab-case")]
pub enum Flowed {
    /// They do.
    Used {
        /// How they were found.
        flow: flow::Report,
        /// What had to be repaired to lay them on the sphere.
        cover: embed::CoverReport,
    },
    /// They do not; the quad sphere was used instead.
    Refused {
        /// Why not.
        reason: String,
    },
}

/// A part whose quads flow.
pub struct FlowedPart {
    pub deformed: Deformed,
    pub sphere: sphere::Report,
    pub flowed: Flowed,
}

/// Makes flowing quads of a part; the text of an error is the reason to use something else.
pub fn flow_part(
    map: &SphereMap,
    target: &Target,
    (n_faces, settings): (usize, &Settings),
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Result<FlowedPart, String>, Cancelled> {
    let part = progress.part("sphere", 0.0, 0.2);
    let even = clock.step("sphere", || {
        told(even(map, target, (n_faces, settings.seed), &part))
    })?;
    let (even, sphere) = match even {
        Ok(even) => even,
        Err(reason) => return Ok(Err(reason)),
    };
    let part = progress.part("flow", 0.2, 0.8);
    let style = settings.style.flow(n_faces);
    let found = clock.step("flow", || told(find(&even, &style, &part)))?;
    let (found, covered) = match found {
        Ok(found) => found,
        Err(reason) => return Ok(Err(reason)),
    };
    let part = progress.part("deform", 0.8, 1.0);
    let quads = found.mesh.with_positions(covered.sphere);
    let flowing = Flowing {
        quads: &quads,
        wanted: found.mesh.positions(),
        crosses: &found.crosses,
        sizes: &found.sizes,
    };
    let settings = deform::Settings::default();
    let fit = || deform::deform_flow(&even, flowing, target, &settings, &part);
    let deformed = clock.step("deform", || told(fit().map_err(pipeline::Error::from)))?;
    Ok(deformed.map(|deformed| FlowedPart {
        deformed,
        sphere,
        flowed: Flowed::Used {
            flow: found.report,
            cover: covered.report,
        },
    }))
}

/// Splits a cancellation, which ends the run, from the reasons to use something else.
fn told<T>(result: Result<T, pipeline::Error>) -> Result<Result<T, String>, Cancelled> {
    match result {
        Ok(value) => Ok(Ok(value)),
        Err(pipeline::Error::Cancelled(cancelled)) => Err(cancelled),
        Err(error) => Ok(Err(error.to_string())),
    }
}

/// An even triangle mesh of the target with its own map to the sphere.
fn even(
    map: &SphereMap,
    target: &Target,
    (n_quads, seed): (usize, u64),
    progress: &Progress<'_>,
) -> Result<(SphereMap, sphere::Report), pipeline::Error> {
    let n_faces = LEAST_TRIANGLES
        .min(MOST_TRIANGLES_PER_QUAD * n_quads)
        .max(TRIANGLES_PER_QUAD * n_quads);
    let settings = sphere::Settings {
        n_faces,
        seed,
        ..sphere::Settings::default()
    };
    let part = progress.part("", 0.0, 0.7);
    let Adaptive { primitive, report } = sphere::adaptive(map, &settings, &part)?;
    let part = progress.part("", 0.7, 1.0);
    let settings = deform::Settings::default();
    let Deformed { mesh, sphere, .. } = deform::deform(map, &primitive, target, &settings, &part)?;
    let sphere = VertexMap::from_vec(sphere);
    let map = SphereMap::prove(triangles(&mesh), sphere).map_err(embed::Error::from)?;
    Ok((map, report))
}

fn triangles(mesh: &PolygonMesh) -> TriangleMesh {
    let corners = |face: &[VertexId]| [face[0], face[1], face[2]];
    TriangleMesh::new(
        mesh.positions().to_vec(),
        mesh.faces().map(corners).collect(),
    )
    .expect("a cover of the sphere by triangles is a closed surface")
}

/// The flow of a surface, laid on its sphere.
fn find(
    map: &SphereMap,
    settings: &flow::Settings,
    progress: &Progress<'_>,
) -> Result<(flow::Flow, Covered), pipeline::Error> {
    let found = flow::flow(map, settings, &progress.part("", 0.0, 0.95))?;
    let covered = embed::cover(&found.mesh, &found.sphere, &progress.part("", 0.95, 1.0))?;
    Ok((found, covered))
}
