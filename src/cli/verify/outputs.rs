//! Where the findings go beside the table.

use super::{Arguments, print};
use crate::cli::Failure;
use radianza::film::file::{check_writable, write_atomic};
use radianza::verify::Report;
use radianza::verify::report::{About, html, json, junit};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, Debug)]
enum Form {
    Json,
    Junit,
    Html,
}

/// Forms and their places; `-` is stdout.
pub(super) struct Outputs(Vec<(Form, PathBuf)>);

impl Outputs {
    /// What the arguments ask for; every file is tried.
    pub(super) fn new(arguments: &Arguments) -> Result<Self, Failure> {
        let asked = [(Form::Json, &arguments.json), (Form::Junit, &arguments.junit), (Form::Html, &arguments.html)];
        let asked: Vec<_> = asked.into_iter().filter_map(|(form, path)| Some((form, path.clone()?))).collect();
        for (i, (_, path)) in asked.iter().enumerate() {
            if asked[..i].iter().any(|(_, other)| other == path) {
                return Err(Failure::Usage(format!("{} is asked for twice", path.display())));
            }
            if !is_stdout(path) {
                check_writable(path).map_err(|e| Failure::Output(path.clone(), e))?;
            }
        }
        Ok(Self(asked))
    }

    /// True where stdout is taken.
    pub(super) fn take_stdout(&self) -> bool {
        self.0.iter().any(|(_, path)| is_stdout(path))
    }

    /// Writes all of them.
    pub(super) fn write(&self, report: &Report, about: &About) -> Result<(), Failure> {
        for (form, path) in &self.0 {
            let text = match form {
                Form::Json => json::text(report, about).map_err(io::Error::other),
                Form::Junit => junit::text(report, about),
                Form::Html => Ok(html::page(report, about)),
            };
            let fail = |e| Failure::Output(path.clone(), e);
            let text = text.map_err(fail)?;
            match is_stdout(path) {
                true => print(&text)?,
                false => write_atomic(path, |file| file.write_all(text.as_bytes())).map_err(fail)?,
            }
        }
        Ok(())
    }
}

fn is_stdout(path: &Path) -> bool {
    path == Path::new("-")
}
