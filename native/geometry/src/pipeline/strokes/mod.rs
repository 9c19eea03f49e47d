//! Strokes that the artist drew, from the input to what is told of them.
//!
//! They enter the frame of work, are made each other's images where the mesh has a plane of symmetry
//! ([`sides`]), and are drawn on the even surface of every part that quads flow on
//! (`pipeline/flow/drawn.rs`). In the end the result is held against them ([`told`]).

mod chain;
mod finer;
mod sides;
mod told;

use glam::DVec3;

use super::frame::Prepared;
use super::mirror::Plane;
use super::proposed::Proposals;
use super::settings::Primitive;
use super::{Error, Input, Settings};
use crate::guidance::{Strength, Stroke};
use crate::measure::total_area;
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

pub use finer::Finer;
pub use told::{GuideOutcome, GuideReport};

/// A stroke with a point farther from the surface than this share of the diagonal is not drawn.
const FARTHEST: f64 = 0.05;
/// About so many points of a stroke say which parts it lies on.
const N_LOOKS: f64 = 500.0;

/// The strokes of a run, in the frame of work.
pub struct Strokes {
    /// As they came, those that somebody proposed last.
    given: Vec<Stroke>,
    /// How many of them the artist drew.
    n_drawn: usize,
    /// Of those that are not drawn, how far off they are.
    far: Vec<Option<f64>>,
    /// What is drawn, on both sides of a plane of symmetry.
    drawn: Vec<Stroke>,
    /// The surface, and which part each of its triangles is of; none where nothing was given.
    surface: Option<(Bvh, Vec<u32>)>,
    /// Which parts they lie on.
    touches: Vec<bool>,
}

/// The strokes on one part.
#[derive(Clone, Copy)]
pub struct OnPart<'a>(Option<(&'a Strokes, u32)>);

impl Strokes {
    /// Those of the input, and those that were proposed and are not drawn already.
    ///
    /// # Errors
    /// When cancelled.
    pub fn new(
        (input, proposals): (&Input<'_>, &Proposals),
        prepared: &Prepared,
        (plane, settings): (Option<Plane>, &Settings),
        progress: &Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let enter = |stroke: &Stroke| Stroke {
            points: prepared.frame.enter(&stroke.points),
            ..*stroke
        };
        let mut given: Vec<Stroke> = input.guides.iter().map(enter).collect();
        let n_drawn = given.len();
        given.extend(proposals.beside(&given));
        if given.is_empty() {
            return Ok(Self {
                given,
                n_drawn,
                far: Vec::new(),
                drawn: Vec::new(),
                surface: None,
                touches: Vec::new(),
            });
        }
        let tree = Bvh::build_of_mesh(&prepared.mesh, progress)?;
        let (parts, n_parts) = prepared.mesh.face_components();
        let off = |p: &DVec3| tree.closest(*p).distance_squared.sqrt();
        let farthest = |stroke: &Stroke| stroke.points.iter().map(off).fold(0.0, f64::max);
        let far = given.iter().map(|stroke| Some(farthest(stroke)));
        let far: Vec<Option<f64>> = far.map(|far| far.filter(|&far| far > FARTHEST)).collect();
        let near = given.iter().zip(&far).filter(|(_, far)| far.is_none());
        let mut drawn: Vec<Stroke> = near.map(|(stroke, _)| stroke.clone()).collect();
        if let Some(plane) = plane {
            let edge = (total_area(&prepared.mesh) / settings.faces as f64).sqrt();
            drawn = sides::both(&drawn, plane.axis, edge);
        }
        // What has to be met comes first.
        drawn.sort_by_key(|stroke| std::cmp::Reverse(stroke.strength));
        let mut touches = vec![false; n_parts];
        for stroke in &drawn {
            for p in stroke.spaced(stroke.length() / N_LOOKS) {
                touches[parts[tree.closest(p).face.0 as usize] as usize] = true;
            }
        }
        Ok(Self {
            given,
            n_drawn,
            far,
            drawn,
            surface: Some((tree, parts)),
            touches,
        })
    }

    /// Those on a part, by its number.
    pub fn on_part(&self, part: usize) -> OnPart<'_> {
        let touches = self.touches.get(part).is_some_and(|&touches| touches);
        OnPart(touches.then_some((self, part as u32)))
    }
}

impl OnPart<'_> {
    /// None.
    #[cfg(test)]
    pub fn none() -> Self {
        Self(None)
    }

    pub fn is_empty(self) -> bool {
        self.0.is_none()
    }

    /// What is to be drawn; pieces of it may lie on other parts.
    pub fn all(&self) -> &[Stroke] {
        self.0.map_or(&[], |(strokes, _)| &strokes.drawn)
    }

    /// Whether one of them has to be met.
    pub fn has_exact(&self) -> bool {
        self.all().iter().any(|s| s.strength == Strength::Exact)
    }

    /// Whether the surface nearest to a place is this part's.
    pub fn is_here(&self, place: DVec3) -> bool {
        let Some((
            Strokes {
                surface: Some((tree, parts)),
                touches,
                ..
            },
            part,
        )) = self.0
        else {
            return false;
        };
        touches.len() == 1 || parts[tree.closest(place).face.0 as usize] == part
    }
}

impl Input<'_> {
    /// Whether all strokes are lines of finite points, and there are quads to follow them.
    pub(super) fn check_guides(&self, settings: &Settings) -> Result<(), Error> {
        if self.guides.is_empty() {
            return Ok(());
        }
        let primitive = settings.primitive();
        if primitive != Primitive::Flow {
            return Err(Error::GuidesNeedFlow { primitive });
        }
        for (guide, stroke) in self.guides.iter().enumerate() {
            let n_points = stroke.points.len();
            let n_least = if stroke.is_closed { 3 } else { 2 };
            if n_points < n_least {
                return Err(Error::GuideTooShort {
                    guide,
                    n_points,
                    n_least,
                });
            }
            if let Some(point) = stroke.points.iter().position(|p| !p.is_finite()) {
                let at = stroke.points[point];
                return Err(Error::GuideNotFinite { guide, point, at });
            }
            if stroke.length() <= 0.0 {
                return Err(Error::GuideWithoutLength { guide, n_points });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
