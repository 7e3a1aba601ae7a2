#!/usr/bin/env python3
"""glTF files in Radianza and in Blender's Cycles, side by side on one sheet.

Needs Blender as a Python module (pip install bpy pillow; bpy 5.0 wants Python 3.11), a release build of Radianza, and a folder of glTF
files:

    python3 benches/peers/blender.py --assets FOLDER --env SKY.hdr [--spp 256] [--size 384x288] [NAME ...]

Each file is imported by Blender and framed there; Radianza gets the same camera and the same environment. Lamps of the file
itself are part of both. Cycles follows paths as long as it may, without clamps, filters of glossy light or denoising. The sheet has
a row for each file: Radianza, Cycles, and log2 of the ratio of their luminances, blue where Cycles is darker by a stop, red where
it is brighter; what is printed tells the same in numbers. Where the two differ, the reasons that are known stand in benches/README.md.
"""

import argparse
import math
import shutil
import subprocess
import sys
from pathlib import Path

import for_cycles

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "target" / "peers" / "cycles"
RADIANZA = ROOT / "target" / "release" / "radianza"
VIEW_ANGLE = 30.0

# Where the camera stands, as seen from the middle of what is framed (glTF axes: y up), and the share of the bounding sphere that fills
# the picture.
VIEWS = {
    "MetalRoughSpheresNoTextures.glb": ((0.0, 0.0, 1.0), 0.75),
    "ClearCoatTest.glb": ((0.0, 0.05, 1.0), 0.72),
    "SheenCloth/SheenCloth.gltf": ((0.4, 0.9, 0.8), 0.75),
    "AnisotropyStrengthTest.glb": ((0.0, 0.0, 1.0), 0.75),
    "SpecularTest.glb": ((0.0, 0.0, 1.0), 0.72),
    "TransmissionTest.glb": ((0.0, 0.1, 1.0), 0.6),
    "TransmissionRoughnessTest.glb": ((0.0, 0.0, 1.0), 0.8),
    "AttenuationTest.glb": ((0.0, 0.0, 1.0), 0.75),
    "TextureTransformMultiTest.glb": ((0.0, 0.0, 1.0), 0.75),
    "ChessBoard-draco.glb": ((0.5, 0.8, 1.0), 0.6),
    "StandardShaderBall.glb": ((0.0, 0.35, 1.0), 0.75),
    "NegativeScaleTest.glb": ((0.0, 0.0, 1.0), 0.75),
    "GlassVaseFlowers.glb": ((0.3, 0.3, 1.0), 0.8),
    "EmissiveStrengthTest.glb": ((0.0, 0.0, 1.0), 0.75),
}
DEFAULT = [name for name in VIEWS][:10]


def main():
    args = arguments()
    sys.argv = sys.argv[:1]
    import bpy

    OUT.mkdir(parents=True, exist_ok=True)
    rows = []
    print(f"{'file':32} {'Radianza':>9} {'Cycles':>9} {'ratio':>6}  within 5 % / 25 % / a stop")
    for name in args.names or DEFAULT:
        source = args.assets / name
        if not source.exists():
            sys.exit(f"{source}: no such file")
        folder = OUT / source.stem
        camera = import_and_frame(bpy, source, VIEWS.get(name, ((0.5, 0.35, 1.0), 0.8)), args)
        ours = radianza(bpy, source, folder, camera, args)
        theirs = cycles(bpy, folder, args)
        report(name, ours, theirs)
        rows.append((name, ours, theirs))
    sheet(rows, OUT / "sheet.png")
    print(OUT / "sheet.png")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assets", type=Path, required=True, help="folder of the glTF files")
    parser.add_argument("--env", type=Path, required=True, help="equirectangular .hdr or .exr")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--size", default="384x288")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"files in the folder [{' '.join(DEFAULT)}]")
    args = parser.parse_args()
    args.width, args.height = (int(n) for n in args.size.split("x"))
    return args


def import_and_frame(bpy, source, view, args):
    """Blender's scene with the file, the camera and the environment; returns the camera in glTF's axes."""
    from mathutils import Vector

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.import_scene.gltf(filepath=str(source))
    scene = bpy.context.scene
    corners = [o.matrix_world @ Vector(c) for o in scene.objects if o.type == "MESH" for c in o.bound_box]
    low, high = (Vector([f(c[i] for c in corners) for i in range(3)]) for f in (min, max))
    center, radius = (low + high) / 2, (high - low).length / 2
    (x, y, z), fill = view
    away = Vector((x, -z, y)).normalized()
    position = center + away * (radius * fill / math.sin(math.radians(VIEW_ANGLE) / 2))

    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(VIEW_ANGLE)
    camera.clip_start, camera.clip_end = 1e-4 * radius, 1e4 * radius
    eye = bpy.data.objects.new("camera", camera)
    eye.location = position
    eye.rotation_euler = (-away).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(eye)
    scene.camera = eye

    for_cycles.surround(bpy, scene, args.env)
    return [(v.x, v.z, -v.y) for v in (position, center)]


