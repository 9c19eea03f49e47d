//! Gives the border of a mesh the vertices of a line that stays, so that both can be joined there.
//!
//! A mesh was made of what lies beside faces that stay as they are. Its border lies on theirs, with
//! vertices of its own. Then, loop by loop,
//!
//! 1. its vertices are told off against those of the line, in order along both (`align`); most edges
//!    have one of the other side each;
//! 2. where there are fewer, an edge is cut in three with four quads for the one beside it; where
//!    there are more, three of them get a quad in front of them (`sheet`);
//! 3. a last odd edge is met by strips of quads from loop to loop (`parity`), else by a triangle;
//! 4. vertices go to the places of those that they stand for, and those of one place become one.
//!
//! The line is not changed by a bit: what stays has no say in any of this.

mod align;
mod parity;
mod sheet;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet, HashSet};

use glam::DVec3;

use crate::groups::Groups;
use crate::mesh::{Id, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use align::{Block, Chain};
use sheet::Sheet;

/// How far vertices without a place on the line any more go inside, as a share of the way to their
/// neighbours there.
const INWARD: f64 = 0.35;

/// A loop of the border of what was remeshed, its faces on the left.
#[derive(Clone, PartialEq, Debug)]
pub struct Border {
    /// Its points; the last is joined to the first.
    pub points: Vec<DVec3>,
    /// Whether something stays beyond the edge from each point to the next.
    pub is_held: Vec<bool>,
    /// How wide what was remeshed is at each point, in radians.
    pub angles: Vec<f64>,
    /// Which vertex of what stays is there, if one is; one that comes twice is one vertex in the end.
    pub names: Vec<Option<usize>>,
}

/// A part of a mesh and its borders as they were.
#[derive(Clone, PartialEq, Debug)]
pub struct Part {
    /// How many faces of the mesh it has: parts lie one after the other.
    pub n_faces: usize,
    /// Its borders that are open still.
    pub borders: Vec<Border>,
}

/// How lines were met.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counts {
    /// Edges of the lines.
    pub n_edges: usize,
    /// Those that one edge of the new mesh was there for.
    pub n_met: usize,
    /// Triangles beside them.
    pub n_triangles: usize,
}

/// A mesh that was joined to what stays.
#[derive(Clone, PartialEq, Debug)]
pub struct Grafted {
    /// The mesh, part by part.
    pub mesh: PolygonMesh,
    /// How many faces each part has.
    pub n_faces: Vec<usize>,
    /// How the lines of each part were met, or why they were not.
    pub told: Vec<Result<Counts, String>>,
    /// The vertex at each name of what stays.
    pub at: BTreeMap<usize, VertexId>,
    /// What each vertex that came is called now.
    pub name: VertexMap<VertexId>,
    /// The vertices that came in whose middle each vertex lies.
    pub from: VertexMap<[VertexId; 2]>,
    /// Vertices that have to find their place: new ones, and those that lay on a line.
    pub loose: Vec<VertexId>,
}

/// What is being grafted.
struct Grafting {
    positions: Vec<DVec3>,
    from: Vec<[VertexId; 2]>,
    loose: Vec<VertexId>,
    /// Vertices by the names of what they stand for.
    held: Vec<(usize, VertexId)>,
}

/// Gives a mesh the vertices of what stays along its borders.
///
/// A part whose borders cannot be met stays as it is, and is told of. Costs the edges of each loop
/// times the points of the border that it lies on.
///
/// # Errors
/// When cancelled.
pub fn graft(
    mesh: &PolygonMesh,
    parts: &[Part],
    progress: &Progress<'_>,
) -> Result<Grafted, Cancelled> {
    let mut grafting = Grafting {
        positions: mesh.positions().to_vec(),
        from: (0..mesh.n_vertices())
            .map(|i| [VertexId::from_index(i); 2])
            .collect(),
        loose: Vec::new(),
        held: Vec::new(),
    };
    let (mut sheets, mut told) = (Vec::new(), Vec::new());
    let mut faces = mesh.faces();
    for part in parts {
        let own: Vec<Vec<VertexId>> = faces
            .by_ref()
            .take(part.n_faces)
            .map(<[_]>::to_vec)
            .collect();
        let is_touched = part.borders.iter().any(Border::is_of_use);
        let mut sheet = Sheet::new(own.clone());
        let found = if is_touched {
            grafting.part(&mut sheet, part, progress)?
        } else {
            Ok(Counts::default())
        };
        sheets.push(if found.is_ok() { sheet.faces } else { own });
        told.push(found);
    }
    Ok(grafting.joined(mesh.n_vertices(), &sheets, told))
}

