//! The promises of a complex, held against its arrays.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, IVec2};
use thiserror::Error;

use super::{Complex, NO_HALFEDGE, Turn};
use crate::mesh::{FaceId, HalfedgeId, Id, VertexId};

/// The part of the longest vector by which vectors may miss each other; a turn of each flip adds
/// a rounding.
const CLOSE: f64 = 1e-8;

/// The first promise of a complex that is broken.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum BrokenComplex {
    /// An array has the wrong length.
    #[error("the arrays differ in length")]
    Length,
    /// Twins do not come in pairs that run in opposite directions.
    #[error("halfedge {0} and its twin do not match")]
    Twin(HalfedgeId),
    /// A vector and its twin's differ by more than the turn, or the two turns do not cancel.
    #[error("the vector of halfedge {0} misses its twin's by {1}")]
    Across(HalfedgeId, f64),
    /// The three vectors of a face do not add up to 0.
    #[error("face {0} stays open by {1}")]
    Open(FaceId, f64),
    /// A face is flat or turned over.
    #[error("face {0} has the double area {1}")]
    Area(FaceId, f64),
    /// The angles at a vertex do not add up to (4 − k) · 90°.
    #[error("the angle at vertex {0} is off by {1}")]
    Angle(VertexId, f64),
    /// The turns round a vertex do not add up to k.
    #[error("the turns round vertex {0} are not its index")]
    Index(VertexId),
    /// The coefficients of a face or an edge do not cancel.
    #[error("the coefficients of halfedge {0} are not consistent")]
    Coefficients(HalfedgeId),
    /// A located point does not lie in its face.
    #[error("a point is not in face {0}")]
    Located(FaceId),
}

impl Complex {
    /// Holds every promise against the arrays; for tests and debug assertions.
    ///
    /// # Errors
    /// The first promise that is broken.
    pub fn check(&self) -> Result<(), BrokenComplex> {
        let n = self.twins.len();
        let lengths = [
            self.origins.len(),
            self.turns.len(),
            self.start.len(),
            self.wish.len(),
        ];
        let n_vertices = self.n_vertices();
        if lengths != [n; 4] || [self.indices.len(), self.original.len()] != [n_vertices; 2] {
            return Err(BrokenComplex::Length);
        }
        let longest = self.start.iter().map(|w| w.length()).fold(0.0, f64::max);
        for h in self.halfedge_ids().filter(|&h| !self.is_removed(h)) {
            self.check_edge(h, CLOSE * longest)?;
        }
        let faces = self
            .face_ids()
            .filter(|&f| !self.is_removed(self.halfedge(f)));
        for f in faces {
            self.check_face(f, CLOSE * longest)?;
        }
        let n_corners = self.halfedge_ids().filter(|&h| !self.is_removed(h)).count();
        let mut n_seen = 0;
        for v in self
            .outgoing
            .ids()
            .filter(|&v| self.outgoing[v] != NO_HALFEDGE)
        {
            n_seen += self.check_vertex(v)?;
        }
        if n_seen == n_corners {
            Ok(())
        } else {
            Err(BrokenComplex::Length)
        }
    }

    fn check_edge(&self, h: HalfedgeId, close: f64) -> Result<(), BrokenComplex> {
        let t = self.twins[h];
        if self.twins[t] != h || self.origins[t] != self.target(h) {
            return Err(BrokenComplex::Twin(h));
        }
        let miss = (self.start[t] + self.start[h].turned(self.turns[h])).length();
        if !(miss <= close && (self.turns[h] + self.turns[t]).is_multiple_of(4)) {
            return Err(BrokenComplex::Across(h, miss));
        }
        let [own, across] = [h, t].map(|e| self.coefficients.row(e));
        if !own.map(|(j, c)| (j, -c.turned(self.turns[h]))).eq(across) {
            return Err(BrokenComplex::Coefficients(h));
        }
        Ok(())
    }

    fn check_face(&self, face: FaceId, close: f64) -> Result<(), BrokenComplex> {
        let h = self.halfedge(face);
        let sides = [h, h.next(), h.prev()];
        let sum: DVec2 = sides.iter().map(|&e| self.start[e]).sum();
        if sum.length() > close {
            return Err(BrokenComplex::Open(face, sum.length()));
        }
        let area = self.double_area(face);
        if area.is_nan() || area <= 0.0 {
            return Err(BrokenComplex::Area(face, area));
        }
        let mut sum = vec![IVec2::ZERO; self.coefficients.n_columns()];
        for e in sides {
            self.coefficients.add_to(&mut sum, e, 0);
        }
        if sum.iter().any(|&c| c != IVec2::ZERO) {
            return Err(BrokenComplex::Coefficients(h));
        }
        for point in self.located.in_face(face) {
            let located = self.located.points()[point];
            let sum: f64 = located.weights.iter().sum();
            let is_inside = located.weights.iter().all(|&w| w >= 0.0);
            if !(is_inside && (sum - 1.0).abs() < 1e-12 && located.face == face) {
                return Err(BrokenComplex::Located(face));
            }
        }
        Ok(())
    }

    /// How many corners meet at a vertex, once they agree with its index.
    fn check_vertex(&self, v: VertexId) -> Result<usize, BrokenComplex> {
        let [mut angle, mut turns, mut n] = [0.0, 0.0, 0.0];
        for h in self.fan(v) {
            if self.origins[h] != v || n as usize > self.twins.len() {
                return Err(BrokenComplex::Twin(h));
            }
            angle += self.angle(h);
            turns += f64::from(self.turns[h.prev()]);
            n += 1.0;
        }
        let miss = angle - f64::from(4 - self.indices[v]) * FRAC_PI_2;
        if miss.is_nan() || miss.abs() > 1e-6 {
            return Err(BrokenComplex::Angle(v, miss));
        }
        if (turns as i32 - self.indices[v]).rem_euclid(4) != 0 {
            return Err(BrokenComplex::Index(v));
        }
        debug_assert!(v.index() < self.original.len());
        Ok(n as usize)
    }
}
