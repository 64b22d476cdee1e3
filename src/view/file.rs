//! The file of a recording. Rerun's own sink for files writes in a thread of its own, and whoever waits for that
//! thread when the disk is full may wait for ever; this one is as simple as it can be.

use rerun::external::re_log_encoding::Encoder;
use rerun::external::re_log_encoding::rrd::EncodingOptions;
use rerun::log::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};
use std::fs::File;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Writes messages into a file. Clones write into the same one.
#[derive(Clone)]
pub struct RrdFile(Arc<Mutex<Writer>>);

struct Writer {
    encoder: Encoder<File>,
    /// The first thing that went wrong: nothing is written after it.
    failure: Option<String>,
}

impl RrdFile {
    /// Begins a recording in an empty file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn new(file: File) -> std::io::Result<Self> {
        let (version, options) =
            (rerun::build_info().version, EncodingOptions::PROTOBUF_COMPRESSED);
        let encoder = Encoder::new_eager(version, options, file).map_err(std::io::Error::other)?;
        Ok(Self(Arc::new(Mutex::new(Writer { encoder, failure: None }))))
    }

    /// Writes the end of the file: an index of what is in it. Nothing may be sent after that.
    ///
    /// # Errors
    /// What went wrong, at any time.
    pub fn finish(&self) -> Result<(), String> {
        self.writer().write(|encoder| encoder.finish().map_err(|error| error.to_string()))
    }

    fn writer(&self) -> MutexGuard<'_, Writer> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Writer {
    fn write(
        &mut self,
        write: impl FnOnce(&mut Encoder<File>) -> Result<(), String>,
    ) -> Result<(), String> {
        if self.failure.is_none() {
            self.failure = write(&mut self.encoder).err();
        }
        self.failure.clone().map_or(Ok(()), Err)
    }
}

impl LogSink for RrdFile {
    fn send(&self, message: LogMsg) {
        // Whoever flushes hears of it.
        let _ = self.writer().write(|encoder| {
            encoder.append(&message).map(|_| ()).map_err(|error| error.to_string())
        });
    }

    fn flush_blocking(&self, _: Duration) -> Result<(), SinkFlushError> {
        let flush =
            |encoder: &mut Encoder<File>| encoder.flush_blocking().map_err(|e| e.to_string());
        self.writer().write(flush).map_err(|message| SinkFlushError::Failed { message })
    }
}
