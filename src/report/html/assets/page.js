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
