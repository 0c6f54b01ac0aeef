/** Over the scene: which line is in execution, and which limits are active. */

import { element } from './element.js';
import { kindOf } from './event-kinds.js';

export function connectStatus(host, run, player) {
  const line = element('div', { class: 'status-line' });
  const active = element('div', { class: 'status-active' });
  host.append(line, active);
  let shown = '';
  player.onChange(() => {
    const { frame } = player;
    const number = run.data.frames.line[frame];
    const block = run.blockAt(frame);
    const events = run.eventsAt(frame).filter((event) => ['limit', 'slowed', 'wait', 'stop'].includes(event.kind));
    const key = `${number} ${block?.id} ${events.map((event) => event.index).join(' ')}`;
    if (key === shown) return;
    shown = key;
    line.replaceChildren(
      ...(number ? [element('b', {}, `line ${number}`), ' '] : []),
      ...(block && number ? [element('code', {}, run.wordsOf(block))] : []),
    );
    active.replaceChildren(
      ...events.map((event) => element('span', { class: 'pill', style: `--mark: var(--${kindOf(event).colour})` }, event.label)),
    );
  });
}
