/** The plots that a run has. */

import { fixed, figure } from '../units.js';
import { clearanceSpec } from './clearance.js';
import { curveOf, hasLimits, inPercent, inUnits, limitSteps } from './series.js';

const SLOWEST_TURN = 1e-3; // rad/s: slower turns are rounding
const MOST_LIMITS = 3; // joints beyond which dashed limits in units hide more than they tell

/**
 * Plots of a run; `choice` tells which joints are shown and whether in percent of their limits, `colours(index)`
 * the colour of a joint.
 */
export function specsOf(run, choice, colours, theme) {
  const specs = [
    jointSpec(run, choice, colours, { id: 'position', what: 'q', kind: 'position', title: 'Joint positions', per: '' }),
    jointSpec(run, choice, colours, { id: 'speed', what: 'speed', kind: 'speed', title: 'Joint speeds', per: '/s' }),
    pathSpec(run, theme),
  ];
  if (run.data.frames.clearance.some((value) => value !== null)) specs.push(clearanceSpec(run, theme));
  if (run.data.frames.singular.some((value) => value !== null)) specs.push(singularSpec(run, theme));
  return specs;
}

function jointSpec(run, choice, colours, { id, what, kind, title, per }) {
  const percent = () => choice.percent && run.joints.some((joint) => hasLimits(run, kind, joint));
  const second = new Set(run.joints.map((joint) => joint.shown)).size > 1;
  const cache = new Map();
  const values = (joint) => {
    const key = `${joint.index} ${percent()}`;
    if (!cache.has(key)) cache.set(key, (percent() ? inPercent : inUnits)(run, what, joint));
    return cache.get(key);
  };
  const series = run.joints.map((joint) => ({
    label: joint.name,
    joint: joint.index,
    scale: second && joint.unit === 'm' ? 'y2' : 'y',
    colour: () => colours(joint.index),
    values: () => values(joint),
    shown: () => choice.shown.has(joint.index),
    width: run.joints.length > 8 ? 1.25 : 1.6,
  }));
  const told = (frame, k) => {
    const joint = run.joints[k];
    const value = values(joint)[frame];
    return percent() ? `${fixed(value, 1)} %` : `${fixed(value, joint.unit === 'm' ? 1 : 2)} ${joint.shown}${per}`;
  };
  const units = [...new Set(run.joints.map((joint) => joint.shown + per))].join('  ·  ');
  return {
    id,
    title,
    unit: () => (percent() ? '% of limit' : units),
    series,
    second,
    single: percent,
    bands: [],
    range: () => (percent() ? [-108, 108] : null),
    limits: () => (percent() ? wholeLimits() : shownLimits(run, choice, colours, kind, series)),
    marks: () =>
      run.events
        .filter((event) => event.kind === 'limit' && curveOf(event) === what && choice.shown.has(event.joint))
        .map((event) => ({ series: event.joint, first: event.frame, last: event.lastFrame })),
    readout: (frame, k) => (k === null ? '' : `${run.joints[k].name}  ${told(frame, k)}`),
  };
}

function wholeLimits() {
  return [-100, 100].map((value) => ({ scale: 'y', colour: 'rgba(128, 128, 128, 0.8)', steps: [[0, value]] }));
}

function shownLimits(run, choice, colours, kind, series) {
  if (choice.shown.size > MOST_LIMITS) return [];
  return run.joints
    .filter((joint) => choice.shown.has(joint.index))
    .flatMap((joint) =>
      limitSteps(run, kind, joint).map((steps) => ({
        scale: series[joint.index].scale,
        colour: colours(joint.index),
        steps,
      })),
    );
}

function pathSpec(run, theme) {
  const { frames } = run.data;
  const degrees = 180 / Math.PI;
  const turns = frames.turn_speed.some((value) => Math.abs(value) > SLOWEST_TURN);
  const [tool, turn] = [frames.tool_speed.map((v) => v * 1000), frames.turn_speed.map((v) => v * degrees)];
  const series = [{ label: 'tool', scale: 'y', colour: () => theme.colour('trail'), values: () => tool, shown: () => true, width: 1.8 }];
  if (turns)
    series.push({ label: 'turn', scale: 'y2', colour: () => theme.colour('accent'), values: () => turn, shown: () => true });
  return {
    id: 'path',
    title: 'Path speed',
    unit: () => (turns ? 'mm/s  ·  turn °/s' : 'mm/s'),
    series,
    second: turns,
    single: () => false,
    from0: true,
    bands: run.events.filter((event) => event.kind === 'slowed').map((event) => ({ from: event.from, to: event.to, colour: 'slowed' })),
    limits: () => [],
    marks: () => [],
    readout: (frame) => `${figure(tool[frame])} mm/s${turns ? `   ${figure(turn[frame], 3)} °/s` : ''}`,
  };
}

function singularSpec(run, theme) {
  const { singular } = run.data.frames;
  return {
    id: 'singular',
    title: 'Smallest singular value',
    unit: () => '',
    series: [{ label: 'singular', scale: 'y', colour: () => theme.colour('singular'), values: () => singular, shown: () => true, width: 1.8 }],
    second: false,
    single: () => true,
    from0: true,
    bands: [],
    limits: () => [],
    marks: () => [],
    readout: (frame) => (singular[frame] === null ? '–' : Number(singular[frame]).toPrecision(3)),
  };
}
