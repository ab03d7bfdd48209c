// The pointer over the stage: values below it, panning, zooming, the wipe, and regions.

function followPointer(viewer, changed, moved) {
  const { canvas, state, root } = viewer;
  let drag = null;

  const at = event => {
    const box = canvas.getBoundingClientRect();
    return [(event.clientX - box.left) * viewer.ratio, (event.clientY - box.top) * viewer.ratio];
  };
  const pixel = (pane, x, y) => {
    const [column, row] = toImage(viewer, pane, x, y).map(Math.floor);
    const { width, height } = viewer.frames[0];
    return column >= 0 && row >= 0 && column < width && row < height ? [column, row] : null;
  };

  canvas.addEventListener('pointerdown', event => {
    const [x, y] = at(event);
    const pane = paneAt(viewer.stage, x, y);
    if (!pane) return;
    root.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    drag = dragFrom(viewer, event, pane, x, y);
  });
  canvas.addEventListener('pointermove', event => {
    const [x, y] = at(event);
    const pane = drag ? drag.pane : paneAt(viewer.stage, x, y);
    viewer.pointer = pane ? pixel(pane, x, y) : null;
    if (drag) drag.to(x, y);
    moved();
  });
  canvas.addEventListener('pointerup', event => {
    const [x, y] = at(event);
    if (drag && !drag.moved(x, y)) flip(viewer, drag.pane);
    drag = null;
    changed();
  });
  canvas.addEventListener('pointerleave', () => { viewer.pointer = null; moved(); });
  canvas.addEventListener('dblclick', () => { state.zoom = 0; changed(); });
  canvas.addEventListener('wheel', event => {
    const [x, y] = at(event);
    const pane = paneAt(viewer.stage, x, y);
    // Only once the viewer has the focus: a page that is scrolled past must not catch the wheel.
    if (!pane || !(event.ctrlKey || root.contains(document.activeElement))) return;
    event.preventDefault();
    zoomBy(viewer, Math.exp(-event.deltaY * 0.0018), pane, x, y);
    changed();
  }, { passive: false });
}

/** What dragging does from here on: it draws a region, moves the wipe, or moves the image. */
function dragFrom(viewer, event, pane, x, y) {
  const { state } = viewer;
  const moved = (toX, toY) => Math.hypot(toX - x, toY - y) > 3 * viewer.ratio;
  if (event.shiftKey) return { pane, moved, to: (toX, toY) => { state.region = regionOf(viewer, pane, [x, y], [toX, toY]); } };
  const handle = pane.x + state.wipe * pane.width;
  if (state.layout === 'wipe' && Math.abs(x - handle) < 16 * viewer.ratio) {
    return { pane, moved: () => true, to: toX => { state.wipe = clip((toX - pane.x) / pane.width); } };
  }
  const start = cameraOf(viewer);
  const to = (toX, toY) => {
    if (!moved(toX, toY)) return;
    const zoom = start.zoom / viewer.ratio;
    Object.assign(state, { zoom, x: start.x - (toX - x) / start.zoom, y: start.y - (toY - y) / start.zoom });
  };
  return { pane, moved, to };
}

/** Column, row, width and height between two places on the stage. */
function regionOf(viewer, pane, from, to) {
  const { width, height } = viewer.frames[0];
  const corners = [from, to].map(([x, y]) => toImage(viewer, pane, x, y));
  const [low, high] = [Math.min, Math.max].map(pick => [0, 1].map(axis => pick(corners[0][axis], corners[1][axis])));
  const left = Math.max(0, Math.floor(low[0])), top = Math.max(0, Math.floor(low[1]));
  const right = Math.min(width, Math.ceil(high[0])), bottom = Math.min(height, Math.ceil(high[1]));
  return right > left && bottom > top ? [left, top, right - left, bottom - top] : null;
}

/** A click shows an image alone, and flips back. */
function flip(viewer, pane) {
  const index = viewer.views.indexOf(pane.view);
  choose(viewer, viewer.state.layout === 'all' ? index : viewer.state.under);
}
