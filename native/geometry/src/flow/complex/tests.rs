//! Complexes of boxes, whose flat metric is known in closed form.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::mesh::IdMap;
use crate::shapes;

/// A box of whole sides whose squares are cut at places that are not whole.
pub fn box_mesh(n: u32) -> TriangleMesh {
    let mesh = shapes::cuboid(n);
    let scaled = mesh.positions().iter().map(|&p| p * 10.0).collect();
    mesh.with_positions(scaled)
}

/// The unfolded box: every side in its own frame, k = 1 at the corners.
pub fn box_complex(n: u32) -> Complex {
    let mesh = box_mesh(n);
    let vector = |h: HalfedgeId| {
        let [a, b, c] = mesh.triangle(h.face());
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let side = if normal.x.abs() > 0.5 {
            DVec3::Y
        } else {
            DVec3::X
        };
        let edge = mesh.position(mesh.target(h)) - mesh.position(mesh.origin(h));
        DVec2::new(edge.dot(side), edge.dot(normal.cross(side)))
    };
    let start: HalfedgeMap<DVec2> = mesh.halfedge_ids().map(vector).collect();
    let turns = mesh.halfedge_ids().map(|h| {
        let twin = start[mesh.twin(h).unwrap()];
        (0..4)
            .find(|&r| (twin + start[h].turned(r)).length() < 1e-9)
            .unwrap()
    });
    let corner = |v| i32::from(mesh.position(v).abs().distance(DVec3::new(5.0, 4.0, 3.0)) < 1e-9);
    let dressing = Dressing {
        turns: turns.collect(),
        indices: mesh.vertex_ids().map(corner).collect(),
        wish: start.clone(),
    };
    Complex::over(&mesh, start, dressing)
}

/// One point at every face's middle, and a column per halfedge pair that sums to nothing.
fn dressed(n: u32) -> Complex {
    let mut complex = box_complex(n);
    for face in complex.face_ids() {
        let weights = [0.2, 0.3, 0.5];
        complex.located.add(Located {
            vertex: VertexId(face.0),
            face,
            weights,
        });
    }
    // Whole multiples of the vectors are coefficients of one column.
    let mut rows = Rows::new(complex.twins.len(), 1);
    let whole: Vec<_> = complex
        .start
        .iter()
        .map(|w| (w * f64::from(n)).round().as_ivec2())
        .collect();
    for h in complex.halfedge_ids() {
        let twin = complex.twins[h];
        if h < twin {
            rows.set([h, twin], complex.turns[h], &[whole[h.index()]]);
        }
    }
    complex.coefficients = rows;
    complex
}

#[test]
fn an_unfolded_box_is_a_complex() {
    let complex = dressed(5);
    complex.check().unwrap();
    assert!((complex.area() - 2.0 * (80.0 + 60.0 + 48.0)).abs() < 1e-9);
    assert_eq!(complex.indices.iter().sum::<i32>(), 8);
}

#[test]
fn a_broken_promise_is_found() {
    let mut turned = box_complex(2);
    turned.turns[HalfedgeId(4)] += 1;
    assert!(matches!(turned.check(), Err(BrokenComplex::Across(..))));
    let mut moved = box_complex(2);
    moved.start.as_mut_slice()[7] *= 1.5;
    assert!(moved.check().is_err());
    let mut other = box_complex(2);
    other.indices.as_mut_slice()[0] += 1;
    assert!(matches!(other.check(), Err(BrokenComplex::Angle(..))));
}

