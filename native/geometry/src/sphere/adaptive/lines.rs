//! Lines in a net: as fine as they have to be not to cross each other.

use std::collections::{BTreeSet, HashSet};

use super::Net;
use super::creases::{Creases, Inserted, Step, Stops};
use crate::groups::Groups;
use crate::measure::FeatureLine;
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// More often no step is cut in two: each time steps that cross others are halved.
const MOST_ROUNDS: usize = 16;

/// A net with all that was put on lines.
pub struct Lined<'a> {
    pub net: Net<'a>,
    pub creases: Creases,
    pub inserted: Inserted,
}

impl<'a> Lined<'a> {
    /// A net with lines of a map's mesh, as fine as `n_faces` triangles are, or finer where that would
    /// let lines cross or lie on the wrong side of each other. At worst, edges of the mesh are edges
    /// of the net, which do neither.
    pub fn new(
        map: &'a SphereMap,
        (density, lines): (&VertexMap<f64>, &[FeatureLine]),
        n_faces: usize,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let mut stops = Stops::new(map, (density, lines), n_faces);
        let wanted = sides_on_mesh(map.mesh(), lines);
        let mut round = 0;
        loop {
            progress.check()?;
            let creases = Creases::new(map, &stops);
            let mut net = Net::tetrahedron(map);
            let mut inserted = creases.insert(&mut net);
            let mut rough = std::mem::take(&mut inserted.rough);
            if rough.is_empty() {
                for line in misplaced(&wanted, &sides_in_net(&net, &inserted, lines.len())) {
                    rough.extend(stops.steps(line));
                }
            }
            round += 1;
            if rough.is_empty() || round > MOST_ROUNDS || !stops.refine(map.mesh(), &rough) {
                return Ok(Self {
                    net,
                    creases,
                    inserted,
                });
            }
        }
    }
}

/// For both sides of every line, the left one first, the first side that is in the same patch.
type Sides = Vec<usize>;

/// The lines with a side that is in one patch with other sides than it should.
fn misplaced(wanted: &Sides, found: &Sides) -> BTreeSet<usize> {
    let sides = wanted.iter().zip(found).enumerate();
    let wrong = sides.filter(|(_, (wanted, found))| wanted != found);
    wrong
        .flat_map(|(side, (&wanted, &found))| [side / 2, wanted / 2, found / 2])
        .collect()
}

fn sides_on_mesh(mesh: &TriangleMesh, lines: &[FeatureLine]) -> Sides {
    let pairs = lines.iter().flat_map(|line| line.vertices.windows(2));
    let on: HashSet<[VertexId; 2]> = pairs.flat_map(|p| [[p[0], p[1]], [p[1], p[0]]]).collect();
    let mut groups = Groups::new(mesh.n_faces());
    for h in mesh.halfedge_ids().filter(|_| !lines.is_empty()) {
        if let Some(twin) = mesh.twin(h)
            && !on.contains(&[mesh.origin(h), mesh.target(h)])
        {
            groups.link(h.face().index(), twin.face().index());
        }
    }
    let of = |line: &FeatureLine| {
        let [a, b] = [line.vertices[0], line.vertices[1]];
        let h = mesh.outgoing(a).find(|&h| mesh.target(h) == b);
        let h = h.expect("a line follows edges");
        [Some(h), mesh.twin(h)]
    };
    let sides: Vec<[Option<HalfedgeId>; 2]> = lines.iter().map(of).collect();
    first_alike(&sides, groups)
}

fn sides_in_net(net: &Net, inserted: &Inserted, n_lines: usize) -> Sides {
    let t = &net.triangulation;
    let mut groups = Groups::new(t.n_faces());
    for h in t.halfedge_ids().filter(|_| n_lines > 0) {
        if !net.is_kept([t.origin(h), t.target(h)]) {
            groups.link(h.face().index(), t.twin(h).face().index());
        }
    }
    let mut sides = vec![[None; 2]; n_lines];
    for (ends, Step { line, .. }) in &inserted.along {
        let h = net.halfedge(*ends);
        sides[*line] = [h, h.map(|h| t.twin(h))];
    }
    first_alike(&sides, groups)
}

fn first_alike(sides: &[[Option<HalfedgeId>; 2]], groups: Groups) -> Sides {
    let (group, n_groups) = groups.numbered();
    let mut first = vec![None; n_groups];
    let sides = sides.iter().flatten().enumerate();
    let alike = sides.map(|(side, h)| {
        let Some(h) = h else { return side };
        *first[group[h.face().index()] as usize].get_or_insert(side)
    });
    alike.collect()
}
