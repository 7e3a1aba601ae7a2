//! What a random scene may contain, and which two of it can meet.
//!
//! Faults sit where two features meet, so pairs are what is counted: two properties of one object, or one of an object
//! and one of the scene that it stands in.

use std::collections::BTreeSet;

/// Which features exclude or need each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A scattering model, or a form of its parameters.
    Model,
    /// An extension of the metallic-roughness model.
    Extension,
    /// Something else about a material.
    Material,
    /// A form of coverage: a material has one.
    Coverage,
    /// Emission and what varies of it.
    Emission,
    /// A shape: an object has one.
    Shape,
    /// What only meshes have.
    Mesh,
    /// How an object is placed.
    Place,
    /// What emits without being an object.
    Light,
    /// A camera: a scene is seen by one.
    Camera,
    /// Something else about a scene.
    Scene,
}

macro_rules! features {
    ($($(#[$doc:meta])* $name:ident = $text:literal, $kind:ident;)*) => {
        /// A feature of the scene description.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Feature {
            $($(#[$doc])* $name,)*
        }

        impl Feature {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$name,)*];

            /// Its name in messages.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$name => $text,)*
                }
            }

            fn kind(self) -> Kind {
                match self {
                    $(Self::$name => Kind::$kind,)*
                }
            }
        }
    };
}

features! {
    /// [`crate::desc::Model::Diffuse`].
    Diffuse = "diffuse", Model;
    /// [`crate::desc::Model::RoughDiffuse`].
    RoughDiffuse = "rough diffuse", Model;
    /// [`crate::desc::Model::Phong`].
    Phong = "Phong", Model;
    /// [`crate::desc::Model::Mirror`].
    Mirror = "mirror", Model;
    /// [`crate::desc::Model::Dielectric`], smooth.
    SmoothDielectric = "smooth dielectric", Model;
    /// [`crate::desc::Model::Dielectric`], rough.
    RoughDielectric = "rough dielectric", Model;
    /// [`crate::desc::Model::Conductor`].
    Conductor = "conductor", Model;
    /// [`crate::desc::Model::CookTorrance`].
    CookTorrance = "Cook-Torrance", Model;
    /// [`crate::desc::Model::Mix`].
    Mix = "mix", Model;
    /// [`crate::desc::Model::MetallicRoughness`].
    MetallicRoughness = "metallic-roughness", Model;
    /// [`crate::desc::Model::SpecularGlossiness`].
    SpecularGlossiness = "specular-glossiness", Model;
    /// [`crate::desc::Model::Absorb`].
    Absorb = "absorb", Model;
    /// A roughness that differs by direction, of a conductor, a dielectric or Cook and Torrance's model.
    Stretched = "stretched roughness", Model;
    /// Complex indices of refraction.
    ComplexIndex = "complex index", Model;

    /// Clear coat.
    Clearcoat = "clear coat", Extension;
    /// Clear coat with a normal map of its own.
    CoatNormal = "normals of the coat", Extension;
    /// Sheen.
    Sheen = "sheen", Extension;
    /// Anisotropy.
    Anisotropy = "anisotropy", Extension;
    /// Thin film.
    Iridescence = "iridescence", Extension;
    /// Factor and colour of the dielectric reflection.
    Specular = "specular", Extension;
    /// Transmission through a thin sheet.
    ThinTransmission = "thin transmission", Extension;
    /// Transmission into a volume.
    Transmission = "transmission", Extension;
    /// Diffuse transmission through a sheet.
    ThinDiffuseTransmission = "thin diffuse transmission", Extension;
    /// Diffuse transmission into a volume.
    DiffuseTransmission = "diffuse transmission", Extension;

    /// An interior that absorbs.
    Absorption = "absorbing interior", Material;
    /// An interior whose index depends on the wavelength.
    Dispersion = "dispersion", Material;
    /// An image that gives a colour.
    ImageColor = "image as colour", Material;
    /// A checker that gives a colour.
    Checker = "checker as colour", Material;
    /// An image that gives a number.
    ImageNumber = "image as number", Material;
    /// A normal map.
    NormalMap = "normal map", Material;

    /// A threshold on the alpha of an image.
    Mask = "mask", Coverage;
    /// Constant coverage below 1.
    BlendConstant = "constant coverage", Coverage;
    /// Coverage by an image.
    BlendImage = "coverage by image", Coverage;

    /// Emission of the front.
    EmitsFront = "emits to the front", Emission;
    /// Emission of both sides.
    EmitsBoth = "emits to both sides", Emission;
    /// Emission by an image.
    EmissionImage = "emission by image", Emission;
    /// Emission under a clear coat.
    EmissionCoat = "emission under a coat", Emission;
    /// Emission of the object in place of its material's.
    OwnEmission = "emission of the object", Emission;

    /// [`crate::desc::Shape::Sphere`].
    Sphere = "sphere", Shape;
    /// [`crate::desc::Shape::Disk`].
    Disk = "disk", Shape;
    /// [`crate::desc::Shape::Cylinder`].
    Cylinder = "cylinder", Shape;
    /// A mesh of one parallelogram.
    Quad = "quad", Shape;
    /// A mesh of six faces.
    Cuboid = "box", Shape;
    /// A closed mesh of few triangles.
    Facets = "facets", Shape;
    /// A closed mesh, round or a ring.
    Ring = "ring", Shape;

    /// Interpolated normals.
    SmoothNormals = "smooth normals", Mesh;
    /// Vertex colours with alpha.
    VertexColors = "vertex colours", Mesh;
    /// Textures by the second set of coordinates.
    SecondUv = "second UV set", Mesh;
    /// Tangents in the mesh.
    Tangents = "tangents", Mesh;
    /// Copies by a hierarchy of their own.
    Instances = "instances", Mesh;

    /// A transform that mirrors.
    Mirrored = "mirrored", Place;
    /// Scales that differ by axis.
    Uneven = "uneven scale", Place;
    /// Normals turned about.
    Reversed = "reversed", Place;
    /// Another surface is inside.
    Nesting = "something inside", Place;
    /// It is inside another.
    Nested = "inside something", Place;

    /// [`crate::desc::Light::Point`].
    Point = "point light", Light;
    /// [`crate::desc::Light::Spot`].
    Spot = "spot light", Light;
    /// [`crate::desc::Light::Profile`].
    Profile = "measured light", Light;
    /// [`crate::desc::Light::Directional`].
    Directional = "directional light", Light;
    /// [`crate::desc::Light::Sun`].
    Sun = "sun", Light;
    /// A light that ends at a distance.
    Range = "range of a light", Light;
    /// Uniform environment.
    Environment = "uniform environment", Light;
    /// Environment by an image.
    EnvironmentImage = "environment by image", Light;

    /// [`crate::desc::Projection::Perspective`].
    Perspective = "perspective", Camera;
    /// [`crate::desc::Projection::Orthographic`].
    Orthographic = "orthographic", Camera;
    /// [`crate::desc::Projection::Equirectangular`].
    Panorama = "panorama", Camera;

    /// A thin lens.
    Lens = "thin lens", Scene;
    /// Walls about everything but the viewer.
    Room = "room", Scene;
}

