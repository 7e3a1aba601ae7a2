//! Building programs, and letting them verify themselves.

use super::patch::Result;
use crate::battery::{Outcome, crash};
use crate::schemata::{Number, RECORD};
use crate::tree::{Files, Tree};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How often a running battery is looked after.
const TICK: Duration = Duration::from_millis(50);

/// Where programs are built, and where they write: a folder below cargo's target folder.
pub(crate) struct Workshop {
    folder: PathBuf,
}

/// A program that does not compile.
pub(crate) struct Broken {
    /// What the compiler said.
    pub(crate) message: String,
    /// Files, by their path from the tree's root, and bytes at which errors begin.
    pub(crate) places: Vec<(PathBuf, usize)>,
}

/// What is run of a battery.
#[derive(Clone, Copy)]
pub(crate) struct Run<'a> {
    /// The program.
    pub(crate) program: &'a Path,
    /// Which of its faults is chosen.
    pub(crate) fault: Number,
    /// Time after which it counts as hanging.
    pub(crate) limit: Option<Duration>,
}

impl Workshop {
    pub(crate) fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Builds the program of `tree` but for the files of `changed`, in a copy of that name, and says where it lies. Two
    /// copies share the dependencies, and each keeps what is compiled of it.
    ///
    /// # Errors
    /// The outer where nothing could be tried.
    pub(crate) fn build(
        &self,
        name: &str,
        tree: &Tree,
        changed: &Files,
    ) -> Result<std::result::Result<PathBuf, Broken>> {
        let copy = self.folder.join(name).join("tree");
        tree.copy(&copy, changed)?;
        let build = self.folder.join("build");
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let output = Command::new(cargo)
            .args(["build", "--quiet", "--profile", "faults", "--bin", "radianza", "--message-format", "json"])
            .arg("--target-dir")
            .arg(&build)
            .current_dir(&copy)
            .output()
            .map_err(|e| format!("cargo: {e}"))?;
        if !output.status.success() {
            return Ok(Err(Broken::read(&output.stdout, &output.stderr)));
        }
        let file = format!("radianza{}", std::env::consts::EXE_SUFFIX);
        let (built, program) = (build.join("faults").join(&file), self.folder.join(name).join(&file));
        fs::copy(&built, &program).map_err(|e| format!("{}: {e}", built.display()))?;
        Ok(Ok(program))
    }

    /// Runs the battery of a program, or what has one of the given patterns in its name; an eighth of it where that is
    /// `quick`.
    pub(crate) fn run(&self, run: Run, only: &[String], quick: bool) -> Result<Outcome> {
        let [findings, complaints] = ["findings.json", "stderr.txt"].map(|name| self.folder.join(name));
        let _ = fs::remove_file(&findings);
        let stderr = File::create(&complaints).map_err(|e| format!("{}: {e}", complaints.display()))?;
        let mut command = Command::new(run.program);
        command.args(["verify", "--quiet", "--json"]).arg(&findings).env("RADIANZA_FAULT", run.fault.to_string());
        command.env("RADIANZA_REACHED", self.reached());
        if quick {
            command.arg("--quick");
        }
        only.iter().for_each(|pattern| {
            command.arg("--only").arg(pattern);
        });
        let start = Instant::now();
        let mut child = command
            .current_dir(&self.folder)
            .stdout(Stdio::null())
            .stderr(stderr)
            .spawn()
            .map_err(|e| format!("{}: {e}", run.program.display()))?;
        let end = loop {
            match child.try_wait().map_err(|e| e.to_string())? {
                Some(status) => break Some(status),
                None if run.limit.is_some_and(|limit| start.elapsed() > limit) => break None,
                None => sleep(TICK),
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        let Some(status) = end else {
            child.kill().and_then(|()| child.wait()).map_err(|e| e.to_string())?;
            return Ok(Outcome::ended(format!("hangs: stopped after {seconds:.0} s"), seconds));
        };
        match fs::read(&findings) {
            Ok(json) => Outcome::read(&json, seconds),
            Err(_) => Ok(Outcome::ended(crash(status, &complaints), seconds)),
        }
    }
}

impl Workshop {
    /// The faults of a program whose functions one subject of the quick battery runs.
    pub(crate) fn record(&self, program: &Path, subject: &str) -> Result<BTreeSet<Number>> {
        let _ = fs::remove_file(self.reached());
        let outcome = self.run(Run { program, fault: RECORD, limit: None }, &[subject.to_owned()], true)?;
        if let Some(ended) = outcome.ended {
            return Err(format!("{subject}: {ended}"));
        }
        let text = fs::read_to_string(self.reached()).unwrap_or_default();
        text.lines().map(|line| line.parse().map_err(|e| format!("`{line}`: {e}"))).collect()
    }

    fn reached(&self) -> PathBuf {
        self.folder.join("reached.txt")
    }
}

/// Of cargo's messages, what is read here.
#[derive(Deserialize)]
struct Line {
    message: Option<Message>,
}

#[derive(Deserialize)]
struct Message {
    level: String,
    rendered: Option<String>,
    spans: Vec<Span>,
}

#[derive(Deserialize)]
struct Span {
    file_name: PathBuf,
    byte_start: usize,
}

impl Broken {
    /// Reads cargo's messages as JSON, one a line, and what it said itself.
    fn read(stdout: &[u8], stderr: &[u8]) -> Self {
        let mut broken = Self { message: String::from("it does not build:\n"), places: Vec::new() };
        for line in String::from_utf8_lossy(stdout).lines() {
            let Ok(Line { message: Some(message) }) = serde_json::from_str(line) else { continue };
            if message.level == "error" {
                broken.message += &message.rendered.unwrap_or_default();
                broken.places.extend(message.spans.into_iter().map(|span| (span.file_name, span.byte_start)));
            }
        }
        broken.message += &String::from_utf8_lossy(stderr);
        broken
    }
}
