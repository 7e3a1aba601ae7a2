//! What buffers and images refer to: the URI's own bytes, or a file beside the document.

use crate::desc::files::plain;
use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;
use std::borrow::Cow;

/// Standard alphabet, padded or not.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// A URI, read.
#[derive(Debug, PartialEq)]
pub(super) enum Uri {
    /// `data:` with its bytes.
    Data(Vec<u8>),
    /// A relative path, percent-decoded.
    File(String),
}

/// Reads a URI; the error says what was found and what was expected.
pub(super) fn parse(uri: &str) -> Result<Uri, String> {
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
pub(super) fn key(uri: &str) -> Cow<'_, str> {
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
