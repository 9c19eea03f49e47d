//! The even surface that flowing quads are found on, and where edges that the user marked are on it.
//!
//! On limbs that are thin for a quad it is finer, as far as sizes are to follow the shape: of even
//! triangles there would be three round a finger, whose tip and gaps are lost.

use glam::DVec3;

use super::open::Opening;
use super::strokes::Finer;
use crate::deform::{self, Held, Lines, Sizes, Target};
use crate::elementary::powf;
use crate::measure::{FeatureLine, feature_lines, loose_share, sharp_edges};
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId, VertexMap};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::sphere::{self, Adaptive};
use crate::sphere_map::SphereMap;
use crate::{embed, flow, pipeline, transfer};

/// The even surface has this many triangles at least, so that the field sees the shape.
const LEAST_TRIANGLES: usize = 16_000;
/// For few quads that is more than they can show.
const MOST_TRIANGLES_PER_QUAD: usize = 40;
/// And at least this many per quad: fewer place quads less well, more only cost time.
const TRIANGLES_PER_QUAD: f64 = 3.0;

/// Cosine of the most by which triangles turn when vertices are set onto marked edges: 60°.
const LEAST_COSINE: f64 = 0.5;

/// The places of the edges of a target that the user marked.
pub struct Marked(Vec<[DVec3; 2]>);

impl Marked {
    /// Those of a mesh that are marked, on both sides of each.
    pub fn new(mesh: &TriangleMesh, marked: &HalfedgeMap<bool>) -> Self {
        let is_first = |h| mesh.twin(h).is_none_or(|twin| h < twin);
        let marked = mesh.halfedge_ids().filter(|&h| marked[h] && is_first(h));
        let places = |h| [mesh.origin(h), mesh.target(h)].map(|v| mesh.position(v));
        Self(marked.map(places).collect())
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// They and more of them.
    #[must_use]
    pub fn and(mut self, more: Option<Self>) -> Self {
        self.0.extend(more.into_iter().flat_map(|more| more.0));
        self
    }

    /// They, each from end to end.
    pub fn segments(&self) -> impl Iterator<Item = [DVec3; 2]> {
        self.0.iter().copied()
    }

    /// They, ready to be asked for the closest point.
    pub fn tree(&self, progress: &Progress<'_>) -> Result<Bvh, Cancelled> {
        let segments: Vec<_> = self.0.iter().map(|&[a, b]| [a, b, b]).collect();
        Bvh::build(&segments, progress)
    }

    /// Those of some edges of a mesh that lie along them.
    pub fn met(
        &self,
        (mesh, edges): (&PolygonMesh, &[[VertexId; 2]]),
        progress: &Progress<'_>,
    ) -> Result<Vec<[VertexId; 2]>, Cancelled> {
        let met = transfer::edges(&self.0, mesh, edges, progress)?.into_iter();
        Ok(met.map(|edge| edge.ends).collect())
    }

    /// The mesh with the ends of those edges set onto them, where that folds no triangle.
    fn drawn(
        &self,
        mesh: &TriangleMesh,
        met: &[[VertexId; 2]],
        progress: &Progress<'_>,
    ) -> Result<TriangleMesh, Cancelled> {
        let tree = self.tree(progress)?;
        let mut positions = mesh.positions().to_vec();
        for &vertex in met.iter().flatten() {
            let at = |v: VertexId| positions[v.index()];
            let place = tree.closest(at(vertex)).position;
            let keeps = |h: HalfedgeId| {
                let [a, b] = [mesh.target(h), mesh.origin(h.prev())].map(at);
                let normal = |p: DVec3| (a - p).cross(b - p);
                let [now, then] = [at(vertex), place].map(normal);
                now.dot(then) > LEAST_COSINE * now.length() * then.length()
            };
            if mesh.outgoing(vertex).all(keeps) {
                positions[vertex.index()] = place;
            }
        }
        Ok(mesh.with_positions(positions))
    }

    /// The share of their length that some edges of a mesh leave out; 0 where nothing is marked.
    pub fn lost(
        &self,
        (mesh, edges): (&PolygonMesh, &[[VertexId; 2]]),
        progress: &Progress<'_>,
    ) -> Result<f64, Cancelled> {
        let length = |places: Vec<[DVec3; 2]>| places.iter().map(|[a, b]| a.distance(*b)).sum();
        let met = self.met((mesh, edges), progress)?.into_iter();
        let met: f64 = length(met.map(|ends| ends.map(|v| mesh.position(v))).collect());
        let all: f64 = length(self.0.clone());
        Ok(if all > 0.0 {
            (1.0 - met / all).max(0.0)
        } else {
            0.0
        })
    }
}

/// An even triangle mesh of a target.
pub struct Even {
    /// It, with its own map to the sphere.
    pub map: SphereMap,
    /// Its edges that lie along the target's sharp or marked ones, on both sides of each.
    pub lines: HalfedgeMap<bool>,
    /// Those of them that lie along marked ones.
    pub marked: HalfedgeMap<bool>,
    /// Those of them that lie along borders, where there are any.
    pub border: Option<HalfedgeMap<bool>>,
    pub sphere: sphere::Report,
}

/// So many more triangles per area are made inside caps, which are small and hold singularities.
const IN_CAPS: f64 = 4.0;

/// What an even surface is for.
pub struct For<'a> {
    pub n_quads: usize,
    /// The sizes of the quads.
    pub sizes: &'a flow::sizes::Settings,
    pub seed: u64,
    /// Lines of the map's mesh that have edges of it all along.
    pub lines: &'a [FeatureLine],
    /// Whether they are all edges of a solid.
    pub is_solid: bool,
    /// What is real of a part that was closed.
    pub opening: Option<&'a Opening>,
    /// Where strokes want them smaller.
    pub finer: &'a Finer,
}

