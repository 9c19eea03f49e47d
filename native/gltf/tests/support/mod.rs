//! Makes files, has them remeshed, and looks into what comes out.
#![allow(dead_code)] // Every test file uses a part of it.

use std::sync::OnceLock;

use glam::DVec3;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::pipeline::{self, Input, Settings};
use orbflow_geometry::progress::Progress;
use orbflow_gltf::{Container, Made, Scene};
use serde_json::{Value, json};

/// Squares along an edge of a side of [`ball`].
const SQUARES: usize = 6;
/// Faces that are asked for.
pub const FACES: usize = 500;
/// How far the morph target moves the upper side.
pub const RISE: f64 = 0.5;
/// The corners of a speck that is too small to be remeshed.
pub const SPECK: [[f32; 3]; 4] = [
    [3.0, 0.1, 0.0],
    [3.01, 0.1, 0.0],
    [3.0, 0.11, 0.0],
    [3.0, 0.1, 0.013],
];

/// A file while it is made.
#[derive(Default)]
pub struct File {
    pub accessors: Vec<Value>,
    pub views: Vec<Value>,
    pub bytes: Vec<u8>,
}

impl File {
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let (at, n) = (self.bytes.len(), bytes.len());
        self.views
            .push(json!({"buffer": 0, "byteOffset": at, "byteLength": n}));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    pub fn accessor(&mut self, kind: &str, component: u32, bytes: &[u8], count: usize) -> usize {
        let view = self.view(bytes);
        self.accessors.push(json!({
            "bufferView": view, "componentType": component, "count": count, "type": kind,
        }));
        self.accessors.len() - 1
    }

    pub fn floats<const N: usize>(&mut self, rows: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = rows
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"]
            .get(N)
            .unwrap_or(&"MAT4");
        let accessor = self.accessor(kind, 5126, &bytes, rows.len());
        if N == 3 {
            let bound = |f: fn(f32, f32) -> f32| -> Vec<f32> {
                let column = |i: usize| rows.iter().map(move |row| row[i]).reduce(f);
                (0..3).map(|i| column(i).unwrap_or(0.0)).collect()
            };
            self.accessors[accessor]["min"] = json!(bound(f32::min));
            self.accessors[accessor]["max"] = json!(bound(f32::max));
        }
        accessor
    }

    pub fn bytes<const N: usize>(&mut self, rows: &[[u8; N]]) -> usize {
        self.accessor("VEC4", 5121, &rows.concat(), rows.len())
    }

    pub fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        self.accessor("SCALAR", 5123, &bytes, indices.len())
    }

    /// The text with what was added.
    pub fn text(&self, mut text: Value) -> Value {
        text["asset"] = json!({"version": "2.0"});
        text["accessors"] = json!(self.accessors);
        text["bufferViews"] = json!(self.views);
        text["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        text
    }

    pub fn glb(&self, text: Value) -> Vec<u8> {
        glb(&self.text(text), &self.bytes)
    }
}

