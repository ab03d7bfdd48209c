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
