//! Image files.

use radianza::desc::image_file::{clear_negatives, decode};
use radianza::desc::{Image, Pixels};
use std::io::Cursor;

fn png(image: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image.into().write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
}

fn rgba8(image: &Image) -> &[[u8; 4]] {
    match &image.pixels {
        Pixels::Rgba8(pixels) => pixels,
        _ => panic!("{} should have 8 bits", image.name),
    }
}

fn float(image: &Image) -> &[[f32; 4]] {
    match &image.pixels {
        Pixels::Rgba32F(pixels) => pixels,
        _ => panic!("{} should be float", image.name),
    }
}

/// An EXR of these channels, of one layer, stored as `compression`.
fn exr(
    size: (usize, usize),
    channels: Vec<(&str, exr::image::FlatSamples)>,
    compression: exr::compression::Compression,
) -> Vec<u8> {
    use exr::prelude::*;
    let list = channels.into_iter().map(|(name, data)| AnyChannel::new(name, data)).collect();
    let encoding = Encoding { compression, ..Encoding::FAST_LOSSLESS };
    let layer = Layer::new(size, LayerAttributes::named("layer"), encoding, AnyChannels::sort(list));
    let mut out = Cursor::new(Vec::new());
    exr::image::Image::from_layer(layer).write().to_buffered(&mut out).unwrap();
    out.into_inner()
}

#[test]
fn png_of_every_color_type() {
    let rgba = image::RgbaImage::from_fn(2, 1, |x, _| image::Rgba([10 + x as u8, 20, 30, 40]));
    let image = decode("a", &png(rgba)).unwrap();
    assert_eq!((image.size, rgba8(&image)), ([2, 1], &[[10, 20, 30, 40], [11, 20, 30, 40]][..]));
    let grey = image::GrayImage::from_pixel(1, 1, image::Luma([7]));
    assert_eq!(rgba8(&decode("a", &png(grey)).unwrap()), [[7, 7, 7, 255]]);
    let grey_alpha = image::GrayAlphaImage::from_pixel(1, 1, image::LumaA([7, 9]));
    assert_eq!(rgba8(&decode("a", &png(grey_alpha)).unwrap()), [[7, 7, 7, 9]]);
    let deep = image::ImageBuffer::from_pixel(1, 1, image::Rgba([0u16, 65_535, 0x8080, 257]));
    assert_eq!(decode("a", &png(deep)).unwrap().pixels, Pixels::Rgba16(vec![[0, 65_535, 0x8080, 257]]));
    let deep_grey = image::ImageBuffer::from_pixel(1, 1, image::Luma([1000u16]));
    assert_eq!(decode("a", &png(deep_grey)).unwrap().pixels, Pixels::Rgba16(vec![[1000, 1000, 1000, 65_535]]));
}

#[test]
fn palette_png() {
    // 1 × 1, one bit, palette of two colours, drawn with the second.
    let chunk = |name: &[u8; 4], data: &[u8]| {
        let body = [&name[..], data].concat();
        let mut crc = !0u32;
        for byte in &body {
            crc ^= u32::from(*byte);
            for _ in 0..8 {
                crc = if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
            }
        }
        [&(data.len() as u32).to_be_bytes()[..], &body, &(!crc).to_be_bytes()].concat()
    };
    let header = [0, 0, 0, 1, 0, 0, 0, 1, 1, 3, 0, 0, 0];
    // Stored deflate block of a filter byte and the bits 1000_0000.
    let data = [0x78, 0x01, 1, 2, 0, 0xfd, 0xff, 0, 0x80, 0, 0x82, 0, 0x81];
    let file = [
        b"\x89PNG\r\n\x1a\n".to_vec(),
        chunk(b"IHDR", &header),
        chunk(b"PLTE", &[1, 2, 3, 200, 100, 50]),
        chunk(b"IDAT", &data),
        chunk(b"IEND", &[]),
    ];
    assert_eq!(rgba8(&decode("a", &file.concat()).unwrap()), [[200, 100, 50, 255]]);
}