def radianza(bpy, source, folder, camera, args):
    """The file in Radianza, as an array of linear RGB."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    files = source.parent.iterdir() if source.suffix == ".gltf" else [source]
    for file in [*files, args.env]:
        shutil.copyfile(file, folder / file.name)
    position, target = camera
    (folder / "scene.toml").write_text(
        f"[camera]\nposition = {list(position)}\ntarget = {list(target)}\nview_angle = {VIEW_ANGLE}\n\n"
        f'[environment]\nfile = "{args.env.name}"\n\n[[shape]]\ntype = "file"\nfile = "{source.name}"\n'
    )
    out = folder / "radianza.exr"
    command = [RADIANZA, "render", folder / "scene.toml", "-q", "--filter", "box", "--layers", "beauty"]
    command += ["--spp", str(args.spp), "--size", args.size, "-o", out, "--png", folder / "radianza.png"]
    subprocess.run([str(c) for c in command], check=True)
    return pixels(bpy, out)


def cycles(bpy, folder, args):
    """Blender's scene in Cycles, as an array of linear RGB."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    c = scene.cycles
    c.samples, c.use_adaptive_sampling, c.use_denoising = args.spp, False, False
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = c.transparent_max_bounces = 1024
    c.sample_clamp_direct = c.sample_clamp_indirect = c.blur_glossy = 0.0
    c.caustics_reflective = c.caustics_refractive = True
    c.pixel_filter_type = "BOX"
    c.filter_width = 1.0
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = args.width, args.height, 100
    scene.render.film_transparent = False
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(folder / "cycles.exr")
    bpy.ops.render.render(write_still=True)
    return pixels(bpy, folder / "cycles.exr")


def pixels(bpy, path):
    import numpy as np

    image = bpy.data.images.load(str(path), check_existing=False)
    image.colorspace_settings.name = "Linear Rec.709"
    width, height = image.size
    values = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)[::-1, :, :3]


def luminance(image):
    return image @ [0.2126, 0.7152, 0.0722]


def blurred(image):
    """Means of 4x4 pixels: less noise, the same differences."""
    height, width = (n // 4 * 4 for n in image.shape)
    return image[:height, :width].reshape(height // 4, 4, width // 4, 4).mean(axis=(1, 3))


def ratio(ours, theirs):
    """log2 of theirs over ours."""
    import numpy as np

    return np.log2(np.maximum(theirs, 1e-4) / np.maximum(ours, 1e-4))


def report(name, ours, theirs):
    import numpy as np

    a, b = (blurred(luminance(x)) for x in (ours, theirs))
    stops = np.abs(ratio(a, b))
    shares = [100 * (stops < s).mean() for s in (math.log2(1.05), math.log2(1.25), 1)]
    figures = f"{a.mean():9.4f} {b.mean():9.4f} {b.mean() / a.mean():6.3f}"
    print(f"{name:32} {figures}  " + " / ".join(f"{s:.0f} %" for s in shares), flush=True)


def sheet(rows, path):
    import numpy as np
    from PIL import Image, ImageDraw

    def screen(image, exposure):
        # Reinhard's curve, white at 4.
        x = np.clip(image * exposure, 0, None)
        x = x * (1 + x / 16) / (1 + x)
        x = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.clip(x, 1e-9, None) ** (1 / 2.4) - 0.055)
        return (np.clip(x, 0, 1) * 255).astype(np.uint8)

    def stops(ours, theirs):
        d = np.clip(ratio(*(blurred(luminance(x)) for x in (ours, theirs))), -1, 1)
        rgb = np.stack([1 + np.minimum(d, 0), 1 - np.abs(d), 1 - np.maximum(d, 0)], axis=-1)
        return (rgb * 255).astype(np.uint8).repeat(4, axis=0).repeat(4, axis=1)

    height, width, _ = rows[0][1].shape
    strip = 14
    out = Image.new("RGB", (3 * width, len(rows) * (height + strip)), "white")
    draw = ImageDraw.Draw(out)
    for i, (name, ours, theirs) in enumerate(rows):
        top = i * (height + strip)
        exposure = 0.3 / float(np.exp(np.log(np.maximum(luminance(ours), 1e-4)).mean()))
        draw.text((4, top + 1), f"{name}: Radianza, Cycles, log2(Cycles / Radianza)", fill="black")
        for j, image in enumerate([screen(ours, exposure), screen(theirs, exposure), stops(ours, theirs)]):
            out.paste(Image.fromarray(image), (j * width, top + strip))
    out.save(path)


if __name__ == "__main__":
    main()
