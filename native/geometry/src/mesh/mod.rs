//! Meshes: topology and positions, with typed ids and builders that check.
//!
//! [`PolygonMesh`] is what comes in and goes out: polygons that promise only valid indices and
//! finite coordinates. [`TriangleMesh`] is what the algorithms work on: oriented, manifold, with
//! neighbours at hand. Neither can be built broken, and neither can be edited in place: an edit
//! builds a new mesh, so that every mesh passes the checks.

mod ids;
pub mod io;
mod polygon_mesh;
mod triangle_mesh;

pub use ids::{FaceId, FaceMap, HalfedgeId, HalfedgeMap, Id, IdMap, VertexId, VertexMap};
pub use polygon_mesh::{MAX_ELEMENTS, PolygonMesh, PolygonMeshError, bounds};
pub use triangle_mesh::{Outgoing, TriangleMesh, TriangleMeshError};
