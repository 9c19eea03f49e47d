//! Closed meshes for tests, chosen by property: round, bumpy, with corners, long, with limbs.
#![allow(dead_code, missing_docs)] // Every test file uses a part of them.

pub mod closing;
pub mod conformance;
pub mod edits;
pub mod guided;

use glam::{DMat3, DVec3};
use orbflow_geometry::elementary::{cos, exp, sin, sin_cos};
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh, VertexId};
use orbflow_geometry::random::Random;

/// The sides of a cube whose corner `i` has a coordinate up for every bit of `i`.
pub const CUBE_QUADS: [[u32; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

/// A sphere of radius 1: a cube of n × n squares a side, each cut in two, blown up.
pub fn sphere(n: u32) -> TriangleMesh {
    mapped_cube(n, |p| p.normalize_or(DVec3::Z))
}

/// A box with sharp edges, of sides 1, 0.8 and 0.6.
pub fn cuboid(n: u32) -> TriangleMesh {
    mapped_cube(n, |p| p * DVec3::new(0.5, 0.4, 0.3))
}

/// A straight rod of radius 1 with round ends, `length` between the ends' centres.
pub fn capsule(length: f64, n: u32) -> TriangleMesh {
    mapped_cube(n, |p| {
        let s = p.normalize_or(DVec3::Z);
        // The middle third of the cube's height becomes the straight part.
        let along = (p.z * 1.5).clamp(-0.5, 0.5) * length;
        let stretched = DVec3::new(
            p.x,
            p.y,
            (p.z.abs() - 1.0 / 3.0).max(0.0) * 1.5 * p.z.signum(),
        );
        stretched.normalize_or(s) + DVec3::Z * along
    })
}

/// A smooth star-shaped body with random bumps.
pub fn blob(seed: u64, n: u32) -> TriangleMesh {
    let mut random = Random::new(seed);
    let mut vector = || DVec3::new(random.unit(), random.unit(), random.unit()) * 2.0 - 1.0;
    let waves: Vec<(DVec3, DVec3)> = (0..5).map(|_| (vector() * 4.0, vector() * 3.0)).collect();
    mapped_cube(n, |p| {
        let s = p.normalize_or(DVec3::Z);
        let bumps: f64 = waves.iter().map(|(k, phase)| sin(k.dot(s) + phase.x)).sum();
        s * (1.0 + 0.09 * bumps)
    })
}

/// A ball with six limbs of random length, bent; not star-shaped once bent.
pub fn limbs(seed: u64, n: u32) -> TriangleMesh {
    let mut random = Random::new(seed);
    let axes = [
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::NEG_X,
        DVec3::NEG_Y,
        DVec3::NEG_Z,
    ];
    let lengths = axes.map(|_| 1.0 + 2.5 * random.unit());
    let bend = 0.15 + 0.25 * random.unit();
    mapped_cube(n, |p| {
        let s = p.normalize_or(DVec3::Z);
        let mut radius = 1.0;
        for (axis, length) in axes.iter().zip(lengths) {
            radius += length * exp(-(1.0 - axis.dot(s)) * 14.0);
        }
        let q = s * radius;
        DMat3::from_rotation_z(bend * q.length()) * DMat3::from_rotation_x(bend * q.z) * q
    })
}

/// Some closed meshes of genus 0 with about 6 n² × 2 faces each.
pub fn closed(n: u32) -> Vec<(&'static str, TriangleMesh)> {
    vec![
        ("sphere", sphere(n)),
        ("cuboid", cuboid(n)),
        ("capsule", capsule(6.0, n)),
        ("blob", blob(1, n)),
        ("limbs", limbs(2, n)),
    ]
}

/// The same mesh as polygons.
pub fn polygons(mesh: &TriangleMesh) -> PolygonMesh {
    mesh.into()
}

/// A cube of side 2 with n × n squares a side, cut alternately and mapped point by point.
pub fn mapped_cube(n: u32, map: impl Fn(DVec3) -> DVec3) -> TriangleMesh {
    let index = |p: [u32; 3]| (p[0] * (n + 1) + p[1]) * (n + 1) + p[2];
    let mut ids = vec![u32::MAX; (n as usize + 1).pow(3)];
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    let mut vertex = |p: [u32; 3]| {
        let id = &mut ids[index(p) as usize];
        if *id == u32::MAX {
            *id = positions.len() as u32;
            let corner = DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
            positions.push(map(corner * 2.0 / f64::from(n) - 1.0));
        }
        VertexId(*id)
    };
    for (axis, end, i, j) in (0..3).flat_map(|axis| {
        [0, n]
            .into_iter()
            .flat_map(move |end| (0..n).flat_map(move |i| (0..n).map(move |j| (axis, end, i, j))))
    }) {
        let at = |i: u32, j: u32| {
            let mut p = [0; 3];
            p[axis] = end;
            p[(axis + 1) % 3] = i;
            p[(axis + 2) % 3] = j;
            p
        };
        let mut quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)].map(&mut vertex);
        if end == 0 {
            quad.reverse();
        }
        let [a, b, c, d] = quad;
        let cut = if (i + j) % 2 == 0 {
            [[a, b, c], [a, c, d]]
        } else {
            [[a, b, d], [b, c, d]]
        };
        faces.extend(cut);
    }
    TriangleMesh::new(positions, faces).expect("a cube's surface is closed")
}