/// A solid has few edges: of more lines, as of the facets of a model, no grid keeps to all.
const MOST_LINES: usize = 100;
/// The share of a solid's edges that may end loosely.
const MOST_LOOSE: f64 = 0.02;

/// The sharp edges of a mesh and its borders as lines, if they are those of a solid.
pub fn solid(
    mesh: &TriangleMesh,
    sharp_angle: Option<f64>,
    border: Option<&HalfedgeMap<bool>>,
) -> Option<Vec<FeatureLine>> {
    let sharp = sharp_edges(mesh, sharp_angle?);
    let sharp = match border {
        Some(border) => sharp.iter().zip(border).map(|(a, b)| a | b).collect(),
        None => sharp,
    };
    if loose_share(mesh, &sharp) > MOST_LOOSE {
        return None;
    }
    let lines = feature_lines(mesh, &sharp);
    (1..=MOST_LINES).contains(&lines.len()).then_some(lines)
}

/// Makes an even triangle mesh for quads.
pub fn even(
    map: &SphereMap,
    (target, marked): (&Target, &Marked),
    quads: &For<'_>,
    progress: &Progress<'_>,
) -> Result<Even, pipeline::Error> {
    let (n_quads, seed) = (quads.n_quads, quads.seed);
    let n_faces = LEAST_TRIANGLES
        .min(MOST_TRIANGLES_PER_QUAD * n_quads)
        .max((TRIANGLES_PER_QUAD * n_quads as f64) as usize);
    let settings = sphere::Settings {
        n_faces,
        seed,
        ..sphere::Settings::default()
    };
    let mut density = density(map.mesh(), quads, &progress.part("", 0.0, 0.1))?;
    if let Some(opening) = quads.opening {
        for (wanted, &is_in_cap) in density.as_mut_slice().iter_mut().zip(&opening.is_in_cap) {
            *wanted *= if is_in_cap { IN_CAPS } else { 1.0 };
        }
    }
    if !quads.finer.is_empty() {
        for (v, wanted) in map.mesh().vertex_ids().zip(density.as_mut_slice()) {
            let factor = quads.finer.at(map.mesh().position(v));
            *wanted *= factor * factor;
        }
    }
    let is_finer = density.iter().any(|&wanted| wanted > 1.0);
    let part = progress.part("", 0.1, 0.7);
    let made = sphere::sized(map, (&density, quads.lines), &settings, &part)?;
    let part = progress.part("", 0.7, 1.0);
    let held = match quads.opening {
        Some(opening) => opening.held(map, &made, &part)?,
        None => Held::default(),
    };
    let Adaptive {
        primitive, report, ..
    } = made;
    let settings = deform::Settings {
        sizes: if is_finer { Sizes::Own } else { Sizes::Equal },
        // Quads are made on it, and tips that are moved would be lost to them.
        separates: false,
        lines: if quads.is_solid {
            Lines::Kept
        } else {
            Lines::Sought
        },
        ..deform::Settings::default()
    };
    let primitive = (&primitive, &held);
    let deformed = deform::deform_held(map, primitive, target, &settings, &part)?;
    // A vertex that did not quite arrive must not cut a mark in two.
    let met = marked.met((&deformed.mesh, &deformed.led), progress)?;
    let mesh = marked.drawn(&triangles(&deformed.mesh), &met, progress)?;
    let marked = met;
    let mut lines = [&deformed.features[..], &marked].concat();
    lines.sort_unstable();
    let [lines, marked] = [lines, marked].map(|edges| either_side(&mesh, &edges));
    let border = quads.opening.map(|_| either_side(&mesh, &held.edges));
    let sphere = VertexMap::from_vec(deformed.sphere);
    Ok(Even {
        map: SphereMap::prove(mesh, sphere).map_err(embed::Error::from)?,
        lines,
        marked,
        border,
        sphere: report,
    })
}

/// How many triangles per area are wanted at every vertex, in proportion: as many to a quad on
/// limbs as elsewhere, once sizes follow the shape.
fn density(
    mesh: &TriangleMesh,
    quads: &For<'_>,
    progress: &Progress<'_>,
) -> Result<VertexMap<f64>, Cancelled> {
    let adaptivity = quads.sizes.adaptivity.min(1.0);
    let shares = flow::sizes::limb_shares(mesh, quads.n_quads, quads.sizes, progress)?;
    let wanted = |&share: &f64| powf(share, -2.0 * adaptivity);
    Ok(shares.iter().map(wanted).collect())
}

/// Edges as halfedges on both sides of each.
pub(super) fn either_side(mesh: &TriangleMesh, edges: &[[VertexId; 2]]) -> HalfedgeMap<bool> {
    let is_marked = |h| {
        let [a, b] = [mesh.origin(h), mesh.target(h)];
        edges.binary_search(&[a.min(b), a.max(b)]).is_ok()
    };
    mesh.halfedge_ids().map(is_marked).collect()
}

pub(super) fn triangles(mesh: &PolygonMesh) -> TriangleMesh {
    let corners = |face: &[VertexId]| [face[0], face[1], face[2]];
    TriangleMesh::new(
        mesh.positions().to_vec(),
        mesh.faces().map(corners).collect(),
    )
    .expect("a cover of the sphere by triangles is a closed surface")
}
