//! Film, filters and image files: sums and errors, χ² of every filter, round trips, damaged files.

use glam::Vec3;
use radianza::desc::{Filter, Integrator, SamplerKind, Strategy, Tonemap};
use radianza::film::exr::{ReadError, read_exr, write_exr};
use radianza::film::file::{check_writable, write_atomic};
use radianza::film::png::write_png;
use radianza::film::{
    Accumulator, Display, Film, Header, Image, LayerKind, MergeError, Origin, PixelSample, develop, filter_offset,
    filter_radius,
};
use radianza::spectrum::Spectrum;
use radianza::stats::{Family, Moments};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

const FILTERS: [Filter; 3] = [Filter::Box, Filter::Gaussian, Filter::BlackmanHarris];

fn rng(seed: u128) -> Pcg64Mcg {
    Pcg64Mcg::new(0xcafe_f00d_d15e_a5e5 + 977 * seed)
}

fn sample(rng: &mut Pcg64Mcg) -> PixelSample {
    let rgb: [f32; 3] = [rng.random(), rng.random(), rng.random()];
    let hit = rng.random::<f32>() < 0.75;
    PixelSample {
        radiance: Spectrum::from_rgb(rgb),
        alpha: f32::from(hit),
        albedo: if hit { Spectrum::splat(0.5) } else { Spectrum::ZERO },
        normal: if hit { Vec3::Z } else { Vec3::ZERO },
        depth: if hit { 2.0 } else { 0.0 },
    }
}

/// Adds a sample, and its radiance to some class.
fn add(acc: &mut Accumulator, rng: &mut Pcg64Mcg) {
    let sample = sample(rng);
    let mut transport = [Spectrum::ZERO; 7];
    transport[rng.random_range(0..7)] = sample.radiance;
    acc.add(&sample);
    acc.add_transport(&transport);
}

fn random_film(size: [u32; 2], crop: [u32; 4], replicates: u32, length: u32, transport: bool, seed: u128) -> Film {
    let mut film = Film::new(size, crop, transport);
    let mut rng = rng(seed);
    for [x, y] in film.pixels() {
        for _ in 0..replicates {
            let mut acc = Accumulator::default();
            (0..length).for_each(|_| add(&mut acc, &mut rng));
            film.add_replicate(x, y, &acc);
        }
    }
    film
}

#[test]
fn stderr_is_that_of_replicate_means() {
    let mut rng = rng(1);
    let mut film = Film::new([3, 2], [1, 1, 3, 2], false);
    let mut means = Vec::new();
    for _ in 0..5 {
        let mut acc = Accumulator::default();
        let samples: Vec<PixelSample> = (0..8).map(|_| sample(&mut rng)).collect();
        samples.iter().for_each(|s| acc.add(s));
        means.push(samples.iter().map(|s| f64::from(s.radiance.to_rgb()[1])).sum::<f64>() / 8.0);
        film.add_replicate(2, 1, &acc);
    }
    let mean = means.iter().sum::<f64>() / 5.0;
    let stderr = (means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / 4.0 / 5.0).sqrt();
    assert!((film.mean(2, 1)[1] - mean).abs() < 1e-14);
    assert!((film.stderr(2, 1).unwrap()[1] - stderr).abs() < 1e-12);
    assert_eq!((film.samples(2, 1), film.replicates(2, 1), film.replicate()), (40, 5, 8));
    // One replicate says nothing about its spread, and no sample is no light.
    assert_eq!(film.stderr(1, 1), None);
    assert_eq!(film.mean(1, 1), [0.0; 3]);
    assert!(film.relative_error().is_nan());
}

#[test]
fn stderr_covers_the_truth() {
    // x uniform in [0, 1): with R replicates, t = (mean − 1/2)/stderr has variance (R − 1)/(R − 3).
    let (n, r) = (256u32, 16u32);
    let film = random_film([n, n], [0, 0, n, n], r, 2, false, 2);
    let t2 = |[x, y]: [u32; 2]| ((film.mean(x, y)[0] - 0.5) / film.stderr(x, y).unwrap()[0]).powi(2);
    let mut moments = Moments::default();
    film.pixels().for_each(|pixel| moments.push(t2(pixel)));
    let mut family = Family::new("standard errors");
    family.moments("mean of t²", f64::from(r - 1) / f64::from(r - 3), &moments);
    family.assert();
}

#[test]
fn surface_layers_are_means_of_the_right_samples() {
    let film = random_film([16, 16], [0, 0, 16, 16], 4, 16, true, 3);
    for [x, y] in film.pixels() {
        let alpha = film.alpha(x, y);
        assert!((0.0..=1.0).contains(&alpha));
        assert!((film.albedo(x, y)[2] - 0.5 * alpha).abs() < 1e-14);
        if alpha > 0.0 {
            assert_eq!((film.normal(x, y), film.depth(x, y)), ([0.0, 0.0, 1.0], 2.0));
        }
        // The transport classes sum to the beauty.
        let sum: f64 = (0..7).map(|c| film.class_mean(c, x, y).unwrap()[0]).sum();
        assert!((sum - film.mean(x, y)[0]).abs() < 1e-12);
        assert!(film.class_stderr(6, x, y).is_some() && film.class_mean(7, x, y).is_none());
    }
}

