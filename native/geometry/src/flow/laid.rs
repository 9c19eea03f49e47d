//! A grid laid on the surface: first positions, seams along lines, images in the plane.

use std::collections::BTreeMap;

use glam::DVec3;

use super::creases::{self, Line};
use super::error::Error;
use super::guides::Guides;
use super::mirror::{Plan, images};
use super::place::{Placed, place};
use super::search::{self, Quantised};
use crate::measure::Seam;
use crate::mesh::{HalfedgeId, VertexId};
use crate::progress::Progress;
use crate::sphere_map::SphereMap;

/// Quads with first positions, and which of their vertices belong on lines.
pub(super) struct Laid {
    pub quads: Vec<[u32; 4]>,
    /// How their grid was found.
    pub report: search::Report,
    pub placed: Placed,
    pub seams: Vec<Seam>,
    /// The edges along what the guides say has to be met.
    pub firm: Vec<[VertexId; 2]>,
    /// An edge of every line that has to be met and has no seam.
    pub unmet: Vec<HalfedgeId>,
    /// Which lines of the plan have a seam.
    pub is_met: Vec<bool>,
    pub images: Option<Vec<VertexId>>,
}

/// Lays a grid on the surface along the lines of a plan.
pub(super) fn lay(
    map: &SphereMap,
    guides: Guides<'_>,
    (whole, plan): (Quantised, &Plan),
    progress: &Progress,
) -> Result<Laid, Error> {
    let grid = whole.grid;
    let quads = (grid.n_vertices, &grid.quads[..]);
    let part = progress.part("", 0.0, 0.5);
    let mut placed = place(map, quads, &grid.cells, &[], &part)?;
    let laid = (&grid.quads[..], &placed.positions[..]);
    let lines: Vec<&Line> = plan.lines().collect();
    let seams = creases::seams((map.mesh(), guides.drawn), &lines, &whole.complex, laid);
    let images = match guides.mirror {
        Some(_) => Some(images(quads, &seams[..plan.plane.len()]).ok_or(Error::Uneven)?),
        None => None,
    };
    let unmet = lines.iter().zip(&seams);
    let unmet = unmet.filter(|(line, seam)| line.is_firm && seam.is_none());
    let unmet = unmet.map(|(line, _)| line.halfedges[0]).collect();
    let is_met = seams.iter().map(Option::is_some).collect();
    let is_firm = |line: &Line| {
        guides
            .firm
            .is_some_and(|firm| firm.is_on[line.halfedges[0]])
    };
    let firm = lines.iter().zip(&seams).filter(|(line, _)| is_firm(line));
    let firm = firm.filter_map(|(_, seam)| seam.as_ref());
    let firm = firm.flat_map(|seam| seam.vertices.windows(2).map(|pair| [pair[0], pair[1]]));
    let firm = firm.collect();
    let seams: Vec<Seam> = seams.into_iter().flatten().collect();
    if !seams.is_empty() {
        let goals: BTreeMap<u32, DVec3> = seams.iter().flat_map(creases::goals).collect();
        let goals: Vec<_> = goals.into_iter().collect();
        let part = progress.part("", 0.5, 1.0);
        placed = place(map, quads, &grid.cells, &goals, &part)?;
    }
    Ok(Laid {
        quads: grid.quads,
        report: whole.report,
        placed,
        seams,
        firm,
        unmet,
        is_met,
        images,
    })
}
