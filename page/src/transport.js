/** Buttons that play, step and loop, the choice of speed, and the time. */

import { byId, element } from './element.js';
import { SPEEDS } from './player.js';
import { seconds } from './units.js';

export function connectTransport(run, player) {
  const press = (id, action) => byId(id).addEventListener('click', action);
  press('play', () => player.toggle());
  press('step-back', () => player.step(-1));
  press('step-on', () => player.step(1));
  press('move-back', () => player.toMove(-1));
  press('move-on', () => player.toMove(1));
  press('loop', () => player.setLoop(!player.loop));
  const speed = byId('speed');
  speed.append(...SPEEDS.map((value) => element('option', { value }, `${value}×`)));
  speed.addEventListener('change', () => player.setSpeed(Number(speed.value)));
  byId('time-end').textContent = seconds(run.duration, run.data.tick_s);
  player.onChange(() => {
    const play = byId('play');
    play.classList.toggle('playing', player.playing);
    play.setAttribute('aria-label', player.playing ? 'Pause' : 'Play');
    play.title = player.playing ? 'Pause (space)' : 'Play (space)';
    byId('loop').setAttribute('aria-pressed', player.loop);
    speed.value = String(player.speed);
    byId('time-now').textContent = seconds(player.time, run.data.tick_s);
  });
}
