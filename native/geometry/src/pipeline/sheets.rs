//! Thin closed sheets: cloth, fins, blades.
//!
//! The rim of a sheet a twentieth as thick as a quad is long are two sharp lines with nothing
//! between them: triangles that show the sheet do not show its rim, and quads cut it into teeth. So
//! the sheet is made as thick as a quad first, by moving its sides apart; it is a box then, and one
//! row of quads goes along its rim. They are brought back side by side.

use glam::DVec3;

use super::Error;
use super::flow::Asked;
use super::flowed::{Flowed, FlowedPart};
use super::mirror::even_out;
use super::part::embed_mesh;
use super::probe::n_missed;
use super::rods::images;
use super::sides::{Sheet, cut};
use crate::deform::{self, Deformed, Target};
use crate::embed::Solver;
use crate::measure::{area_vector, face_normals, sharp_edges, total_area, volume};
use crate::mesh::{FaceId, FaceMap, TriangleMesh, VertexMap};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// Thicker sheets, in edges of quads, flow as they are.
const THIN: f64 = 0.4;
/// How thick they are made, in edges of quads: below, lines of the two sides end too near each
/// other; above, two rows of quads go along the rim.
const THICK: f64 = 1.0;
/// A sheet has this share of its area on its sides.
const SIDES: f64 = 0.7;
/// The other side is where it should be but for this share of the thickness.
const OFF: f64 = 0.8;
/// And looks the other way: the cosine between the normals.
const AWAY: f64 = -0.5;
/// Where sides are made alike the count may be off by one in so many.
const COUNT: usize = 25;
/// Rounds in which what lies between the sides is spread.
const N_ROUNDS: usize = 60;

/// A sheet that was made thick.
pub struct Thick {
    pub map: SphereMap,
    pub target: Target,
    /// Which of its faces lie on sides.
    is_side: FaceMap<bool>,
}

impl Thick {
    /// The part made as thick as a quad, if it is a sheet thinner than one.
    pub fn new(
        map: &SphereMap,
        target: &Target,
        asked: Asked<'_>,
        progress: &Progress<'_>,
    ) -> Result<Option<Self>, Cancelled> {
        let mesh = target.mesh();
        let area = total_area(mesh);
        let edge = (area / asked.n_quads.max(1) as f64).sqrt();
        let thickness = 2.0 * volume(mesh) / area;
        // Nor is what has no area, whose thickness is no number.
        let is_thin = thickness > 0.0 && thickness <= THIN * edge;
        if !is_thin {
            return Ok(None);
        }
        let apart = 0.5 * (THICK * edge - thickness);
        let Some((full, is_side)) = moved_apart(mesh, [thickness, apart], progress)? else {
            return Ok(None);
        };
        let Some((coarse, _)) = moved_apart(map.mesh(), [thickness, apart], progress)? else {
            return Ok(None);
        };
        let Ok(map) = SphereMap::prove(coarse, map.sphere().clone()) else {
            return Ok(None);
        };
        let sharp = sharp_edges(&full, asked.settings.sharp_angle.to_radians());
        let either = sharp.iter().zip(asked.marked).map(|(a, b)| a | b);
        let target = Target::with_features(full, &either.collect(), progress)?;
        Ok(Some(Self {
            map,
            target,
            is_side,
        }))
    }

