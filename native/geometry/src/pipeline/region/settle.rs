//! Room beside what is kept: vertices there find better places on the surface.

use glam::DVec3;

use crate::deform::{self, Target};
use crate::graft::Grafted;
use crate::measure::PolygonEdges;
use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::pipeline::open;
use crate::progress::{Cancelled, Progress};

/// Rings of faces beside what is kept whose vertices find better places.
const N_RINGS: usize = 3;
/// Rounds in which these go to the middle of their neighbours.
const N_SMOOTHINGS: usize = 6;
/// Quality up to which faces there are mended.
const ENOUGH: f64 = 0.7;

/// Vertices beside what is kept at better places of the surface; borders and lines stay.
pub fn settled(
    grafted: &Grafted,
    features: &[[VertexId; 2]],
    target: &Target,
    progress: &Progress<'_>,
) -> Result<PolygonMesh, Cancelled> {
    let mesh = &grafted.mesh;
    let mut is_fixed = PolygonEdges::new(mesh, progress)?.border_vertices(mesh.n_vertices());
    for &v in grafted.at.values() {
        is_fixed[v.index()] = true;
    }
    let mut is_bound = is_fixed.clone();
    for v in features.iter().flatten() {
        is_bound[grafted.name[*v].index()] = true;
    }
    let mut is_near = vec![false; mesh.n_vertices()];
    for v in grafted.at.values().chain(&grafted.loose) {
        is_near[v.index()] = true;
    }
    for _ in 0..N_RINGS {
        let touched = mesh
            .faces()
            .filter(|face| face.iter().any(|v| is_near[v.index()]));
        let more: Vec<VertexId> = touched.flatten().copied().collect();
        for v in more {
            is_near[v.index()] = true;
        }
    }
    for (i, is_near) in is_near.iter().enumerate() {
        is_fixed[i] |= !is_near;
        is_bound[i] |= !is_near;
    }
    let settled = settled_where((mesh, &is_bound), target, progress)?;
    let n_inverted = deform::n_inverted(&settled);
    if n_inverted == 0 || is_bound == is_fixed {
        return Ok(settled);
    }
    // Lines that end beside what is kept may leave no room.
    let other = settled_where((mesh, &is_fixed), target, progress)?;
    Ok(if deform::n_inverted(&other) < n_inverted {
        other
    } else {
        settled
    })
}

/// Vertices that are not fixed at better places.
fn settled_where(
    (mesh, is_fixed): (&PolygonMesh, &[bool]),
    target: &Target,
    progress: &Progress<'_>,
) -> Result<PolygonMesh, Cancelled> {
    let smooth = smoothed((mesh, is_fixed), target, progress)?;
    let settled = deform::settle(&smooth, (is_fixed, ENOUGH), target, progress)?;
    open::untangled(&settled, target, progress)
}

/// Vertices in the middle of their neighbours, on the surface.
fn smoothed(
    (mesh, is_fixed): (&PolygonMesh, &[bool]),
    target: &Target,
    progress: &Progress<'_>,
) -> Result<PolygonMesh, Cancelled> {
    let edges = PolygonEdges::new(mesh, progress)?;
    let mut around: Vec<Vec<VertexId>> = vec![Vec::new(); mesh.n_vertices()];
    for &[a, b] in &edges.ends {
        around[a.index()].push(b);
        around[b.index()].push(a);
    }
    let mut places = mesh.positions().to_vec();
    for _ in 0..N_SMOOTHINGS {
        progress.check()?;
        for v in (0..places.len()).filter(|&v| !is_fixed[v]) {
            let sum: DVec3 = around[v].iter().map(|u| places[u.index()]).sum();
            let wanted = places[v].lerp(sum / around[v].len().max(1) as f64, 0.5);
            places[v] = target.bvh().closest(wanted).position;
        }
    }
    Ok(mesh.with_positions(places))
}
