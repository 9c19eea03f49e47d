//! Ctrl-C while the program reads, whatever it reads.
#![cfg(unix)]

mod support;

use std::fs;
use std::process::Command;

use support::{Folder, ball, interrupt_while_opened};

#[test]
fn ctrl_c_ends_the_program_whatever_it_waits_for() {
    let folder = Folder::new();
    let input = folder.write("ball.obj", &ball(""));
    let [pipe, output] = ["pipe", "out.obj"].map(|name| folder.path(name));
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo exists").success());
    let names = folder.names();
    for arguments in [
        ["remesh", &pipe, &output, "--input-format", "obj"],
        ["remesh", &input, &output, "--density", &pipe],
        ["remesh", &input, &output, "--weights", &pipe],
        ["predict", &input, &output, "--density", &pipe],
        ["predict", &input, &output, "--weights", &pipe],
        ["embed", &input, "--report=-", "--weights", &pipe],
    ] {
        let open = || fs::OpenOptions::new().write(true).open(&pipe).unwrap();
        let ended = interrupt_while_opened(&arguments, open);
        assert_eq!((ended.code, ended.err.as_str()), (130, ""), "{arguments:?}");
        assert_eq!(folder.names(), names, "{arguments:?}");
    }
}
