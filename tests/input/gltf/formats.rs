//! Images in the formats of KHR_texture_basisu and EXT_texture_webp, and PNG of 16 bits.
//!
//! The files in `images/` hold 8 × 4 pixels: the left half (200, 40, 80, 255), the right half (16, 160, 240, 128); of
//! `two_lossy.webp` without alpha. Encoded by PyPI's alktx2 0.1.7 and Pillow:
//!
//! ```text
//! encode_image_to_ktx2("two.png", "etc1s.ktx2", codec="etc1s", quality=100)
//! encode_image_to_ktx2("two.png", "uastc_zstd.ktx2", codec="uastc", quality=100, mipmaps=True, zstd_supercompression_level=3)
//! encode_image_to_ktx2("two.png", "uastc.ktx2", codec="uastc", quality=100, srgb=False, linear=True)  # then inflated
//! Image.open("two.png").save("two.webp", lossless=True); ….convert("RGB").save("two_lossy.webp", quality=90)
//! ```

use super::document::{Document, noted};
use radianza::desc::image_file::decode;
use radianza::desc::{ErrorKind, Model, Pixels, Scene, Texture, TextureRef};
use radianza::glam::{Vec2, Vec4};
use radianza::texture::Textures;
use serde_json::json;

const ETC1S: &[u8] = include_bytes!("images/etc1s.ktx2");
const UASTC: &[u8] = include_bytes!("images/uastc.ktx2");
const UASTC_ZSTD: &[u8] = include_bytes!("images/uastc_zstd.ktx2");
const WEBP: &[u8] = include_bytes!("images/two.webp");
const WEBP_LOSSY: &[u8] = include_bytes!("images/two_lossy.webp");

const LEFT: [u8; 4] = [200, 40, 80, 255];
const RIGHT: [u8; 4] = [16, 160, 240, 128];

/// A material whose base colour has its image, this file, in an extension of its texture.
fn in_extension(name: &str, file: &[u8]) -> Document {
    let mut d = Document::material(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
    d.texture([1, 1], &[[9, 9, 9, 255]]);
    let view = d.view(file);
    d.set("/images/1", json!({ "bufferView": view }));
    d.set("/textures/0", json!({ "extensions": { name: { "source": 1 } } }));
    d.set("/extensionsUsed", json!([name])).set("/extensionsRequired", json!([name]));
    d
}

fn basis(file: &[u8]) -> Document {
    in_extension("KHR_texture_basisu", file)
}

#[track_caller]
fn assert_two(pixels: &Pixels, tolerance: u8, alpha: bool) {
    let Pixels::Rgba8(pixels) = pixels else { panic!("8 bits expected") };
    assert_eq!(pixels.len(), 32);
    for (i, found) in pixels.iter().enumerate() {
        let mut expected = if i % 8 < 4 { LEFT } else { RIGHT };
        if !alpha {
            expected[3] = 255;
        }
        assert!(found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= tolerance), "{i}: {found:?}, {expected:?}");
    }
}

/// ETC1S has 5 bits of base colour; UASTC holds one colour to the last bits; WebP without loss is exact.
#[test]
fn every_format_decodes_to_its_pixels() {
    for (name, file, tolerance, alpha) in [
        ("ETC1S", ETC1S, 9, true),
        ("UASTC", UASTC, 2, true),
        ("UASTC with Zstandard", UASTC_ZSTD, 2, true),
        ("WebP", WEBP, 0, true),
    ] {
        let image = decode(name, file).unwrap();
        assert_eq!(image.size, [8, 4], "{name}");
        assert_two(&image.pixels, tolerance, alpha);
    }
    // A lossy one blurs chroma over the edge of the halves.
    let Pixels::Rgba8(pixels) = decode("lossy", WEBP_LOSSY).unwrap().pixels else { panic!("8 bits expected") };
    for (i, expected) in [(9, [200, 40, 80, 255]), (14, [16, 160, 240, 255])] {
        assert!(pixels[i].iter().zip(expected).all(|(a, b): (_, u8)| a.abs_diff(b) <= 12), "{:?}", pixels[i]);
    }
}

