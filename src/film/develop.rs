//! Film → image: sums become means and errors, layer by layer.

use super::layer::{Group, Layer, RADIANCE};
use super::{Film, Image};
use glam::DVec3;

/// The layers `groups` of a film, as far as it keeps them. Where a pixel has fewer than two replicates no error is known, and
/// the error layers are left out rather than filled with something.
pub fn develop(film: &Film, groups: &[&Group]) -> Image {
    let mut image = Image { size: film.size(), window: film.crop(), ..Image::default() };
    let asked = groups.iter().flat_map(|group| group.layers).filter_map(|layer| film.slot(layer.name));
    let f32s = |value: Option<DVec3>| value.unwrap_or_default().to_array().map(|x| x as f32);
    for slot in asked.clone() {
        let values = (0..film.replicates.len()).map(|i| f32s(Some(film.value_at(slot, i))));
        image.insert(slot.layer.image, slot.layer.channels, values);
    }
    // Errors of radiance, and of all other estimates that are asked for.
    if groups.iter().any(|group| group.is_errors()) && film.replicates.iter().all(|r| *r >= 2) {
        for slot in film.slot(RADIANCE).into_iter().chain(asked).filter(|slot| slot.square.is_some()) {
            let errors = (0..film.replicates.len()).map(|i| f32s(film.error_at(slot, i)));
            image.insert(&error_layer(slot.layer), slot.layer.channels, errors);
        }
    }
    image
}

/// Layer of images that holds the standard errors of an estimate.
fn error_layer(layer: &Layer) -> String {
    match layer.image {
        Image::BEAUTY => "stderr".into(),
        name => format!("stderr.{name}"),
    }
}
