//! Directives with their parameters, a line each.

use super::super::value::Color;
use glam::{Mat4, Vec3};
use std::fmt::Write;

/// Text that grows by directives.
#[derive(Clone, Debug, Default)]
pub(super) struct Words(String);

impl Words {
    /// Begins a directive; parameters follow on its line.
    pub(super) fn line(&mut self, directive: &str) -> &mut Self {
        if !self.0.is_empty() {
            self.0.push('\n');
        }
        self.0.push_str(directive);
        self
    }

    fn put(&mut self, kind: &str, name: &str, values: std::fmt::Arguments) -> &mut Self {
        let _ = write!(self.0, " \"{kind} {name}\" [ {values} ]");
        self
    }

    pub(super) fn float(&mut self, name: &str, x: f32) -> &mut Self {
        self.put("float", name, format_args!("{x}"))
    }

    pub(super) fn floats(&mut self, name: &str, x: &[f32]) -> &mut Self {
        let list: Vec<String> = x.iter().map(f32::to_string).collect();
        self.put("float", name, format_args!("{}", list.join(" ")))
    }

    pub(super) fn integer(&mut self, name: &str, x: u32) -> &mut Self {
        self.put("integer", name, format_args!("{x}"))
    }

    pub(super) fn boolean(&mut self, name: &str, x: bool) -> &mut Self {
        self.put("bool", name, format_args!("{x}"))
    }

    pub(super) fn string(&mut self, name: &str, x: &str) -> &mut Self {
        self.put("string", name, format_args!("\"{}\"", quoted(x)))
    }

    pub(super) fn strings(&mut self, name: &str, x: [&str; 2]) -> &mut Self {
        self.put("string", name, format_args!("\"{}\" \"{}\"", x[0], x[1]))
    }

    pub(super) fn texture(&mut self, name: &str, texture: &str) -> &mut Self {
        self.put("texture", name, format_args!("\"{texture}\""))
    }

    pub(super) fn rgb(&mut self, name: &str, [r, g, b]: [f32; 3]) -> &mut Self {
        self.put("rgb", name, format_args!("{r} {g} {b}"))
    }

    pub(super) fn point(&mut self, name: &str, p: Vec3) -> &mut Self {
        self.put("point3", name, format_args!("{} {} {}", p.x, p.y, p.z))
    }

    /// A directive with a matrix, column by column.
    pub(super) fn matrix(&mut self, directive: &str, m: Mat4) -> &mut Self {
        let list: Vec<String> = m.to_cols_array().iter().map(f32::to_string).collect();
        self.line(&format!("{directive} [ {} ]", list.join(" ")))
    }

    pub(super) fn text(&self) -> String {
        format!("{}\n", self.0)
    }
}

/// File names in quotation marks.
fn quoted(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"")
}

/// A colour or a number that a directive names: constant, or a texture of this name.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Named<T> {
    Constant(T),
    Texture(String),
}

impl Words {
    pub(super) fn color(&mut self, name: &str, color: &Named<[f32; 3]>) -> &mut Self {
        match color {
            Named::Constant(rgb) => self.rgb(name, *rgb),
            Named::Texture(texture) => self.texture(name, texture),
        }
    }

    pub(super) fn scalar(&mut self, name: &str, scalar: &Named<f32>) -> &mut Self {
        match scalar {
            Named::Constant(x) => self.float(name, *x),
            Named::Texture(texture) => self.texture(name, texture),
        }
    }
}

impl Color {
    /// Without a texture: what pbrt can say, vertex colours left out.
    pub(super) fn plain(&self) -> Option<[f32; 3]> {
        match self {
            Self::Constant(rgb) => Some(*rgb),
            Self::Vertex(factor) => Some([*factor; 3]),
            Self::Texture(_) => None,
        }
    }
}
