//! Runs the program and makes its inputs.
#![allow(dead_code)] // Every test file uses a part of it.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use orbflow_geometry::elementary::sin;
use tempfile::TempDir;

/// How many faces [`ball`] has.
pub const BALL_FACES: usize = 6 * SQUARES * SQUARES;
const SQUARES: usize = 12;

/// What the program left.
pub struct Ended {
    pub code: i32,
    pub out: Vec<u8>,
    pub err: String,
}

/// A folder that goes away.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(TempDir::new().expect("a temporary folder can be made"))
    }

    pub fn path(&self, name: &str) -> String {
        let path = self.0.path().join(name);
        path.to_str().expect("the path is text").to_owned()
    }

    /// Its own name.
    pub fn name(&self) -> &str {
        let name = self.0.path().file_name().and_then(OsStr::to_str);
        name.expect("the name is text")
    }

    pub fn write(&self, name: &str, text: &str) -> String {
        let path = self.path(name);
        fs::write(&path, text).expect("the folder can be written");
        path
    }

    /// What is in it, hidden files too.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path())
            .expect("the folder can be read")
            .flatten();
        let mut names: Vec<_> = entries
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        names.sort_unstable();
        names
    }
}

/// A bumpy ball of quads as OBJ, with `before` in front of its faces.
pub fn ball(before: &str) -> String {
    grid(SQUARES, before)
}

fn grid(n: usize, before: &str) -> String {
    let (mut text, mut faces) = (String::new(), String::new());
    let mut ids = HashMap::new();
    let mut vertex = |side: usize, i: usize, j: usize| {
        let at = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
        let [u, v, w] = [at(i), at(j), if side < 3 { 1.0 } else { -1.0 }];
        let [x, y, z] = match side % 3 {
            0 => [w, u, v],
            1 => [v, w, u],
            _ => [u, v, w],
        };
        let r = (1.0 + 0.2 * sin(3.0 * x + y)) / (x * x + y * y + z * z).sqrt();
        let line = format!("v {:.6} {:.6} {:.6}\n", x * r, y * r, z * r);
        let next = ids.len() + 1;
        *ids.entry(line).or_insert_with_key(|line| {
            text.push_str(line);
            next
        })
    };
    for side in 0..6 {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut quad = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                .map(|(i, j)| vertex(side, i, j).to_string());
            if side >= 3 {
                quad.reverse();
            }
            faces.extend(["f ", &quad.join(" "), "\n"]);
        }
    }
    text + before + &faces
}

pub fn run(arguments: &[&str]) -> Ended {
    run_with_input(arguments, b"")
}

pub fn run_with_input(arguments: &[&str], input: &[u8]) -> Ended {
    let mut child = start(arguments);
    let mut stdin = child.stdin.take().expect("it is piped");
    let bytes = input.to_owned();
    // Written beside, because the program may answer before it has read everything, or not read.
    let writer = thread::spawn(move || drop(stdin.write_all(&bytes)));
    let ended = wait(child);
    writer.join().expect("the writer does not panic");
    ended
}

/// Runs the program with a standard output that nobody reads.
pub fn run_unread(arguments: &[&str]) -> Ended {
    let mut child = start(arguments);
    drop(child.stdout.take());
    wait(child)
}

fn start(arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_orbflow"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

fn wait(child: Child) -> Ended {
    let output = child.wait_with_output().expect("the program ends");
    Ended {
        code: output.status.code().expect("no signal ends the program"),
        out: output.stdout,
        err: String::from_utf8(output.stderr).expect("messages are text"),
    }
}

/// Sends Ctrl-C once the temporary file shows that the work has begun.
#[cfg(unix)]
pub fn interrupt_while_working() {
    let folder = Folder::new();
    let input = folder.write("large.obj", &grid(150, ""));
    let embed = ["embed", &input, "--report", &folder.path("report.json")];
    let ended = interrupt_once(&embed, || folder.names().len() > 1);
    assert_eq!(
        (ended.code, ended.err.as_str()),
        (130, "orbflow: cancelled, nothing was written\n")
    );
    assert_eq!(folder.names(), ["large.obj"]);
}

/// Sends Ctrl-C to the program once `is_time`.
#[cfg(unix)]
pub fn interrupt_once(arguments: &[&str], is_time: impl Fn() -> bool) -> Ended {
    let child = start(arguments);
    while !is_time() {
        thread::sleep(Duration::from_millis(5));
    }
    interrupt(&child);
    wait(child)
}

/// Sends Ctrl-C to a program that waits for the rest of its input.
#[cfg(unix)]
pub fn interrupt_while_reading() {
    let mut child = start(&["decimate", "-", "-", "--faces", "100"]);
    let mut stdin = child.stdin.take().expect("it is piped");
    stdin
        .write_all(&vec![b'\n'; 1 << 20])
        .expect("the program reads");
    interrupt(&child);
    let ended = wait(child);
    assert_eq!((ended.code, ended.out.len()), (130, 0));
}

/// Sends Ctrl-C to a program that waits for what a pipe will give it: `open` opens the pipe and
/// waits for the program to do so.
#[cfg(unix)]
pub fn interrupt_while_opened(arguments: &[&str], open: impl FnOnce() -> fs::File) -> Ended {
    let mut child = start(arguments);
    let pipe = open();
    interrupt(&child);
    let patience = Instant::now() + Duration::from_secs(10);
    while child.try_wait().expect("it was started").is_none() {
        if Instant::now() > patience {
            child.kill().expect("it still runs");
            panic!("Ctrl-C does not end {arguments:?}");
        }
        thread::sleep(Duration::from_millis(5));
    }
    drop(pipe);
    wait(child)
}

#[cfg(unix)]
fn interrupt(child: &Child) {
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.expect("kill exists").success());
}
