//! The network as a predictor: conformance, symmetry, and its file.

#[path = "../../geometry/tests/common/mod.rs"]
mod common;

use std::sync::Arc;

use common::conformance::{check, hierarchies};
use glam::{DMat3, DVec3};
use orbflow_geometry::decimate::collapse_to_tetrahedron;
use orbflow_geometry::embed::{OffsetPredictor, Proposal};
use orbflow_geometry::mesh::{Id, TriangleMesh, VertexId};
use orbflow_geometry::progress::{CancelToken, Progress};
use orbflow_geometry::random::Random;
use orbflow_network::features::N_FEATURES;
use orbflow_network::neighbours::Neighbours;
use orbflow_network::net::Sizes;
use orbflow_network::pyramid::{Level, Pyramid};
use orbflow_network::weights::{Header, ReadWeightsError, Weights};
use orbflow_network::{AutoPredictor, NetworkPredictor};

/// A small network with random weights.
fn weights() -> Weights {
    let sizes = Sizes {
        width: 16,
        levels: vec![200, 60, 20],
        blocks: vec![1, 1, 2],
        relaxations: 2,
    };
    let mut random = Random::new(3);
    let n = sizes.n_parameters().expect("a small network");
    Weights {
        parameters: (0..n).map(|_| (random.unit() - 0.5) as f32 * 0.5).collect(),
        header: Header {
            sizes,
            n_features: N_FEATURES,
            provenance: "random".to_owned(),
        },
    }
}

fn predictor(weights: &Weights) -> NetworkPredictor {
    NetworkPredictor::new(weights).expect("parameters of their sizes")
}

fn propose(mesh: TriangleMesh) -> Proposal {
    let hierarchy = collapse_to_tetrahedron(mesh, &Progress::none()).expect("a closed mesh");
    let proposed = predictor(&weights()).propose(&hierarchy, &Progress::none());
    proposed.expect("nothing cancels")
}

#[test]
fn whatever_it_proposes_ends_in_a_valid_map() {
    for (_, hierarchy) in hierarchies() {
        check(&hierarchy, &predictor(&weights()));
    }
}

#[test]
fn the_network_proposes_from_so_many_vertices_on() {
    for (_, hierarchy) in hierarchies() {
        let n = hierarchy.n_vertices();
        for (least, name) in [(n, "network"), (n + 1, "solver")] {
            let auto = AutoPredictor::new(predictor(&weights())).from_vertices(least);
            let report = check(&hierarchy, &auto);
            assert_eq!(report.predictor, name);
            assert_eq!(report.weights.is_some(), name == "network");
        }
    }
}

/// Distortion and folds in percent of what the shipped weights propose for the suite's shapes.
const RECORDED: &[(&str, f64, f64)] = &[
    ("sphere", 1.630, 0.0),
    ("cuboid", 1.661, 0.0),
    ("capsule", 2.008, 0.0),
    ("blob", 1.652, 0.0),
    ("limbs", 2.217, 0.68),
];

#[test]
fn the_shipped_weights_do_what_they_did() {
    let trained = NetworkPredictor::default();
    let shapes = hierarchies();
    assert_eq!(shapes.len(), RECORDED.len());
    for ((name, hierarchy), &(wanted, energy, folds_pct)) in shapes.iter().zip(RECORDED) {
        assert_eq!(*name, wanted);
        let found = check(hierarchy, &trained).proposal;
        // Sums of single precision differ between machines.
        assert!(
            (found.energy / energy - 1.0).abs() < 0.02,
            "{name} {found:?}"
        );
        assert!(
            (found.folds_pct - folds_pct).abs() < 1.0,
            "{name} {found:?}"
        );
    }
}

#[test]
fn the_finest_level_is_proposed_and_no_more() {
    let proposal = propose(common::limbs(4, 9));
    assert_eq!(proposal.n_proposed, 200);
    let n_given = proposal.sphere.iter().filter(|p| p.length() > 0.5).count();
    assert_eq!(n_given, 200);
}

