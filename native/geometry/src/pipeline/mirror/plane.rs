//! Finds the plane in which a mesh is its own image.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::mesh::{TriangleMesh, bounds};
use crate::mirror::mirrored;
use crate::nearest::Bvh;
use crate::pipeline::frame::Frame;
use crate::progress::{Cancelled, Progress};

/// In which plane the result is to be its own image.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mirror {
    /// In none.
    #[default]
    Off,
    /// In the first across an axis in which the mesh is its own image, if there is one.
    Auto,
    /// In the one across x; a mesh that is not its own image there is made so from the side of
    /// positive x.
    X,
    /// The same for y.
    Y,
    /// The same for z.
    Z,
}

impl Mirror {
    /// The name, as users write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Auto => "auto",
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }

    fn axes(self) -> &'static [usize] {
        match self {
            Self::Off => &[],
            Self::Auto => &[0, 1, 2],
            Self::X => &[0],
            Self::Y => &[1],
            Self::Z => &[2],
        }
    }
}

/// Through what a plane of symmetry goes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Through {
    /// The origin of the mesh's own coordinates.
    Origin,
    /// The middle of its bounding box.
    Middle,
}

/// A plane of symmetry.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Plane {
    /// The axis across it: 0, 1 or 2.
    pub axis: usize,
    /// Through what it goes.
    pub through: Through,
    /// The coordinate of its points along the axis.
    pub at: f64,
    /// Whether the mesh was its own image in it; if not, it is made so from the positive side.
    pub was_symmetric: bool,
}

impl Plane {
    fn new(frame: &Frame, (axis, at): (usize, f64), through: Through, was_symmetric: bool) -> Self {
        let at = match through {
            Through::Origin => 0.0,
            Through::Middle => frame.leave(&[DVec3::AXES[axis] * at])[0][axis],
        };
        Self {
            axis,
            through,
            at,
            was_symmetric,
        }
    }
}

/// A mesh is its own image where all but 5 % of it, mirrored, lie nearer to it than this share of
/// the diagonal. Symmetric models have 0.003, shapes that only look symmetric 0.005 and more.
const DEVIATION: f64 = 0.004;
/// The share that may lie farther away.
const SHARE: f64 = 0.05;
/// And none lies farther than this: a handle on one side is not to go away.
const MOST_DEVIATION: f64 = 0.02;
/// The middle of the box is taken instead of the origin where the mesh deviates by less than this
/// share of what it does there.
const CLEARLY: f64 = 0.6;
/// Two vertices are each other's images where they are no farther apart.
const SAME: f64 = 1e-4;
/// About how many points are mirrored.
const N_PROBES: usize = 8_000;

/// The plane that is asked for, of a mesh in the frame of work.
///
/// A plane through the origin comes before one through the middle of the box, unless the mesh is
/// clearly more symmetric in that.
///
/// # Errors
/// When cancelled.
pub fn find(
    mesh: &TriangleMesh,
    frame: &Frame,
    wanted: Mirror,
    progress: &Progress<'_>,
) -> Result<Option<Plane>, Cancelled> {
    if wanted == Mirror::Off {
        return Ok(None);
    }
    let [low, high] = bounds(mesh.positions());
    let tree = Bvh::build_of_mesh(mesh, progress)?;
    for &axis in wanted.axes() {
        let planes = [Through::Origin, Through::Middle].map(|through| {
            (
                through,
                match through {
                    Through::Origin => frame.enter(&[DVec3::ZERO])[0][axis],
                    Through::Middle => f64::midpoint(low[axis], high[axis]),
                },
            )
        });
        let mut found: Option<(f64, Plane)> = None;
        for (through, at) in planes {
            let is_far = (low[axis] + high[axis] - 2.0 * at).abs() > MOST_DEVIATION;
            let deviation = if is_far {
                None
            } else {
                deviation(mesh, &tree, (axis, at), progress)?
            };
            let is_better = |deviation: &f64| found.is_none_or(|f| *deviation < CLEARLY * f.0);
            if let Some(deviation) = deviation.filter(is_better) {
                found = Some((deviation, Plane::new(frame, (axis, at), through, true)));
            }
        }
        if let Some((_, plane)) = found {
            return Ok(Some(plane));
        }
        if wanted != Mirror::Auto {
            let cuts = |at: f64| low[axis] < at && at < high[axis];
            let (through, at) = planes[usize::from(!cuts(planes[0].1))];
            return Ok(Some(Plane::new(frame, (axis, at), through, false)));
        }
    }
    Ok(None)
}

/// How far the image of a mesh in the frame of work is from it in the mean, if it is its own image
/// in a plane.
pub fn deviation(
    mesh: &TriangleMesh,
    tree: &Bvh,
    (axis, at): (usize, f64),
    progress: &Progress<'_>,
) -> Result<Option<f64>, Cancelled> {
    if has_image_vertices(mesh, (axis, at), progress)? {
        return Ok(Some(0.0));
    }
    let [mut all, mut beside, mut sum] = [0.0; 3];
    for face in mesh
        .face_ids()
        .step_by((4 * mesh.n_faces()).div_ceil(N_PROBES))
    {
        progress.check()?;
        let corners = mesh.triangle(face);
        let area = (corners[1] - corners[0])
            .cross(corners[2] - corners[0])
            .length();
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for point in [middle, corners[0], corners[1], corners[2]] {
            let distance = tree.closest(image(point, axis, at)).distance_squared.sqrt();
            if distance > MOST_DEVIATION {
                return Ok(None);
            }
            all += area;
            sum += area * distance;
            beside += if distance > DEVIATION { area } else { 0.0 };
        }
    }
    Ok((beside <= SHARE * all).then_some(sum / all.max(f64::MIN_POSITIVE)))
}

/// Whether the image of every vertex is a vertex: quads cut into triangles either way are none
/// the less symmetric.
fn has_image_vertices(
    mesh: &TriangleMesh,
    (axis, at): (usize, f64),
    progress: &Progress<'_>,
) -> Result<bool, Cancelled> {
    let tree = Bvh::build_of_points(mesh.positions(), progress)?;
    for &p in mesh.positions() {
        progress.check()?;
        if tree.closest(image(p, axis, at)).distance_squared > SAME * SAME {
            return Ok(false);
        }
    }
    Ok(true)
}

fn image(point: DVec3, axis: usize, at: f64) -> DVec3 {
    mirrored(point, axis) + DVec3::AXES[axis] * (2.0 * at)
}
