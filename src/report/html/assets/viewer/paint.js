// The stage: images, and over them what was chosen: outlines of rejected cells, numbers, the wipe, the selection.

/** Pixels this large carry their numbers, CSS pixels. */
const NUMBERS_FROM = 44;

function paint(viewer) {
  const { canvas, layers, state, views, stage } = viewer;
  const pen = canvas.getContext('2d');
  pen.clearRect(0, 0, canvas.width, canvas.height);
  for (const pane of stage.panes) {
    within(pen, pane, () => drawImage(viewer, pen, pane, layers.of(pane.view, state)));
    if (state.layout === 'wipe') wipe(viewer, pen, pane, layers.of(views[state.under], state));
    within(pen, pane, () => drawOver(viewer, pen, pane));
    drawInsets(viewer, pen, pane, layers.of(pane.view, state));
    drawLabel(viewer, pen, pane);
  }
}

/** Draws with nothing outside of a rectangle. */
function within(pen, { x, y, width, height }, draw) {
  pen.save();
  pen.beginPath();
  pen.rect(x, y, width, height);
  pen.clip();
  draw();
  pen.restore();
}

function drawImage(viewer, pen, pane, layer) {
  const [left, top] = toStage(viewer, pane, 0, 0);
  const { zoom } = cameraOf(viewer);
  pen.imageSmoothingEnabled = false;
  pen.drawImage(layer, left, top, layer.width * zoom, layer.height * zoom);
}

function wipe(viewer, pen, pane, layer) {
  const width = Math.round(pane.width * viewer.state.wipe);
  within(pen, { ...pane, width }, () => {
    pen.clearRect(pane.x, pane.y, width, pane.height);
    drawImage(viewer, pen, pane, layer);
  });
  pen.fillStyle = '#fff';
  pen.fillRect(pane.x + width - viewer.ratio, pane.y, 2 * viewer.ratio, pane.height);
}

function drawOver(viewer, pen, pane) {
  const { state, frames, ratio } = viewer;
  const frame = frames[pane.view.frame];
  outlineArea(viewer, pen, pane, rejectedAt(frame, state.cells));
  state.insets.forEach((inset, index) => outline(viewer, pen, pane, inset, INSET_COLOURS[index]));
  if (state.region) outline(viewer, pen, pane, state.region, '#fff');
  if (viewer.pointer) outline(viewer, pen, pane, [...viewer.pointer, 1, 1], '#fff');
  if (cameraOf(viewer).zoom >= NUMBERS_FROM * ratio) drawNumbers(viewer, pen, pane);
}

/** Of the outlines of insets, in their order: far from those of rejected cells. */
const INSET_COLOURS = ['#4cc9f0', '#ff8fd0', '#9be564'];

/** What is enlarged below a pane, in the same colours as above. */
function drawInsets(viewer, pen, pane, layer) {
  viewer.stage.boxes.forEach((box, index) => {
    const [left, top] = [pane.x + box.x, pane.y + pane.height + GAP * viewer.ratio];
    pen.imageSmoothingEnabled = false;
    pen.drawImage(layer, ...viewer.state.insets[index], left, top, box.width, box.height);
    const edge = new Path2D();
    edge.rect(left, top, box.width, box.height);
    stroke(viewer, pen, edge, INSET_COLOURS[index]);
  });
}

/** Where a scale rejects: cells of one component may stand where those of another do. */
function rejectedAt(frame, scale) {
  const extents = frame.rejected.filter(cell => cell.scale === scale).map(cell => cell.extent);
  return [...new Map(extents.map(extent => [String(extent), extent])).values()];
}

/** The border of all cells together: no line stands between two of them. */
function outlineArea(viewer, pen, pane, cells) {
  const corners = new Set(cells.map(([x, y]) => `${x} ${y}`));
  const area = new Path2D();
  for (const [x, y, width, height] of cells) {
    const [left, top] = toStage(viewer, pane, x, y);
    const [right, bottom] = toStage(viewer, pane, x + width, y + height);
    const edges = [
      [x - width, y, left, top, left, bottom], [x + width, y, right, top, right, bottom],
      [x, y - height, left, top, right, top], [x, y + height, left, bottom, right, bottom],
    ];
    for (const [besideX, besideY, fromX, fromY, toX, toY] of edges) {
      if (corners.has(`${besideX} ${besideY}`)) continue;
      area.moveTo(fromX, fromY);
      area.lineTo(toX, toY);
    }
  }
  stroke(viewer, pen, area, '#ffd23f');
}

/** A rectangle in a line with a dark rim, which is seen on any image. */
function outline(viewer, pen, pane, [x, y, width, height], colour) {
  const [left, top] = toStage(viewer, pane, x, y);
  const [right, bottom] = toStage(viewer, pane, x + width, y + height);
  const box = new Path2D();
  box.rect(left, top, right - left, bottom - top);
  stroke(viewer, pen, box, colour);
}

function stroke({ ratio }, pen, path, colour) {
  for (const [thickness, style] of [[3.5, 'rgba(0,0,0,.6)'], [1.5, colour]]) {
    Object.assign(pen, { lineWidth: thickness * ratio, strokeStyle: style });
    pen.stroke(path);
  }
}

