//! A report as JUnit XML, which CI systems show: a suite a topic, a case a check, classes by subject.

use super::{About, Cells, Group, Report, SOFTWARE, Section, one_line};
use crate::stats::Check;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::io;

/// The document as text.
pub fn text(report: &Report, about: &About) -> io::Result<String> {
    let mut bytes = Vec::new();
    write(&mut Writer::new_with_indent(&mut bytes, b' ', 2), report, about)?;
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(io::Error::other)
}

type Out<'a> = Writer<&'a mut Vec<u8>>;

fn write(out: &mut Out, report: &Report, about: &About) -> io::Result<()> {
    let share = report.share();
    out.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let counts = Counts::new(report.checks().map(|(_, check)| check), share);
    let suites = out.create_element("testsuites").with_attributes([
        ("name", &*one_line(&about.what)),
        ("tests", &counts.tests),
        ("failures", &counts.failures),
        ("errors", "0"),
        ("time", &seconds(report.time.as_secs_f64())),
    ]);
    suites.write_inner_content(|out| {
        report.groups().iter().try_for_each(|group| suite(out, group, report, about, share))
    })?;
    Ok(())
}

struct Counts {
    tests: String,
    failures: String,
}

impl Counts {
    fn new<'a>(checks: impl Iterator<Item = &'a Check>, share: f64) -> Self {
        let (mut tests, mut failures) = (0, 0);
        for check in checks {
            tests += 1;
            failures += usize::from(check.p() < share);
        }
        Self { tests: tests.to_string(), failures: failures.to_string() }
    }
}

fn suite(out: &mut Out, group: &Group, report: &Report, about: &About, share: f64) -> io::Result<()> {
    let counts = Counts::new(group.checks(), share);
    let time: f64 = group.sections.iter().map(|section| section.time.as_secs_f64()).sum();
    let suite = out.create_element("testsuite").with_attributes([
        ("name", &*one_line(&format!("{} {}", group.topic.id, group.topic.title))),
        ("tests", &counts.tests),
        ("failures", &counts.failures),
        ("errors", "0"),
        ("skipped", "0"),
        ("time", &seconds(time)),
    ]);
    suite.write_inner_content(|out| {
        out.create_element("properties").write_inner_content(|out| {
            let properties = [
                ("software", SOFTWARE.to_string()),
                ("command", about.command.clone()),
                ("seed", report.seed.to_string()),
                ("alpha", report.alpha.to_string()),
                ("p limit", share.to_string()),
                ("source", group.sources().join("; ")),
            ];
            properties.iter().try_for_each(|(name, value)| {
                out.create_element("property")
                    .with_attributes([("name", *name), ("value", &one_line(value))])
                    .write_empty()
                    .map(drop)
            })
        })?;
        group.sections.iter().try_for_each(|section| cases(out, section, share))
    })?;
    Ok(())
}

fn cases(out: &mut Out, section: &Section, share: f64) -> io::Result<()> {
    // Time is known of the subject as a whole; its first case carries it.
    let mut time = section.time.as_secs_f64();
    for check in &section.checks {
        let case = out.create_element("testcase").with_attributes([
            ("classname", &*one_line(&section.name())),
            ("name", &one_line(&check.name)),
            ("time", &seconds(std::mem::take(&mut time))),
        ]);
        if check.p() >= share {
            case.write_empty()?;
            continue;
        }
        let message = message(check, share);
        case.write_inner_content(|out| {
            out.create_element("failure")
                .with_attributes([("type", "verification"), ("message", &message)])
                .write_text_content(BytesText::new(&one_line(&format!(
                    "{}: {}: {message}",
                    section.name(),
                    check.name
                ))))
                .map(drop)
        })?;
    }
    Ok(())
}

fn message(check: &Check, share: f64) -> String {
    let Cells { exact, estimate, statistic, .. } = Cells::new(check, share);
    let exact = if exact.is_empty() { exact } else { format!("exact {exact}") };
    let found = if estimate.is_empty() { estimate } else { format!("found {estimate}") };
    let p = format!("p {:.1e} < {share:.1e}", check.p());
    let statistic = if statistic.starts_with('z') { statistic } else { String::new() };
    [exact, found, statistic, p].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

fn seconds(seconds: f64) -> String {
    format!("{seconds:.3}")
}

#[cfg(test)]
mod tests {
    use super::super::tests::{about, example};
    use super::*;
    use quick_xml::Reader;
    use quick_xml::events::BytesStart;

    /// Name and attributes of every element; fails where the text is not well-formed.
    fn elements(text: &str) -> Vec<(String, Vec<(String, String)>)> {
        let mut reader = Reader::from_str(text);
        reader.config_mut().check_end_names = true;
        let start = |e: &BytesStart| {
            let attributes = e.attributes().map(|a| {
                let a = a.unwrap();
                let value = a.normalized_value(quick_xml::XmlVersion::Explicit1_0).unwrap();
                (a.key.as_ref().to_string(), value.into_owned())
            });
            (e.name().as_ref().to_string(), attributes.collect())
        };
        let mut found = Vec::new();
        loop {
            match reader.read_event().unwrap() {
                Event::Start(e) | Event::Empty(e) => found.push(start(&e)),
                Event::Eof => return found,
                _ => {}
            }
        }
    }

    #[test]
    fn suites_cases_and_failures() {
        let text = text(&example(true), &about()).unwrap();
        let elements = elements(&text);
        let named = |name: &str| elements.iter().filter(|e| e.0 == name).map(|e| &e.1).collect::<Vec<_>>();
        let get = |attributes: &Vec<(String, String)>, key: &str| {
            attributes.iter().find(|a| a.0 == key).map(|a| a.1.clone()).unwrap_or_default()
        };
        assert_eq!((named("testsuites").len(), named("testsuite").len(), named("testcase").len()), (1, 2, 6));
        assert_eq!(get(named("testsuites")[0], "failures"), "1");
        assert_eq!(get(named("testsuite")[0], "name"), "A1 Albedo & <energy>");
        assert_eq!(get(named("testcase")[0], "classname"), "A1/paint <script>alert(1)</script>");
        assert_eq!(get(named("testcase")[1], "name"), "tail \"quoted\" & 'so'");
        assert!(get(named("failure")[0], "message").starts_with("exact 0.500000, found 0.600000"), "{text}");
        assert!(text.chars().all(|c| !c.is_control() || c == '\n'), "{text:?}");
    }
}
