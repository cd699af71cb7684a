#![no_main]

use cobotwire_fuzz::laws;

libfuzzer_sys::fuzz_target!(|data: &[u8]| laws::editions::files_are_read_or_refused(data));
