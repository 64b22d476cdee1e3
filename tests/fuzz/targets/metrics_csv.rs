#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    islands_fuzz::bodies::metrics_csv(data);
});
