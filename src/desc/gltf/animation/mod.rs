//! Animations (glTF 2.0, section 3.11; KHR_animation_pointer): the document at one time.
//!
//! All animations of a file play together, from the same zero. The values that their channels have at the time asked
//! for are written to the properties that they animate, before the document is read: a scene at a time is the scene of
//! a document without animations.

mod keyframes;
mod property;

use super::accessor::Accessors;
use super::component::Types;
use super::notes::Notes;
use crate::desc::Error;
use keyframes::{Curve, Interpolation};
use property::{Kind, Property, Unfit};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::collections::HashSet;

#[derive(Deserialize)]
struct Animation {
    #[serde(default)]
    channels: Vec<Channel>,
    #[serde(default)]
    samplers: Vec<Sampler>,
}

#[derive(Deserialize)]
struct Channel {
    sampler: usize,
    target: Target,
}

#[derive(Deserialize)]
struct Target {
    node: Option<usize>,
    path: String,
    #[serde(default)]
    extensions: Map<String, Value>,
}

#[derive(Deserialize)]
struct Sampler {
    input: usize,
    output: usize,
    #[serde(default)]
    interpolation: Interpolation,
}

/// When the last of `animations` ends \[s\], as far as their accessors say; `None` where there are none.
pub(super) fn duration(animations: &Value, document: &Value) -> Option<f64> {
    let animations = animations.as_array().filter(|list| !list.is_empty())?;
    let samplers = animations.iter().filter_map(|a| a.get("samplers")?.as_array()).flatten();
    let end = |sampler: &Value| {
        let input = sampler.get("input")?.as_u64()?;
        document.pointer(&format!("/accessors/{input}/max/0"))?.as_f64()
    };
    Some(samplers.filter_map(end).fold(0.0, f64::max))
}

/// Writes what `animations` say at `time` \[s\] into the document that they belong to.
pub(super) fn pose(
    document: &mut Value,
    animations: &Value,
    time: f64,
    accessors: Accessors,
    notes: &mut Notes,
) -> Result<(), Error> {
    let source = accessors.source;
    let Some(animations) = animations.as_array() else {
        return Err(source.invalid("/animations", "is no list of animations"));
    };
    let mut written = HashSet::new();
    for (i, animation) in animations.iter().enumerate() {
        let place = format!("/animations/{i}");
        let Animation { channels, samplers } =
            Animation::deserialize(animation).map_err(|e| source.invalid(&place, e.to_string()))?;
        for (c, channel) in channels.iter().enumerate() {
            let at = format!("{place}/channels/{c}");
            let property = match target(&channel.target) {
                Ok(property) => property,
                Err(Unfit::Wrong(message)) => return Err(source.invalid(format!("{at}/target"), message)),
                Err(Unfit::Ignored(note)) => {
                    notes.at(&format!("{at}/target"), note);
                    continue;
                }
            };
            let sampler = source.get(&samplers, channel.sampler, "sampler", &format!("{at}/sampler"))?;
            let from = format!("{place}/samplers/{}", channel.sampler);
            let numbers = sample(sampler, property.kind, time, accessors, &from)?;
            accessors.budget.decode(source, &at, property.copies(document), size_of::<Value>())?;
            match property.write(document, &numbers) {
                Ok(()) if written.insert(property.pointer) => {}
                Ok(()) => notes.at(&at, "what more than one channel animates has the value of the last one"),
                Err(Unfit::Wrong(message)) => return Err(source.invalid(from, message)),
                Err(Unfit::Ignored(note)) => notes.at(&format!("{at}/target"), note),
            }
        }
    }
    Ok(())
}

/// The property that a channel animates.
fn target(target: &Target) -> Result<Property, Unfit> {
    let kind = match target.path.as_str() {
        "pointer" => {
            let extension = target.extensions.get("KHR_animation_pointer");
            let pointer = extension.and_then(|e| e.get("pointer")).and_then(Value::as_str);
            return Property::of_pointer(pointer.ok_or(Unfit::Wrong("has no KHR_animation_pointer/pointer".into()))?);
        }
        "translation" | "scale" => Kind::Vector(3),
        "rotation" => Kind::Rotation,
        "weights" => Kind::Weights,
        other => {
            let message = format!(
                "has the path {other:?}; expected \"translation\", \"rotation\", \"scale\", \"weights\" or \"pointer\""
            );
            return Err(Unfit::Wrong(message));
        }
    };
    match target.node {
        Some(node) => Ok(Property { pointer: format!("/nodes/{node}/{}", target.path), kind }),
        None => Err(Unfit::Ignored("channels without a target are ignored".into())),
    }
}

/// The numbers of the curve of the sampler at `place`.
fn sample(sampler: &Sampler, kind: Kind, time: f64, accessors: Accessors, place: &str) -> Result<Vec<f64>, Error> {
    let source = accessors.source;
    let (input, output) = (format!("{place}/input"), format!("{place}/output"));
    let times = accessors.floats::<1>(sampler.input, &input, Types::FLOAT)?.into_flattened();
    if let Some(i) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        let message =
            format!("element {} is {}, after {}; expected times that increase", i + 1, times[i + 1], times[i]);
        return Err(source.invalid(input, message));
    }
    let values = match kind {
        Kind::Vector(2) => accessors.floats::<2>(sampler.output, &output, Types::ANY)?.into_flattened(),
        Kind::Vector(3) => accessors.floats::<3>(sampler.output, &output, Types::ANY)?.into_flattened(),
        Kind::Vector(4) => accessors.floats::<4>(sampler.output, &output, Types::ANY)?.into_flattened(),
        Kind::Rotation => accessors.floats::<4>(sampler.output, &output, Types::UNIT)?.into_flattened(),
        Kind::Vector(_) | Kind::Weights | Kind::Flag => {
            accessors.floats::<1>(sampler.output, &output, Types::ANY)?.into_flattened()
        }
    };
    if kind == Kind::Flag && sampler.interpolation != Interpolation::Step {
        let message = "is not \"STEP\", which truth values need";
        return Err(source.invalid(format!("{place}/interpolation"), message));
    }

    // Weights come as many to a key as there are; of the others the kind says how many.
    let keys = times.len() * sampler.interpolation.values();
    let lanes = match kind {
        Kind::Vector(n) => n,
        Kind::Rotation => 4,
        Kind::Flag => 1,
        Kind::Weights => values.len() / keys,
    };
    if lanes == 0 || values.len() != keys * lanes {
        let count = accessors.elements(sampler.output, &output)?.count();
        let message = format!("has {count} elements for {} times and {:?}", times.len(), sampler.interpolation);
        return Err(source.invalid(output, message));
    }
    let curve = Curve { times: &times, values: &values, lanes, interpolation: sampler.interpolation };
    Ok(if kind == Kind::Rotation { curve.rotation(time).to_vec() } else { curve.at(time) })
}
