#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    cobotwire_fuzz::laws::exchange::file_is_refused_or_every_byte_is_in_one_event_and_every_wait_ends(data)
});
