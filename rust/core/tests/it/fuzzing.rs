// SPDX-License-Identifier: MIT OR Apache-2.0
//! The targets of the fuzzer, on the inputs that it has found, and on a sound one each.

use std::fs;
use std::path::{Path, PathBuf};

#[path = "../../../fuzz/src/lib.rs"]
mod targets;

#[test]
fn inputs_that_made_a_target_fail_do_so_no_more_and_still_come_to_a_result() {
    for (name, check) in targets::TARGETS {
        let inputs = entries(&corpus().join(name));
        assert!(!inputs.is_empty(), "{name} has no input");
        for file in inputs {
            println!("{}", file.display());
            assert!(check(&fs::read(&file).unwrap()), "{}: nothing was looked at", file.display());
        }
    }
}

#[test]
fn every_folder_of_inputs_has_the_name_of_a_target() {
    for folder in entries(&corpus()) {
        assert!(targets::TARGETS.iter().any(|(name, _)| folder.ends_with(name)), "{}", folder.display());
    }
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus")
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    entries.map(|entry| entry.unwrap().path()).collect()
}
