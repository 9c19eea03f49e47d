//! A file as it was read: its text, its bytes, and the polygons of its scene.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use orbflow_geometry::mesh::io::MeshFile;
use orbflow_geometry::mesh::{PolygonMesh, VertexId};
use orbflow_geometry::pipeline::Origins;
use orbflow_geometry::transfer::Seams;
use serde_json::Value;

use crate::accessor::view_bytes;
use crate::container;
use crate::error::{Item, ReadError};
use crate::group::Group;
use crate::load::{buffers, check_packed, groups, images, joined};
use crate::schema::Root;

/// Texture coordinates of one place that differ by more are on two sides of a seam.
const APART: f32 = 1e-5;
/// Colours are cut where they jump by more than this share of their range: below, the grain of baked
/// light would cut everywhere; above, a border that is seen would be smeared.
const VISIBLE: f32 = 1.0 / 32.0;
/// Normals of one place that differ by more make a crease: below, those of files that keep a byte for
/// a number do; above, creases of 2 degrees are missed.
const CREASE: f64 = 1.0 / 32.0;

/// A scene and its file.
#[derive(Debug)]
pub struct Scene {
    pub(crate) text: Value,
    pub(crate) root: Root,
    pub(crate) buffers: Vec<Vec<u8>>,
    /// Images that were files beside it.
    pub(crate) images: BTreeMap<usize, Vec<u8>>,
    pub(crate) groups: Vec<Group>,
    pub(crate) mesh: PolygonMesh,
    /// The group of every face.
    pub(crate) of_faces: Vec<u32>,
    notes: Vec<String>,
}

/// Edges along which what lies on corners is cut, and by which set of them what is.
#[derive(Clone, PartialEq, Debug)]
pub struct Cuts {
    /// The sets; there is always one. Borders of primitives are in all but that of normals.
    pub sets: Vec<Vec<[VertexId; 2]>>,
    pub(crate) of_layers: BTreeMap<String, usize>,
    pub(crate) of_normals: Option<usize>,
}

/// A mesh that was made of the scene's.
#[derive(Clone, Copy, Debug)]
pub struct Made<'a> {
    /// The mesh.
    pub mesh: &'a PolygonMesh,
    /// Where its elements come from, by the scene's cuts.
    pub origins: &'a Origins,
}

impl Scene {
    /// Reads a file's bytes, and those of the files beside it that it names, which must lie in its
    /// folder.
    ///
    /// # Errors
    /// The first thing that is wrong, with its numbers; data that is packed; no triangles.
    pub fn read(bytes: &[u8], folder: Option<&Path>) -> Result<Self, ReadError> {
        let parts = container::parts(bytes)?;
        let text: Value = serde_json::from_slice(parts.text)?;
        let root: Root = serde_json::from_slice(parts.text)?;
        if root.asset.version != "2" && !root.asset.version.starts_with("2.") {
            let version = root.asset.version;
            return Err(ReadError::AssetVersion { version });
        }
        check_packed(&root)?;
        let buffers = buffers(&root, parts.bytes, folder)?;
        for view in 0..root.views.len() {
            view_bytes(&root, &buffers, Item::File, view)?;
        }
        let mut notes = Vec::new();
        let images = images(&root, folder, &mut notes);
        let (groups, faces) = groups(&root, &buffers, &mut notes)?;
        let (mesh, of_faces) = joined(&groups, &faces)?;
        Ok(Self {
            text,
            root,
            buffers,
            images,
            groups,
            mesh,
            of_faces,
            notes,
        })
    }

    /// The triangles of the scene, where its nodes put them; vertices of split seams are apart.
    pub fn mesh(&self) -> &PolygonMesh {
        &self.mesh
    }

