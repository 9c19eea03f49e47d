//! Keeps the quads that lie on what is real.

use std::collections::HashSet;

use glam::DVec3;

use super::Opening;
use crate::deform::{Deformed, Target};
use crate::groups::Groups;
use crate::measure::{PolygonEdges, area_vector, topology};
use crate::mesh::{FaceMap, HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

impl Opening {
    /// The faces on what is real, those between some edges together; or why that is not the part.
    ///
    /// The borders of what is left are moved onto those of the part. The proof: it is one manifold
    /// piece with as many borders and handles as the part has.
    ///
    /// # Errors
    /// When cancelled.
    pub fn reopened(
        &self,
        deformed: &Deformed,
        (border, target): (&[[VertexId; 2]], &Target),
        progress: &Progress<'_>,
    ) -> Result<Result<Deformed, String>, Cancelled> {
        let mesh = &deformed.mesh;
        let (patches, n_patches) = patches(mesh, border, progress)?;
        let mut votes = vec![0.0; n_patches];
        for (face, &patch) in mesh.face_ids().zip(&patches) {
            let corners: Vec<DVec3> = mesh.face(face).iter().map(|&v| mesh.position(v)).collect();
            votes[patch as usize] += self.vote(&corners, target);
        }
        let is_kept: Vec<bool> = patches.iter().map(|&p| votes[p as usize] > 0.0).collect();
        self.kept(deformed, &is_kept, progress)
    }

    /// Some faces alone, their borders moved onto those of the part; or why that is not the part.
    ///
    /// # Errors
    /// When cancelled.
    pub fn kept(
        &self,
        deformed: &Deformed,
        is_kept: &[bool],
        progress: &Progress<'_>,
    ) -> Result<Result<Deformed, String>, Cancelled> {
        let opened = deformed.only(is_kept, progress)?;
        let opened = self.onto_borders(opened, progress)?;
        let opened = match self.punctured(opened, progress)? {
            Ok(opened) => self.welded(opened, progress)?,
            refused => refused,
        };
        let opened = match opened {
            Ok(opened) => self.mended(opened, progress)?,
            refused => return Ok(refused),
        };
        let found = topology(&opened.mesh, progress)?;
        let wanted = self.wanted;
        let figures = [
            ("pieces", found.n_components, wanted.n_components),
            ("borders", found.n_borders, wanted.n_borders),
        ];
        for (what, found, wanted) in figures {
            if found != wanted {
                return Ok(Err(format!("{found} {what} are left of {wanted}")));
            }
        }
        Ok(match found.genus {
            None => Err("what is left is no manifold surface".to_owned()),
            Some(genus) if Some(genus) != wanted.genus => Err(format!("{genus} handles are left")),
            Some(_) => Ok(opened),
        })
    }

    /// Which faces lie on what is real, those between edges along borders together, by where they lie
    /// on the sphere of the map; of sheets that lie on each other nothing else tells.
    ///
    /// # Errors
    /// When cancelled.
    pub fn real(
        &self,
        map: &SphereMap,
        (mesh, sphere): (&PolygonMesh, &[DVec3]),
        border: &[[VertexId; 2]],
        progress: &Progress<'_>,
    ) -> Result<Vec<bool>, Cancelled> {
        let sides = sides(mesh, border, progress)?;
        let is_real = real_faces(map.mesh(), &self.small);
        let mut votes = 0_i64;
        for (face, &side) in mesh.face_ids().zip(&sides) {
            let middle: DVec3 = mesh.face(face).iter().map(|v| sphere[v.index()]).sum();
            let is_on_real = is_real[map.locate(middle).face];
            votes += if is_on_real == side { 1 } else { -1 };
        }
        Ok(sides.into_iter().map(|side| side == (votes > 0)).collect())
    }

    /// The area of a face, less than zero if it lies on what is virtual.
    pub(super) fn vote(&self, corners: &[DVec3], target: &Target) -> f64 {
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let halves =
            (2..corners.len()).map(|i| area_vector([corners[0], corners[i - 1], corners[i]]));
        let area = halves.sum::<DVec3>();
        let away = |real: bool| {
            let is_wanted = |face| self.is_real[face] == real && target.looks_along(face, area);
            let found = target.bvh().closest_where(middle, f64::INFINITY, is_wanted);
            found.map_or(f64::INFINITY, |found| found.distance_squared)
        };
        if away(true) <= away(false) {
            area.length()
        } else {
            -area.length()
        }
    }

    /// The same with the vertices of its borders on those of the part.
    fn onto_borders(
        &self,
        opened: Deformed,
        progress: &Progress<'_>,
    ) -> Result<Deformed, Cancelled> {
        if self.edges.is_empty() {
            return Ok(opened);
        }
        let mesh = &opened.mesh;
        let edges = PolygonEdges::new(mesh, progress)?;
        let is_border = edges.border_vertices(mesh.n_vertices());
        let tree = self.edges.tree(progress)?;
        let moved = mesh.positions().iter().zip(is_border);
        let moved = moved.map(|(&p, is_border)| {
            if is_border {
                tree.closest(p).position
            } else {
                p
            }
        });
        let moved = moved.collect();
        Ok(opened.moved(moved))
    }
}

/// What hangs together over edges that are not among some.
fn patches(
    mesh: &PolygonMesh,
    border: &[[VertexId; 2]],
    progress: &Progress<'_>,
) -> Result<(Vec<u32>, usize), Cancelled> {
    let mut groups = Groups::new(mesh.n_faces());
    for (face, around) in neighbours(mesh, border, progress)?.iter().enumerate() {
        for &(other, _) in around.iter().filter(|(_, is_beyond)| !is_beyond) {
            groups.link(face, other);
        }
    }
    Ok(groups.numbered())
}

/// On which side of some edges each face lies: the other one beyond every edge.
fn sides(
    mesh: &PolygonMesh,
    border: &[[VertexId; 2]],
    progress: &Progress<'_>,
) -> Result<Vec<bool>, Cancelled> {
    Ok(coloured(&neighbours(mesh, border, progress)?))
}

/// The neighbours of every face, and whether each lies beyond one of some edges.
fn neighbours(
    mesh: &PolygonMesh,
    border: &[[VertexId; 2]],
    progress: &Progress<'_>,
) -> Result<Vec<Vec<(usize, bool)>>, Cancelled> {
    let border: HashSet<[VertexId; 2]> =
        border.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    let edges = PolygonEdges::new(mesh, progress)?;
    let mut neighbours = vec![Vec::new(); mesh.n_faces()];
    for c in 0..edges.n_corners() {
        if let Some(twin) = edges.twin(c) {
            let ends = edges.ends[edges.of_corner[c] as usize];
            let [own, other] = [c, twin].map(|c| edges.face_of[c] as usize);
            neighbours[own].push((other, border.contains(&ends)));
        }
    }
    Ok(neighbours)
}

/// The faces of a closed part that are real: the first one, and so on across its borders.
fn real_faces(mesh: &TriangleMesh, border: &HalfedgeMap<bool>) -> FaceMap<bool> {
    let around = |face| {
        let first = mesh.halfedge(face);
        let all = [first, first.next(), first.prev()].into_iter();
        let beyond = all.filter_map(|h| Some((mesh.twin(h)?.face().index(), border[h])));
        beyond.collect()
    };
    let beyond: Vec<Vec<(usize, bool)>> = mesh.face_ids().map(around).collect();
    FaceMap::from_vec(coloured(&beyond))
}

/// True for the first of some things, and the same or not for their neighbours, as these say.
fn coloured(neighbours: &[Vec<(usize, bool)>]) -> Vec<bool> {
    let mut colour = vec![None; neighbours.len()];
    let mut open = vec![0];
    colour[0] = Some(true);
    while let Some(at) = open.pop() {
        for &(next, is_other) in &neighbours[at] {
            if colour[next].is_none() {
                colour[next] = colour[at].map(|own| own != is_other);
                open.push(next);
            }
        }
    }
    colour
        .into_iter()
        .map(|colour| colour == Some(true))
        .collect()
}
