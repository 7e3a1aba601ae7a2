#!/usr/bin/env python3
"""Error per second on six scenes, beside Mitsuba 3, Blender's Cycles and pbrt-v4.

Needs a release build of Radianza and Mitsuba (pip install mitsuba numpy; its llvm variants need libLLVM 19 or newer, which
DRJIT_LIBLLVM_PATH may name: Rust's own toolchain brings one). Cycles takes part where Blender is installed as a Python module
(pip install bpy; bpy 5.0 wants Python 3.11), pbrt where it is on PATH. Peers that are not there are left out.

    python3 benches/peers/efficiency.py [--spp 64] [--runs 4] [--only SCENE ...] [--without PEER ...]

Every scene is a scene file of ours, shipped or generated here into target/peers. `radianza export` writes it for Mitsuba and pbrt;
Cycles gets what Mitsuba gets, read from the same XML. All take the same number of samples with a box filter on all cores, and follow
paths as long as they may (in the Cornell box: at most seven reflections).

Error is variance: with RUNS runs of different seeds, relMSE = mean(s^2 / (m^2 + 0.01)), where m and s^2 are mean and sample variance of
a pixel over the runs. It needs no reference, and no contender is measured against another's picture; the means of the pictures, in the
last column against ours, show that all solve the same problem, or by how much they do not.

Seconds are those of rendering alone: Radianza's and Mitsuba's without start-up, loading and just-in-time compilation; of Cycles and
pbrt, which cannot tell, the time of one sample per pixel is taken off. Contenders take turns, the table holds medians.
"""

import argparse
import importlib.util
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "target" / "peers"
SIZES = {"cornell-box": (512, 512), "glass-caustics": (384, 256), "interior": (384, 256)}
MAX_DEPTH = {"cornell-box": 7}


def scene_file(name):
    """The scene in our format; generated where none is shipped."""
    import generated

    make = {"many-lights": generated.many_lights, "terrain": generated.terrain, "forest": generated.forest}
    return make[name](OUT / "scenes") if name in make else ROOT / "scenes" / f"{name}.toml"


class Radianza:
    def __init__(self, sampler, one_replicate=False):
        self.options = ["--sampler", sampler]
        self.one_replicate = one_replicate

    def render(self, scene, args, seed, out):
        replicate = ["--replicate", args.spp] if self.one_replicate else []
        command = [args.radianza, "render", scene.ours, "-o", out, "--spp", args.spp, "--size", scene.size, "--seed", seed]
        command += ["--filter", "box", "--layers", "beauty", *self.options, *replicate, *scene.depth()]
        text = run(command).stderr
        # Before the last line stand how far it was and how fast so far.
        speeds = re.findall(r"([0-9.]+) Msamples/s", text)
        if not speeds:
            sys.exit(f"radianza did not say how fast it was:\n{text}")
        return scene.samples(args.spp) / 1e6 / float(speeds[-1])


class Worker:
    """A peer in Python: a process of its own a run."""

    def __init__(self, kind, *options):
        self.kind, self.options = kind, options

    def render(self, scene, args, seed, out):
        what = {"kind": self.kind, "options": self.options, "xml": str(scene.xml), "spp": args.spp, "seed": seed}
        what |= {"out": str(out), "depth": MAX_DEPTH.get(scene.name)}
        text = run([sys.executable, __file__, "--worker", json.dumps(what)]).stdout
        return json.loads(text.splitlines()[-1])["seconds"]


class Pbrt:
    def render(self, scene, args, seed, out):
        path = scene.xml.with_suffix(".pbrt")

        def seconds(spp):
            begin = time.perf_counter()
            run(["pbrt", "--quiet", "--spp", spp, "--seed", seed, "--outfile", out, path])
            return time.perf_counter() - begin

        one = seconds(1)
        return (seconds(args.spp) - one) * args.spp / (args.spp - 1)


def run(command):
    done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{done.stdout[-1500:]}{done.stderr[-3000:]}")
    return done


class Scene:
    def __init__(self, name, args):
        self.name, self.ours = name, scene_file(name)
        width, height = SIZES.get(name, (256, 256))
        self.pixels, self.size = width * height, f"{width}x{height}"
        self.xml = OUT / "scenes" / f"{name}.xml"
        for suffix in (".xml", ".pbrt"):
            options = ["--size", self.size, "--spp", args.spp, "--filter", "box", *self.depth()]
            run([args.radianza, "export", self.ours, "-o", self.xml.with_suffix(suffix), *options])

    def samples(self, spp):
        return self.pixels * spp

    def depth(self):
        return ["--max-depth", MAX_DEPTH[self.name]] if self.name in MAX_DEPTH else []


