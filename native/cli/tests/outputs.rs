//! What a run leaves behind: every file that was asked for, or none.

mod support;

use std::fs;

use support::{Folder, ball, run};

#[test]
fn one_file_by_two_names_is_not_written_twice() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let old = folder.write("old.obj", "precious");
    let new = folder.path("new.obj");
    let again = |name: &str| folder.path(&format!("../{}/{name}", folder.name()));
    let [same_old, same_new] = ["old.obj", "new.obj"].map(again);
    for (output, again) in [(&new, &same_new), (&old, &same_old)] {
        for flag in ["--sphere", "--report"] {
            refuses_twice(&["remesh", &input, output, flag, again]);
        }
        refuses_twice(&["embed", &input, "--report", output, "--sphere", again]);
    }
    assert_eq!(fs::read_to_string(old).unwrap(), "precious");
    assert_eq!(folder.names(), ["ball.obj", "old.obj"]);
}

#[cfg(unix)]
#[test]
fn links_to_one_place_are_one_file() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let old = folder.write("old.obj", "precious");
    let [first, second, around] = ["a.obj", "b.obj", "around"].map(|name| folder.path(name));
    symlink(&old, &first).unwrap();
    symlink(&old, &second).unwrap();
    symlink(folder.path("."), &around).unwrap();
    let names = folder.names();
    let [new, same_new] = ["new.obj", "around/new.obj"].map(|name| folder.path(name));
    for (output, again) in [(&first, &second), (&old, &first), (&new, &same_new)] {
        refuses_twice(&["remesh", &input, output, "--sphere", again]);
    }
    assert_eq!(fs::read_to_string(old).unwrap(), "precious");
    assert_eq!(folder.names(), names);
}

fn refuses_twice(arguments: &[&str]) {
    let refused = run(arguments);
    assert_eq!(refused.code, 2, "{arguments:?}: {}", refused.err);
    let words = "would be written twice";
    assert!(
        refused.err.contains(words),
        "{arguments:?}: {}",
        refused.err
    );
}

#[cfg(target_os = "linux")]
#[test]
fn no_file_appears_where_a_device_is_full() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let report = folder.path("x.json");
    let sphere = ["--sphere", "/dev/full", "--output-format", "obj"];
    let failed = run(&[&["embed", &input, "--report", &report][..], &sphere].concat());
    assert_eq!(failed.code, 3);
    let words = "cannot write /dev/full";
    assert!(failed.err.contains(words), "{}", failed.err);
    assert_eq!(folder.names(), ["ball.obj"]);
}

#[cfg(unix)]
#[test]
fn no_file_appears_where_nobody_reads_standard_output() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let output = folder.path("out.obj");
    let failed =
        support::run_unread(&["remesh", &input, &output, "--report", "-", "--faces", "200"]);
    assert_eq!(failed.code, 3);
    assert!(failed.err.contains("cannot write -"), "{}", failed.err);
    assert_eq!(folder.names(), ["ball.obj"]);
}
