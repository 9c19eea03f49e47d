//! Relaxing quads that flow: edges turn along a field of crosses and get one length.

use glam::DVec3;

use super::Flowing;
use super::cover::Cover;
use super::sheet::{Point, Sheet};
use crate::mesh::{FaceMap, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// Share of an edge's own length in the length that is wanted; the rest is the mean of all. At 0
/// quads near irregular vertices are sheared, at 0.5 lengths even out too slowly.
const OWN_LENGTH: f64 = 0.1;
/// Share of the way that a vertex goes at once.
const DAMPING: f64 = 0.7;
/// Share of its last way that a vertex goes on for. Without it lengths even out too slowly over
/// long ways; from 0.7 on vertices swing.
const MOMENTUM: f64 = 0.6;
/// Shares of the way to the middle of its neighbours that a vertex of an inverted face tries.
const LOOSENINGS: [f64; 2] = [1.0, 0.3];
/// Quality that no move may spoil: below it a move must make the worst face at the vertex better.
const GUARDED_QUALITY: f64 = 0.7;
/// The same where edges are to be equally long, which takes room; below, the worst quads suffer.
const EVEN_GUARDED_QUALITY: f64 = 0.6;
/// Below this quality a vertex that is stuck tries places around it.
const BAD_QUALITY: f64 = 0.45;
/// How far away these places are, in mean edges.
const REACHES: [f64; 4] = [0.4, 0.2, 0.1, 0.03];

/// A face that covers this many times its own area begins to count as lying over a tip, and counts
/// fully at twice that; below 1.5 every bent face would shrink, and edges become uneven.
const LEAST_EXCESS: f64 = 2.0;
/// How much of a step at most goes to the middle of what a face hides.
const CLIMB: f64 = 0.5;
/// Shares of its way that a vertex that walks tries to go.
const LEADS: [f64; 3] = [1.0, 0.5, 0.2];

/// The neighbours of every vertex over edges.
pub(super) struct Stars {
    starts: Vec<u32>,
    neighbours: Vec<VertexId>,
}

impl Stars {
    /// The edges of a sheet; each is the first of one face at each of its ends.
    pub fn new(sheet: &Sheet) -> Self {
        let mut starts = vec![0];
        let mut neighbours = Vec::with_capacity(4 * sheet.n_vertices());
        for v in sheet.vertex_ids() {
            neighbours.extend(sheet.ring(v).iter().map(|&face| {
                let face = &sheet.faces()[face];
                face.corner(face.find(v).expect("a ring's faces have the vertex"), 1)
            }));
            starts.push(neighbours.len() as u32);
        }
        Self { starts, neighbours }
    }

    /// The neighbours of one vertex.
    pub fn of(&self, v: VertexId) -> &[VertexId] {
        let [from, to] = [self.starts[v.0 as usize], self.starts[v.0 as usize + 1]];
        &self.neighbours[from as usize..to as usize]
    }
}

/// Quads on their way along a field of crosses.
pub(super) struct Follower<'a> {
    flowing: Flowing<'a>,
    cover: Cover,
    stars: Stars,
    /// The last way of every vertex, of which it goes on for a share.
    ways: VertexMap<DVec3>,
    /// The share of an edge's own length in what is wanted.
    own_length: f64,
    /// The quality that no move may spoil.
    guarded: f64,
}

impl<'a> Follower<'a> {
    /// At rest; `evenness` from 0 to 1 says how much equal lengths matter.
    pub fn new(map: &SphereMap, sheet: &Sheet, flowing: Flowing<'a>, evenness: f64) -> Self {
        let even = EVEN_GUARDED_QUALITY - GUARDED_QUALITY;
        Self {
            own_length: OWN_LENGTH * (1.0 - evenness),
            guarded: GUARDED_QUALITY + even * evenness,
            flowing,
            cover: Cover::new(map, sheet),
            stars: Stars::new(sheet),
            ways: VertexMap::filled(sheet.n_vertices(), DVec3::ZERO),
        }
    }

