//! The bytes behind buffers and buffer views, read when they are first asked for: those of a URI itself, of a file beside
//! the document, or of the binary chunk.

use super::budget::Budget;
use super::{Resolve, Source, meshopt};
use crate::desc::Error;
use crate::desc::files::plain;
use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::json::buffer::View;
use percent_encoding::percent_decode_str;
use std::borrow::Cow;
use std::cell::OnceCell;
use std::collections::HashMap;

/// All buffers of a document.
pub(super) struct Buffers<'a> {
    source: Source<'a>,
    /// BIN chunk of a GLB file.
    bin: Option<&'a [u8]>,
    resolve: Resolve<'a>,
    loaded: Vec<OnceCell<Cow<'a, [u8]>>>,
    /// Of each buffer the first that has its URI, where both are read to.
    first: Vec<usize>,
    /// Of the views that are compressed.
    decompressed: Vec<OnceCell<Vec<u8>>>,
}

/// A range of a buffer.
pub(super) struct Bytes<'a> {
    /// Its bytes.
    pub bytes: &'a [u8],
    /// Bytes from one element to the next, where the elements are interleaved with others.
    pub stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// None of them loaded yet.
    pub(super) fn new(source: Source<'a>, bin: Option<&'a [u8]>, resolve: Resolve<'a>) -> Self {
        let loaded = source.root.buffers.iter().map(|_| OnceCell::new()).collect();
        let decompressed = source.root.buffer_views.iter().map(|_| OnceCell::new()).collect();
        let mut by_uri = HashMap::new();
        let buffers = source.root.buffers.iter().enumerate();
        let first = buffers.map(|(i, b)| b.uri.as_deref().map_or(i, |uri| *by_uri.entry(key(uri)).or_insert(i)));
        let first = first.collect();
        Self { source, bin, resolve, loaded, first, decompressed }
    }

    /// The buffer view `index`, which `place` refers to.
    pub(super) fn view(&self, index: usize, place: &str, budget: &Budget) -> Result<Bytes<'_>, Error> {
        let source = self.source;
        let view = source.get(&source.root.buffer_views, index, "buffer view", place)?;
        let place = format!("/bufferViews/{index}");
        let bytes = match self.decompressed(index, view, &place, budget)? {
            Some(bytes) => bytes,
            None => {
                let range = [view.byte_offset.unwrap_or_default().0, view.byte_length.0];
                self.range(view.buffer.value(), range, &place, budget)?
            }
        };
        let stride = view.byte_stride.map(|s| s.0);
        if let Some(stride) = stride.filter(|s| !(4..=252).contains(s)) {
            return Err(source.invalid(format!("{place}/byteStride"), format!("is {stride}; expected 4 to 252")));
        }
        Ok(Bytes { bytes, stride })
    }

    /// The bytes of the view `index` if it is compressed.
    fn decompressed(&self, index: usize, view: &View, place: &str, budget: &Budget) -> Result<Option<&[u8]>, Error> {
        let cell = &self.decompressed[index];
        if cell.get().is_none()
            && let Some(bytes) = meshopt::decompress(self, self.source, view, place, budget)?
        {
            cell.get_or_init(|| bytes);
        }
        Ok(cell.get().map(Vec::as_slice))
    }

    /// `length` bytes of a buffer from `start`, as what stands at `place` asks for them.
    pub(super) fn range(
        &self,
        buffer: usize,
        [start, length]: [u64; 2],
        place: &str,
        budget: &Budget,
    ) -> Result<&[u8], Error> {
        let buffer = self.buffer(buffer, &format!("{place}/buffer"), budget)?;
        let range = start.checked_add(length).and_then(|end| Some(start.try_into().ok()?..end.try_into().ok()?));
        range.and_then(|r: std::ops::Range<usize>| buffer.get(r)).ok_or_else(|| {
            let message = format!("has {length} bytes from byte {start}; its buffer has {}", buffer.len());
            self.source.invalid(place, message)
        })
    }

    /// The buffer `index`, `byteLength` bytes long.
    fn buffer(&self, index: usize, place: &str, budget: &Budget) -> Result<&[u8], Error> {
        let source = self.source;
        let buffer = source.get(&source.root.buffers, index, "buffer", place)?;
        let cell = &self.loaded[self.first[index]];
        let bytes = match cell.get() {
            Some(bytes) => bytes,
            None => {
                let bytes = self.load(index, buffer.uri.as_deref(), budget)?;
                cell.get_or_init(|| bytes)
            }
        };
        usize::try_from(buffer.byte_length.0).ok().and_then(|n| bytes.get(..n)).ok_or_else(|| {
            let message = format!("is {}; there are {} bytes", buffer.byte_length.0, bytes.len());
            source.invalid(format!("/buffers/{index}/byteLength"), message)
        })
    }

    fn load(&self, index: usize, uri: Option<&str>, budget: &Budget) -> Result<Cow<'a, [u8]>, Error> {
        let place = format!("/buffers/{index}/uri");
        match uri {
            Some(uri) => self.fetch(uri, &place, budget).map(|(_, bytes)| Cow::Owned(bytes)),
            None if index == 0 => self
                .bin
                .map(Cow::Borrowed)
                .ok_or_else(|| self.source.invalid(place, "is missing, and the file has no BIN chunk in its stead")),
            None => Err(self.source.invalid(place, "is missing; only buffer 0 can be the BIN chunk of a GLB file")),
        }
    }

    /// What a URI refers to: a name for messages, and the bytes.
    pub(super) fn fetch(&self, uri: &str, place: &str, budget: &Budget) -> Result<(String, Vec<u8>), Error> {
        match parse(uri).map_err(|message| self.source.invalid(place, message))? {
            Uri::Data(bytes) => Ok((format!("data URI of {place}"), bytes)),
            Uri::File(name) => self.file(&name, place, budget).map(|bytes| (name, bytes)),
        }
    }

    /// The file of this name, which `place` asks for.
    pub(super) fn file(&self, name: &str, place: &str, budget: &Budget) -> Result<Vec<u8>, Error> {
        let bytes = (self.resolve)(name, place)?;
        budget.external(self.source, place, name, bytes.len())?;
        Ok(bytes)
    }
}

