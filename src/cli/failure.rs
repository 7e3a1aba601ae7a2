//! Failures and their exit codes.

use radianza::desc;
use radianza::film::exr::ReadError;
use radianza::render;
use std::io;
use std::path::PathBuf;

/// What stands under every `--help`.
pub(crate) const HELP: &str = "\
Exit codes:
    0  done
    1  comparison or verification failed
    2  usage: arguments that are wrong or do not fit the scene
    3  bad scene or image: its content is wrong
    4  missing: a scene, or a file that it refers to, cannot be read
    5  unsupported: valid, but asks for what is not honoured
    6  output not writable
   75  interrupted: the image is valid and written, with fewer samples than asked for
  130  interrupted twice, before the first pass, or during a verification: nothing was written

Environment:
    RADIANZA_ISA  portable, avx2 or avx512: the kernel that traces rays, in place of the best that this CPU runs; changes
                  nothing in the image";

/// Why a command did not do what it was asked for.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// `compare` found too much.
    #[error("{0}")]
    Comparison(String),
    /// `verify` found checks that fail.
    #[error("{0}")]
    Verification(String),
    /// Arguments that are wrong or do not fit the scene.
    #[error("{0}")]
    Usage(String),
    /// The scene cannot be read.
    #[error("{0}")]
    Scene(#[from] desc::Error),
    /// An image cannot be read.
    #[error("{} {}", .0.display(), .1)]
    Image(PathBuf, ReadError),
    /// An output cannot be written.
    #[error("{} cannot be written: {}", .0.display(), .1)]
    Output(PathBuf, io::Error),
    /// The render ended before its first pass.
    #[error("interrupted before the first pass; nothing was written")]
    Nothing,
    /// A verification ended early at the user's wish.
    #[error("interrupted; nothing was written")]
    Abandoned,
    /// The render ended early at the user's wish; the image is there.
    #[error("interrupted after {taken} of {asked}; the image holds what was taken")]
    Interrupted {
        /// Samples per pixel taken.
        taken: u32,
        /// Samples per pixel, or time, asked for.
        asked: String,
    },
}

impl Failure {
    /// The process's exit code.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Comparison(_) | Self::Verification(_) => 1,
            Self::Usage(_) => 2,
            Self::Scene(e) => match e.kind {
                desc::ErrorKind::Invalid => 3,
                desc::ErrorKind::Missing => 4,
                desc::ErrorKind::Unsupported => 5,
                desc::ErrorKind::Choice => 2,
            },
            Self::Image(_, ReadError::Invalid(_)) => 3,
            Self::Image(_, ReadError::Missing(_)) => 4,
            Self::Image(_, ReadError::Unsupported(_)) => 5,
            Self::Output(..) => 6,
            Self::Interrupted { .. } => 75,
            Self::Nothing | Self::Abandoned => 130,
        }
    }

    /// One line on stderr (usage: several). The words that render farms take for a crash never occur in our own text.
    pub(crate) fn report(&self) {
        eprintln!("radianza: {self}");
    }
}

impl From<render::Error> for Failure {
    /// A render refuses only settings that do not fit the scene.
    fn from(e: render::Error) -> Self {
        Self::Usage(e.to_string())
    }
}
