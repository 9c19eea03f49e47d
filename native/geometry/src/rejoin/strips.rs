//! Equal counts: strips of quads that cross a line are taken out of a sheet or doubled in it.
//!
//! A strip goes from an edge on a line through opposite edges to a border, or comes back. Where its
//! rungs shrink to a point each, the line has an edge less in its sheet; where each is cut in the
//! middle, one more (poly-chord collapse: Daniels, Silva, Shepherd & Cohen 2008). It is done where it
//! brings counts together, all lines that the strip crosses taken together; all faces stay quads, the
//! sheet hangs together as before, and no face gets more corners that turn the wrong way.

mod collapse;
mod parity;
mod pillow;
mod thirds;

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::chain::Chain;
use super::{Edge, Given, Line, Sheet, sorted};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// What a strip of all quads would cost, where 1 is what one costs whose quads are as wide as usual.
const MANY: f64 = 20.0;
/// The count of all quads changes by this share at most: beyond, a warning would say so.
const MOST_CHANGE: f64 = 0.04;
/// Lines keep this many vertices.
const FEWEST: usize = 4;

/// Sheets whose lines have been brought to equal counts as far as can be.
pub(super) struct Leveled {
    pub(super) mesh: PolygonMesh,
    /// What each vertex that came is called now.
    pub(super) name: VertexMap<VertexId>,
    /// The vertices that came in whose middle each vertex lies.
    pub(super) from: VertexMap<[VertexId; 2]>,
    pub(super) features: Vec<Edge>,
    pub(super) n_faces: Vec<usize>,
    /// Which sheets got other faces.
    pub(super) is_changed: Vec<bool>,
    /// The chains of each line, with the new names.
    pub(super) chains: Vec<Vec<Chain>>,
}

/// Brings the counts of chains together, and the chains onto their lines.
pub(super) fn level(
    given: &Given<'_>,
    (lines, chains): (&[Line], Vec<Vec<Chain>>),
    progress: &Progress<'_>,
) -> Result<Leveled, Cancelled> {
    let Given {
        mesh,
        sheets,
        features,
    } = *given;
    let mut leveling = Leveling {
        places: mesh.positions().to_vec(),
        from: (0..mesh.n_vertices())
            .map(|v| [VertexId::from_index(v); 2])
            .collect(),
        becomes: BTreeMap::new(),
        faces: sheets.iter().map(|sheet| faces(mesh, sheet)).collect(),
        is_kept: sheets.iter().map(|sheet| sheet.is_kept).collect(),
        are_quads: Vec::new(),
        is_changed: vec![false; sheets.len()],
        features: features.iter().map(|&edge| sorted(edge)).collect(),
        chains,
        n_given: mesh.n_faces(),
    };
    let faces = leveling.faces.iter();
    leveling.are_quads = faces
        .map(|faces| faces.iter().all(|face| face.len() == 4))
        .collect();
    leveling.pillow(lines, progress)?;
    for line in 0..leveling.chains.len() {
        progress.check()?;
        while leveling.step(line) {}
    }
    leveling.make_even(progress)?;
    leveling.cut_in_thirds(lines, progress)?;
    Ok(leveling.leveled(mesh.n_vertices()))
}

fn faces(mesh: &PolygonMesh, sheet: &Sheet) -> Vec<Vec<VertexId>> {
    let faces = sheet.faces.clone().map(FaceId::from_index);
    faces.map(|face| mesh.face(face).to_vec()).collect()
}

/// Sheets on their way.
struct Leveling {
    places: Vec<DVec3>,
    from: Vec<[VertexId; 2]>,
    /// What vertices that are gone have become.
    becomes: BTreeMap<VertexId, VertexId>,
    faces: Vec<Vec<Vec<VertexId>>>,
    /// Sheets that had better stay.
    is_kept: Vec<bool>,
    /// Sheets that are made of quads alone: the others have no strips.
    are_quads: Vec<bool>,
    is_changed: Vec<bool>,
    features: BTreeSet<Edge>,
    chains: Vec<Vec<Chain>>,
    /// How many faces there were.
    n_given: usize,
}

/// The sides of faces of a sheet at each of its edges, by the face and the place of the side in it.
type Sides = BTreeMap<Edge, Vec<(usize, usize)>>;

/// A strip, and what is to be done with it.
struct Strip {
    sheet: usize,
    rungs: Vec<Edge>,
    faces: Vec<usize>,
    is_doubled: bool,
    cost: f64,
}

