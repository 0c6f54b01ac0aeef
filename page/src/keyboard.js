/** Keys that work wherever the focus is, save where a key means something to what has it. */

import { byId } from './element.js';

export function connectKeyboard({ player, theme, fit, joints, help }) {
  const keys = {
    ' ': () => player.toggle(),
    k: () => player.toggle(),
    ArrowLeft: (event) => (event.shiftKey ? player.toMove(-1) : player.step(-1)),
    ArrowRight: (event) => (event.shiftKey ? player.toMove(1) : player.step(1)),
    Home: () => player.seek(0),
    End: () => player.seek(player.run.count - 1),
    '[': () => player.changeSpeed(-1),
    ']': () => player.changeSpeed(1),
    l: () => player.setLoop(!player.loop),
    t: () => theme.toggle(),
    f: () => fit(),
    j: () => joints(),
    '?': () => help(),
  };
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || byId('help').open) return;
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action || means(event.target, event.key)) return;
    event.preventDefault();
    action(event);
  });
  // Who presses buttons with the mouse means the replay with the space bar, not the button again.
  document.addEventListener('click', (event) => {
    if (event.detail > 0) event.target.closest('button')?.blur();
  });
}

/** Whether a key means something to the element that has the focus. */
function means(target, key) {
  // The focus leaves a dialog a moment after it has closed.
  if (target.closest('dialog:not([open])')) return false;
  if (target.matches('select, input:not([type=range]), textarea')) return true;
  if (target.matches('[role=tab]')) return ['ArrowLeft', 'ArrowRight', 'Home', 'End', ' '].includes(key);
  return key === ' ' && target.matches('button, summary');
}
