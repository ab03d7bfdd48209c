// Where each view stands on the stage, and how image and stage coordinates belong together. All in device pixels.

/** An image is shown at this size or more where there is room. */
const LEAST_ZOOM = 4;
const LABEL_HEIGHT = 24;
const GAP = 8;
/** Of the window's height, what one image may take. */
const TALLEST = 0.72;

/** As many beside each other as can be shown large. */
function columnsFor(count, width, imageWidth) {
  const fits = columns => width / columns - GAP >= LEAST_ZOOM * imageWidth;
  const columns = [4, 3, 2].find(columns => columns <= count && fits(columns));
  return columns || (width > 700 ? Math.min(2, count) : 1);
}

/** Lays the stage out for a width in CSS pixels: its height, its panes, and the zoom that fits. */
function layOut({ views, state, frames, width: cssWidth, ratio }) {
  const [image] = frames;
  const shown = state.layout === 'all' ? views : [views[state.show]];
  const columns = columnsFor(shown.length, cssWidth, image.width);
  const [width, label, gap] = [cssWidth * ratio, LABEL_HEIGHT * ratio, GAP * ratio];
  const paneWidth = Math.floor((width - gap * (columns - 1)) / columns);
  const tallest = Math.max(TALLEST * innerHeight * ratio, LEAST_ZOOM * ratio * image.height);
  const zoom = wholeZoom(Math.min(paneWidth / image.width, tallest / image.height));
  const paneHeight = Math.ceil(image.height * zoom);
  const boxes = insetBoxes(state.insets, paneWidth, gap);
  const below = Math.max(0, ...boxes.map(box => box.height + gap));
  const panes = shown.map((view, index) => ({
    view,
    x: index % columns * (paneWidth + gap),
    y: Math.floor(index / columns) * (paneHeight + below + label + gap) + label,
    width: paneWidth,
    height: paneHeight,
  }));
  const rows = Math.ceil(shown.length / columns);
  return { panes, boxes, zoom, width, height: rows * (paneHeight + below + label + gap) - gap };
}

/** Where insets stand below a pane, from its left edge, each at most as high as wide. */
function insetBoxes(insets, paneWidth, gap) {
  const most = Math.floor((paneWidth - gap * (insets.length - 1)) / Math.max(2, insets.length));
  return insets.map(([, , width, height], index) => {
    const zoom = wholeZoom(Math.min(most / width, most / height));
    return { x: index * (most + gap), width: width * zoom, height: height * zoom };
  });
}

/** Whole numbers of device pixels, so that all pixels are alike. */
const wholeZoom = zoom => zoom >= 1 ? Math.floor(zoom) : zoom;

/** The zoom and the centre that hold: the reader's, or what shows all of the image. */
function cameraOf({ state, frames, stage, ratio }) {
  const [{ width, height }] = frames;
  if (!state.zoom) return { zoom: stage.zoom, x: width / 2, y: height / 2 };
  return { zoom: state.zoom * ratio, x: state.x, y: state.y };
}

const paneAt = (stage, x, y) => stage.panes.find(pane =>
  x >= pane.x && x < pane.x + pane.width && y >= pane.y && y < pane.y + pane.height);

/** The place in the image below a place on the stage. */
function toImage(viewer, pane, x, y) {
  const camera = cameraOf(viewer);
  return [
    (x - pane.x - pane.width / 2) / camera.zoom + camera.x,
    (y - pane.y - pane.height / 2) / camera.zoom + camera.y,
  ];
}

/** The place on the stage of a place in the image. */
function toStage(viewer, pane, x, y) {
  const camera = cameraOf(viewer);
  return [
    Math.round((x - camera.x) * camera.zoom + pane.x + pane.width / 2),
    Math.round((y - camera.y) * camera.zoom + pane.y + pane.height / 2),
  ];
}
