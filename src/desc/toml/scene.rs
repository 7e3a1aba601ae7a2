//! The whole file.

use super::keys::{Named, OneOrMore, keys};
use super::place::Place;
use super::read::At;
use super::render::{ExpectTable, RenderTable};
use super::shape::{ShapeKind, ShapeTable};
use super::{camera::CameraTable, environment::EnvironmentTable, image::ImageTable, light::LightTable};
use super::{material::MaterialTable, profile::ProfileTable, texture::TextureTable};

keys! {
    /// A scene for Radianza.
    struct SceneFile {
        /// Name of the scene. Default: the file's.
        name: Option<String>,
        /// The viewpoint, or several; the first is the default. Without any, the whole scene is framed.
        camera: OneOrMore<At<CameraTable>>,
        /// Materials by name.
        material: Named<MaterialTable>,
        /// Images by name, for textures and the environment. Files need no name.
        image: Named<ImageTable>,
        /// Textures by name.
        texture: Named<TextureTable>,
        /// Geometry by name, for shapes of the type "geometry" to share; of any other type but "file".
        geometry: Named<ShapeKind>,
        /// Geometry.
        shape: Vec<At<ShapeTable>> = Vec::new(),
        /// Groups of shapes, lights and instances by name, to be placed by instances.
        group: Named<GroupTable>,
        /// Placed groups.
        instance: Vec<At<InstanceTable>> = Vec::new(),
        /// Measurements by name, for lights of the type "ies". Files need no name.
        profile: Named<ProfileTable>,
        /// Lights without a surface.
        light: Vec<LightTable> = Vec::new(),
        /// Light from infinity all around.
        environment: Option<At<EnvironmentTable>>,
        /// Render settings, unless the command line says otherwise.
        render: Option<RenderTable>,
        /// Exact values that the image must agree with, one table or several.
        expect: OneOrMore<At<ExpectTable>>,
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
