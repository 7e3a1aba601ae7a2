//! Tables whose keys a `serde` type declares: `[render]` and `[expect]` have the types that other modules use too.

use super::read::{Fault, Node, Read, mismatch, suggest};
use super::schema::Defs;
use crate::desc::{Expect, RenderSettings};
use ::toml::Spanned;
use ::toml::de::{DeTable, DeValue, ValueDeserializer};
use serde::de::DeserializeOwned;
use serde_json::Value as Json;

/// A value of a type that derives its reader and its schema.
#[derive(Clone, Debug)]
pub(super) struct Derived<T>(pub(super) T);

/// What `serde` cannot say: the ranges of the numbers.
pub(super) trait Checked {
    /// What is wrong with the values, if anything.
    fn check(&self) -> Result<(), String>;
}

impl<T: DeserializeOwned + schemars::JsonSchema + Checked> Read for Derived<T> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let DeValue::Table(table) = node.get_ref() else { return Err(mismatch::<Self>(node)) };
        // Keys with hyphens, as everywhere.
        let mut keys = DeTable::new();
        for (key, value) in table.iter() {
            let name = key.get_ref().replace('-', "_");
            if keys.insert(Spanned::new(key.span(), name.clone().into()), value.clone()).is_some() {
                return Err(Fault::new(&key.span(), format!("`{name}` is given twice")));
            }
        }
        let renamed = Spanned::new(node.span(), DeValue::Table(keys));
        let value = T::deserialize(ValueDeserializer::from(renamed)).map_err(|e| {
            let at = e.span().unwrap_or(node.span());
            let fault = Fault::new(&at, reworded(e.message()));
            let key = table.iter().find(|(_, value)| value.span().contains(&at.start));
            key.map_or(fault.clone(), |(key, _)| fault.under(key.get_ref()))
        })?;
        value.check().map_err(|message| Fault::new(&node.span(), message))?;
        Ok(Self(value))
    }
    fn absent() -> Option<Self> {
        None
    }
    fn one() -> String {
        "a table".into()
    }
    fn many() -> String {
        "tables".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        defs.derived::<T>()
    }
}

/// `serde`'s "unknown field `a`, expected one of `b`, `c`" with the nearest word instead of all.
fn reworded(message: &str) -> String {
    let what = match message {
        m if m.starts_with("unknown field") => "key",
        m if m.starts_with("unknown variant") => "value",
        m => return m.replace("invalid type: ", "found ").replace("invalid value: ", "found "),
    };
    let mut quoted = message.split('`').skip(1).step_by(2);
    let found = quoted.next().unwrap_or_default();
    format!("unknown {what} `{found}`; {}", suggest(found, quoted))
}

impl Checked for RenderSettings {
    fn check(&self) -> Result<(), String> {
        match self {
            Self { spp: Some(0), .. } => Err("`spp` is 0, expected at least 1".into()),
            Self { exposure: Some(e), .. } if !e.is_finite() => {
                Err(format!("`exposure` is {e}, expected a finite number"))
            }
            _ => Ok(()),
        }
    }
}

impl Checked for Expect {
    fn check(&self) -> Result<(), String> {
        let values = self.radiance.iter().chain(self.layers.values());
        let wrong = values.flat_map(|v| v.rgb()).find(|x| !(x.is_finite() && *x >= 0.0));
        if let Some(x) = wrong {
            return Err(format!("the expected value {x} is not a radiance; expected a number ≥ 0"));
        }
        let layers = ["emission", "D", "S", "DD", "SD", "DS", "SS"];
        if let Some(name) = self.layers.keys().find(|k| !layers.contains(&k.as_str())) {
            return Err(format!("unknown layer `{name}`; {}", suggest(name, layers)));
        }
        if self.radiance.is_none() && self.layers.is_empty() {
            return Err("nothing is expected; give `radiance` or `layers`".into());
        }
        if let Some([x0, y0, x1, y1]) = self.region.filter(|[x0, y0, x1, y1]| x0 >= x1 || y0 >= y1) {
            return Err(format!("`region` is [{x0}, {y0}, {x1}, {y1}], expected [x0, y0, x1, y1], x0 < x1, y0 < y1"));
        }
        if self.spp == Some(0) {
            return Err("`spp` is 0, expected at least 1".into());
        }
        if !(self.tolerance.is_finite() && self.tolerance >= 0.0) {
            return Err(format!("`tolerance` is {}, expected a number ≥ 0", self.tolerance));
        }
        Ok(())
    }
}
