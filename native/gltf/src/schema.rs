//! What is read of a file's text, by the names of the specification; the rest stays as it is.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::{Map, Value};

/// Attributes by their names, each with its accessor.
pub type Attributes = BTreeMap<String, usize>;

#[derive(Deserialize, Debug)]
pub struct Root {
    pub asset: Asset,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default, rename = "bufferViews")]
    pub views: Vec<View>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    #[serde(default)]
    pub images: Vec<Image>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub skins: Vec<Skin>,
    #[serde(default)]
    pub scenes: Vec<Scene>,
    pub scene: Option<usize>,
    #[serde(default)]
    pub animations: Vec<Animation>,
}

#[derive(Deserialize, Debug)]
pub struct Asset {
    pub version: String,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    pub kind: String,
    pub sparse: Option<Sparse>,
}

#[derive(Deserialize, Debug)]
pub struct Sparse {
    pub count: usize,
    pub indices: SparsePart,
    pub values: SparsePart,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct SparsePart {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
    /// Of indices alone.
    #[serde(default)]
    pub component_type: u32,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct View {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
    #[serde(default)]
    pub extensions: Map<String, Value>,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct Buffer {
    pub uri: Option<String>,
    pub byte_length: usize,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct Image {
    pub uri: Option<String>,
    pub buffer_view: Option<usize>,
}

#[derive(Deserialize, Debug)]
pub struct Mesh {
    pub primitives: Vec<Primitive>,
}

#[derive(Deserialize, Debug)]
pub struct Primitive {
    pub attributes: Attributes,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub mode: Option<u32>,
    #[serde(default)]
    pub targets: Vec<Attributes>,
    #[serde(default)]
    pub extensions: Map<String, Value>,
}

#[derive(Deserialize, Debug)]
pub struct Material {
    pub name: Option<String>,
}

#[derive(Deserialize, Debug)]
pub struct Node {
    #[serde(default)]
    pub children: Vec<usize>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct Skin {
    pub inverse_bind_matrices: Option<usize>,
    pub joints: Vec<usize>,
}

#[derive(Deserialize, Debug)]
pub struct Scene {
    #[serde(default)]
    pub nodes: Vec<usize>,
}

#[derive(Deserialize, Debug)]
pub struct Animation {
    #[serde(default)]
    pub samplers: Vec<Sampler>,
}

#[derive(Deserialize, Debug)]
pub struct Sampler {
    pub input: usize,
    pub output: usize,
}

impl Primitive {
    /// Every accessor that it names, some perhaps twice.
    pub fn accessors(&self) -> impl Iterator<Item = usize> {
        let targets = self.targets.iter().flat_map(BTreeMap::values);
        let all = self.attributes.values().chain(&self.indices).chain(targets);
        all.copied()
    }
}
