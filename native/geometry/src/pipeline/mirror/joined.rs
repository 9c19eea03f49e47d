//! The faces of a half and their image, joined along the seam.

use glam::DVec3;

use super::seam::Seam;
use crate::deform::{self, Deformed};
use crate::measure::{PolygonEdges, topology};
use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::mirror::mirrored;
use crate::nearest::Bvh;
use crate::pipeline::flowed::Flowed;
use crate::pipeline::part::PartResult;
use crate::pipeline::report::Mirrored;
use crate::progress::{Cancelled, Progress};

/// Where the seam ends there is a vertex no farther away than this share of the diagonal.
const SAME: f64 = 1e-5;
/// An edge belongs to the seam if its ends are no farther from the plane than this share of it.
const NEAR: f64 = 0.1;

/// The whole of a half: its faces and their image, one mesh; or why that is not the part.
///
/// # Errors
/// When cancelled.
pub fn joined(
    half: PartResult,
    seam: &Seam,
    progress: &Progress<'_>,
) -> Result<Result<PartResult, String>, Cancelled> {
    let Some(pair) = Pair::new(&half.mesh, seam, progress)? else {
        return Ok(Err(
            "faces of its half do not end where it meets the plane".to_owned()
        ));
    };
    let axis = seam.axis;
    let mesh = match pair.mesh(&half.mesh, axis) {
        Ok(mesh) => mesh,
        Err(reason) => return Ok(Err(reason)),
    };
    let found = topology(&mesh, progress)?;
    let (n_borders, euler) = seam.whole;
    let genus = (2 - n_borders as i64 - euler) / 2;
    if (found.n_components, found.n_borders, found.genus) != (1, n_borders, Some(genus)) {
        return Ok(Err(format!(
            "faces of its half and their image have {} borders and {} handles, not {n_borders} and {genus}",
            found.n_borders,
            found
                .genus
                .map_or("no".to_owned(), |genus| genus.to_string())
        )));
    }
    let sphere = pair.both(&half.sphere, |p| mirrored(p, axis));
    let features = pair.edges(&half.features);
    let deformed = Deformed::in_space(mesh, sphere, features, progress)?;
    let mut report = half.report;
    report.n_faces = deformed.mesh.n_faces();
    report.mirrored = Some(Mirrored::Used);
    report.deform = deform::Report {
        n_inverted: deformed.report.n_inverted,
        n_crossing_left: deformed.report.n_crossing_left,
        n_crossing: 2 * report.deform.n_crossing,
        ..report.deform
    };
    if let Some(Flowed::Used { flow, .. }) = &mut report.flow {
        flow.n_quads = report.n_faces;
    }
    let crosses = half.crosses.iter().map(|cross| cross.mirrored(axis));
    Ok(Ok(PartResult {
        mesh: deformed.mesh,
        sphere: deformed.sphere,
        features: deformed.features,
        crosses: half.crosses.iter().copied().chain(crosses).collect(),
        filling: half.filling,
        area: half.area,
        report,
    }))
}

/// The vertices of a half and of its image.
struct Pair {
    /// The image of each; its own in the seam. None for those of no face any more.
    images: Vec<VertexId>,
    is_seam: Vec<bool>,
    n: usize,
}

impl Pair {
    /// None where no edge lies along the seam, or an end of it was not met.
    fn new(
        mesh: &PolygonMesh,
        seam: &Seam,
        progress: &Progress<'_>,
    ) -> Result<Option<Self>, Cancelled> {
        let edges = PolygonEdges::new(mesh, progress)?;
        let tree = |pieces: &[[DVec3; 2]]| {
            let pieces: Vec<_> = pieces.iter().map(|&[a, b]| [a, b, b]).collect();
            (!pieces.is_empty())
                .then(|| Bvh::build(&pieces, progress))
                .transpose()
        };
        let (own, others) = (tree(&seam.edges)?, tree(&seam.borders)?);
        let away = |tree: &Option<Bvh>, p: DVec3| {
            let tree = tree.as_ref();
            tree.map_or(f64::INFINITY, |tree| tree.closest(p).distance_squared)
        };
        let mut is_seam = vec![false; mesh.n_vertices()];
        let alone = edges.ends.iter().zip(&edges.n_sides);
        for (ends, _) in alone.filter(|(_, n_sides)| **n_sides == 1) {
            let [a, b] = ends.map(|v| mesh.position(v));
            let least = NEAR * a.distance(b);
            let is_near = [a, b].iter().all(|p| p[seam.axis].abs() <= least);
            let middle = a.midpoint(b);
            if is_near && away(&own, middle) <= away(&others, middle) {
                for v in ends {
                    is_seam[v.index()] = true;
                }
            }
        }
        let is_met = |end: &DVec3| {
            let mut shared = mesh.positions().iter().zip(&is_seam);
            shared.any(|(p, &is_seam)| is_seam && p.distance_squared(*end) <= SAME * SAME)
        };
        if !is_seam.contains(&true) || !seam.ends.iter().all(is_met) {
            return Ok(None);
        }
        let mut n = mesh.n_vertices();
        let mut image = |(v, &is_seam): (usize, &bool)| {
            n += usize::from(!is_seam);
            VertexId::from_index(if is_seam { v } else { n - 1 })
        };
        let images = is_seam.iter().enumerate().map(&mut image).collect();
        Ok(Some(Self { images, is_seam, n }))
    }

    fn both<T: Copy>(&self, of_half: &[T], image: impl Fn(T) -> T) -> Vec<T> {
        let beyond = of_half.iter().zip(&self.is_seam);
        let beyond = beyond.filter(|(_, is_seam)| !**is_seam);
        let images = beyond.map(|(&value, _)| image(value));
        of_half.iter().copied().chain(images).collect()
    }

    fn edges(&self, of_half: &[[VertexId; 2]]) -> Vec<[VertexId; 2]> {
        let images = of_half
            .iter()
            .map(|ends| ends.map(|v| self.images[v.index()]));
        let mut edges: Vec<[VertexId; 2]> = of_half.iter().copied().chain(images).collect();
        for ends in &mut edges {
            ends.sort_unstable();
        }
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    fn mesh(&self, half: &PolygonMesh, axis: usize) -> Result<PolygonMesh, String> {
        let mut positions = half.positions().to_vec();
        for (p, _) in positions
            .iter_mut()
            .zip(&self.is_seam)
            .filter(|(_, is)| **is)
        {
            p[axis] = 0.0;
        }
        let positions = self.both(&positions, |p| mirrored(p, axis));
        debug_assert_eq!(positions.len(), self.n);
        let own = half.faces().map(<[VertexId]>::to_vec);
        let images = half.faces().map(|face| {
            let mut image: Vec<VertexId> = face.iter().map(|v| self.images[v.index()]).collect();
            image[1..].reverse();
            image
        });
        let named = |face: Vec<VertexId>| face.iter().map(|v| v.0).collect();
        let faces: Vec<Vec<u32>> = own.chain(images).map(named).collect();
        PolygonMesh::from_faces(positions, &faces).map_err(|error| error.to_string())
    }
}
