//! Elements of the scene file, in the order in which they were added.

use super::super::value::{Color, Pattern, Scalar, Source};
use crate::desc::Wrap;
use glam::{Affine2, Mat4};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::io;

/// An element with its attributes and content.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Element {
    tag: &'static str,
    attributes: Vec<(&'static str, String)>,
    content: Vec<Element>,
}

impl Element {
    pub(super) fn new(tag: &'static str) -> Self {
        Self { tag, attributes: Vec::new(), content: Vec::new() }
    }

    /// An object of a plugin.
    pub(super) fn plugin(tag: &'static str, kind: &str) -> Self {
        Self::new(tag).with("type", kind)
    }

    pub(super) fn bsdf(kind: &str) -> Self {
        Self::plugin("bsdf", kind)
    }

    pub(super) fn with(mut self, key: &'static str, value: impl ToString) -> Self {
        self.attributes.push((key, value.to_string()));
        self
    }

    pub(super) fn child(mut self, child: Self) -> Self {
        self.content.push(child);
        self
    }

    /// A parameter `<tag name=… value=…/>`.
    pub(super) fn value(self, tag: &'static str, name: &str, value: impl ToString) -> Self {
        self.child(Self::new(tag).with("name", name).with("value", value))
    }

    pub(super) fn float(self, name: &str, x: f32) -> Self {
        self.value("float", name, x)
    }

    pub(super) fn integer(self, name: &str, x: i64) -> Self {
        self.value("integer", name, x)
    }

    pub(super) fn boolean(self, name: &str, x: bool) -> Self {
        self.value("boolean", name, x)
    }

    pub(super) fn string(self, name: &str, x: &str) -> Self {
        self.value("string", name, x)
    }

    pub(super) fn rgb(self, name: &str, [r, g, b]: [f32; 3]) -> Self {
        self.value("rgb", name, format_args!("{r}, {g}, {b}"))
    }

    /// A 4×4 matrix, row by row.
    pub(super) fn transform(self, name: &str, m: Mat4) -> Self {
        let rows: Vec<String> = m.transpose().to_cols_array().iter().map(f32::to_string).collect();
        let matrix = Self::new("matrix").with("value", rows.join(" "));
        self.child(Self::new("transform").with("name", name).child(matrix))
    }

    /// A colour, constant or not.
    pub(super) fn color(self, name: &str, color: &Color) -> Self {
        match color {
            Color::Constant(rgb) => self.rgb(name, *rgb),
            Color::Vertex(factor) => {
                let texture =
                    Self::plugin("texture", "mesh_attribute").with("name", name).string("name", "vertex_color");
                self.child(texture.float("scale", *factor))
            }
            Color::Texture(source) => {
                self.child(texture(name, source, |e, name, rgb| e.unbounded(name, &Color::Constant(rgb))))
            }
        }
    }

    /// A colour that may exceed 1.
    pub(super) fn unbounded(self, name: &str, color: &Color) -> Self {
        match color {
            Color::Constant([r, g, b]) => {
                let texture = Self::plugin("texture", "rawconstant").with("name", name);
                self.child(texture.value("vector", "value", format_args!("{r}, {g}, {b}")))
            }
            other => self.color(name, other),
        }
    }

    /// A number, constant or not.
    pub(super) fn scalar(self, name: &str, scalar: &Scalar) -> Self {
        match scalar {
            Scalar::Constant(x) => self.float(name, *x),
            Scalar::Texture(source) => self.child(texture(name, source, |e, name, x| e.rgb(name, [x; 3]))),
        }
    }

    /// A normal map.
    pub(super) fn normals(self, name: &str, source: &Source<f32>) -> Self {
        self.child(texture(name, source, |e, name, x| e.float(name, x)))
    }

    fn write(&self, out: &mut Writer<&mut Vec<u8>>) -> io::Result<()> {
        let attributes = self.attributes.iter().map(|(key, value)| (*key, value.as_str()));
        let element = out.create_element(self.tag).with_attributes(attributes);
        if self.content.is_empty() {
            element.write_empty()?;
        } else {
            element.write_inner_content(|out| self.content.iter().try_for_each(|child| child.write(out)))?;
        }
        Ok(())
    }
}

/// A texture element; `put` writes a checker's value.
fn texture<T: Copy>(name: &str, source: &Source<T>, put: impl Fn(Element, &str, T) -> Element) -> Element {
    let (element, transform) = match &source.pattern {
        Pattern::Image { file, linear, wrap, nearest } => {
            let element = Element::plugin("texture", "bitmap").with("name", name).string("filename", file);
            let wrap = match wrap[0] {
                Wrap::Repeat => "repeat",
                Wrap::Mirror => "mirror",
                Wrap::Clamp => "clamp",
            };
            let element = element.boolean("raw", *linear).string("wrap_mode", wrap);
            (element.string("filter_type", if *nearest { "nearest" } else { "bilinear" }), source.transform)
        }
        Pattern::Checker { even, odd, scale } => {
            let element = Element::plugin("texture", "checkerboard").with("name", name);
            // Its period, two squares, is the unit there.
            let scale = Affine2::from_scale(0.5 * glam::Vec2::from(*scale));
            (put(put(element, "color0", *even), "color1", *odd), scale * source.transform)
        }
    };
    if transform == Affine2::IDENTITY { element } else { element.transform("to_uv", uv_matrix(transform)) }
}

/// Of a map of the plane; the translation stands where that of space does, and is moved to the third column by the reader
/// (it takes the upper left 3×3 part).
fn uv_matrix(m: Affine2) -> Mat4 {
    let [x, y, t] = [m.matrix2.x_axis, m.matrix2.y_axis, m.translation];
    Mat4::from_cols(x.extend(0.0).extend(0.0), y.extend(0.0).extend(0.0), t.extend(1.0).extend(0.0), glam::Vec4::W)
}

/// The document, with a comment a line of `comments`.
pub(super) fn document(root: &Element, comments: &[String]) -> io::Result<String> {
    let mut bytes = Vec::new();
    let mut out = Writer::new_with_indent(&mut bytes, b' ', 2);
    out.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    for comment in comments {
        // Two hyphens would end it.
        let text = format!(" {} ", comment.replace("--", "- -"));
        out.write_event(Event::Comment(BytesText::from_escaped(text)))?;
    }
    root.write(&mut out)?;
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(io::Error::other)
}