/// Standard alphabet, padded or not.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// A URI, read.
#[derive(Debug, PartialEq)]
enum Uri {
    /// `data:` with its bytes.
    Data(Vec<u8>),
    /// A relative path, percent-decoded.
    File(String),
}

/// Reads a URI; the error says what was found and what was expected.
fn parse(uri: &str) -> Result<Uri, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((head, body)) = data.split_once(',') else {
            return Err(format!("the data URI `{}` has no comma before its data", shorten(uri)));
        };
        if !head.ends_with(";base64") {
            return Ok(Uri::Data(percent_decode_str(body).collect()));
        }
        let wrong = |e| format!("the data URI `{}` is not base64: {e}", shorten(uri));
        return BASE64.decode(body).map(Uri::Data).map_err(wrong);
    }
    if let Some(scheme) = scheme(uri) {
        return Err(format!(
            "`{}` has the scheme `{scheme}`; expected a path beside the file, or `data:`",
            shorten(uri)
        ));
    }
    let name = percent_decode_str(uri).decode_utf8();
    let name = name.map_err(|_| format!("`{}` is not UTF-8 once percent-decoded", shorten(uri)))?;
    Ok(Uri::File(plain(&name)))
}

/// What all URIs of the same bytes have in common: the name of the file, or else the URI itself.
fn key(uri: &str) -> Cow<'_, str> {
    if uri.starts_with("data:") {
        return uri.into();
    }
    match parse(uri) {
        Ok(Uri::File(name)) => name.into(),
        _ => uri.into(),
    }
}

/// `http` of `http://…` (RFC 3986, section 3.1).
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let first = scheme.chars().next()?;
    let letters = first.is_ascii_alphabetic() && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    letters.then_some(scheme)
}

/// The beginning of a long URI, for messages.
fn shorten(uri: &str) -> String {
    let head: String = uri.chars().take(40).collect();
    if head.len() < uri.len() { format!("{head}…") } else { head }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn uris_are_data_or_relative_paths() {
        assert_eq!(parse("data:application/octet-stream;base64,AAEC/w=="), Ok(Uri::Data(vec![0, 1, 2, 255])));
        assert_eq!(parse("data:;base64,AAEC/w"), Ok(Uri::Data(vec![0, 1, 2, 255])));
        assert_eq!(parse("data:,a%20b"), Ok(Uri::Data(b"a b".to_vec())));
        assert_eq!(parse("my%20file.bin"), Ok(Uri::File("my file.bin".into())));
        assert_eq!(parse("a/100%.png"), Ok(Uri::File("a/100%.png".into())));
        for bad in ["data:x", "data:;base64,!!", "http://x/y", "file:///etc/passwd", "C:\\x.bin", "%ff%fe"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