use Feature::*;

impl Feature {
    /// It belongs to the scene, not to one of its objects.
    pub fn is_of_scene(self) -> bool {
        matches!(self.kind(), Kind::Light | Kind::Camera | Kind::Scene)
    }

    /// Light passes a surface with it into a volume: only what is closed may have it.
    fn encloses(self) -> bool {
        matches!(
            self,
            SmoothDielectric | RoughDielectric | Transmission | DiffuseTransmission | Absorption | Dispersion
        )
    }

    /// A surface with it does not bound a volume.
    fn is_open(self) -> bool {
        matches!(self, Disk | Cylinder | Quad | Reversed | Mask | BlendConstant | BlendImage)
    }

    /// A parametric shape, without vertices.
    fn is_quadric(self) -> bool {
        matches!(self, Sphere | Disk | Cylinder)
    }
}

/// Two features that may meet, in the order of [`Feature::ALL`].
pub type Pair = (Feature, Feature);

/// Whether a lawful scene may have both, on one object where both are of objects.
pub fn may_meet(a: Feature, b: Feature) -> bool {
    let either = |f: &dyn Fn(Feature, Feature) -> bool| f(a, b) || f(b, a);
    let kinds = |k: Kind| a.kind() == k && b.kind() == k;
    let alone = [Kind::Coverage, Kind::Shape, Kind::Camera].into_iter().any(kinds);
    let no_vertices = either(&|a, b| a.is_quadric() && b.kind() == Kind::Mesh);
    let not_closed = either(&|a, b| a.encloses() && b.is_open());
    let excluded = either(&|a, b| match (a, b) {
        (EmitsFront, EmitsBoth) | (Environment, EnvironmentImage) => true,
        (Lens, Orthographic | Panorama) => true,
        // Copies need many triangles, what is inside needs an inside.
        (Instances, Quad | Cuboid | Facets) => true,
        (Nesting, Disk | Cylinder | Quad | Ring | Facets | Instances) => true,
        (Nested, Instances | Nesting) => true,
        _ => false,
    });
    !(a == b || alone || no_vertices || not_closed || excluded)
}

/// What the objects of a scene have, each by itself, and the scene beside them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    /// Features of each object.
    pub objects: Vec<BTreeSet<Feature>>,
    /// Features of the scene.
    pub scene: BTreeSet<Feature>,
}

impl Features {
    /// All pairs that meet.
    pub fn pairs(&self) -> BTreeSet<Pair> {
        let mut pairs = BTreeSet::new();
        for object in &self.objects {
            let all: BTreeSet<Feature> = object.union(&self.scene).copied().collect();
            pairs.extend(all.iter().flat_map(|a| all.range(a..).skip(1).map(|b| (*a, *b))));
        }
        pairs
    }
}

/// All pairs that may meet.
pub fn lawful_pairs() -> BTreeSet<Pair> {
    let all = Feature::ALL;
    let pairs = all.iter().enumerate().flat_map(|(i, a)| all[i + 1..].iter().map(|b| (*a, *b)));
    pairs.filter(|(a, b)| may_meet(*a, *b)).collect()
}
