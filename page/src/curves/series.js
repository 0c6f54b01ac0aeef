/** Curves of joints: values in units people read, shares of limits, and the limits themselves. */

/** Column of joint values or speeds (`what` 'q' or 'speed') of one joint in its shown unit. */
export function inUnits(run, what, joint) {
  return run.data.frames[what][joint.index].map((value) => value * joint.factor);
}

/**
 * The same in percent of the limits in force: of a position, of the way from the middle of its range to either
 * end; of a speed, of the bound on its side. null where there is no limit.
 */
export function inPercent(run, what, joint) {
  const kind = what === 'q' ? 'position' : 'speed';
  return run.data.frames[what][joint.index].map((value, frame) => {
    const [lower, upper] = run.limits(frame)[kind].map((side) => side[joint.index]);
    if (lower === null || upper === null) return null;
    if (kind === 'position') {
      const half = (upper - lower) / 2;
      return half > 0 ? (100 * (value - lower - half)) / half : 0;
    }
    const bound = value < 0 ? -lower : upper;
    return bound > 0 ? (100 * value) / bound : 0;
  });
}

/** Steps [[time, value]..] of both sides of a joint's limits of a kind, in the joint's shown unit. */
export function limitSteps(run, kind, joint) {
  return [0, 1].map((side) =>
    run.data.limits.map((limits) => {
      const value = limits[kind][side][joint.index];
      return [limits.tick * run.data.tick_s, value === null ? null : value * joint.factor];
    }),
  );
}

/** Whether a joint has limits of a kind at any time. */
export function hasLimits(run, kind, joint) {
  return run.data.limits.some((limits) => limits[kind][0][joint.index] !== null && limits[kind][1][joint.index] !== null);
}

/** Which curves a limit event is marked in: 'q', 'speed', or null for an acceleration, which has none. */
export function curveOf(event) {
  if (/\bacceleration\b/.test(event.label)) return null;
  return /\bspeed\b/.test(event.label) ? 'speed' : 'q';
}