    /// Sentences about what is not taken over as it is.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Where what lies on corners is cut. Borders are taken for one edge as they are when welded
    /// within this share of the diagonal.
    pub fn cuts(&self, weld: Option<f64>) -> Cuts {
        let seams = Seams::new(&self.mesh, weld);
        let mut cuts = Cuts {
            sets: Vec::new(),
            of_layers: BTreeMap::new(),
            of_normals: None,
        };
        cuts.add(seams.cuts(|a, b| self.group_of(a) != self.group_of(b)));
        let names: BTreeSet<&String> = self.groups.iter().flat_map(|g| g.layers.keys()).collect();
        for name in names {
            let least = self.least_jump(name);
            let set = seams.cuts(|a, b| self.is_apart(name, least, [a, b]));
            let set = cuts.add(set);
            cuts.of_layers.insert(name.clone(), set);
        }
        if self.groups.iter().any(|group| group.normals.is_some()) {
            cuts.of_normals = Some(cuts.add(seams.cuts(|a, b| self.is_crease([a, b]))));
        }
        cuts
    }

    /// The scene as a plain mesh: the material of each face, and the first texture coordinates of its
    /// corners, from below as OBJ counts them.
    pub fn plain(&self) -> MeshFile {
        let mut names = Vec::new();
        let mut by_material = BTreeMap::new();
        for group in &self.groups {
            by_material.entry(group.material).or_insert_with(|| {
                let material = group.material.and_then(|i| self.root.materials.get(i));
                let name = material.and_then(|material| material.name.clone());
                let unnamed = || {
                    group
                        .material
                        .map_or("default".to_owned(), |i| format!("material_{i}"))
                };
                names.push(name.unwrap_or_else(unnamed));
                names.len() as i32 - 1
            });
        }
        let material = |&group: &u32| by_material[&self.groups[group as usize].material];
        let coordinate = |corner: usize| {
            let (group, vertex) = self.at(corner);
            let values = &group.layers.get("TEXCOORD_0")?.values;
            let [u, v] = [values[2 * vertex], values[2 * vertex + 1]].map(f64::from);
            Some([u, 1.0 - v])
        };
        let has_coordinates = |group: &Group| group.layers.contains_key("TEXCOORD_0");
        let coordinates = (0..self.mesh.corners().len()).map(coordinate);
        MeshFile {
            mesh: self.mesh.clone(),
            materials: self.of_faces.iter().map(material).collect(),
            material_names: names,
            coordinates: if self.groups.iter().any(has_coordinates) {
                coordinates.collect()
            } else {
                Vec::new()
            },
            ..MeshFile::default()
        }
    }

    /// The group of a corner, and its vertex there.
    pub(crate) fn at(&self, corner: usize) -> (&Group, usize) {
        let group = &self.groups[self.group_of(corner)];
        let vertex = self.mesh.corners()[corner].0 as usize;
        (group, vertex - group.first_vertex)
    }

    pub(crate) fn group_of(&self, corner: usize) -> usize {
        // All faces are triangles.
        self.of_faces[corner / 3] as usize
    }

    fn is_apart(&self, name: &str, least: f32, corners: [usize; 2]) -> bool {
        let [one, other] = corners.map(|corner| self.group_of(corner));
        if one != other {
            return true;
        }
        let Some(numbers) = self.groups[one].layers.get(name) else {
            return false;
        };
        let [a, b] = corners.map(|corner| {
            let first = self.at(corner).1 * numbers.width;
            &numbers.values[first..first + numbers.width]
        });
        a.iter().zip(b).any(|(a, b)| (a - b).abs() > least)
    }

    fn is_crease(&self, corners: [usize; 2]) -> bool {
        let normals = corners.map(|corner| {
            let (group, vertex) = self.at(corner);
            group.normals.as_ref().map(|normals| normals[vertex])
        });
        let [Some(a), Some(b)] = normals else {
            return false;
        };
        (a - b).abs().max_element() > CREASE
    }

    fn least_jump(&self, name: &str) -> f32 {
        if !name.starts_with("COLOR") {
            return APART;
        }
        let layers = self
            .groups
            .iter()
            .filter_map(|group| group.layers.get(name));
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for &value in layers.flat_map(|numbers| &numbers.values) {
            (low, high) = (low.min(value), high.max(value));
        }
        VISIBLE * (high - low).max(0.0)
    }
}

impl Cuts {
    /// The number of a set, which is added where it is new.
    fn add(&mut self, set: Vec<[VertexId; 2]>) -> usize {
        let known = self.sets.iter().position(|known| *known == set);
        known.unwrap_or_else(|| {
            self.sets.push(set);
            self.sets.len() - 1
        })
    }
}