impl Leveling {
    /// Takes out or doubles the cheapest strip that brings the counts of a line together; whether
    /// there is one.
    fn step(&mut self, line: usize) -> bool {
        let lengths = self.chains[line].iter().map(|chain| chain.vertices.len());
        let least = lengths.clone().min().unwrap_or(0);
        let most = lengths.max().unwrap_or(0);
        let mut strips = Vec::new();
        for chain in &self.chains[line] {
            let may_change = self.are_quads[chain.sheet] && !self.is_kept[chain.sheet];
            if !may_change || least == most {
                continue;
            }
            let sides = self.sides(chain.sheet);
            let n = chain.vertices.len();
            if n < most {
                strips.extend(self.strips((chain, &sides), true));
            }
            if n > least.max(FEWEST) {
                strips.extend(self.strips((chain, &sides), false));
            }
        }
        strips.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        strips.iter().any(|strip| {
            if strip.is_doubled {
                self.double(strip);
            }
            strip.is_doubled || self.collapse(strip)
        })
    }

    fn sides(&self, sheet: usize) -> Sides {
        let mut sides = Sides::new();
        for (f, face) in self.faces[sheet].iter().enumerate() {
            for i in 0..face.len() {
                let edge = sorted([face[i], face[(i + 1) % face.len()]]);
                sides.entry(edge).or_default().push((f, i));
            }
        }
        sides
    }

    /// The strips that cross a chain and bring counts together.
    fn strips(&self, (chain, sides): (&Chain, &Sides), is_doubled: bool) -> Vec<Strip> {
        let edges = chain.edges();
        let n = edges.len() as f64;
        let strip = |(i, &edge): (usize, &Edge)| {
            let mut strip = self.strip(edge, chain.sheet, sides)?;
            strip.is_doubled = is_doubled;
            let lengths = strip.rungs.iter().map(|&edge| self.length(edge));
            let mean = lengths.sum::<f64>() / strip.rungs.len() as f64;
            let usual = edges.iter().map(|&edge| self.length(edge)).sum::<f64>() / n;
            let shape = if is_doubled {
                usual / mean
            } else {
                mean / usual
            };
            // In the middle the others move by half an edge at most.
            strip.cost = shape * shape + ((2 * i + 1) as f64 - n).abs() / n;
            strip.cost += MANY * strip.faces.len() as f64 / self.n_given as f64;
            (self.is_few(&strip) && self.gain(&strip) > 0).then_some(strip)
        };
        edges.iter().enumerate().filter_map(strip).collect()
    }

    fn length(&self, edge: Edge) -> f64 {
        let [a, b] = edge.map(|v| self.places[v.index()]);
        a.distance(b)
    }

    /// The strip through an edge; none where it crosses itself or has a vertex twice.
    fn strip(&self, edge: Edge, sheet: usize, sides: &Sides) -> Option<Strip> {
        let mut rungs = vec![edge];
        let mut crossed = Vec::new();
        let mut is_closed = false;
        for &start in &sides[&edge] {
            let mut at = start;
            while !is_closed {
                let (f, i) = at;
                if crossed.contains(&f) {
                    return None;
                }
                crossed.push(f);
                let face = &self.faces[sheet][f];
                let rung = sorted([face[(i + 2) % 4], face[(i + 3) % 4]]);
                is_closed = rung == edge;
                if is_closed {
                    break;
                }
                rungs.push(rung);
                let Some(&next) = sides[&rung].iter().find(|side| side.0 != f) else {
                    break;
                };
                at = next;
            }
        }
        let mut ends: Vec<VertexId> = rungs.concat();
        ends.sort_unstable();
        let is_simple = ends.windows(2).all(|pair| pair[0] != pair[1]);
        let are_sound = rungs.iter().all(|rung| sides[rung].len() <= 2);
        (is_simple && are_sound).then_some(Strip {
            sheet,
            rungs,
            faces: crossed,
            is_doubled: false,
            cost: 0.0,
        })
    }

    /// Whether the count of all faces stays near what it was.
    fn is_few(&self, strip: &Strip) -> bool {
        let n = self.faces.iter().map(Vec::len).sum::<usize>();
        let after = if strip.is_doubled {
            n + strip.faces.len()
        } else {
            n - strip.faces.len()
        };
        after.abs_diff(self.n_given) as f64 <= MOST_CHANGE * self.n_given as f64
    }