#[test]
fn what_is_no_number_counts_as_nothing_and_is_named() {
    let sound = PixelSample {
        radiance: Spectrum::splat(2.0),
        alpha: 1.0,
        albedo: Spectrum::splat(0.5),
        normal: Vec3::new(0.0, -1.0, 0.0),
        depth: 3.0,
    };
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let all = [
            ("beauty", PixelSample { radiance: Spectrum::from_rgb([1.0, x, 1.0]), ..sound }),
            ("alpha", PixelSample { alpha: x, ..sound }),
            ("albedo", PixelSample { albedo: Spectrum::from_rgb([x, 0.5, 0.5]), ..sound }),
            ("normal", PixelSample { normal: Vec3::new(0.0, 0.0, x), ..sound }),
            ("depth", PixelSample { depth: x, ..sound }),
        ];
        for (name, bad) in all {
            let (mut film, mut acc) = (Film::new([1, 1], [0, 0, 1, 1], false), Accumulator::default());
            assert_eq!(acc.add(&sound), None);
            let invalid = acc.add(&bad).unwrap();
            assert_eq!(invalid.layer, name);
            assert!(invalid.value.iter().any(|v| v.to_bits() == x.to_bits()), "{invalid:?}");
            film.add_replicate(0, 0, &acc);
            let halved = |layer| if name == layer { 0.5 } else { 1.0 };
            assert_eq!(film.mean(0, 0), [2.0 * halved("beauty"); 3]);
            assert_eq!((film.alpha(0, 0), film.albedo(0, 0)), (halved("alpha"), [0.5 * halved("albedo"); 3]));
            assert_eq!((film.depth(0, 0), film.normal(0, 0)), (3.0 * halved("depth"), [0.0, -halved("normal"), 0.0]));
        }
    }
    // Radiance and distance are not negative; normals may be.
    let mut acc = Accumulator::default();
    assert!(acc.add(&PixelSample { radiance: Spectrum::from_rgb([0.0, -1e-9, 0.0]), ..sound }).is_some());
    assert!(acc.add(&PixelSample { depth: -1.0, ..sound }).is_some());
}

#[test]
fn merging_is_addition() {
    // Two shards of one image.
    let all = [0, 0, 6, 5];
    let (a, b) = (random_film([6, 5], all, 3, 4, true, 4), random_film([6, 5], all, 2, 4, true, 5));
    let (mut ab, mut ba) = (a.clone(), b.clone());
    ab.merge(&b).unwrap();
    ba.merge(&a).unwrap();
    assert_eq!(ab, ba);
    assert_eq!(ab.samples(3, 3), 20);
    let expected = (3.0 * a.mean(3, 3)[0] + 2.0 * b.mean(3, 3)[0]) / 5.0;
    assert!((ab.mean(3, 3)[0] - expected).abs() < 1e-14);

    // Tiles of one film give the film.
    let mut tiled = Film::new([6, 5], all, true);
    let mut tile = random_film([6, 5], [2, 1, 5, 3], 3, 4, true, 6);
    tiled.merge(&tile).unwrap();
    assert_eq!(tiled.mean(2, 1), tile.mean(2, 1));
    assert_eq!((tiled.samples(0, 0), tiled.samples(4, 2)), (0, 12));

    // Films of different things do not add up.
    assert_eq!(tile.merge(&a), Err(MergeError::Window(all, [2, 1, 5, 3])));
    assert_eq!(tiled.merge(&random_film([6, 5], all, 2, 8, true, 7)), Err(MergeError::Replicate(4, 8)));
    assert_eq!(tiled.merge(&random_film([6, 5], all, 2, 4, false, 7)), Err(MergeError::Transport));
    assert_eq!(tiled.merge(&random_film([5, 6], [0, 0, 5, 6], 2, 4, true, 7)), Err(MergeError::Size(6, 5, 5, 6)));
}

#[test]
fn filters_are_smooth_and_odd() {
    for filter in FILTERS {
        let axis = |u: f32| filter_offset(filter, [u, 0.5]).x;
        let n = 1 << 16;
        let steps: Vec<f32> = (0..=n).map(|i| axis((i as f32 / n as f32).min(1.0 - f32::EPSILON / 2.0))).collect();
        assert!(steps.is_sorted(), "{filter:?}");
        for i in 1..n {
            assert!((steps[i] + steps[n - i]).abs() < 1e-5, "{filter:?} {i}");
        }
        assert_eq!(axis(0.0), -filter_radius(filter));
    }
}

fn header() -> Header {
    Header {
        at: None,
        variant: None,
        software: "radianza".into(),
        scene: Origin::new("Zürich 🌍", b"scene"),
        environment: None,
        camera: (0, "left".into()),
        size: [7, 5],
        crop: [2, 1, 7, 4],
        samples: [0, 24],
        replicate: 8,
        integrator: Integrator::Path,
        strategy: Strategy::Mis,
        sampler: SamplerKind::Lattice,
        seed: u64::MAX,
        max_depth: Some(8),
        filter: Filter::BlackmanHarris,
        metadata: vec![serde_json::json!({ "dc:creator": "Zürich" })],
        biased: vec!["max depth 8".into()],
        non_finite: 0,
    }
}

