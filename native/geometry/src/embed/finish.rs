//! The last relaxation of a valid map.

use glam::DVec3;

use super::Settings;
use super::growth::STILL;
use super::level::Level;
use super::partial::Partial;
use super::rest::{Stiffness, to_size_one};
use crate::mesh::{TriangleMesh, VertexMap};
use crate::progress::{Cancelled, Progress};

/// A finished map.
pub struct Finish {
    /// Its points.
    pub sphere: VertexMap<DVec3>,
    /// How many relaxations of single vertices were done.
    pub n_relaxations: u64,
    /// How many sweeps over all vertices.
    pub n_sweeps: u32,
    /// Whether the last one reached the tolerance.
    pub complete: bool,
}

/// Sweeps over a valid map until its energy is settled.
pub fn finish(
    mesh: &TriangleMesh,
    sphere: VertexMap<DVec3>,
    (settings, stiffness): (&Settings, Stiffness),
    progress: &Progress,
) -> Result<Finish, Cancelled> {
    let mut partial = Partial::whole(mesh, sphere, progress)?;
    let positions = to_size_one(mesh.positions());
    let mut level = Level::new(&partial, &positions, stiffness.finish(), progress)?;
    let (mut n_relaxations, mut n_sweeps, mut complete) = (0, 0, false);
    let mut whole = None;
    while n_sweeps < settings.max_sweeps && !complete {
        progress.at(f64::from(n_sweeps) / f64::from(settings.max_sweeps))?;
        let sweep = level.sweep(STILL, progress)?;
        n_relaxations += sweep.n_relaxations;
        n_sweeps += 1;
        complete = sweep.is_settled(&mut whole, settings.tolerance);
    }
    level.store(&mut partial);
    Ok(Finish {
        sphere: partial.sphere,
        n_relaxations,
        n_sweeps,
        complete,
    })
}