#[test]
fn the_image_in_the_extension_is_the_texture_s() {
    for (name, file) in [("KHR_texture_basisu", UASTC_ZSTD), ("EXT_texture_webp", WEBP)] {
        let mut d = in_extension(name, file);
        for fallback in [false, true] {
            if fallback {
                d.set("/textures/0/source", json!(0));
            }
            let scene = d.read().unwrap();
            assert_eq!(scene.images.len(), 1, "{name}: {:?}", scene.images);
            assert_two(&scene.images[0].pixels, 2, true);
            assert!(scene.notes.is_empty(), "{name}: {:?}", scene.notes);
            assert!(matches!(scene.textures[..], [Texture::Image { srgb: true, .. }]));
        }
    }
    // Both: the first that the reader prefers.
    let mut d = basis(UASTC_ZSTD);
    d.set("/textures/0/extensions/EXT_texture_webp", json!({ "source": 0 }));
    assert_eq!(d.read().unwrap().images[0].size, [8, 4]);
}

/// Damage in what the extension refers to is an error, fallback or not.
#[test]
fn a_damaged_image_is_no_reason_for_the_fallback() {
    let mut damaged = UASTC_ZSTD.to_vec();
    let level = u64::from_le_bytes(damaged[80..88].try_into().unwrap()) as usize;
    damaged[level] = 0;
    let mut d = basis(&damaged);
    d.set("/textures/0/source", json!(0)).fails("/images/1", "is not a valid KTX2");
    basis(&ETC1S[..200]).set("/textures/0/source", json!(0)).fails("/images/1", "is not a valid KTX2");
}

#[test]
fn broken_references_in_the_extensions() {
    let at = "/textures/0/extensions/KHR_texture_basisu/source";
    let with = |source| {
        let mut d = basis(ETC1S);
        d.set("/textures/0/extensions/KHR_texture_basisu", source);
        d
    };
    with(json!({})).fails(at, "is missing");
    with(json!({ "source": "a" })).fails(at, "is a string; expected the index");
    with(json!({ "source": -1 })).fails(at, "is -1; expected the index");
    with(json!({ "source": 7 })).fails(at, "refers to image 7; the file has 2");
    basis(WEBP).fails("/images/1", "is WebP; expected KTX2");
    in_extension("EXT_texture_webp", ETC1S).fails("/images/1", "is KTX2; expected WebP");

    let mut d = Document::material(json!({ "normalTexture": { "index": 0 } }));
    d.set("/textures", json!([{ "extensions": { "EXT_texture_avif": { "source": 0 } } }]));
    d.fails("/textures/0/source", "has its image in `EXT_texture_avif` alone");
    assert_eq!(d.read().unwrap_err().kind, ErrorKind::Unsupported);
    d.set("/textures/0", json!({})).fails("/textures/0/source", "has no source");
}

/// The use decides whether codes are sRGB; a file that says otherwise is noted.
#[test]
fn the_use_decides_over_what_the_file_says() {
    let said = |file, slot: &str| {
        let mut d = basis(file);
        d.set("/materials/0", json!({})).set(slot, json!({ "index": 0 }));
        let scene = d.read().unwrap();
        let [Texture::Image { srgb, .. }] = scene.textures[..] else { panic!() };
        (srgb, noted(&scene, "by their use"))
    };
    let (color, normal) = ("/materials/0/pbrMetallicRoughness/baseColorTexture", "/materials/0/normalTexture");
    assert_eq!(said(ETC1S, color), (true, false));
    assert_eq!(said(ETC1S, normal), (false, true));
    assert_eq!(said(UASTC, color), (true, true));
    assert_eq!(said(UASTC, normal), (false, false));
}