#[test]
fn jpeg_keeps_a_flat_color() {
    let mut out = Cursor::new(Vec::new());
    image::RgbImage::from_pixel(16, 8, image::Rgb([200, 100, 50]))
        .write_to(&mut out, image::ImageFormat::Jpeg)
        .unwrap();
    let image = decode("a", &out.into_inner()).unwrap();
    assert_eq!(image.size, [16, 8]);
    for pixel in rgba8(&image) {
        assert!(pixel.iter().zip([200, 100, 50, 255]).all(|(a, b)| a.abs_diff(b) <= 4), "{pixel:?}");
    }
}

#[test]
fn radiance_hdr_divides_by_exposure() {
    // Mantissa 128, exponent 129: 128 · 2^(129 − 136) = 1.
    let file = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 1 +X 1\n\x80\x40\x20\x81";
    assert_eq!(float(&decode("a", file).unwrap()), [[0.5, 0.25, 0.125, 1.0]]);
}

#[test]
fn exr_of_every_sample_type_and_compression() {
    use exr::compression::Compression;
    use exr::prelude::{FlatSamples, f16};
    let f = |x: f32| FlatSamples::F32(vec![x; 6]);
    let lossless =
        [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ];
    for compression in lossless {
        let file = exr((3, 2), vec![("R", f(1.5)), ("G", f(-2.0)), ("B", f(0.25))], compression);
        let image = decode("a", &file).unwrap();
        assert_eq!((image.size, float(&image)), ([3, 2], &[[1.5, -2.0, 0.25, 1.0]; 6][..]), "{compression}");
    }
    for compression in
        [Compression::DWAA(Some(45.0)), Compression::DWAB(Some(45.0)), Compression::B44, Compression::PXR24]
    {
        let h = |x: f32| FlatSamples::F16(vec![f16::from_f32(x); 6]);
        let file = exr((3, 2), vec![("R", h(0.5)), ("G", h(2.0)), ("B", h(8.0))], compression);
        for pixel in float(&decode("a", &file).unwrap()) {
            for (got, expected) in pixel.iter().zip([0.5, 2.0, 8.0, 1.0]) {
                assert!((got - expected).abs() < 0.02 * expected, "{compression}: {pixel:?}");
            }
        }
    }
}

#[test]
fn exr_channels() {
    use exr::compression::Compression::ZIP16;
    use exr::prelude::FlatSamples;
    let f = |x: f32| FlatSamples::F32(vec![x]);
    let read = |channels| decode("a", &exr((1, 1), channels, ZIP16));
    assert_eq!(float(&read(vec![("Y", f(3.0))]).unwrap()), [[3.0, 3.0, 3.0, 1.0]]);
    let premultiplied = vec![("R", f(0.25)), ("G", f(0.5)), ("B", f(0.0)), ("A", f(0.5))];
    assert_eq!(float(&read(premultiplied).unwrap()), [[0.5, 1.0, 0.0, 0.5]]);
    let layered = vec![("sky.R", f(1.0)), ("sky.G", f(2.0)), ("sky.B", f(3.0)), ("Z", f(9.0))];
    assert_eq!(float(&read(layered).unwrap()), [[1.0, 2.0, 3.0, 1.0]]);
    let error = read(vec![("Z", f(1.0))]).unwrap_err();
    assert!(error.contains("channels are Z; expected R, G and B, or Y"), "{error}");
    let error = read(vec![("Y", f(f32::NAN))]).unwrap_err();
    assert!(error.contains("pixel (0, 0)") && error.contains("NaN"), "{error}");
}

#[test]
fn negative_values_are_cleared_and_counted() {
    let mut image =
        Image { name: String::new(), size: [2, 1], pixels: Pixels::Rgba32F(vec![[-1.0, 2.0, 0.0, 1.0], [1.0; 4]]) };
    assert_eq!(clear_negatives(&mut image), 1);
    assert_eq!(float(&image), [[0.0, 2.0, 0.0, 1.0], [1.0; 4]]);
}

