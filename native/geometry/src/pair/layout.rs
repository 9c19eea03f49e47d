//! Coarse quads as a layout of finer ones: every strip of quads is cut into a number of rows.
//!
//! ```text
//! d ────────── c      A strip goes from edge to opposite edge and ends at borders or in itself. Here
//! │   │   │    │      one is cut in three across a b, one in two across b c. Lines of the coarse quads
//! ├───┼───┼────┤      stay lines; vertices where other than four quads meet stay the only ones.
//! a ────────── b
//! ```

use std::collections::HashMap;

use glam::DVec3;

use super::faces_on;
use crate::elementary::{exp2, ln};
use crate::groups::Groups;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};

/// What a share of the count that is missed costs, against the squared logarithm of how much longer or
/// shorter edges are than others.
const MISSED: f64 = 20.0;
/// Scales that are tried on either side, so many for each doubling, and how many doublings.
const SCALES: i32 = 16;
const DOUBLINGS: i32 = 4;
/// Steps by which counts are improved, at most.
const MOST_STEPS: usize = 200;

type Edge = [VertexId; 2];

/// Coarse quads, and the strips that they make.
pub struct Layout<'a> {
    quads: &'a PolygonMesh,
    /// The strip across the first side of each quad and the third, and that across the others.
    strips: Vec<[usize; 2]>,
    lengths: Vec<f64>,
    /// The share of the area that each strip has, of twice the whole.
    shares: Vec<f64>,
    area: f64,
}

/// Finer quads.
pub struct Cut {
    /// They, on the coarse ones: sides straight, the rest bilinear.
    pub mesh: PolygonMesh,
    /// A coarse quad that each vertex lies in.
    pub quads: Vec<FaceId>,
    /// Where the vertices on each coarse edge begin, the smaller end of it first, and how many rows it
    /// is cut in.
    on_edge: HashMap<Edge, [usize; 2]>,
}

impl<'a> Layout<'a> {
    /// The strips of a mesh of quads; those that are each other's images in a plane count as one. None
    /// where a face is no quad or an edge has more than two.
    pub fn of(quads: &'a PolygonMesh, images: Option<&[VertexId]>) -> Option<Self> {
        let mut numbers: HashMap<Edge, usize> = HashMap::new();
        let (mut edges, mut n_faces): (Vec<Edge>, Vec<usize>) = (Vec::new(), Vec::new());
        let mut sides = Vec::with_capacity(quads.n_faces());
        for face in quads.faces() {
            let corners: [VertexId; 4] = face.try_into().ok()?;
            sides.push([0, 1, 2, 3].map(|i| {
                let edge = sorted([corners[i], corners[(i + 1) % 4]]);
                let number = *numbers.entry(edge).or_insert(edges.len());
                if number == edges.len() {
                    edges.push(edge);
                    n_faces.push(0);
                }
                n_faces[number] += 1;
                number
            }));
        }
        if n_faces.iter().any(|&n| n > 2) {
            return None;
        }
        let mut groups = Groups::new(edges.len());
        for [a, b, c, d] in &sides {
            groups.link(*a, *c);
            groups.link(*b, *d);
        }
        if let Some(images) = images {
            for (number, edge) in edges.iter().enumerate() {
                let image = sorted(edge.map(|v| images[v.index()]));
                groups.link(number, *numbers.get(&image)?);
            }
        }
        let (strip_of, n_strips) = groups.numbered();
        let strips = sides
            .iter()
            .map(|s| [s[0], s[1]].map(|e| strip_of[e] as usize));
        let mut layout = Self {
            quads,
            strips: strips.collect(),
            lengths: vec![0.0; n_strips],
            shares: vec![0.0; n_strips],
            area: 0.0,
        };
        layout.measure();
        Some(layout)
    }

    /// The share of quads that one strip crosses twice.
    pub fn spiral(&self) -> f64 {
        let crossed = self.strips.iter().filter(|[u, v]| u == v);
        crossed.count() as f64 / self.strips.len().max(1) as f64
    }