impl Border {
    /// Whether anything stays along it.
    fn is_of_use(&self) -> bool {
        self.names.iter().any(Option::is_some)
    }

    fn length(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        self.points
            .iter()
            .zip(next)
            .map(|(a, b)| a.distance(*b))
            .sum()
    }
}

impl Grafting {
    fn part(
        &mut self,
        sheet: &mut Sheet,
        part: &Part,
        progress: &Progress<'_>,
    ) -> Result<Result<Counts, String>, Cancelled> {
        let loops = sheet.loops();
        let owners = self.owners(&loops, &part.borders);
        let pairs: Vec<(&Border, Vec<VertexId>)> = match owners {
            Ok(owners) => part.borders.iter().zip(owners).collect(),
            Err(reason) => return Ok(Err(reason)),
        };
        let pairs = parity::evened(self, sheet, pairs);
        let mut counts = Counts::default();
        for (border, made) in &pairs {
            progress.check()?;
            if border.is_of_use() {
                match self.border(sheet, border, made, progress)? {
                    Ok(found) => counts.add(found),
                    Err(reason) => return Ok(Err(reason)),
                }
            }
        }
        Ok(Ok(counts))
    }

    /// The loop on each of some borders: those first that lie nearest.
    fn owners(
        &self,
        loops: &[Vec<VertexId>],
        borders: &[Border],
    ) -> Result<Vec<Vec<VertexId>>, String> {
        if loops.len() < borders.iter().filter(|border| border.is_of_use()).count() {
            let (found, wanted) = (loops.len(), borders.len());
            return Err(format!("it has {found} borders of {wanted}"));
        }
        let mut pairs = Vec::new();
        for (i, made) in loops.iter().enumerate() {
            for (k, border) in borders.iter().enumerate() {
                let places: Vec<DVec3> = made.iter().map(|v| self.positions[v.index()]).collect();
                pairs.push((align::distance(&places, border), i, k));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut is_taken = vec![false; loops.len()];
        let mut owners = vec![Vec::new(); borders.len()];
        for (_, i, k) in pairs {
            if !is_taken[i] && owners[k].is_empty() {
                is_taken[i] = true;
                owners[k].clone_from(&loops[i]);
            }
        }
        let lacks =
            |(border, made): (&Border, &Vec<VertexId>)| border.is_of_use() && made.is_empty();
        if borders.iter().zip(&owners).any(lacks) {
            return Err("a border of it is no longer there".to_owned());
        }
        Ok(owners)
    }

    /// Gives a loop the vertices of the border that it lies on.
    fn border(
        &mut self,
        sheet: &mut Sheet,
        border: &Border,
        made: &[VertexId],
        progress: &Progress<'_>,
    ) -> Result<Result<Counts, String>, Cancelled> {
        let chain = Chain {
            places: made.iter().map(|v| self.positions[v.index()]).collect(),
            valences: made.iter().map(|&v| sheet.n_at(v)).collect(),
            are_quads: sheet.has_quads(),
            is_joined: &|a, b| sheet.is_edge([made[a], made[b]]),
        };
        let Some(aligned) = chain.aligned(border, progress)? else {
            let (n, of) = (made.len(), border.points.len());
            return Ok(Err(format!("its border of {n} edges cannot take {of}")));
        };
        let mut counts = Counts::default();
        for (i, j) in aligned.pins {
            self.hold(made[i], border, j);
        }
        for Block { made: of, line } in aligned.blocks {
            let own: Vec<VertexId> = of.iter().map(|&i| made[i]).collect();
            counts.n_edges += line.len() - 1;
            counts.n_met += usize::from(own.len() == line.len());
            let along = match (own.len() - 1, line.len() - 1) {
                (1, n) => self.cut(sheet, [own[0], own[1]], n, &mut counts),
                (_, _) => self.bridged(sheet, &own, &mut counts),
            };
            for (&v, &j) in along.iter().zip(&line) {
                self.hold(v, border, j);
            }
        }
        Ok(Ok(counts))
    }

    /// Has a vertex stand for a point of a border.
    fn hold(&mut self, v: VertexId, border: &Border, at: usize) {
        self.positions[v.index()] = border.points[at];
        if let Some(name) = border.names[at] {
            self.held.push((name, v));
        }
    }

    fn add(&mut self, place: DVec3, from: [VertexId; 2]) -> VertexId {
        let v = VertexId::from_index(self.positions.len());
        let [a, b] = from.map(|v| self.from[v.index()][0]);
        self.positions.push(place);
        self.from.push([a, b]);
        self.loose.push(v);
        v
    }

    fn joined(
        self,
        n_came: usize,
        sheets: &[Vec<Vec<VertexId>>],
        mut told: Vec<Result<Counts, String>>,
    ) -> Grafted {
        let mut groups = Groups::new(self.positions.len());
        let mut at: BTreeMap<usize, VertexId> = BTreeMap::new();
        for &(name, v) in &self.held {
            let first = *at.entry(name).or_insert(v);
            groups.link(first.index(), v.index());
        }
        for (faces, told) in sheets.iter().zip(&mut told) {
            if told.is_ok()
                && let Some(reason) = spoiled(faces, &mut groups)
            {
                *told = Err(reason);
            }
        }
        let corners = sheets.iter().flatten().flatten();
        let used: BTreeSet<usize> = corners.map(|v| groups.root(v.index())).collect();
        let mut renamed = vec![0; self.positions.len()];
        for (i, &root) in used.iter().enumerate() {
            renamed[root] = i;
        }
        let mut name = |v: VertexId| VertexId::from_index(renamed[groups.root(v.index())]);
        let n_faces = sheets.iter().map(Vec::len).collect();
        let (mut starts, mut corners) = (vec![0], Vec::new());
        for face in sheets.iter().flatten() {
            corners.extend(face.iter().map(|&v| name(v)));
            starts.push(corners.len() as u32);
        }
        let positions = used.iter().map(|&root| self.positions[root]).collect();
        let mut loose: Vec<VertexId> = self.loose.iter().map(|&v| name(v)).collect();
        loose.sort_unstable();
        loose.dedup();
        Grafted {
            mesh: PolygonMesh::new(positions, starts, corners).expect("faces of used vertices"),
            n_faces,
            told,
            at: at.into_iter().map(|(of, v)| (of, name(v))).collect(),
            name: (0..n_came).map(|i| name(VertexId::from_index(i))).collect(),
            from: used.iter().map(|&root| self.from[root]).collect(),
            loose,
        }
    }
}

/// What is wrong with faces some of whose vertices become one.
fn spoiled(faces: &[Vec<VertexId>], groups: &mut Groups) -> Option<String> {
    let mut sides = HashSet::new();
    let (mut n_lost, mut n_crowded) = (0, 0);
    for face in faces {
        let roots: Vec<usize> = face.iter().map(|v| groups.root(v.index())).collect();
        let mut sorted = roots.clone();
        sorted.sort_unstable();
        n_lost += usize::from(sorted.windows(2).any(|pair| pair[0] == pair[1]));
        for (i, &root) in roots.iter().enumerate() {
            let is_new = sides.insert([root, roots[(i + 1) % roots.len()]]);
            n_crowded += usize::from(!is_new);
        }
    }
    match (n_lost, n_crowded) {
        (0, 0) => None,
        (0, n) => Some(format!(
            "{n} edges would have too many faces beside what is kept"
        )),
        (n, _) => Some(format!("{n} faces would lose a corner beside what is kept")),
    }
}

impl Counts {
    /// More of them.
    pub fn add(&mut self, other: Self) {
        self.n_edges += other.n_edges;
        self.n_met += other.n_met;
        self.n_triangles += other.n_triangles;
    }
}
