//! A film as bytes, exactly: what checkpoints and shards are made of.
//!
//! ```text
//! "RADIFILM", version                                                     8 bytes, u32
//! width, height, x0, y0, x1, y1, samples of a replicate, layers           u32 each
//! of each layer: length of its name, the name                             u8, UTF-8
//! of each pixel: replicates (u32), samples that met a surface (u64)
//! of each pixel and channel: Σ S (f64); of each pixel and channel of an estimate: Σ S² (f64)
//! SHA-256 of all of it
//! ```
//!
//! Numbers are little-endian. The splats of a replicate that has not ended are no part of it: a film is kept between replicates.

use super::layer::{Layer, layer};
use super::{Film, Layers};
use sha2::{Digest, Sha256};
use std::io::{self, Read, Write};

const MAGIC: &[u8; 8] = b"RADIFILM";
const VERSION: u32 = 1;

/// Length of the hash at the end.
const HASH: usize = 32;

/// Bytes that are written or read at once.
const BLOCK: usize = 1 << 16;

/// Why bytes are no film.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// They could not be read, or end too early.
    #[error("cannot be read: {0}")]
    Read(#[from] io::Error),
    /// They are something else.
    #[error("is not a film that was kept")]
    Magic,
    /// They were written by another version.
    #[error("is a film of version {0}; this program reads version {VERSION}")]
    Version(u32),
    /// They contradict themselves, or are damaged.
    #[error("is not a sound film: {0}")]
    Invalid(String),
}

impl Film {
    /// Writes all sums, bit for bit. Equal films give equal bytes.
    pub fn write_to(&self, out: impl Write) -> io::Result<()> {
        let mut out = Hashed { inner: out, hash: Sha256::new() };
        let layers: Vec<&Layer> = self.layers.iter().collect();
        let ([width, height], [x0, y0, x1, y1]) = (self.size, self.crop);
        let header = [VERSION, width, height, x0, y0, x1, y1, self.replicate, layers.len() as u32];
        out.write_all(MAGIC)?;
        header.iter().try_for_each(|n| out.write_all(&n.to_le_bytes()))?;
        for layer in layers {
            // Names are short, as the list of layers has them.
            out.write_all(&[layer.name.len() as u8])?;
            out.write_all(layer.name.as_bytes())?;
        }
        write(&mut out, &self.replicates, |n| n.to_le_bytes())?;
        write(&mut out, &self.met, |n| n.to_le_bytes())?;
        write(&mut out, &self.sums, |x| x.to_le_bytes())?;
        write(&mut out, &self.squares, |x| x.to_le_bytes())?;
        let Hashed { mut inner, hash } = out;
        inner.write_all(&hash.finalize())?;
        inner.flush()
    }

