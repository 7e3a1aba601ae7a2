//! The HTML report in a browser: it fits a phone, obeys its own policy, and its search works. Skips where no browser is
//! installed ($CHROME, chromium, chromium-browser, google-chrome).

mod browser;
mod example;

use browser::Browser;
use radianza::verify::report::html;
use std::path::Path;

/// Widths of a phone and of a desktop \[px\].
const WIDTHS: [u32; 2] = [360, 1280];

/// Puts the page into a frame of `width`, asks it things, and leaves the answers as attributes of the root.
fn probe(page: &str, width: u32) -> String {
    let escaped = page.replace('&', "&amp;").replace('"', "&quot;");
    let script = include_str!("probe.js");
    format!(
        "<!DOCTYPE html><html><body style=\"margin:0\"><iframe style=\"border:0;width:{width}px;height:4000px\" \
         srcdoc=\"{escaped}\"></iframe><script>{script}</script></body></html>"
    )
}

/// The probe's answers.
struct Answers(String);

impl Answers {
    fn get(&self, key: &str) -> &str {
        let root = &self.0[self.0.find("<html").expect("a root")..];
        let root = &root[..root.find('>').expect("its end")];
        let start = root.find(&format!("data-{key}=\"")).unwrap_or_else(|| panic!("no {key} in {root}"));
        root[start..].split('"').nth(1).expect("a value")
    }
}

#[test]
fn the_page_fits_and_works_in_a_browser() {
    let Some(browser) = Browser::find() else { return };
    let page = html::page(&example::report(), &example::about());
    for width in WIDTHS {
        let (dom, console) = browser.dump(&probe(&page, width));
        assert_eq!(console, Vec::<String>::new(), "the console is silent at {width} px");
        let answers = Answers(dom);
        for state in ["closed", "open"] {
            let (scroll, wide) = (answers.get(state), answers.get(&format!("{state}-wide")));
            assert_eq!((scroll, wide), ("0", ""), "the page scrolls sideways at {width} px, {state}");
        }
        for (key, expected) in [
            ("sections", "overview,failures,distribution,topics"),
            ("topics", "3"),
            ("subjects", "14"),
            ("open-at-first", "A5,X1"),
            ("charts", "3"),
            ("broken-images", "0"),
            ("alerts", "0"),
            ("search-hit", "1"),
            ("search-miss", "0"),
            ("only-failing", "2"),
        ] {
            assert_eq!(answers.get(key), expected, "{key} at {width} px");
        }
        assert!(answers.get("images").parse::<u32>().unwrap() >= 7, "three panels, three scales, a picture");
    }
}

#[test]
fn what_is_not_the_pages_own_does_not_run() {
    let Some(browser) = Browser::find() else { return };
    let page = html::page(&example::report(), &example::about());
    let alien = page.replace("</body>", "<script>parent.document.documentElement.dataset.alien = 1</script></body>");
    assert_ne!(page, alien);
    let (dom, console) = browser.dump(&probe(&alien, 1280));
    assert!(!dom.contains("data-alien"));
    assert!(console.iter().any(|line| line.contains("Content Security Policy")), "{console:?}");
}

/// To look at: `target/tmp/report-WIDTH.png` as it comes, and `-dark` in the dark.
#[test]
fn screenshots_are_taken() {
    let Some(browser) = Browser::find() else { return };
    let page = html::page(&example::report(), &example::about());
    for width in WIDTHS {
        for dark in [false, true] {
            let name = format!("report-{width}{}.png", if dark { "-dark" } else { "" });
            let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
            browser.screenshot(&page, width, dark, &path);
            let image = image::open(&path).unwrap().into_rgb8();
            assert_eq!(image.width(), width, "{}", path.display());
            let corner = image.get_pixel(2, 2).0[0];
            assert!(if dark { corner < 64 } else { corner > 192 }, "the page follows the system's colours: {corner}");
        }
    }
}
