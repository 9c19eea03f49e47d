//! What a scene is read of: buffers, images, primitives.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec3;
use orbflow_geometry::mesh::PolygonMesh;

use crate::accessor::Accessors;
use crate::beside;
use crate::error::{Item, ReadError, UriError};
use crate::group::{self, Group};
use crate::placed::placed;
use crate::schema::Root;

/// Packed data is named, not read as if it were not.
pub fn check_packed(root: &Root) -> Result<(), ReadError> {
    let packed = |item, extension: &String| ReadError::Packed {
        item,
        extension: extension.clone(),
    };
    for (i, view) in root.views.iter().enumerate() {
        let found = view
            .extensions
            .keys()
            .find(|name| name.ends_with("meshopt_compression"));
        if let Some(name) = found {
            return Err(packed(Item::Of("buffer view", i), name));
        }
    }
    for (i, mesh) in root.meshes.iter().enumerate() {
        for (j, primitive) in mesh.primitives.iter().enumerate() {
            let found = primitive
                .extensions
                .keys()
                .find(|name| name.ends_with("mesh_compression"));
            if let Some(name) = found {
                return Err(packed(Item::Primitive(i, j), name));
            }
        }
    }
    Ok(())
}

/// The bytes of all buffers.
pub fn buffers(
    root: &Root,
    own: Option<&[u8]>,
    folder: Option<&Path>,
) -> Result<Vec<Vec<u8>>, ReadError> {
    let mut buffers = Vec::with_capacity(root.buffers.len());
    for (i, buffer) in root.buffers.iter().enumerate() {
        let item = Item::Of("buffer", i);
        let mut bytes = match &buffer.uri {
            Some(uri) => beside::bytes(uri, folder).map_err(|why| uri_error(item, uri, why))?,
            None if i == 0 => own.unwrap_or_default().to_vec(),
            None => Vec::new(),
        };
        if bytes.len() < buffer.byte_length {
            return Err(ReadError::Truncated {
                what: item,
                expected: buffer.byte_length,
                found: bytes.len(),
            });
        }
        bytes.truncate(buffer.byte_length);
        buffers.push(bytes);
    }
    Ok(buffers)
}

fn uri_error(item: Item, uri: &str, why: UriError) -> ReadError {
    let uri = uri.chars().take(100).collect();
    ReadError::Uri { item, uri, why }
}

/// Images that are files beside it; one that is not there stays a name.
pub fn images(
    root: &Root,
    folder: Option<&Path>,
    notes: &mut Vec<String>,
) -> BTreeMap<usize, Vec<u8>> {
    let mut images = BTreeMap::new();
    for (i, image) in root.images.iter().enumerate() {
        let Some(uri) = image.uri.as_ref().filter(|uri| !beside::is_data(uri)) else {
            continue;
        };
        match beside::bytes(uri, folder) {
            Ok(bytes) => {
                images.insert(i, bytes);
            }
            Err(why) => {
                let error = uri_error(Item::Of("image", i), uri, why);
                notes.push(format!("{error}; the result names it as before"));
            }
        }
    }
    images
}

/// The triangles of every group, by its own vertices.
pub type Faces = Vec<Vec<[u32; 3]>>;

/// Reads the primitives of the scene, and says what is not taken over.
pub fn groups(
    root: &Root,
    buffers: &[Vec<u8>],
    notes: &mut Vec<String>,
) -> Result<(Vec<Group>, Faces), ReadError> {
    let accessors = Accessors::new(root, buffers);
    let (mut groups, mut faces) = (Vec::new(), Vec::new());
    let mut dropped = BTreeSet::new();
    let (mut n_vertices, mut n_left) = (0, 0);
    for (placed, n_shown) in placed(root, &accessors)? {
        let n = root.meshes.len();
        let mesh = root.meshes.get(placed.mesh).ok_or(ReadError::NoSuch {
            by: Item::Of("node", placed.node),
            what: "mesh",
            index: placed.mesh,
            n,
        })?;
        if n_shown > 1 {
            let mesh = placed.mesh;
            notes.push(format!(
                "mesh {mesh} is shown by {n_shown} nodes and remeshed once"
            ));
        }
        for primitive in 0..mesh.primitives.len() {
            let Some(found) = group::read(&accessors, &placed, primitive, &mut dropped)? else {
                n_left += 1;
                continue;
            };
            let first_vertex = n_vertices;
            n_vertices += found.group.positions.len();
            groups.push(Group {
                first_vertex,
                ..found.group
            });
            faces.push(found.faces);
        }
    }
    if groups.is_empty() {
        return Err(ReadError::Nothing);
    }
    if n_left > 0 {
        notes.push(format!(
            "{n_left} primitives without triangles stay as they are"
        ));
    }
    let shown: BTreeSet<usize> = groups.iter().map(|group| group.placed.mesh).collect();
    if shown.len() < root.meshes.len() {
        let n = root.meshes.len() - shown.len();
        notes.push(format!(
            "{n} meshes that the scene does not show stay as they are"
        ));
    }
    if !dropped.is_empty() {
        let names: Vec<String> = dropped.into_iter().collect();
        notes.push(format!("left out: {}", names.join(", ")));
    }
    let n = accessors.not_finite.get();
    if n > 0 {
        notes.push(format!("{n} numbers that are not finite are taken for 0"));
    }
    Ok((groups, faces))
}

/// The triangles of all groups as one mesh in the scene's space.
pub fn joined(groups: &[Group], faces: &Faces) -> Result<(PolygonMesh, Vec<u32>), ReadError> {
    let (mut positions, mut all, mut of_faces) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (group, faces)) in groups.iter().zip(faces).enumerate() {
        let space = &group.placed.space;
        let place = |p: &[f32; 3]| space.there(DVec3::from_array(p.map(f64::from)));
        positions.extend(group.positions.iter().map(place));
        let flips = space.flips();
        for face in faces {
            let mut face = face.map(|v| v + group.first_vertex as u32);
            if flips {
                face.reverse();
            }
            all.push(face);
            of_faces.push(i as u32);
        }
    }
    Ok((PolygonMesh::from_faces(positions, &all)?, of_faces))
}