function drawNumbers(viewer, pen, pane) {
  const [left, top] = toImage(viewer, pane, pane.x, pane.y).map(Math.floor);
  const [right, bottom] = toImage(viewer, pane, pane.x + pane.width, pane.y + pane.height).map(Math.ceil);
  const { width, height } = viewer.frames[0];
  const numbers = numbersOf(viewer, pane.view);
  pen.textAlign = 'center';
  for (let y = Math.max(0, top); y < Math.min(height, bottom); y++) {
    for (let x = Math.max(0, left); x < Math.min(width, right); x++) {
      drawNumber(viewer, pen, toStage(viewer, pane, x + 0.5, y + 0.5), numbers(y * width + x));
    }
  }
}

/** What stands in a pixel of a view: three channels, or one error. */
function numbersOf({ layers, frames, state }, view) {
  const frame = frames[view.frame];
  if (!view.isError) return pixel => pixelOf(frame, pixel);
  const { errors, channels } = layers.errorsOf(frame, state);
  return pixel => Array.from(errors.subarray(channels * pixel, channels * (pixel + 1)));
}

function drawNumber({ ratio }, pen, [x, y], numbers) {
  const line = 13 * ratio;
  pen.font = `${11 * ratio}px ui-monospace, monospace`;
  numbers.forEach((number, index) => {
    const below = y + (index - (numbers.length - 1) / 2) * line + 4 * ratio;
    pen.lineWidth = 3 * ratio;
    pen.strokeStyle = 'rgba(0,0,0,.75)';
    pen.strokeText(figure(number), x, below);
    pen.fillStyle = numbers.length === 1 ? '#fff' : ['#ff9d8a', '#a5e59b', '#9cc4ff'][index];
    pen.fillText(figure(number), x, below);
  });
}

/** The name of a view above its pane, and what its colours mean. */
function drawLabel(viewer, pen, pane) {
  const { ratio, state, views, frames } = viewer;
  const [size, baseline] = [13 * ratio, pane.y - 7 * ratio];
  pen.fillStyle = viewer.ink;
  const own = labelOf(frames, pane.view);
  const name = state.layout === 'wipe' ? `${labelOf(frames, views[state.under])} | ${own}` : own;
  const legend = legendOf(viewer, pane.view);
  const room = legend ? drawLegend(viewer, pen, pane, legend) - pane.x : pane.width;
  pen.font = `600 ${size}px system-ui, sans-serif`;
  pen.textAlign = 'left';
  pen.fillText(shortened(pen, name, room - 8 * ratio), pane.x, baseline);
}

/** As much of a text as there is room for. */
function shortened(pen, text, room) {
  if (pen.measureText(text).width <= room) return text;
  const letters = [...text];
  while (letters.length > 1 && pen.measureText(`${letters.join('')}…`).width > room) letters.pop();
  return `${letters.join('')}…`;
}

/** The two ends of a scale, and its colours. */
function legendOf({ layers, frames, state }, view) {
  const frame = frames[view.frame];
  if (view.isError) {
    const metric = METRICS[state.metric];
    const { limit, channels } = layers.errorsOf(frame, state);
    const end = metric.unit === '%' ? `${figure(100 * limit)} %` : figure(limit);
    const stops = channels === 3 ? [0x000000, 0x7f7f7f, 0xffffff] : metric.signed ? SIGNED : MAGNITUDE;
    return { low: metric.signed ? `−${end}` : '0', high: metric.signed ? `+${end}` : end, stops };
  }
  if (frame.kind === 'signed') return { low: '−', high: '+', stops: SIGNED };
  if (frame.kind === 'magnitude') return { low: '0', high: '1', stops: MAGNITUDE };
  const [low, high] = FALSE_STOPS.map(stops => figure(2 ** (stops - state.stops)));
  return state.tone === FALSE_COLOUR ? { low, high, stops: MAGNITUDE } : null;
}

/** Draws it at the right, and says where it begins. */
function drawLegend({ ratio, ink }, pen, pane, { low, high, stops }) {
  const [width, height, top] = [70 * ratio, 9 * ratio, pane.y - 16 * ratio];
  pen.font = `${11 * ratio}px system-ui, sans-serif`;
  pen.textAlign = 'right';
  pen.fillStyle = ink;
  const right = pane.x + pane.width;
  pen.fillText(high, right, pane.y - 8 * ratio);
  const left = right - pen.measureText(high).width - 5 * ratio - width;
  pen.fillText(low, left - 5 * ratio, pane.y - 8 * ratio);
  for (let at = 0; at < width; at++) {
    pen.fillStyle = `rgb(${scaleColour(stops, at / width)})`;
    pen.fillRect(left + at, top, 1, height);
  }
  pen.fillStyle = ink;
  return left - 5 * ratio - pen.measureText(low).width;
}

/** A number for people: four digits. */
function figure(value) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? 'NaN' : value > 0 ? 'Inf' : '−Inf';
  const size = Math.abs(value);
  const text = size && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : String(Number(value.toPrecision(4)));
  return text.replace('-', '−');
}
