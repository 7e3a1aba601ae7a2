"""Mitsuba XML, as `radianza export` writes it, for Blender's Cycles: diffuse, smooth and rough dielectrics and conductors, area lights,
uniform and mapped environments, instances."""

import math
import xml.etree.ElementTree as ET
from pathlib import Path

KNOWN = {"twosided", "diffuse", "dielectric", "roughdielectric", "conductor", "roughconductor"}


def unknown(xml):
    """Why Cycles has no equal of the scene, or None."""
    for bsdf in ET.parse(xml).getroot().iter("bsdf"):
        if bsdf.get("type") not in KNOWN:
            return f"no equal of `{bsdf.get('type')}`"
    for texture in ET.parse(xml).getroot().iter("texture"):
        if texture.get("type") == "bitmap":
            return "textures are not written"
    return None


def numbers(text):
    return [float(x) for x in text.replace(",", " ").split()]


def child(node, name):
    return next((c for c in node if c.get("name") == name), None)


def value(node, name, default):
    found = child(node, name)
    if found is None:
        return default
    found = found if found.get("value") else found[0]
    values = numbers(found.get("value"))
    return values if len(values) > 1 else values[0]


def load(xml, max_depth):
    """The scene in Blender, which is returned."""
    import bpy
    from mathutils import Matrix

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    root = ET.parse(xml).getroot()
    scene = bpy.context.scene
    # y up to z up.
    up = Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))

    def to_world(node):
        transform = child(node, "to_world")
        if transform is None:
            return Matrix.Identity(4)
        m = numbers(transform.find("matrix").get("value"))
        return Matrix([m[4 * i : 4 * i + 4] for i in range(4)])

    def rgb(node, name, default):
        v = value(node, name, default)
        return (*(v if isinstance(v, list) else [v] * 3), 1.0)

    def material_of(bsdf, emission):
        bsdf = bsdf[0] if bsdf is not None and bsdf.get("type") == "twosided" else bsdf
        material = bpy.data.materials.new("material")
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        output = nodes.new("ShaderNodeOutputMaterial")
        if emission is not None:
            # The front alone.
            light, nothing, mix = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeMixShader")
            side = nodes.new("ShaderNodeNewGeometry")
            light.inputs["Color"].default_value = rgb(emission, "radiance", 1.0)
            nothing.inputs["Strength"].default_value = 0.0
            links.new(side.outputs["Backfacing"], mix.inputs[0])
            links.new(light.outputs[0], mix.inputs[1])
            links.new(nothing.outputs[0], mix.inputs[2])
            links.new(mix.outputs[0], output.inputs["Surface"])
            material.cycles.emission_sampling = "FRONT"
            return material
        kind = bsdf.get("type")
        alpha = value(bsdf, "alpha", 0.0)
        if kind == "diffuse":
            shader = nodes.new("ShaderNodeBsdfDiffuse")
            shader.inputs["Color"].default_value = rgb(bsdf, "reflectance", 0.5)
        elif kind in ("dielectric", "roughdielectric"):
            shader = nodes.new("ShaderNodeBsdfGlass")
            shader.inputs["Color"].default_value = (1, 1, 1, 1)
            shader.inputs["IOR"].default_value = value(bsdf, "int_ior", 1.5)
            shader.inputs["Roughness"].default_value = math.sqrt(alpha)
        elif child(bsdf, "eta") is not None:
            shader = nodes.new("ShaderNodeBsdfMetallic")
            shader.fresnel_type = "PHYSICAL_CONDUCTOR"
            shader.inputs["IOR"].default_value = rgb(bsdf, "eta", 1.0)[:3]
            shader.inputs["Extinction"].default_value = rgb(bsdf, "k", 0.0)[:3]
            shader.inputs["Roughness"].default_value = math.sqrt(alpha)
        else:
            shader = nodes.new("ShaderNodeBsdfGlossy")
            shader.inputs["Color"].default_value = rgb(bsdf, "specular_reflectance", 1.0)
            shader.inputs["Roughness"].default_value = math.sqrt(alpha)
        links.new(shader.outputs[0], output.inputs["Surface"])
        return material

    bsdfs = {b.get("id"): b for b in root.findall("bsdf")}
    materials = {}

    def material_for(shape):
        emission = shape.find("emitter")
        if emission is not None:
            return material_of(None, emission)
        name = shape.find("ref").get("id")
        if name not in materials:
            materials[name] = material_of(bsdfs[name], None)
        return materials[name]

    def mesh_of(shape):
        kind = shape.get("type")
        if kind == "ply":
            bpy.ops.wm.ply_import(filepath=str(xml.parent / child(shape, "filename").get("value")), forward_axis="Y", up_axis="Z")
        elif kind == "sphere":
            # Lamps may be coarse, if they are as large; what is looked at and through may not.
            lamp, radius = shape.find("emitter") is not None, value(shape, "radius", 1.0)
            bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3 if lamp else 7, radius=radius)
            bpy.ops.object.shade_smooth()
            area = sum(face.area for face in bpy.context.object.data.polygons)
            bpy.context.object.data.transform(Matrix.Scale(math.sqrt(4 * math.pi * radius**2 / area), 4))
        elif kind == "disk":
            bpy.ops.mesh.primitive_circle_add(vertices=256, radius=value(shape, "radius", 1.0), fill_type="NGON")
        elif kind == "cylinder":
            p0, p1 = ([float(child(shape, p).get(a)) for a in "xyz"] if child(shape, p) is not None else d for p, d in (("p0", [0, 0, 0]), ("p1", [0, 0, 1])))
            bpy.ops.mesh.primitive_cylinder_add(vertices=256, radius=value(shape, "radius", 1.0), depth=p1[2] - p0[2], end_fill_type="NOTHING")
            bpy.context.object.data.transform(Matrix.Translation((0, 0, (p0[2] + p1[2]) / 2)))
            bpy.ops.object.shade_smooth()
        else:
            raise SystemExit(f"{xml}: no equal of shape `{kind}`")
        source = bpy.context.object
        mesh = source.data
        bpy.data.objects.remove(source)
        mesh.materials.clear()
        mesh.materials.append(material_for(shape))
        return mesh

    def place(mesh, matrix):
        thing = bpy.data.objects.new("object", mesh)
        thing.matrix_world = up @ matrix
        scene.collection.objects.link(thing)

    groups = {}
    for shape in root.findall("shape"):
        if shape.get("type") == "shapegroup":
            groups[shape.get("id")] = [(mesh_of(part), to_world(part)) for part in shape.findall("shape")]
        elif shape.get("type") == "instance":
            for mesh, matrix in groups[shape.find("ref").get("id")]:
                place(mesh, to_world(shape) @ matrix)
        else:
            place(mesh_of(shape), to_world(shape))

    sensor = root.find("sensor")
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL" if child(sensor, "fov_axis").get("value") == "y" else "HORIZONTAL"
    camera.angle = math.radians(value(sensor, "fov", 45.0))
    camera.clip_start, camera.clip_end = 1e-3, 1e6
    eye = bpy.data.objects.new("camera", camera)
    # Mitsuba looks along +z with x to the left.
    eye.matrix_world = up @ to_world(sensor) @ Matrix.Diagonal((-1, 1, -1, 1))
    scene.collection.objects.link(eye)
    scene.camera = eye

    radiance, image = (0, 0, 0, 1), None
    for emitter in root.findall("emitter"):
        if emitter.get("type") == "constant":
            radiance = rgb(emitter, "radiance", 1.0)
        elif emitter.get("type") == "envmap":
            image = xml.parent / child(emitter, "filename").get("value")
        else:
            raise SystemExit(f"{xml}: no equal of emitter `{emitter.get('type')}`")
    surround(bpy, scene, image, radiance)

    film = sensor.find("film")
    render, c = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = int(value(film, "width", 1)), int(value(film, "height", 1))
    render.resolution_percentage = 100
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.color_mode = "RGB"
    scene.view_settings.view_transform = "Raw"
    c.device = "CPU"
    c.use_adaptive_sampling = c.use_denoising = False
    c.sample_clamp_direct = c.sample_clamp_indirect = 0.0
    c.blur_glossy = 0.0
    c.caustics_reflective = c.caustics_refractive = True
    c.light_sampling_threshold = 0.0
    c.pixel_filter_type = "BOX"
    c.filter_width = 1.0
    # Light that is sampled at the last bounce counts as none there.
    bounces = 1024 if max_depth is None else max_depth - 1
    for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(c, f"{kind}_bounces", bounces)
    return bpy


def surround(bpy, scene, image, radiance=(0, 0, 0, 1)):
    """The environment: an equirectangular image whose middle is glTF's -z, or the same radiance from everywhere."""
    world = bpy.data.worlds.new("world")
    scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    light, output = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeOutputWorld")
    light.inputs["Color"].default_value = radiance
    links.new(light.outputs["Background"], output.inputs["Surface"])
    if image is None:
        return
    where, turn, texture = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeTexEnvironment")
    # Blender's map has +x in its middle, glTF's viewers -z, which is Blender's +y.
    turn.inputs["Rotation"].default_value[2] = -math.pi / 2
    texture.image = bpy.data.images.load(str(image.resolve()))
    texture.image.colorspace_settings.name = "Linear Rec.709"
    links.new(where.outputs["Generated"], turn.inputs["Vector"])
    links.new(turn.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], light.inputs["Color"])