#[test]
fn wrong_files_are_named() {
    for (bytes, expected) in [
        (&b""[..], "is empty"),
        (b"RIFF\0\0\0\0WEBPVP8 ", "is not a valid WebP"),
        (b"\xabKTX 11\xbb\r\n\x1a\n", "is KTX of the first version; expected PNG, JPEG, WebP, KTX2"),
        (b"\xabKTX 20\xbb\r\n\x1a\n", "is not a valid KTX2"),
        (b"hello", "unknown format"),
        (b"\x89PNG\r\n\x1a\n", "is not a valid PNG"),
        (b"\xff\xd8\xff\xe0", "is not a valid JPEG"),
        (b"\x76\x2f\x31\x01\x02\0\0\0", "is not a valid OpenEXR"),
        (b"#?RADIANCE\n\n-Y 1000000 +X 1000000\n", "1000000 × 1000000 pixels; expected at most 65536 a side"),
        (b"#?RADIANCE\n\n-Y 65000 +X 65000\n", "would take more than 2048 MiB"),
        (b"#?RADIANCE\n\n-Y 0 +X 7\n", "expected at least one"),
    ] {
        let error = decode("a", bytes).unwrap_err();
        assert!(error.contains(expected), "{error:?} should say {expected:?}");
    }
}

/// Every prefix, and every file with one byte changed, is decoded or refused.
#[test]
fn damaged_files_never_panic() {
    use exr::compression::Compression;
    use exr::prelude::FlatSamples;
    let f = |n: usize| FlatSamples::F32((0..n).map(|i| i as f32).collect());
    let noise = image::RgbImage::from_fn(9, 7, |x, y| image::Rgb([(x * 31) as u8, (y * 57) as u8, (x * y) as u8]));
    let mut jpeg = Cursor::new(Vec::new());
    noise.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
    let mut files = vec![png(noise), jpeg.into_inner()];
    for compression in [Compression::ZIP16, Compression::PIZ, Compression::DWAB(None), Compression::RLE] {
        files.push(exr((9, 7), vec![("R", f(63)), ("G", f(63)), ("B", f(63))], compression));
    }
    for file in files {
        for i in 0..file.len() {
            let _ = decode("a", &file[..i]);
            let mut changed = file.clone();
            changed[i] ^= 1 << (i % 8);
            let _ = decode("a", &changed);
        }
    }
}

#[test]
fn assets_decode() {
    let Some(folder) = super::assets("hdr") else { return };
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let mut image =
            decode("a", &std::fs::read(&path).unwrap()).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let negative = clear_negatives(&mut image);
        let mean = float(&image).iter().map(|p| f64::from(p[1])).sum::<f64>() / float(&image).len() as f64;
        println!("{}: {:?}, mean green {mean:.4}, {negative} pixels were negative", path.display(), image.size);
        assert_eq!(image.size[0], 2 * image.size[1], "an environment covers 360° × 180°");
        assert!(mean > 0.0);
        seen += 1;
    }
    assert!(seen > 0);
}

/// `cargo test --test input -- --ignored seeds`.
#[test]
#[ignore = "writes tests/fuzz/corpus/image"]
fn seeds_of_the_fuzzer() {
    use exr::compression::Compression;
    use exr::prelude::{FlatSamples, f16};
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus/image");
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).unwrap();
    let noise = image::RgbImage::from_fn(9, 7, |x, y| image::Rgb([(x * 31) as u8, (y * 57) as u8, (x * y) as u8]));
    let mut jpeg = Cursor::new(Vec::new());
    noise.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
    write("a.jpg", &jpeg.into_inner());
    write("a.png", &png(noise));
    write(
        "deep.png",
        &png(image::ImageBuffer::from_fn(3, 2, |x, y| image::Rgba([x as u16 * 999, 7, 65_535, y as u16]))),
    );
    write("a.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 1 +X 1\n\x80\x40\x20\x81");
    let h = |x: f32| FlatSamples::F16(vec![f16::from_f32(x); 12]);
    for (name, compression) in
        [("zip.exr", Compression::ZIP16), ("piz.exr", Compression::PIZ), ("dwaa.exr", Compression::DWAA(Some(45.0)))]
    {
        write(name, &exr((4, 3), vec![("R", h(0.5)), ("G", h(2.0)), ("B", h(8.0)), ("A", h(0.5))], compression));
    }
    for name in ["etc1s.ktx2", "uastc.ktx2", "uastc_zstd.ktx2", "two.webp", "two_lossy.webp"] {
        let from = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gltf/images").join(name);
        write(name, &std::fs::read(from).unwrap());
    }
}
