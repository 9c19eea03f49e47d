//! The algebra against brute force: every choice of whole periods is whole everywhere and closes.

use proptest::prelude::*;

use super::*;
use crate::flow::complex::tests::box_complex;
use crate::flow::complex::{Dressing, Turn};
use crate::mesh::{HalfedgeMap, TriangleMesh, VertexId};
use crate::random::Random;

/// The vectors that whole periods make: whole, opposite across edges and closed in faces.
fn assert_closes(complex: &Complex, periods: &[f64]) {
    let vector = |h: HalfedgeId| complex.coefficients.value(h, periods);
    for h in complex.halfedge_ids() {
        let across = vector(complex.twins[h]) + vector(h).turned(complex.turns[h]);
        assert_eq!(across, DVec2::ZERO);
        assert_eq!(vector(h), vector(h).round());
        let sum = vector(h) + vector(h.next()) + vector(h.prev());
        assert_eq!(sum, DVec2::ZERO);
    }
}

fn assert_reproduces(complex: &Complex, basis: &Basis) {
    for h in complex.halfedge_ids() {
        let vector = complex.coefficients.value(h, &basis.start);
        assert!(vector.distance(complex.start[h]) < 1e-9);
    }
}

/// The octahedron with any turns: an index of 1 or more at each vertex by moving turns about.
fn octahedron(turns: &[u8; 12]) -> Complex {
    let faces = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 1],
        [5, 2, 1],
        [5, 3, 2],
        [5, 4, 3],
        [5, 1, 4],
    ];
    let positions = [
        [0, 0, 1],
        [1, 0, 0],
        [0, 1, 0],
        [-1, 0, 0],
        [0, -1, 0],
        [0, 0, -1],
    ];
    let mesh = TriangleMesh::new(
        positions.map(|p| glam::IVec3::from(p).as_dvec3()).to_vec(),
        faces.map(|f| f.map(VertexId)).to_vec(),
    )
    .unwrap();
    let mut quarter = HalfedgeMap::filled(24, 0);
    let edges = mesh.halfedge_ids().filter(|&h| h < mesh.twin(h).unwrap());
    for (h, &r) in edges.zip(turns) {
        quarter[h] = r;
        quarter[mesh.twin(h).unwrap()] = (4 - r) % 4;
    }
    let zeros = HalfedgeMap::filled(24, DVec2::ZERO);
    let dressing = Dressing {
        turns: quarter,
        indices: mesh.vertex_ids().map(|_| 0).collect(),
        wish: zeros.clone(),
    };
    Complex::over(&mesh, zeros, dressing)
}

proptest! {
    #[test]
    fn any_turns_give_periods_that_close(turns in prop::array::uniform12(0..4u8), seed: u64) {
        let mut complex = octahedron(&turns);
        let basis = choose(&mut complex).unwrap();
        // Five vectors of the tree, less one for the closing equation unless it is empty.
        let n = basis.start.len() / 2;
        prop_assert!(n == 4 || n == 5);
        let mut random = Random::new(seed);
        let periods: Vec<f64> = (0..2 * n).map(|_| random.below(21) as f64 - 10.0).collect();
        assert_closes(&complex, &periods);
    }

    #[test]
    fn whole_solutions_are_all_reached(turns in prop::array::uniform12(0..4u8), seed: u64) {
        // A whole solution of the closing equation over the tree's vectors is a choice of periods:
        // the free columns and the solved one are a unimodular change of the tree's.
        let mut complex = octahedron(&turns);
        let tree = tree::shortest_tree(&complex);
        let mut random = Random::new(seed);
        let basis = choose(&mut complex).unwrap();
        let n = basis.start.len() / 2;
        let hidden: Vec<f64> = (0..2 * n).map(|_| random.below(9) as f64 - 4.0).collect();
        let seen: Vec<DVec2> =
            tree.iter().map(|&h| complex.coefficients.value(h, &hidden)).collect();
        let mut wished = complex.clone();
        for h in wished.halfedge_ids() {
            wished.start[h] = complex.coefficients.value(h, &hidden);
        }
        let found = choose_over(&mut wished, &tree);
        for (h, seen) in tree.iter().zip(seen) {
            prop_assert_eq!(wished.coefficients.value(*h, &found), seen);
        }
        prop_assert!(found.iter().all(|x| x.fract() == 0.0));
    }
}

/// The periods of the metric over a given tree.
fn choose_over(complex: &mut Complex, tree: &[HalfedgeId]) -> Periods {
    let (mut rows, open) = tree::peel(complex, tree).unwrap();
    let mut start: Vec<DVec2> = tree.iter().map(|&h| complex.start[h]).collect();
    let mut wish = start.clone();
    if let Some(zero) = close(&mut rows, open, &mut [&mut start, &mut wish]) {
        assert_eq!(start.remove(zero), DVec2::ZERO);
        for row in &mut rows {
            row.remove(zero);
        }
    }
    complex.coefficients = sparse(complex, &rows, start.len());
    start.iter().flat_map(DVec2::to_array).collect()
}

#[test]
fn the_periods_of_a_box_give_its_vectors_back() {
    let mut complex = box_complex(2);
    let basis = choose(&mut complex).unwrap();
    assert_eq!(basis.start.len() / 2, complex.n_vertices() - 2);
    assert_reproduces(&complex, &basis);
    let whole: Vec<f64> = basis.start.iter().map(|x| x.round()).collect();
    assert_closes(&complex, &whole);
}

#[test]
fn flips_carry_the_coefficients_along() {
    let mut complex = box_complex(2);
    let basis = choose(&mut complex).unwrap();
    for h in complex.halfedge_ids() {
        if complex.is_flippable(h, 1e-6) {
            complex.flip(h);
        }
    }
    assert_reproduces(&complex, &basis);
    assert_eq!(complex.check(), Ok(()));
}

#[test]
fn rows_outlive_many_flips() {
    // Far more flips than there are edges, so that rows no longer in use are dropped on the way.
    let mut complex = box_complex(2);
    let basis = choose(&mut complex).unwrap();
    let mut random = Random::new(7);
    for _ in 0..3000 {
        let h = HalfedgeId::from_index(random.below(complex.twins.len()));
        complex.reframe(h.face(), random.below(4) as u8);
        if complex.is_flippable(h, 1e-3) {
            complex.flip(h);
        }
    }
    assert_reproduces(&complex, &basis);
    let wanted = complex.halfedge_ids().map(|h| {
        let row = complex.coefficients.row(h);
        row.fold(DVec2::ZERO, |sum, (j, c)| {
            let period = DVec2::new(basis.start[2 * j], basis.start[2 * j + 1]);
            sum + c.as_dvec2().rotate(period)
        })
    });
    for (h, wanted) in complex.halfedge_ids().zip(wanted) {
        assert!(complex.coefficients.value(h, &basis.start).distance(wanted) < 1e-9);
    }
}

#[test]
fn two_spheres_are_refused() {
    let one = octahedron(&[0; 12]);
    let mut two = one.clone();
    for h in one.halfedge_ids() {
        two.origins.push(VertexId(one.origins[h].0 + 6));
        two.twins.push(HalfedgeId(one.twins[h].0 + 24));
        two.turns.push(0);
        two.start.push(DVec2::ZERO);
        two.wish.push(DVec2::ZERO);
    }
    for v in one.outgoing.ids() {
        two.outgoing.push(HalfedgeId(one.outgoing[v].0 + 24));
        two.indices.push(0);
    }
    assert_eq!(choose(&mut two), Err(NotASphere));
}