#[test]
fn delaunay_undoes_random_flips() {
    let mut complex = dressed(4);
    let mut random = crate::random::Random::new(5);
    for _ in 0..400 {
        let h = HalfedgeId::from_index(random.below(complex.twins.len()));
        if complex.is_flippable(h, 1e-3) {
            complex.flip(h);
        }
    }
    assert!(complex.delaunay() > 10);
    complex.check().unwrap();
    for h in complex.halfedge_ids() {
        assert!(complex.cotangent(h) + complex.cotangent(complex.twins[h]) > -1e-6);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn flips_keep_every_promise(edges in prop::collection::vec((0u32..576, 0u8..4), 1..120)) {
        let mut complex = dressed(4);
        let n = complex.located.points().len();
        for (edge, turns) in edges {
            let h = HalfedgeId(edge);
            complex.reframe(h.face(), turns);
            if complex.is_flippable(h, 1e-3) {
                complex.flip(h);
            }
        }
        prop_assert_eq!(complex.check(), Ok(()));
        prop_assert_eq!(complex.located.points().len(), n);
        for h in complex.halfedge_ids() {
            prop_assert!(complex.start[h].distance(complex.wish[h]) < 1e-9);
            let whole = complex.coefficients.value(h, &[0.25, 0.0]);
            prop_assert!(complex.start[h].distance(whole) < 1e-9);
        }
    }
}

#[test]
fn an_identity_of_ids_is_kept_by_compacting() {
    let mut complex = dressed(3);
    let before = complex.clone();
    complex.compact();
    assert_eq!(complex, before);
    let ids: IdMap<HalfedgeId, HalfedgeId> = complex.twins;
    assert_eq!(ids.len(), 324);
}

/// Lines of some edges each from random vertices on, through flat vertices only.
fn random_lines(complex: &Complex, seed: u64) -> Vec<Vec<HalfedgeId>> {
    let mut random = crate::random::Random::new(seed);
    let mut lines = Vec::new();
    for _ in 0..20 {
        let mut h = HalfedgeId(random.below(complex.twins.len()) as u32);
        let mut line = vec![h];
        for _ in 0..random.below(12) {
            if complex.indices[complex.target(h)] != 0 {
                break;
            }
            // Never back, and as straight as it goes by counting.
            let fan: Vec<HalfedgeId> = complex.fan(complex.target(h)).collect();
            let back = fan.iter().position(|&e| e == complex.twins[h]).unwrap();
            h = fan[(back + 1 + random.below(fan.len() - 1)) % fan.len()];
            line.push(h);
        }
        lines.push(line);
    }
    lines
}

#[test]
fn lines_keep_their_sums_while_flat_vertices_go() {
    use crate::flow::cones::keep_cones;
    use crate::progress::Progress;
    for seed in 0..10 {
        let mut complex = box_complex(6);
        let lines = random_lines(&complex, seed);
        complex.follow_lines(&lines);
        let mut is_wanted: VertexMap<bool> = complex.outgoing.iter().map(|_| false).collect();
        let mut before = Vec::new();
        for (i, line) in lines.iter().enumerate() {
            is_wanted[complex.origins[line[0]]] = true;
            is_wanted[complex.target(line[line.len() - 1])] = true;
            before.push(complex.sum_along(i, &complex.start));
        }
        let cones = keep_cones(complex, &is_wanted, &Progress::none()).unwrap();
        for (i, sum) in before.into_iter().enumerate() {
            let after = cones.sum_along(i, &cones.start);
            assert!(after.distance(sum) < 1e-9, "{sum} {after}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn lines_keep_their_sums_and_stay_short(
        edges in prop::collection::vec((0u32..576, 0u8..4), 1..300),
        seed: u64,
    ) {
        let mut complex = dressed(4);
        complex.follow_lines(&random_lines(&complex, seed));
        let sums = |complex: &Complex| -> Vec<DVec2> {
            (0..20).map(|i| complex.sum_along(i, &complex.start)).collect()
        };
        let (before, size) = (sums(&complex), complex.chains.size());
        for (edge, turns) in edges {
            let h = HalfedgeId(edge);
            // The frame that a line begins in may turn: its sum is said in the first one.
            complex.reframe(h.face(), turns);
            if complex.is_flippable(h, 1e-3) {
                complex.flip(h);
            }
        }
        for (i, (sum, old)) in sums(&complex).into_iter().zip(before).enumerate() {
            prop_assert!(sum.distance(old) < 1e-9, "{} is not {}", sum, old);
            let whole = complex.coefficients_along(i)[0].as_dvec2() / 4.0;
            prop_assert!(sum.distance(whole) < 1e-9, "{} is not {}", sum, whole);
        }
        complex.delaunay();
        prop_assert!(complex.chains.size() <= 2 * size, "{} of {}", complex.chains.size(), size);
    }
}
