//! Sizes: how long the edges of quads are wanted at every place.
//!
//! ```text
//! curvature^(−adaptivity / 4) · weight^(−½) · factor for the count, capped round limbs
//! ```
//!
//! The mean distance between quads and a surface grows as curvature times length squared; at a
//! given number of quads it is least for lengths as the −¼th power of curvature. Round a limb
//! thinner than a few quads sizes are capped, so that a few still go round.

mod girth;
mod grade;

use thiserror::Error;

use crate::elementary::{hypot, powf};
use crate::measure::{area_vector, principal_curvatures, total_area};
use crate::mesh::{FaceMap, TriangleMesh, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sparse::NotPositiveDefinite;
use girth::girths;
use grade::{Wanted, grade};

/// By how much of the way sizes may grow from a place to another. Steeper, the map along the field
/// cannot follow; flatter, thin limbs make their surroundings small.
const SLOPE: f64 = 0.25;
/// Curvatures count as at least and at most this, per wanted length of an edge: below, a quad is
/// as good as flat; above, it cannot show the shape.
const BENT: [f64; 2] = [0.05, 3.0];
/// Round limbs with room for fewer quads than this sizes are capped: quads are sheared or doubled.
const FEWEST: f64 = 3.0;
/// What limbs get in even quads.
const EVEN_LIMBS: Limbs = Limbs {
    more: 0.0,
    least: 0.3,
    growth: 1.25,
};
/// What they get at full adaptivity: without one more, fingers have no rings; with two more, faces
/// and trunks of bodies lose more than hands gain.
const ADAPTIVE_LIMBS: Limbs = Limbs {
    more: 1.0,
    least: 0.4,
    growth: 1.5,
};

/// How limbs that are thin for a quad are favoured.
#[derive(Clone, Copy)]
struct Limbs {
    /// So many more quads than the fewest go round them where no more than two would; fewer where
    /// nearly enough would, so that sizes do not jump where a limb grows thick.
    more: f64,
    /// But none smaller than this share of the even size.
    least: f64,
    /// How much longer edges elsewhere may become to make room; beyond, limbs give way too.
    growth: f64,
}

impl Limbs {
    fn new(adaptivity: f64) -> Self {
        let [even, adaptive] = [EVEN_LIMBS, ADAPTIVE_LIMBS];
        let between = |a: f64, b: f64| a + (b - a) * adaptivity.min(1.0);
        Self {
            more: between(even.more, adaptive.more),
            least: between(even.least, adaptive.least),
            growth: between(even.growth, adaptive.growth),
        }
    }

    /// The most that edges are to be long at every vertex; infinite away from limbs.
    fn caps(
        self,
        mesh: &TriangleMesh,
        even: f64,
        progress: &Progress,
    ) -> Result<VertexMap<f64>, Cancelled> {
        let mut caps = girths(mesh, FEWEST * even, progress)?;
        for cap in caps.as_mut_slice() {
            let missing = (FEWEST - *cap / even).clamp(0.0, 1.0);
            *cap = (*cap / (FEWEST + self.more * missing)).max(self.least * even);
        }
        grade(mesh, &mut caps, SLOPE);
        Ok(caps)
    }
}

/// How sizes follow the shape.
#[derive(Clone, PartialEq, Debug)]
pub struct Settings {
    /// 0 for even quads, 1 for those nearest to the surface; more exaggerates.
    pub adaptivity: f64,
    /// How many more quads per area each vertex of the surface wants than others, if not as many.
    pub weights: Option<VertexMap<f64>>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            adaptivity: 1.0,
            weights: None,
        }
    }
}

/// Why there are no sizes.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum SizesError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The sizes of the mesh overflow.
    #[error(transparent)]
    Unsolvable(#[from] NotPositiveDefinite),
    /// Not one positive weight for every vertex.
    #[error("{n_positive} positive weights for {n_vertices} vertices")]
    Weights {
        /// How many weights are positive and finite.
        n_positive: usize,
        /// How many are needed.
        n_vertices: usize,
    },
}

