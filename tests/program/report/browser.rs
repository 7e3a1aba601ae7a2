//! A headless browser.

use std::ffi::OsString;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// After this a browser hangs.
const PATIENCE: Duration = Duration::from_secs(180);

pub(crate) struct Browser(OsString);

impl Browser {
    /// The first that runs; says so where there is none.
    pub(crate) fn find() -> Option<Self> {
        let names = ["chromium", "chromium-browser", "google-chrome"].map(OsString::from);
        let found = std::env::var_os("CHROME").into_iter().chain(names).find(|name| {
            let version = Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
            version.is_ok_and(|status| status.success())
        });
        if found.is_none() {
            crate::skip::skip("neither $CHROME nor chromium, chromium-browser or google-chrome runs");
        }
        found.map(Self)
    }

    /// The page's elements once it has loaded, and what it said on the console.
    pub(crate) fn dump(&self, page: &str) -> (String, Vec<String>) {
        let folder = folder(page);
        let (dom, log) = self.run(folder.path(), &["--dump-dom", "--window-size=1280,2000"]);
        (dom, log.lines().filter(|line| line.contains("CONSOLE")).map(Into::into).collect())
    }

    /// The window as it looks, written to `path`.
    pub(crate) fn screenshot(&self, page: &str, width: u32, dark: bool, path: &Path) {
        let folder = folder(page);
        let _ = fs::remove_file(path);
        let (screenshot, size) = (format!("--screenshot={}", path.display()), format!("--window-size={width},2600"));
        let dark =
            if dark { "--blink-settings=preferredColorScheme=0" } else { "--blink-settings=preferredColorScheme=1" };
        let (_, log) = self.run(folder.path(), &[&screenshot, &size, "--hide-scrollbars", dark]);
        assert!(path.exists(), "no screenshot\n{log}");
    }

    /// stdout and stderr.
    fn run(&self, folder: &Path, options: &[&str]) -> (String, String) {
        let [out, err] = ["out", "err"].map(|name| folder.join(name));
        let mut child = Command::new(&self.0)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--no-first-run"])
            .arg(format!("--user-data-dir={}", folder.join("profile").display()))
            .args(options)
            .arg(folder.join("page.html"))
            .stdout(File::create(&out).unwrap())
            .stderr(File::create(&err).unwrap())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while child.try_wait().unwrap().is_none() {
            if start.elapsed() > PATIENCE {
                let _ = child.kill();
                panic!("the browser does not end\n{}", read(&err));
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        (read(&out), read(&err))
    }
}

fn folder(page: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("page.html"), page).unwrap();
    folder
}

fn read(path: &Path) -> String {
    String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned()
}
