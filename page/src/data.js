/** The data of the page as irlx wrote it, and what follows from it. */

import { shownUnit } from './units.js';

const SUPPORTED = 'irlx page 1';
const NO_TOOL = { xyz: [0, 0, 0], quat: [0, 0, 0, 1] };

/** Read the JSON text of the page; throws an Error with a sentence for people. */
export function readRun(text) {
  const data = JSON.parse(text);
  if (data.format !== SUPPORTED) throw new Error(`This page shows '${SUPPORTED}'; the data is '${data.format}'.`);
  return new Run(data);
}

export class Run {
  constructor(data) {
    this.data = data;
    this.ticks = data.frames.tick;
    this.count = this.ticks.length;
    this.times = Float64Array.from(this.ticks, (tick) => tick * data.tick_s);
    this.duration = this.count ? this.times[this.count - 1] : 0;
    this.joints = data.joints.map((joint, index) => ({ ...joint, index, ...shownUnit(joint.unit) }));
    shortenNames(this.joints);
    this.programLines = data.program.text?.split('\n') ?? [];
    this.blocks = data.blocks.map((block) => this.#begun(block));
    this.blockFrames = this.blocks.map((block) => block.frame);
    this.events = data.events
      .map((event) => this.#placed(event))
      .sort((a, b) => a.first - b.first || a.last - b.last);
    this.events.forEach((event, index) => {
      event.index = index;
    });
  }

  /** First frame that shows a tick: frames stand for the ticks since the frame before. */
  frameOfTick(tick) {
    return Math.min(lowerBound(this.ticks, tick), Math.max(this.count - 1, 0));
  }

  /** Last frame at or before a time, s. */
  frameAt(time) {
    return Math.max(0, lowerBound(this.times, time + 1e-9) - 1);
  }

  /** Frame nearest to a time, s. */
  nearestFrame(time) {
    const before = this.frameAt(time);
    const next = Math.min(before + 1, this.count - 1);
    return this.times[next] - time < time - this.times[before] ? next : before;
  }

  /** Joint values of a frame, and on the way to the next one where `share` is above 0. */
  q(frame, share = 0) {
    const next = Math.min(frame + 1, this.count - 1);
    return this.data.frames.q.map((column) =>
      share > 0 ? column[frame] + share * (column[next] - column[frame]) : column[frame],
    );
  }

  /** Limits in force in a frame. */
  limits(frame) {
    const tick = this.ticks[frame];
    let found = this.data.limits[0];
    for (const limits of this.data.limits) if (limits.tick <= tick) found = limits;
    return found;
  }

  /** Pose {xyz, quat} of the tool frame in that of the tip link, in force in a frame. */
  tool(frame) {
    const tick = this.ticks[frame];
    let found = NO_TOOL;
    for (const tool of this.data.tools ?? []) if (tool.tick <= tick) found = tool;
    return found;
  }

  /** The block in execution in a frame, undefined before the first. */
  blockAt(frame) {
    return this.blocks[lowerBound(this.blockFrames, frame + 1) - 1];
  }

  /** What a block does, in words of the program where they are known. */
  wordsOf(block) {
    return this.programLines[block.line - 1]?.replace(/\{[^}]*\}?|\(\*.*?(\*\)|$)/g, '').trim() || block.text;
  }

  /** Events that go on in a frame. */
  eventsAt(frame) {
    return this.events.filter((event) => event.frame <= frame && frame <= event.lastFrame);
  }

  /** A block with the time at which it begins, and the first frame that it has moved. */
  #begun(block) {
    const line = block.file ? 0 : block.line;
    return { ...block, line, from: block.tick * this.data.tick_s, frame: this.frameOfTick(block.tick + 1) };
  }

  #placed(event) {
    const frame = this.frameOfTick(event.first);
    return {
      ...event,
      frame,
      // What a module writes has no line in this text; the line in execution is another one.
      line: event.line ?? (event.kind === "message" ? null : this.data.frames.line[frame] || null),
      lastFrame: Math.max(frame, this.frameOfTick(event.last)),
      from: event.first * this.data.tick_s,
      to: event.last * this.data.tick_s,
    };
  }
}

/** Index of the first entry of a rising list that is not below a value. */
function lowerBound(values, value) {
  let [low, high] = [0, values.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Give joints the name `short`: without what all names begin with, where room is scarce. */
function shortenNames(joints) {
  const names = joints.map((joint) => joint.name);
  const shared = names.length > 1 ? sharedBeginning(names) : '';
  joints.forEach((joint) => {
    joint.short = joint.name.slice(shared.length) || joint.name;
  });
}

function sharedBeginning(names) {
  let end = 0;
  while (names.every((name) => end < name.length && name[end] === names[0][end])) end += 1;
  const shared = names[0].slice(0, end);
  // A beginning ends where a word does: "left_hand" and "left_head" lose "left_" only, "A1" and "A2" the letter.
  if (/[A-Za-z]$/.test(shared) && names.every((name) => /^\d+$/.test(name.slice(end)))) return shared;
  const word = shared.match(/^.*[^A-Za-z0-9]/);
  return word ? word[0] : '';
}
