//! The log of a run: a line of JSON every interval.

use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::Path;

use serde::Deserialize;

use crate::curve::draw_log;
use crate::run::{Line, TrainError, file_error};
use crate::whole;

/// What every line has, also one whose figures are no numbers.
#[derive(Deserialize)]
struct Step {
    step: usize,
}

/// Adds a line to the log and draws all of it.
///
/// # Errors
/// [`TrainError::File`].
pub fn add(run: &Path, line: &Line) -> Result<(), TrainError> {
    let path = run.join("log.jsonl");
    let text = serde_json::to_string(line).expect("a line is plain numbers");
    let open = OpenOptions::new().create(true).append(true).open(&path);
    open.and_then(|mut file| writeln!(file, "{text}"))
        .map_err(|cause| file_error(&path, cause))?;
    draw_log(run)
}

/// Takes the lines out of the log that come after a step, which the run will write again, and one that
/// a kill cut.
///
/// # Errors
/// [`TrainError::File`].
pub fn cut_back(run: &Path, step: usize) -> Result<(), TrainError> {
    let path = run.join("log.jsonl");
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(cause) => return Err(file_error(&path, cause)),
    };
    let is_kept = |line: &&str| serde_json::from_str::<Step>(line).is_ok_and(|l| l.step <= step);
    let kept = text.lines().filter(is_kept);
    let kept: String = kept.flat_map(|line| [line, "\n"]).collect();
    if kept == text {
        return Ok(());
    }
    whole::write(&path, kept.as_bytes()).map_err(|cause| file_error(&path, cause))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_after_the_step_and_a_cut_one_are_taken_out() {
        let run = tempfile::tempdir().unwrap();
        let path = run.path().join("log.jsonl");
        let line = |step: usize| format!("{{\"step\":{step},\"loss\":null}}");
        let three = [4, 8, 12].map(line).join("\n");
        for (text, step, n_left) in [
            (three.clone(), 12, 3),
            (three.clone(), 8, 2),
            (three.clone(), 0, 0),
            (three[..three.len() - 1].to_owned(), 12, 2),
        ] {
            fs::write(&path, text).unwrap();
            cut_back(run.path(), step).unwrap();
            let wanted = [4, 8, 12].map(|step| line(step) + "\n");
            assert_eq!(
                fs::read_to_string(&path).unwrap(),
                wanted[..n_left].concat()
            );
        }
        fs::remove_file(&path).unwrap();
        cut_back(run.path(), 8).unwrap();
        assert!(!path.exists());
    }
}
