//! The bytes behind buffers and buffer views, read when they are first asked for.

use super::budget::Budget;
use super::uri::{self, Uri};
use super::{Resolve, Source, meshopt};
use crate::desc::Error;
use gltf::json::buffer::View;
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
        let first = buffers.map(|(i, b)| b.uri.as_deref().map_or(i, |uri| *by_uri.entry(uri::key(uri)).or_insert(i)));
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
        match uri::parse(uri).map_err(|message| self.source.invalid(place, message))? {
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
