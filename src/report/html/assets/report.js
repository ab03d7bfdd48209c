// Comforts of the page: everything is readable without them. A classic script, for pages opened from disk may
// load no modules. Nothing is fetched.
'use strict';
(() => {
const all = (selector, root = document) => [...root.querySelectorAll(selector)];
const press = (button, on) => button.setAttribute('aria-pressed', String(on));
const isPressed = button => button.getAttribute('aria-pressed') === 'true';

// Colours
document.getElementById('theme').addEventListener('click', () => {
  const root = document.documentElement;
  const system = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
  root.dataset.theme = (root.dataset.theme || system) === 'dark' ? 'light' : 'dark';
  try { localStorage.setItem('furnace-theme', root.dataset.theme); } catch { /* from disk, storage may be refused */ }
});

// Links into folded cases unfold them.
function unfold() {
  let id = location.hash.slice(1);
  try { id = decodeURIComponent(id); } catch { /* not one of our links */ }
  const target = document.getElementById(id);
  if (!target) return;
  for (let at = target; at; at = at.parentElement) if (at.tagName === 'DETAILS') at.open = true;
  target.scrollIntoView();
}
addEventListener('hashchange', unfold);
document.addEventListener('click', event => {
  const link = event.target.closest('a[href^="#"]');
  if (link && link.hash === location.hash) unfold();
});
unfold();

// The table of trials
const words = document.getElementById('filter');
if (words) {
  const rows = all('#all-trials tbody tr').map(row => ({ row, text: row.textContent.toLowerCase() }));
  const buttons = all('.filter [data-status]');
  const apply = () => {
    const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean);
    const pressed = buttons.filter(isPressed).map(b => b.dataset.status);
    let shown = 0;
    for (const { row, text } of rows) {
      const fits = wanted.every(word => text.includes(word));
      row.hidden = !fits || (pressed.length > 0 && !pressed.includes(row.dataset.status));
      shown += !row.hidden;
    }
    document.getElementById('filtered').textContent = `${shown} of ${rows.length}`;
  };
  words.addEventListener('input', apply);
  for (const button of buttons) {
    button.addEventListener('click', () => { press(button, !isPressed(button)); apply(); });
  }
  apply();
}

// Commands to copy
for (const button of all('.copy')) {
  button.addEventListener('click', async () => {
    const code = button.previousElementSibling;
    try {
      await navigator.clipboard.writeText(code.textContent);
      button.textContent = 'copied';
    } catch {
      getSelection().selectAllChildren(code);
      button.textContent = 'selected';
    }
    setTimeout(() => { button.textContent = 'copy'; }, 1500);
  });
}

// Pictures: one at a time to flip between, one over another to wipe, or all side by side.
function viewer(root) {
  const frames = all('.frame', root);
  const chooses = all('[data-show]', root);
  const layouts = all('[data-layout]', root.querySelector('.tools'));
  const wipe = root.querySelector('.wipe');
  const render = Math.min(1, frames.length - 1);
  const state = { shown: render, before: 0, layout: 'all' };
  const draw = () => {
    root.dataset.layout = state.layout;
    root.style.setProperty('--wipe', `${wipe.value}%`);
    frames.forEach((frame, number) => {
      frame.classList.toggle('shown', number === state.shown);
      frame.classList.toggle('under', number === state.before && number !== state.shown);
    });
    chooses.forEach((button, number) => press(button, state.layout !== 'all' && number === state.shown));
    layouts.forEach(button => press(button, button.dataset.layout === state.layout));
  };
  const show = number => {
    if (number !== state.shown) state.before = state.shown;
    state.shown = number;
    if (state.layout === 'all') state.layout = 'one';
    draw();
  };
  const lay = layout => { state.layout = state.layout === layout ? 'one' : layout; draw(); };
  const act = key => {
    const button = chooses.find(one => one.dataset.key === key);
    if (button) show(Number(button.dataset.show));
    else if (key === ' ') show(state.before);
    else if (key === 'w') lay('wipe');
    else if (key === 'g') lay('all');
    else return false;
    return true;
  };
  for (const button of chooses) button.addEventListener('click', () => show(Number(button.dataset.show)));
  for (const button of layouts) button.addEventListener('click', () => lay(button.dataset.layout));
  frames.forEach((frame, number) => {
    const image = frame.querySelector('img');
    if (image) image.addEventListener('click', () => show(state.layout === 'all' ? number : state.before));
  });
  wipe.addEventListener('input', draw);
  root.addEventListener('keydown', event => {
    // A focused button or slider keeps its own space and arrows.
    const own = event.key === ' ' && event.target !== root;
    if (own || event.ctrlKey || event.metaKey || event.altKey) return;
    if (act(event.key)) event.preventDefault();
  });
  draw();
}
for (const figure of all('.viewer')) viewer(figure);
})();
