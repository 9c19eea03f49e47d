//! Orbflow's core: rebuilds a mesh at a wanted face count by deforming a sphere into it.
//!
//! [`pipeline::remesh`] does it all. This is the tour of its steps, with one mesh through them:
//!
//! ```
//! use glam::DVec3;
//! use orbflow_geometry::{clean, decimate, deform, embed, mesh::PolygonMesh, score, sphere};
//! use orbflow_geometry::progress::Progress;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let quiet = Progress::none();
//! // Polygons come in: here an icosphere, stretched.
//! let ball = sphere::icosphere(12);
//! let points: Vec<DVec3> = ball.positions().iter().map(|&p| p * DVec3::new(2.0, 1.0, 1.0)).collect();
//! let input: PolygonMesh = ball.with_positions(points);
//!
//! // They become an oriented manifold triangle mesh, and that a smaller one for the map.
//! let cleaned = clean::clean(&input, &quiet)?;
//! let small = decimate::simplify(&cleaned.mesh, &decimate::Settings { n_faces: 1000 }, &quiet)?;
//!
//! // Collapsed to a tetrahedron, a predictor proposes where its vertices go on the sphere;
//! // what comes out is proven to be a bijection.
//! let hierarchy = decimate::collapse_to_tetrahedron(small.mesh, &quiet)?;
//! let solver = embed::Solver::default();
//! let embedded = embed::embed(&hierarchy, &solver, &embed::Settings::default(), &quiet)?;
//!
//! // A sphere of quads goes through the map to the surface at full resolution.
//! let primitive = sphere::quad_sphere(sphere::quad_sphere_counts(600));
//! let target = deform::Target::new(cleaned.mesh, &quiet)?;
//! let settings = deform::Settings::default();
//! let deformed = deform::deform(&embedded.map, &primitive, &target, &settings, &quiet)?;
//! assert_eq!(deformed.mesh.n_quads(), 600);
//!
//! // And that can be told in numbers.
//! let score = score::score(&input, &deformed.mesh, &score::Settings::default(), &quiet)?;
//! assert!(score.distance.chamfer_pct < 0.5);
//! # Ok(())
//! # }
//! ```

pub mod chords;
pub mod clean;
pub mod close;
pub mod decimate;
pub mod deform;
pub mod elementary;
pub mod embed;
pub mod flow;
pub mod graft;
pub mod groups;
pub mod guidance;
pub mod hierarchy;
pub mod measure;
pub mod mesh;
pub mod mirror;
pub mod nearest;
pub mod pair;
pub mod pipeline;
pub mod progress;
pub mod random;
pub mod rejoin;
pub mod score;
pub mod solid;
pub mod sparse;
pub mod sphere;
pub mod sphere_map;
pub mod transfer;

#[cfg(test)]
extern crate self as orbflow_geometry;
#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod shapes;

#[cfg(test)]
mod tests {
    use crate::shapes;

    #[test]
    fn the_test_shapes_are_closed_and_of_genus_zero() {
        for (name, mesh) in shapes::closed(6) {
            assert!(mesh.is_closed(), "{name}");
            assert_eq!(mesh.euler_number(), 2, "{name}");
            assert_eq!(mesh.n_faces(), 6 * 6 * 6 * 2, "{name}");
        }
    }
}