    /// How many strips there are.
    pub fn n_strips(&self) -> usize {
        self.lengths.len()
    }

    fn measure(&mut self) {
        for (face, strips) in self.quads.faces().zip(&self.strips) {
            let p = [0, 1, 2, 3].map(|i| self.quads.position(face[i]));
            let area = (p[2] - p[0]).cross(p[3] - p[1]).length() / 2.0;
            self.area += area;
            for (side, &strip) in strips.iter().enumerate() {
                let length = |i: usize| p[i].distance(p[(i + 1) % 4]);
                self.lengths[strip] += area * (length(side) + length(side + 2)) / 2.0;
                self.shares[strip] += area;
            }
        }
        for (length, share) in self.lengths.iter_mut().zip(&mut self.shares) {
            *length /= share.max(f64::MIN_POSITIVE);
            *share /= 2.0 * self.area.max(f64::MIN_POSITIVE);
        }
    }

    /// How many rows to cut each strip in for about so many quads, as square as can be.
    pub fn counts(&self, n_quads: usize) -> Vec<usize> {
        let edge = (self.area / n_quads.max(1) as f64).sqrt();
        let at = |i: i32| {
            let scale = exp2(f64::from(i) / f64::from(SCALES)) / edge.max(f64::MIN_POSITIVE);
            let rows = |length: &f64| (length * scale).round().max(1.0) as usize;
            let counts: Vec<usize> = self.lengths.iter().map(rows).collect();
            let off = self.n_quads(&counts).abs_diff(n_quads);
            (off, i.abs(), scale, counts)
        };
        let most = SCALES * DOUBLINGS;
        let best = (-most..=most).map(at).min_by_key(|best| (best.0, best.1));
        let (_, _, scale, counts) = best.expect("a scale is tried");
        self.improved(counts, (scale, n_quads))
    }

    /// How many quads there are with such counts.
    pub fn n_quads(&self, counts: &[usize]) -> usize {
        let each = self.strips.iter().map(|&[u, v]| counts[u] * counts[v]);
        each.sum()
    }

    /// Counts in which no single one is better by one more or less.
    fn improved(&self, mut counts: Vec<usize>, (scale, n_wanted): (f64, usize)) -> Vec<usize> {
        let mut of_strip = vec![Vec::new(); self.n_strips()];
        for (f, strips) in self.strips.iter().enumerate() {
            for &strip in strips {
                of_strip[strip].push(f);
            }
        }
        let mut n = self.n_quads(&counts);
        let missed = |n: usize| MISSED * n.abs_diff(n_wanted) as f64 / n_wanted.max(1) as f64;
        let shape = |strip: usize, count: usize| {
            let longer = ln(self.lengths[strip] * scale / count as f64);
            self.shares[strip] * longer * longer
        };
        for _ in 0..MOST_STEPS {
            let mut best = (0.0, 0, 0, n);
            for strip in (0..counts.len()).filter(|&s| self.lengths[s] > 0.0) {
                let mut faces = of_strip[strip].clone();
                faces.dedup();
                let now = counts[strip];
                let before: usize = self.n_in(&faces, &counts);
                for then in [now - 1, now + 1].into_iter().filter(|&then| then > 0) {
                    counts[strip] = then;
                    let n_then = n + self.n_in(&faces, &counts) - before;
                    let gain = shape(strip, now) - shape(strip, then) + missed(n) - missed(n_then);
                    if gain > best.0 + 1e-12 {
                        best = (gain, strip, then, n_then);
                    }
                }
                counts[strip] = now;
            }
            let (gain, strip, then, n_then) = best;
            if gain <= 0.0 {
                break;
            }
            counts[strip] = then;
            n = n_then;
        }
        counts
    }

    fn n_in(&self, faces: &[usize], counts: &[usize]) -> usize {
        let strips = faces.iter().map(|&f| self.strips[f]);
        strips.map(|[u, v]| counts[u] * counts[v]).sum()
    }