#[test]
fn the_same_mesh_gets_the_same_points() {
    assert_eq!(propose(common::limbs(4, 9)), propose(common::limbs(4, 9)));
}

#[test]
fn the_proposal_turns_moves_and_grows_with_the_mesh() {
    let mesh = common::limbs(4, 9);
    let turn = DMat3::from_rotation_y(0.8) * DMat3::from_rotation_z(2.2);
    let places = mesh
        .positions()
        .iter()
        .map(|&p| turn * p * 64.0 + DVec3::new(3.0, -8.0, 1.0));
    let [still, turned] = [mesh.clone(), mesh.with_positions(places.collect())].map(propose);
    for (p, q) in still.sphere.iter().zip(turned.sphere.iter()) {
        assert!((turn * *p).distance(*q) < 1e-3, "{p} {q}");
    }
}

#[test]
fn a_turned_mesh_gets_a_proposal_as_good() {
    let trained = NetworkPredictor::default();
    for (name, hierarchy) in hierarchies() {
        let mesh = hierarchy.mesh();
        let energy = |turn: DMat3| {
            let places = mesh.positions().iter().map(|&p| turn * p).collect();
            let turned = mesh.clone().with_positions(places);
            let hierarchy = collapse_to_tetrahedron(turned, &Progress::none());
            check(&hierarchy.expect("it was closed"), &trained)
                .proposal
                .energy
        };
        let still = energy(DMat3::IDENTITY);
        let mut random = Random::new(5);
        for _ in 0..6 {
            let angles = [0, 1, 2].map(|_| random.unit() * std::f64::consts::TAU);
            let turned = energy(DMat3::from_euler(
                glam::EulerRot::XYZ,
                angles[0],
                angles[1],
                angles[2],
            ));
            assert!(
                (turned / still - 1.0).abs() < 0.02,
                "{name}: {turned} {still}"
            );
        }
    }
}

#[test]
fn a_cancelled_prediction_stops() {
    let hierarchy = collapse_to_tetrahedron(common::blob(1, 6), &Progress::none()).unwrap();
    let token = CancelToken::new();
    token.cancel();
    let cancelled = predictor(&weights()).propose(&hierarchy, &Progress::silent(token));
    assert!(cancelled.is_err());
}

#[test]
fn a_file_gives_the_network_back_in_half_precision() {
    let saved = weights();
    let read = Weights::from_bytes(&saved.to_bytes()).unwrap();
    assert_eq!(read.header, saved.header);
    for (x, y) in saved.parameters.iter().zip(&read.parameters) {
        assert!((x - y).abs() <= 5e-4 * x.abs() + 1e-7, "{x} {y}");
    }
    // Halves are read exactly.
    assert_eq!(Weights::from_bytes(&read.to_bytes()).unwrap(), read);
}

#[test]
fn the_report_tells_which_weights_proposed() {
    let shape = || collapse_to_tetrahedron(common::blob(1, 6), &Progress::none()).unwrap();
    let told = |predictor: &NetworkPredictor| check(&shape(), predictor).weights.unwrap();
    let (own, shipped) = (weights(), told(&NetworkPredictor::default()));
    let other = told(&predictor(&own));
    assert_eq!(other.provenance, "random");
    assert!(shipped.shipped && !other.shipped && shipped.sum != other.sum);
    // The sum of the file's front, so that a file can be told by its first bytes.
    let front: [u8; 8] = own.to_bytes()[24..32].try_into().unwrap();
    assert_eq!(other.sum, format!("{:016x}", u64::from_le_bytes(front)));
    // The same weights from a file are still the shipped ones.
    let read = Weights::from_bytes(&Weights::shipped().to_bytes()).unwrap();
    assert_eq!(told(&predictor(&read)), shipped);
}

