//! Where nodes put meshes: the places of the scene's vertices.

use std::collections::BTreeMap;

use glam::{DMat4, DQuat, DVec3};

use crate::accessor::Accessors;
use crate::error::{Item, ReadError};
use crate::schema::{Node, Root};

/// A mesh of the scene and how its own space lies in the scene's.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Placed {
    pub node: usize,
    pub mesh: usize,
    pub skin: Option<usize>,
    pub space: Space,
}

/// The way from a mesh's own space to the scene's and back.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Space {
    there: DMat4,
    back: DMat4,
}

impl Space {
    /// None where the way leads into a plane, from which none leads back.
    fn new(there: DMat4) -> Option<Self> {
        let back = there.inverse();
        let is_finite = there.is_finite() && back.is_finite();
        (is_finite && there.determinant() != 0.0).then_some(Self { there, back })
    }

    /// Whether faces are seen from behind in the scene.
    pub fn flips(&self) -> bool {
        self.there.determinant() < 0.0
    }

    pub fn there(&self, p: DVec3) -> DVec3 {
        self.there.transform_point3(p)
    }

    pub fn back(&self, p: DVec3) -> DVec3 {
        self.back.transform_point3(p)
    }

    /// Where a normal of the mesh points to in the scene.
    pub fn normal_there(&self, n: DVec3) -> DVec3 {
        turned(&self.back, n).normalize_or_zero()
    }

    /// Where a normal of the scene points to in the mesh.
    pub fn normal_back(&self, n: DVec3) -> DVec3 {
        turned(&self.there, n).normalize_or_zero()
    }
}

/// A normal by the transpose of the way it came from.
fn turned(way: &DMat4, n: DVec3) -> DVec3 {
    way.transpose().transform_vector3(n)
}

/// The meshes that the scene's nodes show, each once, by the first node that does, and how often it
/// is shown. Meshes that lie in a plane because of their node are left out.
pub fn placed(root: &Root, accessors: &Accessors<'_>) -> Result<Vec<(Placed, usize)>, ReadError> {
    let worlds = worlds(root)?;
    let mut found: Vec<(Placed, usize)> = Vec::new();
    let mut known: BTreeMap<usize, usize> = BTreeMap::new();
    for (&index, world) in &worlds {
        let node = &root.nodes[index];
        let Some(mesh) = node.mesh else {
            continue;
        };
        if let Some(&i) = known.get(&mesh) {
            found[i].1 += 1;
            continue;
        }
        let there = match node.skin {
            // Bones put a skinned mesh in its place, and its node does not.
            Some(skin) => at_rest(root, accessors, (skin, index), &worlds)?,
            None => *world,
        };
        if let Some(space) = Space::new(there) {
            let skin = node.skin;
            known.insert(mesh, found.len());
            let node = index;
            found.push((
                Placed {
                    node,
                    mesh,
                    skin,
                    space,
                },
                1,
            ));
        }
    }
    Ok(found)
}

/// How the first bone of a skin moves vertices while nothing is animated: where bones rest as they
/// were bound, all move them alike.
fn at_rest(
    root: &Root,
    accessors: &Accessors<'_>,
    (skin, node): (usize, usize),
    worlds: &BTreeMap<usize, DMat4>,
) -> Result<DMat4, ReadError> {
    let item = Item::Of("skin", skin);
    let found = root.skins.get(skin).ok_or(ReadError::NoSuch {
        by: Item::Of("node", node),
        what: "skin",
        index: skin,
        n: root.skins.len(),
    })?;
    let Some(bone) = found.joints.first().and_then(|joint| worlds.get(joint)) else {
        return Ok(DMat4::IDENTITY);
    };
    let bound = match found.inverse_bind_matrices {
        None => DMat4::IDENTITY,
        Some(index) => {
            let numbers = accessors.numbers(index, item, None)?;
            let first = numbers.values.get(..16).filter(|_| numbers.width == 16);
            let first = first.and_then(|values| <[f32; 16]>::try_from(values).ok());
            let first = first.ok_or_else(|| ReadError::Unexpected {
                item: Item::Of("accessor", index),
                expected: "matrices of four columns",
                found: format!("{} numbers an element", numbers.width),
            })?;
            DMat4::from_cols_array(&first.map(f64::from))
        }
    };
    let rest = *bone * bound;
    Ok(if Space::new(rest).is_some() {
        rest
    } else {
        DMat4::IDENTITY
    })
}

