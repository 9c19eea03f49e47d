//! Where the user wants smaller quads, found again on a part and on its even surface.

use std::collections::HashMap;

use glam::DVec3;

use super::frame::{Frame, bits};
use super::{Error, Input};
use crate::deform::Target;
use crate::elementary::powf;
use crate::measure::area_vector;
use crate::mesh::{Id, TriangleMesh, VertexId, VertexMap};

/// Quads per area that density 1 wants for each that density 0 does. The map along the field follows
/// about half of a wish, so that edges become half as long; at a quarter of this many shapes show
/// next to nothing.
const MOST: f64 = 16.0;

/// Values from 0 to 1 by the places of their vertices; of vertices in one place the largest counts.
#[derive(Debug, Default)]
pub struct Density(HashMap<[u64; 3], f64>);

impl Density {
    /// The values of the input, in the frame of work; none ask for nothing.
    pub fn new(input: &Input<'_>, frame: &Frame) -> Self {
        let mut values = HashMap::new();
        let given = input.density.unwrap_or_default();
        let places = frame.enter(input.mesh.positions());
        for (&place, &value) in places.iter().zip(given) {
            let most = values.entry(bits(place)).or_insert(value);
            *most = value.max(*most);
        }
        Self(values)
    }

    /// The same, larger where others are larger, by their places in the frame of work.
    #[must_use]
    pub fn raised(mut self, others: impl Iterator<Item = (DVec3, f64)>) -> Self {
        for (place, value) in others {
            let most = self.0.entry(bits(place)).or_insert(value);
            *most = value.max(*most);
        }
        self
    }

    /// Values at places in the frame of work.
    pub fn at(values: impl Iterator<Item = (DVec3, f64)>) -> Self {
        Self(values.map(|(place, value)| (bits(place), value)).collect())
    }

    /// The value at every vertex of a part; none where all are alike and ask for nothing.
    pub fn on(&self, part: &TriangleMesh) -> Option<VertexMap<f64>> {
        let known = |v| self.0.get(&bits(part.position(v))).copied();
        // Polygons that are cut from their centre have a vertex there that did not come in.
        let value = |v| known(v).unwrap_or_else(|| mean(part.neighbours(v).filter_map(known)));
        let values: VertexMap<f64> = part.vertex_ids().map(value).collect();
        let first = values.iter().next().copied();
        let differ = values.iter().any(|&value| Some(value) != first);
        differ.then_some(values)
    }

    /// The area of a part as if it all had the density 0: what its share of the faces goes by.
    pub fn amount(&self, part: &TriangleMesh) -> f64 {
        let weight = |v: VertexId| {
            let value = self.0.get(&bits(part.position(v)));
            value.map_or(1.0, |&value| weight(value))
        };
        let amount = |face| {
            let weights = part.face(face).map(weight);
            area_vector(part.triangle(face)).length() * (weights.iter().sum::<f64>() / 3.0)
        };
        part.face_ids().map(amount).sum()
    }
}

/// How many more quads per area every vertex of an even surface wants, by the values at the
/// vertices of the target, which it lies on.
pub fn weights(values: &VertexMap<f64>, target: &Target, even: &TriangleMesh) -> VertexMap<f64> {
    let places = even.positions().iter();
    places
        .map(|&place| weight_at(values, target, place))
        .collect()
}

/// The same at the place of the target that is nearest to another.
pub fn weight_at(values: &VertexMap<f64>, target: &Target, place: DVec3) -> f64 {
    let closest = target.bvh().closest(place);
    let corners = target.mesh().face(closest.face);
    let shares = corners.iter().zip(closest.weights);
    weight(shares.map(|(&v, share)| values[v] * share).sum())
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (n, sum) = values.fold((0.0, 0.0), |(n, sum), value| (n + 1.0, sum + value));
    sum / f64::max(n, 1.0)
}

fn weight(value: f64) -> f64 {
    powf(MOST, value)
}