/// Fields of the header of 80 bytes, and of the level index behind it.
#[test]
fn what_the_extension_does_not_allow_is_refused() {
    let with = |file: &[u8], at: usize, value: u32| {
        let mut file = file.to_vec();
        file[at..at + 4].copy_from_slice(&value.to_le_bytes());
        file
    };
    let model = {
        let dfd = u32::from_le_bytes(UASTC[48..52].try_into().unwrap()) as usize;
        dfd + 12
    };
    for (what, file, message) in [
        ("a volume", with(UASTC, 28, 4), "a depth (4)"),
        ("an array", with(UASTC, 32, 3), "array layers beside the first (2)"),
        ("a cube", with(UASTC, 36, 6), "faces beside the first (5)"),
        ("no height", with(UASTC, 24, 0), "8 × 0 pixels"),
        ("huge", with(UASTC, 20, 1 << 20), "at most 65536 a side"),
        ("large", with(&with(UASTC, 20, 65_536), 24, 65_536), "would take more than"),
        ("another size", with(UASTC, 20, 32), "32 bytes are stored for 32 × 4 pixels; expected 128"),
        ("a claim of Zstandard", with(UASTC_ZSTD, 96, u32::MAX), "bytes are stored for 8 × 4 pixels; expected 32"),
        ("plain RGBA", with(UASTC, 12, 37), "holds R8G8B8A8_UNORM; expected Basis Universal"),
        ("ZLIB", with(UASTC, 44, 3), "expected Basis Universal"),
        ("another model", with(UASTC, model, 1), "expected Basis Universal"),
        ("a level beyond the file", with(UASTC, 80, u32::MAX), "end of buffer"),
        ("global data beyond the file", with(ETC1S, 64, u32::MAX - 10), "end of buffer"),
    ] {
        let error = decode("a", &file).expect_err(what);
        assert!(error.contains(message), "{what}: {error}; expected {message:?}");
    }
    let premultiplied = {
        let mut file = UASTC.to_vec();
        file[model + 3] |= 1;
        file
    };
    assert!(decode("a", &premultiplied).unwrap_err().contains("multiplied by alpha"));
}

/// No prefix and no changed byte makes the decoders do worse than fail.
#[test]
fn mutated_files_fail_or_decode() {
    for file in [ETC1S, UASTC, UASTC_ZSTD, WEBP, WEBP_LOSSY] {
        for i in 0..file.len() {
            let _ = decode("a", &file[..i]);
            for value in [0, 1, 0x7f, 0xff] {
                let mut file = file.to_vec();
                file[i] = value;
                let _ = decode("a", &file);
            }
        }
    }
}

/// The second byte of a code counts: 16-bit colours, in one step of 8-bit sRGB, are told apart.
#[test]
fn sixteen_bits_are_kept() {
    let mut file = std::io::Cursor::new(Vec::new());
    let pixels = vec![0x8000_u16, 0x8040, 0x0101, 0xffff];
    image::ImageBuffer::<image::Rgba<u16>, _>::from_raw(1, 1, pixels.clone())
        .unwrap()
        .write_to(&mut file, image::ImageFormat::Png)
        .unwrap();
    let mut d = Document::material(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
    d.texture([1, 1], &[LEFT]);
    let view = d.view(&file.into_inner());
    d.set("/images/0", json!({ "bufferView": view }));
    let scene = d.read().unwrap();
    assert_eq!(scene.images[0].pixels, Pixels::Rgba16(vec![pixels.try_into().unwrap()]));

    // IEC 61966-2-1 in f64, at the code over 65,535.
    let curve = |code: u16| {
        let x = f64::from(code) / 65_535.0;
        (if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }) as f32
    };
    let found = lookup(&scene);
    let expected = Vec4::new(curve(0x8000), curve(0x8040), curve(0x0101), 1.0);
    assert!(found.abs_diff_eq(expected, 1e-7) && found.y > found.x, "{found}, {expected}");
}

fn lookup(scene: &Scene) -> Vec4 {
    let Model::MetallicRoughness(m) = &scene.materials[0].model else { panic!() };
    let texture: TextureRef = m.base_color.texture.unwrap();
    Textures::new(scene).lookup(&texture, &[Vec2::splat(0.5); 2])
}
