//! Where quads cannot flow: triangles of the part are paired into quads.
//!
//! Two ways lead there. Even triangles, a quarter of what is needed, are paired and cut in four: that
//! is regular, but limbs thinner than their edges are lost. The input's own triangles, brought to
//! twice the count and embedded, are paired as they are: less regular, but as long as a wire's are.

use super::clock::Clock;
use super::even::{either_side, triangles};
use super::ground::Ground;
use super::laid::Laid;
use super::part::{Wanted, embed_mesh};
use crate::deform::{self, Deformed, Held};
use crate::mesh::{VertexId, VertexMap};
use crate::pair::{self, Paired, Stay};
use crate::pipeline;
use crate::progress::{Cancelled, Progress};
use crate::sphere;
use crate::sphere_map::SphereMap;
use crate::{decimate, embed, measure};

/// How often triangles are made, so that their pairs have the count.
const N_TRIES: usize = 3;
/// The share that the count may be off before they are made again.
const NEAR_COUNT: f64 = 0.02;
/// Of fewer quads the quad sphere's are as good, and their count is nearer.
const FEWEST: usize = 24;

/// Quads of paired triangles, or why there are none.
pub fn paired(
    wanted: &Wanted<'_>,
    (map, ground): (&SphereMap, &Ground),
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Result<Laid, String>, Cancelled> {
    if wanted.n_faces < FEWEST && ground.opening.is_none() {
        let reason = format!("{} quads are too few to be pairs", wanted.n_faces);
        return Ok(Err(reason));
    }
    let part = progress.part("", 0.0, 0.5);
    let quarters = told(quarters(wanted, (map, ground), clock, &part))?;
    // The part's own triangles have no other borders than those that virtual ones have.
    if quarters.as_ref().is_ok_and(Laid::is_good) || ground.opening.is_some() {
        return Ok(quarters);
    }
    let part = progress.part("", 0.5, 1.0);
    let own = told(own(wanted, (map, ground), clock, &part))?;
    Ok(match (quarters, own) {
        (Ok(quarters), Ok(own)) if quarters.is_worse_than(&own) => Ok(own),
        (quarters, own) => quarters.or(own),
    })
}

/// Triangles in pairs, with their own map to the sphere.
struct Pairs {
    map: SphereMap,
    paired: Paired,
    report: Option<sphere::Report>,
    /// How many quads lie on what is real in the end.
    n_quads: f64,
}

/// What makes pairs of so many triangles.
type Source<'a> = dyn FnMut(usize, &Progress<'_>) -> Result<Pairs, pipeline::Error> + 'a;

/// Pairs whose count is near what is wanted: where vertices of two quads were taken out more triangles
/// are asked for. It begins with a number of them.
fn counted(
    (wanted, n_faces): (usize, f64),
    make: &mut Source<'_>,
    progress: &Progress<'_>,
) -> Result<Pairs, pipeline::Error> {
    let even = |n: f64| 2 * (n / 2.0).round().max(2.0) as usize;
    let mut n_faces = even(n_faces);
    let mut pairs = make(n_faces, &progress.part("", 0.0, 0.5))?;
    for _ in 1..N_TRIES {
        let share = wanted as f64 / pairs.n_quads.max(1.0);
        let next = even(share * n_faces as f64);
        if (share - 1.0).abs() < NEAR_COUNT || next == n_faces {
            break;
        }
        n_faces = next;
        pairs = make(n_faces, &progress.part("", 0.5, 1.0))?;
    }
    Ok(pairs)
}

/// Even triangles, paired and cut in four.
fn quarters(
    wanted: &Wanted<'_>,
    (map, ground): (&SphereMap, &Ground),
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Laid, pipeline::Error> {
    let mut make = |n_faces: usize, progress: &Progress<'_>| {
        let part = progress.part("", 0.0, 0.8);
        let (even, held, report) = even(wanted, (map, ground), n_faces, (clock, &part))?;
        let real = ground.real_share(map, (&even.mesh, &even.sphere), &held.edges, &part)?;
        let mesh = triangles(&even.mesh);
        let kept = either_side(&mesh, &even.features);
        let firm = ground
            .opening
            .as_ref()
            .map(|_| either_side(&mesh, &held.edges));
        let own = SphereMap::prove(mesh, VertexMap::from_vec(even.sphere));
        let own = own.map_err(embed::Error::from)?;
        let part = progress.part("pair", 0.8, 1.0);
        let paired = clock.step("pair", || {
            let (kept, firm) = (&kept, firm.as_ref());
            pair::pair(&own, Stay { kept, firm }, &part)
        })?;
        Ok(Pairs {
            map: own,
            n_quads: paired.n_once_split() as f64 * real,
            paired,
            report: Some(report),
        })
    };
    let part = progress.part("", 0.0, 0.7);
    let count = (ground.n_asked(wanted), wanted.n_faces as f64 / 2.0);
    let mut pairs = counted(count, &mut make, &part)?;
    pairs.paired = pair::split(&pairs.paired);
    pairs.lay((map, ground), clock, &progress.part("deform", 0.7, 1.0))
}