/// The transforms of all nodes of the scene: the one that is named, or the first, or, where there is
/// none, all nodes.
fn worlds(root: &Root) -> Result<BTreeMap<usize, DMat4>, ReadError> {
    let no_such = |by, what, index, n| ReadError::NoSuch { by, what, index, n };
    let roots: Vec<usize> = match (root.scene, root.scenes.as_slice()) {
        (None, []) => {
            let mut is_child = vec![false; root.nodes.len()];
            for &child in root.nodes.iter().flat_map(|node| &node.children) {
                if let Some(is_child) = is_child.get_mut(child) {
                    *is_child = true;
                }
            }
            (0..root.nodes.len()).filter(|&i| !is_child[i]).collect()
        }
        (scene, scenes) => {
            let scene = scene.unwrap_or(0);
            let found = scenes.get(scene);
            let found = found.ok_or(no_such(Item::File, "scene", scene, scenes.len()))?;
            found.nodes.clone()
        }
    };
    let mut worlds = BTreeMap::new();
    let above = |&index: &usize| (index, Item::File, DMat4::IDENTITY);
    let mut open: Vec<_> = roots.iter().map(above).collect();
    while let Some((index, by, above)) = open.pop() {
        let n = root.nodes.len();
        let node = root.nodes.get(index).ok_or(no_such(by, "node", index, n))?;
        let world = above * local(node);
        if !world.is_finite() {
            return Err(ReadError::BadTransform { node: index });
        }
        if worlds.insert(index, world).is_some() {
            return Err(ReadError::NotATree { node: index });
        }
        let item = Item::Of("node", index);
        open.extend(node.children.iter().map(|&child| (child, item, world)));
    }
    Ok(worlds)
}

fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    let turn = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
    let length = turn.length();
    let turn = if length > 0.0 {
        turn / length
    } else {
        DQuat::IDENTITY
    };
    let scale = node.scale.unwrap_or([1.0; 3]);
    let shift = node.translation.unwrap_or([0.0; 3]);
    DMat4::from_scale_rotation_translation(scale.into(), turn, shift.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed_of(nodes: &str) -> Result<Vec<(Placed, usize)>, ReadError> {
        let text = format!(r#"{{"asset": {{"version": "2.0"}}, {nodes}}}"#);
        let root: Root = serde_json::from_str(&text).unwrap();
        placed(&root, &Accessors::new(&root, &[]))
    }

    #[test]
    fn nodes_are_placed_by_all_above_them() {
        let found = placed_of(
            r#""nodes": [{"children": [1], "translation": [1, 0, 0], "scale": [2, 2, 2]},
                {"mesh": 0, "rotation": [0, 0, 1, 0], "translation": [0, 1, 0]}]"#,
        );
        let (placed, n) = found.unwrap()[0];
        assert_eq!((placed.node, placed.mesh, n), (1, 0, 1));
        let p = placed.space.there(DVec3::X);
        assert!(p.distance(DVec3::new(-1.0, 2.0, 0.0)) < 1e-12, "{p}");
        assert!(placed.space.back(p).distance(DVec3::X) < 1e-12);
    }

    #[test]
    fn a_mesh_that_several_nodes_show_is_placed_once_by_the_first() {
        let found = placed_of(
            r#""nodes": [{"mesh": 0, "scale": [0, 1, 1]}, {"mesh": 0, "scale": [-1, 1, 1]},
                {"mesh": 0}, {"mesh": 1}], "scenes": [{"nodes": [2, 1, 0]}]"#,
        );
        let found = found.unwrap();
        assert_eq!(found.len(), 1);
        let (placed, n) = found[0];
        assert_eq!((placed.node, n, placed.space.flips()), (1, 2, true));
        assert_eq!(placed.space.normal_there(DVec3::X), DVec3::NEG_X);
    }

    #[test]
    fn nodes_that_are_no_forest_are_named() {
        let message = |nodes| placed_of(nodes).unwrap_err().to_string();
        let round =
            r#""nodes": [{"children": [1]}, {"children": [0]}], "scenes": [{"nodes": [0]}]"#;
        assert!(message(round).starts_with("node 0 is reached twice"));
        let lost = r#""nodes": [{"children": [7]}]"#;
        assert_eq!(message(lost), "node 0 names node 7, but there are 1");
        let far =
            r#""nodes": [{"scale": [1e300, 1, 1], "children": [1]}, {"scale": [1e300, 1, 1]}]"#;
        assert_eq!(message(far), "node 1 has a transform that is not finite");
        let scene = r#""scene": 3"#;
        assert_eq!(message(scene), "the file names scene 3, but there are 0");
        let skin = r#""nodes": [{"mesh": 0, "skin": 2}]"#;
        assert_eq!(message(skin), "node 0 names skin 2, but there are 0");
    }
}
