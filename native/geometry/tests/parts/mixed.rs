//! Meshes of several parts, good and bad.

use glam::DVec3;
use orbflow_geometry::elementary::direction;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh};
use orbflow_geometry::pipeline::{self, Error, Input, Kept, Primitive, Remeshed, Settings};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::random::Random;

pub fn ball(n: u32) -> TriangleMesh {
    super::common::sphere(n)
}

pub fn cube(n: u32) -> TriangleMesh {
    super::common::cuboid(n)
}

/// Quads that flow, unless there are few; one thread.
pub fn settings(faces: usize) -> Settings {
    Settings {
        faces,
        threads: 1,
        ..Settings::default()
    }
}

/// The quads of a blown up box: parts with borders or handles stay.
pub fn sphere(faces: usize) -> Settings {
    Settings {
        primitive: Some(Primitive::QuadSphere),
        ..settings(faces)
    }
}

pub fn remesh(mesh: &PolygonMesh, settings: &Settings) -> Result<Remeshed, Error> {
    let (input, quiet) = (Input::new(mesh), Progress::none());
    pipeline::remesh(input, settings, &Solver::default(), &quiet)
}

/// The kinds of the reasons of a part, as reports name them.
pub fn kinds(kept: &Kept) -> Vec<String> {
    let told = serde_json::to_value(&kept.reasons).expect("reasons are words and numbers");
    let reasons = told.as_array().expect("a list").iter();
    let kinds = reasons.map(|reason| reason["kind"].as_str().expect("a word").to_owned());
    kinds.collect()
}

/// Faces that are being put together.
#[derive(Default)]
pub struct Mixed {
    pub positions: Vec<DVec3>,
    pub faces: Vec<Vec<u32>>,
}

impl Mixed {
    pub fn mesh(&self) -> PolygonMesh {
        PolygonMesh::from_faces(self.positions.clone(), &self.faces).expect("the faces are good")
    }

    pub fn add(&mut self, mesh: &TriangleMesh, shift: DVec3, scale: f64) {
        let first = self.positions.len() as u32;
        let positions = mesh.positions().iter();
        self.positions.extend(positions.map(|&p| p * scale + shift));
        let faces = mesh.faces().iter();
        self.faces
            .extend(faces.map(|f| f.iter().map(|v| v.0 + first).collect()));
    }

    pub fn add_faces(&mut self, points: &[[f64; 3]], faces: &[&[u32]]) {
        let first = self.positions.len() as u32;
        self.positions
            .extend(points.iter().map(|&p| DVec3::from_array(p)));
        let faces = faces.iter();
        self.faces
            .extend(faces.map(|f| f.iter().map(|v| v + first).collect()));
    }

    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        let faces = other.faces.iter();
        self.faces
            .extend(faces.map(|f| f.iter().map(|v| v + first).collect()));
    }

    /// A solid and one-sided scraps around it, their faces among each other, and which are the
    /// scraps'.
    pub fn scattered(
        solid: &TriangleMesh,
        n_scraps: usize,
        size: f64,
        seed: u64,
    ) -> (PolygonMesh, Vec<usize>) {
        let mut random = Random::new(seed);
        let mut mixed = Self::default();
        mixed.add(solid, DVec3::ZERO, 1.0);
        let n_solid = mixed.faces.len();
        for i in 0..n_scraps {
            let shift = DVec3::new(5.0 + 3.0 * i as f64, random.unit(), random.unit());
            let points = [[0, 0], [1, 0], [1, 1], [0, 1], [2, 2], [0, 2]].map(|[x, y]| {
                (shift + DVec3::new(f64::from(x), f64::from(y), random.unit())).to_array()
            });
            // A moebius strip.
            mixed.add_faces(
                &points,
                &[&[0, 1, 2, 3], &[3, 2, 4, 5], &[5, 4, 0], &[5, 0, 1]],
            );
        }
        for p in &mut mixed.positions {
            *p *= size;
        }
        let mut order: Vec<usize> = (0..mixed.faces.len()).collect();
        for i in (1..order.len()).rev() {
            order.swap(i, random.below(i + 1));
        }
        mixed.faces = order.iter().map(|&i| mixed.faces[i].clone()).collect();
        let is_scrap = |&i: &usize| order[i] >= n_solid;
        let scraps = (0..order.len()).filter(is_scrap).collect();
        (mixed.mesh(), scraps)
    }
}

