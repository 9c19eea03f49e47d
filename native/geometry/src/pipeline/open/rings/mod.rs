//! Borders along which no line of edges lies: rings of edges are laid on them.
//!
//! A flow may miss lines that it was to meet, or none were asked for. What is virtual is known all the
//! same, by where quads lie on the sphere: the quads of a cap go, with some more until what is left has
//! no quad with two edges on the ring, and the ring goes onto the border in even steps.

mod hole;

use glam::DVec3;

use super::reopen::real_faces;
use super::{Opening, mend};
use crate::deform::Deformed;
use crate::flow::FirmEdges;
use crate::groups::Groups;
use crate::measure::{FeatureLine, Polyline};
use crate::mesh::{
    FaceId, FaceMap, HalfedgeId, HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId,
};
use crate::sphere_map::SphereMap;
use hole::Hole;

/// A cap that takes a larger share of the surface is the other side of a sheet: no ring goes round it.
const LARGEST: f64 = 0.25;
/// With fewer quads for each ring most lie beside one: a brick of ten holes and 400 quads comes out
/// better in pairs, a button of four and 350 with rings.
const QUADS_PER_RING: usize = 30;
/// At how many places of the border it is tried where the first vertex goes.
const N_TURNS: usize = 24;

/// Which face of an even surface belongs to which piece of what is real or virtual.
#[derive(Clone, Debug)]
pub struct Regions {
    /// The piece of each face.
    pub of: FaceMap<u32>,
    /// Which pieces are real.
    pub is_real: Vec<bool>,
    /// Points on the rim of each, and one of the sphere in it.
    rims: Vec<Vec<DVec3>>,
    middles: Vec<DVec3>,
    /// The share of all faces that each has.
    shares: Vec<f64>,
    /// The caps that are to get rings whatever lines are met.
    pub loose: Vec<u32>,
}

/// Which borders of a closed part need no lines of edges.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Loose {
    /// None.
    Nothing,
    /// Those of cuts.
    Cuts,
    /// All.
    All,
}

/// A cap that gets a ring.
struct Cap<'a> {
    region: u32,
    /// The border round it.
    line: &'a Polyline,
    /// A point of the sphere in it.
    middle: DVec3,
}

/// Quads that stay, and where the vertices of rings belong.
pub struct Ringed {
    pub is_kept: Vec<bool>,
    pub positions: Vec<DVec3>,
}

impl Regions {
    /// Those between firm edges.
    pub fn between(even: &SphereMap, firm: &FirmEdges) -> Self {
        let all = FaceMap::filled(even.mesh().n_faces(), true);
        let is_real = firm.real.as_ref().map_or(&all, |real| &real.is_real);
        Self::of(even, &firm.is_on, is_real)
    }

    /// The same with rings at all that is virtual.
    #[must_use]
    pub fn all_loose(self) -> Self {
        let caps = (0..self.is_real.len()).filter(|&r| !self.is_real[r]);
        Self {
            loose: caps.map(|r| r as u32).collect(),
            ..self
        }
    }

    /// Those between some edges.
    fn of(map: &SphereMap, is_between: &HalfedgeMap<bool>, real: &FaceMap<bool>) -> Self {
        let mesh = map.mesh();
        let mut groups = Groups::new(mesh.n_faces());
        for h in mesh.halfedge_ids().filter(|&h| !is_between[h]) {
            if let Some(twin) = mesh.twin(h) {
                groups.link(h.face().index(), twin.face().index());
            }
        }
        let (of, n) = groups.numbered();
        let mut regions = Self {
            of: FaceMap::from_vec(of),
            is_real: vec![true; n],
            rims: vec![Vec::new(); n],
            middles: vec![DVec3::ZERO; n],
            shares: vec![0.0; n],
            loose: Vec::new(),
        };
        for face in mesh.face_ids() {
            let region = regions.of[face] as usize;
            regions.is_real[region] = real[face];
            let middle: DVec3 = map.sphere_triangle(face).into_iter().sum();
            regions.middles[region] += middle.normalize_or_zero();
            regions.shares[region] += 1.0 / mesh.n_faces() as f64;
        }
        for h in mesh.halfedge_ids().filter(|&h| is_between[h]) {
            let region = regions.of[h.face()] as usize;
            regions.rims[region].push(mesh.position(mesh.origin(h)));
        }
        regions
    }

    /// The caps beside some edges, and those that get rings in any case; or why that are none.
    fn caps_at(&self, mesh: &TriangleMesh, unmet: &[HalfedgeId]) -> Result<Vec<u32>, String> {
        let mut caps = self.loose.clone();
        for &h in unmet {
            let sides = [Some(h), mesh.twin(h)].into_iter().flatten();
            let sides = sides.map(|h| self.of[h.face()]);
            let cap = sides.into_iter().find(|&r| !self.is_real[r as usize]);
            caps.push(cap.ok_or("a border has no virtual side")?);
        }
        caps.sort_unstable();
        caps.dedup();
        Ok(caps)
    }
}

