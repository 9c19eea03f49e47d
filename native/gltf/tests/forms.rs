//! The ways in which one and the same mesh can be written down.

#![allow(clippy::unwrap_used)] // What helps tests is a test.

mod support;

use std::fs;

use glam::DVec3;
use orbflow_gltf::{Container, Scene, plain};
use serde_json::{Value, json};
use support::{File, parts};

const POINTS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]];
const FACES: [u16; 6] = [0, 1, 2, 0, 2, 3];

fn one(primitive: &Value) -> Value {
    json!({"nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}]})
}

fn triangles(file: &[u8]) -> Vec<[DVec3; 3]> {
    let scene = Scene::read(file, None).unwrap();
    let mesh = scene.mesh();
    let faces = mesh
        .faces()
        .map(|face| [0, 1, 2].map(|i| mesh.position(face[i])));
    faces.collect()
}

fn wanted() -> Vec<[DVec3; 3]> {
    let point = |i: u16| DVec3::from_array(POINTS[i as usize].map(f64::from));
    FACES
        .chunks_exact(3)
        .map(|f| [f[0], f[1], f[2]].map(point))
        .collect()
}

#[test]
fn strips_fans_and_lists_without_indices_are_read() {
    let with = |mode: u32, indices: &[u16]| {
        let mut file = File::default();
        let points = file.floats(&POINTS);
        let indices = file.indices(indices);
        let attributes = json!({"POSITION": points});
        file.glb(one(
            &json!({"mode": mode, "attributes": attributes, "indices": indices}),
        ))
    };
    assert_eq!(triangles(&with(4, &FACES)), wanted());
    assert_eq!(triangles(&with(6, &[0, 1, 2, 3])), wanted());
    let strip = triangles(&with(5, &[1, 2, 0, 3]));
    let turned = |t: &[DVec3; 3]| [t[1], t[2], t[0]];
    assert_eq!(
        strip,
        [
            turned(&wanted()[0]),
            [wanted()[1][0], wanted()[1][1], wanted()[1][2]]
        ]
    );
    let mut file = File::default();
    let points = file.floats(&FACES.map(|i| POINTS[i as usize]));
    let file = file.glb(one(&json!({"attributes": {"POSITION": points}})));
    assert_eq!(triangles(&file), wanted());
}

#[test]
fn quantised_interleaved_and_sparse_positions_are_read() {
    // Words of 16 bits, of which 32767 is 1, every 8 bytes; the node makes them what they were.
    let mut file = File::default();
    let words = POINTS.map(|p| p.map(|x| (x * 32767.0).round() as i16));
    let bytes: Vec<u8> = words
        .iter()
        .flat_map(|p| [p[0], p[1], p[2], 99].map(i16::to_le_bytes).concat())
        .collect();
    let points = file.accessor("VEC3", 5122, &bytes, 4);
    file.accessors[points]["normalized"] = json!(true);
    file.views[0]["byteStride"] = json!(8);
    let indices = file.indices(&FACES);
    let mut text = one(&json!({"attributes": {"POSITION": points}, "indices": indices}));
    text["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    for (a, b) in triangles(&file.glb(text))
        .iter()
        .flatten()
        .zip(wanted().iter().flatten())
    {
        assert!(a.distance(*b) < 1e-4, "{a} {b}");
    }

    let mut file = File::default();
    let mut low = POINTS;
    low[3][2] = 0.0;
    let points = file.floats(&low);
    let (which, what) = (
        file.view(&[3]),
        file.view(&POINTS[3].map(f32::to_le_bytes).concat()),
    );
    file.accessors[points]["sparse"] = json!({"count": 1,
        "indices": {"bufferView": which, "componentType": 5121}, "values": {"bufferView": what}});
    let indices = file.indices(&FACES);
    let text = one(&json!({"attributes": {"POSITION": points}, "indices": indices}));
    assert_eq!(triangles(&file.glb(text)), wanted());
}

#[test]
fn text_with_bytes_in_it_or_beside_it_is_the_same_scene() {
    let file = support::scene();
    let (mut text, bytes) = parts(&file);
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("all bytes.bin"), &bytes).unwrap();
    fs::write(folder.path().join("picture.jpg"), b"\xff\xd8 a picture").unwrap();
    text["buffers"][0]["uri"] = json!("all%20bytes.bin");
    text["images"] = json!([{"uri": "picture.jpg"}, {"uri": "https://nobody/picture.png"}]);
    let text = text.to_string();
    let beside = Scene::read(text.as_bytes(), Some(folder.path())).unwrap();
    let own = Scene::read(&file, None).unwrap();
    assert_eq!(beside.mesh(), own.mesh());
    let notes = beside.notes().join("\n");
    assert!(
        notes.contains("image 1 is the file 'https://nobody/picture.png', which"),
        "{notes}"
    );
    assert!(!notes.contains("image 0"), "{notes}");
    let alone = Scene::read(text.as_bytes(), None).unwrap_err().to_string();
    assert!(
        alone.starts_with("buffer 0 is the file 'all%20bytes.bin'"),
        "{alone}"
    );
    assert!(
        alone.ends_with("what comes from a stream has no files beside it"),
        "{alone}"
    );
}

#[test]
fn a_plain_mesh_becomes_a_scene_and_comes_back() {
    let own = Scene::read(&support::scene(), None).unwrap().plain();
    assert_eq!(own.material_names, ["red", "blue", "default"]);
    for container in [Container::Glb, Container::Gltf] {
        let file = plain(&own, container).unwrap();
        gltf::Gltf::from_slice(&file).unwrap();
        let again = Scene::read(&file, None).unwrap().plain();
        assert_eq!(again.material_names, own.material_names);
        assert_eq!(again.mesh.n_faces(), own.mesh.n_faces());
        assert_eq!(again.materials, own.materials);
        let corners = |file: &orbflow_geometry::mesh::io::MeshFile| -> Vec<DVec3> {
            let corners = file.mesh.corners().iter();
            corners.map(|&v| file.mesh.position(v)).collect()
        };
        for (a, b) in corners(&again).into_iter().zip(corners(&own)) {
            assert!(a.distance(b) < 1e-6);
        }
        for (a, b) in again.coordinates.iter().zip(&own.coordinates) {
            let ([a, b], [c, d]) = (a.unwrap(), b.unwrap_or([0.0, 0.0]));
            assert!((a - c).abs() < 1e-6 && (b - d).abs() < 1e-6);
        }
    }
    let nothing = plain(
        &orbflow_geometry::mesh::io::MeshFile::default(),
        Container::Glb,
    )
    .unwrap();
    gltf::Gltf::from_slice(&nothing).unwrap();
}
