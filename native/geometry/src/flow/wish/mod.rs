//! The wish: the flat map that follows the orientation field best, in units of a quad's edge.
//!
//! A seamless Poisson problem. The surface is cut along a tree through all singularities into a
//! disk, the frames on it are turned alike, and the points of the plane are found whose differences
//! fit the edges' vectors in the frames best, ½ cot |dp − e / h|², while across the cut they
//! differ by a quarter turn and a shift. Nothing keeps triangles from folding: it is only a wish.

mod close;
mod disk;

use glam::DVec2;
use thiserror::Error;

use crate::flow::complex::Turn;
use crate::flow::field::{Charts, OrientationField, axes, in_chart};
use crate::mesh::{FaceMap, HalfedgeMap, TriangleMesh};
use crate::progress::{Cancelled, Progress};
use crate::sparse::{HermitianMatrix, NotPositiveDefinite};

use disk::Disk;

/// How much a difference across the cut weighs beside one of an edge.
const CUT_WEIGHT: f64 = 1e4;

/// Why there is no wish.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum WishError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The sizes of the mesh overflow.
    #[error(transparent)]
    Unsolvable(#[from] NotPositiveDefinite),
}

/// The wished vector of every halfedge, in its face's frame, for quads whose edges are as long as
/// `sizes` says for each face.
///
/// The vectors of a face sum up to zero, and twins' vectors are w and −i^r w, r the turn of the
/// first. One sparse factorisation, O(n^1.5).
///
/// # Errors
/// When sizes overflow or on cancellation.
///
/// # Panics
/// When the field belongs to another mesh.
pub fn wish(
    mesh: &TriangleMesh,
    field: &OrientationField,
    sizes: &FaceMap<f64>,
    progress: &Progress,
) -> Result<HalfedgeMap<DVec2>, WishError> {
    let charts = Charts::new(mesh);
    let disk = Disk::new(mesh, field);
    progress.at(0.1)?;
    let arms = arms(mesh, field);
    let wanted = mesh
        .halfedge_ids()
        .map(|halfedge| {
            let arm = arms[halfedge.face()];
            let in_frame =
                DVec2::new(arm.x, -arm.y).rotate(charts.edge(halfedge) / sizes[halfedge.face()]);
            in_frame.turned(disk.combed[halfedge.face()])
        })
        .collect();
    let points = solve(mesh, (&charts, &disk, &field.turns), &wanted)?;
    progress.at(0.9)?;
    let mut vectors: HalfedgeMap<DVec2> = mesh
        .halfedge_ids()
        .map(|h| {
            let along = points[disk.classes[h.next()]] - points[disk.classes[h]];
            along.turned(4 - disk.combed[h.face()])
        })
        .collect();
    close::close(mesh, &field.turns, &mut vectors);
    Ok(vectors)
}

/// The directions of the field in the faces' charts.
fn arms(mesh: &TriangleMesh, field: &OrientationField) -> FaceMap<DVec2> {
    let axes = axes(mesh);
    let both = field.directions.iter().zip(&axes);
    both.map(|(direction, axes)| in_chart(*direction, axes))
        .collect()
}

/// The points of the disk.
fn solve(
    mesh: &TriangleMesh,
    (charts, disk, turns): (&Charts, &Disk, &HalfedgeMap<u8>),
    wanted: &HalfedgeMap<DVec2>,
) -> Result<Vec<DVec2>, NotPositiveDefinite> {
    let mut system = HermitianMatrix::new(disk.n_classes);
    let mut points = vec![DVec2::ZERO; disk.n_classes];
    for h in mesh.halfedge_ids() {
        let weight = 0.5 * charts.cotangent(h).clamp(0.05, 10.0);
        let [from, to] = [disk.classes[h], disk.classes[h.next()]];
        system.add_square(&[(from, DVec2::NEG_X), (to, DVec2::X)], weight);
        points[to] += wanted[h] * weight;
        points[from] -= wanted[h] * weight;
        let Some(twin) = mesh.twin(h).filter(|twin| disk.is_cut[h] && h < *twin) else {
            continue;
        };
        let combed = 4 + turns[h] + disk.combed[twin.face()] - disk.combed[h.face()];
        let turned = DVec2::X.turned(combed);
        let jump = [
            (from, -turned),
            (to, turned),
            (disk.classes[twin], DVec2::NEG_X),
            (disk.classes[twin.next()], DVec2::X),
        ];
        system.add_square(&jump, CUT_WEIGHT);
    }
    // Only differences count: the first point stays, and a shift that rounding cannot lose keeps
    // the system definite where a turn and its way back leave a singularity loose.
    system.add(0, 0, DVec2::X);
    for i in 0..disk.n_classes {
        system.add(i, i, DVec2::X * 1e-7);
    }
    let order = system.order()?;
    system.factorize(&order)?.solve(&mut points);
    Ok(points)
}

#[cfg(test)]
mod tests;
