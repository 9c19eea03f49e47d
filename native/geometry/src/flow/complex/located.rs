//! Points that lie inside faces and are found again after every flip.

use crate::mesh::{FaceId, Id, VertexId};

const END: u32 = u32::MAX;

/// A vertex of the mesh inside a face of the complex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Located {
    /// Which vertex it is.
    pub vertex: VertexId,
    /// The face that holds it.
    pub face: FaceId,
    /// Its barycentric weights at the corners 0, 1, 2 of the face.
    pub weights: [f64; 3],
}

/// All located points, chained by face: flat arrays that are cheap to copy.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct LocatedPoints {
    points: Vec<Located>,
    next: Vec<u32>,
    first: Vec<u32>,
}

impl LocatedPoints {
    /// No point in any of the faces.
    pub fn new(n_faces: usize) -> Self {
        Self {
            points: Vec::new(),
            next: Vec::new(),
            first: vec![END; n_faces],
        }
    }

    /// Every point, in the order in which they were added.
    pub fn points(&self) -> &[Located] {
        &self.points
    }

    /// Forgets every point: for searches that need the metric alone.
    pub fn clear(&mut self) {
        self.points.clear();
        self.next.clear();
        self.first.fill(END);
    }

    /// Adds one more point.
    pub fn add(&mut self, point: Located) {
        self.points.push(point);
        self.next.push(END);
        self.put(self.points.len() - 1, point.face, point.weights);
    }

    /// The numbers of the points in a face.
    pub fn in_face(&self, face: FaceId) -> impl Iterator<Item = usize> + '_ {
        let mut at = self.first[face.index()];
        std::iter::from_fn(move || {
            let point = (at != END).then_some(at as usize)?;
            at = self.next[point];
            Some(point)
        })
    }

    /// Takes the points out of a face; each must be put somewhere again.
    pub(in crate::flow) fn take(&mut self, face: FaceId) -> Vec<usize> {
        let taken = self.in_face(face).collect();
        self.first[face.index()] = END;
        taken
    }

    /// Puts a point that was taken into a face.
    pub(in crate::flow) fn put(&mut self, point: usize, face: FaceId, weights: [f64; 3]) {
        // Rounding may leave a point on an edge a hair outside.
        let inside = weights.map(|w| w.max(0.0));
        let sum: f64 = inside.iter().sum();
        self.points[point].face = face;
        self.points[point].weights = inside.map(|w| w / sum);
        self.next[point] = std::mem::replace(&mut self.first[face.index()], point as u32);
    }

    /// Renumbers faces: each of the given ones takes its place in the list.
    pub(super) fn keep_faces(&mut self, faces: &[usize]) {
        self.first = faces.iter().map(|&f| self.first[f]).collect();
        for f in 0..faces.len() {
            let mut at = self.first[f];
            while at != END {
                self.points[at as usize].face = FaceId::from_index(f);
                at = self.next[at as usize];
            }
        }
    }
}
