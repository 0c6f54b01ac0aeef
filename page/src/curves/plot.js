/** One plot over time: curves, dashed limits, bands, the time shown; pressing or dragging in it seeks. */

import uPlot from 'uplot';
import { element } from '../element.js';
import { sparse } from '../sparse.js';

const LEFT = 52;
const FOCUS = 28; // px within which a curve is told by the pointer
const MARKS = 6; // px that marks of moves are apart at least
const BREAK = 4; // px that a break in a curve is wide at least

/**
 * A spec has: id, title, series [{label, unit, scale, colour(), values(), shown(), dash, width, decimals}], of which one
 * may have breaks(), the frames that are not joined with the one before,
 * second (name of the right scale or null), from0 (whether the y axis begins at 0), range(scale) or null,
 * single() whether the left scale serves all curves now, rows of the heading where more than one, limits() -> [{scale, colour, steps: [[time, value]..]}], bands [{from, to, colour}],
 * marks() -> [{series, first, last}] stretches of curves drawn strong, readout(frame, series) -> text.
 */
export class Plot {
  constructor(run, spec, theme, { right, seek, hover, shown }) {
    Object.assign(this, { run, spec, theme, right, seek, hover, shown });
    this.value = element('output', { class: 'plot-value' });
    this.host = element('div', { class: 'plot-canvas', role: 'img', 'aria-label': `${spec.title} over time` });
    this.heading = element('span', { class: 'plot-unit' }, spec.unit());
    this.root = element(
      'section',
      { class: spec.rows > 1 ? 'plot two-rows' : 'plot', 'data-plot': spec.id },
      element('h3', {}, element('span', { class: 'plot-title' }, spec.title), this.heading, this.value),
      this.host,
    );
    this.focused = null;
    this.frame = 0;
    this.time = 0;
  }

  /** Height of the heading, px. */
  get head() {
    return this.heading.parentElement.offsetHeight;
  }

