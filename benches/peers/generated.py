"""Scenes that are too large to ship: written into a folder, the same on every machine."""

import json
import math
import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SKY = ROOT / "scenes" / "textures" / "sky.hdr"


def many_lights(folder):
    """A hall lit by a thousand small spheres of all colours, a fifth of them bright, with forty boxes in the way."""
    import numpy as np

    rng = np.random.default_rng(1)
    lines = ["[camera]", "position = [0, 2.2, 13]", "target = [0, 1.4, 0]", "view_angle = 46", "resolution = [256, 256]", ""]
    for name, color in {"wall": [0.7, 0.68, 0.64], "floor": [0.42, 0.4, 0.36], "box": [0.6, 0.5, 0.42]}.items():
        lines += [f"[material.{name}]", 'type = "diffuse"', f"reflectance = {color}", ""]

    def shape(kind, **keys):
        lines.extend(["[[shape]]", f'type = "{kind}"'])
        lines.extend(f"{key} = {json.dumps(value)}" for key, value in keys.items())
        lines.append("")

    shape("quad", material="floor", corner=[-10, 0, 14], edge_u=[20, 0, 0], edge_v=[0, 0, -28])
    shape("quad", material="wall", corner=[-10, 6, -14], edge_u=[20, 0, 0], edge_v=[0, 0, 28])
    shape("quad", material="wall", corner=[-10, 0, -14], edge_u=[20, 0, 0], edge_v=[0, 6, 0])
    shape("quad", material="wall", corner=[-10, 0, 14], edge_u=[0, 0, -28], edge_v=[0, 6, 0])
    shape("quad", material="wall", corner=[10, 0, -14], edge_u=[0, 0, 28], edge_v=[0, 6, 0])
    for _ in range(40):
        x, z = rng.uniform(-8.5, 8.5), rng.uniform(-12, 6)
        w, h = rng.uniform(0.3, 0.9), rng.uniform(0.4, 2.2)
        shape("box", material="box", min=[round(x - w, 4), 0, round(z - w, 4)], max=[round(x + w, 4), round(h, 4), round(z + w, 4)])
    for _ in range(1000):
        at = [round(float(v), 4) for v in (rng.uniform(-9.7, 9.7), rng.uniform(2.6, 5.8), rng.uniform(-13.5, 10))]
        power = 10.0 ** rng.uniform(0, 1) * (6 if rng.random() < 0.2 else 1)
        color = [round(float(power * c), 3) for c in rng.uniform(0.3, 1.0, 3)]
        shape("sphere", radius=0.04, center=at, emission=color)
    return write(folder, "many-lights", lines)


def terrain(folder):
    """A million triangles of mountains under the sky of scenes/outdoor.toml."""
    import numpy as np

    n = 708
    rng = np.random.default_rng(2)
    axis = np.linspace(-1, 1, n)
    x, z = np.meshgrid(axis, axis)
    height = np.zeros_like(x)
    for octave in range(9):
        for _ in range(6):
            angle, phase = rng.uniform(0, 2 * math.pi, 2)
            f = 2.0 * 1.9**octave
            height += 0.16 * 0.52**octave * np.sin(f * (x * math.cos(angle) + z * math.sin(angle)) + phase)
    points = np.stack([20 * x, 4 * height, 20 * z], axis=-1).reshape(-1, 3)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.concatenate([np.stack([i, i + n, i + 1], -1), np.stack([i + 1, i + n, i + n + 1], -1)])
    folder.mkdir(parents=True, exist_ok=True)
    write_ply(folder / "terrain.ply", points, triangles)
    shutil.copyfile(SKY, folder / "sky.hdr")
    top = float(points[:, 1].max())
    lines = ["[camera]", f"position = [14, {top + 1.5:.4f}, 15]", "target = [0, 0.5, 0]", "view_angle = 45", "resolution = [256, 256]", ""]
    lines += ["[environment]", 'file = "sky.hdr"', "", "[material.rock]", 'type = "diffuse"', "reflectance = [0.45, 0.4, 0.34]", ""]
    lines += ["[[shape]]", 'type = "file"', 'file = "terrain.ply"', 'material = "rock"', ""]
    return write(folder, "terrain", lines)


