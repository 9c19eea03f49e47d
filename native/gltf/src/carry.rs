//! What lies on the elements of a new mesh, mixed of what lies on the scene's.

use glam::DVec3;
use orbflow_geometry::mesh::Id;
use orbflow_geometry::pipeline::Origin;

use crate::accessor::Component;
use crate::build::{Building, Layout, Name, Record};
use crate::error::WriteError;
use crate::group::{BONES, Bones, Group, Target};
use crate::normals;
use crate::scene::{Cuts, Made, Scene};
use crate::triangles::cut;

/// A new mesh on its way into the primitives of a scene.
pub struct Carrying<'a> {
    scene: &'a Scene,
    made: Made<'a>,
    cuts: &'a Cuts,
    /// Of every corner, where the scene has any.
    normals: Vec<DVec3>,
}

/// A corner of the new mesh.
#[derive(Clone, Copy)]
struct Corner {
    face: usize,
    index: usize,
    vertex: usize,
}

impl<'a> Carrying<'a> {
    pub fn new(scene: &'a Scene, made: Made<'a>, cuts: &'a Cuts) -> Self {
        let normals = match cuts.of_normals {
            Some(set) => normals::of_corners(scene, made, set),
            None => Vec::new(),
        };
        Self {
            scene,
            made,
            cuts,
            normals,
        }
    }

    /// The new primitive of every group, perhaps without triangles.
    pub fn primitives(&self) -> Result<Vec<Building>, WriteError> {
        let groups = self.scene.groups.iter();
        let mut primitives: Vec<_> = groups.map(|group| Building::new(layout(group))).collect();
        let mesh = self.made.mesh;
        for (face, (&first, id)) in mesh.starts().iter().zip(mesh.face_ids()).enumerate() {
            let from = self.made.origins.faces[face];
            let number = self.scene.of_faces[from.index()] as usize;
            let (group, building) = (&self.scene.groups[number], &mut primitives[number]);
            let vertices = mesh.face(id);
            let mut names = Vec::with_capacity(vertices.len());
            for (i, vertex) in vertices.iter().enumerate() {
                let vertex = vertex.index();
                let index = first as usize + i;
                names.push(self.vertex(
                    (group, number),
                    Corner {
                        face,
                        index,
                        vertex,
                    },
                    building,
                )?);
            }
            let places: Vec<DVec3> = vertices.iter().map(|&v| mesh.position(v)).collect();
            for [a, b, c] in cut(&places) {
                let order = if group.placed.space.flips() {
                    [c, b, a]
                } else {
                    [a, b, c]
                };
                building.indices.extend(order.map(|i| names[i]));
            }
        }
        Ok(primitives)
    }

    fn vertex(
        &self,
        (group, number): (&Group, usize),
        at: Corner,
        building: &mut Building,
    ) -> Result<u32, WriteError> {
        let set = |set: usize| &self.made.origins.corners[set][at.index];
        let own = self.place(group, at);
        if !own.as_vec3().is_finite() {
            return Err(WriteError::NotFinite { position: own });
        }
        let parts = |origin: &Origin, is_fit: &dyn Fn(&Group) -> bool| self.parts(origin, is_fit);
        let in_group = |set_of: usize| {
            let is_own = |other: &Group| other.first_vertex == group.first_vertex;
            let found = parts(set(set_of), &is_own);
            if found.is_empty() {
                self.any_of(number, at.face)
            } else {
                found
            }
        };
        let of_vertex = |is_fit: &dyn Fn(&Group) -> bool| {
            let found = parts(&self.made.origins.vertices[at.vertex], is_fit);
            let total: f64 = found.iter().map(|part| part.share).sum();
            // A vertex between two meshes belongs to both: what it has of the other one is no use.
            if total > 0.999 { found } else { in_group(0) }
        };
        let bones = group.bones.as_ref().map(|bones| {
            let skin = group.placed.skin;
            let parts = of_vertex(&|other| other.placed.skin == skin && other.bones.is_some());
            mixed_bones(&parts, (bones, bones.most()))
        });
        let steps = (!group.targets.is_empty()).then(|| {
            let mesh = group.placed.mesh;
            of_vertex(&|other| other.placed.mesh == mesh)
        });
        Ok(building.vertex(|record| {
            record.floats(own.to_array());
            if group.normals.is_some() {
                let normal = group.placed.space.normal_back(self.normals[at.index]);
                record.floats(normal.normalize_or(DVec3::Z).to_array());
            }
            for (name, layer) in &group.layers {
                let parts = in_group(self.cuts.of_layers[name]);
                let value = mixed(&parts, layer.width, |group| {
                    group.layers.get(name).map(|l| &l.values)
                });
                record.numbers(written_as(name, layer.component, layer.normalized), &value);
            }
            if let (Some(bones), Some((which, shares))) = (&group.bones, &bones) {
                for set in 0..bones.n_sets {
                    let range = BONES * set..BONES * (set + 1);
                    record.bones(bones.is_wide, &which[range.clone()]);
                    record.floats(shares[range].iter().copied());
                }
            }
            write_steps(group, steps.as_deref().unwrap_or_default(), record);
        }))
    }

    /// The place of a corner in its primitive's own space; one that was not touched is as it was.
    fn place(&self, group: &Group, at: Corner) -> DVec3 {
        let origin = &self.made.origins.corners[0][at.index];
        if is_untouched(origin) {
            let (from, vertex) = self.scene.at(origin.corners[0] as usize);
            if from.first_vertex == group.first_vertex {
                return DVec3::from_array(from.positions[vertex].map(f64::from));
            }
        }
        let place = self.made.mesh.positions()[at.vertex];
        group.placed.space.back(place)
    }