  /** Draw at a size in px; the first call makes the plot. */
  size(width, height) {
    if (width < 40 || height < 30) return;
    if (this.plot) {
      this.plot.setSize({ width, height });
    } else {
      this.plot = new uPlot(this.#options(width, height), this.#data(), this.host);
      // uPlot knows its scales only once it has drawn, which places the line.
      this.line = element('div', { class: 'plot-now' });
      this.plot.over.append(this.line);
      this.#listen(this.plot.over);
      this.#tell(this.frame, null);
    }
  }

  /** Show a time, s, and the values of its frame. */
  now(frame, time) {
    this.frame = frame;
    this.time = time;
    if (!this.plot) return;
    this.#placeLine();
    if (this.focused === null) this.#tell(frame, null);
  }

  /** Values, units or the choice of curves have changed. */
  renew() {
    this.heading.textContent = this.spec.unit();
    if (!this.plot) return;
    this.spec.series.forEach((series, k) => this.plot.setSeries(k + 1, { show: series.shown() }, false));
    this.plot.setData(this.#data());
    this.#tell(this.frame, null);
  }

  /** Show the stretch of time that is `shown` now. */
  window() {
    this.plot?.setScale('x', { min: this.shown.from, max: this.shown.to });
  }

  /** Take the colours of the theme. */
  paint() {
    this.plot?.redraw(false, true);
  }

  #data() {
    return [this.run.times, ...this.spec.series.map((series) => series.values())];
  }

  #options(width, height) {
    const { spec, theme } = this;
    const muted = () => theme.colour('muted');
    const grid = { stroke: () => theme.colour('plot-grid'), width: 1 };
    const axis = {
      stroke: muted,
      grid,
      ticks: { show: false },
      font: '11px system-ui, sans-serif',
      values: (_, ticks) => ticks.map((tick) => String(+tick.toPrecision(8)).replace('-', '\u2212')),
    };
    const y = { ...axis, scale: 'y', size: LEFT, gap: 4, space: 15 };
    // Where one scale serves all curves the other one keeps its room, so that plots stay below each other.
    const values = (u, ticks) => (spec.single() ? ticks.map(() => '') : axis.values(u, ticks));
    const second = { ...axis, values, scale: 'y2', side: 1, size: this.right, gap: 4, space: 15, grid: { show: false } };
    return {
      width,
      height,
      padding: [6, spec.second ? 0 : this.right, 0, 0],
      legend: { show: false },
      cursor: {
        y: false,
        drag: { x: false, y: false, setScale: false },
        sync: { key: 'irlx', setSeries: false },
        points: { show: false },
      },
      focus: { alpha: 0.22 },
      scales: {
        x: { time: false, range: () => [this.shown.from, this.shown.to] },
        y: { range: (_, low, high) => this.#range('y', low, high) },
        y2: { range: (_, low, high) => this.#range('y2', low, high) },
      },
      axes: [{ ...axis, size: 22, gap: 4, space: 56 }, y, ...(spec.second ? [second] : [])],
      series: [{}, ...spec.series.map((series) => this.#series(series))],
      hooks: { drawClear: [(u) => this.#drawBelow(u)], draw: [(u) => this.#drawAbove(u), () => this.line && this.#placeLine()] },
    };
  }

  #series(series) {
    return {
      label: series.label,
      scale: series.scale,
      show: series.shown(),
      stroke: () => series.colour(),
      width: series.width ?? 1.5,
      dash: series.dash,
      points: { show: (u) => u.data[0].length < 2 },
      spanGaps: false,
      gaps: (u, _, first, last, gaps) => (series.breaks ? withBreaks(u, series.breaks(), first, last, gaps) : gaps),
      pxAlign: 0,
    };
  }

  #range(scale, low, high) {
    const given = this.spec.range?.(scale);
    if (given) return given;
    let [least, most] = this.#extent(scale, low, high);
    for (const limit of this.spec.limits()) {
      if (limit.scale !== scale) continue;
      for (const [, value] of limit.steps) {
        if (value === null) continue;
        least = Math.min(least, value);
        most = Math.max(most, value);
      }
    }
    if (this.spec.from0) return [Math.min(0, least), most > 0 ? most * 1.08 : 1];
    const room = 0.06 * (most - least) || Math.max(Math.abs(most) * 0.1, 1);
    return [least - room, most + room];
  }

  /** Least and largest value that a scale has to show: where nothing of its curves is in sight, those of the whole run. */
  #extent(scale, low, high) {
    if (low !== null && high !== null) return [low, high];
    let [least, most] = [Infinity, -Infinity];
    for (const series of this.spec.series) {
      if (series.scale !== scale || !series.shown()) continue;
      for (const value of series.values()) {
        if (value === null) continue;
        least = Math.min(least, value);
        most = Math.max(most, value);
      }
    }
    return least <= most ? [least, most] : [0, 1];
  }

  #drawBelow(u) {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    for (const band of this.spec.bands) {
      const [from, to] = [band.from, band.to].map((time) => u.valToPos(time, 'x', true));
      ctx.globalAlpha = 0.14;
      ctx.fillStyle = this.theme.colour(band.colour);
      ctx.fillRect(from, bbox.top, Math.max(to - from, devicePixelRatio), bbox.height);
    }
    ctx.globalAlpha = 1;
    ctx.strokeStyle = this.theme.colour('plot-block');
    ctx.lineWidth = devicePixelRatio;
    ctx.beginPath();
    const begins = this.run.blocks.slice(1).map((block) => Math.round(u.valToPos(block.from, 'x', true)));
    for (const x of sparse(begins, MARKS * devicePixelRatio)) {
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
    }
    ctx.stroke();
    ctx.restore();
  }

  #drawAbove(u) {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top - 2, bbox.width, bbox.height + 4);
    ctx.clip();
    ctx.lineWidth = 1.1 * devicePixelRatio;
    for (const limit of this.spec.limits()) {
      ctx.setLineDash([5, 4].map((length) => length * devicePixelRatio));
      ctx.strokeStyle = limit.colour;
      this.#drawSteps(u, limit);
    }
    ctx.setLineDash([]);
    ctx.lineWidth = 3.5 * devicePixelRatio;
    ctx.strokeStyle = this.theme.colour('limit');
    ctx.lineCap = 'round';
    for (const mark of this.spec.marks()) this.#drawStretch(u, mark);
    ctx.restore();
  }

