//! The two sides of a thin sheet: the quads of one are laid on the other too.
//!
//! Quads that differ from side to side cross where the sheet is bent, for it is thinner than a bent
//! quad is deep. So one side's are kept, the other side gets the same, and a row of quads along the
//! rim joins them: the hem is straight, and the sheet as thick everywhere as it was.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use crate::deform::{Deformed, Target};
use crate::groups::Groups;
use crate::measure::face_normal;
use crate::mesh::{FaceMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::nearest::Bvh;

/// Faces of the other side look the other way: the cosine between the normals.
const AWAY: f64 = -0.3;

/// Quads of a sheet whose sides are alike.
pub struct Alike {
    pub mesh: PolygonMesh,
    /// The edges on the lines of the rim and on creases of the sides, each once, in order.
    pub on_lines: Vec<[VertexId; 2]>,
}

/// One side of a sheet in quads.
struct Side {
    quads: Vec<[u32; 4]>,
    /// The edges round it, with the side on their left.
    border: Vec<[u32; 2]>,
}

/// A sheet and the thick one that was made of it, over the same triangles.
pub struct Sheet<'a> {
    pub thin: &'a Target,
    pub thick: &'a Target,
    /// Which triangles lie on sides.
    pub is_side: &'a FaceMap<bool>,
}

impl Sheet<'_> {
    /// The quads of one side of a thick sheet on both sides of the thin one: of the side that leads
    /// nearer to a count. None where the quads are not two discs and one row between them.
    pub fn alike(&self, quads: &Deformed, n_wanted: usize) -> Option<Alike> {
        let (sides, n_rim) = sides(quads)?;
        let n = |side: &Side| 2 * side.quads.len() + n_rim;
        let side = sides
            .into_iter()
            .min_by_key(|side| n(side).abs_diff(n_wanted))?;
        let (vertices, number) = side.vertices();
        let n_vertices = vertices.len() as u32;
        let new = |v: u32| number[&v];
        let mut faces: Vec<[u32; 4]> = side.quads.iter().map(|q| q.map(new)).collect();
        let turned = |q: &[u32; 4]| [q[3], q[2], q[1], q[0]].map(|v| v + n_vertices);
        let copies: Vec<[u32; 4]> = faces.iter().map(turned).collect();
        faces.extend(copies);
        faces.extend(side.border.iter().map(|&[a, b]| {
            let [a, b] = [new(a), new(b)];
            [b, a, a + n_vertices, b + n_vertices]
        }));
        let positions = self.places(quads, (&side, &vertices))?;
        let mut on_lines: Vec<[VertexId; 2]> = quads
            .features
            .iter()
            .filter_map(|[a, b]| Some([*number.get(&a.0)?, *number.get(&b.0)?]))
            .flat_map(|[a, b]| [[a, b], [a + n_vertices, b + n_vertices]])
            .map(|[a, b]| [VertexId(a.min(b)), VertexId(a.max(b))])
            .collect();
        on_lines.sort_unstable();
        Some(Alike {
            mesh: PolygonMesh::from_faces(positions, &faces).ok()?,
            on_lines,
        })
    }

    /// Where the vertices of a side lie on the thin sheet, and then their copies.
    fn places(&self, quads: &Deformed, (side, vertices): (&Side, &[u32])) -> Option<Vec<DVec3>> {
        let thin = self.thin.mesh();
        let on_border: HashSet<u32> = side.border.iter().map(|edge| edge[0]).collect();
        let component = self.components();
        let inner = vertices.iter().find(|&&v| !on_border.contains(&v))?;
        let first = self
            .thick
            .bvh()
            .closest(quads.mesh.position(VertexId(*inner)));
        let own = component[first.face.index()]?;
        let rim = self.rim(&component, own)?;
        let mut places = Vec::with_capacity(2 * vertices.len());
        let mut others = Vec::with_capacity(vertices.len());
        for &v in vertices {
            let p = quads.mesh.position(VertexId(v));
            let at = self.thick.bvh().closest(p);
            let corners = thin.triangle(at.face);
            let place: DVec3 = corners.iter().zip(at.weights).map(|(&c, w)| c * w).sum();
            if on_border.contains(&v) {
                places.push(place);
                others.push(rim.closest(place).position);
            } else {
                // What straddles the surface of one side does so on the other.
                let off = p - at.position;
                let normal = face_normal(thin, at.face);
                let looks_away = |face| face_normal(thin, face).dot(normal) < AWAY;
                let other = self
                    .thin
                    .bvh()
                    .closest_where(place, f64::INFINITY, looks_away)?;
                places.push(place + off);
                others.push(other.position + off);
            }
        }
        places.extend(others);
        Some(places)
    }

    /// The side that each triangle is of, if there are two.
    fn components(&self) -> Vec<Option<u32>> {
        let mesh = self.thin.mesh();
        let mut groups = Groups::new(mesh.n_faces());
        for h in mesh.halfedge_ids() {
            if let Some(twin) = mesh.twin(h)
                && self.is_side[h.face()]
                && self.is_side[twin.face()]
            {
                groups.link(h.face().index(), twin.face().index());
            }
        }
        let (numbers, _) = groups.numbered();
        mesh.face_ids()
            .map(|f| self.is_side[f].then_some(numbers[f.index()]))
            .collect()
    }

    /// The border of the side that is not `own`; none where there are not two.
    fn rim(&self, component: &[Option<u32>], own: u32) -> Option<Bvh> {
        let mesh = self.thin.mesh();
        let mut others: Vec<u32> = component.iter().flatten().copied().collect();
        others.sort_unstable();
        others.dedup();
        let [a, b] = <[u32; 2]>::try_from(others).ok()?;
        let other = if a == own { b } else { a };
        let is_of = |f: usize| component[f] == Some(other);
        let edges = mesh.halfedge_ids().filter(|&h| {
            let beyond = mesh.twin(h).map(|twin| twin.face().index());
            is_of(h.face().index()) && beyond.is_some_and(|f| !is_of(f))
        });
        let segments: Vec<[DVec3; 3]> = edges
            .map(|h| [mesh.origin(h), mesh.target(h), mesh.target(h)])
            .map(|segment| segment.map(|v| mesh.position(v)))
            .collect();
        (!segments.is_empty()).then(|| Bvh::new(&segments))
    }
}