    /// Quads of the thick sheet brought back onto the thin one.
    pub fn thinned(
        &self,
        mut part: FlowedPart,
        (target, asked): (&Target, Asked<'_>),
        progress: &Progress<'_>,
    ) -> Result<FlowedPart, Error> {
        let laid = match self.alike((&part.deformed, target), asked.n_quads, progress)? {
            Some(laid) => laid,
            None => self.side_by_side(&part.deformed, target, progress)?,
        };
        let mut deformed = Deformed {
            report: deform::Report {
                n_inverted: laid.report.n_inverted,
                n_crossing: laid.report.n_crossing,
                n_crossing_left: laid.report.n_crossing_left,
                ..part.deformed.report
            },
            ..laid
        };
        if let (Some(axis), Some(Ok(()))) = (asked.axis, &part.mirrored) {
            match images(&deformed.mesh, axis) {
                Some(images) => deformed = even_out(&deformed, &images, axis, target),
                None => part.mirrored = Some(Err("the sheet is no longer its own image".into())),
            }
        }
        if let Flowed::Used { flow, .. } = &mut part.flowed {
            flow.n_quads = deformed.mesh.n_faces();
        }
        Ok(FlowedPart {
            n_missed: n_missed(&deformed.mesh, target),
            n_unmet: 0,
            deformed,
            ..part
        })
    }

    /// The quads of one side on both; none where they are no sides with one row between, or where
    /// the count would be off.
    fn alike(
        &self,
        (quads, target): (&Deformed, &Target),
        n_wanted: usize,
        progress: &Progress<'_>,
    ) -> Result<Option<Deformed>, Error> {
        let sheet = Sheet {
            thin: target,
            thick: &self.target,
            is_side: &self.is_side,
        };
        let Some(alike) = sheet.alike(quads, n_wanted) else {
            return Ok(None);
        };
        let n_off = alike.mesh.n_faces().abs_diff(n_wanted);
        let Some(cut) = cut(&alike.mesh).filter(|_| n_off * COUNT <= n_wanted) else {
            return Ok(None);
        };
        let map = embed_mesh(cut, &Solver::default(), &progress.part("embed", 0.9, 1.0))?.map;
        let sphere = map.sphere().iter().copied().collect();
        let laid = Deformed::laid(alike.mesh, sphere, alike.on_lines, progress)?;
        Ok(Some(laid))
    }

    /// Every vertex where it belongs.
    fn side_by_side(
        &self,
        thick: &Deformed,
        target: &Target,
        progress: &Progress<'_>,
    ) -> Result<Deformed, Error> {
        let back = |&p: &DVec3| {
            let at = self.target.bvh().closest(p);
            let corners = target.mesh().triangle(at.face);
            corners.iter().zip(at.weights).map(|(&c, w)| c * w).sum()
        };
        let positions = thick.mesh.positions().iter().map(back).collect();
        let mesh = thick.mesh.with_positions(positions);
        let (sphere, features) = (thick.sphere.clone(), thick.features.clone());
        Ok(Deformed::laid(mesh, sphere, features, progress)?)
    }
}

/// A sheet whose sides are moved so far out each; none if it is no sheet of about the thickness.
fn moved_apart(
    mesh: &TriangleMesh,
    [thickness, apart]: [f64; 2],
    progress: &Progress<'_>,
) -> Result<Option<(TriangleMesh, FaceMap<bool>)>, Cancelled> {
    let normals = face_normals(mesh);
    let tree = Bvh::build_of_mesh(mesh, progress)?;
    let is_side = |face: FaceId| {
        let [a, b, c] = mesh.triangle(face);
        let normal = normals[face];
        let below = (a + b + c) / 3.0 - normal * thickness;
        let is_other = |other: FaceId| normals[other].dot(normal) < AWAY;
        let reach = (OFF * thickness).powi(2);
        tree.closest_where(below, reach, is_other).is_some()
    };
    let is_side: FaceMap<bool> = mesh.face_ids().map(is_side).collect();
    progress.check()?;
    let area = |face: FaceId| area_vector(mesh.triangle(face)).length();
    let sides: f64 = mesh.face_ids().filter(|&f| is_side[f]).map(area).sum();
    if sides < SIDES * total_area(mesh) {
        return Ok(None);
    }
    let ways = ways(mesh, &normals, &is_side);
    let positions = mesh.positions().iter().zip(ways.iter());
    let positions = positions.map(|(&p, &way)| p + way * apart).collect();
    Ok(Some((mesh.with_positions(positions), is_side)))
}

/// The way out of every vertex of a side; those between the sides go with their neighbours.
fn ways(
    mesh: &TriangleMesh,
    normals: &FaceMap<DVec3>,
    is_side: &FaceMap<bool>,
) -> VertexMap<DVec3> {
    let mut ways = VertexMap::filled(mesh.n_vertices(), DVec3::ZERO);
    let mut is_between = VertexMap::filled(mesh.n_vertices(), true);
    for v in mesh.vertex_ids() {
        for h in mesh.outgoing(v).filter(|h| is_side[h.face()]) {
            let corners = mesh.triangle(h.face());
            ways[v] += normals[h.face()] * area_vector(corners).length();
            is_between[v] = false;
        }
        // Where both sides meet in an edge they stay there.
        let whole: f64 = mesh
            .outgoing(v)
            .filter(|h| is_side[h.face()])
            .map(|h| area_vector(mesh.triangle(h.face())).length())
            .sum();
        ways[v] /= whole.max(f64::MIN_POSITIVE);
    }
    for _ in 0..N_ROUNDS {
        for v in mesh.vertex_ids().filter(|&v| is_between[v]) {
            let (sum, n) = mesh
                .neighbours(v)
                .fold((DVec3::ZERO, 0.0), |(sum, n), u| (sum + ways[u], n + 1.0));
            ways[v] = sum / n;
        }
    }
    ways
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::sin;
    use crate::embed::Solver;
    use crate::pipeline::{Input, Settings, remesh};
    use crate::shapes::{mapped_cube, polygons};

    #[test]
    fn a_thin_wavy_sheet_keeps_its_hem() {
        let wave = |p: DVec3| DVec3::new(p.x, 0.7 * p.y, 0.004 * p.z + 0.08 * sin(2.0 * p.x));
        let mesh = mapped_cube(6, wave);
        let input = polygons(&mesh);
        let settings = Settings {
            faces: 400,
            ..Settings::default()
        };
        let run = remesh(
            Input::new(&input),
            &settings,
            &Solver::default(),
            &Progress::none(),
        );
        let run = run.unwrap();
        let part = &run.report.parts[0];
        assert_eq!(part.deform.n_inverted, 0);
        let quads: Vec<[DVec3; 3]> = run
            .mesh
            .faces()
            .flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]])
            .map(|t| t.map(|v| run.mesh.position(v)))
            .collect();
        let tree = Bvh::new(&quads);
        let gaps = mesh.positions().iter();
        let gaps = gaps.map(|&p| tree.closest(p).distance_squared.sqrt());
        let farthest = gaps.fold(0.0, f64::max);
        assert!(farthest < 0.01, "{farthest}");
        assert_eq!(part.deform.n_crossing_left, 0);
    }
}
