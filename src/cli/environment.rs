//! `--env FILE`: light from infinity in place of the scene's own.

use radianza::desc::image_file::{clear_negatives, decode};
use radianza::desc::{self, Environment, Error};
use radianza::film::Origin;
use radianza::glam::Mat3;
use std::path::Path;
use std::sync::Arc;

/// Surrounds the scene with this equirectangular image, upright, its middle towards −z; names it for the header.
pub(super) fn replace(scene: &mut desc::Scene, path: &Path) -> Result<Origin, Error> {
    let bytes = desc::files::read(path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut image = decode(&name, &bytes).map_err(|message| Error::invalid(path, "", message))?;
    let cleared = clear_negatives(&mut image);
    if cleared > 0 {
        scene.notes.push(format!("{name}: {cleared} pixels with negative values were set to 0 there"));
    }
    scene.notes.retain(|note| note != desc::NO_LIGHT);
    scene.environment =
        Some(Environment { radiance: [1.0; 3], image: Some(scene.images.len()), to_world: Mat3::IDENTITY });
    scene.images.push(Arc::new(image));
    Ok(Origin::new(name, &bytes))
}
