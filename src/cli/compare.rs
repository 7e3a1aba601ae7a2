//! `radianza compare A.exr B.exr`.

use super::{Failure, args};
use radianza::film::exr::read_exr;
use radianza::film::png::write_rgb8;
use radianza::film::{Comparison, Header, Image, compare, difference_colors};
use std::path::PathBuf;

/// Compare two EXR images.
#[derive(clap::Args, Debug)]
pub(crate) struct Arguments {
    /// The image that is judged
    a: PathBuf,
    /// The image that it is compared with: the reference of relMSE
    b: PathBuf,
    /// Exit with 1 if relMSE = mean((a − b)²/(b² + 0.01)) is larger, or not a number
    #[arg(long, value_name = "X", value_parser = args::finite)]
    max_relmse: Option<f64>,
    /// The layer that is compared
    #[arg(long, value_name = "NAME", default_value = Image::BEAUTY)]
    layer: String,
    /// Write the difference as an image: red where A is brighter, blue where it is darker
    #[arg(long, value_name = "FILE")]
    png: Option<PathBuf>,
}

/// Prints the comparison; fails beyond the limit.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let read = |path: &PathBuf| read_exr(path).map_err(|e| Failure::Image(path.clone(), e));
    let (a, b) = (read(&arguments.a)?, read(&arguments.b)?);
    let comparison = compare(&a, &b, &arguments.layer).map_err(|e| Failure::Usage(e.to_string()))?;
    print(&comparison);
    if same_randomness(&a, &b) {
        println!("note: both images have the same seed; their errors are correlated and z is not valid");
    }
    if let Some(path) = &arguments.png {
        let (pixels, full) = difference_colors(&a, &b, &arguments.layer).map_err(|e| Failure::Usage(e.to_string()))?;
        write_rgb8(path, a.window_size(), &pixels).map_err(|e| Failure::Output(path.clone(), e))?;
        println!("{}: full colour is a relative difference of {:.3} %", path.display(), 100.0 * full);
    }
    // A limit that is not kept fails, and so does an image in which it cannot be claimed.
    let Some(limit) = arguments.max_relmse else { return Ok(()) };
    if comparison.non_finite > 0 {
        let message = format!("{} pixels are not finite; no limit can be claimed", comparison.non_finite);
        return Err(Failure::Comparison(message));
    }
    if comparison.relmse > limit {
        return Err(Failure::Comparison(format!("relMSE {:.6e} is larger than {limit:e}", comparison.relmse)));
    }
    Ok(())
}

fn print(c: &Comparison) {
    let [a, b] = c.mean;
    println!("pixels      {}", c.pixels);
    if c.non_finite > 0 {
        println!("not finite  {} pixels, left out", c.non_finite);
    }
    println!("mean error  {:+.6e}", [0, 1, 2].map(|i| a[i] - b[i]).iter().sum::<f64>() / 3.0);
    println!("RMSE        {:.6e}", c.rmse);
    println!("relMSE      {:.6e}", c.relmse);
    println!("            mean of A     mean of B     bias A − B    relative{}", c.evidence.map_or("", |_| "      z"));
    for (i, name) in ["R", "G", "B"].iter().enumerate() {
        let bias = a[i] - b[i];
        print!("{name}           {:<13.6e} {:<13.6e} {bias:<+13.6e} {:+.4} %", a[i], b[i], 100.0 * bias / b[i]);
        println!("{}", c.evidence.map_or(String::new(), |e| format!("  {:+.2}", e.z[i])));
    }
    match c.evidence {
        Some(evidence) => {
            println!("|z| > 3     {:.3} % of pixel channels", 100.0 * evidence.beyond_three);
            for (name, known) in ["A", "B"].iter().zip(evidence.known) {
                if !known {
                    println!("note: {name} has no standard error; it counts as exact");
                }
            }
        }
        None => println!("note: neither image has a standard error; no z"),
    }
}

/// Both from one sampler with one seed: what they have in common cancels, and their errors are not independent.
fn same_randomness(a: &Image, b: &Image) -> bool {
    let key = |image: &Image| serde_json::from_str::<Header>(&image.header).ok().map(|h| (h.sampler, h.seed));
    key(a).is_some_and(|a| key(b) == Some(a))
}
