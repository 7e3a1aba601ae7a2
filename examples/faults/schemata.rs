//! Many faults in the text of one program, of which each run chooses one: "mutant schemata" (Untch, Offutt & Harrold 1993,
//! "Mutation Analysis Using Mutant Schemata"), so that all are compiled once.
//!
//! A fault that changes nothing of a file but the body of a function is written beside the body that is there,
//!
//! ```text
//! fn area(r: f32) -> f32 {
//!     if ::radianza::planted(17) { 0.5 * PI * r * r } else { PI * r * r }
//! }
//! ```
//!
//! Bodies are found by parsing, and moved as text. What cannot be chosen while the program runs is left to a build of its
//! own: constants, types, signatures, `const fn`, and functions whose `impl Trait` is another type in either body.

use super::patch::Result;
use std::ops::Range;
use syn::visit::{self, Visit};

/// Number of a fault in the program that holds many; 0 is none.
pub(crate) type Number = u32;

/// The body of a function, in place of the one that is there.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Change {
    /// Of all functions of the file, in their order.
    pub(crate) function: usize,
    /// With its braces.
    pub(crate) body: String,
}

/// A function that is not inside another's body.
struct Function {
    /// Bytes of its body, from brace to brace.
    body: Range<usize>,
    /// Whether its body may be chosen while the program runs.
    switchable: bool,
}

/// Collects the functions of a file.
#[derive(Default)]
struct Functions(Vec<Function>);

impl Functions {
    fn add(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let mut hidden = HiddenType(false);
        hidden.visit_return_type(&signature.output);
        let braces = block.brace_token.span;
        let body = braces.open().byte_range().start..braces.close().byte_range().end;
        self.0.push(Function { body, switchable: signature.constness.is_none() && !hidden.0 });
    }
}

impl Visit<'_> for Functions {
    fn visit_item_fn(&mut self, f: &syn::ItemFn) {
        self.add(&f.sig, &f.block);
    }

    fn visit_impl_item_fn(&mut self, f: &syn::ImplItemFn) {
        self.add(&f.sig, &f.block);
    }

    fn visit_trait_item_fn(&mut self, f: &syn::TraitItemFn) {
        if let Some(block) = &f.default {
            self.add(&f.sig, block);
        }
    }
}

/// Whether a type has an `impl Trait` in it.
struct HiddenType(bool);

impl Visit<'_> for HiddenType {
    fn visit_type_impl_trait(&mut self, _: &syn::TypeImplTrait) {
        self.0 = true;
    }
}

/// The functions of a source text.
fn functions(text: &str) -> Result<Vec<Function>> {
    let file = syn::parse_file(text).map_err(|e| e.to_string())?;
    let mut found = Functions::default();
    visit::visit_file(&mut found, &file);
    // Positions count from the first byte only where nothing was cut off before parsing.
    let sound =
        |f: &Function| text.get(f.body.clone()).is_some_and(|body| body.starts_with('{') && body.ends_with('}'));
    match found.0.iter().all(sound) {
        true => Ok(found.0),
        false => Err("bodies of functions are not where the parser says".into()),
    }
}

/// All of a text that is in no body.
fn around<'a>(text: &'a str, functions: &[Function]) -> Vec<&'a str> {
    let starts = std::iter::once(0).chain(functions.iter().map(|f| f.body.end));
    let ends = functions.iter().map(|f| f.body.start).chain([text.len()]);
    starts.zip(ends).map(|(start, end)| &text[start..end]).collect()
}

/// What a fault makes of a file, as bodies of functions; `None` where it cannot be said so.
pub(crate) fn changes(original: &str, planted: &str) -> Result<Option<Vec<Change>>> {
    let (old, new) = (functions(original)?, functions(planted)?);
    if around(original, &old) != around(planted, &new) {
        return Ok(None);
    }
    let mut changes = Vec::new();
    for (function, (old, new)) in old.iter().zip(&new).enumerate() {
        let body = &planted[new.body.clone()];
        if *body != original[old.body.clone()] {
            if !old.switchable {
                return Ok(None);
            }
            changes.push(Change { function, body: body.to_owned() });
        }
    }
    Ok(Some(changes))
}

/// Where faults stand in a text, in bytes.
pub(crate) type Places = Vec<(Number, Range<usize>)>;

/// A file with many faults in it, and where each stands.
pub(crate) fn combine(original: &str, faults: &[(Number, Vec<Change>)]) -> Result<(String, Places)> {
    let (mut text, mut places, mut end) = (String::new(), Vec::new(), 0);
    for (i, function) in functions(original)?.iter().enumerate() {
        let of_this = |(number, changes): &'_ (Number, Vec<Change>)| {
            let change = changes.iter().find(|change| change.function == i)?;
            Some((*number, change.body.clone()))
        };
        let bodies: Vec<(Number, String)> = faults.iter().filter_map(of_this).collect();
        if bodies.is_empty() {
            continue;
        }
        text += &original[end..function.body.start];
        text += "{ ";
        for (number, body) in bodies {
            text += &format!("if ::radianza::planted({number}) ");
            let start = text.len();
            text += &body;
            places.push((number, start..text.len()));
            text += " else ";
        }
        text += &original[function.body.clone()];
        text += " }";
        end = function.body.end;
    }
    text += &original[end..];
    Ok((text, places))
}

/// In place of a fault's number: nothing is planted, and the numbers of all faults whose functions run are written down.
pub(crate) const RECORD: Number = Number::MAX;

/// What the library has in addition: whether a fault is planted, as the environment says. The name `radianza` leads to it
/// from the library and from the program alike.
pub(crate) const SWITCH: &str = r#"
extern crate self as radianza;

/// Whether the environment variable `RADIANZA_FAULT` is `number`.
#[inline(always)]
pub fn planted(number: u32) -> bool {
    static PLANTED: std::sync::LazyLock<u32> =
        std::sync::LazyLock::new(|| std::env::var("RADIANZA_FAULT").ok().and_then(|text| text.parse().ok()).unwrap_or(0));
    let planted = *PLANTED;
    planted == number || planted == u32::MAX && reached(number)
}

/// Writes the number of a function that runs to the file `RADIANZA_REACHED`, once, and plants nothing.
#[cold]
fn reached(number: u32) -> bool {
    use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
    static REACHED: [AtomicBool; 4096] = [const { AtomicBool::new(false) }; 4096];
    let known = &REACHED[number as usize];
    if !known.load(Relaxed) && !known.swap(true, Relaxed) {
        let path = std::env::var_os("RADIANZA_REACHED").expect("a file to write to");
        let file = std::fs::OpenOptions::new().create(true).append(true).open(path);
        let written = file.and_then(|mut file| std::io::Write::write_all(&mut file, format!("{number}\n").as_bytes()));
        written.expect("it can be written");
    }
    false
}
"#;