impl Opening {
    /// The borders that need lines, on the map's mesh.
    pub fn firm_lines(&self, loose: Loose) -> Vec<FeatureLine> {
        let is_cut = |line: &FeatureLine| {
            let starts: Vec<DVec3> = line.segments().map(|[a, _]| a).collect();
            self.is_at_cut(&starts)
        };
        let lines = self.lines.iter().filter(|line| match loose {
            Loose::Nothing => true,
            Loose::Cuts => !is_cut(line),
            Loose::All => false,
        });
        lines.cloned().collect()
    }

    /// Whether some points of a border are those of a cut: no border is as near to them in the mean.
    fn is_at_cut(&self, points: &[DVec3]) -> bool {
        let off = |line: &Polyline| points.iter().map(|&p| line.distance(p)).sum::<f64>();
        let least = |lines: &[Polyline]| lines.iter().map(off).fold(f64::INFINITY, f64::min);
        least(&self.cuts) < least(&self.borders)
    }

    /// Whether rings can stand for lines: the border of a sheet lies in its plane in any case.
    pub fn can_be_loose(&self) -> bool {
        !self.ways_to_be_loose().is_empty()
    }

    /// Which borders may be without lines, fewer first.
    pub fn ways_to_be_loose(&self) -> &'static [Loose] {
        let n_cuts = 2 * self.cuts.len();
        let has_room = |n_rings: usize| n_rings > 0 && self.has_room(n_rings);
        if self.is_sheet() || self.has_tubes {
            return &[];
        }
        match (has_room(n_cuts), has_room(n_cuts + self.borders.len())) {
            (true, true) if !self.borders.is_empty() => &[Loose::Cuts, Loose::All],
            (true, _) => &[Loose::Cuts],
            (false, true) => &[Loose::All],
            (false, false) => &[],
        }
    }

    /// Whether there are quads enough for so many rings.
    pub fn has_room(&self, n_rings: usize) -> bool {
        n_rings * QUADS_PER_RING <= self.n_asked
    }

    /// The pieces of an even surface, as those of the map's mesh.
    pub fn regions(&self, map: &SphereMap, even: &SphereMap, loose: Loose) -> Regions {
        let own = Regions::of(map, &self.small, &real_faces(map.mesh(), &self.small));
        let is_loose = |r: usize| loose == Loose::All || self.is_at_cut(&own.rims[r]);
        let caps = (0..own.is_real.len()).filter(|&r| !own.is_real[r] && is_loose(r));
        let caps = caps.map(|r| r as u32).collect();
        let middle = |face| even.sphere_triangle(face).into_iter().sum::<DVec3>();
        let faces = even.mesh().face_ids();
        let located = faces.map(|face| own.of[map.locate(middle(face)).face]);
        Regions {
            of: located.collect(),
            loose: caps,
            ..own
        }
    }

    /// The quads that lie on what is real, where some borders have no line of edges; or why rings
    /// cannot go round these. Quads hang together in patches.
    pub fn ringed(
        &self,
        deformed: &Deformed,
        (even, regions): (&SphereMap, &Regions),
        (patches, unmet): (&[u32], &[HalfedgeId]),
    ) -> Result<Ringed, String> {
        let mesh = &deformed.mesh;
        let caps = regions.caps_at(even.mesh(), unmet)?;
        let middle = |face: &[VertexId]| -> DVec3 {
            face.iter()
                .map(|v| deformed.sphere[v.index()])
                .sum::<DVec3>()
        };
        let middles: Vec<DVec3> = mesh.faces().map(middle).collect();
        let located = middles.iter().map(|&at| regions.of[even.locate(at).face]);
        let region: Vec<u32> = located.collect();
        let n_patches = patches.iter().max().map_or(0, |&last| last as usize + 1);
        let mut votes = vec![0_i64; n_patches];
        for (&patch, &region) in patches.iter().zip(&region) {
            votes[patch as usize] += match regions.is_real[region as usize] {
                true => 1,
                false if caps.contains(&region) => 0,
                false => -1,
            };
        }
        let mut ringed = Ringed {
            is_kept: patches.iter().map(|&p| votes[p as usize] > 0).collect(),
            positions: mesh.positions().to_vec(),
        };
        let mut around = Around::new(mesh, &ringed.is_kept);
        for region_of_cap in caps {
            let cap = self.cap(regions, region_of_cap)?;
            let ring = around.ring(&cap, (&region, &middles))?;
            let now: Vec<DVec3> = ring.iter().map(|&v| mesh.position(v)).collect();
            for (&v, place) in ring.iter().zip(even_places(cap.line, &now)) {
                ringed.positions[v.index()] = place;
            }
        }
        let is_gone = around.is_gone;
        for (is_kept, is_gone) in ringed.is_kept.iter_mut().zip(is_gone) {
            *is_kept &= !is_gone;
        }
        Ok(ringed)
    }

    /// A cap by its piece of a surface.
    fn cap(&self, regions: &Regions, region: u32) -> Result<Cap<'_>, String> {
        let share = regions.shares[region as usize];
        if share > LARGEST {
            let share = 100.0 * share;
            return Err(format!(
                "what is virtual beyond a border has {share:.0} % of the faces"
            ));
        }
        let rim = &regions.rims[region as usize];
        let off = |line: &Polyline| rim.iter().map(|&p| line.distance(p)).sum::<f64>();
        let lines = self.cuts.iter().chain(&self.borders);
        let line = lines.min_by(|a, b| off(a).total_cmp(&off(b)));
        Ok(Cap {
            region,
            line: line.ok_or("a cap has no border")?,
            middle: regions.middles[region as usize].normalize_or(DVec3::Z),
        })
    }
}