    /// By how much the counts of all lines come together.
    fn gain(&self, strip: &Strip) -> i64 {
        let rungs: BTreeSet<Edge> = strip.rungs.iter().copied().collect();
        let change = if strip.is_doubled { 1 } else { -1 };
        let mut gain = 0;
        for chains in &self.chains {
            if chains.iter().all(|chain| chain.sheet != strip.sheet) {
                continue;
            }
            let before = chains.iter().map(|chain| chain.vertices.len() as i64);
            let after = chains.iter().map(|chain| {
                let own = chain.sheet == strip.sheet;
                let crossings = chain.edges().iter().filter(|e| rungs.contains(*e)).count();
                chain.vertices.len() as i64 + if own { change * crossings as i64 } else { 0 }
            });
            let span = |lengths: Vec<i64>| {
                lengths
                    .iter()
                    .max()
                    .zip(lengths.iter().min())
                    .map_or(0, |(a, b)| a - b)
            };
            gain += span(before.collect()) - span(after.collect());
        }
        gain
    }

    /// Cuts each rung of a strip in the middle.
    fn double(&mut self, strip: &Strip) {
        self.is_changed[strip.sheet] = true;
        let mut middles: BTreeMap<Edge, VertexId> = BTreeMap::new();
        for &rung in &strip.rungs {
            let [a, b] = rung;
            let place = self.place(a).midpoint(self.place(b));
            let middle = self.add(place, rung);
            if self.features.remove(&rung) {
                self.features.extend([[a, middle], [b, middle]]);
            }
            middles.insert(rung, middle);
        }
        for &f in &strip.faces {
            let face = self.faces[strip.sheet][f].clone();
            let at = |i: usize| middles.get(&sorted([face[i], face[(i + 1) % 4]])).copied();
            let i = usize::from(at(0).is_none());
            if let (Some(m), Some(n)) = (at(i), at(i + 2)) {
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| face[(i + k) % 4]);
                self.faces[strip.sheet][f] = vec![a, m, n, d];
                self.faces[strip.sheet].push(vec![m, b, c, n]);
            }
        }
        self.lengthen(strip.sheet, |edge| {
            middles.get(&sorted(edge)).copied().into_iter().collect()
        });
    }

    fn place(&self, v: VertexId) -> DVec3 {
        self.places[v.index()]
    }

    /// A new vertex between two.
    fn add(&mut self, place: DVec3, [a, b]: Edge) -> VertexId {
        self.places.push(place);
        self.from
            .push([self.from[a.index()][0], self.from[b.index()][0]]);
        VertexId::from_index(self.places.len() - 1)
    }

    /// Puts vertices between the ends of edges of a sheet's chains.
    fn lengthen(&mut self, sheet: usize, between: impl Fn(Edge) -> Vec<VertexId>) {
        let chains = self.chains.iter_mut().flatten();
        for chain in chains.filter(|chain| chain.sheet == sheet) {
            let sides = chain.sides();
            let vertices = chain.vertices.iter().enumerate();
            let longer = vertices.flat_map(|(i, &v)| {
                let after = sides.get(i).map(|&side| between(side));
                std::iter::once(v).chain(after.unwrap_or_default())
            });
            let longer: Vec<VertexId> = longer.collect();
            chain.is_changed |= chain.vertices.len() != longer.len();
            chain.vertices = longer;
        }
    }

    /// What has become of all of it; vertices that are gone leave no name.
    fn leveled(self, n_before: usize) -> Leveled {
        let last = |mut v: VertexId| {
            while let Some(&next) = self.becomes.get(&v) {
                v = next;
            }
            v
        };
        let mut names: Vec<Option<VertexId>> = Vec::with_capacity(self.places.len());
        let (mut positions, mut from) = (Vec::new(), Vec::new());
        for (i, (&place, &of)) in self.places.iter().zip(&self.from).enumerate() {
            let is_left = !self.becomes.contains_key(&VertexId::from_index(i));
            names.push(is_left.then(|| VertexId::from_index(positions.len())));
            if is_left {
                positions.push(place);
                from.push(of);
            }
        }
        let named = |v: VertexId| names[last(v).index()].expect("what a vertex became is there");
        let (mut starts, mut corners) = (vec![0], Vec::new());
        for face in self.faces.iter().flatten() {
            corners.extend(face.iter().map(|&v| named(v)));
            starts.push(corners.len() as u32);
        }
        let mesh = PolygonMesh::new(positions, starts, corners);
        let mut chains = self.chains;
        for v in chains
            .iter_mut()
            .flatten()
            .flat_map(|chain| &mut chain.vertices)
        {
            *v = names[v.index()].expect("chains go over vertices that are left");
        }
        Leveled {
            mesh: mesh.expect("no face loses a corner"),
            name: (0..n_before)
                .map(|v| named(VertexId::from_index(v)))
                .collect(),
            from: VertexMap::from_vec(from),
            features: self.features.iter().map(|edge| edge.map(named)).collect(),
            n_faces: self.faces.iter().map(Vec::len).collect(),
            is_changed: self.is_changed,
            chains,
        }
    }
}
