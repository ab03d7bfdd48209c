'use strict';
// What a reader has chosen stands in the address after `#`, so that a link shows the same again:
// `#trials?words=bvh`, `#image/caustic:images?show=2&stops=1.5`.

/** The anchor that the address names, and what was chosen there. */
function readAddress() {
  const [anchor, choices = ''] = location.hash.slice(1).split('?');
  return { anchor: decoded(anchor), choices: new URLSearchParams(choices) };
}

/** Puts what was chosen at an anchor into the address, without a step in the browser's history. */
function writeAddress(anchor, choices) {
  const words = new URLSearchParams(choices).toString();
  const hash = `#${encodeURI(anchor)}${words && `?${words}`}`;
  try { history.replaceState(null, '', hash); } catch { /* a sandboxed frame may refuse */ }
}

function decoded(text) {
  try { return decodeURIComponent(text); } catch { return text; }
}
// Comforts of a page: everything is readable without them. Nothing is fetched.

const all = (selector, root = document) => [...root.querySelectorAll(selector)];
const press = (button, on) => button.setAttribute('aria-pressed', String(on));
const isPressed = button => button.getAttribute('aria-pressed') === 'true';

function switchColours() {
  const root = document.documentElement;
  const system = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
  root.dataset.theme = (root.dataset.theme || system) === 'dark' ? 'light' : 'dark';
  try { localStorage.setItem('furnace-theme', root.dataset.theme); } catch { /* from disk, storage may be refused */ }
}
document.getElementById('theme').addEventListener('click', switchColours);

/** Opens what is folded around the anchor in the address. */
function unfold() {
  const target = document.getElementById(readAddress().anchor);
  if (!target) return;
  for (let at = target; at; at = at.parentElement) if (at.tagName === 'DETAILS') at.open = true;
  target.scrollIntoView();
}
addEventListener('hashchange', unfold);
unfold();

async function copy(button) {
  const code = button.previousElementSibling;
  try {
    await navigator.clipboard.writeText(code.textContent);
    button.textContent = 'copied';
  } catch {
    getSelection().selectAllChildren(code);
    button.textContent = 'selected';
  }
  setTimeout(() => { button.textContent = 'copy'; }, 1500);
}
for (const button of all('.copy')) button.addEventListener('click', () => copy(button));
// The table of trials: by words and by outcome.

function filterTrials(words) {
  const rows = all('#all-trials tbody tr').map(row => ({ row, text: row.textContent.toLowerCase() }));
  const buttons = all('.filter [data-status]');
  const chosen = () => buttons.filter(isPressed).map(button => button.dataset.status);

  function show() {
    const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean);
    const statuses = chosen();
    let shown = 0;
    for (const { row, text } of rows) {
      const fits = wanted.every(word => text.includes(word));
      row.hidden = !fits || (statuses.length > 0 && !statuses.includes(row.dataset.status));
      shown += !row.hidden;
    }
    document.getElementById('filtered').textContent = `${shown} of ${rows.length}`;
  }

  function change() {
    const choices = { words: words.value, status: chosen().join(' ') };
    writeAddress('trials', Object.entries(choices).filter(([, value]) => value));
    show();
  }

  function restore() {
    const { anchor, choices } = readAddress();
    if (anchor !== 'trials') return;
    words.value = choices.get('words') || '';
    const statuses = (choices.get('status') || '').split(' ');
    for (const button of buttons) press(button, statuses.includes(button.dataset.status));
    show();
  }

  words.addEventListener('input', change);
  for (const button of buttons) {
    button.addEventListener('click', () => { press(button, !isPressed(button)); change(); });
  }
  addEventListener('hashchange', restore);
  show();
  restore();
}
const words = document.getElementById('filter');
if (words) filterTrials(words);
