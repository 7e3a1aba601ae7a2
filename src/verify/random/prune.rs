//! What nothing uses is left out.

use crate::desc::{Emission, Scene, Texture};

/// The scene without shapes and materials that no object has, and without textures and images that none of those looks at.
pub(super) fn prune(scene: &Scene) -> Scene {
    let mut pruned = scene.clone();
    let shapes = Numbers::of(scene.shapes.len(), scene.objects.iter().map(|o| o.shape));
    let materials = Numbers::of(scene.materials.len(), scene.objects.iter().map(|o| o.material));
    for object in &mut pruned.objects {
        shapes.renumber(&mut object.shape);
        materials.renumber(&mut object.material);
    }
    pruned.shapes = shapes.kept(&scene.shapes);
    pruned.materials = materials.kept(&scene.materials);

    let mut used = Vec::new();
    each_texture(&mut pruned, &mut |texture| used.push(*texture));
    let textures = Numbers::of(scene.textures.len(), used.into_iter());
    each_texture(&mut pruned, &mut |texture| textures.renumber(texture));
    pruned.textures = textures.kept(&scene.textures);

    let mut used = Vec::new();
    each_image(&mut pruned, &mut |image| used.push(*image));
    let images = Numbers::of(scene.images.len(), used.into_iter());
    each_image(&mut pruned, &mut |image| images.renumber(image));
    pruned.images = images.kept(&scene.images);
    pruned
}

/// The number of every texture that a material or an emission looks at.
fn each_texture(scene: &mut Scene, visit: &mut dyn FnMut(&mut usize)) {
    let mut parameter = |mut parameter: crate::desc::parameter::Parameter| {
        if let Some(texture) = parameter.value.texture_mut() {
            visit(&mut texture.texture);
        }
    };
    scene.materials.iter_mut().for_each(|material| material.visit(&mut parameter));
    let own = scene.objects.iter_mut().filter_map(|object| object.emission.as_mut());
    own.for_each(|emission: &mut Emission| emission.visit(&mut parameter));
}

/// The number of every image that a texture or the environment has.
fn each_image(scene: &mut Scene, visit: &mut dyn FnMut(&mut usize)) {
    for texture in &mut scene.textures {
        if let Texture::Image { image, .. } = texture {
            visit(image);
        }
    }
    scene.environment.iter_mut().filter_map(|e| e.image.as_mut()).for_each(visit);
}

/// New numbers of what is used of a list.
struct Numbers(Vec<Option<usize>>);

impl Numbers {
    fn of(count: usize, used: impl Iterator<Item = usize>) -> Self {
        let mut is_used = vec![false; count];
        used.for_each(|i| is_used[i] = true);
        let mut next = 0..;
        Self(is_used.into_iter().map(|used| if used { next.next() } else { None }).collect())
    }

    fn renumber(&self, number: &mut usize) {
        *number = self.0[*number].unwrap_or(*number);
    }

    fn kept<T: Clone>(&self, list: &[T]) -> Vec<T> {
        list.iter().zip(&self.0).filter(|(_, number)| number.is_some()).map(|(x, _)| x.clone()).collect()
    }
}
