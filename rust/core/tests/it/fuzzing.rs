// SPDX-License-Identifier: MIT OR Apache-2.0
//! The targets of the fuzzer, on the inputs that it has found.

use std::fs;
use std::path::{Path, PathBuf};

#[path = "../../../fuzz/src/lib.rs"]
mod targets;

#[test]
fn inputs_that_made_a_target_fail_do_so_no_more() {
    let folders = entries(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus"));
    assert!(!folders.is_empty());
    for folder in folders {
        let is_of = |(name, _): &&targets::Target| folder.ends_with(name);
        let (_, check) = targets::TARGETS.iter().find(is_of).expect("a target with the name of the folder");
        for file in entries(&folder) {
            println!("{}", file.display());
            check(&fs::read(file).unwrap());
        }
    }
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
}