  #drawSteps(u, { scale, steps }) {
    const { ctx } = u;
    ctx.beginPath();
    steps.forEach(([time, value], k) => {
      if (value === null) return;
      const y = u.valToPos(value, scale, true);
      ctx.moveTo(u.valToPos(time, 'x', true), y);
      ctx.lineTo(u.valToPos(steps[k + 1]?.[0] ?? this.run.duration, 'x', true), y);
    });
    ctx.stroke();
  }

  #drawStretch(u, { series, first, last }) {
    const { ctx } = u;
    const { scale } = this.spec.series[series];
    ctx.beginPath();
    for (let frame = first; frame <= last; frame += 1) {
      const value = u.data[series + 1][frame];
      if (value === null) continue;
      const [x, y] = [u.valToPos(this.run.times[frame], 'x', true), u.valToPos(value, scale, true)];
      if (frame === first) ctx.moveTo(x - (first === last ? 1 : 0), y);
      ctx.lineTo(x, y);
    }
    ctx.stroke();
  }

  #listen(over) {
    const at = (event) => {
      const box = over.getBoundingClientRect();
      return { time: this.plot.posToVal(event.clientX - box.left, 'x'), y: event.clientY - box.top };
    };
    over.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      over.setPointerCapture(event.pointerId);
      this.seek(at(event).time);
    });
    over.addEventListener('pointermove', (event) => {
      const { time, y } = at(event);
      if (event.buttons & 1) this.seek(time);
      const frame = this.run.nearestFrame(Math.min(Math.max(time, 0), this.run.duration));
      this.#focus(this.#nearest(frame, y), frame);
      if (event.pointerType === 'mouse') this.hover(frame);
    });
    over.addEventListener('dblclick', () => this.shown.reset());
    over.addEventListener(
      'wheel',
      (event) => {
        // The wheel alone scrolls the list of plots.
        const { shown } = this;
        if (event.ctrlKey || event.metaKey) shown.zoom(at(event).time, Math.exp(event.deltaY / 300));
        else if (event.shiftKey && !shown.isWhole) shown.shift(((event.deltaX || event.deltaY) / 1000) * (shown.to - shown.from));
        else return;
        event.preventDefault();
      },
      { passive: false },
    );
    over.addEventListener('pointerleave', () => {
      this.#focus(null, this.frame);
      this.focused = null;
      this.#tell(this.frame, null);
      this.hover(null);
    });
  }

  /** Number of the curve next to the pointer, null for none. */
  #nearest(frame, y) {
    let [found, least] = [null, FOCUS];
    this.spec.series.forEach((series, k) => {
      const value = this.plot.data[k + 1][frame];
      if (!series.shown() || value === null || series.silent) return;
      const way = Math.abs(this.plot.valToPos(value, series.scale) - y);
      if (way < least) [found, least] = [k, way];
    });
    return found;
  }

  #focus(series, frame) {
    const many = this.spec.series.filter((it) => it.shown() && !it.silent).length > 2;
    if (many) this.plot.setSeries(series === null ? null : series + 1, { focus: true }, false);
    this.focused = frame;
    this.#tell(frame, series);
  }

  #placeLine() {
    this.line.hidden = this.time < this.shown.from || this.time > this.shown.to;
    this.line.style.transform = `translateX(${Math.round(this.plot.valToPos(this.time, 'x'))}px)`;
  }

  #tell(frame, series) {
    this.value.textContent = this.spec.readout(frame, series);
  }
}

/** Gaps of a curve [[from, to]..], px: those where it has no values, and as wide a one as can be seen at each break. */
function withBreaks(u, breaks, first, last, gaps) {
  const half = (BREAK * devicePixelRatio) / 2;
  const own = breaks
    .filter((frame) => first < frame && frame <= last)
    .map((frame) => {
      const [from, to] = [frame - 1, frame].map((index) => u.valToPos(u.data[0][index], 'x', true));
      const middle = (from + to) / 2;
      return [Math.min(from, middle - half), Math.max(to, middle + half)];
    });
  const joined = [];
  for (const [from, to] of [...gaps, ...own].sort((a, b) => a[0] - b[0])) {
    const before = joined[joined.length - 1];
    if (before && from <= before[1]) before[1] = Math.max(before[1], to);
    else joined.push([from, to]);
  }
  return joined;
}
