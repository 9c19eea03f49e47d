//! Properties and symmetries of both decimations, on closed meshes edited at random.

mod common;

use common as shapes;
use glam::DVec3;
use orbflow_geometry::decimate::{
    CollapseError, Settings, Simplified, collapse_to_tetrahedron, simplify,
};
use orbflow_geometry::elementary::sin_cos;
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::mesh::{Id, TriangleMesh, VertexId};
use orbflow_geometry::progress::{CancelToken, Progress};
use orbflow_geometry::random::Random;
use proptest::prelude::*;

/// A closed mesh with vertices of all valences: a shape, faces split and edges flipped at random.
fn edited(seed: u64, n_edits: usize) -> TriangleMesh {
    let mut random = Random::new(seed);
    let mut pick = |n: usize| (random.unit() * n as f64) as usize;
    let mut shapes = shapes::closed(1 + pick(4) as u32);
    let (_, shape) = shapes.swap_remove(pick(5));
    let mut points = shape.positions().to_vec();
    let mut faces = shape.faces().to_vec();
    for _ in 0..n_edits {
        let at = pick(faces.len());
        let [a, b, c] = faces[at];
        let opposite = faces
            .iter()
            .position(|f| (0..3).any(|i| [f[i], f[(i + 1) % 3]] == [b, a]));
        let opposite = opposite.expect("the mesh is closed");
        let d = faces[opposite]
            .into_iter()
            .find(|&v| v != a && v != b)
            .expect("a third corner");
        let is_edge = faces.iter().any(|f| f.contains(&c) && f.contains(&d));
        if pick(2) == 0 && !is_edge {
            faces[at] = [a, d, c];
            faces[opposite] = [d, b, c];
        } else {
            let v = VertexId::from_index(points.len());
            points.push((points[a.index()] + points[b.index()] + points[c.index()]) / 3.0);
            faces[at] = [a, b, v];
            faces.extend([[b, c, v], [c, a, v]]);
        }
    }
    TriangleMesh::new(points, faces).expect("splits and flips keep a mesh manifold")
}

/// The mesh without the faces at some vertices; `None` when that leaves no manifold.
fn opened(mesh: &TriangleMesh, seed: u64) -> Option<TriangleMesh> {
    let mut random = Random::new(seed);
    let gone: Vec<bool> = mesh.vertex_ids().map(|_| random.unit() < 0.06).collect();
    let is_kept = |f: &&[VertexId; 3]| f.iter().all(|v| !gone[v.index()]);
    let kept: Vec<[VertexId; 3]> = mesh.faces().iter().filter(is_kept).copied().collect();
    let mut used: Vec<VertexId> = kept.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let id = |v| VertexId::from_index(used.binary_search(&v).expect("it is used"));
    let faces = kept.iter().map(|f| f.map(id)).collect();
    let points = used.iter().map(|&v| mesh.position(v)).collect();
    TriangleMesh::new(points, faces)
        .ok()
        .filter(|mesh| mesh.n_faces() > 0)
}

/// A torus of n × 2n squares, each cut in two.
fn torus(n: u32) -> TriangleMesh {
    let id = |i: u32, j: u32| VertexId(i % n * 2 * n + j % (2 * n));
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..2 * n).map(move |j| (i, j))) {
        let [u, w] = [i, j].map(|k| f64::from(k) * std::f64::consts::TAU);
        let [(su, cu), (sw, cw)] = [u / f64::from(n), w / f64::from(2 * n)].map(sin_cos);
        points.push(DVec3::new((2.0 + cu) * cw, (2.0 + cu) * sw, su));
        faces.push([id(i, j), id(i, j + 1), id(i + 1, j + 1)]);
        faces.push([id(i, j), id(i + 1, j + 1), id(i + 1, j)]);
    }
    TriangleMesh::new(points, faces).expect("a torus is closed")
}

fn moved(mesh: &TriangleMesh, to: impl Fn(DVec3) -> DVec3) -> TriangleMesh {
    mesh.with_positions(mesh.positions().iter().map(|&p| to(p)).collect())
}

fn collapsed(mesh: &TriangleMesh) -> CollapseHierarchy {
    collapse_to_tetrahedron(mesh.clone(), &Progress::none()).expect("it is closed, of genus 0")
}

fn simplified(mesh: &TriangleMesh, n_faces: usize) -> Simplified {
    simplify(mesh, &Settings { n_faces }, &Progress::none()).expect("4 faces or more")
}

/// Removed vertices and the rings that they left, in the order of rounds.
fn record(hierarchy: &CollapseHierarchy) -> Vec<(VertexId, Vec<VertexId>)> {
    let collapses = (0..hierarchy.n_collapses()).map(|i| hierarchy.collapse(i));
    collapses.map(|c| (c.vertex, c.ring.to_vec())).collect()
}

fn topology(mesh: &TriangleMesh) -> (i64, usize, usize) {
    (
        mesh.euler_number(),
        mesh.border_loops().len(),
        mesh.face_components().1,
    )
}

