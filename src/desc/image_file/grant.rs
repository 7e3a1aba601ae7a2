//! How much the images of one scene may grow while they are decoded: files without loss hold a million equal pixels in a
//! few bytes.

use std::cell::Cell;

/// Granted to every scene \[bytes\]: as much as its largest image may take.
const BASE: u64 = super::MAX_BYTES;

/// Granted for each byte of the files: about what deflate makes of equal pixels.
const GROWTH: u64 = 1024;

/// What is left of the grant of a scene.
pub(in crate::desc) struct Grant(Cell<u64>);

impl Default for Grant {
    fn default() -> Self {
        Self(Cell::new(BASE))
    }
}

impl Grant {
    /// Grants the growth of a file of so many bytes that was read; of each file once.
    pub(in crate::desc) fn read(&self, bytes: usize) {
        self.0.set(self.0.get().saturating_add(GROWTH.saturating_mul(bytes as u64)));
    }

    /// Pays for so many bytes of decoded pixels; the error says what was found and what is granted.
    pub(in crate::desc) fn pay(&self, decoded: usize) -> Result<(), String> {
        let left = self.0.get().checked_sub(decoded as u64).ok_or_else(|| {
            format!(
                "{} MiB of pixels are too many for files of this size; all images together may have {} MiB and {GROWTH} \
                 times the files' bytes",
                decoded >> 20,
                BASE >> 20
            )
        })?;
        self.0.set(left);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_files_are_granted_one_large_image() {
        let grant = Grant::default();
        grant.read(100);
        assert_eq!(grant.pay(BASE as usize), Ok(()));
        assert_eq!(grant.pay(100 << 10), Ok(()));
        assert!(grant.pay(1).unwrap_err().contains("0 MiB of pixels are too many for files of this size"));
        // A large file pays for itself.
        grant.read(8 << 20);
        assert_eq!(grant.pay(4 << 30), Ok(()));
    }
}
