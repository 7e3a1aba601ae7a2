#!/usr/bin/env python3
"""The Cornell box in Radianza and in Mitsuba 3, side by side in one run.

Needs Mitsuba (pip install mitsuba; its llvm variants need libLLVM 19 or newer) and a release build of Radianza.

    python3 benches/peers/cornell.py [--spp 64] [--repeat 3] [--reference-spp 16384] [--size 512]

Same geometry (read from scenes/cornell-box.toml), box filter, independent or stratified samples as named, at most seven reflections
(Mitsuba calls that max_depth 8), as many threads as there are cores. Contenders take turns; the table holds the median of each
figure. relMSE = mean((x - r)^2 / (r^2 + 0.01)) against a reference that is rendered once with Mitsuba and kept in target/peers.
Seconds are wall-clock seconds of rendering alone: without start-up, scene loading and just-in-time compilation. CPU seconds
beside them show whether the machine was busy with something else: on an idle one they are wall seconds times cores.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "target" / "peers"
SCENE = ROOT / "scenes" / "cornell-box.toml"
MAX_REFLECTIONS = 7


def mitsuba_scene(mi, size, spp, sampler):
    """scenes/cornell-box.toml as a Mitsuba dictionary."""
    from math import atan, degrees, radians, tan

    import numpy as np

    desc = tomllib.loads(SCENE.read_text())
    camera = desc["camera"]
    up = camera.get("up", [0, 1, 0])
    fov = camera.get("horizontal_view_angle")
    if fov is None:
        width, height = camera["resolution"]
        fov = degrees(2 * atan(tan(radians(camera["view_angle"]) / 2) * width / height))
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": MAX_REFLECTIONS + 1},
        "sensor": {
            "type": "perspective",
            "fov": fov,
            "fov_axis": "x",
            "to_world": mi.ScalarTransform4f().look_at(origin=camera["position"], target=camera["target"], up=up),
            "film": {
                "type": "hdrfilm",
                "width": size,
                "height": size,
                "rfilter": {"type": "box"},
                "pixel_format": "rgb",
                "component_format": "float32",
            },
            "sampler": {"type": sampler, "sample_count": spp},
        },
    }

    def rgb(value):
        return {"type": "rgb", "value": value if isinstance(value, list) else [value] * 3}

    for name, material in desc["material"].items():
        if material["type"] != "diffuse":
            sys.exit(f"{SCENE}: this script knows diffuse materials only, not `{material['type']}`")
        diffuse = {"type": "diffuse", "reflectance": rgb(material["reflectance"])}
        scene[f"material-{name}"] = {"type": "twosided", "id": name, "bsdf": diffuse}

    for i, shape in enumerate(desc["shape"]):
        positions, triangles = triangles_of(shape)
        props = mi.Properties()
        mesh = mi.Mesh(f"shape-{i}", len(positions), len(triangles), props=props)
        params = mi.traverse(mesh)
        params["vertex_positions"] = np.asarray(positions, dtype=np.float32).ravel()
        params["faces"] = np.asarray(triangles, dtype=np.uint32).ravel()
        params.update()
        path = OUT / f"cornell-{i}.ply"
        mesh.write_ply(str(path))
        entry = {"type": "ply", "filename": str(path), "face_normals": True}
        if "material" in shape:
            entry["bsdf"] = {"type": "ref", "id": shape["material"]}
        if "emission" in shape:
            entry["emitter"] = {"type": "area", "radiance": rgb(shape["emission"])}
        scene[f"shape-{i}"] = entry
    return mi.load_dict(scene)


def triangles_of(shape):
    if shape["type"] == "mesh":
        return shape["positions"], shape["indices"]
    if shape["type"] == "quad":
        if "vertices" in shape:
            return shape["vertices"], [[0, 1, 2], [0, 2, 3]]
        c, u, v = shape["corner"], shape["edge_u"], shape["edge_v"]
        add = lambda *xs: [sum(t) for t in zip(*xs)]
        return [c, add(c, u), add(c, u, v), add(c, v)], [[0, 1, 2], [0, 2, 3]]
    sys.exit(f"{SCENE}: this script knows meshes and quads only, not `{shape['type']}`")


def worker(args):
    """Renders with one Mitsuba variant in a process of its own and prints the figures as JSON."""
    import time

    import mitsuba as mi

    mi.set_variant(args.variant)
    import numpy as np

    OUT.mkdir(parents=True, exist_ok=True)
    scene = mitsuba_scene(mi, args.size, args.spp, args.sampler)
    render = lambda seed: np.array(mi.render(scene, spp=args.spp, seed=seed))
    if args.passes > 1:
        total = sum(render(seed).astype(np.float64) for seed in range(1, args.passes + 1))
        image = (total / args.passes).astype(np.float32)
        mi.Bitmap(image).write(args.worker)
        return
    if args.variant != "scalar_rgb":
        render(99)  # just-in-time compilation
    wall, cpu = time.perf_counter(), time.process_time()
    image = render(args.seed)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    mi.Bitmap(image).write(args.worker)
    print(json.dumps({"seconds": wall, "cpu": cpu}))


def run_mitsuba(variant, sampler, args, seed, passes=1, spp=None, path=None):
    path = path or OUT / f"{variant}-{sampler}.exr"
    command = [sys.executable, __file__, "--worker", path, "--variant", variant, "--sampler", sampler, "--size", args.size]
    command += ["--spp", spp or args.spp, "--seed", seed, "--passes", passes]
    done = subprocess.run([str(c) for c in command], check=True, stdout=subprocess.PIPE, text=True)
    return path, json.loads(done.stdout.splitlines()[-1]) if passes == 1 else None


def run_radianza(sampler, args, seed):
    path = OUT / f"radianza-{sampler}.exr"
    command = [args.radianza, "render", SCENE, "-o", path, "--spp", args.spp, "--size", f"{args.size}x{args.size}"]
    command += ["--max-depth", MAX_REFLECTIONS, "--filter", "box", "--sampler", sampler, "--seed", seed, "--layers", "beauty"]
    before = os.times()
    done = subprocess.run([str(c) for c in command], check=True, stderr=subprocess.PIPE, text=True)
    after = os.times()
    seconds = re.search(r"samples each, in ([0-9.]+) s", done.stderr)
    if not seconds:
        sys.exit(f"radianza did not say how long it took:\n{done.stderr}")
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return path, {"seconds": float(seconds[1]), "cpu": cpu}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--reference-spp", type=int, default=16384)
    parser.add_argument("--radianza", default=ROOT / "target" / "release" / "radianza")
    for hidden, kind, default in [
        ("--worker", str, None),
        ("--variant", str, None),
        ("--sampler", str, "independent"),
        ("--seed", int, 1),
        ("--passes", int, 1),
    ]:
        parser.add_argument(hidden, type=kind, default=default, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.worker:
        return worker(args)

    import mitsuba as mi
    import numpy as np

    mi.set_variant("scalar_rgb")

    def pixels(path):
        for name, bitmap in mi.Bitmap(str(path)).split():
            if name in ("<root>", ""):
                bitmap = bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
                return np.array(bitmap).astype(np.float64)
        sys.exit(f"{path}: no R, G, B channels")

    # The reference: many independent passes.
    OUT.mkdir(parents=True, exist_ok=True)
    reference = OUT / f"reference-{args.size}-{args.reference_spp}.exr"
    if not reference.exists():
        print(f"rendering the reference, {args.reference_spp} samples per pixel", file=sys.stderr)
        per_pass = min(256, args.reference_spp)
        passes = args.reference_spp // per_pass
        run_mitsuba("llvm_ad_rgb", "independent", args, 0, max(passes, 2), per_pass, reference)
    r = pixels(reference)

    contenders = {
        "Radianza, independent": lambda seed: run_radianza("independent", args, seed),
        "Radianza, sobol": lambda seed: run_radianza("sobol", args, seed),
        "Mitsuba scalar_rgb, independent": lambda seed: run_mitsuba("scalar_rgb", "independent", args, seed),
        "Mitsuba llvm_ad_rgb, independent": lambda seed: run_mitsuba("llvm_ad_rgb", "independent", args, seed),
        "Mitsuba llvm_ad_rgb, multijitter": lambda seed: run_mitsuba("llvm_ad_rgb", "multijitter", args, seed),
    }
    samples = args.size * args.size * args.spp
    rows = {name: [] for name in contenders}
    for seed in range(1, args.repeat + 1):
        for name, run in contenders.items():
            path, figures = run(seed)
            x = pixels(path)
            figures["relmse"] = float(np.mean((x - r) ** 2 / (r**2 + 0.01)))
            figures["bias"] = float(np.mean(x) / np.mean(r) - 1)
            rows[name].append(figures)
            print(f"{name}: {figures}, load {os.getloadavg()[0]:.2f}", file=sys.stderr)

    print("| renderer | Msamples/s | CPU s | relMSE | 1/(relMSE s) | mean / reference - 1 |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name, runs in rows.items():
        median = lambda key: statistics.median(run[key] for run in runs)
        seconds, relmse = median("seconds"), median("relmse")
        print(
            f"| {name} | {samples / seconds / 1e6:.2f} | {median('cpu'):.1f} | {relmse:.2e} "
            f"| {1 / (relmse * seconds):.1f} | {median('bias'):+.1e} |"
        )


if __name__ == "__main__":
    main()
