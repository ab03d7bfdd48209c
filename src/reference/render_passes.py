"""Renders passes of a scene with Mitsuba, one file of raw little-endian f32 for each seed.

    python - SCENE VARIANT SAMPLES FOLDER SEED...

A file appears under its name only when it is whole, so that a run which was killed can go on. What is said on
standard output is read by `furnace`: `version V` first, `pass SEED` after each file, `cpu SECONDS` at the end.
"""

import os
import sys
import time

import mitsuba
import numpy

scene_file, variant, samples, folder, *seeds = sys.argv[1:]
mitsuba.set_variant(variant)
print("version", mitsuba.__version__, flush=True)
scene = mitsuba.load_file(scene_file)
for seed in seeds:
    image = mitsuba.render(scene, spp=int(samples), seed=int(seed))
    path = os.path.join(folder, f"pass-{seed}.f32")
    numpy.array(image, dtype="<f4").tofile(path + ".tmp")
    os.replace(path + ".tmp", path)
    print("pass", seed, flush=True)
print("cpu", time.process_time(), flush=True)
