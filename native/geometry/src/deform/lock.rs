//! Vertices of flowing quads on sharp lines: led there, pinned, and moved along them.
//!
//! A vertex on a line has one freedom left, its arc length; vertices at the line's ends have none.
//! Between rounds of relaxation each goes to where its neighbours want it along the line.

use std::collections::BTreeSet;

use glam::DVec3;

use super::follow::{Follower, Stars, walk};
use super::project::lift_towards;
use super::sheet::Sheet;
use super::untangle::{grown, smooth};
use crate::measure::Seam;
use crate::mesh::VertexId;
use crate::progress::{Cancelled, Progress};

/// Steps in which vertices walk to their lines, while the others make room.
const N_STEPS: usize = 30;
/// How far one goes in a step, in edges.
const STRIDE: f64 = 0.35;
/// A vertex is set onto its line from no farther away than this share of an edge.
const NEAR: f64 = 0.1;
/// Quality that setting a vertex onto its line may not spoil unless the face is worse already.
const LEAST_QUALITY: f64 = 0.2;
/// Quality that moving one along its line may not spoil.
const GUARDED_QUALITY: f64 = 0.7;
/// Share of its way along the line that a vertex goes at once.
const DAMPING: f64 = 0.5;
/// Share of the way to the middle between its neighbours that it goes besides where the line is bent:
/// long edges would cut off more than their share of a rim.
const EVENNESS: f64 = 0.5;
/// A line is bent whose ends are nearer to each other than this share of its length.
const STRAIGHT: f64 = 0.98;
/// A vertex stays this share of the way to its neighbours on the line away from these.
const ROOM: f64 = 0.4;

/// The seams of a sheet while it is relaxed.
pub(super) struct Seams {
    tracks: Vec<Track>,
}

struct Track {
    seam: Seam,
    /// Whether the line is no straight one.
    is_bent: bool,
    /// Which vertices stand on the line.
    is_there: Vec<bool>,
}

impl Seams {
    /// Leads vertices to their lines and pins those that arrive.
    pub fn new(
        sheet: &mut Sheet,
        seams: &[Seam],
        follower: &mut Follower<'_>,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        for pair in seams.iter().flat_map(|s| s.vertices.windows(2)) {
            sheet.keep_edge(pair[0], pair[1]);
        }
        let tracks = seams.iter().cloned().map(Track::new).collect();
        let mut seams = Self { tracks };
        for v in seams.vertices().collect::<Vec<_>>() {
            sheet.pin(v);
        }
        for step in 0..N_STEPS {
            if seams.step(sheet) == 0 {
                break;
            }
            let [from, to] = [step, step + 1].map(|s| s as f64 / N_STEPS as f64);
            let part = progress.part("", from, to);
            follower.follow(sheet, 1, &part)?;
            // With momentum it would be shoved past the vertices that walk.
            follower.rest();
        }
        seams.pin(sheet);
        Ok(seams)
    }

    /// Moves vertices along their lines to where their neighbours want them, evenly along bent ones
    /// where that is asked for, and on towards the lines those that are not there.
    pub fn slide(&mut self, sheet: &mut Sheet, stars: &Stars, is_even: bool) {
        for track in &mut self.tracks {
            track.slide(sheet, stars, is_even);
        }
        self.step(sheet);
        self.pin(sheet);
    }

    /// How many vertices belong on lines, and how many are there.
    pub fn counts(&self, sheet: &Sheet) -> [usize; 2] {
        let vertices: BTreeSet<VertexId> = self.vertices().collect();
        let n_there = vertices.iter().filter(|&&v| sheet.is_pinned(v)).count();
        [vertices.len(), n_there]
    }

    /// Lets go of vertices at bad faces, so that these can be mended.
    pub fn release_bad(&self, sheet: &mut Sheet) {
        for v in self.vertices() {
            if sheet.worst_quality(v, sheet.point(v)) < LEAST_QUALITY {
                sheet.unpin(v);
            }
        }
    }

    /// Sets every vertex onto its line in space, whatever its sphere point says, and what is around
    /// those that had not arrived between them.
    pub fn force(&self, sheet: &mut Sheet) {
        let mut moved = Vec::new();
        for track in &self.tracks {
            for (&v, &at) in track.seam.vertices.iter().zip(&track.seam.at) {
                if !sheet.is_pinned(v) {
                    sheet.lift(v, track.seam.line.point(at));
                    sheet.pin(v);
                    moved.push(v);
                }
            }
        }
        smooth(sheet, &grown(sheet, moved, 1));
    }

    /// Pins those vertices alone that are on their lines.
    fn pin(&self, sheet: &mut Sheet) {
        for v in self.vertices() {
            sheet.unpin(v);
        }
        for track in &self.tracks {
            let vertices = track.seam.vertices.iter().zip(&track.is_there);
            for (&v, _) in vertices.filter(|(_, is_there)| **is_there) {
                sheet.pin(v);
            }
        }
    }

    /// Brings vertices a step nearer to their lines; returns how many are still on the way.
    fn step(&mut self, sheet: &mut Sheet) -> usize {
        let edge = sheet.mean_edge();
        let mut n_left = 0;
        for track in &mut self.tracks {
            for i in 0..track.n() {
                if !track.is_there[i] {
                    track.is_there[i] = track.approach(sheet, i, edge);
                    n_left += usize::from(!track.is_there[i]);
                }
            }
        }
        n_left
    }

    fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        self.tracks
            .iter()
            .flat_map(|t| t.seam.vertices.iter().copied())
    }
}

