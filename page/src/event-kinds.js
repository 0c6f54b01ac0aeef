/** Kinds of events: what they are called, and the colour of the style sheet that marks them. */

export const KINDS = {
  slowed: { name: 'Slowed', colour: 'slowed' },
  limit: { name: 'At a limit', colour: 'limit' },
  nearest: { name: 'Nearest', colour: 'nearest' },
  signal: { name: 'Signals', colour: 'signal' },
  wait: { name: 'Waits', colour: 'wait' },
  stop: { name: 'Stops', colour: 'stop' },
  message: { name: 'Messages', colour: 'message' },
};

export function kindOf(event) {
  return KINDS[event.kind] ?? KINDS.message;
}

/** Kinds that a run has events of, in the order of KINDS. */
export function kindsOf(events) {
  return Object.keys(KINDS).filter((kind) => events.some((event) => event.kind === kind));
}