/// Even triangles on a part, so many, and which of their edges were made along borders.
fn even(
    wanted: &Wanted<'_>,
    (map, ground): (&SphereMap, &Ground),
    n_faces: usize,
    (clock, progress): (&mut Clock, &Progress<'_>),
) -> Result<(Deformed, Held, sphere::Report), pipeline::Error> {
    let lines = ground.lines();
    let density = VertexMap::filled(map.mesh().n_vertices(), 1.0);
    let settings = sphere::Settings {
        n_faces,
        seed: wanted.settings.seed,
        ..sphere::Settings::default()
    };
    let part = progress.part("sphere", 0.0, 0.6);
    let sized = || sphere::sized(map, (&density, lines), &settings, &part);
    let made = clock.step("sphere", sized)?;
    let held = ground.held(map, &made, &part)?;
    let primitive = (&made.primitive, &held);
    let part = progress.part("deform", 0.6, 1.0);
    let settings = deform::Settings {
        separates: false,
        ..ground.deform()
    };
    let even = clock.step("deform", || {
        deform::deform_held(map, primitive, &ground.target, &settings, &part)
    })?;
    Ok((even, held, made.report))
}

/// The part's own triangles, more or fewer, paired.
fn own(
    wanted: &Wanted<'_>,
    (map, ground): (&SphereMap, &Ground),
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Laid, pipeline::Error> {
    let mut make = |n_faces: usize, progress: &Progress<'_>| {
        let part = progress.part("decimate", 0.0, 0.3);
        let mesh = clock.step("decimate", || {
            let mesh = ground.target.mesh();
            if mesh.n_faces() > n_faces {
                let settings = decimate::Settings { n_faces };
                return Ok(decimate::simplify(mesh, &settings, &part)?.mesh);
            }
            Ok::<_, pipeline::Error>(pair::refine(mesh, n_faces, &part)?)
        })?;
        let kept = measure::sharp_edges(&mesh, wanted.settings.sharp_angle.to_radians());
        let part = progress.part("embed", 0.3, 0.8);
        let embedded = clock.step("embed", || embed_mesh(mesh, wanted.predictor, &part))?;
        let part = progress.part("pair", 0.8, 1.0);
        let paired = clock.step("pair", || {
            let (kept, firm) = (&kept, None);
            pair::pair(&embedded.map, Stay { kept, firm }, &part)
        })?;
        Ok(Pairs {
            map: embedded.map,
            n_quads: paired.quads.n_faces() as f64,
            paired,
            report: None,
        })
    };
    let part = progress.part("", 0.0, 0.7);
    let pairs = counted(
        (wanted.n_faces, 2.0 * wanted.n_faces as f64),
        &mut make,
        &part,
    )?;
    pairs.lay((map, ground), clock, &progress.part("deform", 0.7, 1.0))
}

impl Pairs {
    /// Lays them on the target of a map; where there are borders they cover the same sphere.
    fn lay(
        self,
        (map, ground): (&SphereMap, &Ground),
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Laid, pipeline::Error> {
        let usual = deform::Settings::default();
        // Vertices that were the part's own are where they belong, and wires thinner than a quad would
        // be torn by a fit.
        let settings = deform::Settings {
            n_straddles: if self.report.is_some() {
                usual.n_straddles
            } else {
                0
            },
            ..ground.deform()
        };
        let Paired { quads, kept, firm } = &self.paired;
        let at = |v: VertexId| {
            let place = self.map.locate(quads.position(v));
            self.map.surface_position(place)
        };
        let mut held = match &ground.opening {
            Some(opening) => opening.held_at(firm, at, progress)?,
            None => Held::default(),
        };
        held.edges.extend(kept);
        held.edges.sort_unstable();
        held.edges.dedup();
        let quads = (quads, &held);
        let deformed = clock.step("deform", || {
            deform::lay(&self.map, quads, &ground.target, &settings, progress)
        })?;
        let deformed = ground.opened(map, deformed, firm, progress)?;
        let deformed = deformed.map_err(|reason| pipeline::Error::Unopened { reason })?;
        Ok(Laid::new(deformed, self.report, ground.bare()))
    }
}

/// Splits a cancellation, which ends the run, from the reasons to use something else.
pub(super) fn told<T>(result: Result<T, pipeline::Error>) -> Result<Result<T, String>, Cancelled> {
    match result {
        Ok(value) => Ok(Ok(value)),
        Err(pipeline::Error::Cancelled(cancelled)) => Err(cancelled),
        Err(pipeline::Error::Unopened { reason }) => Ok(Err(reason)),
        Err(error) => Ok(Err(error.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DVec3;

    use super::*;
    use crate::deform::Target;
    use crate::elementary::sin_cos;
    use crate::embed::Solver;
    use crate::mesh::{TriangleMesh, VertexId};
    use crate::pipeline::Settings;
    use crate::pipeline::density::Density;
    use crate::pipeline::marks::Marks;
    use crate::pipeline::mirror::Role;
    use crate::shapes;
    use crate::sphere_map::check_cover;

    /// So many quads of a mesh that do not flow.
    fn quads(mesh: &TriangleMesh, n_faces: usize) -> Laid {
        let (marks, density) = (Marks::default(), Density::default());
        let wanted = Wanted {
            n_faces,
            settings: &Settings::default(),
            predictor: &Solver::default(),
            mirror: (&Role::Alone(None), None),
            reduced: None,
            marks: &marks,
            sides: &marks,
            line: &marks,
            density: &density,
            strokes: crate::pipeline::strokes::OnPart::none(),
            has_tubes: false,
            is_one_of_many: false,
        };
        let quiet = Progress::none();
        let map = embed_mesh(mesh.clone(), wanted.predictor, &quiet).unwrap();
        let target = Target::new(mesh.clone(), &quiet).unwrap();
        let ground = Ground::closed(target);
        let laid = paired(&wanted, (&map.map, &ground), &mut Clock::default(), &quiet);
        laid.unwrap().unwrap()
    }

    /// A wire of six sides, wound up: as long as 400 times its thickness.
    fn wire(n_turns: u32) -> TriangleMesh {
        const SIDES: u32 = 6;
        const STEPS: u32 = 14;
        let n = n_turns * STEPS;
        let point = |i: u32, j: u32| {
            let (sin, cos) = sin_cos(f64::from(i) * TAU / f64::from(STEPS));
            let (side, up) = sin_cos(f64::from(j) * TAU / f64::from(SIDES));
            let height = 0.25 * f64::from(i) / f64::from(STEPS);
            let out = DVec3::new(cos, sin, 0.0);
            out * (1.0 + 0.04 * up) + DVec3::Z * (height + 0.04 * side)
        };
        let all = (0..=n).flat_map(|i| (0..SIDES).map(move |j| point(i, j)));
        let mut points: Vec<DVec3> = all.collect();
        let id = |i: u32, j: u32| VertexId(i * SIDES + j % SIDES);
        let mut faces = Vec::new();
        for (i, j) in (0..n).flat_map(|i| (0..SIDES).map(move |j| (i, j))) {
            let [a, b, c, d] = [id(i, j), id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)];
            faces.extend([[a, c, b], [a, d, c]]);
        }
        for (i, turn) in [(0, false), (n, true)] {
            let middle = VertexId(points.len() as u32);
            points.push((point(i, 0) + point(i, 3)) / 2.0);
            faces.extend((0..SIDES).map(|j| {
                let [a, b] = [id(i, j), id(i, j + 1)];
                if turn { [middle, b, a] } else { [middle, a, b] }
            }));
        }
        TriangleMesh::new(points, faces).unwrap()
    }

    fn check(name: &str, laid: &Laid, n_wanted: usize) {
        let mesh = &laid.deformed.mesh;
        let n = mesh.n_faces();
        assert_eq!((mesh.n_quads(), mesh.n_vertices()), (n, n + 2), "{name}");
        assert!(20 * n.abs_diff(n_wanted) <= n_wanted, "{name}: {n}");
        assert_eq!(laid.n_inverted(), 0, "{name}");
        assert_eq!(check_cover(mesh, &laid.deformed.sphere), Ok(()), "{name}");
    }

    #[test]
    fn blobs_and_limbs_get_near_quads_none_of_which_is_inverted() {
        let blobs = [1, 2].map(|seed| ("blob", shapes::blob(seed, 10)));
        for (name, mesh) in blobs.into_iter().chain([("limbs", shapes::limbs(1, 10))]) {
            let laid = quads(&mesh, 400);
            check(name, &laid, 400);
            assert!(laid.off < 1.0, "{name}: {}", laid.off);
        }
    }

    #[test]
    fn a_thin_wire_gets_long_quads_none_of_which_is_inverted() {
        for n_faces in [600, 1_000] {
            let laid = quads(&wire(8), n_faces);
            check("wire", &laid, n_faces);
            assert!(laid.off < 1.0, "{}", laid.off);
        }
    }
}
