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