def forest(folder):
    """Five hundred places of one tree of 21,000 triangles: ten million as placed. (Of four times as many Mitsuba's llvm variants make
    code for minutes.)"""
    import numpy as np

    rng = np.random.default_rng(3)
    # A trunk, and leaves on a crown: quads of random directions.
    ring = np.linspace(0, 2 * math.pi, 17)[:-1]
    levels = np.linspace(0, 1, 33)
    trunk = np.array([[(0.16 - 0.13 * t) * math.cos(a), 3.4 * t, (0.16 - 0.13 * t) * math.sin(a)] for t in levels for a in ring])
    a, b = np.arange(16), (np.arange(16) + 1) % 16
    rows = [16 * k for k in range(32)]
    bark = np.concatenate([np.concatenate([np.stack([r + a, r + 16 + a, r + b], -1), np.stack([r + b, r + 16 + a, r + 16 + b], -1)]) for r in rows])
    count = 10_000
    direction = rng.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    center = direction * (rng.uniform(0.3, 1, (count, 1)) ** (1 / 3)) * [1.3, 1.5, 1.3] + [0, 3.2, 0]
    u = rng.normal(size=(count, 3))
    u *= 0.07 / np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(u, rng.normal(size=(count, 3)))
    v *= 0.045 / np.linalg.norm(v, axis=1, keepdims=True)
    leaves = np.stack([center - u - v, center + u - v, center + u + v, center - u + v], 1).reshape(-1, 3)
    k = 4 * np.arange(count)[:, None]
    foliage = np.concatenate([k + [0, 1, 2], k + [0, 2, 3]])

    parts = [("bark", trunk, bark, [0.2, 0.14, 0.09]), ("leaves", leaves, foliage, [0.22, 0.36, 0.1])]
    data, views, accessors, primitives = b"", [], [], []
    for _, points, triangles, _ in parts:
        for array, target, kind, component in ((points.astype("<f4"), 34962, "VEC3", 5126), (triangles.astype("<u4").ravel(), 34963, "SCALAR", 5125)):
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes, "target": target})
            accessor = {"bufferView": len(views) - 1, "componentType": component, "type": kind, "count": len(array)}
            if kind == "VEC3":
                accessor |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
            accessors.append(accessor)
            data += array.tobytes()
        at = len(accessors)
        primitives.append({"attributes": {"POSITION": at - 2}, "indices": at - 1, "material": len(primitives)})
    diffuse = lambda c: {"pbrMetallicRoughness": {"baseColorFactor": [*c, 1], "metallicFactor": 0}, "doubleSided": True}
    materials = [{"name": name, **diffuse(color), "extensions": {"KHR_materials_specular": {"specularFactor": 0}}} for name, _, _, color in parts]
    nodes = []
    for _ in range(500):
        (px, pz), turn, size = rng.uniform(-20, 20, 2) + [0, 6], rng.uniform(0, 2 * math.pi), rng.uniform(0.7, 1.4)
        rotation = [0, math.sin(turn / 2), 0, math.cos(turn / 2)]
        nodes.append({"mesh": 0, "translation": [px, 0, pz], "rotation": rotation, "scale": [size] * 3})
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "forest.bin").write_bytes(data)
    gltf = {"asset": {"version": "2.0"}, "buffers": [{"uri": "forest.bin", "byteLength": len(data)}], "bufferViews": views}
    gltf |= {"accessors": accessors, "materials": materials, "meshes": [{"primitives": primitives}], "nodes": nodes}
    gltf |= {"scenes": [{"nodes": list(range(len(nodes)))}], "scene": 0, "extensionsUsed": ["KHR_materials_specular"]}
    (folder / "forest.gltf").write_text(json.dumps(gltf))
    shutil.copyfile(SKY, folder / "sky.hdr")
    lines = ["[camera]", "position = [0, 7, 46]", "target = [0, 2.4, 20]", "view_angle = 45", "resolution = [256, 256]", ""]
    lines += ["[environment]", 'file = "sky.hdr"', "", "[material.ground]", 'type = "diffuse"', "reflectance = [0.2, 0.17, 0.12]", ""]
    lines += ["[[shape]]", 'type = "disk"', "radius = 200", "normal = [0, 1, 0]", 'material = "ground"', ""]
    lines += ["[[shape]]", 'type = "file"', 'file = "forest.gltf"', ""]
    return write(folder, "forest", lines)


def write_ply(path, points, triangles):
    import numpy as np

    faces = np.empty(len(triangles), dtype=[("n", "u1"), ("v", "<u4", 3)])
    faces["n"], faces["v"] = 3, triangles
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "property float x\nproperty float y\nproperty float z\n"
    header += f"element face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n"
    path.write_bytes(header.encode() + points.astype("<f4").tobytes() + faces.tobytes())


def write(folder, name, lines):
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.toml"
    path.write_text("\n".join(lines))
    return path
