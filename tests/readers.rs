//! The readers: what they accept, and what they say of what they do not.

#[path = "readers/images.rs"]
mod images;
#[path = "readers/toml_files.rs"]
mod toml_files;

/// A folder of third-party files, if this machine has it: `$RADIANZA_ASSETS/name`.
fn assets(name: &str) -> Option<std::path::PathBuf> {
    let folder = std::env::var_os("RADIANZA_ASSETS").map(|root| std::path::Path::new(&root).join(name));
    match folder {
        Some(folder) if folder.is_dir() => Some(folder),
        _ => {
            println!("skipped: RADIANZA_ASSETS names no folder that has `{name}`");
            None
        }
    }
}
