//! Every broken file of `tests/bad`: what reading and cleaning make of it.

use std::fs;
use std::path::Path;

use orbflow_geometry::clean::clean;
use orbflow_geometry::mesh::TriangleMesh;
use orbflow_geometry::mesh::io::{Format, read};
use orbflow_geometry::progress::Progress;

/// What becomes of a file: words of an error, or what is said of the mesh.
type Outcome = Result<&'static str, &'static str>;

const NO_AREA: &str = "the mesh has no area: each of its 12 faces is a point or a line";

const EXPECTED: &[(&str, Outcome)] = &[
    ("all_points_equal", Err(NO_AREA)),
    ("comment_only", Err("the mesh has no faces (0 vertices)")),
    ("cut_off", Err("line 3: 3 coordinates expected, 2 found")),
    (
        "duplicate_face",
        Ok("closed, 1 part, genus 0; 1 duplicate face dropped"),
    ),
    (
        "duplicate_vertices",
        Ok("closed, 1 part, genus 0; 28 duplicate vertices welded"),
    ),
    (
        "edge_shared_by_three",
        Err("3 faces meet at the edge between vertices 0 and 1; at most 2 can"),
    ),
    ("empty", Err("the mesh has no faces (0 vertices)")),
    ("far_from_origin", Ok("closed, 1 part, genus 0")),
    ("flat", Ok("closed, 1 part, genus 0")),
    (
        "flipped_face",
        Ok("closed, 1 part, genus 0; 1 face re-oriented"),
    ),
    ("huge_scale", Ok("closed, 1 part, genus 0")),
    (
        "index_out_of_range",
        Err("line 21: the face names vertex 99, but there are 8 vertices"),
    ),
    (
        "inf_coordinate",
        Err("line 8: vertex 7 has a coordinate that is not finite: (inf, 1, 1)"),
    ),
    ("inside_out", Ok("closed, 1 part, genus 0")),
    (
        "isolated_vertex",
        Ok("closed, 1 part, genus 0; 1 isolated vertex dropped"),
    ),
    ("missing_face", Ok("1 border loop of 3 edges, 1 part")),
    (
        "moebius_strip",
        Err(
            "the surface cannot be oriented (it has one side, like a moebius strip): faces \
             disagree along the edge between vertices 24 and 25 whichever way they are turned",
        ),
    ),
    (
        "nan_coordinate",
        Err("line 8: vertex 7 has a coordinate that is not finite: (NaN, 1, 1)"),
    ),
    ("negative_indices", Ok("closed, 1 part, genus 0")),
    ("points_only", Err("the mesh has no faces (8 vertices)")),
    ("self_intersecting", Ok("closed, 2 parts, genus 0")),
    (
        "single_triangle",
        Err("the faces use 3 different points; at least 4 are needed"),
    ),
    (
        "text_instead_of_numbers",
        Err("line 1: 'a' is not a number"),
    ),
    ("tiny_scale", Ok("closed, 1 part, genus 0")),
    (
        "two_boxes_sharing_a_vertex",
        Ok("closed, 2 parts, genus 0; 1 vertex added where fans met"),
    ),
    (
        "zero_area_faces",
        Ok("closed, 1 part, genus 0; 2 degenerate faces dropped; 1 triangle without area dropped"),
    ),
];

fn outcome(path: &Path) -> Result<String, String> {
    let bytes = fs::read(path).expect("the file is part of the repository");
    let file = read(&bytes, Format::Obj).map_err(|error| error.to_string())?;
    let cleaned = clean(&file.mesh, &Progress::none()).map_err(|error| error.to_string())?;
    cleaned
        .mesh
        .check()
        .expect("a clean mesh passes the checks");
    let mut words = vec![described(&cleaned.mesh)];
    words.extend(cleaned.report.sentences());
    Ok(words.join("; "))
}

fn described(mesh: &TriangleMesh) -> String {
    let n_parts = mesh.face_components().1;
    let parts = format!("{n_parts} part{}", if n_parts == 1 { "" } else { "s" });
    match mesh.border_loops().as_slice() {
        [] => {
            let genus = n_parts as i64 - mesh.euler_number() / 2;
            format!("closed, {parts}, genus {genus}")
        }
        [border] => format!("1 border loop of {} edges, {parts}", border.len()),
        borders => format!("{} border loops, {parts}", borders.len()),
    }
}

#[test]
fn every_broken_file_ends_as_expected() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let entries = fs::read_dir(&folder).expect("the folder exists").flatten();
    let is_mesh = |path: &Path| path.extension().is_some_and(|ending| ending == "obj");
    let n_files = entries.filter(|entry| is_mesh(&entry.path())).count();
    assert_eq!(n_files, EXPECTED.len());
    for (name, expected) in EXPECTED {
        let outcome = outcome(&folder.join(name).with_extension("obj"));
        let outcome = outcome.as_deref().map_err(String::as_str);
        assert_eq!(outcome, expected.as_deref().map_err(|e| *e), "{name}");
    }
}
