//! Finds the plane in which a mesh is its own image.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::data::data_is_symmetric;
use crate::mesh::{TriangleMesh, VertexId, bounds};
use crate::mirror::mirrored;
use crate::nearest::Bvh;
use crate::pipeline::Input;
use crate::pipeline::frame::Frame;
use crate::progress::{Cancelled, Progress};

/// In which plane the result is to be its own image.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mirror {
    /// In none.
    Off,
    /// In the first across an axis in which every vertex is the image of another, and so are its
    /// density and the marks of edges, and no stroke runs aslant through it, if there is one. A mesh that is not quite its own image
    /// would lose by it: there the user names the axis.
    #[default]
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
    /// How far its farthest point lies from the mesh once it is mirrored, in % of the diagonal.
    pub off_pct: f64,
}

impl Plane {
    fn new(frame: &Frame, (axis, at): (usize, f64), through: Through, off: Off) -> Self {
        let at = match through {
            Through::Origin => 0.0,
            Through::Middle => frame.leave(&[DVec3::AXES[axis] * at])[0][axis],
        };
        Self {
            axis,
            through,
            at,
            was_symmetric: off.is_symmetric(),
            off_pct: 100.0 * off.most,
        }
    }
}

/// How far a mesh in the frame of work, mirrored, lies from itself.
#[derive(Clone, Copy, Default)]
struct Off {
    mean: f64,
    most: f64,
    /// The share of its area that lies farther than symmetric models do.
    beside: f64,
}

impl Off {
    fn is_symmetric(self) -> bool {
        self.most <= MOST_DEVIATION && self.beside <= SHARE
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
/// Vertices whose mean is farther from a plane are not each other's images in it; this spares most
/// meshes the search for them.
const MOST_LOPSIDED: f64 = 1e-3;
/// About how many points are mirrored.
const N_PROBES: usize = 8_000;

/// The plane that is asked for, of a mesh in the frame of work that was cleaned from an input.
///
/// # Errors
/// When cancelled.
pub fn find(
    mesh: &TriangleMesh,
    (input, frame): (&Input<'_>, &Frame),
    wanted: Mirror,
    progress: &Progress<'_>,
) -> Result<Option<Plane>, Cancelled> {
    let axis = match wanted {
        Mirror::Off => return Ok(None),
        Mirror::Auto => return exact(mesh, (input, frame), progress),
        Mirror::X => 0,
        Mirror::Y => 1,
        Mirror::Z => 2,
    };
    named(mesh, frame, axis, progress).map(Some)
}

/// The planes across an axis that may be taken: through the origin, through the middle of the box.
fn planes([low, high]: [DVec3; 2], frame: &Frame, axis: usize) -> [(Through, f64); 2] {
    [Through::Origin, Through::Middle].map(|through| {
        let at = match through {
            Through::Origin => frame.enter(&[DVec3::ZERO])[0][axis],
            Through::Middle => f64::midpoint(low[axis], high[axis]),
        };
        (through, at)
    })
}

/// The first plane in which every vertex is the image of another, data on them included.
fn exact(
    mesh: &TriangleMesh,
    (input, frame): (&Input<'_>, &Frame),
    progress: &Progress<'_>,
) -> Result<Option<Plane>, Cancelled> {
    let mean = mesh.positions().iter().sum::<DVec3>() / mesh.n_vertices() as f64;
    let corners = bounds(mesh.positions());
    let planes = (0..3).flat_map(|axis| planes(corners, frame, axis).map(|plane| (axis, plane)));
    let planes = planes.filter(|&(axis, (_, at))| (mean[axis] - at).abs() <= MOST_LOPSIDED);
    let planes: Vec<_> = planes.collect();
    if planes.is_empty() {
        return Ok(None);
    }
    let tree = Bvh::build_of_points(mesh.positions(), progress)?;
    for (axis, (through, at)) in planes {
        if has_image_vertices(mesh, &tree, (axis, at), progress)?
            && data_is_symmetric((input, frame), (axis, at), progress)?
        {
            return Ok(Some(Plane::new(frame, (axis, at), through, Off::default())));
        }
    }
    Ok(None)
}

/// The plane across an axis: through the origin, unless the mesh is clearly more symmetric in the
/// one through the middle of the box, or does not reach to the origin.
fn named(
    mesh: &TriangleMesh,
    frame: &Frame,
    axis: usize,
    progress: &Progress<'_>,
) -> Result<Plane, Cancelled> {
    let [low, high] = bounds(mesh.positions());
    let tree = Bvh::build_of_mesh(mesh, progress)?;
    let [origin, middle] = planes([low, high], frame, axis);
    let measured = |(through, at)| {
        let off = off(mesh, &tree, (axis, at), progress)?;
        Ok((off, Plane::new(frame, (axis, at), through, off)))
    };
    let (off_middle, in_middle) = measured(middle)?;
    if origin.1 <= low[axis] || origin.1 >= high[axis] {
        return Ok(in_middle);
    }
    let (off_origin, in_origin) = measured(origin)?;
    let is_clearly_better = off_middle.mean < CLEARLY * off_origin.mean;
    // A mesh that is its own image in one of the two is not made so in the other.
    let takes_middle = if off_origin.is_symmetric() == off_middle.is_symmetric() {
        is_clearly_better
    } else {
        off_middle.is_symmetric()
    };
    Ok(if takes_middle { in_middle } else { in_origin })
}

/// Whether a mesh in the frame of work is its own image in a plane.
pub fn is_symmetric(
    mesh: &TriangleMesh,
    tree: &Bvh,
    plane: (usize, f64),
    progress: &Progress<'_>,
) -> Result<bool, Cancelled> {
    Ok(off(mesh, tree, plane, progress)?.is_symmetric())
}

fn off(
    mesh: &TriangleMesh,
    tree: &Bvh,
    (axis, at): (usize, f64),
    progress: &Progress<'_>,
) -> Result<Off, Cancelled> {
    let points = Bvh::build_of_points(mesh.positions(), progress)?;
    if has_image_vertices(mesh, &points, (axis, at), progress)? {
        return Ok(Off::default());
    }
    let (mut off, mut all) = (Off::default(), 0.0);
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
            all += area;
            off.mean += area * distance;
            off.most = off.most.max(distance);
            off.beside += if distance > DEVIATION { area } else { 0.0 };
        }
    }
    let all = f64::max(all, f64::MIN_POSITIVE);
    (off.mean, off.beside) = (off.mean / all, off.beside / all);
    Ok(off)
}

/// Whether the image of every vertex is a vertex, of which there is a tree: quads cut into
/// triangles either way are none the less symmetric.
fn has_image_vertices(
    mesh: &TriangleMesh,
    tree: &Bvh,
    plane: (usize, f64),
    progress: &Progress<'_>,
) -> Result<bool, Cancelled> {
    for &p in mesh.positions() {
        progress.check()?;
        if image_vertex(tree, p, plane).is_none() {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The vertex, of those in a tree, where the image of a point is.
pub fn image_vertex(tree: &Bvh, point: DVec3, (axis, at): (usize, f64)) -> Option<VertexId> {
    let closest = tree.closest(image(point, axis, at));
    (closest.distance_squared <= SAME * SAME).then_some(VertexId(closest.face.0))
}

fn image(point: DVec3, axis: usize, at: f64) -> DVec3 {
    mirrored(point, axis) + DVec3::AXES[axis] * (2.0 * at)
}