fn cropped_image() -> Image {
    let film = random_film([7, 5], [2, 1, 7, 4], 3, 8, true, 20);
    let kinds = [&LayerKind::DEFAULT[..], &[LayerKind::Transport]].concat();
    let mut image = develop(&film, &kinds);
    image.header = header().to_json();
    image
}

#[test]
fn exr_holds_every_layer_and_the_header() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let image = cropped_image();
    let names: Vec<&str> = image.layers.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        [
            "D",
            "DD",
            "DS",
            "S",
            "SD",
            "SS",
            "albedo",
            "beauty",
            "depth",
            "emission",
            "normal",
            "samples",
            "stderr",
            "stderr.D",
            "stderr.DD",
            "stderr.DS",
            "stderr.S",
            "stderr.SD",
            "stderr.SS",
            "stderr.emission"
        ]
    );
    write_exr(&path, &image).unwrap();
    let back = read_exr(&path).unwrap();
    assert_eq!(back, image);
    assert_eq!(serde_json::from_str::<Header>(&back.header).unwrap(), header());
    assert!(back.layers["samples"]["N"].iter().all(|&n| n == 24.0));
}

#[test]
fn equal_images_are_equal_files() {
    let folder = tempfile::tempdir().unwrap();
    let write = |i: usize| {
        let path = folder.path().join(format!("{i}.exr"));
        write_exr(&path, &cropped_image()).unwrap();
        std::fs::read(path).unwrap()
    };
    let first = write(0);
    assert!((1..8).all(|i| write(i) == first));
}

#[test]
fn errors_that_are_not_known_are_left_out() {
    let film = random_film([2, 2], [0, 0, 2, 2], 1, 4, true, 21);
    let image = develop(&film, &[LayerKind::Beauty, LayerKind::Stderr, LayerKind::Transport]);
    assert!(image.layers.contains_key("SD"));
    assert!(image.layers.keys().all(|name| !name.starts_with("stderr")));
    // Without classes in the film there are none in the image.
    let film = random_film([2, 2], [0, 0, 2, 2], 2, 4, false, 22);
    let image = develop(&film, &[LayerKind::Beauty, LayerKind::Stderr, LayerKind::Transport]);
    assert_eq!(image.layers.keys().collect::<Vec<_>>(), ["beauty", "stderr"]);
}

#[test]
fn damaged_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_exr(&path, &cropped_image()).unwrap();
    let whole = std::fs::read(&path).unwrap();

    assert!(matches!(read_exr(&folder.path().join("none.exr")), Err(ReadError::Missing(_))));
    assert!(read_exr(folder.path()).is_err());
    for length in [0, 3, 4, 8, 100, whole.len() / 2, whole.len() - 1] {
        std::fs::write(&path, &whole[..length]).unwrap();
        assert!(matches!(read_exr(&path), Err(ReadError::Invalid(_))), "{length}");
    }
    // Any bit may be wrong: an answer or an error, never a panic.
    let mut rng = rng(30);
    let mut refused = 0;
    for _ in 0..1000 {
        let mut bytes = whole.clone();
        let at = if rng.random() { rng.random_range(0..1500) } else { rng.random_range(0..bytes.len()) };
        bytes[at] ^= 1 << rng.random_range(0..8);
        std::fs::write(&path, &bytes).unwrap();
        refused += usize::from(read_exr(&path).is_err());
    }
    println!("{refused} of 1000 refused");
    assert!(refused > 100);
}

#[test]
fn png_is_opaque_and_repeatable() {
    let folder = tempfile::tempdir().unwrap();
    let image = cropped_image();
    let write = |name: &str| {
        let path = folder.path().join(name);
        write_png(&path, &image, &Display::new(Tonemap::Linear, 0.0)).unwrap();
        std::fs::read(path).unwrap()
    };
    assert_eq!(write("a.png"), write("b.png"));
    let png = image::open(folder.path().join("a.png")).unwrap();
    assert_eq!((png.width(), png.height(), png.color()), (5, 3, image::ColorType::Rgb8));
    let [r, g, b] = image.rgb(Image::BEAUTY).unwrap().map(|c| c[6]);
    assert_eq!(png.to_rgb8().get_pixel(1, 1).0, Display::new(Tonemap::Linear, 0.0).code([r, g, b]));
}

#[test]
fn a_failed_write_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    std::fs::write(&path, "old").unwrap();
    let failed = write_atomic(&path, |file| {
        std::io::Write::write_all(file, b"half of the n")?;
        Err(std::io::Error::other("disk full"))
    });
    assert_eq!(failed.unwrap_err().to_string(), "disk full");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);

    // What cannot be written is known before.
    assert!(check_writable(&path).is_ok());
    assert!(check_writable(&folder.path().join("new/folder/a.exr")).is_ok());
    assert!(check_writable(folder.path()).is_err());
    assert!(check_writable(&path.join("a.exr")).is_err());
}
