// The controls above the stage, and how they follow the state.

/** Builds the controls of a viewer; the answer makes them show its state. */
function controls(viewer, changed) {
  const doing = action => () => { action(viewer); changed(); };
  const button = (label, action, properties = {}) =>
    make('button', { type: 'button', ...properties, onclick: doing(action) }, ...[label].flat());
  const chooser = (label, options, name, then = () => {}) => make('select', {
    title: label,
    ariaLabel: label,
    onchange: event => { viewer.state[name] = event.target.value; then(); changed(); },
  }, ...options.map(option => make('option', { value: option }, option)));

  const images = viewer.views.map((view, index) =>
    button([make('kbd', {}, String(index + 1)), ` ${labelOf(viewer.whole, view)}`], () => choose(viewer, index)));
  const layouts = Object.entries(LAYOUTS).map(([layout, label]) =>
    button(label, () => { viewer.state.layout = layout; }, { title: { all: 'g', wipe: 'w' }[layout] || '' }));
  const tone = chooser('tone curve (t)', TONES, 'tone');
  const channel = chooser('channel ([ and ])', CHANNELS, 'channel');
  const metric = chooser('error metric (m)', viewer.metrics, 'metric', () => { viewer.state.limit = 0; });
  const stops = slider('exposure (e, E)', -12, 12, 0.1, value => { viewer.state.stops = value; changed(); });
  const limit = slider('end of the error scale', -12, 6, 0.25, value => { viewer.state.limit = 2 ** value; changed(); });
  const cells = chooser('outlines of rejected cells (p)', [...viewer.scales, NO_CELLS], 'cells');
  const part = chooser('part of the image (b)', viewer.partNames, 'part');
  const bars = button('histogram', KEYS.i[1], { title: 'i' });
  const enlarge = button('enlarge region', KEYS.x[1], { title: 'x' });
  const key = name => button(name, KEYS[name][1], { title: KEYS[name][0], ariaLabel: KEYS[name][0] });
  const hasErrors = viewer.views.some(view => view.isError);

  const rows = [
    [...images, make('span', { className: 'gap' }), ...layouts],
    [...(viewer.partNames.length > 1 ? [part] : []), stops.label, tone, channel, ...(hasErrors ? [metric, limit.label] : []),
      ...(viewer.scales.length ? [cells] : []), bars, enlarge, key('-'), button('fit', KEYS.f[1], { title: 'f' }), key('+'),
      button('reset', KEYS.r[1], { title: 'r' }), button('PNG', KEYS.s[1], { title: 'save as PNG (s)' }), key('?')],
  ];
  viewer.root.prepend(...rows.map(row => make('div', { className: 'tools' }, ...row)));

  return () => {
    const { state } = viewer;
    images.forEach((one, index) => press(one, state.layout !== 'all' && index === state.show));
    layouts.forEach((one, index) => press(one, Object.keys(LAYOUTS)[index] === state.layout));
    Object.assign(tone, { value: state.tone });
    Object.assign(channel, { value: state.channel });
    Object.assign(metric, { value: state.metric });
    Object.assign(cells, { value: state.cells });
    Object.assign(part, { value: state.part });
    enlarge.disabled = !state.region && !state.insets.length;
    enlarge.textContent = state.region || !state.insets.length ? 'enlarge region' : 'drop insets';
    stops.show(state.stops, `${state.stops < 0 ? '−' : '+'}${Math.abs(state.stops).toFixed(1)} EV`);
    limit.show(Math.log2(state.limit || 1), state.limit ? figure(state.limit) : 'auto');
    press(bars, state.histogram);
  };
}

/** A slider with its value beside it. */
function slider(title, min, max, step, changed) {
  const input = make('input', { type: 'range', min, max, step, ariaLabel: title });
  input.addEventListener('input', () => changed(Number(input.value)));
  const output = make('output');
  const show = (value, words) => { input.value = value; output.textContent = words; };
  return { label: make('label', { title }, input, output), show };
}

/** The list of keys. */
function help() {
  const rows = Object.entries(KEYS).map(([key, [words]]) =>
    make('li', {}, make('kbd', {}, key === ' ' ? 'space' : key.replace('Arrow', '')), ` ${words}`));
  const first = [['1 … 9', 'choose an image'], ['Shift+1 … 9', 'choose the reference'],
    ['Shift+drag', 'means of a region, and what x enlarges'], ['wheel', 'zoom, once the viewer has the focus; always with Ctrl']];
  const more = first.map(([key, words]) => make('li', {}, make('kbd', {}, key), ` ${words}`));
  return make('ul', { className: 'keys', hidden: true }, ...more, ...rows);
}
