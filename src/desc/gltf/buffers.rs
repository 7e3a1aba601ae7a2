//! The bytes behind buffers and buffer views, read when they are first asked for.

use super::budget::Budget;
use super::uri::{self, Uri};
use super::{Resolve, Source};
use crate::desc::Error;
use std::borrow::Cow;
use std::cell::OnceCell;

/// All buffers of a document.
pub(super) struct Buffers<'a> {
    source: Source<'a>,
    /// BIN chunk of a GLB file.
    bin: Option<&'a [u8]>,
    resolve: Resolve<'a>,
    loaded: Vec<OnceCell<Cow<'a, [u8]>>>,
}

/// A range of a buffer.
pub(super) struct View<'a> {
    /// Its bytes.
    pub bytes: &'a [u8],
    /// Bytes from one element to the next, where the elements are interleaved with others.
    pub stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// None of them loaded yet.
    pub(super) fn new(source: Source<'a>, bin: Option<&'a [u8]>, resolve: Resolve<'a>) -> Self {
        let loaded = source.root.buffers.iter().map(|_| OnceCell::new()).collect();
        Self { source, bin, resolve, loaded }
    }

    /// The buffer view `index`, which `place` refers to.
    pub(super) fn view(&self, index: usize, place: &str, budget: &Budget) -> Result<View<'_>, Error> {
        let source = self.source;
        let view = source.get(&source.root.buffer_views, index, "buffer view", place)?;
        let place = format!("/bufferViews/{index}");
        let buffer = self.buffer(view.buffer.value(), &format!("{place}/buffer"), budget)?;
        let (start, length) = (view.byte_offset.unwrap_or_default().0, view.byte_length.0);
        let range = start.checked_add(length).and_then(|end| Some(start.try_into().ok()?..end.try_into().ok()?));
        let bytes = range.and_then(|r: std::ops::Range<usize>| buffer.get(r)).ok_or_else(|| {
            let message = format!("has {length} bytes from byte {start}; its buffer has {}", buffer.len());
            source.invalid(&place, message)
        })?;
        let stride = view.byte_stride.map(|s| s.0);
        if let Some(stride) = stride.filter(|s| !(4..=252).contains(s)) {
            return Err(source.invalid(format!("{place}/byteStride"), format!("is {stride}; expected 4 to 252")));
        }
        Ok(View { bytes, stride })
    }

    /// The buffer `index`, `byteLength` bytes long.
    fn buffer(&self, index: usize, place: &str, budget: &Budget) -> Result<&[u8], Error> {
        let source = self.source;
        let buffer = source.get(&source.root.buffers, index, "buffer", place)?;
        let cell = &self.loaded[index];
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
        match uri::parse(uri).map_err(|message| self.source.invalid(place, message))? {
            Uri::Data(bytes) => Ok((format!("data URI of {place}"), bytes)),
            Uri::File(name) => {
                let bytes = (self.resolve)(&name, place)?;
                budget.external(self.source, place, bytes.len())?;
                Ok((name, bytes))
            }
        }
    }
}
