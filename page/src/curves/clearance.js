/** The plot of the room that the robot has above the margins kept around it. */

import { fixed } from '../units.js';

const JUMP = 0.05; // share of all its range beyond which a change of pair breaks the curve, ..
const STEEPER = 3; // .. if it changes so many times as much there as beside it

export function clearanceSpec(run, theme) {
  const { frames, pairs } = run.data;
  const margin = (frame) => pairs[frames.nearest[frame]]?.margin ?? 0;
  // Pairs have margins of their own: which one is nearest is a matter of the room above them.
  const room = frames.clearance.map((value, frame) => (value === null ? null : (value - margin(frame)) * 1000));
  const breaks = breaksOf(room, frames.nearest);
  return {
    id: 'clearance',
    title: 'Room above the margin',
    unit: () => 'mm',
    rows: 2,
    series: [
      {
        label: 'room',
        scale: 'y',
        colour: () => theme.colour('nearest'),
        values: () => room,
        shown: () => true,
        breaks: () => breaks,
        width: 1.8,
      },
    ],
    second: false,
    single: () => true,
    from0: true,
    bands: [],
    limits: () => [],
    marks: () => [],
    readout: (frame) => {
      const pair = pairs[frames.nearest[frame]];
      if (pair && room[frame] !== null) return `${pair.link} – ${pair.other}\n${words(frames.clearance[frame], pair.margin)}`;
      return frames.watched?.[frame] === false ? 'nothing is watched' : 'nothing within reach of its influence';
    },
  };
}

/** A distance and what it leaves above the margin, m, in words. */
function words(distance, margin) {
  const [away, room] = [distance * 1000, (distance - margin) * 1000];
  const kept = `margin ${+(margin * 1000).toFixed(1)}`;
  const side = room < 0 ? 'below' : 'above';
  return `${fixed(away, 1)} mm away, ${fixed(Math.abs(room), 1)} ${side} ${kept}`;
}

/** Frames in which another pair is the nearest, at quite another distance: nothing moved from the one to the other. */
function breaksOf(room, nearest) {
  let [least, most] = [Infinity, -Infinity];
  for (const value of room) {
    if (value === null) continue;
    least = Math.min(least, value);
    most = Math.max(most, value);
  }
  const step = (frame) => {
    const [before, here] = [room[frame - 1] ?? null, room[frame] ?? null];
    return before === null || here === null ? 0 : Math.abs(here - before);
  };
  const isBreak = (frame) =>
    nearest[frame] !== nearest[frame - 1] &&
    step(frame) > JUMP * (most - least) &&
    step(frame) > STEEPER * Math.max(step(frame - 1), step(frame + 1));
  return room.map((_, frame) => frame).filter((frame) => frame > 0 && isBreak(frame));
}