/// The wanted length of edges at every face, so that `n_quads` quads cover a closed mesh.
///
/// A limb's quads are taken from the rest, which grow by a quarter to a half at most; then limbs
/// give way too. Costs two passes over the vertices in the order of their sizes, short walks around every
/// place, and one sparse factorisation if adaptive.
///
/// # Errors
/// Weights that do not fit the mesh, sizes that overflow, or a cancellation.
pub fn sizes(
    mesh: &TriangleMesh,
    n_quads: usize,
    settings: &Settings,
    progress: &Progress,
) -> Result<FaceMap<f64>, SizesError> {
    let areas = vertex_areas(mesh);
    let n_quads = n_quads.max(1) as f64;
    let even = (areas.iter().sum::<f64>() / n_quads).sqrt();
    let mut sizes = wanted(mesh, settings, even)?;
    progress.at(0.5)?;
    grade(mesh, &mut sizes, SLOPE);
    let limbs = Limbs::new(settings.adaptivity);
    let caps = limbs.caps(mesh, even, &progress.part("", 0.5, 0.9))?;
    let wanted = Wanted {
        areas: &areas,
        sizes: &sizes,
        caps: &caps,
        most_growth: limbs.growth,
    };
    let sizes = wanted.fit(n_quads);
    let mean = |face| mesh.face(face).iter().map(|&v| sizes[v]).sum::<f64>() / 3.0;
    Ok(mesh.face_ids().map(mean).collect())
}

/// How much shorter than even ones the edges of `n_quads` quads have to be at every vertex to go
/// round its limb, as a share, 1 away from limbs.
///
/// # Errors
/// A cancellation.
pub fn limb_shares(
    mesh: &TriangleMesh,
    n_quads: usize,
    settings: &Settings,
    progress: &Progress,
) -> Result<VertexMap<f64>, Cancelled> {
    let even = (total_area(mesh) / n_quads.max(1) as f64).sqrt();
    let caps = Limbs::new(settings.adaptivity).caps(mesh, even, progress)?;
    Ok(caps.iter().map(|cap| (cap / even).min(1.0)).collect())
}

/// What curvature and weights want, about `even` long.
fn wanted(
    mesh: &TriangleMesh,
    settings: &Settings,
    even: f64,
) -> Result<VertexMap<f64>, SizesError> {
    let mut sizes = VertexMap::filled(mesh.n_vertices(), even);
    if settings.adaptivity > 0.0 {
        let [least, most] = BENT;
        let curvatures = principal_curvatures(mesh, even)?;
        for (size, curvature) in sizes.as_mut_slice().iter_mut().zip(&curvatures) {
            let bent = (hypot(curvature.k1, curvature.k2) * even).clamp(least, most);
            *size *= powf(bent, -0.25 * settings.adaptivity);
        }
    }
    if let Some(weights) = &settings.weights {
        let is_positive = |w: &&f64| **w > 0.0 && w.is_finite();
        let n_positive = weights.iter().filter(is_positive).count();
        let n_vertices = mesh.n_vertices();
        if [n_positive, weights.len()] != [n_vertices; 2] {
            return Err(SizesError::Weights {
                n_positive,
                n_vertices,
            });
        }
        for (size, weight) in sizes.as_mut_slice().iter_mut().zip(weights) {
            *size /= weight.sqrt();
        }
    }
    Ok(sizes)
}

/// A third of the area of the faces at every vertex.
fn vertex_areas(mesh: &TriangleMesh) -> VertexMap<f64> {
    let mut areas = VertexMap::filled(mesh.n_vertices(), 0.0);
    for face in mesh.face_ids() {
        let area = area_vector(mesh.triangle(face)).length();
        for v in mesh.face(face) {
            areas[v] += area / 3.0;
        }
    }
    areas
}

#[cfg(test)]
mod tests;
