"""Renders passes of a scene with Mitsuba, one file of raw little-endian f32 for each seed.

    python - SCENE VARIANT SAMPLES FOLDER BOUNCES SEED...

BOUNCES is `together`, or the last: then a file `bounces-SEED.f32` holds each bounce alone, one below the other. LLVM's
back end draws the same paths whatever the last bounce is, so that the difference of two pictures is one bounce.

A file appears under its name only when it is whole, so that a run which was killed can go on. What is said on
standard output is read by `furnace`: `version V` first, `pass SEED` after each file, `cpu SECONDS` at the end.
"""

import os
import sys
import time

import mitsuba
import numpy

scene_file, variant, samples, folder, bounces, *seeds = sys.argv[1:]
mitsuba.set_variant(variant)
print("version", mitsuba.__version__, flush=True)
scene = mitsuba.load_file(scene_file)


def together(seed):
    return numpy.array(mitsuba.render(scene, spp=int(samples), seed=seed))


def apart(seed):
    alone, before = [], 0
    for integrator in integrators:
        image = mitsuba.render(scene, integrator=integrator, spp=int(samples), seed=seed)
        up_to_here = numpy.array(image, dtype=numpy.float64)
        alone.append(up_to_here - before)
        before = up_to_here
    lowest, rounding = min(bounce.min() for bounce in alone), 1e-5 * before.max()
    if lowest < -rounding:
        sys.exit(f"the paths of seed {seed} differ between depths: a bounce has {lowest} of light somewhere")
    return numpy.maximum(numpy.concatenate(alone), 0)


render, content = together, "pass"
if bounces != "together":
    render, content = apart, "bounces"
    depths = range(1, int(bounces) + 2)
    kinds = [{"type": "path", "max_depth": depth, "rr_depth": 1_000_000} for depth in depths]
    integrators = [mitsuba.load_dict(kind) for kind in kinds]
for seed in seeds:
    path = os.path.join(folder, f"{content}-{seed}.f32")
    render(int(seed)).astype("<f4").tofile(path + ".tmp")
    os.replace(path + ".tmp", path)
    print("pass", seed, flush=True)
print("cpu", time.process_time(), flush=True)
