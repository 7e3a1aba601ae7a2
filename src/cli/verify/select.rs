//! Which tasks are run, and what they are called.

use crate::cli::Failure;
use radianza::verify::Task;
use radianza::verify::report::one_line;

/// How many names a pattern that fits none is answered with.
const SHOWN: usize = 3;

/// The tasks that a pattern names; each pattern must name one.
pub(super) fn select(tasks: Vec<Task>, only: &[String]) -> Result<Vec<Task>, Failure> {
    for pattern in only {
        if !tasks.iter().any(|task| task.matches(std::slice::from_ref(pattern))) {
            let names: Vec<String> = tasks.iter().map(Task::name).collect();
            return Err(Failure::Usage(format!(
                "--only {pattern}: nothing has that in its name{}",
                near(pattern, &names)
            )));
        }
    }
    Ok(tasks.into_iter().filter(|task| task.matches(only)).collect())
}

/// Names that are like a pattern, or have a word that is.
fn near(pattern: &str, names: &[String]) -> String {
    let pattern = pattern.to_lowercase();
    let likeness = |name: &String| {
        let name = name.to_lowercase();
        let parts = name.split(['/', ' ']).chain([&*name]);
        parts.map(|part| strsim::jaro_winkler(&pattern, part)).fold(0.0, f64::max)
    };
    let mut names: Vec<(f64, &String)> = names.iter().map(|name| (likeness(name), name)).collect();
    names.sort_by(|a, b| b.0.total_cmp(&a.0));
    match names.iter().take(SHOWN).map(|(_, name)| format!("`{}`", one_line(name))).collect::<Vec<_>>() {
        none if none.is_empty() => String::new(),
        names => format!("; near are {}; --list names all", names.join(", ")),
    }
}

/// Names, one a line; above them what a topic means, if `verbose`.
pub(super) fn list(tasks: &[Task], verbose: bool) -> String {
    let mut lines = String::new();
    let mut last = None;
    for task in tasks {
        if verbose && last != Some(task.topic) {
            lines += &format!("# {}: {} ({})\n", task.topic.id, task.topic.title, task.topic.source);
            last = Some(task.topic);
        }
        lines += &one_line(&task.name());
        lines.push('\n');
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use radianza::verify::Topic;

    fn tasks() -> Vec<Task> {
        const TOPIC: Topic = Topic { id: "A5", title: "energy", source: "Heitz" };
        ["white conductor", "glass"].map(|subject| Task::new(TOPIC, subject, |_, _| {})).into()
    }

    #[test]
    fn patterns_choose() {
        assert_eq!(select(tasks(), &["GLASS".into()]).unwrap().len(), 1);
        assert_eq!(select(tasks(), &[]).unwrap().len(), 2);
        assert_eq!(select(tasks(), &["a5".into()]).unwrap().len(), 2);
    }

    #[test]
    fn a_pattern_that_fits_nothing_is_answered() {
        let message = select(tasks(), &["glass".into(), "conducter".into()]).unwrap_err().to_string();
        assert!(message.starts_with("--only conducter: nothing"), "{message}");
        assert!(message.find("`A5/white conductor`") < message.find("`A5/glass`"), "{message}");
        assert!(select(vec![], &["a".into()]).is_err());
    }

    #[test]
    fn names_a_line() {
        assert_eq!(list(&tasks(), false), "A5/white conductor\nA5/glass\n");
        assert_eq!(list(&tasks(), true), "# A5: energy (Heitz)\nA5/white conductor\nA5/glass\n");
    }
}
