"""Renders a scene with Mitsuba 3: SCENE OUTPUT SAMPLES SEED THREADS.

At most 256 samples go into one pass, for Mitsuba adds up in single precision. Fewer than four are drawn independently:
at two, multijitter is biased (a Cornell box is 0.2 % to 0.6 % too bright), and there is nothing to stratify yet. The back
end is `scalar_rgb`, which runs everywhere; MITSUBA_VARIANT=llvm_ad_rgb is four times as fast where there is an LLVM that
it works with.
"""

import os
import time

import drjit
import mitsuba
import numpy

import furnace_scene as furnace

path, output, samples, seed, threads = furnace.arguments()
mitsuba.set_variant(os.environ.get("MITSUBA_VARIANT", "scalar_rgb"))
if samples < 4:
    with open(path, encoding="utf-8") as described:
        text = described.read().replace('type="multijitter"', 'type="independent"')
    path = os.path.join(os.path.dirname(path), "independent.xml")
    with open(path, "w", encoding="utf-8") as described:
        described.write(text)
scene = mitsuba.load_file(path)
# Not before: with one thread Mitsuba waits for ever to read an EXR, as a sky is.
drjit.set_thread_count(threads)
total, done, number = 0, 0, 0
while done < samples:
    # Multijitter wants a number that has two factors of about one size; it takes the next one, and says so.
    now = min(256, samples - done)
    image = mitsuba.render(scene, spp=now, seed=seed + number)
    total = total + now * numpy.array(image, dtype=float)
    done, number = done + now, number + 1
furnace.write_pfm(output, total / samples)
print("seconds", time.process_time())
