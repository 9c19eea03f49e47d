//! A primitive: triangles of one material, and what lies on their vertices.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::accessor::{Accessors, Component, Numbers};
use crate::error::{Item, ReadError};
use crate::placed::Placed;
use crate::schema::{Attributes, Primitive};
use crate::triangles::triangles;

/// Bones that a set of attributes has for every vertex.
pub const BONES: usize = 4;

/// A primitive whose triangles are remeshed.
#[derive(Clone, Debug)]
pub struct Group {
    pub placed: Placed,
    /// Which primitive of its mesh it is.
    pub primitive: usize,
    pub material: Option<usize>,
    /// The first of its vertices among those of all groups.
    pub first_vertex: usize,
    /// In the mesh's own space, vertex by vertex.
    pub positions: Vec<[f32; 3]>,
    /// In the scene's space; zero where the file's was.
    pub normals: Option<Vec<DVec3>>,
    /// Texture coordinates and colours, by their names.
    pub layers: BTreeMap<String, Numbers>,
    pub bones: Option<Bones>,
    pub targets: Vec<Target>,
}

/// Which bones move every vertex, and by which shares: some sets of four.
#[derive(Clone, PartialEq, Debug)]
pub struct Bones {
    pub n_sets: usize,
    /// Whether bones need two bytes.
    pub is_wide: bool,
    pub which: Vec<u16>,
    pub shares: Vec<f32>,
}

impl Bones {
    /// The bones of a vertex.
    pub fn of(&self, vertex: usize) -> impl Iterator<Item = (u16, f32)> {
        let n = BONES * self.n_sets;
        let range = n * vertex..n * (vertex + 1);
        let which = self.which[range.clone()].iter().copied();
        which.zip(self.shares[range].iter().copied())
    }

    /// The most bones that move one vertex.
    pub fn most(&self) -> usize {
        let vertices = self.shares.chunks(BONES * self.n_sets);
        let counts = vertices.map(|shares| shares.iter().filter(|&&share| share > 0.0).count());
        counts.max().unwrap_or(0).max(1)
    }
}

/// How far a morph target moves every vertex, and how it turns normals.
#[derive(Clone, Default, PartialEq, Debug)]
pub struct Target {
    pub moves: Option<Vec<f32>>,
    pub turns: Option<Vec<f32>>,
}

/// What comes of reading a primitive.
pub struct Found {
    pub group: Group,
    /// Its triangles, by its own vertices.
    pub faces: Vec<[u32; 3]>,
}

/// Reads a primitive with the vertices that its triangles use; none where it has no triangles.
///
/// Names of attributes that are left out are added to `dropped`.
pub fn read(
    accessors: &Accessors<'_>,
    placed: &Placed,
    primitive: usize,
    dropped: &mut BTreeSet<String>,
) -> Result<Option<Found>, ReadError> {
    let given = &accessors.root.meshes[placed.mesh].primitives[primitive];
    let item = Item::Primitive(placed.mesh, primitive);
    let mode = given.mode.unwrap_or(4);
    let (4..=6, Some(&position)) = (mode, given.attributes.get("POSITION")) else {
        return Ok(None);
    };
    let reading = Reading { accessors, item };
    let positions = accessors.numbers(position, item, None)?;
    Reading::check(position, &positions, &[3])?;
    let n = positions.values.len() / 3;
    let indices = match given.indices {
        Some(index) => accessors.indices(index, item, n)?,
        None => (0..n as u32).collect(),
    };
    let (faces, used) = compact(triangles(mode, &indices), n);
    if faces.is_empty() {
        return Ok(None);
    }
    let rows = Rows { n, used: &used };
    let positions = rows.of(&positions.values, 3);
    let triples = positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
    let positions = triples.collect();
    let group = Group {
        placed: *placed,
        primitive,
        material: given.material,
        first_vertex: 0,
        positions,
        normals: reading.normals(given, &rows, placed)?,
        layers: reading.layers(given, &rows, dropped)?,
        bones: reading.bones(given, &rows, placed)?,
        targets: reading.targets(given, &rows, dropped)?,
    };
    Ok(Some(Found { group, faces }))
}

/// Triangles by the vertices that they use alone, and which these are.
fn compact(mut faces: Vec<[u32; 3]>, n: usize) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut is_used = vec![false; n];
    for &v in faces.iter().flatten() {
        is_used[v as usize] = true;
    }
    let used: Vec<u32> = (0..n as u32).filter(|&v| is_used[v as usize]).collect();
    let mut names = vec![0; n];
    for (name, &v) in used.iter().enumerate() {
        names[v as usize] = name as u32;
    }
    for v in faces.iter_mut().flatten() {
        *v = names[*v as usize];
    }
    (faces, used)
}

/// The vertices that are used, of all.
struct Rows<'a> {
    n: usize,
    used: &'a [u32],
}

impl Rows<'_> {
    fn of<T: Copy>(&self, values: &[T], width: usize) -> Vec<T> {
        let row = |&v: &u32| &values[v as usize * width..(v as usize + 1) * width];
        self.used.iter().flat_map(row).copied().collect()
    }
}

struct Reading<'a> {
    accessors: &'a Accessors<'a>,
    item: Item,
}

