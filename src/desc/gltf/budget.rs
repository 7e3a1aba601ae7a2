//! How much a file may grow while it is decoded: a few hundred bytes of JSON can ask for any number of vertices.

use super::Source;
use crate::desc::Error;
use crate::desc::image_file::Grant;
use std::cell::{Cell, RefCell};
use std::collections::HashSet;

/// Granted to every file \[bytes\].
const BASE: u64 = 256 << 20;
/// Granted for each byte of the document and its buffers: one 8-bit index may become a triangle with its own vertices.
const GROWTH: u64 = 256;
/// Most bytes that are read from other files.
const EXTERNAL: u64 = 16 << 30;

/// What is left of the three grants.
pub(super) struct Budget {
    decoded: Cell<u64>,
    external: Cell<u64>,
    /// Files that were read, by their names.
    files: RefCell<HashSet<String>>,
    pixels: Grant,
}

impl Budget {
    /// For a file of so many bytes.
    pub(super) fn of(bytes: usize) -> Self {
        let pixels = Grant::default();
        pixels.read(bytes);
        Self {
            decoded: Cell::new(BASE + GROWTH * bytes as u64),
            external: Cell::new(EXTERNAL),
            files: RefCell::default(),
            pixels,
        }
    }

    /// Pays for `count` things of `size` bytes before they are allocated.
    pub(super) fn decode(&self, source: Source, place: &str, count: usize, size: usize) -> Result<(), Error> {
        pay(&self.decoded, count as u64, size as u64).ok_or_else(|| {
            let message = format!(
                "{count} × {size} bytes are too many for a file of this size; at most {} MiB and {GROWTH} times the \
                 file's bytes are decoded",
                BASE >> 20
            );
            source.invalid(place, message)
        })
    }

    /// Bytes that can still be decoded.
    pub(super) fn left(&self) -> u64 {
        self.decoded.get()
    }

    /// Pays for a file that was read, and grants its growth where it is read for the first time.
    pub(super) fn external(&self, source: Source, place: &str, name: &str, bytes: usize) -> Result<(), Error> {
        if self.files.borrow_mut().insert(name.to_owned()) {
            self.decoded.set(self.decoded.get().saturating_add(GROWTH * bytes as u64));
            self.pixels.read(bytes);
        }
        let message = || format!("refers to more than {} GiB in other files", EXTERNAL >> 30);
        pay(&self.external, bytes as u64, 1).ok_or_else(|| source.invalid(place, message()))
    }

    /// Pays for so many bytes of decoded pixels.
    pub(super) fn pixels(&self, source: Source, place: &str, decoded: usize) -> Result<(), Error> {
        self.pixels.pay(decoded).map_err(|message| source.invalid(place, message))
    }
}

/// Takes `count * size` from what is left; `None` where that is not enough.
fn pay(left: &Cell<u64>, count: u64, size: u64) -> Option<()> {
    left.set(left.get().checked_sub(count.checked_mul(size)?)?);
    Some(())
}