def mitsuba(what):
    """Renders with one variant and sampler."""
    import mitsuba as mi

    variant, sampler = what["options"]
    mi.set_variant(variant)
    import numpy as np

    xml = Path(what["xml"])
    copy = xml.with_name(f"{xml.stem}-{variant}-{sampler}.xml")
    copy.write_text(xml.read_text().replace('<sampler type="independent">', f'<sampler type="{sampler}">'))
    scene = mi.load_file(str(copy))
    render = lambda seed: np.array(mi.render(scene, spp=what["spp"], seed=seed))
    if variant != "scalar_rgb":
        render(10_000 + what["seed"])  # just-in-time compilation
    begin = time.perf_counter()
    image = render(what["seed"])
    seconds = time.perf_counter() - begin
    mi.Bitmap(image[..., :3]).write(what["out"])
    return seconds


def cycles(what):
    import for_cycles

    bpy = for_cycles.load(Path(what["xml"]), what["depth"])
    scene = bpy.context.scene
    scene.cycles.seed = what["seed"]
    scene.render.filepath = what["out"]

    def seconds(spp):
        scene.cycles.samples = spp
        begin = time.perf_counter()
        bpy.ops.render.render(write_still=True)
        return time.perf_counter() - begin

    one = seconds(1)
    return (seconds(what["spp"]) - one) * what["spp"] / (what["spp"] - 1)


def contenders(args):
    have = lambda module: importlib.util.find_spec(module) is not None
    all_of_them = {
        "Radianza, lattice": Radianza("lattice"),
        "Radianza, lattice in one replicate": Radianza("lattice", one_replicate=True),
        "Radianza, sobol in one replicate": Radianza("sobol", one_replicate=True),
        "Radianza, independent": Radianza("independent"),
        "Mitsuba llvm_ad_rgb, multijitter": Worker("mitsuba", "llvm_ad_rgb", "multijitter"),
        "Mitsuba llvm_ad_rgb, independent": Worker("mitsuba", "llvm_ad_rgb", "independent"),
        "Mitsuba scalar_rgb, multijitter": Worker("mitsuba", "scalar_rgb", "multijitter"),
    }
    if have("bpy"):
        all_of_them["Cycles"] = Worker("cycles")
    if shutil.which("pbrt"):
        all_of_them["pbrt-v4"] = Pbrt()
    return {name: c for name, c in all_of_them.items() if not any(w in name for w in args.without)}


def measure(scene, args):
    import for_cycles
    import mitsuba as mi
    import numpy as np

    mi.set_variant("scalar_rgb")

    def pixels(path):
        bitmap = mi.Bitmap(str(path))
        for name, part in bitmap.split():
            if name in ("<root>", ""):
                bitmap = part
        return np.array(bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)).astype(np.float64)

    rows = {}
    for seed in range(1, args.runs + 1):
        for name, contender in contenders(args).items():
            if name == "Cycles" and (reason := for_cycles.unknown(scene.xml)):
                if seed == 1:
                    print(f"{scene.name}: not for Cycles: {reason}", file=sys.stderr)
                continue
            out = OUT / "pictures" / f"{scene.name}-{re.sub('[^a-z0-9]+', '-', name.lower())}.exr"
            out.parent.mkdir(parents=True, exist_ok=True)
            seconds = contender.render(scene, args, seed, out)
            rows.setdefault(name, []).append((seconds, pixels(out)))
            print(f"{scene.name}, {name}, {seed}: {seconds:.2f} s, load {os.getloadavg()[0]:.2f}", file=sys.stderr)

    print(f"\n{scene.name}, {scene.size}, {args.spp} samples\n")
    print("| renderer | Msamples/s | relMSE | 1/(relMSE s) | mean / ours |")
    print("| --- | --- | --- | --- | --- |")
    ours = None
    for name, runs in rows.items():
        seconds = statistics.median(s for s, _ in runs)
        stack = np.stack([x for _, x in runs])
        mean, variance = stack.mean(axis=0), stack.var(axis=0, ddof=1)
        relmse = float(np.mean(variance / (mean**2 + 0.01)))
        ours = ours or float(mean.mean())
        speed = scene.samples(args.spp) / 1e6 / seconds
        print(f"| {name} | {speed:.2f} | {relmse:.2e} | {1 / (relmse * seconds):.1f} | {mean.mean() / ours:.4f} |", flush=True)


def main():
    names = ["cornell-box", "many-lights", "glass-caustics", "interior", "terrain", "forest"]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--runs", type=int, default=4)
    parser.add_argument("--only", nargs="*", choices=names, default=names, metavar="SCENE")
    parser.add_argument("--without", nargs="*", default=[], metavar="PEER", help="leave out who has this in the name")
    parser.add_argument("--radianza", default=ROOT / "target" / "release" / "radianza")
    parser.add_argument("--worker", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.worker:
        what = json.loads(args.worker)
        sys.argv = sys.argv[:1]
        seconds = {"mitsuba": mitsuba, "cycles": cycles}[what["kind"]](what)
        print(f"\n{json.dumps({'seconds': seconds})}")
        return
    if args.runs < 2:
        sys.exit("a variance takes two runs or more")
    for name in args.only:
        measure(Scene(name, args), args)


if __name__ == "__main__":
    main()