    /// Takes away what the vertices go on for.
    pub fn rest(&mut self) {
        self.ways.as_mut_slice().fill(DVec3::ZERO);
    }

    /// The neighbours of every vertex.
    pub fn stars(&self) -> &Stars {
        &self.stars
    }

    /// Moves every vertex that is not pinned, round by round, to the mean of where the edges to its
    /// neighbours want it: along the nearest arm of the cross, at the wanted length.
    ///
    /// Moves go along the surface; those that fold the sphere or spoil a face are halved once, then
    /// refused. What faces cover is measured once, before the first of a few rounds. Returns how
    /// many moves of the last round were refused.
    pub fn follow(
        &mut self,
        sheet: &mut Sheet,
        n_rounds: usize,
        progress: &Progress,
    ) -> Result<usize, Cancelled> {
        self.cover.update(sheet);
        let mut n_refused = 0;
        for round in 0..n_rounds {
            progress.at(round as f64 / n_rounds as f64)?;
            let unit = unit(sheet, self.flowing.sizes, &self.stars);
            n_refused = 0;
            for v in sheet.vertex_ids() {
                if v.0 % 4096 == 0 {
                    progress.check()?;
                }
                if !sheet.is_pinned(v) {
                    n_refused += usize::from(!self.step(sheet, v, unit));
                }
            }
        }
        Ok(n_refused)
    }

    /// Moves one vertex; false if it stays where it does not belong.
    fn step(&mut self, sheet: &mut Sheet, v: VertexId, unit: f64) -> bool {
        let star = self.stars.of(v);
        if loosen(sheet, v, star) {
            return true;
        }
        let step = wish(sheet, self.flowing, (v, star), [unit, self.own_length]);
        let step = DAMPING * climb(sheet, &self.cover, v, step) + MOMENTUM * self.ways[v];
        let before = sheet.position(v);
        let moved = slide(sheet, v, step, self.guarded)
            || slide(sheet, v, step * 0.5, self.guarded)
            || mend(
                sheet,
                v,
                unit * self.flowing.sizes[sheet.point(v).place.face],
            );
        self.ways[v] = sheet.position(v) - before;
        moved
    }
}

/// Moves a vertex of an inverted face towards the middle of its neighbours, guarded by nothing but
/// the folds on the sphere: more would keep knots closed. False where there is no such face or no way.
fn loosen(sheet: &mut Sheet, vertex: VertexId, star: &[VertexId]) -> bool {
    let now = *sheet.point(vertex);
    if sheet.worst_quality(vertex, &now) >= 0.0 {
        return false;
    }
    let sum: DVec3 = star.iter().map(|&other| sheet.position(other)).sum();
    let middle = sum / star.len() as f64;
    LOOSENINGS.iter().any(|&share| {
        let there = sheet.walked(vertex, now.position.lerp(middle, share));
        sheet.try_move(vertex, there)
    })
}

/// Moves a vertex along the surface if that neither folds the sphere nor brings the worst face
/// below `enough`, or makes it better where it is there already.
pub(super) fn slide(sheet: &mut Sheet, vertex: VertexId, step: DVec3, enough: f64) -> bool {
    let now = *sheet.point(vertex);
    let there = sheet.walked(vertex, now.position + step);
    let before = sheet.badness(vertex, &now, enough);
    let after = sheet.badness(vertex, &there, enough);
    after <= before && sheet.try_move(vertex, there)
}

/// Moves a vertex of a bad face to the best of some places around it.
fn mend(sheet: &mut Sheet, vertex: VertexId, length: f64) -> bool {
    let now = *sheet.point(vertex);
    if sheet.worst_quality(vertex, &now) >= BAD_QUALITY {
        return false;
    }
    let ways = now.ways();
    let places = REACHES
        .iter()
        .flat_map(|reach| ways.map(|way| way * (reach * length)));
    let mut best = (sheet.badness(vertex, &now, GUARDED_QUALITY), now);
    for step in places {
        let there = sheet.walked(vertex, now.position + step);
        let badness = sheet.badness(vertex, &there, GUARDED_QUALITY);
        if badness < best.0 && sheet.covers(vertex, there.sphere) {
            best = (badness, there);
        }
    }
    best.1 != now && sheet.try_move(vertex, best.1)
}

