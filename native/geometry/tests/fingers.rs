//! Limbs thinner than a quad: the result has all of them.

use std::collections::HashMap;

use glam::{DVec3, IVec3};
use orbflow_geometry::embed::Solver;
use orbflow_geometry::mesh::PolygonMesh;
use orbflow_geometry::pipeline::{Flowed, Input, Settings, remesh};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::sphere_map::check_cover;

/// The body's size in voxels. A quad of 2,000 is 2.6 long, a finger some 6 round.
const BODY: IVec3 = IVec3::new(80, 50, 24);
/// Where five fingers begin on its top, 2 × 2 voxels each.
const FINGERS: [[i32; 2]; 5] = [[24, 11], [28, 11], [32, 11], [36, 11], [44, 7]];
const LENGTH: i32 = 9;
/// A rack's size in voxels.
const RACK: IVec3 = IVec3::new(2, 24, 21);

fn is_of_body(cell: IVec3) -> bool {
    let within = |from: IVec3, to: IVec3| cell.cmpge(from).all() && cell.cmplt(to).all();
    let is_finger = |&[x, z]: &[i32; 2]| {
        within(
            IVec3::new(x, 0, z),
            IVec3::new(x + 2, BODY.y + LENGTH, z + 2),
        )
    };
    within(IVec3::ZERO, BODY) || FINGERS.iter().any(is_finger)
}

/// Whether a voxel belongs to a rack: bars of one voxel across a bar, with plates at their ends.
fn is_of_rack(cell: IVec3) -> bool {
    let is_rung = cell.y % 12 == 2 && cell.x == 0;
    let is_plate = matches!(cell.z, 0 | 20) && (cell.y % 12 - 2).abs() < 2 && cell.x < 2;
    let is_bar = cell.x == 0 && cell.z == 10;
    let is_within = cell.cmpge(IVec3::ZERO).all() && cell.cmplt(RACK).all();
    is_within && (is_rung || is_plate || is_bar)
}

/// The corners of the sides of a voxel that others do not cover.
fn sides(cell: IVec3, is_inside: impl Fn(IVec3) -> bool) -> impl Iterator<Item = [IVec3; 4]> {
    let sides = (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]);
    sides.filter_map(move |(axis, side)| {
        let [out, u, v] = [0, 1, 2].map(|i| IVec3::AXES[(axis + i) % 3]);
        let [u, v] = if side == 1 { [u, v] } else { [v, u] };
        let from = cell + out * side;
        let is_free = !is_inside(cell + out * (2 * side - 1));
        is_free.then_some([from, from + u, from + u + v, from + v])
    })
}

/// The border of the voxels inside, a few times smoothed.
fn border(size: IVec3, is_inside: impl Fn(IVec3) -> bool + Copy, n_smoothings: u32) -> PolygonMesh {
    let cells = (0..size.x * size.y * size.z)
        .map(|i| IVec3::new(i % size.x, i / size.x % size.y, i / (size.x * size.y)));
    let mut known: HashMap<IVec3, u32> = HashMap::new();
    let mut places: Vec<DVec3> = Vec::new();
    let mut vertex = |place: IVec3| {
        *known.entry(place).or_insert_with(|| {
            places.push(place.as_dvec3());
            places.len() as u32 - 1
        })
    };
    let faces: Vec<[u32; 4]> = cells
        .filter(|&cell| is_inside(cell))
        .flat_map(|cell| sides(cell, is_inside))
        .map(|corners| corners.map(&mut vertex))
        .collect();
    for _ in 0..n_smoothings {
        let mut sums = vec![(DVec3::ZERO, 0.0); places.len()];
        for (face, i) in faces.iter().flat_map(|face| (0..4).map(move |i| (face, i))) {
            let (sum, n) = &mut sums[face[i] as usize];
            *sum += places[face[(i + 1) % 4] as usize];
            *n += 1.0;
        }
        for (place, (sum, n)) in places.iter_mut().zip(sums) {
            *place = place.lerp(sum / n, 0.5);
        }
    }
    PolygonMesh::from_faces(places, &faces).expect("the border of voxels is closed")
}

#[test]
fn fingers_thinner_than_three_quads_have_tips_and_rings() {
    let mesh = border(BODY + IVec3::Y * LENGTH, is_of_body, 4);
    let run = remesh(
        Input::new(&mesh),
        &Settings::default(),
        &Solver::default(),
        &Progress::none(),
    );
    let made = run.unwrap().mesh;
    for [x, z] in FINGERS {
        let axis = DVec3::new(f64::from(x) + 1.0, 0.0, f64::from(z) + 1.0);
        let heights = |mesh: &PolygonMesh| -> Vec<f64> {
            let on_finger = |p: &&DVec3| (**p - axis).with_y(0.0).length() < 2.0;
            mesh.positions()
                .iter()
                .filter(on_finger)
                .map(|p| p.y)
                .collect()
        };
        let top = |mesh: &PolygonMesh| heights(mesh).into_iter().fold(0.0, f64::max);
        let short = top(&mesh) - top(&made);
        assert!(short.abs() < 0.3, "the finger at {x} is {short} too short");
        // Five rings of four; on an even surface some have no more than four.
        let bottom = f64::from(BODY.y) + 1.0;
        let n = heights(&made).iter().filter(|&&y| y > bottom).count();
        assert!(n >= 20, "the finger at {x} has {n} vertices");
    }
}

#[test]
fn bars_too_thin_for_their_quads_flow_once_strips_are_taken_out() {
    let mesh = border(RACK, is_of_rack, 0);
    let settings = Settings {
        faces: 60,
        ..Settings::default()
    };
    let run = remesh(
        Input::new(&mesh),
        &settings,
        &Solver::default(),
        &Progress::none(),
    );
    let made = run.unwrap();
    let part = &made.report.parts[0];
    match &part.flow {
        Some(Flowed::Used { flow, .. }) => assert!(flow.n_thinned > 0, "{flow:?}"),
        other => panic!("{other:?}"),
    }
    assert_eq!(part.deform.n_inverted, 0);
    assert!(made.mesh.n_faces().abs_diff(60) <= 2);
    assert_eq!(check_cover(&made.mesh, &made.sphere), Ok(()));
}
