//! The whole file.

use super::derived::Derived;
use super::keys::{Named, OneOrMore, keys};
use super::place::Place;
use super::read::At;
use super::{camera::CameraTable, light::EnvironmentTable, light::LightTable, material::MaterialTable};
use super::{shape::ShapeTable, texture::TextureTable};
use crate::desc::{Expect, RenderSettings};

keys! {
    /// A scene for Radianza.
    struct SceneFile {
        /// Name of the scene. Default: the file's.
        name: Option<String>,
        /// The viewpoint, or several; the first is the default. Without any, the whole scene is framed.
        camera: OneOrMore<CameraTable>,
        /// Materials by name.
        material: Named<MaterialTable>,
        /// Textures by name.
        texture: Named<TextureTable>,
        /// Geometry.
        shape: Vec<At<ShapeTable>> = Vec::new(),
        /// Groups of shapes, lights and instances by name, to be placed by instances.
        group: Named<GroupTable>,
        /// Placed groups.
        instance: Vec<At<InstanceTable>> = Vec::new(),
        /// Lights without a surface.
        light: Vec<LightTable> = Vec::new(),
        /// Light from infinity all around.
        environment: Option<At<EnvironmentTable>>,
        /// Render settings, unless the command line says otherwise.
        render: Option<Derived<RenderSettings>>,
        /// Exact values that the image must agree with, one table or several.
        expect: OneOrMore<Derived<Expect>>,
    }
}

keys! {
    /// A group; its content exists once, however many instances place it.
    struct GroupTable {
        /// Geometry.
        shape: Vec<At<ShapeTable>> = Vec::new(),
        /// Other groups, placed.
        instance: Vec<At<InstanceTable>> = Vec::new(),
        /// Lights without a surface.
        light: Vec<LightTable> = Vec::new(),
    }
}

keys! {
    /// A group, placed.
    struct InstanceTable {
        /// Name of the group.
        group: At<String>,
        /// Name for messages. Default: the group's.
        name: Option<String>,
        /// Name of a material in place of all materials of the group. Default: their own.
        material: Option<At<String>>,
        ..place: Place,
    }
}