    /// What an origin consists of, in groups that fit.
    fn parts(&self, origin: &Origin, is_fit: &dyn Fn(&Group) -> bool) -> Vec<Part<'a>> {
        let parts = origin
            .corners
            .iter()
            .zip(origin.weights)
            .map(|(&corner, share)| {
                let (group, vertex) = self.scene.at(corner as usize);
                Part {
                    group,
                    vertex,
                    share,
                }
            });
        let fits = |part: &Part<'_>| part.share > 0.0 && is_fit(part.group);
        parts.filter(fits).collect()
    }

    /// A vertex of the face of the scene that a face comes from.
    fn any_of(&self, number: usize, face: usize) -> Vec<Part<'a>> {
        let corner = 3 * self.made.origins.faces[face].index();
        let (_, vertex) = self.scene.at(corner);
        let group = &self.scene.groups[number];
        vec![Part {
            group,
            vertex,
            share: 1.0,
        }]
    }
}

/// Whether a corner is the input's own.
pub fn is_untouched(origin: &Origin) -> bool {
    origin.corners[0] == origin.corners[1] && origin.corners[0] == origin.corners[2]
}

/// A share of a vertex of the scene.
struct Part<'a> {
    group: &'a Group,
    vertex: usize,
    share: f64,
}

/// The channels of a group's records.
pub fn layout(group: &Group) -> Layout {
    let mut layout = Layout::default();
    let attribute = |name: &str| Name::Attribute(name.to_owned());
    layout.floats(attribute("POSITION"), 3);
    if group.normals.is_some() {
        layout.floats(attribute("NORMAL"), 3);
    }
    for (name, layer) in &group.layers {
        let mut like = layer.clone();
        like.component = written_as(name, layer.component, layer.normalized);
        like.normalized = like.component != Component::F32;
        like.values = Vec::new();
        layout.like(attribute(name), &like);
    }
    if let Some(bones) = &group.bones {
        let component = if bones.is_wide {
            Component::U16
        } else {
            Component::U8
        };
        for set in 0..bones.n_sets {
            layout.like(
                attribute(&format!("JOINTS_{set}")),
                &crate::accessor::Numbers {
                    component,
                    normalized: false,
                    width: BONES,
                    values: Vec::new(),
                },
            );
            layout.floats(attribute(&format!("WEIGHTS_{set}")), BONES);
        }
    }
    for (i, target) in group.targets.iter().enumerate() {
        if has_moves(target) {
            layout.floats(Name::Target(i, "POSITION"), 3);
        }
        if target.turns.is_some() {
            layout.floats(Name::Target(i, "NORMAL"), 3);
        }
    }
    layout
}

/// Colours of whole numbers stay that; all else has a point.
fn written_as(name: &str, component: Component, normalized: bool) -> Component {
    match component {
        Component::U8 | Component::U16 if normalized && name.starts_with("COLOR") => component,
        _ => Component::F32,
    }
}

/// A target without anything that is carried moves nothing.
fn has_moves(target: &Target) -> bool {
    target.moves.is_some() || target.turns.is_none()
}

fn write_steps(group: &Group, parts: &[Part<'_>], record: &mut Record) {
    for (i, target) in group.targets.iter().enumerate() {
        if has_moves(target) {
            record.floats(mixed(parts, 3, |group| {
                group.targets.get(i)?.moves.as_ref()
            }));
        }
        if target.turns.is_some() {
            record.floats(mixed(parts, 3, |group| {
                group.targets.get(i)?.turns.as_ref()
            }));
        }
    }
}

/// Values by the shares of those parts that have any; zeros where none has.
fn mixed<'a>(
    parts: &[Part<'a>],
    width: usize,
    values: impl Fn(&'a Group) -> Option<&'a Vec<f32>>,
) -> Vec<f64> {
    let (mut sum, mut total) = (vec![0.0; width], 0.0);
    for part in parts {
        total += part.share;
        if let Some(values) = values(part.group) {
            let row = &values[width * part.vertex..width * (part.vertex + 1)];
            for (sum, &value) in sum.iter_mut().zip(row) {
                *sum += part.share * f64::from(value);
            }
        }
    }
    if total > 0.0 {
        for value in &mut sum {
            *value /= total;
        }
    }
    sum
}

/// The bones with the largest shares, which sum to 1 in single precision.
fn mixed_bones(parts: &[Part<'_>], (like, most): (&Bones, usize)) -> (Vec<u16>, Vec<f64>) {
    let mut shares: Vec<(u16, f64)> = Vec::new();
    for part in parts {
        let Some(bones) = &part.group.bones else {
            continue;
        };
        for (bone, share) in bones.of(part.vertex).filter(|&(_, share)| share > 0.0) {
            let share = part.share * f64::from(share);
            match shares.iter_mut().find(|(known, _)| *known == bone) {
                Some((_, sum)) => *sum += share,
                None => shares.push((bone, share)),
            }
        }
    }
    shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    shares.truncate(most.min(BONES * like.n_sets));
    let total: f64 = shares.iter().map(|(_, share)| share).sum();
    let mut which = vec![0; BONES * like.n_sets];
    let mut weights = vec![0.0; BONES * like.n_sets];
    for (i, (bone, share)) in shares.into_iter().enumerate() {
        which[i] = bone;
        // As it will be written.
        weights[i] = f64::from((share / total) as f32);
    }
    let rest: f64 = weights[1..].iter().sum();
    weights[0] = 1.0 - rest;
    (which, weights)
}