    /// The quads cut into so many rows each.
    pub fn cut(&self, counts: &[usize]) -> Cut {
        let mut cut = Rows {
            positions: self.quads.positions().to_vec(),
            quads: vec![FaceId(0); self.quads.n_vertices()],
            on_edge: HashMap::new(),
        };
        let mut faces: Vec<[u32; 4]> = Vec::with_capacity(self.n_quads(counts));
        for (f, strips) in self.quads.face_ids().zip(&self.strips) {
            let face = self.quads.face(f);
            let corners = [face[0], face[1], face[2], face[3]];
            for v in corners {
                cut.quads[v.index()] = f;
            }
            cut.quad((f, corners), strips.map(|strip| counts[strip]), &mut faces);
        }
        Cut {
            mesh: faces_on(cut.positions, &faces),
            quads: cut.quads,
            on_edge: cut.on_edge,
        }
    }
}

impl Cut {
    /// The vertices on a coarse edge, smaller end first, its ends among them.
    pub fn on(&self, edge: Edge) -> Vec<usize> {
        let Some(&[first, n]) = self.on_edge.get(&edge) else {
            return Vec::new();
        };
        let inner = first..first + n - 1;
        let [a, b] = edge.map(Id::index);
        [a].into_iter().chain(inner).chain([b]).collect()
    }

    /// The finer edges that lie along coarse ones, each once, smaller end first, in order.
    pub fn along(&self, edges: &[Edge]) -> Vec<Edge> {
        let mut along = Vec::new();
        for edge in edges {
            let on = self.on(*edge);
            let line: Vec<VertexId> = on.into_iter().map(VertexId::from_index).collect();
            along.extend(line.windows(2).map(|w| sorted([w[0], w[1]])));
        }
        along.sort_unstable();
        along
    }
}

/// Finer quads on their way.
struct Rows {
    positions: Vec<DVec3>,
    quads: Vec<FaceId>,
    on_edge: HashMap<Edge, [usize; 2]>,
}

impl Rows {
    fn add(&mut self, quad: FaceId, place: DVec3) -> usize {
        self.positions.push(place);
        self.quads.push(quad);
        self.positions.len() - 1
    }

    /// The vertices along an edge, from end to end.
    fn edge(&mut self, quad: FaceId, ends: Edge, n: usize) -> Vec<usize> {
        let edge = sorted(ends);
        let [a, b] = edge.map(|v| self.positions[v.index()]);
        if !self.on_edge.contains_key(&edge) {
            let first = self.positions.len();
            for i in 1..n {
                self.add(quad, a.lerp(b, i as f64 / n as f64));
            }
            self.on_edge.insert(edge, [first, n]);
        }
        let [first, _] = self.on_edge[&edge];
        let inner = first..first + n - 1;
        let whole = [edge[0].index()]
            .into_iter()
            .chain(inner)
            .chain([edge[1].index()]);
        let mut whole: Vec<usize> = whole.collect();
        if edge != ends {
            whole.reverse();
        }
        whole
    }

    /// Cuts a quad into rows along its first side and along its second.
    fn quad(
        &mut self,
        (quad, [a, b, c, d]): (FaceId, [VertexId; 4]),
        [n, m]: [usize; 2],
        faces: &mut Vec<[u32; 4]>,
    ) {
        let low = self.edge(quad, [a, b], n);
        let high = self.edge(quad, [d, c], n);
        let left = self.edge(quad, [a, d], m);
        let right = self.edge(quad, [b, c], m);
        let corners = [a, b, c, d].map(|v| self.positions[v.index()]);
        let mut below = low;
        for j in 1..=m {
            let row = if j == m {
                high.clone()
            } else {
                let mut row = vec![left[j]];
                for i in 1..n {
                    let [s, t] = [(i, n), (j, m)].map(|(i, n)| i as f64 / n as f64);
                    let ends = [
                        corners[0].lerp(corners[1], s),
                        corners[3].lerp(corners[2], s),
                    ];
                    row.push(self.add(quad, ends[0].lerp(ends[1], t)));
                }
                row.push(right[j]);
                row
            };
            let cells = below.windows(2).zip(row.windows(2));
            faces.extend(
                cells.map(|(low, high)| [low[0], low[1], high[1], high[0]].map(|v| v as u32)),
            );
            below = row;
        }
    }
}