/// Moves the free vertices of the faces around one that is on its way, which may stand in it.
fn shove(sheet: &mut Sheet, v: VertexId, way: DVec3) {
    let faces = sheet.ring(v).iter();
    let corners = faces.flat_map(|&face| sheet.faces()[face].corners().to_vec());
    let around: BTreeSet<VertexId> = corners.filter(|&u| u != v && !sheet.is_pinned(u)).collect();
    for u in around {
        walk(sheet, u, way);
    }
}

impl Track {
    fn new(seam: Seam) -> Self {
        let length = seam.line.length();
        let chord = seam.line.point(0.0).distance(seam.line.point(length));
        Self {
            is_there: vec![false; seam.vertices.len()],
            is_bent: seam.line.is_closed() || chord < STRAIGHT * length,
            seam,
        }
    }

    fn n(&self) -> usize {
        self.seam.vertices.len()
    }

    /// Takes a step towards the place on the line, or half of one, if nothing folds; near to it
    /// the vertex is set there. Returns whether it is.
    fn approach(&self, sheet: &mut Sheet, i: usize, edge: f64) -> bool {
        let v = self.seam.vertices[i];
        let goal = self.seam.line.point(self.seam.at[i]);
        for is_last in [false, true] {
            let way = (goal - sheet.position(v)).clamp_length_max(STRIDE * edge);
            walk(sheet, v, way);
            let is_near = sheet.position(v).distance(goal) <= NEAR * edge;
            if is_near && lift_towards(sheet, v, goal, LEAST_QUALITY) == Some(0) {
                return true;
            }
            if !is_last {
                shove(sheet, v, way);
            }
        }
        false
    }

    fn slide(&mut self, sheet: &mut Sheet, stars: &Stars, is_even: bool) {
        let n = self.n() - 1;
        let whole = self.seam.line.length();
        for i in usize::from(!self.seam.line.is_closed())..n {
            let v = self.seam.vertices[i];
            let now = self.seam.at[i];
            let before = if i == 0 {
                self.seam.at[n - 1] - whole
            } else {
                self.seam.at[i - 1]
            };
            let ahead = self.seam.at[i + 1];
            if !self.is_there[i] {
                // Its neighbours would leave it no place.
                self.set(i, f64::midpoint(before, ahead));
                continue;
            }
            let gap = (ahead - now).min(now - before) * ROOM;
            let [back, on] = [now - gap, now + gap].map(|at| self.seam.line.point(at));
            let tangent = (on - back).normalize_or_zero();
            let star = stars.of(v);
            let sum: DVec3 = star.iter().map(|&u| sheet.position(u)).sum();
            let pull = (sum / star.len() as f64 - sheet.position(v)).dot(tangent);
            let even = if is_even && self.is_bent {
                EVENNESS * (f64::midpoint(before, ahead) - now)
            } else {
                0.0
            };
            let at = now + (DAMPING * pull + even).clamp(-gap.max(0.0), gap.max(0.0));
            if self.move_to(sheet, v, at) {
                self.set(i, at);
            }
        }
    }

    fn set(&mut self, i: usize, at: f64) {
        self.seam.at[i] = at;
        if i == 0 {
            let n = self.n() - 1;
            self.seam.at[n] = at + self.seam.line.length();
        }
    }

    /// Moves a vertex along the line unless that folds the sphere or spoils a face.
    fn move_to(&self, sheet: &mut Sheet, v: VertexId, at: f64) -> bool {
        let place = self.seam.line.point(at);
        let now = *sheet.point(v);
        let mut there = sheet.walked(v, place);
        there.position = place;
        let before = sheet.badness(v, &now, GUARDED_QUALITY);
        let after = sheet.badness(v, &there, GUARDED_QUALITY);
        after <= before && sheet.try_move(v, there)
    }
}