impl Reading<'_> {
    fn values(
        &self,
        index: usize,
        rows: &Rows<'_>,
        widths: &[usize],
    ) -> Result<Numbers, ReadError> {
        let mut numbers = self.accessors.numbers(index, self.item, Some(rows.n))?;
        Self::check(index, &numbers, widths)?;
        numbers.values = rows.of(&numbers.values, numbers.width);
        Ok(numbers)
    }

    fn check(index: usize, numbers: &Numbers, widths: &[usize]) -> Result<(), ReadError> {
        if widths.contains(&numbers.width) && numbers.component != Component::U32 {
            return Ok(());
        }
        let expected = match widths {
            [2] => "two numbers",
            [3] => "three numbers",
            [4] => "four numbers",
            _ => "three or four numbers",
        };
        Err(ReadError::Unexpected {
            item: Item::Of("accessor", index),
            expected,
            found: format!("{} of type {}", numbers.width, numbers.component.code()),
        })
    }

    fn normals(
        &self,
        given: &Primitive,
        rows: &Rows<'_>,
        placed: &Placed,
    ) -> Result<Option<Vec<DVec3>>, ReadError> {
        let Some(&index) = given.attributes.get("NORMAL") else {
            return Ok(None);
        };
        let found = self.values(index, rows, &[3])?;
        let normals = found.values.chunks_exact(3).map(|n| {
            let [x, y, z] = [n[0], n[1], n[2]].map(f64::from);
            placed.space.normal_there(DVec3::new(x, y, z))
        });
        Ok(Some(normals.collect()))
    }

    fn layers(
        &self,
        given: &Primitive,
        rows: &Rows<'_>,
        dropped: &mut BTreeSet<String>,
    ) -> Result<BTreeMap<String, Numbers>, ReadError> {
        let mut layers = BTreeMap::new();
        for (name, &index) in &given.attributes {
            let widths: &[usize] = match name.split_once('_') {
                Some(("TEXCOORD", _)) => &[2],
                Some(("COLOR", _)) => &[3, 4],
                Some(("JOINTS" | "WEIGHTS", _)) => continue,
                _ if ["POSITION", "NORMAL"].contains(&name.as_str()) => continue,
                _ => {
                    dropped.insert(name.clone());
                    continue;
                }
            };
            layers.insert(name.clone(), self.values(index, rows, widths)?);
        }
        Ok(layers)
    }

    fn bones(
        &self,
        given: &Primitive,
        rows: &Rows<'_>,
        placed: &Placed,
    ) -> Result<Option<Bones>, ReadError> {
        let Some(skin) = placed.skin else {
            return Ok(None);
        };
        let mut sets = Vec::new();
        loop {
            let [which, shares] = ["JOINTS", "WEIGHTS"].map(|name| {
                let name = format!("{name}_{}", sets.len());
                given.attributes.get(&name).copied()
            });
            let (Some(which), Some(shares)) = (which, shares) else {
                break;
            };
            let found = self.values(which, rows, &[4])?;
            Self::check_bones(which, &found, self.accessors.root.skins[skin].joints.len())?;
            sets.push([found, self.values(shares, rows, &[4])?]);
        }
        let n_sets = sets.len();
        if n_sets == 0 {
            return Ok(None);
        }
        let n = rows.used.len();
        let (mut which, mut shares) = (Vec::new(), Vec::new());
        for v in 0..n {
            for [bones, weights] in &sets {
                let range = BONES * v..BONES * (v + 1);
                which.extend(bones.values[range.clone()].iter().map(|&bone| bone as u16));
                shares.extend(weights.values[range].iter().map(|&share| share.max(0.0)));
            }
        }
        let is_wide = sets
            .iter()
            .any(|[bones, _]| bones.component != Component::U8);
        Ok(Some(Bones {
            n_sets,
            is_wide,
            which,
            shares,
        }))
    }

    fn check_bones(index: usize, found: &Numbers, n: usize) -> Result<(), ReadError> {
        let item = Item::Of("accessor", index);
        if !matches!(found.component, Component::U8 | Component::U16) || found.normalized {
            return Err(ReadError::Unexpected {
                item,
                expected: "whole numbers of one or two bytes",
                found: format!("type {}", found.component.code()),
            });
        }
        match found.values.iter().find(|&&bone| bone as usize >= n) {
            None => Ok(()),
            Some(&bone) => Err(ReadError::NoSuch {
                by: item,
                what: "joint",
                index: bone as usize,
                n,
            }),
        }
    }

    fn targets(
        &self,
        given: &Primitive,
        rows: &Rows<'_>,
        dropped: &mut BTreeSet<String>,
    ) -> Result<Vec<Target>, ReadError> {
        let mut targets = Vec::with_capacity(given.targets.len());
        for target in &given.targets {
            let others = target
                .keys()
                .filter(|name| !["POSITION", "NORMAL"].contains(&name.as_str()));
            dropped.extend(others.map(|name| format!("{name} of morph targets")));
            targets.push(Target {
                moves: self.steps(target, "POSITION", rows)?,
                turns: self.steps(target, "NORMAL", rows)?,
            });
        }
        Ok(targets)
    }

    fn steps(
        &self,
        target: &Attributes,
        name: &str,
        rows: &Rows<'_>,
    ) -> Result<Option<Vec<f32>>, ReadError> {
        let Some(&index) = target.get(name) else {
            return Ok(None);
        };
        Ok(Some(self.values(index, rows, &[3])?.values))
    }
}
