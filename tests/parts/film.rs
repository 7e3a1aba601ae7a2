//! Film, filters and image files: sums and errors, χ² of every filter, round trips, damaged files.

use glam::Vec3;
use radianza::desc::{Filter, Integrator, SamplerKind, Strategy, Tonemap};
use radianza::film::exr::{ReadError, read_exr, write_exr};
use radianza::film::file::{check_writable, write_atomic};
use radianza::film::png::write_png;
use radianza::film::{
    ByClass, Display, Film, GROUPS, Group, Header, Image, Invalid, Kind, Layers, MergeError, Origin, PixelSample,
    Replicate, Splats, StateError, TRANSPORT, develop, filter_density, filter_offset, filter_radius,
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

const NO_CLASS: ByClass = [Spectrum::ZERO; 7];

/// Adds a sample, and its radiance to some class.
fn add(sums: &mut Replicate, pixel: [u32; 2], rng: &mut Pcg64Mcg) {
    let sample = sample(rng);
    let mut classes = NO_CLASS;
    classes[rng.random_range(0..7)] = sample.radiance;
    assert_eq!(sums.pixel(pixel).add(&sample, &classes), None);
}

fn random_film(size: [u32; 2], crop: [u32; 4], replicates: u32, length: u32, transport: bool, seed: u128) -> Film {
    let mut film = Film::new(size, crop, &Layers::held(transport));
    let mut rng = rng(seed);
    for [x, y] in film.pixels() {
        for _ in 0..replicates {
            let mut sums = Replicate::new(film.layers(), [x, y, x + 1, y + 1]);
            (0..length).for_each(|_| add(&mut sums, [x, y], &mut rng));
            film.add(&sums);
        }
    }
    film
}

#[test]
fn stderr_is_that_of_replicate_means() {
    let mut rng = rng(1);
    let mut film = Film::new([3, 2], [1, 1, 3, 2], &Layers::held(false));
    let mut means = Vec::new();
    for _ in 0..5 {
        let mut sums = Replicate::new(film.layers(), [2, 1, 3, 2]);
        let samples: Vec<PixelSample> = (0..8).map(|_| sample(&mut rng)).collect();
        samples.iter().for_each(|s| assert_eq!(sums.pixel([2, 1]).add(s, &NO_CLASS), None));
        means.push(samples.iter().map(|s| f64::from(s.radiance.to_rgb()[1])).sum::<f64>() / 8.0);
        film.add(&sums);
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
        let value = |layer| film.value(layer, x, y).unwrap();
        let [alpha, ..] = value("alpha");
        assert!((0.0..=1.0).contains(&alpha));
        assert!((value("albedo")[2] - 0.5 * alpha).abs() < 1e-14);
        if alpha > 0.0 {
            assert_eq!((value("normal"), value("depth")[0]), ([0.0, 0.0, 1.0], 2.0));
        }
        assert_eq!(value("samples")[0], 64.0);
        assert_eq!((film.value("unheard of", x, y), film.error("albedo", x, y)), (None, None));
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
    let pixel = [0, 0];
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let all = [
            ("radiance", PixelSample { radiance: Spectrum::from_rgb([1.0, x, 1.0]), ..sound }),
            ("alpha", PixelSample { alpha: x, ..sound }),
            ("albedo", PixelSample { albedo: Spectrum::from_rgb([x, 0.5, 0.5]), ..sound }),
            ("normal", PixelSample { normal: Vec3::new(0.0, 0.0, x), ..sound }),
            ("depth", PixelSample { depth: x, ..sound }),
        ];
        for (name, bad) in all {
            let mut film = Film::new([1, 1], [0, 0, 1, 1], &Layers::held(true));
            let mut sums = Replicate::new(film.layers(), film.crop());
            let classes = [Spectrum::splat(2.0 / 7.0); 7];
            assert_eq!(sums.pixel(pixel).add(&sound, &classes), None);
            let Invalid { layer, value } = sums.pixel(pixel).add(&bad, &classes).unwrap();
            assert_eq!(layer, name);
            assert!(value.iter().any(|v| v.to_bits() == x.to_bits()), "{value:?}");
            film.add(&sums);
            let halved = |layer| if name == layer { 0.5 } else { 1.0 };
            let value = |layer| film.value(layer, 0, 0).unwrap();
            assert_eq!(value("radiance"), [2.0 * halved("radiance"); 3]);
            assert_eq!((value("alpha")[0], value("albedo")), (halved("alpha"), [0.5 * halved("albedo"); 3]));
            assert_eq!((value("depth")[0], value("normal")), (3.0 * halved("depth"), [0.0, -halved("normal"), 0.0]));
            // Radiance that does not count is in no class.
            let sum: f64 = (0..7).map(|class| film.class_mean(class, 0, 0).unwrap()[1]).sum();
            assert!((sum - 2.0 * halved("radiance")).abs() < 1e-6);
        }
    }
    // Radiance and distance are not negative; normals may be.
    let mut sums = Replicate::new(&Layers::held(false), [0, 0, 1, 1]);
    let negative = PixelSample { radiance: Spectrum::from_rgb([0.0, -1e-9, 0.0]), ..sound };
    assert!(sums.pixel(pixel).add(&negative, &NO_CLASS).is_some());
    assert!(sums.pixel(pixel).add(&PixelSample { depth: -1.0, ..sound }, &NO_CLASS).is_some());
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
    let mut tiled = Film::new([6, 5], all, &Layers::held(true));
    let mut tile = random_film([6, 5], [2, 1, 5, 3], 3, 4, true, 6);
    tiled.merge(&tile).unwrap();
    assert_eq!(tiled.mean(2, 1), tile.mean(2, 1));
    assert_eq!((tiled.samples(0, 0), tiled.samples(4, 2)), (0, 12));

    // Films of different things do not add up.
    assert_eq!(tile.merge(&a), Err(MergeError::Window(all, [2, 1, 5, 3])));
    assert_eq!(tiled.merge(&random_film([6, 5], all, 2, 8, true, 7)), Err(MergeError::Replicate(4, 8)));
    assert_eq!(tiled.merge(&random_film([6, 5], all, 2, 4, false, 7)), Err(MergeError::Layers));
    assert_eq!(tiled.merge(&random_film([5, 6], [0, 0, 5, 6], 2, 4, true, 7)), Err(MergeError::Size(6, 5, 5, 6)));
}

#[test]
fn a_film_comes_back_from_its_bytes() {
    for transport in [false, true] {
        let film = random_film([7, 5], [2, 1, 7, 4], 3, 8, transport, 40);
        let mut bytes = Vec::new();
        film.write_to(&mut bytes).unwrap();
        let read = |bytes: &[u8]| Film::read_from(bytes, bytes.len() as u64);
        let mut back = read(&bytes).unwrap();
        assert_eq!(back, film);
        // It goes on where it was.
        let (mut twice, more) = (film.clone(), random_film([7, 5], [2, 1, 7, 4], 2, 8, transport, 41));
        twice.merge(&more).unwrap();
        back.merge(&more).unwrap();
        assert_eq!(back, twice);

        // What is cut off, longer, of another version or of another kind is refused.
        for length in [0, 3, 8, 12, 44, 60, bytes.len() / 2, bytes.len() - 1] {
            assert!(read(&bytes[..length]).is_err(), "{length}");
        }
        assert!(read(&[&bytes[..], &[0]].concat()).is_err());
        let changed = |at: usize, to: u8| {
            let mut bytes = bytes.clone();
            bytes[at] = to;
            read(&bytes)
        };
        assert!(matches!(changed(0, 0), Err(StateError::Magic)));
        assert!(matches!(changed(8, 2), Err(StateError::Version(2))));
        // Any bit may be wrong: the hash tells.
        let mut rng = rng(42);
        for _ in 0..500 {
            let at = rng.random_range(0..bytes.len());
            assert!(changed(at, bytes[at] ^ 1 << rng.random_range(0..8)).is_err(), "{at}");
        }
    }
    // A header of a few bytes that promises 2^60 pixels allocates none of them.
    let mut bytes = b"RADIFILM".to_vec();
    [1u32, 1 << 30, 1 << 30, 0, 0, 1 << 30, 1 << 30, 4, 0].iter().for_each(|n| bytes.extend(n.to_le_bytes()));
    for length in [bytes.len() as u64, u64::MAX, 12 << 60] {
        assert!(matches!(Film::read_from(&bytes[..], length), Err(StateError::Invalid(_))));
    }
}

#[test]
fn splats_are_the_same_bits_in_any_order() {
    let crop = [1, 2, 9, 8];
    for filter in FILTERS {
        let film = Film::new([12, 10], crop, &Layers::held(true));
        let mut rng = rng(50);
        let paths: Vec<([f32; 2], f32, usize)> = (0..4000)
            .map(|_| {
                let at = [rng.random_range(-1.0..13.0), rng.random_range(-1.0..11.0)];
                (at, 10f32.powi(rng.random_range(-8..8)) * rng.random::<f32>(), rng.random_range(0..7))
            })
            .collect();
        let one = |splats: &Splats, (at, x, class): ([f32; 2], f32, usize)| {
            let radiance = Spectrum::from_rgb([x, 2.0 * x, 0.5 * x]);
            let mut classes = NO_CLASS;
            classes[class] = radiance;
            assert_eq!(splats.add(filter, at.into(), radiance, &classes), None);
        };
        let ended = |splats: &Splats| {
            let mut film = film.clone();
            let mut sums = Replicate::new(film.layers(), crop);
            for pixel in film.pixels() {
                sums.pixel(pixel).add(&PixelSample { radiance: Spectrum::ONE, ..PixelSample::default() }, &NO_CLASS);
            }
            sums.add_splats(splats);
            film.add(&sums);
            film
        };
        let straight = Splats::new(&film);
        paths.iter().for_each(|&path| one(&straight, path));
        let mixed = Splats::new(&film);
        std::thread::scope(|scope| {
            for part in paths.chunks(1000) {
                let (mixed, one) = (&mixed, &one);
                scope.spawn(move || part.iter().rev().for_each(|&path| one(mixed, path)));
            }
        });
        let film = ended(&straight);
        assert_eq!(film, ended(&mixed), "{filter:?}");
        // Splats are added to what the pixel's own paths brought, and are split as that is.
        for [x, y] in film.pixels() {
            let classes: f64 = (0..7).map(|class| film.class_mean(class, x, y).unwrap()[1]).sum();
            let all = film.mean(x, y)[1];
            assert!((1.0 + classes - all).abs() <= 1e-6 * all, "{x} {y}: {classes} {all}");
        }
    }
}

#[test]
fn a_splat_reaches_the_pixels_whose_filter_reaches_it() {
    let film = Film::new([12, 10], [1, 2, 9, 8], &Layers::held(false));
    let shares = |filter, at: [f32; 2]| {
        let splats = Splats::new(&film);
        assert_eq!(splats.add(filter, at.into(), Spectrum::ONE, &NO_CLASS), None);
        let mut sums = Replicate::new(film.layers(), film.crop());
        film.pixels().for_each(|pixel| assert_eq!(sums.pixel(pixel).add(&PixelSample::default(), &NO_CLASS), None));
        sums.add_splats(&splats);
        let mut film = film.clone();
        film.add(&sums);
        film.pixels().map(|[x, y]| ([x, y], film.mean(x, y)[0])).filter(|(_, s)| *s > 0.0).collect::<Vec<_>>()
    };
    // The box: the pixel that holds the point, at its borders too; outside the window none.
    for (at, pixel) in [([3.2, 4.9], [3, 4]), ([3.0, 4.0], [3, 4]), ([1.0, 2.0], [1, 2]), ([8.999, 7.999], [8, 7])] {
        assert_eq!(shares(Filter::Box, at), [(pixel, 1.0)], "{at:?}");
    }
    for at in [[0.99, 4.0], [9.0, 4.0], [4.0, 1.9], [4.0, 8.0], [-1e9, 1e9], [1e30, 4.0]] {
        assert_eq!(shares(Filter::Box, at), [], "{at:?}");
    }
    // Wider filters: as dense as their samples.
    for filter in FILTERS {
        for at in [[4.3, 5.1], [1.2, 2.0], [10.1, 4.4]] {
            let expected: Vec<_> = film
                .pixels()
                .map(|[x, y]| {
                    let offset = glam::Vec2::new(at[0] - x as f32 - 0.5, at[1] - y as f32 - 0.5);
                    ([x, y], f64::from(filter_density(filter, offset) as f32))
                })
                .filter(|(_, share)| *share > 0.0)
                .collect();
            assert_eq!(shares(filter, at), expected, "{filter:?} {at:?}");
        }
    }
    let splats = Splats::new(&film);
    for (at, x) in [([f32::NAN, 4.0], 1.0), ([4.0, 4.0], f32::NAN), ([4.0, 4.0], -1.0), ([4.0, 4.0], f32::INFINITY)] {
        assert!(splats.add(Filter::Box, at.into(), Spectrum::splat(x), &NO_CLASS).is_some());
    }
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
    let mut image = develop(&film, &GROUPS.iter().collect::<Vec<_>>());
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

fn groups<const N: usize>(names: [&str; N]) -> [&'static Group; N] {
    names.map(|name| Group::named(name).unwrap())
}

#[test]
fn the_list_of_layers_is_what_the_readme_says() {
    let readme = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let table = readme.split("| layer | channels | |").nth(1).unwrap().split("\n\n").next().unwrap();
    let rows: Vec<Vec<&str>> = table.lines().skip(2).map(|row| row.split('|').map(str::trim).collect()).collect();
    let names: Vec<&str> = rows.iter().map(|row| row[1].trim_matches('`')).collect();
    assert_eq!(names, GROUPS.iter().map(|group| group.name).collect::<Vec<_>>());
    for (group, row) in GROUPS.iter().zip(&rows) {
        for layer in group.layers {
            let first = layer.channels[0];
            let said = match layer.image {
                Image::BEAUTY => row[2].trim_matches('`').split(' ').any(|channel| channel == first),
                image => row[2].contains(&format!("`{image}.{first}")) || row[2].contains(&format!("`{image}`")),
            };
            assert!(said, "{}: {}", layer.name, row[2]);
        }
        assert_eq!(group.always, group.name != TRANSPORT);
    }
    // Names are unique, and estimates alone have errors.
    let mut names: Vec<&str> = Layers::held(true).iter().map(|layer| layer.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
    let film = random_film([1, 1], [0, 0, 1, 1], 2, 1, true, 9);
    for layer in film.layers().iter() {
        assert_eq!(film.error(layer.name, 0, 0).is_some(), layer.kind == Kind::Estimate, "{}", layer.name);
    }
}

#[test]
fn errors_that_are_not_known_are_left_out() {
    let film = random_film([2, 2], [0, 0, 2, 2], 1, 4, true, 21);
    let image = develop(&film, &groups(["beauty", "stderr", "transport"]));
    assert!(image.layers.contains_key("SD"));
    assert!(image.layers.keys().all(|name| !name.starts_with("stderr")));
    // Without classes in the film there are none in the image.
    let film = random_film([2, 2], [0, 0, 2, 2], 2, 4, false, 22);
    let image = develop(&film, &groups(["beauty", "stderr", "transport"]));
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