proptest! {
    #[test]
    fn every_closed_mesh_collapses_and_can_be_undone(seed: u64, n_edits in 0..300_usize) {
        let mesh = edited(seed, n_edits);
        let hierarchy = collapsed(&mesh);
        prop_assert_eq!(hierarchy.check(), Ok(()));
        prop_assert_eq!(hierarchy.mesh(), &mesh);
        let levels = [4, mesh.n_vertices() / 2, mesh.n_vertices()];
        for n in levels.map(|n| n.max(4)) {
            prop_assert_eq!(hierarchy.faces_at(n).map(|faces| faces.len()), Ok(2 * n - 4));
        }
    }

    #[test]
    fn shape_never_stands_in_the_way(seed: u64, n_edits in 0..200_usize, kind in 0..4) {
        let mesh = moved(&edited(seed, n_edits), |p| match kind {
            0 => (p * 2.0).round(),
            1 => p.with_y(0.0),
            2 => p * 1e307,
            _ => DVec3::splat(1e12) + p,
        });
        prop_assert_eq!(collapsed(&mesh).check(), Ok(()));
        prop_assert_eq!(simplified(&mesh, 4).mesh.n_faces(), 4);
    }

    #[test]
    fn simplifying_keeps_the_topology(seed: u64, n_edits in 0..200_usize, n_faces in 4..200_usize) {
        let closed = edited(seed, n_edits);
        let meshes = [Some(closed.clone()), opened(&closed, seed), Some(torus(3 + seed as u32 % 9))];
        for mesh in meshes.into_iter().flatten() {
            let Simplified { mesh: result, report } = simplified(&mesh, n_faces);
            prop_assert_eq!(topology(&result), topology(&mesh));
            prop_assert_eq!(report.n_faces, result.n_faces());
            prop_assert_eq!(report.complete, result.n_faces() <= n_faces);
            prop_assert!(report.complete || !mesh.is_closed() || mesh.euler_number() != 2);
            prop_assert!(result.n_faces() + 1 >= n_faces.min(mesh.n_faces()));
        }
    }

    #[test]
    fn a_larger_mesh_gets_the_same_record(seed: u64, exponent in -60..60_i32) {
        let mesh = edited(seed, 60);
        let scale = 2.0_f64.powi(exponent);
        let larger = moved(&mesh, |p| p * scale);
        prop_assert_eq!(record(&collapsed(&mesh)), record(&collapsed(&larger)));
        let wanted = moved(&simplified(&mesh, 20).mesh, |p| p * scale);
        prop_assert_eq!(simplified(&larger, 20).mesh, wanted);
    }
}

#[test]
fn renumbered_vertices_are_collapsed_in_the_same_order() {
    for mesh in [shapes::blob(3, 9), shapes::limbs(4, 9)] {
        let n = mesh.n_vertices();
        let mut order: Vec<usize> = (0..n).collect();
        let mut random = Random::new(5);
        (1..n).for_each(|i| order.swap(i, (random.unit() * (i + 1) as f64) as usize));
        let new = |v: VertexId| VertexId::from_index(order[v.index()]);
        let mut points = vec![DVec3::ZERO; n];
        mesh.vertex_ids()
            .for_each(|v| points[new(v).index()] = mesh.position(v));
        let faces = mesh.faces().iter().map(|f| f.map(new)).collect();
        let renumbered = TriangleMesh::new(points, faces).expect("only the names differ");
        let mut wanted = record(&collapsed(&mesh));
        for (v, ring) in &mut wanted {
            *v = new(*v);
            for w in ring {
                *w = new(*w);
            }
        }
        assert_eq!(record(&collapsed(&renumbered)), wanted);
    }
}

#[test]
fn a_mirrored_mesh_is_collapsed_in_the_same_order() {
    for mesh in [shapes::blob(6, 9), shapes::limbs(7, 9)] {
        let points = mesh.positions().iter().map(|p| p.with_x(-p.x)).collect();
        let faces = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
        let mirrored = TriangleMesh::new(points, faces).expect("only the orientation differs");
        let goals = |mesh| {
            let record = record(&collapsed(mesh)).into_iter();
            record.map(|(v, ring)| (v, ring[0])).collect::<Vec<_>>()
        };
        assert_eq!(goals(&mesh), goals(&mirrored));
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let mesh = shapes::limbs(8, 40);
    let with = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build();
        let pool = pool.expect("threads can be had");
        pool.install(|| (record(&collapsed(&mesh)), simplified(&mesh, 500)))
    };
    let [one, again, four] = [1, 1, 4].map(with);
    assert!(one == again && one == four);
}

#[test]
fn what_cannot_be_collapsed_is_said_with_numbers() {
    let message = |mesh: TriangleMesh| {
        let error = collapse_to_tetrahedron(mesh, &Progress::none()).expect_err("it has handles");
        error.to_string()
    };
    assert_eq!(
        message(torus(5)),
        "genus 1: only genus 0 can be collapsed to a tetrahedron"
    );
    let open = opened(&shapes::sphere(4), 0).expect("the holes do not touch");
    let loops = open.border_loops();
    let n_edges: usize = loops.iter().map(Vec::len).sum();
    let wanted = format!(
        "{} border loops, {n_edges} border edges: only closed meshes can be collapsed",
        loops.len()
    );
    assert_eq!(message(open), wanted);
}

#[test]
fn both_stop_when_cancelled() {
    let token = CancelToken::new();
    token.cancel();
    let progress = Progress::silent(token);
    let mesh = shapes::sphere(5);
    let error = simplify(&mesh, &Settings { n_faces: 9 }, &progress).expect_err("cancelled");
    assert_eq!(error.to_string(), "cancelled");
    let error = collapse_to_tetrahedron(mesh, &progress).expect_err("cancelled");
    assert!(matches!(error, CollapseError::Cancelled(_)));
}
