//! What is left to do once all parts are made: data is carried, the result judged and told of.

use super::carried::{CarriedReport, carried};
use super::clock::{Clock, peak_memory_mb};
use super::crosses;
use super::frame::Prepared;
use super::join::Joined;
use super::mirror::Plane;
use super::origins::origins;
use super::proposed::Asked;
use super::region::Region;
use super::scored::{Judged, judge, sound};
use super::split::Parts;
use super::stay::{Elements, Staying};
use super::strokes::{GuideReport, Strokes};
use super::{Error, Input, Remeshed, Report, Settings, VERSION};
use crate::mesh::PolygonMesh;
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::{measure, transfer};

/// All parts, made and joined, and what they are of.
pub struct Made<'a> {
    /// What came in.
    pub given: Input<'a>,
    /// The same with its seams closed, and the marks on parts that were made alone.
    pub input: Input<'a>,
    pub settings: &'a Settings,
    pub parts: Parts,
    pub prepared: Prepared,
    pub plane: Option<Plane>,
    pub joined: Joined,
    pub strokes: Strokes,
    /// What somebody proposed beside them.
    pub asked: Option<Asked>,
    /// What is kept, if anything is.
    pub region: Option<&'a Region>,
}

impl Made<'_> {
    /// Carries data over, judges the result and puts the faces that stay behind it.
    ///
    /// # Errors
    /// A result that is not sound, where that is asked for; when cancelled.
    pub fn finished(
        mut self,
        mut clock: Clock,
        progress: &Progress<'_>,
    ) -> Result<Remeshed, Error> {
        let crosses = std::mem::take(&mut self.joined.crosses);
        let crosses = crosses::leave(crosses, &self.prepared.frame);
        let faces = self.parts.staying(self.input.mesh);
        let whole = self.region.map(|_| {
            // The polygons that are kept, in the place of hollow ones.
            let places = self.input.mesh.positions().to_vec();
            self.given.mesh.with_positions(places)
        });
        let stays = whole.as_ref().unwrap_or(self.input.mesh);
        let staying = Staying::new(stays, faces, &self.joined.met);
        let staying = staying.exactly(self.region.is_some());
        let stage = progress.part("transfer", 0.9, 0.92);
        let carrying = || self.elements(&staying, &stage);
        let (mut made, carried) = clock.step("transfer", carrying)?;
        let stage = progress.part("score", 0.92, 1.0);
        let guides = clock.step("score", || self.strokes.told(&self.joined.mesh, &stage))?;
        let mut judged = judge(
            (self.given.mesh, &self.parts),
            (&self.prepared, self.plane),
            (self.input.mesh, self.input.marked),
            (&made.mesh, &self.joined),
            (self.settings, &mut clock, &stage),
        )?;
        judged.heed(&guides, self.settings);
        staying.append(&self.given, &mut made);
        let settings = self.settings;
        let report = self.report(&made.mesh, (carried, judged, guides), clock, progress)?;
        progress.at(1.0)?;
        let report = sound(report, settings)?;
        Ok(made.told(crosses, staying.n_faces(), report))
    }

    fn report(
        self,
        output: &PolygonMesh,
        (carried, judged, guides): (Option<CarriedReport>, Judged, Vec<GuideReport>),
        clock: Clock,
        progress: &Progress<'_>,
    ) -> Result<Report, Cancelled> {
        Ok(Report {
            version: VERSION,
            settings: self.settings.clone(),
            input: measure::topology(self.given.mesh, progress)?,
            clean: self.prepared.report,
            solid: None,
            output: measure::topology(output, progress)?,
            plane: self.plane,
            embedding: self.joined.embedding,
            parts: self.joined.parts,
            kept: self.parts.kept,
            carried,
            rejoined: self.joined.rejoined,
            kept_faces: self.joined.kept_faces,
            guides,
            guidance: self.asked,
            score: judged.score,
            score_refused: judged.refused,
            warnings: judged.warnings,
            steps: clock.into_steps(),
            peak_memory_mb: peak_memory_mb(),
        })
    }

    /// What was made, with the artist's data on it, and what became of edges that were to be carried.
    fn elements(
        &mut self,
        staying: &Staying,
        progress: &Progress<'_>,
    ) -> Result<(Elements, Option<CarriedReport>), Cancelled> {
        let (input, prepared, frame) = (&self.input, &self.prepared, &self.prepared.frame);
        let joined = &mut self.joined;
        let which = self.parts.on_done(input.mesh, input.carried);
        let found = carried((input, &which), (frame, self.plane), joined, progress)?;
        let report = (!input.carried.is_empty()).then(|| {
            let (n, length) = staying.carried_length(input, frame);
            found.report(n, length)
        });
        let mesh = &joined.mesh;
        let mut made = Elements {
            mesh: mesh.with_positions(frame.leave(mesh.positions())),
            materials: None,
            sphere: std::mem::take(&mut joined.sphere),
            carried: found.edges,
            origins: None,
            filled: joined.on_filling(prepared, progress)?,
        };
        if input.materials.is_none() && input.cuts.is_none() {
            return Ok((made, report));
        }
        let tree = Bvh::build_of_mesh(&prepared.mesh, progress)?;
        let part = progress.part("", 0.0, 0.5);
        let materials = input
            .materials
            .map(|of_faces| transfer::materials(&tree, &prepared.materials(of_faces), mesh, &part));
        made.materials = materials.transpose()?;
        let part = progress.part("", 0.5, 1.0);
        made.origins = origins(input, (prepared, &tree), mesh, &part)?;
        Ok((made, report))
    }
}
