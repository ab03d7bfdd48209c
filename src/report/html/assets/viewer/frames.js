// The images of a viewer, and what can be looked at: each of them, and the error of each render.

/** Unpacks the images that a figure carries. */
async function unpackFrames({ width, height, frames }) {
  return Promise.all(frames.map(async packed => {
    const frame = { ...packed, width, height, pixels: width * height };
    Object.assign(frame, await unpack(packed.image, frame.pixels));
    if (packed.noise) frame.noise = await unpack(packed.noise, frame.pixels);
    frame.mean = meanLuminance(frame);
    return frame;
  }));
}

function meanLuminance(frame) {
  let sum = 0, count = 0;
  for (let pixel = 0; pixel < frame.pixels; pixel++) {
    const value = luminance(pixelOf(frame, pixel));
    if (Number.isFinite(value)) { sum += value; count++; }
  }
  return count ? sum / count : 0;
}

/** What the keys 1, 2, 3 choose: the images, then the error of each render. */
function viewsOf(frames) {
  const renders = frames.flatMap((frame, index) => frame.role === 'render' ? [index] : []);
  const hasReference = frames.some(frame => frame.role === 'reference');
  const errors = hasReference ? renders : [];
  return [
    ...frames.map((frame, index) => ({ label: frame.label, frame: index, isError: false })),
    ...errors.map(index => ({ label: `error of ${frames[index].label}`, frame: index, isError: true })),
  ];
}

/** Whether exposure and tone curve apply to a frame; others are in false colour of a fixed scale. */
const isRadiance = frame => frame.kind === 'radiance';
