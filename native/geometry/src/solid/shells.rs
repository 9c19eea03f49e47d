//! What each shell that has borders is: a wall of a body, or a sheet that bounds nothing.
//!
//! Just behind a wall the winding number of all open shells is near 1, just before it near 0; on the
//! wall it is near ½. On a sheet by itself it is near 0. A wall that faces inward shows by the sign.

use glam::DVec3;
use rayon::prelude::*;

use super::Report;
use super::winding::Winding;
use crate::mesh::{Id, TriangleMesh, bounds};

/// The mean winding number on a shell from which on it is a wall: on half a ball it is 0.31, on a
/// third of one 0.22. Above, bowls that are to be filled become skins; below, capes become bodies.
const WALL: f64 = 0.25;
/// Places of a shell that are looked at, at most: enough for a mean.
const N_PLACES: usize = 256;
/// Rounds of turning shells that face inward; each may show more of them.
const N_ROUNDS: usize = 3;

/// What the triangles of the shells are.
pub struct Sorted {
    /// Which triangles face inward.
    pub is_turned: Vec<bool>,
    /// Which belong to walls with borders.
    pub is_wall: Vec<bool>,
    /// Which triangles belong to sheets.
    pub is_sheet: Vec<bool>,
    pub n_closed: usize,
    pub n_walls: usize,
    pub n_sheets: usize,
    /// How many sheets are too small to be made thick.
    pub n_scraps: usize,
    /// How many of the walls were turned.
    pub n_turned: usize,
}

impl Sorted {
    pub fn n_shells(&self) -> usize {
        self.n_closed + self.n_walls + self.n_sheets + self.n_scraps
    }

    /// A report with what is known of the shells.
    pub fn report(&self, report: Report) -> Report {
        Report {
            n_shells: self.n_shells(),
            n_closed: self.n_closed,
            n_walls: self.n_walls,
            n_turned: self.n_turned,
            n_sheets: self.n_sheets,
            n_scraps: self.n_scraps,
            ..report
        }
    }
}

/// Sorts the components of a mesh, and loose triangles after it, which are a shell by themselves.
/// Sheets shorter than `scrap` are scraps.
pub fn sort(mesh: &TriangleMesh, triangles: &[[DVec3; 3]], scrap: f64) -> Sorted {
    let (component, n) = mesh.face_components();
    let n_loose = triangles.len() - mesh.n_faces();
    let mut is_open = vec![false; n];
    for h in mesh.halfedge_ids().filter(|&h| mesh.twin(h).is_none()) {
        is_open[component[h.face().index()] as usize] = true;
    }
    is_open.extend((n_loose > 0).then_some(true));
    let name = |i: usize| component.get(i).map_or(n, |&c| c as usize);
    let mut open: Vec<Vec<u32>> = vec![Vec::new(); is_open.len()];
    for i in (0..triangles.len()).filter(|&i| is_open[name(i)]) {
        open[name(i)].push(i as u32);
    }
    let n_closed = is_open.iter().filter(|is_open| !**is_open).count();
    open.retain(|shell| !shell.is_empty());
    let mut shells = Shells {
        triangles,
        is_turned: vec![false; open.len()],
        open,
    };
    let means = shells.turned();
    let mut sorted = Sorted {
        is_turned: inside_out(mesh, (&component, n), triangles.len()),
        is_wall: vec![false; triangles.len()],
        is_sheet: vec![false; triangles.len()],
        n_closed,
        n_walls: 0,
        n_sheets: 0,
        n_scraps: 0,
        n_turned: 0,
    };
    for (i, mean) in means.into_iter().enumerate() {
        if mean >= WALL {
            for &t in &shells.open[i] {
                sorted.is_wall[t as usize] = true;
                sorted.is_turned[t as usize] = shells.is_turned[i];
            }
            sorted.n_walls += 1;
            sorted.n_turned += usize::from(shells.is_turned[i]);
        } else if shells.length(i) < scrap {
            sorted.n_scraps += 1;
        } else {
            shells.open[i]
                .iter()
                .for_each(|&t| sorted.is_sheet[t as usize] = true);
            sorted.n_sheets += 1;
        }
    }
    sorted
}

/// Which triangles are of closed components with a negative volume.
fn inside_out(mesh: &TriangleMesh, (component, n): (&[u32], usize), n_all: usize) -> Vec<bool> {
    let mut volumes = vec![0.0; n];
    let middle = bounds(mesh.positions());
    let middle = middle[0].midpoint(middle[1]);
    for (face, &of) in mesh.face_ids().zip(component) {
        let [a, b, c] = mesh.triangle(face).map(|p| p - middle);
        volumes[of as usize] += a.dot(b.cross(c));
    }
    for h in mesh.halfedge_ids().filter(|&h| mesh.twin(h).is_none()) {
        volumes[component[h.face().index()] as usize] = 0.0;
    }
    let is_turned = component.iter().map(|&c| volumes[c as usize] < 0.0);
    let mut is_turned: Vec<bool> = is_turned.collect();
    is_turned.resize(n_all, false);
    is_turned
}

/// Shells with borders.
struct Shells<'a> {
    triangles: &'a [[DVec3; 3]],
    open: Vec<Vec<u32>>,
    is_turned: Vec<bool>,
}

impl Shells<'_> {
    fn of(&self, shell: usize) -> impl Iterator<Item = [DVec3; 3]> {
        let is_turned = self.is_turned[shell];
        let own = self.open[shell].iter().map(|&i| self.triangles[i as usize]);
        own.map(move |[a, b, c]| if is_turned { [a, c, b] } else { [a, b, c] })
    }

    /// The diagonal of its box.
    fn length(&self, shell: usize) -> f64 {
        let corners: Vec<DVec3> = self.of(shell).flatten().collect();
        let [low, high] = bounds(&corners);
        low.distance(high)
    }

    /// Turns those that face inward, and gives the mean winding number on each.
    fn turned(&mut self) -> Vec<f64> {
        if self.open.is_empty() {
            return Vec::new();
        }
        let mut round = 0;
        loop {
            let all: Vec<_> = (0..self.open.len()).flat_map(|i| self.of(i)).collect();
            let winding = Winding::new(&all);
            let shells: Vec<usize> = (0..self.open.len()).collect();
            let means: Vec<f64> = shells.par_iter().map(|&i| self.mean(i, &winding)).collect();
            let inward = |i: &usize| means[*i] <= -WALL;
            let inward: Vec<usize> = shells.iter().copied().filter(inward).collect();
            round += 1;
            if inward.is_empty() || round > N_ROUNDS {
                return means;
            }
            for i in inward {
                self.is_turned[i] = !self.is_turned[i];
            }
        }
    }

    /// The mean winding number on a shell by area: 0 for a sheet, ½ for a wall.
    fn mean(&self, shell: usize, winding: &Winding) -> f64 {
        let step = self.open[shell].len().div_ceil(N_PLACES);
        let (sum, whole) =
            self.of(shell)
                .step_by(step)
                .fold((0.0, 0.0), |(sum, whole), [a, b, c]| {
                    let area = (b - a).cross(c - a).length();
                    (sum + area * winding.number((a + b + c) / 3.0), whole + area)
                });
        if whole > 0.0 { sum / whole } else { 0.0 }
    }
}
