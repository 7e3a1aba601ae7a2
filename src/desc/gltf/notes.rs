//! What the reader did that the author may not expect, each sentence once.

use std::collections::HashMap;

/// Sentences in the order of their first occurrence, with the place of that and how often they occurred.
#[derive(Default)]
pub(super) struct Notes {
    list: Vec<Note>,
    known: HashMap<String, usize>,
}

struct Note {
    sentence: String,
    place: String,
    count: usize,
}

impl Notes {
    /// About the whole file.
    pub(super) fn say(&mut self, sentence: impl Into<String>) {
        self.add(sentence, "", 1);
    }

    /// About one place.
    pub(super) fn at(&mut self, place: &str, sentence: impl Into<String>) {
        self.add(sentence, place, 1);
    }

    /// About `count` things at one place.
    pub(super) fn add(&mut self, sentence: impl Into<String>, place: &str, count: usize) {
        let sentence = sentence.into();
        match self.known.get(&sentence) {
            Some(&i) => self.list[i].count += count,
            None => {
                self.known.insert(sentence.clone(), self.list.len());
                self.list.push(Note { sentence, place: place.into(), count });
            }
        }
    }

    /// The sentences, with `(place; n in all)` behind them.
    pub(super) fn finish(self) -> Vec<String> {
        let text = |Note { sentence, place, count }: Note| match (place.as_str(), count) {
            ("", _) => sentence,
            (place, 1) => format!("{sentence} ({place})"),
            (place, n) => format!("{sentence} (first at {place}; {n} in all)"),
        };
        self.list.into_iter().map(text).collect()
    }
}
