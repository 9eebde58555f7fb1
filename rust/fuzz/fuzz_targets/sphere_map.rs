// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs `sphere_map` of the library, which says what it looks for.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    authalic_fuzz::sphere_map::check(bytes);
});
