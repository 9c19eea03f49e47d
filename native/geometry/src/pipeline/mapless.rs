//! Parts whose faces are made without a map to the sphere, and what is told of them.

use super::Error;
use super::clock::Clock;
use super::flowed::Flowed;
use super::laid::Instead;
use super::mirror::Role;
use super::open::Whole;
use super::part::{PartResult, Wanted};
use super::report::{Mirrored, PartReport};
use super::settings::Primitive;
use crate::deform::Deformed;
use crate::embed;
use crate::progress::Progress;

/// What is told of a part however it is made.
#[derive(Clone, Copy)]
pub struct Came {
    pub n_input_faces: usize,
    pub n_asked_faces: usize,
    pub area: f64,
}

impl Wanted<'_> {
    /// Makes the faces of a part with nothing closed or cut; why, is told.
    pub fn run_uncut(
        &self,
        (whole, came): (&Whole, Came),
        reason: String,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<PartResult, Error> {
        let made = self.uncut(whole, clock, progress)?;
        let flow = (self.settings.primitive() == Primitive::Flow).then_some(Flowed::Refused {
            reason,
            instead: Instead::PairedTriangles,
        });
        Ok(self.without_map((whole, came), made, flow))
    }

    /// Faces that were made without a map.
    pub fn without_map(
        &self,
        (whole, came): (&Whole, Came),
        made: Deformed,
        flow: Option<Flowed>,
    ) -> PartResult {
        let of_part = match self.mirror.0 {
            Role::Whole => Some("only quads that flow can be".to_owned()),
            Role::Alone(reason) => reason.clone(),
            Role::ImageOf(_) => None,
        };
        let report = PartReport {
            n_input_faces: came.n_input_faces,
            n_asked_faces: came.n_asked_faces,
            n_faces: made.mesh.n_faces(),
            reduced: None,
            decimate: None,
            opened: whole.told,
            embedding: embed::Report::none(),
            flow,
            mirrored: of_part.map(|reason| Mirrored::Refused { reason }),
            sphere: None,
            deform: made.report,
        };
        PartResult {
            mesh: made.mesh,
            sphere: made.sphere,
            features: made.features,
            crosses: Vec::new(),
            filling: Vec::new(),
            area: came.area,
            report,
        }
    }
}