/// A box with a wall inside that shares its edges with the sides.
pub fn walled_box(shift: DVec3) -> Mixed {
    let mut mixed = Mixed::default();
    let points: Vec<[f64; 3]> = (0..12)
        .map(|i| {
            let corner = [f64::from(i % 3), f64::from(i / 3 % 2), f64::from(i / 6)];
            (DVec3::from_array(corner) + shift).to_array()
        })
        .collect();
    mixed.add_faces(
        &points,
        &[
            &[0, 3, 4, 1],
            &[1, 4, 5, 2],
            &[6, 7, 10, 9],
            &[7, 8, 11, 10],
            &[0, 1, 7, 6],
            &[1, 2, 8, 7],
            &[3, 9, 10, 4],
            &[4, 10, 11, 5],
            &[0, 6, 9, 3],
            &[2, 5, 11, 8],
            &[1, 4, 10, 7],
        ],
    );
    mixed
}

/// A strip of twelve quads that turns by half on its way round.
pub fn moebius_strip(shift: DVec3) -> Mixed {
    let points: Vec<[f64; 3]> = (0..24)
        .map(|i| {
            let turn = f64::from(i / 2) / 12.0 * std::f64::consts::TAU;
            let [half, across] = [turn / 2.0, f64::from(i % 2) - 0.5];
            let round = direction(turn) * (2.0 + across * direction(half).x);
            (round.extend(across * direction(half).y) + shift).to_array()
        })
        .collect();
    let rung = |i: u32| if i < 12 { [2 * i, 2 * i + 1] } else { [1, 0] };
    let quad = |i: u32| [rung(i)[0], rung(i + 1)[0], rung(i + 1)[1], rung(i)[1]];
    let quads: Vec<[u32; 4]> = (0..12).map(quad).collect();
    let faces: Vec<&[u32]> = quads.iter().map(<[u32; 4]>::as_slice).collect();
    let mut mixed = Mixed::default();
    mixed.add_faces(&points, &faces);
    mixed
}

/// Two blocks that share an edge, with the edge's vertices in common.
pub fn touching_blocks() -> PolygonMesh {
    let corner = |i: u32, at: [u32; 3]| [at[0] + (i & 1), at[1] + (i >> 1 & 1), at[2] + (i >> 2)];
    let mut names: Vec<[u32; 3]> = Vec::new();
    let mut faces = Vec::new();
    for block in [[0, 0, 0], [1, 1, 0]] {
        for quad in super::common::CUBE_QUADS {
            let name = |i: u32| {
                let at = corner(i, block);
                names
                    .iter()
                    .position(|name| *name == at)
                    .unwrap_or_else(|| {
                        names.push(at);
                        names.len() - 1
                    }) as u32
            };
            let face: Vec<u32> = quad.map(name).to_vec();
            faces.push(face);
        }
    }
    let point = |at: &[u32; 3]| DVec3::from_array(at.map(f64::from));
    PolygonMesh::from_faces(names.iter().map(point).collect(), &faces).expect("blocks are a mesh")
}

/// A mesh cut in two at x = 0, the halves apart by a share of the diagonal.
pub fn split_along(mesh: &TriangleMesh, gap: f64) -> PolygonMesh {
    let mut positions = mesh.positions().to_vec();
    let [low, high] = orbflow_geometry::mesh::bounds(&positions);
    let shift = DVec3::X * (gap * high.distance(low));
    let mut twins = vec![None; positions.len()];
    let mut faces = Vec::new();
    for face in mesh.faces() {
        let middle: f64 = face.iter().map(|&v| mesh.position(v).x).sum();
        let name = |v: u32| {
            if middle < 0.0 {
                return v;
            }
            *twins[v as usize].get_or_insert_with(|| {
                positions.push(positions[v as usize] + shift);
                positions.len() as u32 - 1
            })
        };
        faces.push(face.map(|v| v.0).map(name).to_vec());
    }
    PolygonMesh::from_faces(positions, &faces).expect("halves are a mesh")
}
