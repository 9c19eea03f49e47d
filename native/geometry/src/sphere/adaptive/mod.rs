//! Triangles placed where a surface needs them.

mod creases;
mod relax;
mod sample;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use creases::Creases;

use super::net::Net;
use crate::measure::FeatureLine;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::random::Random;
use crate::sphere_map::{SphereMap, SurfacePoint, check_cover};

/// What [`adaptive`] shall make.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// How many triangles; an odd number is met less one, and there are never fewer than four.
    pub n_faces: usize,
    /// Equal seeds give equal meshes.
    pub seed: u64,
    /// How many rounds of moves and flips. Eight bring the edges within 2 % of where they end up;
    /// below four, irregular clusters of the random start stay.
    pub n_rounds: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            n_faces: 6000,
            seed: 0,
            n_rounds: 8,
        }
    }
}

/// What [`adaptive`] did.
#[derive(Clone, PartialEq, Debug, Default, Serialize)]
pub struct Report {
    /// How many vertices were placed.
    pub n_vertices: usize,
    /// How many triangles they have.
    pub n_faces: usize,
    /// How many edges were flipped after the vertices were placed.
    pub n_flips: usize,
    /// How many moves of single vertices were made along the surface.
    pub n_moves: usize,
    /// How many moves would have folded a triangle on the sphere, however short.
    pub n_refused_moves: usize,
}

/// A primitive made for one surface.
#[derive(Clone, Debug)]
pub struct Adaptive {
    /// Triangles with vertices on the unit sphere; they are even on the surface, not there.
    pub primitive: PolygonMesh,
    /// Its edges along lines, each once, smaller end first, in order.
    pub on_lines: Vec<[VertexId; 2]>,
    /// How many neighbours on a line no edge could join.
    pub n_apart: usize,
    /// What was done.
    pub report: Report,
}

/// Why there is no [`Adaptive`] primitive.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum AdaptiveError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Triangles on the sphere became too small for more vertices.
    #[error("only {n_placed} of {n_wanted} vertices found room on the sphere; ask for fewer faces")]
    NoRoom {
        /// How many could be placed.
        n_placed: usize,
        /// How many were wanted.
        n_wanted: usize,
    },
}

/// Makes a primitive whose triangles are even on the surface of a map.
///
/// Vertices are placed on the surface, evenly by area, and joined by the Delaunay triangulation of
/// their points on the sphere. Rounds of edge flips (Delaunay on the surface, and towards valence
/// 6) and moves of each vertex to the middle of its ring, along the surface, follow. A flip or move
/// that would fold a triangle on the sphere is refused, so the sphere stays covered once. What
/// lies close in space but not on the surface never mixes. Cost: linear, 5 µs a face.
///
/// # Errors
/// Cancelled, or the vertices find no room on a map that is distorted beyond what numbers hold.
pub fn adaptive(
    map: &SphereMap,
    settings: &Settings,
    progress: &Progress,
) -> Result<Adaptive, AdaptiveError> {
    let density = VertexMap::filled(map.mesh().n_vertices(), 1.0);
    sized(map, (&density, &[]), settings, progress)
}