    /// Reads what [`Self::write_to`] wrote. `length` is how many bytes there are: a header that promises more or fewer is
    /// refused before anything is allocated for its pixels.
    pub fn read_from(input: impl Read, length: u64) -> Result<Self, StateError> {
        let invalid = |message: String| StateError::Invalid(message);
        let mut input = Hashed { inner: input, hash: Sha256::new() };
        if &bytes::<8>(&mut input)? != MAGIC {
            return Err(StateError::Magic);
        }
        let version = number(&mut input)?;
        if version != VERSION {
            return Err(StateError::Version(version));
        }
        let size = [number(&mut input)?, number(&mut input)?];
        let mut crop = [0; 4];
        for side in &mut crop {
            *side = number(&mut input)?;
        }
        let (replicate, count) = (number(&mut input)?, number(&mut input)?);
        let [x0, y0, x1, y1] = crop;
        if x0 > x1 || y0 > y1 || x1 > size[0] || y1 > size[1] {
            return Err(invalid(format!("the window {crop:?} of an image of {}×{} pixels", size[0], size[1])));
        }

        // Layers that this program knows, each once.
        let (mut layers, mut header) = (Vec::<&'static Layer>::new(), MAGIC.len() + 9 * 4);
        for _ in 0..count {
            let [length] = bytes(&mut input)?;
            let mut name = vec![0; length.into()];
            input.read_exact(&mut name)?;
            header += 1 + name.len();
            let name = String::from_utf8_lossy(&name);
            let known = layer(&name).filter(|layer| !layers.contains(layer));
            layers.push(known.ok_or_else(|| invalid(format!("a layer `{name}`, unknown or twice")))?);
        }

        // As many pixels as there are bytes for.
        let layers = Layers::new(layers);
        let doubles = (layers.sums + layers.squares) as u64;
        let pixels = u64::from(x1 - x0) * u64::from(y1 - y0);
        let expected = pixels.checked_mul(12 + 8 * doubles).and_then(|n| n.checked_add((header + HASH) as u64));
        if expected != Some(length) {
            return Err(invalid(format!("{length} bytes for {pixels} pixels of {doubles} sums")));
        }
        let mut film = Self::new(size, crop, &layers);
        film.replicate = replicate;
        read(&mut input, &mut film.replicates, u32::from_le_bytes)?;
        read(&mut input, &mut film.met, u64::from_le_bytes)?;
        read(&mut input, &mut film.sums, f64::from_le_bytes)?;
        read(&mut input, &mut film.squares, f64::from_le_bytes)?;
        let Hashed { mut inner, hash } = input;
        let mut stated = [0; HASH];
        inner.read_exact(&mut stated)?;
        if hash.finalize()[..] != stated {
            return Err(invalid("its hash is another".into()));
        }
        film.check().map_err(|message| invalid(message.into()))?;
        Ok(film)
    }

    /// What holds of every film, whoever computed the hash.
    fn check(&self) -> Result<(), &'static str> {
        let most = u64::from(self.replicate);
        if (self.replicate == 0) != self.replicates.iter().all(|r| *r == 0) {
            return Err("samples without replicates");
        }
        if self.replicates.iter().zip(&self.met).any(|(r, met)| *met > u64::from(*r) * most) {
            return Err("more samples met a surface than were taken");
        }
        if !self.sums.iter().all(|x| x.is_finite()) || !self.squares.iter().all(|x| x.is_finite() && *x >= 0.0) {
            return Err("sums that are not finite");
        }
        Ok(())
    }
}

/// Bytes on their way, and the hash of those that have passed.
struct Hashed<T> {
    inner: T,
    hash: Sha256,
}

impl<T: Write> Hashed<T> {
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        self.inner.write_all(bytes)
    }
}

impl<T: Read> Hashed<T> {
    fn read_exact(&mut self, bytes: &mut [u8]) -> io::Result<()> {
        self.inner.read_exact(bytes)?;
        self.hash.update(&*bytes);
        Ok(())
    }
}

fn bytes<const N: usize>(input: &mut Hashed<impl Read>) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn number(input: &mut Hashed<impl Read>) -> io::Result<u32> {
    Ok(u32::from_le_bytes(bytes(input)?))
}

fn write<T: Copy, const N: usize>(
    out: &mut Hashed<impl Write>,
    numbers: &[T],
    to_bytes: impl Fn(T) -> [u8; N],
) -> io::Result<()> {
    numbers.chunks(BLOCK / N).try_for_each(|part| {
        let bytes: Vec<u8> = part.iter().flat_map(|n| to_bytes(*n)).collect();
        out.write_all(&bytes)
    })
}

fn read<T, const N: usize>(
    input: &mut Hashed<impl Read>,
    numbers: &mut [T],
    from_bytes: impl Fn([u8; N]) -> T,
) -> io::Result<()> {
    let mut block = vec![0; BLOCK / N * N];
    for part in numbers.chunks_mut(BLOCK / N) {
        let bytes = &mut block[..part.len() * N];
        input.read_exact(bytes)?;
        let (chunks, _) = bytes.as_chunks();
        part.iter_mut().zip(chunks).for_each(|(n, chunk)| *n = from_bytes(*chunk));
    }
    Ok(())
}
