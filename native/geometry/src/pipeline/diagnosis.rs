//! What keeps each part of a mesh from being remeshed: all of it, with numbers.

use std::collections::HashSet;

use super::borders::SphereAlone;
use super::kept::{Flaw, Reason, count};
use super::split::Part;
use super::{Settings, handles};
use crate::clean::{self, Apart, SharedLine, Tangle};
use crate::groups::Groups;
use crate::mesh::{FaceId, HalfedgeId, Id, PolygonMesh, TriangleMesh, VertexId};

/// All parts in the order of their first faces.
///
/// Where `alone` says why, a part with borders or handles has that reason not to be done.
pub fn parts(
    (mesh, settings, alone): (&PolygonMesh, &Settings, SphereAlone),
    apart: &Apart,
    (component, n): (&[u32], usize),
) -> Vec<Part> {
    let told = Told {
        mesh,
        alone,
        reach: settings
            .weld
            .filter(|_| apart.is_open())
            .map(|share| clean::distance(mesh, share)),
        shared: apart.shared.iter().flat_map(SharedLine::edges).collect(),
    };
    let mut surfaces = surfaces(apart, component, n);
    if told.alone.handles.is_some() && surfaces.iter().any(|surface| surface.genus() != 0) {
        let loops = handles::loops(&apart.mesh);
        for (surface, edges) in surfaces.iter_mut().zip(loops) {
            surface.handle = edges.iter().map(|e| e.map(|v| apart.origin[v])).collect();
        }
    }
    let surfaces = surfaces.into_iter().enumerate();
    let surfaces = surfaces.map(|(i, surface)| Part {
        surface: Some(i),
        reasons: told.of_surface(&surface),
        faces: surface.faces,
    });
    let tangles = apart.tangles.iter().map(|tangle| Part {
        surface: None,
        reasons: told.of_tangle(tangle),
        faces: tangle.faces.clone(),
    });
    let mut parts: Vec<Part> = surfaces.chain(tangles).collect();
    parts.sort_by_key(|part| part.faces[0]);
    parts
}

/// What is counted of a component.
#[derive(Clone, Default)]
struct Surface {
    faces: Vec<FaceId>,
    n_vertices: usize,
    n_triangles: usize,
    n_loops: usize,
    n_border: usize,
    border: Vec<[VertexId; 2]>,
    /// A loop of a handle, if there is one.
    handle: Vec<[VertexId; 2]>,
    has_area: bool,
}

fn surfaces(apart: &Apart, component: &[u32], n: usize) -> Vec<Surface> {
    let mesh = &apart.mesh;
    let of = |h: HalfedgeId| component[h.face().index()] as usize;
    let mut surfaces = vec![Surface::default(); n];
    for face in mesh.face_ids() {
        let surface = &mut surfaces[of(mesh.halfedge(face))];
        surface.n_triangles += 1;
        surface.has_area = surface.has_area || has_area(mesh, face);
        let source = apart.source[face];
        if surface.faces.last() != Some(&source) {
            surface.faces.push(source);
        }
    }
    for v in mesh.vertex_ids() {
        if let Some(h) = mesh.outgoing(v).next() {
            surfaces[of(h)].n_vertices += 1;
        }
    }
    for border in mesh.border_loops() {
        let surface = &mut surfaces[of(border[0])];
        surface.n_loops += 1;
        let ends = |&h: &HalfedgeId| [mesh.origin(h), mesh.target(h)].map(|v| apart.origin[v]);
        surface.n_border += border.len();
        // Of an edge that was cut in the middle one half has both ends of the input's.
        let is_edge = |[a, b]: &[VertexId; 2]| a != b;
        surface
            .border
            .extend(border.iter().map(ends).filter(is_edge));
    }
    surfaces
}

/// Whether a triangle is no line, as far as this matters here: a part needs but one that is none.
fn has_area(mesh: &TriangleMesh, face: FaceId) -> bool {
    let [a, b, c] = mesh.triangle(face);
    // Halves do not overflow, and directions do not vanish when they are multiplied.
    let side = |to: glam::DVec3| (to / 2.0 - a / 2.0).try_normalize();
    let sides = side(b).zip(side(c));
    sides.is_some_and(|(b, c)| b.cross(c).length() > 1e-12)
}

