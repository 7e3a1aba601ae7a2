//! The program that holds all faults that one program can hold.

use super::patch::{Patch, Result};
use crate::schemata::{Change, Number, SWITCH, changes, combine};
use crate::tree::{Files, Tree};
use crate::workshop::{Broken, Workshop};
use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The file that tells the faults apart.
const ROOT: &str = "src/lib.rs";

/// A built program with faults to choose from.
pub(crate) struct Many {
    /// Where it lies.
    pub(crate) program: PathBuf,
    /// The faults that it holds, by name.
    pub(crate) numbers: BTreeMap<String, Number>,
    /// A number that tells such programs of one tree apart.
    pub(crate) hash: u64,
}

/// The bodies of functions that a fault changes, by file.
type Bodies = BTreeMap<PathBuf, Vec<Change>>;

/// A tree with faults to choose from.
struct Written {
    files: Files,
    /// Where a fault stands.
    places: Vec<(PathBuf, Range<usize>, Number)>,
}

impl Many {
    /// Builds the program of `tree` with every fault that changes bodies of functions alone and compiles beside the others.
    pub(crate) fn build(tree: &Tree, patches: &[Patch], workshop: &Workshop) -> Result<Self> {
        let mut faults = BTreeMap::new();
        let mut names = BTreeMap::new();
        for (number, patch) in (1..).zip(patches) {
            if let Some(bodies) = bodies(tree, patch)? {
                faults.insert(number, bodies);
                names.insert(number, patch.name.clone());
            }
        }
        loop {
            let written = write(tree, &faults)?;
            let broken = match workshop.build("many", tree, &written.files)? {
                Ok(program) => {
                    let numbers = faults.keys().map(|number| (names[number].clone(), *number)).collect();
                    let mut hasher = DefaultHasher::new();
                    written.files.hash(&mut hasher);
                    return Ok(Self { program, numbers, hash: hasher.finish() });
                }
                Err(broken) => broken,
            };
            // Without the faults in which the compiler has found errors, again.
            let wrong = written.blamed(&broken);
            if wrong.is_empty() {
                return Err(broken.message);
            }
            for number in wrong {
                println!("{} does not compile beside the others", names[&number]);
                faults.remove(&number);
            }
        }
    }
}

impl Written {
    /// The faults in whose bodies an error lies.
    fn blamed(&self, broken: &Broken) -> BTreeSet<Number> {
        let holds = |(path, range, _): &&(PathBuf, Range<usize>, Number)| {
            broken.places.iter().any(|(file, at)| file == path && range.contains(at))
        };
        self.places.iter().filter(holds).map(|(.., number)| *number).collect()
    }
}

/// A fault as bodies of functions; `None` where it is more than that, or no Rust.
fn bodies(tree: &Tree, patch: &Patch) -> Result<Option<Bodies>> {
    let mut bodies = Bodies::new();
    for (path, planted) in tree.planted(patch)? {
        match changes(tree.text(&path)?, &String::from_utf8_lossy(&planted)) {
            Ok(Some(changes)) => bodies.insert(path, changes),
            _ => return Ok(None),
        };
    }
    Ok(Some(bodies))
}

/// The files that hold the faults.
fn write(tree: &Tree, faults: &BTreeMap<Number, Bodies>) -> Result<Written> {
    let root = Path::new(ROOT);
    let paths: BTreeSet<&Path> = faults.values().flat_map(|bodies| bodies.keys()).map(|path| &**path).collect();
    let mut written = Written { files: Files::new(), places: Vec::new() };
    for path in paths.into_iter().chain([root]) {
        let of_this = faults.iter().filter_map(|(number, bodies)| Some((*number, bodies.get(path)?.clone())));
        let (mut text, places) = combine(tree.text(path)?, &of_this.collect::<Vec<_>>())?;
        if path == root {
            text += SWITCH;
        }
        written.files.insert(path.to_owned(), text.into_bytes());
        written.places.extend(places.into_iter().map(|(number, range)| (path.to_owned(), range, number)));
    }
    Ok(written)
}
