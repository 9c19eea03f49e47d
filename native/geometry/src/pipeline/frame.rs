//! The frame of work: every mesh is cleaned, centred and scaled to a diagonal of 1 before a step
//! sees it.

use glam::DVec3;

use super::Input;
use super::mirror::{self, Mirror, Plane};
use crate::clean::{self, Cleaned};
use crate::mesh::{FaceId, FaceMap, Id, PolygonMesh, TriangleMesh, bounds};
use crate::progress::{Cancelled, Progress};

/// A cleaned mesh in the frame of work.
pub struct Prepared {
    pub mesh: TriangleMesh,
    pub frame: Frame,
    pub report: clean::Report,
    source: FaceMap<FaceId>,
}

impl Prepared {
    /// Cleans first: welding needs the input's own coordinates, and a vertex without a face must
    /// not stretch the frame.
    pub fn new(input: &PolygonMesh, progress: &Progress<'_>) -> Result<Self, clean::Error> {
        let cleaned = clean::clean(input, progress)?;
        let input = Input::new(input);
        Ok(Self::facing(cleaned, &input, Mirror::Off, progress)?.0)
    }

    /// The same of a clean mesh with the plane of symmetry that is asked for, which then goes through
    /// the frame's origin.
    pub fn facing(
        cleaned: Cleaned,
        input: &Input<'_>,
        wanted: Mirror,
        progress: &Progress<'_>,
    ) -> Result<(Self, Option<Plane>), Cancelled> {
        let Cleaned {
            mesh,
            source,
            report,
        } = cleaned;
        progress.check()?;
        let mut frame = Frame::new(bounds(mesh.positions()));
        let mut entered = mesh.with_positions(frame.enter(mesh.positions()));
        let plane = mirror::find(&entered, (input, &frame), wanted, progress)?;
        if let Some(plane) = plane {
            frame.centre[plane.axis] = plane.at;
            entered = mesh.with_positions(frame.enter(mesh.positions()));
        }
        let prepared = Self {
            mesh: entered,
            frame,
            report,
            source,
        };
        Ok((prepared, plane))
    }

    /// Some of its components alone, in the same frame.
    pub fn only(&self, is_wanted: &[bool]) -> Self {
        let (component, _) = self.mesh.face_components();
        let is_wanted: Vec<bool> = component.iter().map(|&c| is_wanted[c as usize]).collect();
        let all = Cleaned {
            mesh: self.mesh.clone(),
            source: self.source.clone(),
            report: self.report,
        };
        let Cleaned { mesh, source, .. } = all.only(&is_wanted);
        Self {
            mesh,
            source,
            ..*self
        }
    }

    /// The polygon of the input that a triangle is a piece of.
    pub fn input_face(&self, face: FaceId) -> FaceId {
        self.source[face]
    }

    /// The corner of that polygon, by its place among all corners of the input, where a corner of the
    /// triangle is; the nearest where the polygon was cut from its centre.
    pub fn input_corner(&self, input: &PolygonMesh, face: FaceId, corner: usize) -> u32 {
        let place = self.mesh.triangle(face)[corner];
        let polygon = self.source[face];
        let corners = input.face(polygon).iter().map(|&v| input.position(v));
        let away =
            |p: DVec3| ((p - self.frame.centre) / self.frame.diagonal - place).length_squared();
        let nearest = corners
            .enumerate()
            .min_by(|a, b| away(a.1).total_cmp(&away(b.1)));
        input.starts()[polygon.index()] + nearest.map_or(0, |(i, _)| i as u32)
    }

    /// The material of each triangle.
    pub fn materials(&self, of_faces: &[i32]) -> Vec<i32> {
        self.source
            .iter()
            .map(|&face| of_faces[face.index()])
            .collect()
    }
}

/// A place as bits, the same for both zeros: what finds a vertex again after cleaning, which welds
/// and renumbers vertices but moves none.
pub fn bits(place: DVec3) -> [u64; 3] {
    (place + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// A shift and a scale, to be undone at the end.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Frame {
    centre: DVec3,
    diagonal: f64,
}

impl Frame {
    /// The frame of a bounding box; a box without size is only shifted.
    pub fn new([low, high]: [DVec3; 2]) -> Self {
        // Halves first: the box of finite points can be larger than the largest number.
        let half = high / 2.0 - low / 2.0;
        let largest = half.max_element();
        // The length of a tiny or huge vector under- or overflows when squared.
        let diagonal = if largest > 0.0 {
            2.0 * largest * (half / largest).length()
        } else {
            1.0
        };
        Self {
            centre: low / 2.0 + high / 2.0,
            diagonal: diagonal.min(f64::MAX),
        }
    }

    /// How long the diagonal of the box is.
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// Into the frame: centre 0, diagonal 1.
    pub fn enter(&self, points: &[DVec3]) -> Vec<DVec3> {
        points
            .iter()
            .map(|&p| (p - self.centre) / self.diagonal)
            .collect()
    }

    /// A vector back from the frame.
    pub fn grow(&self, vector: DVec3) -> DVec3 {
        vector * self.diagonal
    }

    /// Back from the frame; what would lie beyond the largest numbers lies there.
    pub fn leave(&self, points: &[DVec3]) -> Vec<DVec3> {
        let back = |&p: &DVec3| (p * self.diagonal + self.centre).clamp(DVec3::MIN, DVec3::MAX);
        points.iter().map(back).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_of_any_size_enter_with_a_diagonal_of_one_and_come_back() {
        for (size, shift) in [
            (1.0, 0.0),
            (1e30, 0.0),
            (1e-30, 0.0),
            (1e300, 0.0),
            (1.0, 1e7),
        ] {
            let points = [DVec3::ZERO, DVec3::new(3.0, 4.0, 12.0) * size].map(|p| p + shift);
            let frame = Frame::new(bounds(&points));
            let inside = frame.enter(&points);
            assert!((inside[0].distance(inside[1]) - 1.0).abs() < 1e-8, "{size}");
            for (back, point) in frame.leave(&inside).iter().zip(points) {
                assert!(
                    (*back - point).abs().max_element() <= 1e-8 * size,
                    "{size}: {back} {point}"
                );
            }
        }
    }

    #[test]
    fn what_lies_outside_the_largest_box_comes_back_finite() {
        let frame = Frame::new([DVec3::MIN, DVec3::MAX]);
        let back = frame.leave(&[DVec3::new(1.1, -1.1, 0.0)]);
        assert_eq!(back, [DVec3::new(f64::MAX, f64::MIN, 0.0)]);
    }

    #[test]
    fn a_single_point_is_only_shifted() {
        let frame = Frame::new([DVec3::ONE; 2]);
        assert_eq!(frame.leave(&frame.enter(&[DVec3::ONE])), [DVec3::ONE]);
    }
}
