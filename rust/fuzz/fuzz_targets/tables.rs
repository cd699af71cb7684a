#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    cobotwire_fuzz::laws::tables::any_table_is_rejected_or_works(data)
});