fn sorted([a, b]: Edge) -> Edge {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::CUBE_QUADS;

    fn cuboid(size: DVec3) -> PolygonMesh {
        let corner = |i: u32| {
            let bit = |bit: u32| f64::from(i >> bit & 1);
            DVec3::new(bit(0), bit(1), bit(2)) * size
        };
        PolygonMesh::from_faces((0..8).map(corner).collect(), &CUBE_QUADS).unwrap()
    }

    #[test]
    fn a_cuboid_has_three_strips_that_are_cut_by_their_lengths() {
        let mesh = cuboid(DVec3::new(4.0, 2.0, 1.0));
        let layout = Layout::of(&mesh, None).unwrap();
        assert_eq!(layout.n_strips(), 3);
        let counts = layout.counts(28 * 9);
        let cut = layout.cut(&counts);
        assert_eq!((cut.mesh.n_faces(), layout.n_quads(&counts)), (252, 252));
        // Every quad is a square of a third.
        for face in cut.mesh.faces() {
            let p = [0, 1, 2, 3].map(|i| cut.mesh.position(face[i]));
            assert!((0..4).all(|i| (p[i].distance(p[(i + 1) % 4]) - 1.0 / 3.0).abs() < 1e-12));
        }
    }

    #[test]
    fn a_cut_layout_is_closed_and_keeps_its_edges() {
        let mesh = cuboid(DVec3::new(3.0, 2.0, 1.0));
        let layout = Layout::of(&mesh, None).unwrap();
        for n in [6, 50, 333] {
            let cut = layout.cut(&layout.counts(n));
            let [n_faces, n_vertices] = [cut.mesh.n_faces(), cut.mesh.n_vertices()];
            assert_eq!(n_vertices, n_faces + 2, "{n}");
            assert!(n_faces.abs_diff(n) * 20 <= n, "{n_faces} instead of {n}");
            let along = cut.along(&[[VertexId(0), VertexId(1)]]);
            let length = |[a, b]: &Edge| cut.mesh.position(*a).distance(cut.mesh.position(*b));
            let whole = mesh
                .position(VertexId(0))
                .distance(mesh.position(VertexId(1)));
            assert!((along.iter().map(length).sum::<f64>() - whole).abs() < 1e-12);
        }
    }

    #[test]
    fn strips_that_are_images_get_equal_counts() {
        // Two quads side by side, one slightly wider: apart they are cut otherwise.
        let points = [0.0, 1.0, 2.3].map(|x| [DVec3::new(x, 0.0, 0.0), DVec3::new(x, 1.0, 0.0)]);
        let mesh = PolygonMesh::from_faces(points.concat(), &[[0, 2, 3, 1], [2, 4, 5, 3]]).unwrap();
        let images: Vec<VertexId> = [4, 5, 2, 3, 0, 1].map(VertexId).to_vec();
        let apart = Layout::of(&mesh, None).unwrap();
        let alike = Layout::of(&mesh, Some(&images)).unwrap();
        assert_eq!((apart.n_strips(), alike.n_strips()), (3, 2));
        assert_eq!(alike.counts(2), vec![1; 2]);
    }

    #[test]
    fn what_is_not_all_quads_two_at_an_edge_is_no_layout() {
        let points: Vec<DVec3> = (0..8).map(|i| DVec3::splat(f64::from(i))).collect();
        let fan = [[0, 1, 2, 3], [1, 0, 4, 5], [0, 1, 6, 7]];
        let mesh = PolygonMesh::from_faces(points.clone(), &fan).unwrap();
        assert!(Layout::of(&mesh, None).is_none());
        let mesh = PolygonMesh::from_faces(points, &[vec![0, 1, 2]]).unwrap();
        assert!(Layout::of(&mesh, None).is_none());
    }
}