/// Leads vertices along the surface to positions near it, as far as nothing folds on the sphere.
pub(super) fn lead(
    sheet: &mut Sheet,
    wanted: &[DVec3],
    n_rounds: usize,
    progress: &Progress,
) -> Result<(), Cancelled> {
    for round in 0..n_rounds {
        progress.at(round as f64 / n_rounds as f64)?;
        for (v, &wanted) in sheet.vertex_ids().zip(wanted) {
            walk(sheet, v, wanted - sheet.position(v));
        }
    }
    Ok(())
}

/// Moves a vertex along the surface by a step or a share of it, if nothing folds on the sphere.
pub(super) fn walk(sheet: &mut Sheet, vertex: VertexId, step: DVec3) {
    for share in LEADS {
        let there = sheet.walked(vertex, sheet.position(vertex) + step * share);
        if sheet.try_move(vertex, there) {
            break;
        }
    }
}

fn along(step: DVec3, at: &Point) -> DVec3 {
    step - at.normal * step.dot(at.normal)
}

/// What a wanted size must be multiplied by for the mean edge to be as long as it is.
fn unit(sheet: &Sheet, sizes: &FaceMap<f64>, stars: &Stars) -> f64 {
    let [mut lengths, mut wanted] = [0.0; 2];
    for v in sheet.vertex_ids() {
        let here = sheet.point(v);
        for &other in stars.of(v) {
            lengths += here.position.distance(sheet.position(other));
            wanted += sizes[here.place.face];
        }
    }
    lengths / wanted
}

/// The way along the surface to the mean of what the edges of a vertex want: lengths in so many
/// units of their sizes, but for a share of their own.
fn wish(
    sheet: &Sheet,
    Flowing { crosses, sizes, .. }: Flowing<'_>,
    (vertex, star): (VertexId, &[VertexId]),
    [unit, own]: [f64; 2],
) -> DVec3 {
    let here = sheet.point(vertex);
    let sum: DVec3 = star
        .iter()
        .map(|&other| {
            let there = sheet.point(other);
            let edge = here.position - there.position;
            let wanted = [here, there].map(|end| unit * sizes[end.place.face]);
            let length = f64::midpoint(wanted[0], wanted[1]);
            let size = own * edge.length() + (1.0 - own) * length;
            let arms =
                [here, there].map(|end| nearest_arm(crosses[end.place.face], end.normal, edge));
            there.position + (arms[0] + arms[1]) * (0.5 * size)
        })
        .sum();
    along(sum / star.len() as f64 - here.position, here)
}

/// Turns a vertex's step towards what the faces at it hide: a face that covers much more than it
/// seems to lies over the tip of a limb, and its corners have slipped off.
fn climb(sheet: &Sheet, cover: &Cover, vertex: VertexId, step: DVec3) -> DVec3 {
    let here = sheet.point(vertex);
    let most = sheet
        .ring(vertex)
        .iter()
        .map(|&face| (cover.excess(sheet, face), face));
    let Some((excess, face)) = most.max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return step;
    };
    let hidden = ((excess - LEAST_EXCESS) / LEAST_EXCESS).clamp(0.0, 1.0);
    step.lerp(
        along(cover.part(face).centre - here.position, here),
        CLIMB * hidden,
    )
}

/// The arm of a cross that points most along an edge.
pub(super) fn nearest_arm(arm: DVec3, normal: DVec3, edge: DVec3) -> DVec3 {
    let other = normal.cross(arm);
    let [a, b] = [edge.dot(arm), edge.dot(other)];
    if a.abs() > b.abs() {
        arm * a.signum()
    } else {
        other * b.signum()
    }
}