pub fn glb(text: &Value, bytes: &[u8]) -> Vec<u8> {
    let mut text = text.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bytes = bytes.to_vec();
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + bytes.len();
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", bytes)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

/// The text and the bytes of a GLB file.
pub fn parts(file: &[u8]) -> (Value, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    let text = serde_json::from_slice(&file[20..20 + word(12)]).unwrap();
    let at = 20 + word(12);
    (text, file[at + 8..at + 8 + word(at)].to_vec())
}

/// A place on a side of the ball, and where that is on the side: 0 to 1 both ways.
fn on_side(side: usize, i: usize, j: usize) -> ([f32; 3], [f32; 2]) {
    let [s, t] = [i, j].map(|i| i as f64 / SQUARES as f64);
    let [u, v] = [2.0 * s - 1.0, 2.0 * t - 1.0];
    let w = if side < 3 { 1.0 } else { -1.0 };
    let p = match side % 3 {
        0 => DVec3::new(w, u, v),
        1 => DVec3::new(v, w, u),
        _ => DVec3::new(u, v, w),
    };
    (
        p.normalize_or_zero().as_vec3().to_array(),
        [s as f32, t as f32],
    )
}

/// The side of the ball that a place is on, and where that is there.
pub fn side_of(p: DVec3) -> (usize, [f64; 2]) {
    let axis = p.abs().max_position();
    let q = p / p[axis].abs();
    let [u, v] = match axis {
        0 => [q.y, q.z],
        1 => [q.z, q.x],
        _ => [q.x, q.y],
    };
    let side = if p[axis] > 0.0 { axis } else { axis + 3 };
    (side, [u, v].map(share))
}

/// The texture coordinates of a place of a side: the sides lie beside each other, with gaps.
pub fn coordinate(side: usize, [s, t]: [f64; 2]) -> [f64; 2] {
    [(side as f64 + 0.1 + 0.8 * s) / 6.0, 0.1 + 0.8 * t]
}

/// The share of the second bone.
pub fn share(z: f64) -> f64 {
    z.midpoint(1.0)
}

/// Three sides of the ball that share no vertex with each other, with all that can lie on them.
fn half(file: &mut File, sides: std::ops::Range<usize>, speck: bool) -> Value {
    let (mut points, mut coordinates, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for side in sides {
        let first = points.len() as u16;
        for (i, j) in (0..=SQUARES).flat_map(|i| (0..=SQUARES).map(move |j| (i, j))) {
            let (point, at) = on_side(side, i, j);
            points.push(point);
            coordinates.push(coordinate(side, at.map(f64::from)).map(|x| x as f32));
        }
        let name = |i: usize, j: usize| first + (i * (SQUARES + 1) + j) as u16;
        for (i, j) in (0..SQUARES).flat_map(|i| (0..SQUARES).map(move |j| (i, j))) {
            let quad = [
                name(i, j),
                name(i + 1, j),
                name(i + 1, j + 1),
                name(i, j + 1),
            ];
            let turn = if side < 3 {
                [0, 1, 2, 0, 2, 3]
            } else {
                [0, 2, 1, 0, 3, 2]
            };
            indices.extend(turn.map(|k| quad[k]));
        }
    }
    if speck {
        let first = points.len() as u16;
        points.extend(SPECK);
        coordinates.extend([[0.0, 0.0]; 4]);
        indices.extend([0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2].map(|i| first + i));
    }
    let byte = |x: f32| (255.0 * share(f64::from(x)).clamp(0.0, 1.0)).round() as u8;
    let colors: Vec<_> = points.iter().map(|p| [byte(p[2]), 0, 255, 255]).collect();
    let shares = points
        .iter()
        .map(|p| share(f64::from(p[2])).clamp(0.0, 1.0) as f32);
    let weights: Vec<_> = shares.map(|share| [1.0 - share, share, 0.0, 0.0]).collect();
    let joints = vec![[0, 1, 0, 0]; points.len()];
    let rises = |p: &[f32; 3]| side_of(DVec3::from_array(p.map(f64::from))).0 == 2;
    let rising: Vec<u16> = (0..points.len() as u16)
        .filter(|&i| rises(&points[i as usize]) && points[i as usize][2] > 0.9)
        .collect();
    let color = file.bytes(&colors);
    file.accessors[color]["normalized"] = json!(true);
    let morph = sparse(file, &rising, points.len());
    json!({
        "attributes": {
            "POSITION": file.floats(&points),
            "NORMAL": file.floats(&points),
            "TANGENT": file.floats(&vec![[1.0, 0.0, 0.0, 1.0]; points.len()]),
            "TEXCOORD_0": file.floats(&coordinates),
            "COLOR_0": color,
            "JOINTS_0": file.bytes(&joints),
            "WEIGHTS_0": file.floats(&weights),
            "_TEMPERATURE": file.floats(&vec![[1.0]; points.len()]),
        },
        "indices": file.indices(&indices),
        "targets": [{"POSITION": morph}],
    })
}

/// An accessor that is zero but at some elements.
fn sparse(file: &mut File, which: &[u16], n: usize) -> usize {
    let indices: Vec<u8> = which.iter().flat_map(|i| i.to_le_bytes()).collect();
    let up = [0.0, 0.0, RISE as f32]
        .map(f32::to_le_bytes)
        .concat()
        .repeat(which.len());
    let (indices, values) = (file.view(&indices), file.view(&up));
    file.accessors.push(json!({
        "componentType": 5126, "count": n, "type": "VEC3",
        "min": [0, 0, 0], "max": [0, 0, RISE],
        "sparse": {"count": which.len(), "indices": {"bufferView": indices, "componentType": 5123},
            "values": {"bufferView": values}},
    }));
    file.accessors.len() - 1
}

/// A ball of two materials, with bones and a morph target, a stone that two nodes show, a picture, an
/// animation, and what only others understand.
pub fn scene() -> Vec<u8> {
    let mut file = File::default();
    let picture = file.view(b"\x89PNG not really");
    let mut halves = [half(&mut file, 0..3, true), half(&mut file, 3..6, false)];
    for (material, half) in halves.iter_mut().enumerate() {
        half["material"] = json!(material);
    }
    let stone = half(&mut file, 0..6, false);
    let stone = json!({"attributes": {"POSITION": stone["attributes"]["POSITION"]},
        "indices": stone["indices"]});
    let mut rest = [[0.0; 16]; 2];
    for matrix in &mut rest {
        for i in 0..4 {
            matrix[5 * i] = 1.0;
        }
    }
    let bound = file.floats(&rest);
    let times = file.floats(&[[0.0], [1.0]]);
    file.accessors[times]["min"] = json!([0.0]);
    file.accessors[times]["max"] = json!([1.0]);
    let turns = file.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0]]);
    file.glb(json!({
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2, 4, 5]}],
        "nodes": [
            {"mesh": 0, "skin": 0, "name": "ball", "translation": [9, 9, 9]},
            {"name": "root", "children": [3]},
            {"mesh": 1, "translation": [6, 0, 0], "scale": [1, -0.5, 1], "name": "stone"},
            {"name": "tip", "translation": [0, 0, 0]},
            {"mesh": 1, "translation": [9, 0, 0], "name": "the same stone"},
            {"camera": 0, "extras": {"note": [0.1, 1e-7, "kept"]}},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}],
        "meshes": [
            {"primitives": halves, "weights": [0.25], "extras": {"targetNames": ["rise"]}},
            {"primitives": [stone]},
        ],
        "materials": [
            {"name": "red", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
            {"name": "blue", "emissiveFactor": [0.0, 0.0, 0.123_456_789]},
        ],
        "textures": [{"source": 0}],
        "images": [{"bufferView": picture, "mimeType": "image/png"}],
        "skins": [{"joints": [1, 3], "inverseBindMatrices": bound, "skeleton": 1}],
        "animations": [{
            "channels": [{"sampler": 0, "target": {"node": 3, "path": "rotation"}}],
            "samplers": [{"input": times, "output": turns}],
        }],
        "extensionsUsed": ["NOBODY_knows"],
        "extensions": {"NOBODY_knows": {"index": 3}},
    }))
}

/// A file that was remeshed, and what was said of it.
pub struct Done {
    pub file: Vec<u8>,
    pub notes: Vec<String>,
}

pub fn remeshed(file: &[u8], faces: usize, container: Container) -> Done {
    let scene = Scene::read(file, None).unwrap();
    let cuts = scene.cuts(Some(1e-5));
    let input = Input {
        cuts: Some(&cuts.sets),
        ..Input::new(scene.mesh())
    };
    let settings = Settings {
        faces,
        ..Settings::default()
    };
    let made = pipeline::remesh(input, &settings, &Solver::default(), &Progress::none()).unwrap();
    let origins = made.origins.as_ref().unwrap();
    let made = Made {
        mesh: &made.mesh,
        origins,
    };
    let written = scene.written(made, &cuts, container).unwrap();
    let notes = scene.notes().iter().chain(&written.notes).cloned();
    Done {
        notes: notes.collect(),
        file: written.bytes,
    }
}

/// The scene remeshed.
pub fn done() -> &'static Done {
    static DONE: OnceLock<Done> = OnceLock::new();
    DONE.get_or_init(|| remeshed(&scene(), FACES, Container::Glb))
}
