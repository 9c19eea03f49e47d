//! Surfaces of damaged solids are closed as far as that is asked for, and are what that makes of them.
#![no_main]

#[path = "../../geometry/tests/common/mod.rs"]
mod common;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| common::closing::check(bytes));