/// A ring of genus 1 with n × m quads, each cut in two.
pub fn torus(n: u32, m: u32) -> TriangleMesh {
    let angle = |i: u32, n: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
    let point = |i: u32, j: u32| {
        let (s, c) = sin_cos(angle(i, n));
        let radius = 1.0 + 0.4 * cos(angle(j, m));
        DVec3::new(c * radius, s * radius, 0.4 * sin(angle(j, m)))
    };
    let positions = (0..n)
        .flat_map(|i| (0..m).map(move |j| point(i, j)))
        .collect();
    let id = |i: u32, j: u32| VertexId((i % n) * m + j % m);
    let faces = (0..n).flat_map(|i| {
        (0..m).flat_map(move |j| {
            let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
    });
    TriangleMesh::new(positions, faces.collect()).expect("a torus is closed")
}

/// A tube of `n` sides and `m` rings of quads, open at both ends, its vertices ring by ring.
pub fn open_tube([n, m]: [u32; 2]) -> PolygonMesh {
    let point = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i % n) / f64::from(n);
        let (sin, cos) = sin_cos(angle);
        DVec3::new(cos, sin, f64::from(i / n))
    };
    let quad = |i: u32| {
        let [ring, side] = [i / n * n, i % n];
        let next = (side + 1) % n;
        [ring + side, ring + next, ring + n + next, ring + n + side]
    };
    let points = (0..n * (m + 1)).map(point).collect();
    let quads: Vec<[u32; 4]> = (0..n * m).map(quad).collect();
    PolygonMesh::from_faces(points, &quads).expect("quads have corners that exist")
}

/// Rings of `n` corners round a path, closed by flat ends.
pub fn swept(path: &[DVec3], radius: f64, n: u32) -> TriangleMesh {
    let mut positions = Vec::new();
    let mut up = DVec3::new(0.1, 0.2, 1.0);
    for (i, &at) in path.iter().enumerate() {
        let [from, to] = [i.saturating_sub(1), (i + 1).min(path.len() - 1)].map(|i| path[i]);
        let way = (to - from).normalize_or(DVec3::X);
        up = (up - way * up.dot(way)).normalize_or(DVec3::Z);
        let side = way.cross(up);
        for k in 0..n {
            let (sin, cos) = sin_cos(f64::from(k) / f64::from(n) * std::f64::consts::TAU);
            positions.push(at + (up * cos + side * sin) * radius);
        }
    }
    let mut faces = Vec::new();
    let last = n * (path.len() as u32 - 1);
    for k in 0..n {
        let next = (k + 1) % n;
        for ring in (0..last).step_by(n as usize) {
            let [a, b, c, d] = [ring + k, ring + next, ring + n + next, ring + n + k];
            faces.extend([[a, b, c], [a, c, d]]);
        }
        if k > 1 {
            faces.extend([[0, k, k - 1], [last, last + k - 1, last + k]]);
        }
    }
    let faces = faces.into_iter().map(|f| f.map(VertexId)).collect();
    TriangleMesh::new(positions, faces).expect("the shape is a surface")
}
