"""Renders a scene with Mitsuba 3: SCENE OUTPUT SAMPLES SEED THREADS.

At most 256 samples go into one pass, for Mitsuba adds up in single precision. The back end is `scalar_rgb`, which runs
everywhere; MITSUBA_VARIANT=llvm_ad_rgb is four times as fast where there is an LLVM that it works with.
"""

import os
import time

import drjit
import mitsuba
import numpy

import furnace_scene as furnace

path, output, samples, seed, threads = furnace.arguments()
mitsuba.set_variant(os.environ.get("MITSUBA_VARIANT", "scalar_rgb"))
drjit.set_thread_count(threads)
scene = mitsuba.load_file(path)
total, done, number = 0, 0, 0
while done < samples:
    # Multijitter wants a number that has two factors of about one size; it takes the next one, and says so.
    now = min(256, samples - done)
    image = mitsuba.render(scene, spp=now, seed=seed + number)
    total = total + now * numpy.array(image, dtype=float)
    done, number = done + now, number + 1
furnace.write_pfm(output, total / samples)
print("seconds", time.process_time())
