//! What a reader says when a file cannot be honoured.

use std::fmt;
use std::path::{Path, PathBuf};

/// A file could not be turned into a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The file.
    pub file: PathBuf,
    /// Where in it: `12:3` (line and column), a JSON pointer, or empty.
    pub place: String,
    /// What was found and what was expected.
    pub message: String,
    /// What sort of failure, for the exit code.
    pub kind: ErrorKind,
}

/// Sorts of failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The file's content is wrong.
    Invalid,
    /// The file, or one that it refers to, is missing or unreadable.
    Missing,
    /// The content is valid but asks for what is not honoured.
    Unsupported,
    /// The content is valid and lacks what was asked for.
    Choice,
}

impl Error {
    /// Wrong content.
    pub fn invalid(file: &Path, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { file: file.into(), place: place.into(), message: message.into(), kind: ErrorKind::Invalid }
    }

    /// Missing or unreadable file.
    pub fn missing(file: &Path, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { file: file.into(), place: place.into(), message: message.into(), kind: ErrorKind::Missing }
    }

    /// Valid but not honoured.
    pub fn unsupported(file: &Path, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { file: file.into(), place: place.into(), message: message.into(), kind: ErrorKind::Unsupported }
    }

    /// Valid but without what was asked for.
    pub fn choice(file: &Path, message: impl Into<String>) -> Self {
        Self { file: file.into(), place: String::new(), message: message.into(), kind: ErrorKind::Choice }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if !self.place.is_empty() {
            write!(f, ":{}", self.place)?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for Error {}
