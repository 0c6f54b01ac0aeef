/** SI values as people read them: deg and mm. */

const DEGREES = 180 / Math.PI;

/** Factor and name of the unit in which values of an SI unit are shown. */
export function shownUnit(unit) {
  return unit === 'm' ? { factor: 1000, shown: 'mm' } : { factor: DEGREES, shown: '°' };
}

/** A number with as many decimals as its size deserves, with a true minus sign. */
export function figure(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const size = Math.abs(Number(value.toPrecision(digits)));
  if (size < 0.5 * 10 ** (1 - digits)) return '0';
  const decimals = size >= 1 ? Math.max(0, digits - 1 - Math.floor(Math.log10(size))) : digits - 1;
  return withSign(value.toFixed(Math.min(decimals, 6)));
}

/** A number with fixed decimals, with a true minus sign. */
export function fixed(value, decimals) {
  return value === null || !Number.isFinite(value) ? '–' : withSign(value.toFixed(decimals));
}

/** Time in s, as many decimals as ticks need. */
export function seconds(value, tick = 0.01) {
  return value.toFixed(tick < 0.01 ? 3 : 2);
}

function withSign(text) {
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text.replace('-', '\u2212');
}
