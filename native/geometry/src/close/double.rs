//! Doubles a disc across its border.

use std::collections::{HashMap, HashSet};

use super::cap::Sheet;
use super::split::{key, pieces};
use crate::mesh::{HalfedgeId, Id, VertexId};
use crate::progress::{Cancelled, Progress};

impl Sheet<'_> {
    /// Adds the image of every face, turned round at the same place and glued along a loop.
    ///
    /// Inner edges between two vertices of the loop are split in the image, where they would join
    /// the same two vertices again.
    pub fn double(&mut self, border: &[HalfedgeId], progress: &Progress) -> Result<(), Cancelled> {
        let images = self.images(border);
        let sides = border.iter().map(|&h| self.ends(h));
        let sides: HashSet<[VertexId; 2]> = sides.map(|[a, b]| key(a, b)).collect();
        let mut middles = HashMap::new();
        for i in 0..self.faces.len() {
            progress.check()?;
            let [a, b, c] = self.faces[i];
            let corners = [a, c, b];
            let between = [0, 1, 2].map(|k| {
                let ends = key(corners[k], corners[(k + 1) % 3]);
                let is_glued = ends.iter().all(|&v| images[v.index()] == v);
                let is_chord = is_glued && !sides.contains(&ends);
                is_chord.then(|| self.middle(ends, &mut middles))
            });
            let corners = corners.map(|v| images[v.index()]);
            self.faces.extend(pieces(corners, between));
        }
        Ok(())
    }

    /// The image of each vertex, which is added; those of the loop are their own.
    fn images(&mut self, border: &[HalfedgeId]) -> Vec<VertexId> {
        let n = self.positions.len();
        let mut images: Vec<Option<VertexId>> = vec![None; n];
        for &h in border {
            let v = self.mesh.origin(h);
            images[v.index()] = Some(v);
        }
        let mut image = |(i, own): (usize, Option<VertexId>)| {
            own.unwrap_or_else(|| {
                self.positions.push(self.positions[i]);
                VertexId::from_index(self.positions.len() - 1)
            })
        };
        images.into_iter().enumerate().map(&mut image).collect()
    }

    fn middle(
        &mut self,
        ends: [VertexId; 2],
        middles: &mut HashMap<[VertexId; 2], VertexId>,
    ) -> VertexId {
        *middles.entry(ends).or_insert_with(|| {
            let [p, q] = ends.map(|v| self.positions[v.index()]);
            // Halves first: the sum of two finite numbers need not be finite.
            self.positions.push(p / 2.0 + q / 2.0);
            VertexId::from_index(self.positions.len() - 1)
        })
    }
}
