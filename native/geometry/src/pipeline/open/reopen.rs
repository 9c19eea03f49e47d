//! Keeps the quads that lie on what is real.

use std::collections::HashSet;

use glam::DVec3;

use super::weld::loops;
use super::{Opening, Regions, SAME};
use crate::deform::{Deformed, Target, settle};
use crate::groups::Groups;
use crate::measure::{PolygonEdges, Polyline, area_vector, topology};
use crate::mesh::{FaceMap, HalfedgeId, HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// Quality up to which quads round rings are mended.
const ENOUGH: f64 = 0.5;

/// Of so many vertices of a loop it is asked how far they are from a border.
const N_ASKED: usize = 12;

/// What quads lie along.
#[derive(Clone, Copy)]
pub struct Lines<'a> {
    /// Their edges along borders.
    pub met: &'a [[VertexId; 2]],
    /// Edges of the surface that quads were made on, on borders along which none lie.
    pub unmet: &'a [HalfedgeId],
    /// That surface and its pieces, where borders are to get rings.
    pub surface: Option<(&'a SphereMap, &'a Regions)>,
}

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
        (lines, target): (Lines<'_>, &Target),
        progress: &Progress<'_>,
    ) -> Result<Result<Deformed, String>, Cancelled> {
        let mesh = &deformed.mesh;
        let (patches, n_patches) = patches(mesh, lines.met, progress)?;
        if let Some(surface) = lines.surface {
            let ringed = match self.ringed(deformed, surface, (&patches, lines.unmet)) {
                Ok(ringed) => ringed,
                Err(reason) => return Ok(Err(reason)),
            };
            let moved = deformed.clone().moved(ringed.positions);
            let opened = self.kept(&moved, &ringed.is_kept, progress)?;
            return Ok(match opened {
                Ok(opened) => Ok(self.settled(opened, progress)?),
                refused => refused,
            });
        }
        let mut votes = vec![0.0; n_patches];
        for (face, &patch) in mesh.face_ids().zip(&patches) {
            let corners: Vec<DVec3> = mesh.face(face).iter().map(|&v| mesh.position(v)).collect();
            votes[patch as usize] += self.vote(&corners, target);
        }
        let is_kept: Vec<bool> = patches.iter().map(|&p| votes[p as usize] > 0.0).collect();
        self.kept(deformed, &is_kept, progress)
    }

    /// Quads round rings at better places of the part.
    fn settled(&self, opened: Deformed, progress: &Progress<'_>) -> Result<Deformed, Cancelled> {
        let mesh = &opened.mesh;
        let mut is_fixed = PolygonEdges::new(mesh, progress)?.border_vertices(mesh.n_vertices());
        for (is_fixed, &p) in is_fixed.iter_mut().zip(mesh.positions()) {
            *is_fixed |= self.cuts.iter().any(|cut| cut.distance(p) < SAME);
        }
        for v in opened.features.iter().flatten() {
            is_fixed[v.index()] = true;
        }
        let settled = settle(mesh, (&is_fixed, ENOUGH), &self.bare, progress)?;
        let positions = settled.positions().to_vec();
        Ok(opened.moved(positions))
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
        let nearest = |real: bool, limit: f64| {
            let is_wanted = |face| self.is_real[face] == real && target.looks_along(face, area);
            let found = target.bvh().closest_where(middle, limit, is_wanted);
            found.map_or(f64::INFINITY, |found| found.distance_squared)
        };
        // What is virtual is looked for no farther: the way to the next cap is long.
        let real = nearest(true, f64::INFINITY);
        if real <= nearest(false, real) {
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
        let loops = loops(mesh, progress)?;
        let owners = self.owners(mesh, &loops);
        let all = self.edges.tree(progress)?;
        let mut moved = mesh.positions().to_vec();
        for (border, owner) in loops.iter().zip(owners) {
            let own = owner.map(|line| {
                let pieces: Vec<_> = line.pieces().map(|[a, b]| [a, b, b]).collect();
                Bvh::new(&pieces)
            });
            for &v in border {
                let place = own.as_ref().unwrap_or(&all).closest(mesh.position(v));
                moved[v.index()] = place.position;
            }
        }
        Ok(opened.moved(moved))
    }

    /// The border of the part that each loop of vertices belongs on: two at each cut, one at others,
    /// those first that lie nearest; none for what is left over.
    fn owners(&self, mesh: &PolygonMesh, loops: &[Vec<VertexId>]) -> Vec<Option<&Polyline>> {
        let cuts = self.cuts.iter().map(|line| (line, 2));
        let lines: Vec<(&Polyline, usize)> = cuts
            .chain(self.borders.iter().map(|line| (line, 1)))
            .collect();
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (i, border) in loops.iter().enumerate() {
            let some = border.iter().step_by(border.len().div_ceil(N_ASKED));
            let some: Vec<DVec3> = some.map(|&v| mesh.position(v)).collect();
            for (k, (line, _)) in lines.iter().enumerate() {
                let off: f64 = some.iter().map(|&p| line.distance(p)).sum();
                pairs.push((off / some.len() as f64, i, k));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut n_free: Vec<usize> = lines.iter().map(|(_, n)| *n).collect();
        let mut owners = vec![None; loops.len()];
        for (_, i, k) in pairs {
            if owners[i].is_none() && n_free[k] > 0 {
                n_free[k] -= 1;
                owners[i] = Some(lines[k].0);
            }
        }
        owners
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
pub(super) fn real_faces(mesh: &TriangleMesh, border: &HalfedgeMap<bool>) -> FaceMap<bool> {
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
