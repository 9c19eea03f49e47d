//! What the parts of a mesh are to its plane of symmetry.

use glam::DVec3;

use super::plane::{Plane, is_symmetric};
use crate::measure::total_area;
use crate::mesh::{PolygonMesh, TriangleMesh, bounds};
use crate::mirror::mirrored;
use crate::nearest::Bvh;
use crate::pipeline::part::PartResult;
use crate::pipeline::report::Mirrored;
use crate::progress::{Cancelled, Progress};

/// What becomes of a part.
#[derive(Clone, PartialEq, Debug)]
pub enum Role {
    /// It is made its own image.
    Whole,
    /// It is made without regard to the plane; why, where it should be.
    Alone(Option<String>),
    /// It becomes the image of another part.
    ImageOf(usize),
}

/// The corners of two boxes may differ by this share of a box's diagonal, and two areas by this
/// share, if one part is to be the image of the other.
const ALIKE: f64 = 0.05;

/// The role of each part of a mesh whose plane goes through the origin.
///
/// A part across the plane is its own image; one beside it is the image of the part of the positive
/// side that is most like it.
///
/// # Errors
/// When cancelled.
pub fn roles(
    parts: &[TriangleMesh],
    plane: Plane,
    progress: &Progress<'_>,
) -> Result<Vec<Role>, Cancelled> {
    let seen: Vec<Seen> = parts
        .iter()
        .map(|part| Seen::new(part, plane.axis))
        .collect();
    let mut is_taken = vec![false; parts.len()];
    let mut roles = Vec::with_capacity(parts.len());
    for (part, own) in parts.iter().zip(&seen) {
        roles.push(if own.is_across() {
            let is_whole = !plane.was_symmetric || parts.len() == 1 || {
                let tree = Bvh::build_of_mesh(part, progress)?;
                is_symmetric(part, &tree, (plane.axis, 0.0), progress)?
            };
            if is_whole {
                Role::Whole
            } else {
                Role::Alone(Some("it is not its own image in the plane".to_owned()))
            }
        } else if own.low_high[0][plane.axis] >= 0.0 {
            Role::Alone(None)
        } else if let Some(of) = own.most_alike(&seen, &is_taken) {
            is_taken[of] = true;
            Role::ImageOf(of)
        } else {
            Role::Alone(Some("no part of the positive side is its image".to_owned()))
        });
    }
    Ok(roles)
}

/// What is compared of a part.
struct Seen {
    axis: usize,
    low_high: [DVec3; 2],
    area: f64,
}

impl Seen {
    fn new(part: &TriangleMesh, axis: usize) -> Self {
        Self {
            axis,
            low_high: bounds(part.positions()),
            area: total_area(part),
        }
    }

    fn is_across(&self) -> bool {
        let [low, high] = self.low_high.map(|corner| corner[self.axis]);
        // A part that only touches the plane is not across it.
        let least = 1e-3 * (high - low);
        low < -least && high > least
    }

    fn most_alike(&self, all: &[Self], is_taken: &[bool]) -> Option<usize> {
        let [mut low, mut high] = self.low_high;
        [low[self.axis], high[self.axis]] = [-high[self.axis], -low[self.axis]];
        let size = high.distance(low);
        let off = |other: &Self| {
            let [a, b] = other.low_high;
            low.distance(a).max(high.distance(b))
        };
        let is_alike = |other: &Self| {
            let is_positive = !other.is_across() && other.low_high[0][self.axis] >= -1e-9;
            let areas = (other.area - self.area).abs() <= ALIKE * self.area;
            is_positive && areas && off(other) <= ALIKE * size
        };
        let free = (0..all.len()).filter(|&i| !is_taken[i] && is_alike(&all[i]));
        free.min_by(|&a, &b| off(&all[a]).total_cmp(&off(&all[b])))
    }
}

/// The image of a part that is made.
pub fn image_of(made: &PartResult, of: usize, axis: usize) -> PartResult {
    let flip = |points: &[DVec3]| {
        points
            .iter()
            .map(|&p| mirrored(p, axis))
            .collect::<Vec<_>>()
    };
    let faces = made.mesh.faces().map(|face| {
        let mut turned: Vec<u32> = face.iter().map(|v| v.0).collect();
        turned[1..].reverse();
        turned
    });
    let faces: Vec<Vec<u32>> = faces.collect();
    let mesh = PolygonMesh::from_faces(flip(made.mesh.positions()), &faces);
    let mut report = made.report.clone();
    report.mirrored = Some(Mirrored::Image { of });
    PartResult {
        mesh: mesh.expect("faces turned round make a mesh as before"),
        sphere: flip(&made.sphere),
        features: made.features.clone(),
        filling: made
            .filling
            .iter()
            .map(|t| t.map(|p| mirrored(p, axis)))
            .collect(),
        crosses: made.crosses.iter().map(|c| c.mirrored(axis)).collect(),
        area: made.area,
        report,
    }
}
