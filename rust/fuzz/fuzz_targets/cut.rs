// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs `cut` of the library, which says what it looks for.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    authalic_fuzz::cut::check(bytes);
});
