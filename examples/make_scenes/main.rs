//! Writes the files that the shipped scenes refer to, from formulas alone: the same bytes on every run.
//!
//! ```text
//! cargo run --example make_scenes [folder]        # default: scenes
//! ```

mod glb;
mod lathe;
mod materials;
mod pavilion;
mod sky;
mod textures;

use std::path::Path;

/// What can go wrong: the disk, or an encoder.
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "scenes".into());
    let folder = Path::new(&folder);
    let textures = folder.join("textures");
    let verify = folder.join("verify").join("textures");
    std::fs::create_dir_all(&textures)?;
    std::fs::create_dir_all(&verify)?;

    textures::planks(256).save(textures.join("planks.png"))?;
    textures::rug(128).save(textures.join("rug.png"))?;
    textures::painting(192, 128).save(textures.join("painting.png"))?;
    textures::plaster_normals(128).save(textures.join("plaster-normals.png"))?;
    textures::scratches(128).save(textures.join("scratches.png"))?;
    std::fs::write(textures.join("sky.hdr"), sky::daylight(256, 128, &sky::Sun::AFTERNOON)?)?;
    std::fs::write(folder.join("pavilion.glb"), pavilion::pavilion()?)?;

    let folder = folder.join("materials");
    std::fs::create_dir_all(&folder)?;
    for (name, file) in materials::all()? {
        std::fs::write(folder.join(name).with_extension("glb"), file)?;
    }

    textures::upper_half().save(verify.join("upper-half.png"))?;
    std::fs::write(verify.join("texel.hdr"), sky::one_texel([32, 16], [21, 5], 1000.0, 0.25)?)?;
    std::fs::write(verify.join("pole.hdr"), sky::one_texel([32, 16], [9, 0], 1000.0, 0.25)?)?;
    Ok(())
}
