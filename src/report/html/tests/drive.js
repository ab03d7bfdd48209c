// Drives a page from within, as a reader would, and leaves what it saw in the page for the test that opened it.

const seen = { errors: drivenErrors };
const frameOfBrowser = () => new Promise(done => { requestAnimationFrame(() => setTimeout(done)); });
const encoded = bytes => btoa(Array.from(bytes, byte => String.fromCharCode(byte)).join(''));

/** A state from which every key has somewhere to go. */
function unsettle(viewer) {
  const middle = { layout: 'one', show: 1, under: 0, zoom: 3.3, x: 5, y: 5, region: [1, 1, 2, 2], limit: 3 };
  Object.assign(viewer.state, viewer.initial, middle);
  viewer.help.hidden = true;
}

const shownBy = viewer => JSON.stringify([viewer.state, viewer.help.hidden]);

/** The keys that change nothing. */
function deadKeys(viewer) {
  const digits = ['Digit1', 'Digit3'].map(code => ({ key: code.slice(-1), code }));
  const others = Object.keys(KEYS).filter(key => key !== 's').map(key => ({ key, code: '' }));
  return [...digits, ...others].filter(press => {
    unsettle(viewer);
    const before = shownBy(viewer);
    viewer.root.dispatchEvent(new KeyboardEvent('keydown', { ...press, bubbles: true }));
    return shownBy(viewer) === before;
  }).map(press => press.key);
}

async function operateControls(viewer) {
  const buttons = all('.tools button', viewer.root).filter(button => button.textContent !== 'PNG');
  for (const button of buttons) button.click();
  for (const select of all('.tools select', viewer.root)) {
    for (const option of select.options) {
      select.value = option.value;
      select.dispatchEvent(new Event('change'));
      await frameOfBrowser();
    }
  }
  for (const slider of all('.tools input', viewer.root)) slider.dispatchEvent(new Event('input'));
  await frameOfBrowser();
}

/** The 8-bit colours of every image under each tone curve. */
function shaded(viewer, stops) {
  return Object.keys(CURVES).map(tone => {
    const state = { ...viewer.initial, tone, stops };
    return viewer.frames.map((frame, index) => {
      const canvas = viewer.layers.of(viewer.views[index], state);
      return encoded(canvas.getContext('2d').getImageData(0, 0, frame.width, frame.height).data);
    });
  });
}

async function hover(viewer) {
  Object.assign(viewer.state, viewer.initial);
  drawAll(viewer);
  const [pane] = viewer.stage.panes;
  const box = viewer.canvas.getBoundingClientRect();
  const [x, y] = toStage(viewer, pane, 2.5, 1.5).map(place => place / viewer.ratio);
  viewer.canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + x, clientY: box.top + y }));
  await frameOfBrowser();
  return { pointer: viewer.pointer, rows: all('tr', viewer.table).map(row => all('td', row).map(cell => cell.textContent)) };
}

async function driveViewer(viewer) {
  seen.state = { ...viewer.state };
  seen.values = viewer.frames.map(frame => {
    const values = Array.from({ length: frame.pixels }, (_, pixel) => pixelOf(frame, pixel));
    return values.flat().map(String);
  });
  seen.tables = Object.keys(CURVES).map(tone => encoded(toneTable(1, { tone, stops: 0.3, offset: 0 })));
  seen.shaded = shaded(viewer, 1.3);
  seen.dead = deadKeys(viewer);
  await operateControls(viewer);
  seen.hover = await hover(viewer);
  seen.canvas = [viewer.canvas.width, viewer.canvas.height];
}

async function drive() {
  const started = typeof viewers === 'undefined' ? [] : await viewers;
  await frameOfBrowser();
  if (started[0]) await driveViewer(started[0]);
  const loaded = performance.getEntriesByType('resource').map(entry => entry.name);
  seen.fetched = loaded.filter(name => !/^(file|data|blob):/.test(name));
  seen.width = [document.documentElement.scrollWidth, innerWidth];
}

drive().catch(error => drivenErrors.push(`${error.message} ${error.stack}`)).then(() => {
  const text = JSON.stringify(seen);
  if (parent !== window) parent.postMessage(text, '*');
  document.body.append(Object.assign(document.createElement('pre'), { id: 'driven', textContent: text }));
});