#[test]
fn wrong_damaged_and_hostile_files_are_refused() {
    let bytes = weights().to_bytes();
    let read = |bytes: &[u8]| Weights::from_bytes(bytes).unwrap_err();
    assert_eq!(read(b"OFF\n"), ReadWeightsError::NotWeights);
    assert_eq!(read(&[]), ReadWeightsError::NotWeights);
    let mut newer = bytes.clone();
    newer[8] = 9;
    assert_eq!(read(&newer), ReadWeightsError::Version { found: 9 });
    for n in [9, 31, 32, 100, bytes.len() - 1] {
        assert!(
            matches!(read(&bytes[..n]), ReadWeightsError::Length { .. }),
            "{n}"
        );
    }
    for at in [12, 20, 24, 40, bytes.len() / 2, bytes.len() - 1] {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x11;
        read(&damaged);
    }
}

#[test]
fn sizes_that_would_eat_the_memory_are_refused() {
    for (width, levels, blocks, relaxations) in [
        (usize::MAX, vec![500], vec![1], 1),
        (8, vec![500], vec![usize::MAX], 1),
        (8, vec![500], vec![1], usize::MAX),
        (8, vec![20, 500], vec![1, 1], 1),
        (8, vec![500, 20], vec![1], 1),
        (8, vec![], vec![], 1),
        (8, vec![500, 0], vec![1, 1], 1),
    ] {
        let mut hostile = weights();
        hostile.header.sizes = Sizes {
            width,
            levels,
            blocks,
            relaxations,
        };
        let error = Weights::from_bytes(&hostile.to_bytes()).unwrap_err();
        let refused = matches!(
            error,
            ReadWeightsError::Sizes { .. } | ReadWeightsError::Header { .. }
        );
        assert!(refused, "{error}");
    }
}

#[test]
fn parameters_of_another_width_are_refused() {
    let mut other = weights();
    other.header.sizes.width = 24;
    let error = Weights::from_bytes(&other.to_bytes()).unwrap_err();
    let wanted = other.header.sizes.n_parameters().unwrap();
    let found = other.parameters.len();
    assert_eq!(error, ReadWeightsError::Parameters { found, wanted });
    assert_eq!(NetworkPredictor::new(&other).unwrap_err(), error);
}

#[test]
fn parameters_that_are_no_numbers_are_refused() {
    for poison in [f32::NAN, f32::INFINITY, 1e6] {
        let mut poisoned = weights();
        poisoned.parameters[7] = poison;
        let error = Weights::from_bytes(&poisoned.to_bytes()).unwrap_err();
        assert_eq!(error, ReadWeightsError::NotFinite { index: 7 });
    }
}

/// Three grids on a torus with random features: numbers that no machine makes otherwise.
fn grids() -> Pyramid {
    let mut random = Random::new(11);
    let mut level = |[width, height]: [usize; 2], n_finer: u32| {
        let id = |i: usize, j: usize| VertexId::from_index(i % width + j % height * width);
        let cells = (0..width * height).map(|cell| (cell % width, cell / width));
        let faces = cells.flat_map(|(i, j)| {
            let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            [[a, b, c], [a, c, d]]
        });
        let n = width * height;
        let numbers = (0..n * N_FEATURES).map(|_| 2.0 * random.unit() as f32 - 1.0);
        Level {
            graph: Arc::new(Neighbours::of_faces(n, &faces.collect::<Vec<_>>())),
            features: numbers.collect(),
            parents: (0..n_finer).map(|i| i % n as u32).collect(),
        }
    };
    Pyramid {
        levels: vec![level([8, 5], 0), level([5, 4], 40), level([4, 3], 20)],
    }
}

/// What the shipped weights said of the first vertices of these grids.
const SAID: [[f64; 3]; 3] = [
    [0.044_197, 0.288_581, 2.093_956],
    [0.279_658, 0.773_166, 5.400_925],
    [0.244_305, 0.431_412, 2.898_115],
];

#[test]
fn the_shipped_weights_say_the_same_on_every_machine() {
    let network = Weights::shipped().network().expect("they are whole");
    let said = network.forward(&grids());
    assert_eq!(said.len(), 40);
    for (said, wanted) in said.iter().zip(SAID) {
        // Six digits are recorded.
        assert!(said.distance(wanted.into()) < 1e-6, "{said} {wanted:?}");
    }
}
