//! What is written is read back; what is broken is an error and never a panic.

use glam::DVec3;
use orbflow_geometry::mesh::PolygonMesh;
use orbflow_geometry::mesh::io::{Format, MeshFile, WriteError, read, write};
use proptest::collection::vec;
use proptest::prelude::*;

const WRITTEN: [Format; 3] = [Format::Obj, Format::Ply, Format::Off];
const ALL: [Format; 4] = [Format::Obj, Format::Ply, Format::Stl, Format::Off];

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        -10.0..10.0f64,
        any::<f64>().prop_filter("finite", |x| x.is_finite()),
        Just(-0.0),
        Just(1e30),
        Just(f64::MIN_POSITIVE / 8.0),
    ]
}

fn mesh_file() -> impl Strategy<Value = MeshFile> {
    let points = vec([coordinate(), coordinate(), coordinate()], 1..20);
    let faces = vec(vec(any::<prop::sample::Index>(), 3..9), 0..20);
    let materials = (0..4usize, vec(any::<prop::sample::Index>(), 20));
    (points, faces, materials).prop_map(|(points, faces, (n_names, picked))| {
        let n = points.len();
        let positions = points.into_iter().map(DVec3::from_array).collect();
        let faces: Vec<Vec<u32>> = faces
            .iter()
            .map(|face| face.iter().map(|i| i.index(n) as u32).collect())
            .collect();
        let mut used: Vec<i32> = Vec::new();
        let mut materials = Vec::new();
        for pick in picked
            .iter()
            .take(if n_names > 0 { faces.len() } else { 0 })
        {
            let name = pick.index(n_names) as i32;
            let index = used.iter().position(|&u| u == name).unwrap_or(used.len());
            if index == used.len() {
                used.push(name);
            }
            materials.push(index as i32);
        }
        let coordinates = faces.iter().flatten().map(|&v| match v % 3 {
            0 => None,
            _ => Some([f64::from(v) / 7.0, -1e-9]),
        });
        let coordinates: Vec<_> = coordinates.collect();
        let has_coordinates = coordinates.iter().any(Option::is_some);
        MeshFile {
            mesh: PolygonMesh::from_faces(positions, &faces).expect("indices are in range"),
            materials,
            material_names: used.iter().map(|i| format!("paint {i}")).collect(),
            coordinates: if has_coordinates {
                coordinates
            } else {
                Vec::new()
            },
            material_libraries: used.iter().map(|i| format!("paints {i}.mtl")).collect(),
        }
    })
}

fn bytes(file: &MeshFile, format: Format) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(file, format, &mut bytes).expect("memory takes everything");
    bytes
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(file in mesh_file()) {
        for format in WRITTEN {
            let bytes = bytes(&file, format);
            prop_assert!(Format::sniff(&bytes) == format);
            let again = read(&bytes, format).unwrap();
            let bits = |mesh: &PolygonMesh| -> Vec<_> {
                mesh.positions().iter().map(|p| p.to_array().map(f64::to_bits)).collect()
            };
            prop_assert_eq!(bits(&again.mesh), bits(&file.mesh));
            prop_assert_eq!(&again.mesh, &file.mesh);
            if format == Format::Obj {
                prop_assert_eq!(&again, &file);
            }
        }
    }

    #[test]
    fn a_cut_or_changed_file_is_a_mesh_or_an_error(
        file in mesh_file(), cut: prop::sample::Index, at: prop::sample::Index, byte: u8,
    ) {
        for format in WRITTEN {
            let mut bytes = bytes(&file, format);
            let i = at.index(bytes.len());
            bytes[i] = byte;
            let _ = read(&bytes, format);
            let _ = read(&bytes[..cut.index(bytes.len())], format);
        }
    }

    #[test]
    fn any_bytes_are_a_mesh_or_an_error(bytes in vec(any::<u8>(), 0..300)) {
        let _ = Format::sniff(&bytes);
        for format in ALL {
            let _ = read(&bytes, format);
        }
    }

    #[test]
    fn any_statements_are_a_mesh_or_an_error(
        words in vec(prop::sample::select(vec![
            "v", "f", "1", "-1", "2", "3", "0", "1/1", "-2//3", "1e9", "nan", "\n", "\n", "\\\n",
            "usemtl", "vt", "2/2", "1/-1/1", "#", "OFF", "3 1 0", "solid", "vertex", "endloop", "endsolid", "ply",
            "format ascii 1.0", "element vertex 3", "element face 1", "property float x",
            "property list uchar int vertex_indices", "end_header",
        ]), 0..60),
    ) {
        let text = words.join(" ").replace(" \n ", "\n");
        for format in ALL {
            let _ = read(text.as_bytes(), format);
        }
    }
}

#[test]
fn stl_is_read_only() {
    let result = write(&MeshFile::default(), Format::Stl, &mut Vec::new());
    assert!(matches!(result, Err(WriteError::ReadOnly { .. })));
}

#[test]
fn formats_are_known_by_name_and_by_bytes() {
    use std::path::Path;
    assert_eq!(Format::from_path(Path::new("a/b.PLY")), Some(Format::Ply));
    assert_eq!(Format::from_path(Path::new("obj")), None);
    assert_eq!(Format::sniff(b"solid a\nfacet"), Format::Stl);
    assert_eq!(Format::sniff(b"# by hand\nv 0 0 0"), Format::Obj);
    assert_eq!(Format::sniff(b""), Format::Obj);
}