/// Quads, and which of them have gone so far.
struct Around<'a> {
    mesh: &'a PolygonMesh,
    at: Vec<Vec<FaceId>>,
    is_kept: &'a [bool],
    is_gone: Vec<bool>,
    /// Vertices that no other ring may have.
    is_taken: Vec<bool>,
}

impl<'a> Around<'a> {
    fn new(mesh: &'a PolygonMesh, is_kept: &'a [bool]) -> Self {
        let at = mend::around(mesh);
        let is_border = |faces: &Vec<FaceId>| faces.iter().any(|face| !is_kept[face.index()]);
        Self {
            is_taken: at.iter().map(is_border).collect(),
            at,
            is_kept,
            is_gone: vec![false; mesh.n_faces()],
            mesh,
        }
    }

    /// Takes the quads of a cap out; the ring round them, they on its left.
    fn ring(
        &mut self,
        cap: &Cap<'_>,
        (region, middles): (&[u32], &[DVec3]),
    ) -> Result<Vec<VertexId>, String> {
        let is_free = |face: usize| {
            let mut corners = self.mesh.face(FaceId::from_index(face)).iter();
            self.is_kept[face] && corners.all(|v| !self.is_taken[v.index()])
        };
        let n = self.mesh.n_faces();
        let own: Vec<usize> = (0..n)
            .filter(|&f| region[f] == cap.region && is_free(f))
            .collect();
        let mut hole = Hole::new(self.mesh, &self.at, &own);
        if own.is_empty() {
            let near = |f: &usize| middles[*f].normalize_or_zero().dot(cap.middle);
            let free = (0..n).filter(|&f| is_free(f));
            let nearest = free.max_by(|a, b| near(a).total_cmp(&near(b)));
            hole.add(nearest.ok_or("there is no room for a ring")?);
        }
        hole.grow(is_free)?;
        let ring = hole.ring()?;
        for face in (0..n).filter(|&f| hole.is_in[f]) {
            self.is_gone[face] = true;
            for v in self.mesh.face(FaceId::from_index(face)) {
                self.is_taken[v.index()] = true;
            }
        }
        Ok(ring)
    }
}

/// Places on a closed line in even steps, either way round, near to where vertices in a row are.
pub(super) fn even_places(line: &Polyline, now: &[DVec3]) -> Vec<DVec3> {
    let n = now.len();
    let whole = line.length();
    let at = |turn: usize| {
        let first = whole * (turn / 2) as f64 / (n * N_TURNS) as f64;
        let way = if turn.is_multiple_of(2) { -1.0 } else { 1.0 };
        let place = |i: usize| (first + way * whole * i as f64 / n as f64).rem_euclid(whole);
        (0..n).map(|i| line.point(place(i))).collect::<Vec<_>>()
    };
    let off = |places: &Vec<DVec3>| -> f64 {
        let pairs = places.iter().zip(now);
        pairs.map(|(a, b)| a.distance_squared(*b)).sum()
    };
    let all = (0..2 * n * N_TURNS).map(at);
    let best = all.min_by(|a, b| off(a).total_cmp(&off(b)));
    best.unwrap_or_else(|| now.to_vec())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::elementary::sin_cos;
    use crate::measure::angle_between;

    #[test]
    fn a_ring_goes_onto_its_border_in_even_steps_whichever_way_round() {
        let round = |n: usize, radius: f64, way: f64| -> Vec<DVec3> {
            let at = |i: usize| sin_cos(way * (i as f64 / n as f64 + 0.07) * TAU);
            (0..n)
                .map(|i| radius * DVec3::from((at(i).1, at(i).0, 0.0)))
                .collect()
        };
        let line = Polyline::new(
            [round(64, 2.0, 1.0), vec![round(64, 2.0, 1.0)[0]]].concat(),
            true,
        );
        for way in [1.0, -1.0] {
            let now = round(8, 1.5, way);
            for (place, now) in even_places(&line, &now).iter().zip(&now) {
                assert!((place.length() - 2.0).abs() < 0.01);
                assert!(angle_between(*place, *now) < 0.05, "{place} {now}");
            }
        }
    }
}