impl Input<'_> {
    /// Whether there is one density for every vertex, from 0 to 1.
    pub(super) fn check_density(&self) -> Result<(), Error> {
        let Some(values) = self.density else {
            return Ok(());
        };
        let [n_values, n_vertices] = [values.len(), self.mesh.n_vertices()];
        if n_values != n_vertices {
            return Err(Error::DensityCount {
                n_values,
                n_vertices,
            });
        }
        match values.iter().position(|v| !(0.0..=1.0).contains(v)) {
            Some(at) => Err(Error::DensityOutOfRange {
                vertex: VertexId::from_index(at),
                value: values[at],
            }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embed::Solver;
    use crate::mesh::PolygonMesh;
    use crate::pipeline::{Mirror, Settings, remesh};
    use crate::progress::Progress;
    use crate::shapes;

    fn input<'a>(mesh: &'a PolygonMesh, values: &'a [f64]) -> Input<'a> {
        Input {
            density: Some(values),
            ..Input::new(mesh)
        }
    }

    /// The mean area of the quads well inside each half of a mesh, x < 0 first.
    fn areas(mesh: &PolygonMesh) -> [f64; 2] {
        [-1.0, 1.0].map(|side| {
            let quads = mesh.faces().map(|f| f.iter().map(|&v| mesh.position(v)));
            let quads = quads.map(Iterator::collect::<Vec<_>>);
            let inside: Vec<f64> = quads
                .filter(|q| q.iter().sum::<DVec3>().x / 4.0 * side > 0.3)
                .map(|q| (q[2] - q[0]).cross(q[3] - q[1]).length() / 2.0)
                .collect();
            inside.iter().sum::<f64>() / inside.len() as f64
        })
    }

    #[test]
    fn quads_are_smaller_in_the_half_that_asks_for_it_and_as_many() {
        let mesh = shapes::polygons(&shapes::sphere(20));
        let is_right = |p: &DVec3| f64::from(u8::from(p.x > 0.0));
        let values: Vec<f64> = mesh.positions().iter().map(is_right).collect();
        let ratio = |faces: usize, mirror: Mirror| {
            let settings = Settings {
                faces,
                mirror,
                ..Settings::default()
            };
            let run = remesh(
                input(&mesh, &values),
                &settings,
                &Solver::default(),
                &Progress::none(),
            );
            let made = run.unwrap().mesh;
            assert!(made.n_faces().abs_diff(faces) <= faces / 50);
            let [left, right] = areas(&made);
            right / left
        };
        for mirror in [Mirror::Off, Mirror::Y] {
            // A sphere's eight irregular vertices leave the least room; other shapes follow better.
            // Which places they take is chance: single counts go from 0.4 to 0.75.
            let ratios = [800, 900, 1000, 1100].map(|faces| ratio(faces, mirror));
            let mean = ratios.iter().sum::<f64>() / 4.0;
            assert!(mean < 0.65, "{mirror:?}: {ratios:?}");
        }
    }

    #[test]
    fn one_density_everywhere_is_none() {
        let mesh = shapes::sphere(4);
        let polygons = shapes::polygons(&mesh);
        let values = vec![0.7; mesh.n_vertices()];
        let frame = Frame::new([DVec3::NEG_ONE, DVec3::ONE]);
        let density = Density::new(&input(&polygons, &values), &frame);
        let inside = mesh.with_positions(frame.enter(mesh.positions()));
        assert_eq!(density.on(&inside), None);
        let times = density.amount(&inside) / Density::default().amount(&inside);
        assert!((times - powf(16f64, 0.7)).abs() < 1e-9, "{times}");
    }

    #[test]
    fn wrong_densities_are_refused_with_their_numbers() {
        let mesh = shapes::polygons(&shapes::sphere(3));
        let n = mesh.n_vertices();
        let told = |values: &[f64]| {
            input(&mesh, values)
                .check_density()
                .unwrap_err()
                .to_string()
        };
        assert_eq!(told(&[0.5; 7]), format!("7 densities for {n} vertices"));
        for wrong in [-0.1, 1.5, f64::NAN, f64::INFINITY] {
            let mut values = vec![0.5; n];
            values[4] = wrong;
            assert_eq!(
                told(&values),
                format!("vertex 4 has the density {wrong}; it goes from 0 to 1")
            );
        }
    }
}