impl Surface {
    /// Half of what the Euler number lacks to that of a sphere with as many holes.
    fn genus(&self) -> i64 {
        let n_edges = usize::midpoint(3 * self.n_triangles, self.n_border);
        let euler = self.n_vertices as i64 - n_edges as i64 + self.n_triangles as i64;
        (2 - self.n_loops as i64 - euler) / 2
    }
}

/// Puts what was found in words.
struct Told<'a> {
    mesh: &'a PolygonMesh,
    /// Why a part with borders or handles cannot be done, if so.
    alone: SphereAlone,
    /// Up to which gap borders were welded, where they were.
    reach: Option<f64>,
    /// The edges of more than two faces.
    shared: HashSet<[VertexId; 2]>,
}

impl Told<'_> {
    fn of_surface(&self, surface: &Surface) -> Vec<Reason> {
        let faces = &surface.faces;
        let border = self.border(faces, surface.n_loops, &surface.border);
        let flat = self.flat(surface);
        let genus = surface.genus();
        let handles = self.alone.handles.as_ref().filter(|_| genus != 0);
        let handles = handles.map(|why| {
            let text = format!("genus {genus}: {why}");
            Reason::new(
                self.mesh,
                faces,
                &surface.handle,
                Flaw::Handles { genus },
                text,
            )
        });
        [border, handles, flat].into_iter().flatten().collect()
    }

    fn of_tangle(&self, tangle: &Tangle) -> Vec<Reason> {
        let border = self.border(&tangle.faces, n_loops(&tangle.border), &tangle.border);
        let [a, b] = tangle.one_sided;
        let text = format!(
            "the surface cannot be oriented (it has one side, like a moebius strip): faces \
             disagree along the edge between vertices {a} and {b} whichever way they are turned"
        );
        let one_sided = Reason::new(self.mesh, &tangle.faces, &[[a, b]], Flaw::OneSided, text);
        std::iter::once(one_sided).chain(border).collect()
    }

    fn border(&self, faces: &[FaceId], n_loops: usize, edges: &[[VertexId; 2]]) -> Option<Reason> {
        let n_edges = edges.len();
        let why = self.alone.borders.as_ref().filter(|_| n_edges > 0)?;
        let is_shared = |[a, b]: &&[VertexId; 2]| self.shared.contains(&[*a.min(b), *a.max(b)]);
        let shared = match edges.iter().filter(is_shared).count() {
            0 => String::new(),
            n => format!(" ({n} of them where 3 or more faces meet)"),
        };
        let [loops, borders] = [count(n_loops, "border loop"), count(n_edges, "border edge")];
        let weld = match self.reach {
            Some(reach) => format!("; borders farther apart than {reach:.2e} are not welded"),
            None => "; only equal points are welded".to_owned(),
        };
        let text = format!("{loops}, {borders}{shared}: {why}{weld}");
        let flaw = Flaw::Border { n_loops, n_edges };
        Some(Reason::new(self.mesh, faces, edges, flaw, text))
    }

    fn flat(&self, surface: &Surface) -> Option<Reason> {
        let n_points = surface.n_vertices;
        let text = if n_points < 4 {
            format!("the faces use {n_points} different points; at least 4 are needed")
        } else if surface.has_area {
            return None;
        } else {
            let n_faces = surface.faces.len();
            format!("the part has no area: each of its {n_faces} faces is a point or a line")
        };
        let flaw = Flaw::Flat { n_points };
        Some(Reason::new(self.mesh, &surface.faces, &[], flaw, text))
    }
}

/// Groups of edges that hang together.
fn n_loops(edges: &[[VertexId; 2]]) -> usize {
    let mut names: Vec<VertexId> = edges.iter().flatten().copied().collect();
    names.sort_unstable();
    names.dedup();
    let mut groups = Groups::new(names.len());
    for ends in edges {
        let [a, b] = ends.map(|v| names.partition_point(|&name| name < v));
        groups.link(a, b);
    }
    groups.numbered().1
}
