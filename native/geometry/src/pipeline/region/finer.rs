//! Smaller quads towards faces that are kept, where these are smaller: so that fewer edges have to be
//! cut at the line.

use glam::DVec3;

use super::Region;
use crate::measure::{area_vector, cut_polygon};
use crate::mesh::{Id, VertexId};
use crate::nearest::Bvh;
use crate::pipeline::{Input, Kind, Settings};
use crate::progress::{Cancelled, Progress};

/// Up to how many edges of the new mesh from the line quads are smaller.
const REACH: f64 = 4.0;
/// Where edges of the line want no more in the mean, nothing is asked for.
const LEAST: f64 = 0.5;

impl Region {
    /// The density of the input with more of it beside what is kept, where its edges are shorter than
    /// those that so many faces would have: half as long want 1.
    ///
    /// # Errors
    /// When cancelled.
    pub(super) fn finer(
        &self,
        input: &Input<'_>,
        settings: &Settings,
        progress: &Progress<'_>,
    ) -> Result<Option<Vec<f64>>, Cancelled> {
        if self.line.is_empty() || settings.kind != Kind::Quads {
            return Ok(None);
        }
        let mesh = input.mesh;
        let edge = (self.area_left(input) / settings.faces as f64).sqrt();
        let ends = |ends: &[VertexId; 2]| ends.map(|v| mesh.position(v));
        let line: Vec<[DVec3; 2]> = self.line.iter().map(ends).collect();
        let wish = |[a, b]: [DVec3; 2]| {
            let ratio = edge / a.distance(b).max(f64::MIN_POSITIVE);
            (ratio - 1.0).clamp(0.0, 1.0)
        };
        let mean = line.iter().map(|&piece| wish(piece)).sum::<f64>() / line.len() as f64;
        if !(LEAST..=1.0).contains(&mean) {
            return Ok(None);
        }
        let pieces: Vec<_> = line.iter().map(|&[a, b]| [a, b, b]).collect();
        let tree = Bvh::build(&pieces, progress)?;
        let reach = REACH * edge;
        let mut values = match input.density {
            Some(given) => given.to_vec(),
            None => vec![0.0; mesh.n_vertices()],
        };
        for (value, &place) in values.iter_mut().zip(mesh.positions()) {
            let near = tree.closest_where(place, reach * reach, |_| true);
            if let Some(near) = near {
                let share = 1.0 - near.distance_squared.sqrt() / reach;
                *value = f64::max(*value, share.max(0.0) * wish(line[near.face.index()]));
            }
        }
        Ok(Some(values))
    }

    /// The area of the faces that are not kept.
    fn area_left(&self, input: &Input<'_>) -> f64 {
        let mut triangles = Vec::new();
        for face in self.hollow.face_ids().filter(|&face| !self.is_kept[face]) {
            cut_polygon(input.mesh, input.mesh.face(face), &mut triangles);
        }
        let area = |t: &[VertexId; 3]| area_vector(t.map(|v| input.mesh.position(v))).length();
        triangles.iter().map(area).sum()
    }
}