impl Side {
    /// Its vertices in order, and the number of each.
    fn vertices(&self) -> (Vec<u32>, HashMap<u32, u32>) {
        let mut all: Vec<u32> = self.quads.iter().flatten().copied().collect();
        all.sort_unstable();
        all.dedup();
        let numbered = all.iter().enumerate().map(|(i, &v)| (v, i as u32));
        let number = numbered.collect();
        (all, number)
    }

    /// Whether it is a disc.
    fn is_disc(&self) -> bool {
        let n_vertices = self.vertices().0.len();
        let n_edges = usize::midpoint(4 * self.quads.len(), self.border.len());
        n_vertices + self.quads.len() == n_edges + 1
    }
}

/// The two sides of quads of a sheet, and how many quads lie in the one row between them.
fn sides(quads: &Deformed) -> Option<([Side; 2], usize)> {
    let corners = |face: &[VertexId]| <[VertexId; 4]>::try_from(face).ok();
    let all: Vec<[u32; 4]> = quads
        .mesh
        .faces()
        .map(|face| Some(corners(face)?.map(|v| v.0)))
        .collect::<Option<_>>()?;
    let mut left = HashMap::with_capacity(4 * all.len());
    for (q, quad) in all.iter().enumerate() {
        for i in 0..4 {
            left.insert([quad[i], quad[(i + 1) % 4]], q);
        }
    }
    let lines: HashSet<[u32; 2]> = quads.features.iter().map(|e| e.map(|v| v.0)).collect();
    let is_line = |[a, b]: [u32; 2]| lines.contains(&[a.min(b), a.max(b)]);
    let mut groups = Groups::new(all.len());
    for (q, quad) in all.iter().enumerate() {
        for i in 0..4 {
            let [a, b] = [quad[i], quad[(i + 1) % 4]];
            if !is_line([a, b]) {
                groups.link(q, *left.get(&[b, a])?);
            }
        }
    }
    let (group_of, n_groups) = groups.numbered();
    let mut sizes = vec![0usize; n_groups];
    for &group in &group_of {
        sizes[group as usize] += 1;
    }
    let mut order: Vec<u32> = (0..n_groups as u32).collect();
    order.sort_by_key(|&g| std::cmp::Reverse(sizes[g as usize]));
    let [first, second] = [*order.first()?, *order.get(1)?];
    let side = |group: u32| {
        let own = || (0..all.len()).filter(|&q| group_of[q] == group);
        let edges = own().flat_map(|q| (0..4).map(move |i| (q, i)));
        let edges = edges.map(|(q, i)| [all[q][i], all[q][(i + 1) % 4]]);
        let is_border =
            |&[a, b]: &[u32; 2]| left.get(&[b, a]).is_none_or(|&q| group_of[q] != group);
        Side {
            border: edges.filter(is_border).collect(),
            quads: own().map(|q| all[q]).collect(),
        }
    };
    let sides = [side(first), side(second)];
    let n_rim = all.len() - sides[0].quads.len() - sides[1].quads.len();
    let crosses = |&[a, b]: &[u32; 2]| {
        // From the rim's side of an edge across its quad to the other side.
        let q = *left.get(&[b, a])?;
        let i = all[q].iter().position(|&v| v == b)?;
        let far = [all[q][(i + 2) % 4], all[q][(i + 3) % 4]];
        Some(group_of[*left.get(&[far[1], far[0]])?] == second && group_of[q] != second)
    };
    let is_row = sides[0].border.len() == n_rim
        && sides[1].border.len() == n_rim
        && sides[0]
            .border
            .iter()
            .all(|edge| crosses(edge) == Some(true));
    (is_row && sides.iter().all(Side::is_disc)).then_some((sides, n_rim))
}

/// Quads cut in two along their shorter diagonals, or the others where those are taken.
pub fn cut(mesh: &PolygonMesh) -> Option<TriangleMesh> {
    let key = |a: VertexId, b: VertexId| [a.min(b), a.max(b)];
    let edges = mesh
        .faces()
        .flat_map(|f| (0..4).map(|i| key(f[i], f[(i + 1) % 4])));
    let mut joined: HashSet<[VertexId; 2]> = edges.collect();
    let mut triangles = Vec::with_capacity(2 * mesh.n_faces());
    for face in mesh.faces() {
        let &[a, b, c, d] = <&[VertexId; 4]>::try_from(face).ok()?;
        let length = |v: VertexId, w: VertexId| mesh.position(v).distance_squared(mesh.position(w));
        let ways = [[[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]];
        let first = usize::from(length(b, d) < length(a, c));
        let way = [first, 1 - first]
            .into_iter()
            .find(|&way| joined.insert(key(ways[way][0][0], ways[way][0][2])))?;
        triangles.extend(ways[way]);
    }
    TriangleMesh::new(mesh.positions().to_vec(), triangles).ok()
}