/// The same with a wish for each vertex of the map's mesh: faces per area in proportion to
/// `density`, which must be positive. Lines of the map's mesh get vertices and edges all along them, in
/// place of others near by; the number of faces is then met roughly.
///
/// # Errors
/// As [`adaptive`].
pub fn sized(
    map: &SphereMap,
    (density, lines): (&VertexMap<f64>, &[FeatureLine]),
    settings: &Settings,
    progress: &Progress,
) -> Result<Adaptive, AdaptiveError> {
    let n_vertices = settings.n_faces.max(4) / 2 + 2;
    let mut random = Random::new(settings.seed);
    let creases = Creases::new(map, (density, lines), settings.n_faces);
    let n_free = n_vertices.saturating_sub(4 + creases.places.len());
    let places = creases.clear(map, sample::sample(map, density, n_free, &mut random));
    let mut net = Net::tetrahedron(map);
    let creases::Inserted {
        vertices,
        edges,
        n_apart,
    } = creases.insert(&mut net);
    let part = progress.part("", 0.0, 0.3);
    scatter(&mut net, &places, &mut random, &part)?;
    let mut is_fixed = VertexMap::filled(net.n_vertices(), false);
    for v in vertices {
        is_fixed[v] = true;
    }
    let mut report = Report::default();
    for round in 0..settings.n_rounds {
        let share = |r| 0.3 + 0.7 * r as f64 / settings.n_rounds as f64;
        let part = progress.part("", share(round), share(round + 1));
        report.n_flips += relax::flip_to_delaunay(&mut net, &part)?;
        // In every round they would undo what the surface wants; in none pairs of valence 5 and
        // 7 that attract each other would stay.
        if round % 3 == 2 {
            report.n_flips += relax::even_valences(&mut net, &part)?;
        }
        relax::smooth(&mut net, (density, &is_fixed), &mut report, &part)?;
    }
    report.n_flips += relax::flip_to_delaunay(&mut net, &progress.part("", 1.0, 1.0))?;
    let (faces, sphere) = net.into_parts();
    let primitive = PolygonMesh::from_faces(sphere, &faces).expect("a net has valid faces");
    debug_assert_eq!(check_cover(&primitive, primitive.positions()), Ok(()));
    report.n_vertices = primitive.n_vertices();
    report.n_faces = primitive.n_faces();
    Ok(Adaptive {
        primitive,
        on_lines: edges,
        n_apart,
        report,
    })
}

/// Joins places, and what is there, by their Delaunay triangulation on the sphere.
fn scatter(
    net: &mut Net,
    places: &[SurfacePoint],
    random: &mut Random,
    progress: &Progress,
) -> Result<(), AdaptiveError> {
    for (i, at) in insertion_order(places.len(), random)
        .into_iter()
        .enumerate()
    {
        if i.is_multiple_of(4096) {
            progress.at(i as f64 / places.len() as f64)?;
        }
        if !insert_near(net, places[at], random) && !insert_anywhere(net) {
            return Err(AdaptiveError::NoRoom {
                n_placed: net.n_vertices(),
                n_wanted: places.len() + 4,
            });
        }
    }
    Ok(())
}

/// Inserts a place, or one beside it when it coincides with what is there.
fn insert_near(net: &mut Net, mut place: SurfacePoint, random: &mut Random) -> bool {
    for _ in 0..8 {
        let last = VertexId::from_index(net.n_vertices() - 1);
        let face = net.face_at(net.map.sphere_position(place), last);
        if net.insert(face, place) {
            return true;
        }
        place = sample::inside(place.face, random);
    }
    false
}

/// Inserts a vertex into the largest triangle on the surface that has room on the sphere.
fn insert_anywhere(net: &mut Net) -> bool {
    let area = |face: [VertexId; 3]| {
        let [a, b, c] = face.map(|v| net.position(v));
        (b - a).cross(c - a).length_squared()
    };
    let areas = net.triangulation.faces().map(area);
    let mut order: Vec<(f64, FaceId)> = areas.zip((0..).map(FaceId)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    order.into_iter().any(|(_, face)| {
        let middle = net.triangulation.face(face).map(|v| net.sphere(v));
        let place = net.map.locate(middle.into_iter().sum());
        net.insert(face, place)
    })
}

/// Rounds that double in size, each in the given order (Amenta, Choi & Rote 2003): random enough
/// to keep the flips few, local enough to keep the walks short.
fn insertion_order(n: usize, random: &mut Random) -> Vec<usize> {
    let mut order: Vec<(u32, usize)> = (0..n)
        // A random number has k leading zeros with probability 2^-(k + 1).
        .map(|i| (64 - random.next_u64().leading_zeros(), i))
        .collect();
    order.sort_unstable();
    order.into_iter().map(|(_, i)| i).collect()
}

#[cfg(test)]
mod tests;
