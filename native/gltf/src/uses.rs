//! What of a file's accessors and buffer views is free once primitives are rebuilt.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::schema::{Accessor, Root};

/// Accessors and buffer views by their numbers.
#[derive(Clone, Default, PartialEq, Debug)]
pub struct Numbered {
    pub accessors: BTreeSet<usize>,
    pub views: BTreeSet<usize>,
}

/// What only primitives name that are rebuilt. What extensions name is taken for used, as far as
/// their names of things say what is named.
pub fn free(root: &Root, text: &Value, is_rebuilt: impl Fn(usize, usize) -> bool) -> Numbered {
    let (mut old, mut used) = (Numbered::default(), named_by_extensions(text));
    for (i, mesh) in root.meshes.iter().enumerate() {
        for (j, primitive) in mesh.primitives.iter().enumerate() {
            let named = if is_rebuilt(i, j) {
                &mut old
            } else {
                &mut used
            };
            named.accessors.extend(primitive.accessors());
        }
    }
    let bound = root
        .skins
        .iter()
        .filter_map(|skin| skin.inverse_bind_matrices);
    used.accessors.extend(bound);
    for sampler in root
        .animations
        .iter()
        .flat_map(|animation| &animation.samplers)
    {
        used.accessors.extend([sampler.input, sampler.output]);
    }
    let accessors: BTreeSet<usize> = old.accessors.difference(&used.accessors).copied().collect();
    used.views
        .extend(root.images.iter().filter_map(|image| image.buffer_view));
    for (i, accessor) in root.accessors.iter().enumerate() {
        let is_free = accessors.contains(&i);
        let named = if is_free {
            &mut old.views
        } else {
            &mut used.views
        };
        named.extend(views(accessor));
    }
    Numbered {
        accessors,
        views: old.views.difference(&used.views).copied().collect(),
    }
}

fn views(accessor: &Accessor) -> impl Iterator<Item = usize> {
    let sparse = accessor.sparse.as_ref();
    let sparse = sparse.map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]);
    accessor
        .buffer_view
        .into_iter()
        .chain(sparse.into_iter().flatten())
}

fn named_by_extensions(text: &Value) -> Numbered {
    let mut named = Numbered::default();
    search(text, false, &mut named);
    named
}

fn search(value: &Value, is_inside: bool, named: &mut Numbered) {
    match value {
        Value::Array(values) => values
            .iter()
            .for_each(|value| search(value, is_inside, named)),
        Value::Object(values) => {
            for (key, value) in values {
                let key = key.to_ascii_lowercase();
                if is_inside && (key.contains("accessor") || key == "attributes") {
                    collect(value, &mut named.accessors);
                }
                // The last three are those of EXT_structural_metadata.
                let names_views = key.contains("bufferview")
                    || ["values", "arrayoffsets", "stringoffsets"].contains(&key.as_str());
                if is_inside && names_views {
                    collect(value, &mut named.views);
                }
                search(value, is_inside || key == "extensions", named);
            }
        }
        _ => {}
    }
}

fn collect(value: &Value, into: &mut BTreeSet<usize>) {
    match value {
        Value::Array(values) => values.iter().for_each(|value| collect(value, into)),
        Value::Object(values) => values.values().for_each(|value| collect(value, into)),
        value => into.extend(value.as_u64().map(|n| n as usize)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_others_name_is_not_free() {
        let accessor = |view: usize| {
            format!(
                r#"{{"bufferView": {view}, "componentType": 5126, "type": "VEC3", "count": 1}}"#
            )
        };
        let accessors: Vec<_> = [0, 1, 2, 3, 3, 4].map(accessor).into();
        let text = format!(
            r#"{{"asset": {{"version": "2.0"}}, "accessors": [{}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1}}, "indices": 4,
                "targets": [{{"POSITION": 5}}]}},
                {{"attributes": {{"POSITION": 1}}, "mode": 0}}]}}],
            "nodes": [{{"extensions": {{"EXT_mesh_gpu_instancing": {{"attributes": {{"SCALE": 5}}}}}}}}],
            "skins": [{{"joints": [0], "inverseBindMatrices": 2}}],
            "animations": [{{"samplers": [{{"input": 2, "output": 3}}], "channels": []}}]}}"#,
            accessors.join(",")
        );
        let root: Root = serde_json::from_str(&text).unwrap();
        let text: Value = serde_json::from_str(&text).unwrap();
        let found = free(&root, &text, |mesh, primitive| (mesh, primitive) == (0, 0));
        let wanted = Numbered {
            accessors: [0, 4].into(),
            views: [0].into(),
        };
        assert_eq!(found, wanted);
    }
}
